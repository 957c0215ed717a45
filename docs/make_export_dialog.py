"""Make `docs/export-dialog.png` and `docs/export-pens.png`: the dialog on a sample, offscreen.

python docs/make_export_dialog.py
"""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from PIL import Image

import stippler
from stippler.app import App
from stippler.drawing.style import Style
from stippler.opening import open_file
from stippler.ui.window.scripted_host import Host

HERE = Path(__file__).parent
SAMPLE = HERE.parent / "assets" / "samples" / "ammonite.png"
PUBLISHER = "Journal of Paleontology, column"


def main() -> None:
    """Open the dialog, choose what a journal asks for; then what a plotter does."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ["STIPPLER_CONFIG_DIR"] = os.environ["STIPPLER_STATE_DIR"] = folder
        kept = Path(folder) / "ammonite.stipple"
        stippler.stipple(SAMPLE, dots=20_000, width=148).save(kept)
        app = App(Style(), tone="linear", width_mm=148.0, size=(1280, 800), offscreen=True)
        hands = Host(app.window, app.editor, app.step)
        try:
            app.session.show(open_file(kept))
            hands.settle()
            _for_a_journal(app, hands)
            _for_a_plotter(app, hands)
        finally:
            app.close()


def _for_a_journal(app: App, hands: Host) -> None:
    from stippler.editor.export_choices import profile_choices

    hands.key("e", ctrl=True)
    dialog = app.editor.popups.exporting
    hands.click("Fit sheet")  # takes the keyboard from the path
    dialog.choices.path = "ammonite.tif"
    dialog.choices.choose_profile(
        next(one for one in profile_choices() if one.text.startswith(PUBLISHER))
    )
    for name, value in (
        ("magnification", 1.6),
        ("caption", "Fig. 3. Dactylioceras."),
        ("letter", "A"),
    ):
        dialog.choices.set(name, value)
    _shot(app, hands, "export-dialog.png")


def _for_a_plotter(app: App, hands: Host) -> None:
    from stippler.editor.export_choices import profile_choices

    dialog = app.editor.popups.exporting
    dialog.choices.choose_profile(profile_choices()[0])
    dialog.choices.path = "ammonite.gcode"
    hands.click("Pens")
    _wait(app, hands)
    course = dialog.look.course
    assert course is not None
    dialog.preview.playing.at_s = 0.4 * course.total_s
    _shot(app, hands, "export-pens.png")


def _wait(app: App, hands: Host) -> None:
    dialog = app.editor.popups.exporting

    def found() -> bool:
        going, look = dialog._going, dialog.look
        if going is None or look.file_key != going.asked.file_key:
            return False
        is_plotted = look.course_key == look.file_key and look.moments is not None
        return is_plotted or not going.asked.wants_moments

    hands.settle()
    hands.until(found, "what the file will be")
    hands.settle()


def _shot(app: App, hands: Host, name: str) -> None:
    _wait(app, hands)
    hands.move(640, 780)
    hands.settle()
    image = Image.fromarray(hands.screenshot()).quantize(96)
    image.save(HERE / name, optimize=True)


if __name__ == "__main__":
    main()
