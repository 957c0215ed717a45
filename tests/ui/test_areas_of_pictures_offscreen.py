"""Areas from the picture in the whole editor: proposed, grown, dark."""

from __future__ import annotations

from pathlib import Path

import pytest


@pytest.fixture
def drawn(desk, picture: Path):
    """An editor with the dark disc drawn."""
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()
    return desk


def on_screen(desk, x_mm: float, y_mm: float) -> tuple[float, float]:
    view, origin = desk.app.editor.view, desk.app.editor.pointer.origin_px
    x, y = view.camera.page_to_screen((x_mm, y_mm), view.size_px)
    return float(x + origin[0]), float(y + origin[1])


def wait(desk) -> None:
    desk.host.until(lambda: not desk.app.editor.area_acts.jobs.busy, "the work on areas")
    desk.host.settle()


def test_proposals_are_merged_and_made_as_one_step(drawn):
    painting, session = drawn.app.editor.painting, drawn.app.session
    painting.toolbox.choose("proposals")
    painting.toolbox.tool.set("regions", 3)
    drawn.host.move(*on_screen(drawn, 60, 45))
    wait(drawn)
    drawn.host.move(*on_screen(drawn, 61, 45))
    drawn.host.settle()
    assert painting.toolbox.tool.n_regions == 3
    drawn.host.click(on_screen(drawn, 60, 45))
    assert painting.toolbox.tool.n_regions == 4
    drawn.host.drag(on_screen(drawn, 10, 45), on_screen(drawn, 70, 45), "left")
    n = painting.toolbox.tool.n_regions
    assert n < 4
    drawn.host.key("enter")
    wait(drawn)
    assert len(session.drawing.areas) == n
    assert session.document.history.steps[-1].label == "Propose areas"
    session.undo()
    assert len(session.drawing.areas) == 1


def test_an_outline_grows_from_a_scribble(drawn):
    session = drawn.app.session
    drawn.app.editor.painting.toolbox.choose("grow")
    drawn.host.click(on_screen(drawn, 60, 45))  # the picture is read first
    wait(drawn)
    drawn.host.drag(on_screen(drawn, 55, 45), on_screen(drawn, 65, 45), "left")
    drawn.host.key("enter")
    drawn.host.settle()
    area = session.drawing.areas[1].outline_mm
    assert area.area == pytest.approx(3.14 * 30**2, rel=0.06)
    assert area.centroid.distance(area.centroid.__class__(60, 45)) < 1.0


def test_dark_parts_become_inverse_areas(drawn):
    session, acts = drawn.app.session, drawn.app.editor.area_acts
    acts.dark_level = 0.5
    acts.dark_parts()
    wait(drawn)
    (area,) = [a for k, a in session.drawing.areas.items() if k]
    assert session.drawing.styles[area.style].is_inverse
    assert area.outline_mm.area == pytest.approx(3.14 * 30**2, rel=0.05)
    steps = len(session.document.history.steps)
    session.undo()
    assert len(session.drawing.areas) == 1
    assert len(session.drawing.styles) == 1
    assert len(session.document.history.steps) == steps
