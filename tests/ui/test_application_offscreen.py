"""Menus, palette, shortcuts, preferences, recent pictures and close guard, by scripted hands."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

from imgui_bundle import imgui  # noqa: F401  # isort: skip - first: glfw then uses its library
import glfw
import numpy as np
import pytest
from PIL import Image

import stippler
from stippler.app import App
from stippler.drawing.style import Style
from stippler.ui.panels.layout import DRAWING, HISTORY, TOOL, VIEW
from stippler.ui.preferences import FILE, Preferences
from stippler.ui.theme import DARK, PANEL_WIDTH, STRIP_WIDTH
from stippler.ui.widgets import Widgets
from stippler.ui.window.placement import Place
from stippler.ui.window.scripted_host import Host

from .conftest import Desk

Start = Callable[[], Desk]


@pytest.fixture
def start(kernels: None, monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Start]:
    """Start editors one after the other, all with the same settings folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("STIPPLER_SCALE", raising=False)
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path / "settings"))
    running: list[App] = []

    def begin() -> Desk:
        while running:
            running.pop().close()
        kept = Preferences.load(tmp_path / "settings")
        style, tone, width_mm = kept.begin(
            Style(n_dots=300, iterations=4), "linear", 120.0, {"n_dots", "iterations"}
        )
        app = App(
            style, tone=tone, width_mm=width_mm, size=(1000, 700), preferences=kept, offscreen=True
        )
        running.append(app)
        return Desk(app, Host(app.window, app.editor, app.step))

    yield begin
    while running:
        running.pop().close()


def opened(desk: Desk, picture: Path) -> None:
    desk.host.drop(picture)
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    desk.host.settle()


def painted(desk: Desk, picture: Path) -> int:
    """Open a picture and erase some of its dots; return how many are left."""
    opened(desk, picture)
    desk.host.key("e")
    desk.host.drag((640, 330), (660, 340), "left")
    desk.host.key("v")
    assert desk.app.session.unsaved
    return desk.app.session.n_dots


def run_by_name(desk: Desk, typed: str) -> None:
    desk.host.key("p", ctrl=True, shift=True)
    desk.host.type(typed)
    desk.host.key("enter")


# --- palette ---------------------------------------------------------------------------------


def test_the_palette_runs_what_is_typed(start: Start) -> None:
    desk = start()
    run_by_name(desk, "light or dark")
    assert desk.app.editor.look.theme is DARK
    assert not desk.app.editor.popups.palette.is_open
    desk.host.key("p", ctrl=True, shift=True)
    palette = desk.app.editor.popups.palette
    assert palette.found[0].name == "view.theme"  # run last
    desk.host.type("tip")
    assert [command.name for command in palette.found[:2]] == ["tool.larger", "tool.smaller"]
    desk.host.key("down")
    desk.host.key("up")
    desk.host.key("up")  # from the first to the last
    assert palette._at == len(palette.found) - 1
    desk.host.key("escape")
    assert not palette.is_open


def test_a_letter_in_the_palette_is_no_tool_and_a_click_runs(start: Start) -> None:
    desk = start()
    desk.host.key("p", ctrl=True, shift=True)
    desk.host.type("eras")
    assert desk.app.editor.painting.toolbox.brush is None
    desk.host.click("palette Erase")
    brush = desk.app.editor.painting.toolbox.brush
    assert brush is not None
    assert brush.kind == "erase"


def test_every_command_is_in_the_palette_and_in_a_menu(start: Start) -> None:
    desk = start()
    desk.host.key("p", ctrl=True, shift=True)
    found = {command.name for command in desk.app.editor.popups.palette.found}
    assert found == {command.name for command in desk.app.editor.commands}
    desk.host.key("escape")
    shown: set[str] = set()
    for group, members in desk.app.editor.commands.groups():
        desk.host.click(f"menu {group}")
        shown |= {one.name for one in members if desk.host.shown(f"item {one.label}")}
        desk.host.click(f"menu {group}")
    assert shown == found


def test_a_menu_runs_and_greys(start: Start, picture: Path) -> None:
    desk = start()
    desk.host.click("menu View")
    desk.host.click("item Light or dark")
    assert desk.app.editor.look.theme is DARK
    desk.host.click("menu Edit")
    desk.host.click("item Undo")  # greyed: nothing to undo
    assert desk.host.shown("item Undo")
    desk.host.key("escape")


# --- shortcuts -------------------------------------------------------------------------------


def test_the_sheet_lists_all_keys_and_closes_by_its_own(start: Start) -> None:
    desk = start()
    sheet = desk.app.editor.popups.sheet
    desk.host.key("f1")
    assert sheet.is_open
    commands = list(desk.app.editor.commands)
    with_keys = {command.label for command in commands if command.keys}
    for command in commands:
        assert desk.host.shown(f"sheet {command.label}") == (command.label in with_keys)
    assert desk.host.shown("sheet Zoom at the pointer")
    desk.host.type("zoom")
    assert desk.host.shown("sheet Zoom at the pointer")
    assert not desk.host.shown("sheet Undo")
    desk.host.key("f1")
    assert not sheet.is_open
    desk.host.key("f1")
    desk.host.key("escape")
    assert not sheet.is_open


def test_a_key_is_changed_used_and_kept(start: Start) -> None:
    desk = start()
    desk.host.key("comma", ctrl=True)
    desk.host.click("tab Keys")
    desk.host.click("key search")
    desk.host.type("light or dark")
    desk.host.click("key Light or dark")
    desk.host.key("l", ctrl=True)
    assert desk.host.shown("Use Ctrl+L")
    assert "Relax all dots" in desk.app.editor.popups.preferences.keys.said
    desk.host.click("Use Ctrl+L")
    assert desk.host.shown("reset Light or dark")
    desk.host.key("escape")
    assert not desk.app.editor.popups.preferences.is_open
    desk.host.key("l", ctrl=True)
    assert desk.app.editor.look.theme is DARK
    desk = start()
    assert desk.app.editor.look.theme is DARK
    assert desk.app.editor.commands["work.relax"].keys == ()
    desk.host.key("l", ctrl=True)
    assert desk.app.editor.look.theme is not DARK
    desk.host.key("comma", ctrl=True)
    desk.host.click("tab Keys")
    desk.host.click("Reset all")
    assert str(start().app.editor.commands["work.relax"].keys[0]) == "Ctrl+L"


def test_escape_closes_the_preferences_and_leaves_the_brush(start: Start) -> None:
    desk = start()
    desk.host.key("e")
    desk.host.key("comma", ctrl=True)
    desk.host.key("escape")
    assert not desk.app.editor.popups.preferences.is_open
    assert desk.app.editor.painting.toolbox.brush is not None
    desk.host.key("escape")
    assert desk.app.editor.painting.toolbox.brush is None


def test_escape_while_a_key_is_asked_for_closes_nothing(start: Start) -> None:
    desk = start()
    desk.host.key("comma", ctrl=True)
    desk.host.click("tab Keys")
    desk.host.click("key New page")
    desk.host.key("escape")
    preferences = desk.app.editor.popups.preferences
    assert preferences.is_open
    assert not preferences.keys.waits
    assert not desk.app.editor.commands.is_changed("file.new")


# --- preferences -----------------------------------------------------------------------------


def test_look_and_values_survive(start: Start) -> None:
    desk = start()
    desk.host.key("comma", ctrl=True)
    desk.host.click("Dark")
    desk.host.click("Scale")
    desk.host.key("escape")
    desk.host.click("As in file")
    desk.host.fill("Width", "77")
    desk.app.editor.look.opacity = 0.8
    desk = start()
    assert desk.app.editor.look.theme is DARK
    assert desk.app.editor.look.opacity == 0.8
    assert (desk.app.session.tone, desk.app.session.width_mm) == ("perceptual", 77.0)
    run_by_name(desk, "default values")
    assert (desk.app.session.tone, desk.app.session.width_mm) == ("illustration", 148.0)


def test_text_and_panels_grow_at_once(start: Start) -> None:
    desk = start()
    before = desk.app.editor.widgets.marks["Start"]
    desk.app.editor.look.scale = 1.5
    desk.host.move(700, 300)
    desk.host.settle()
    after = desk.app.editor.widgets.marks["Start"]
    assert (after[2] - after[0]) / (before[2] - before[0]) == pytest.approx(1.5, abs=0.12)
    assert desk.app.editor.view.size_px[0] >= 0.38 * desk.app.window.size_px[0]
    desk = start()
    assert desk.app.editor.widgets.marks["Start"] == pytest.approx(after, abs=1)
    kept = Preferences.load(desk.app.editor._kept.folder)  # type: ignore[arg-type]
    assert kept.look.scale == 1.5


def test_panels_close_open_and_keep_their_place(start: Start) -> None:
    desk = start()
    assert desk.host.shown("Start")
    run_by_name(desk, "panels drawing")
    assert not desk.app.editor.panels.is_open(DRAWING)
    desk.host.settle()
    assert not desk.host.shown("Start")
    desk = start()
    assert not desk.host.shown("Start")
    desk.host.click("menu Panels")
    desk.host.click("item Drawing")
    assert desk.host.shown("Start")
    desk.host.drag(desk.host.place("panel Drawing"), (600.0, 200.0), "left")  # by its tab
    place = desk.host.place("Start")
    assert place[0] > 400
    desk = start()
    desk.host.settle()
    assert desk.host.place("Start") == pytest.approx(place, abs=2)
    run_by_name(desk, "reset the panels")
    assert desk.host.place("Start")[0] < STRIP_WIDTH + PANEL_WIDTH


def test_broken_settings_are_told_and_do_no_harm(start: Start, tmp_path: Path) -> None:
    settings = tmp_path / "settings"
    settings.mkdir()
    (settings / FILE).write_text('{"look": ')
    (settings / "keys.json").write_text("no keys")
    (settings / "layout.ini").write_text("[Docking][Data]\nDockSpace ID=zzz\n[Window][\x01\n\n=,=")
    desk = start()
    said = [message.text for message in desk.app.session.messages.log]
    assert sum(FILE in line for line in said) == 1
    assert sum("keys.json" in line for line in said) == 1
    assert (settings / "preferences.broken.json").read_text() == '{"look": '
    assert (settings / "keys.broken.json").exists()
    assert desk.host.shown("Start")
    start()
    assert json.loads((settings / FILE).read_text())["look"]["theme"] == "light"


def test_a_folder_that_cannot_be_written_is_one_line(start: Start, tmp_path: Path) -> None:
    (tmp_path / "settings").write_text("in the way")
    desk = start()
    desk.app.editor._keeper.keep()
    assert "settings cannot be kept" in desk.host.said()


def test_the_window_is_as_large_as_it_was(kernels: None, tmp_path: Path) -> None:
    kept = Preferences(tmp_path)
    kept.place = Place((900, 650))
    app = App(Style(), tone="linear", width_mm=50.0, preferences=kept, offscreen=True)
    try:
        assert app.window.size_px == (900, 650)
        app.step(0.0)
        glfw.set_window_size(app.window._handle, 840, 600)
        app.step(0.0)
    finally:
        app.close()
    assert Preferences.load(tmp_path).place.size == (840, 600)


# --- recent pictures -------------------------------------------------------------------------


def test_recent_pictures_are_offered_and_missing_ones_taken_off(
    start: Start, picture: Path, tmp_path: Path
) -> None:
    gone = tmp_path / "gone.png"
    Image.new("L", (60, 60), 128).save(gone)
    desk = start()
    opened(desk, gone)
    opened(desk, picture)
    desk = start()
    assert desk.host.shown(f"file.recent {picture}")
    assert desk.host.shown(f"file.recent {gone}")
    gone.unlink()
    desk.host.click(f"file.recent {gone}")
    assert str(gone) in desk.host.said()
    assert not desk.host.shown(f"file.recent {gone}")
    run_by_name(desk, "open disc")
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    assert desk.app.session.name == picture.name
    desk = start()
    assert desk.app.editor._kept.recent == [picture]


# --- the close guard -------------------------------------------------------------------------


def test_what_no_hand_has_touched_is_closed_unasked(desk, picture: Path) -> None:
    opened(desk, picture)
    desk.app.session.relax(2, weighted=True)
    desk.host.until(lambda: not desk.app.session.busy, "relaxation")
    desk.host.until(lambda: desk.host.shown("Start"), "the button")
    desk.host.click("Start")  # anew, in place of the dots that are there
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")
    assert not desk.app.session.unsaved
    desk.app.window.input.close()
    desk.host.settle()
    assert desk.app.window.wants_to_close


def test_a_picture_dropped_on_a_file_dialog_is_asked_about(desk, picture: Path) -> None:
    painted(desk, picture)
    desk.host.key("o", ctrl=True)
    assert desk.app.editor.popups.dialogs.is_open
    desk.host.drop(picture)
    assert not desk.app.editor.popups.dialogs.is_open  # two windows fought for the keyboard
    desk.host.click("Discard")
    assert not desk.app.editor.popups.is_open
    desk.host.until(lambda: desk.app.session.phase == "done", "the drawing")


def test_closing_asks_however_often(desk, picture: Path) -> None:
    left = painted(desk, picture)
    assert desk.app.window.title == "disc.png* – Stippler"
    for _ in range(3):
        desk.app.window.input.close()
        desk.host.settle()
        desk.host.key("q", ctrl=True)
        assert desk.host.shown("Discard")
        assert not desk.app.window.wants_to_close
    desk.host.key("escape")
    assert not desk.host.shown("Discard")
    assert desk.app.session.n_dots == left
    desk.host.key("q", ctrl=True)
    desk.host.click("Cancel")
    assert not desk.app.window.wants_to_close
    desk.host.key("q", ctrl=True)
    desk.host.click("Discard")
    assert desk.app.window.wants_to_close


def test_closing_with_a_dialog_open_asks_in_its_place(desk, picture: Path) -> None:
    painted(desk, picture)
    desk.host.key("o", ctrl=True)
    assert desk.host.shown("path")
    desk.app.window.input.close()
    desk.host.settle()
    assert not desk.host.shown("path")
    desk.host.click("Save")
    desk.app.window.input.close()  # the question is being answered
    desk.host.settle()
    assert desk.host.shown("path")
    assert not desk.app.window.wants_to_close


def test_undone_changes_are_none(desk, picture: Path) -> None:
    painted(desk, picture)
    desk.host.key("z", ctrl=True)
    assert not desk.app.session.unsaved
    desk.host.key("y", ctrl=True)
    assert desk.app.session.unsaved


def test_export_then_close(desk, picture: Path, tmp_path: Path) -> None:
    left = painted(desk, picture)
    desk.host.key("q", ctrl=True)
    desk.host.click("Save")
    desk.host.fill("path", str(tmp_path / "kept.stipple"))
    desk.host.until(lambda: desk.app.window.wants_to_close, "the end")
    assert len(stippler.open(tmp_path / "kept.stipple").dots) == left


def test_export_then_close_while_dots_relax(desk, picture: Path, tmp_path: Path) -> None:
    left = painted(desk, picture)
    desk.app.session.relax(100_000, weighted=True)
    desk.host.key("q", ctrl=True)
    desk.host.click("Save")
    desk.host.fill("path", str(tmp_path / "kept.stipple"))
    desk.host.until(lambda: desk.app.window.wants_to_close, "the end")
    assert len(stippler.open(tmp_path / "kept.stipple").dots) == left


def test_an_export_that_is_cancelled_or_fails_closes_nothing(
    desk, picture: Path, tmp_path: Path
) -> None:
    painted(desk, picture)
    desk.host.key("q", ctrl=True)
    desk.host.click("Save")
    desk.host.key("escape")
    desk.host.settle()
    assert not desk.app.editor.popups.filing.guard.is_open
    desk.host.key("q", ctrl=True)
    desk.host.click("Save")
    desk.host.fill("path", str(tmp_path / "nowhere" / "kept.stipple"))
    assert "no folder" in desk.app.editor.popups.dialogs._own.problem
    desk.host.key("escape")
    desk.host.settle()
    assert not desk.app.editor.popups.filing.guard.is_open
    assert not desk.app.window.wants_to_close
    assert desk.app.session.unsaved


def test_another_drawing_asks_first(desk, picture: Path, tmp_path: Path) -> None:
    other = tmp_path / "other.png"
    Image.new("L", (60, 60), 128).save(other)
    left = painted(desk, picture)
    desk.host.drop(other)
    assert desk.host.shown("Discard")
    desk.host.click("Cancel")
    desk.host.key("n", ctrl=True)
    desk.host.click("Begin")
    assert desk.host.shown("Discard")
    desk.host.click("Cancel")
    desk.app.editor.show_panel(DRAWING)
    desk.host.settle()
    desk.host.click("As in file")  # the picture would be read anew
    desk.host.click("Start")
    assert desk.host.shown("Discard")
    desk.host.click("Cancel")
    assert (desk.app.session.name, desk.app.session.n_dots) == (picture.name, left)
    assert not desk.app.session.busy
    desk.host.drop(other)
    desk.host.click("Discard")
    desk.host.until(lambda: desk.app.session.phase == "done", "the other drawing")
    assert desk.app.session.name == "other.png"
    assert not desk.app.session.unsaved


def test_saving_again_asks_for_no_path(desk, picture: Path, tmp_path: Path) -> None:
    painted(desk, picture)
    out = tmp_path / "out.stipple"
    desk.host.key("s", ctrl=True)
    desk.host.fill("path", str(out))
    desk.host.until(lambda: not desk.app.session.exporting, "the export")
    desk.host.settle()
    assert not desk.app.session.unsaved
    desk.host.key("a", ctrl=True)
    desk.host.key("delete")
    assert desk.app.session.unsaved
    desk.host.key("z", ctrl=True)
    assert not desk.app.session.unsaved  # as the file has it
    desk.host.key("y", ctrl=True)
    desk.host.key("z", ctrl=True)
    desk.host.key("e")
    desk.host.drag((600, 300), (610, 310), "left")
    desk.host.key("s", ctrl=True)
    assert not desk.app.editor.popups.dialogs.is_open
    desk.host.until(lambda: not desk.app.session.exporting, "the export")
    assert len(stippler.open(out).dots) == desk.app.session.n_dots
    desk.host.key("s", ctrl=True, shift=True)
    assert desk.app.editor.popups.dialogs.is_open


def test_a_file_that_is_being_written_is_finished_first(
    desk, picture: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from threading import Event

    from stippler.editor import exports

    opened(desk, picture)
    gate, write = Event(), exports.export_drawing

    def slow(*asked):
        gate.wait(30)
        return write(*asked)

    monkeypatch.setattr(exports, "export_drawing", slow)
    out = tmp_path / "out.csv"
    desk.app.session.export(out, 600.0)
    desk.host.key("q", ctrl=True)
    assert desk.host.shown("Stay")
    assert not desk.app.window.wants_to_close
    desk.host.click("Stay")
    desk.host.settle()
    assert not desk.app.editor.popups.filing.guard.is_open
    desk.host.key("q", ctrl=True)
    gate.set()
    desk.host.until(lambda: desk.app.window.wants_to_close, "the end")
    assert out.exists()


# --- tooltips --------------------------------------------------------------------------------


def test_every_control_of_the_panels_says_what_it_does(
    desk, picture: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    noted: list[str] = []
    told: set[str] = set()
    note, tip = Widgets.note, Widgets.tip

    def noting(self: Widgets, label: str) -> None:
        noted.append(label)
        note(self, label)

    def telling(self: Widgets, text: str) -> None:
        if noted and len(text.strip(". ")) > 3:
            told.add(noted[-1])
        tip(self, text)

    opened(desk, picture)
    desk.app.editor.look.reference_shown = True
    monkeypatch.setattr(Widgets, "note", noting)
    monkeypatch.setattr(Widgets, "tip", telling)
    for name in (DRAWING, VIEW, HISTORY, TOOL):
        desk.app.editor.show_panel(name)
        desk.host.settle()
    for key in "sjbwgkcm":
        desk.host.key(key)
    desk.host.key("comma", ctrl=True)
    for tab in ("Panels", "Keys"):
        desk.host.click(f"tab {tab}")
    bare = {label for label in noted if label not in told}
    bare = {label for label in bare if not label.startswith(("menu ", "item ", "tab ", "step "))}
    assert bare == set()
    assert {"Start", "Fit", "Undo", "Brush radius", "Dark", "Reset all"} <= told


def test_the_shot_is_of_the_palette(start: Start) -> None:
    desk = start()
    before = desk.host.screenshot()
    desk.host.key("p", ctrl=True, shift=True)
    changed = np.abs(desk.host.screenshot().astype(int) - before).max(axis=2) > 8
    rows = np.flatnonzero(changed[:660, 500:].any(axis=1))
    assert 20 < rows.min() < 120  # in the middle, near the top
    assert rows.max() < 520
