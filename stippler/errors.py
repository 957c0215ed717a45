"""Errors a person or a file can cause; programmers' errors stay ordinary exceptions."""

from __future__ import annotations

from stippler.names import shown


class StipplerError(Exception):
    """What went wrong, where, and what to do, in one line.

    Parameters
    ----------
    what : str
        The problem, as a short clause.
    where : str, optional
        The file, option or part of the drawing concerned.
    do : str, optional
        The next step for the person who reads it.
    """

    def __init__(self, what: str, where: object = "", do: str = "") -> None:
        self.what, self.where, self.do = what, str(where), do
        head = f"{self.where}: {what}" if self.where else what
        super().__init__(shown(" ".join(f"{head}; {do}".split() if do else head.split())))


class ParameterError(StipplerError, ValueError):
    """A value outside its range, or of the wrong kind."""


class GeometryError(StipplerError, ValueError):
    """A polygon or set of dots that no drawing can be made of."""


class PictureError(StipplerError):
    """A picture that cannot be read."""


class TableError(StipplerError):
    """A table of dots that cannot be read."""


class HistoryError(StipplerError):
    """A step of the history that is lost."""


class DrawingFileError(StipplerError):
    """A drawing or journal that cannot be read."""


class OutputError(StipplerError, OSError):
    """A file that cannot be written."""

    def __str__(self) -> str:
        return str(self.args[0])


class DisplayError(StipplerError):
    """No window or no OpenGL where one is needed."""


class StipplerWarning(UserWarning):
    """What is to be known of a job or a file, and hinders neither."""
