"""What the panels' controls are called, that the palette may find them, and what it wants."""

from __future__ import annotations

from dataclasses import dataclass

NUMBER, CHOICE, CHECK = "number", "choice", "check"


@dataclass(frozen=True, slots=True)
class Field:
    """A control of a panel, as it was drawn last.

    Attributes
    ----------
    kind : {"number", "choice", "check"}
    options : tuple of str
        Of a choice.
    chosen : int
        Which of them; of a check, whether it is on.
    """

    panel: str
    label: str
    kind: str
    options: tuple[str, ...] = ()
    chosen: int = 0
    unit: str = ""


class Fields:
    """The controls of all panels, and wishes that the next drawing of one fulfils.

    Attributes
    ----------
    panel : str
        The one that is drawn; empty outside panels, where nothing is noted.
    is_survey : bool
        Whether panels are drawn out of sight, only to be known.
    is_watched : bool
        Whether somebody, such as scripted hands, wants to know where each control is.
    """

    def __init__(self) -> None:
        self.panel = ""
        self.is_survey = self.is_watched = False
        self._known: dict[tuple[str, str], Field] = {}
        self._wishes: dict[tuple[str, str], str | int] = {}

    def forget(self) -> None:
        """Know nothing, before the panels are looked through anew."""
        self._known.clear()

    @property
    def known(self) -> list[Field]:
        """All controls, in the order of their panels."""
        return list(self._known.values())

    @property
    def has_wishes(self) -> bool:
        """Whether something is wished of the panel that is drawn."""
        return any(panel == self.panel for panel, _ in self._wishes)

    def wish(self, field: Field, value: str | int) -> None:
        """Ask for a value: a text for a number (an empty one opens it), an option's place."""
        self._wishes[field.panel, field.label] = value

    def wished(
        self,
        label: str,
        kind: str,
        options: tuple[str, ...] = (),
        chosen: int = 0,
        unit: str = "",
    ) -> str | int | None:
        """Note a control that is drawn; return what is wished of it, once."""
        if not self.panel:
            return None
        self._known[self.panel, label] = Field(self.panel, label, kind, options, chosen, unit)
        return None if self.is_survey else self._wishes.pop((self.panel, label), None)
