"""Drawings to pixels without a window."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from stippler.camera import Camera, Size
from stippler.drawing.drawing import Drawing
from stippler.drawing.visible import shown
from stippler.errors import DisplayError, ParameterError
from stippler.render.frame import Frame
from stippler.render.ink import MARGIN_PX
from stippler.render.paper import Color
from stippler.render.renderer import Renderer
from stippler.render.state import release_target

MAX_SIDE_PX = 100_000
_MOST_DEVICES = 16
_STRIP_PX = 4_000_000  # pixels in one strip
_LEAST_ROWS = 16

WHITE: Color = (1.0, 1.0, 1.0)
BLACK: Color = (0.0, 0.0, 0.0)


def is_software(ctx: moderngl.Context) -> bool:
    """Return whether a context's driver draws on the CPU."""
    name = ctx.info["GL_RENDERER"].lower()
    return any(driver in name for driver in ("llvmpipe", "softpipe", "swrast", "swiftshader"))


def open_gpu_context() -> moderngl.Context:
    """Open a context on the first EGL device that is a GPU; on the first of all without one.

    Raises
    ------
    DisplayError
        If there is no OpenGL 3.3 to be had.
    """
    ctx = open_context()
    create: Any = moderngl.create_standalone_context
    for device in range(1, _MOST_DEVICES):
        if not is_software(ctx):
            break
        try:
            other = create(require=330, backend="egl", device_index=device)
        except Exception:  # noqa: BLE001 - no such device, or one without OpenGL 3.3
            continue
        ctx.release()
        ctx = other
    return ctx


def open_context() -> moderngl.Context:
    """Open a GL context without a window or a display.

    Raises
    ------
    DisplayError
        If there is no OpenGL 3.3 to be had.
    """
    try:
        create: Any = moderngl.create_standalone_context  # its stub mistypes the backend
        ctx: moderngl.Context = create(require=330, backend="egl")
    except Exception as error:
        raise DisplayError(
            f"no OpenGL 3.3 ({str(error).strip() or type(error).__name__})",
            do="on Debian or Ubuntu: apt install libegl1 libegl-mesa0 libgl1 libgl1-mesa-dri"
            " libglx-mesa0",
        ) from error
    return ctx


def image_size(drawing: Drawing, px_per_mm: float) -> Size:
    """Return the (width, height) in pixels of the page at a scale."""
    page = drawing.page
    longest = max(page.width_mm, page.height_mm) * px_per_mm
    if not 0.5 <= longest <= MAX_SIDE_PX:  # also catches NaN
        raise ParameterError(
            f"{px_per_mm:g} pixels a mm make no picture of this page",
            "resolution",
            f"keep its longer side between 1 and {MAX_SIDE_PX} pixels",
        )
    return max(round(page.width_mm * px_per_mm), 1), max(round(page.height_mm * px_per_mm), 1)


def render_strips(
    drawing: Drawing,
    *,
    px_per_mm: float,
    paper: Color = WHITE,
    ink: Color = BLACK,
    grey: bool = False,
    context: moderngl.Context | None = None,
) -> Iterator[NDArray[np.uint8]]:
    """Yield the picture of the page from top to bottom in strips.

    Parameters
    ----------
    px_per_mm : float
        Resolution; `stippler.units.px_per_mm` takes dots per inch.
    paper, ink : (r, g, b)
        0..1, encoded for display.
    grey : bool
        Only the first channel of paper and ink.
    context : moderngl.Context, optional
        One to draw in; else one is opened and released, and none is current afterwards.

    Yields
    ------
    (rows, width, 3) uint8, or (rows, width) if grey

    Raises
    ------
    ParameterError
        If the picture would have no pixels or more than `MAX_SIDE_PX` on a side.
    DisplayError
        If a context is to be opened and cannot be.
    """
    size = image_size(drawing, px_per_mm)
    ctx = context or open_context()
    try:
        yield from _strips(ctx, drawing, size, (paper, ink), 1 if grey else 3)
    finally:
        if context is None:
            ctx.release()


def _strips(
    ctx: moderngl.Context,
    drawing: Drawing,
    size: Size,
    colors: tuple[Color, Color],
    channels: int,
) -> Iterator[NDArray[np.uint8]]:
    paper, ink = colors
    page = drawing.page
    rows = min(max(_STRIP_PX // size[0], _LEAST_ROWS), size[1])
    columns = min(_most_columns(ctx), size[0])
    scale = max(size[0] / page.width_mm, size[1] / page.height_mm)  # the page covers all pixels
    whole = Camera((page.width_mm / 2, page.height_mm / 2), scale)
    with contextlib.ExitStack() as made:
        renderer = Renderer(ctx)
        made.callback(renderer.release)
        target = ctx.framebuffer([ctx.renderbuffer((columns, rows), channels)])
        made.callback(release_target, ctx, target)
        renderer.scene.set_drawing(shown(drawing))
        for top in range(0, size[1], rows):
            shape = (rows, size[0], channels)[: 2 if channels == 1 else 3]
            strip = np.empty(shape, np.uint8)
            for left in range(0, size[0], columns):
                camera = whole.tile((left, top), (columns, rows), size)
                frame = Frame(camera, (columns, rows), paper=paper, desk=paper, ink=ink, marks=None)
                renderer.draw(frame, target)
                data = np.frombuffer(target.read(components=channels, alignment=1), np.uint8)
                tile = data.reshape(rows, columns, *shape[2:])[::-1, : size[0] - left]
                strip[:, left : left + columns] = tile
            yield strip[: size[1] - top]


def _most_columns(ctx: moderngl.Context) -> int:
    """Return how wide a picture the context draws at once, with the ink's margins."""
    limits = [ctx.info[f"GL_MAX_{what}_SIZE"] for what in ("TEXTURE", "RENDERBUFFER")]
    return int(min(*limits, *ctx.info["GL_MAX_VIEWPORT_DIMS"])) - 2 * MARGIN_PX


def render_image(
    drawing: Drawing,
    *,
    px_per_mm: float,
    paper: Color = WHITE,
    ink: Color = BLACK,
    grey: bool = False,
    context: moderngl.Context | None = None,
) -> NDArray[np.uint8]:
    """Return the picture of the page as (height, width, 3) uint8, or (height, width) if grey.

    The parameters and errors are those of `render_strips`.
    """
    strips = render_strips(
        drawing, px_per_mm=px_per_mm, paper=paper, ink=ink, grey=grey, context=context
    )
    return np.concatenate(list(strips))
