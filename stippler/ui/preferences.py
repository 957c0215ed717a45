"""What the editor keeps from one start to the next, as JSON in the settings folder."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from stippler.drawing.drawing import MAX_PAGE_MM
from stippler.drawing.picture_values import TONES
from stippler.drawing.style import PARAMETERS, Style
from stippler.editor.saving import MOST_AUTOSAVE_MIN, MOST_BACKUPS, Wishes
from stippler.settings import put_aside, read_document, write_document, write_text
from stippler.ui.look import Look
from stippler.ui.theme import DARK, LIGHT
from stippler.ui.window.placement import Place

if TYPE_CHECKING:
    from stippler.editor.session import Session

FILE, LAYOUT_FILE = "preferences.json", "layout.ini"
SCALES = (0.75, 3.0)
N_RECENT = 10
_VERSION = 1
_THEMES = {theme.name: theme for theme in (LIGHT, DARK)}
_PLAIN = (bool, int, float, str)
_NOT_KEPT = ("seed",)  # the same command draws the same picture


@dataclass(slots=True)
class Preferences:
    """All that is kept, but for keys and brushes, which have files of their own.

    Attributes
    ----------
    folder : Path or None
        Where it is kept; None keeps nothing.
    values : dict
        Tone, width of the page, and the style's fields, as last used.
    closed : list of str
        Names of the panels that are not shown.
    recent : list of Path
        Pictures, the last one first.
    ran : list of str
        Commands run from the palette, the last one first.
    layout : str
        Where the panels are, as ImGui writes it down.
    problem : str
        What was wrong with the files, if anything.
    """

    folder: Path | None = None
    look: Look = field(default_factory=Look)
    values: dict[str, Any] = field(default_factory=dict)
    place: Place = field(default_factory=Place)
    saving: Wishes = field(default_factory=Wishes)
    closed: list[str] = field(default_factory=list)
    recent: list[Path] = field(default_factory=list)
    ran: list[str] = field(default_factory=list)
    layout: str = ""
    layout_scale: float = 0.0
    problem: str = ""
    _written: tuple[dict[str, Any], str] | None = None

    @classmethod
    def load(cls, folder: Path) -> Preferences:
        """Read what is kept in a folder; what cannot be used is told in `problem`."""
        document, problem = read_document(folder / FILE)
        made = cls(folder, problem=problem)
        made._take(document)
        try:
            made.layout = (folder / LAYOUT_FILE).read_text(encoding="utf-8")
        except FileNotFoundError:
            pass
        except (OSError, ValueError) as error:
            aside = put_aside(folder / LAYOUT_FILE)
            made._complain(
                f"{LAYOUT_FILE} cannot be read ({error}); the panels are as at first, "
                f"and it is kept as {aside}"
            )
        return made

    def keep(self) -> None:
        """Write what has changed since the last time.

        Raises
        ------
        StipplerError
            If it cannot be written.
        """
        document = self._document()
        if self.folder is None or (document, self.layout) == self._written:
            return
        write_document(self.folder / FILE, document)
        if self.layout:
            write_text(self.folder / LAYOUT_FILE, self.layout)
        self._written = (document, self.layout)

    # --- values of a drawing to come ----------------------------------------------------------

    def begin(
        self, style: Style, tone: str, width_mm: float, given: Collection[str]
    ) -> tuple[Style, str, float]:
        """Return what to begin with: what was `given`, by name, and else what was used last."""
        sized = {"n_dots", "size_range_mm", "density_per_cm2"}
        skipped = {*given, *(sized if sized & set(given) else ())}
        kept = {name: value for name, value in self.values.items() if name not in skipped}
        tone, width_mm = kept.pop("tone", tone), kept.pop("width_mm", width_mm)
        return replace(style, **kept), tone, width_mm

    def note_values(self, session: Session) -> None:
        """Take note of the values in use."""
        names = [about.name for about in PARAMETERS if about.name not in _NOT_KEPT]
        style = {name: getattr(session.style, name) for name in names}
        self.values = {"tone": session.tone, "width_mm": session.width_mm, **style}

    # --- lists --------------------------------------------------------------------------------

    def note_opened(self, path: Path) -> None:
        """Put a picture at the head of the recent ones."""
        path = path.absolute()
        self.recent = [path, *(other for other in self.recent if other != path)][:N_RECENT]

    def note_ran(self, name: str) -> None:
        """Put a command at the head of the recent ones."""
        self.ran = [name, *(other for other in self.ran if other != name)][:N_RECENT]

    # --- as a document ------------------------------------------------------------------------

    def _document(self) -> dict[str, Any]:
        look = {f.name: getattr(self.look, f.name) for f in fields(Look)}
        look = {name: value for name, value in look.items() if isinstance(value, _PLAIN)}
        return {
            "version": _VERSION,
            "look": {**look, "theme": self.look.theme.name},
            "values": self.values,
            "window": self.place.as_dict(),
            "saving": asdict(self.saving),
            "closed_panels": self.closed,
            "recent_files": [str(path) for path in self.recent],
            "recent_commands": self.ran,
            "layout_scale": self.layout_scale,
        }

    def _take(self, document: dict[str, Any]) -> None:
        """Take each part that can be used; the others are as at first."""
        parts: dict[str, Callable[[Any], None]] = {
            "look": self._take_look,
            "values": self._take_values,
            "window": self._take_place,
            "saving": self._take_saving,
            "closed_panels": self._take_closed,
            "recent_files": self._take_recent,
            "recent_commands": self._take_ran,
            "layout_scale": self._take_layout_scale,
        }
        for name, take in parts.items():
            if name in document:
                try:
                    take(document[name])
                except (ValueError, TypeError, KeyError, AttributeError) as error:
                    self._complain(f"{FILE}: {name!r} cannot be used ({error}); it is as at first")

    def _complain(self, text: str) -> None:
        self.problem = self.problem or f"{self.folder}: {text}"

    def _take_look(self, data: dict[str, Any]) -> None:
        self.look.theme = _THEMES.get(data.get("theme", ""), LIGHT)
        for about in fields(Look):
            value, now = data.get(about.name), getattr(self.look, about.name)
            if isinstance(now, _PLAIN) and value is not None:
                setattr(self.look, about.name, _like(now, value))
        scale = self.look.scale
        self.look.scale = min(max(scale, SCALES[0]), SCALES[1]) if scale > 0 else 0.0
        self.look.opacity = min(max(self.look.opacity, 0.0), 1.0)

    def _take_values(self, data: dict[str, Any]) -> None:
        if not data:  # none were ever in use
            return
        known = {about.name for about in PARAMETERS} - set(_NOT_KEPT)
        values = {name: value for name, value in data.items() if name in known}
        style = Style.from_json(values)  # raises what a bad value deserves
        values = {name: getattr(style, name) for name in values}
        tone, width_mm = data.get("tone", TONES[0]), _like(0.0, data["width_mm"])
        if tone not in TONES or not 0 < width_mm <= MAX_PAGE_MM:
            raise ValueError(f"{tone}, {width_mm:g} mm")
        self.values = {"tone": tone, "width_mm": width_mm, **values}

    def _take_place(self, data: dict[str, Any]) -> None:
        self.place = Place.from_dict(data)

    def _take_saving(self, data: dict[str, Any]) -> None:
        first, most = Wishes(), {"n_backups": MOST_BACKUPS, "autosave_min": MOST_AUTOSAVE_MIN}
        for about in fields(Wishes):
            usual = getattr(first, about.name)
            value = _like(usual, data.get(about.name, usual))
            if about.name in most:
                value = min(max(value, 0), most[about.name])
            setattr(self.saving, about.name, value)

    def _take_closed(self, names: list[Any]) -> None:
        self.closed = [str(name) for name in names]

    def _take_recent(self, paths: list[Any]) -> None:
        self.recent = [Path(_like("", path)) for path in paths][:N_RECENT]

    def _take_ran(self, names: list[Any]) -> None:
        self.ran = [_like("", name) for name in names][:N_RECENT]

    def _take_layout_scale(self, scale: Any) -> None:
        scale = _like(0.0, scale)
        if scale and not 0.1 <= scale <= 10.0:  # 0 is of a layout never kept
            raise ValueError(f"{scale:g} is no scale")
        self.layout_scale = scale


def _like(pattern: Any, value: Any) -> Any:
    """Return a value of the pattern's type.

    Raises
    ------
    ValueError
        If it is of another.
    """
    if isinstance(pattern, float) and isinstance(value, int) and not isinstance(value, bool):
        try:
            value = float(value)
        except OverflowError as error:
            raise ValueError("no finite number") from error
    if type(value) is not type(pattern):
        raise ValueError(f"{value!r} is not of the right kind")
    if isinstance(value, float) and not math.isfinite(value):
        raise ValueError("no finite number")
    return value
