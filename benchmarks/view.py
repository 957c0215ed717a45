"""The view: what the lens costs, how true its tone is, and what an adjustment costs.

``python -m benchmarks.view [--quick]``. Frames are taken in an offscreen window.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from benchmarks.figures import Figure, median_s
from benchmarks.rendering import cpu_s, drawing
from benchmarks.tone import lightness, to_linear

_SIZE = (1280, 800)
_N_DOTS = 100_000
_LENS_PX = 400


def figures(quick: bool = False) -> list[Figure]:
    """Measure all; `quick` repeats less."""
    return _lens(9 if quick else 31) + _adjustment(3 if quick else 7) + [_tone()]


def _lens(repeats: int) -> list[Figure]:
    from stippler.app import App
    from stippler.drawing.style import Style

    app = App(Style(), tone="linear", width_mm=200.0, size=_SIZE, offscreen=True)
    try:
        _open(app)
        found = []
        for lens, zoom, what in (
            ("none", 1.0, "no lens"),
            ("reduce", 1.0, "1/4, whole page seen"),
            ("reduce", 4.0, "1/4, zoomed in 4 times"),
            ("magnify", 1.0, "4 x, whole page seen"),
        ):
            app.editor.view.fit()
            app.editor.view.camera = app.editor.view.camera.zoomed(zoom, (470, 380), (940, 772))
            app.editor.look.lens = lens
            ms = 1e3 * median_s(_mover(app), repeats, warm=5)
            note = f"software GL; {1e3 * cpu_s(_mover(app), repeats):.0f} ms of CPU time"
            found.append(Figure(f"frame, pointer moving, {what}", ms, "ms", note=note))
    finally:
        app.close()
    return found


def _open(app: Any) -> None:
    """Give the editor a drawing, as a finished job would."""
    app.session.show(drawing(_N_DOTS))


def _mover(app: Any) -> Any:
    """Return a call that moves the pointer by a pixel of the strongest lens and draws the frame."""
    at = [400.0]

    def frame() -> None:
        at[0] += 8.0 if at[0] < 1200.0 else -800.0
        app.window.input.move(at[0], 400.0)
        app.editor.step()
        app.window.ctx.finish()

    return frame


def _adjustment(repeats: int) -> list[Figure]:
    from stippler.drawing.adjustment import Adjustment

    darkness = np.random.default_rng(0).random((4000, 4000), np.float32)
    every = Adjustment(0.2, 0.5, 1.5, True)
    spent_s = median_s(lambda: every.apply(darkness), repeats)
    return [Figure("adjusting a picture of 16 megapixels", spent_s, "s", note="all four")]


def _tone() -> Figure:
    """Compare a drawing through the lens with its picture, over windows of 9 pixels."""
    from scipy.ndimage import uniform_filter

    import stippler
    from stippler.camera import Camera
    from stippler.headless import open_context
    from stippler.render.frame import Frame
    from stippler.render.lens import LensPass
    from stippler.render.renderer import Renderer
    from stippler.resources import assets

    made = stippler.stipple(assets() / "samples" / "ammonite.png", dots=60_000, width=148)
    ctx = open_context()
    renderer, lens = Renderer(ctx), LensPass(ctx, _LENS_PX, 0, 1.0)
    try:
        renderer.scene.set_page(made.page.width_mm, made.page.height_mm)
        renderer.scene.set_dots(made.dots)
        middle = (made.page.width_mm / 2, made.page.height_mm / 2)
        camera = Camera(middle, _LENS_PX / made.page.width_mm)
        white, black = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
        size_px = (_LENS_PX, _LENS_PX)
        lens.draw(renderer, Frame(camera, size_px, white, white, black))
        seen = np.frombuffer(lens.texture.read(), np.uint8).reshape(_LENS_PX, _LENS_PX, 4)
    finally:
        lens.release()
        renderer.release()
        ctx.release()
    light = to_linear(seen[::-1, :, 0] / 255.0)
    both = [uniform_filter(v, 9) for v in (light, _picture_light(made.reference, camera))]
    y, x = np.mgrid[:_LENS_PX, :_LENS_PX] + 0.5 - _LENS_PX / 2
    inside = np.hypot(x, y) < _LENS_PX / 2 - 6  # of the rim
    off = (lightness(both[0]) - lightness(both[1]))[inside]
    rms = float(np.sqrt((off**2).mean()))
    return Figure("lightness in the lens off the picture's, RMS", rms, "L*", note="ammonite")


def _picture_light(reference: Any, camera: Any) -> Any:
    """Return the light of a picture over each pixel that the camera sees; white beside it."""
    n = 4 * _LENS_PX
    y, x = (np.mgrid[:n, :n] + 0.5) / 4
    size = (_LENS_PX, _LENS_PX)
    at = camera.screen_to_page(np.stack([x, y], axis=-1), size) / reference.pixel_mm
    h, w = reference.darkness.shape
    column, row = np.floor(at[..., 0]).astype(int), np.floor(at[..., 1]).astype(int)
    on_page = (column >= 0) & (column < w) & (row >= 0) & (row < h)
    darkness = reference.darkness[np.clip(row, 0, h - 1), np.clip(column, 0, w - 1)]
    light = np.where(on_page, 1.0 - darkness, 1.0)
    return light.reshape(_LENS_PX, 4, _LENS_PX, 4).mean(axis=(1, 3))


def main() -> None:
    """Print the figures."""
    for figure in figures("--quick" in sys.argv[1:]):
        print(f"{figure.name:<52}{figure.value:9.3f} {figure.unit:<4}{figure.note}")


if __name__ == "__main__":
    main()
