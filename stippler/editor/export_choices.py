"""What a person has chosen for an export; knows neither ImGui nor how it is drawn."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.errors import ParameterError, StipplerError
from stippler.files.write.formats import (
    FORMATS,
    STIPPLE,
    every_option,
    format_of,
    options_of,
)

if TYPE_CHECKING:
    from stippler.drawing.page import Page
    from stippler.files.checks import Process
    from stippler.files.write.format import Format
    from stippler.files.write.options import Option, Value

OFFERED = tuple(one for one in FORMATS if one is not STIPPLE)
ENDINGS = tuple(ending for one in OFFERED for ending in one.endings)
_BY_PROFILE = ("print_width", "dpi", "bits")


@dataclass(frozen=True, slots=True)
class ProfileChoice:
    """A publisher's column, as one choice."""

    text: str
    profile: str | None
    column: str | None


@dataclass(slots=True)
class Choices:
    """The file and everything about it.

    Attributes
    ----------
    path : str
        As it is typed; its ending chooses the format.
    given : dict
        Values of options that a person has set, of all formats.
    least_dot_mm, least_gap_mm, gain_mm : float or None
        What print can do; None is the profile's or the press's, or a common value.
    """

    path: str
    given: dict[str, Value] = field(default_factory=dict)
    least_dot_mm: float | None = None
    least_gap_mm: float | None = None
    gain_mm: float | None = None

    @property
    def file(self) -> Path:
        """The path, from the person's home on."""
        return Path(self.path).expanduser()

    @property
    def form(self) -> Format | None:
        """The format of the path's ending; None where that is none."""
        try:
            one = format_of(self.file)
        except StipplerError:
            return None
        return one if one in OFFERED else None

    def choose_format(self, one: Format) -> None:
        """Give the path a format's ending."""
        if self.form is not one:
            self.path = _with_ending(self.path, one.endings[0])

    # --- options ------------------------------------------------------------------------------

    def set(self, name: str, value: Any) -> None:
        """Set an option; its default takes it out again.

        Raises
        ------
        ParameterError
            If the value cannot be used; what was set before stays.
        """
        option, _ = every_option()[name]
        checked = self._option(name, option).check(value)
        self.given[name] = checked
        if checked is None:
            del self.given[name]

    def _option(self, name: str, first: Option) -> Option:
        """Return an option as the chosen format has it: dpi differs by format."""
        own = options_of(self.form) if self.form else ()
        return next((one for one in own if one.name == name), first)

    def options(self) -> dict[str, Any]:
        """Return what is set of the chosen format's options, as `stippler.export.save` takes it."""
        names = {option.name for option in options_of(self.form)} if self.form else set()
        return {name: value for name, value in self.given.items() if name in names}

    def values(self) -> dict[str, Any]:
        """Return a value for each option of the format.

        Raises
        ------
        ParameterError
            If there is no format, or values do not go together.
        """
        from stippler.export import values_for

        one = self.form
        if one is None:
            raise ParameterError(self._ending_problem())
        return values_for(one, self.options())

    # --- what publishers ask for ------------------------------------------------------------------

    def choose_profile(self, choice: ProfileChoice) -> None:
        """Take over all that a publisher asks for, the kind of file too."""
        from stippler.files.write.profiles import profile_named

        for name in ("profile", "column", *_BY_PROFILE):
            self.given.pop(name, None)
        self.least_dot_mm = None
        if choice.profile is None:
            return
        self.given["profile"] = choice.profile
        if choice.column is not None:
            self.given["column"] = choice.column
        files = [f".{ending}" for ending in profile_named(choice.profile).files]
        known = [ending for ending in files if ending in ENDINGS]
        if known and self.file.suffix.lower() not in files:
            self.path = _with_ending(self.path, known[0])

    @property
    def profile(self) -> tuple[str | None, str | None]:
        """The profile and the column chosen."""
        profile, column = self.given.get("profile"), self.given.get("column")
        return (str(profile) if profile else None, str(column) if column else None)

    # --- what print can do ------------------------------------------------------------------------

    def process(self) -> Process:
        """Return what the print can do, to check the drawing by.

        Raises
        ------
        ParameterError
            If values cannot be used.
        """
        from stippler.files.checks import Process
        from stippler.files.write.profiles import profile_named

        values = self.values()
        least, gain = 0.1, 0.01
        name, _ = self.profile
        if name is not None:
            least = profile_named(name).smallest_line_mm or least
        press_gain, press_least = _press_of(values)
        if press_gain:  # dots are solved for it: they print as they are drawn
            gain = 0.0
        least = press_least or least
        one_bit = values.get("bits") == "1"
        return Process(
            values.get("print_width"),
            least if self.least_dot_mm is None else self.least_dot_mm,
            0.05 if self.least_gap_mm is None else self.least_gap_mm,
            gain if self.gain_mm is None else self.gain_mm,
            values.get("dpi") if one_bit else None,
        )

    # --- whether it can be written ----------------------------------------------------------------

    def problem(self, inputs: Iterable[Path] = (), page: Page | None = None) -> str:
        """Return in one line why it cannot be written; empty where it can."""
        if not self.path.strip():
            return "Type a name for the file"
        if self.file.is_dir():
            return f"{self.file} is a folder; type a name after it"
        if self.form is None:
            return self._ending_problem()
        if not self.file.parent.is_dir():
            return f"There is no folder {self.file.parent}"
        from stippler.export import check_output, check_size

        try:
            values = self.values()
            check_output(self.file, inputs, **values)
            if page is not None and not self.form.is_data:
                check_size(self.file, page, **values)
        except StipplerError as error:
            return str(error)
        return ""

    def _ending_problem(self) -> str:
        ending = self.file.suffix
        told = f"{ending} is no ending" if ending else "An ending is missing"
        return f"{told}; one of {', '.join(ENDINGS)}"


def _press_of(values: dict[str, Any]) -> tuple[float, float]:
    gain, least = values.get("gain"), values.get("least_dot")
    if values.get("press") is not None:
        from stippler.files.presses import press_named

        press = press_named(values["press"])
        gain = press.gain_mm if gain is None else gain
        least = press.least_dot_mm if least is None else least
    return gain or 0.0, least or 0.0


def _with_ending(path: str, ending: str) -> str:
    """Return a path with another ending; what only looks like one stays."""
    name = path.rsplit("/", 1)[-1].rsplit(os.sep, 1)[-1]
    stem = Path(name).stem if Path(name).suffix.lower() in (*ENDINGS, *STIPPLE.endings) else name
    folder = path[: len(path) - len(name)]
    return f"{folder}{stem or 'drawing'}{ending}"


def profile_choices() -> list[ProfileChoice]:
    """Return every column of every publisher, each with what it asks for in one line."""
    from stippler.files.write.profiles import profiles

    choices = [ProfileChoice("None", None, None)]
    for name, one in profiles().items():
        columns: dict[str, float | None] = {**one.widths_mm} or {"": None}
        for column, width in columns.items():
            asked = [
                f"{width:g} mm" if width else "",
                f"{one.dpi:g} dpi" if one.dpi else "",
                f"{one.bits} bit" if one.bits else "",
            ]
            told = ", ".join(part for part in asked if part) or ", ".join(one.files)
            of = f", {column}" if column else ""
            choices.append(ProfileChoice(f"{one.title}{of}: {told}", name, column or None))
    return choices
