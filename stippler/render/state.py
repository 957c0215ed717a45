"""The GL state a pass needs, set in full, so that nothing depends on what ran before."""

from __future__ import annotations

from typing import Any, Literal

import moderngl

from stippler.camera import Size

Blending = Literal["none", "over", "add", "most"]


def set_state(ctx: moderngl.Context, blending: Blending, *, sprites: bool = False) -> None:
    """Set blending and whether shaders give points their size; depth, culling and all else off."""
    gl: Any = ctx  # moderngl's stubs type these setters by their getters
    flags = moderngl.NOTHING if blending == "none" else moderngl.BLEND
    gl.enable_only(flags | (moderngl.PROGRAM_POINT_SIZE if sprites else 0))
    gl.blend_equation = moderngl.MAX if blending == "most" else moderngl.FUNC_ADD
    if blending in ("add", "most"):
        gl.blend_func = moderngl.ONE, moderngl.ONE
    else:
        over = moderngl.ONE_MINUS_SRC_ALPHA  # an opaque target stays opaque
        gl.blend_func = moderngl.SRC_ALPHA, over, moderngl.ONE, over
    gl.wireframe = False


def set_target(ctx: moderngl.Context, framebuffer: moderngl.Framebuffer, size_px: Size) -> None:
    """Draw into a framebuffer's lower left corner of this size, every channel; ready to clear."""
    ctx.enable_only(moderngl.NOTHING)  # discarding would discard clearing too
    target: Any = framebuffer
    target.use()
    target.scissor = None
    target.viewport = (0, 0, *size_px)
    target.color_mask = True, True, True, True


def release_target(ctx: moderngl.Context, framebuffer: moderngl.Framebuffer) -> None:
    """Free a framebuffer, its attachments too; one in use would be bound again when it is gone."""
    ctx.detect_framebuffer(0).use()
    attachments = framebuffer.color_attachments
    framebuffer.release()
    for attachment in attachments:
        attachment.release()
