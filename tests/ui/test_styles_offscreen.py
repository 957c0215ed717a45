"""Styles chosen from their pictures, in the window."""

from __future__ import annotations

from stippler.drawing.style_presets import presets


def test_a_style_is_chosen_by_its_picture_and_told_when_it_is_changed(desk) -> None:
    session, host = desk.app.session, desk.host
    assert session.style.name == ""
    seed = session.style.seed
    host.click("style")
    shelf = desk.app.editor.popups.styles
    host.until(lambda: shelf.is_open and shelf.is_ready, "the pictures")
    host.settle()
    assert all(shelf._texture(one.swatch) is not None for one in presets().values())
    k = list(presets()).index("cloth")
    host.click(f"shelf {k}")
    host.settle()
    assert not shelf.is_open
    assert session.style.name == "Cloth"
    assert session.style.spacing == "square"
    assert session.style.seed == seed
    host.click("In all")
    assert session.style.density_per_cm2 is None
    host.click("Per cm²")
    assert session.style.density_per_cm2 is not None
    assert session.style.n_dots is None
