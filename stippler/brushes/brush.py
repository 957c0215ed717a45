"""A brush: its type, tip and parameters, as data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field, replace
from typing import Any, Self

from stippler.brushes.kinds import KINDS, Kind, Value, kind_of
from stippler.brushes.stroke_path import SMOOTHINGS, SmoothingKind
from stippler.brushes.tip import Tip
from stippler.drawing.parameter import Parameter
from stippler.errors import ParameterError

SMALLEST_MM, LARGEST_MM = 0.05, 500.0
PRESSURES = ("none", "speed", "key")


@dataclass(frozen=True, slots=True)
class Brush:
    """One named brush.

    Attributes
    ----------
    kind : str
        Of `stippler.brushes.kinds`.
    spacing : float
        Way between stamps, as a share of the radius.
    smoothing, smoothing_mm
        How the stroke is calmed, and the length of the rope or the window.
    pressure : {"none", "speed", "key"}
        What stands in for a pen's pressure: slower is stronger, or Alt makes it light.
    values : mapping of str to value
        The kind's parameters; those left out have their defaults.
    """

    name: str
    kind: str
    radius_mm: float = 4.0
    tip: Tip = field(default_factory=Tip)
    spacing: float = 0.25
    smoothing: SmoothingKind = "none"
    smoothing_mm: float = 3.0
    pressure: str = "none"
    values: Mapping[str, Value] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if not isinstance(self.name, str):
            raise ParameterError(f"{self.name!r} is no name", "brush")
        if self.kind not in (kind.name for kind in KINDS):
            raise ParameterError(f"{self.kind!r} is no type of brush", self.name)
        for name, value, low, high in (
            ("radius", self.radius_mm, SMALLEST_MM, LARGEST_MM),
            ("spacing", self.spacing, 0.02, 4.0),
            ("smoothing", self.smoothing_mm, 0.0, 200.0),
        ):
            if not low <= value <= high:
                raise ParameterError(
                    f"{value:g} is out of range", name, f"give {low:g} to {high:g}"
                )
        if self.smoothing not in SMOOTHINGS or self.pressure not in PRESSURES:
            raise ParameterError("smoothing or pressure is unknown", self.name)
        for parameter in self.about.parameters:
            _check(parameter, self.value(parameter.name))

    @property
    def about(self) -> Kind:
        """Its type."""
        return kind_of(self.kind)

    def value(self, name: str) -> Any:
        """Return a parameter's value."""
        return self.values.get(name, self.about.parameter(name).default)

    def with_value(self, name: str, value: Value) -> Self:
        """Return a brush with one parameter changed."""
        return replace(self, values={**self.values, name: value})

    @property
    def inverted(self) -> Self | None:
        """What does the opposite, with the same tip; None where nothing does."""
        about = self.about
        if about.inverse:
            other = kind_of(about.inverse)
            known = {p.name for p in other.parameters}
            values = {name: value for name, value in self.values.items() if name in known}
            return replace(self, name=other.label, kind=other.name, values=values)
        if about.opposite:
            parameter, opposites = about.opposite
            if (value := opposites.get(self.value(parameter))) is not None:
                name = f"{self.name}, inverted"
                return replace(self.with_value(parameter, value), name=name)
        return None

    def resized(self, factor: float) -> Self:
        """Return a larger or smaller brush, within limits."""
        radius = min(max(self.radius_mm * factor, SMALLEST_MM), LARGEST_MM)
        return replace(self, radius_mm=radius)

    def as_dict(self) -> dict[str, Any]:
        """Return it as plain data."""
        return {**asdict(self), "values": dict(self.values)}

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Self:
        """Make a brush of plain data.

        Raises
        ------
        ParameterError
            If it is no brush.
        """
        try:
            tip = dict(data["tip"])
            tip["corners"] = tuple((float(x), float(y)) for x, y in tip.get("corners", ()))
            known = {p.name for p in kind_of(data["kind"]).parameters}
            values = {name: value for name, value in data["values"].items() if name in known}
            return cls(**{**data, "tip": Tip(**tip), "values": values})
        except (KeyError, TypeError, ValueError, AttributeError, OverflowError) as error:
            if isinstance(error, ParameterError):
                raise
            raise ParameterError(f"is no brush ({error})", str(data)[:40]) from error


def _check(parameter: Parameter, value: Value) -> None:
    if not parameter.allows(value):
        raise ParameterError(f"{value!r} is out of range", parameter.label)


def first_brushes() -> list[Brush]:
    """Return one brush of each type, to begin with."""
    return [Brush(kind.label, kind.name) for kind in KINDS]
