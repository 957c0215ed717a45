"""Stippler: an editor for stipple drawings, and the methods behind it.

    import stippler
    drawing = stippler.stipple("photo.png", dots=60_000, width=148)
    drawing.save("photo.svg")

Nothing is imported before it is used, so that the command line starts at once.
"""

from __future__ import annotations

TYPE_CHECKING = False  # what typing has; importing it takes long enough to be interrupted in

if TYPE_CHECKING:
    from stippler.api import Drawing, fill, open, process, pulse_density, relax, stipple
    from stippler.errors import StipplerError

__all__ = [
    "Drawing", "StipplerError", "fill", "open", "process", "pulse_density", "relax", "stipple",
]  # fmt: skip


def __getattr__(name: str) -> object:
    if name == "__version__":
        from stippler import version

        return version.VERSION
    if name == "StipplerError":
        from stippler import errors

        return errors.StipplerError
    if name in __all__:
        from stippler import api

        return getattr(api, name)
    raise AttributeError(f"module 'stippler' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
