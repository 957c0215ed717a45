"""The palette's Enter counted as the lens's key: held for a moment, the lens went with it."""

from stippler.editor.events import NO_MODS, KeyDown, KeyUp
from stippler.ui.canvas.lens import LensKey
from stippler.ui.look import Look


def test_a_lens_that_no_key_holds_stays():
    look = Look()
    lens = LensKey(look)
    lens.take(KeyDown("enter", NO_MODS, False, 1.0))
    lens.let_pass()  # the palette runs its commands later in the frame
    lens.switch("reduce")
    lens.note_frame(1.0)
    lens.take(KeyUp("enter", NO_MODS, 2.0))
    assert look.lens == "reduce"


def test_a_lens_that_its_key_holds_goes_with_it():
    look = Look()
    lens = LensKey(look)
    lens.take(KeyDown("z", NO_MODS, False, 1.0))
    lens.switch("reduce")
    lens.let_pass()
    lens.note_frame(1.0)
    lens.take(KeyUp("z", NO_MODS, 2.0))
    assert look.lens == "none"
