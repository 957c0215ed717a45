"""How an area is drawn, as it was asked for; importing it costs nothing.

Each parameter is declared once, where the class holds it: the check, the command line's options,
Python's keywords, the panels' controls and the files are all made from `PARAMETERS`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from typing import Any, Self

from stippler.drawing.parameter import Choice, Kind, Parameter, parameter, parameters_of
from stippler.errors import ParameterError

DEFAULT_DOTS = 20_000
DEFAULT_PEN = "technical-pen"
MAX_DOTS = 20_000_000

_FIRST_DOTS = (
    Choice("pulse-density", "By the picture", "Pulse density: follows the picture best."),
    Choice("floyd-steinberg", "Error diffusion", "Floyd and Steinberg's, as on a screen."),
    Choice("random", "By chance", "Anywhere, more in the dark."),
    Choice("hexagonal", "In rows", "A hexagonal grid, whatever the tone."),
)
_GROWTHS = (
    Choice("circular", "Discs", "Each dot's region grows as a disc."),
    Choice("triangular", "Triangles", "Each dot's region grows as a triangle."),
)
_STARTS = (
    Choice("top", "At the top", "The page is filled from its top."),
    Choice("border", "At borders", "The outermost dots line up with the ink's border."),
)
_SIZES = (
    Choice("tone", "Tone", "Dots are as large as it takes for the ink to meet the tone."),
    Choice(
        "regions", "Room",
        "As in the paper: dots with little room are enlarged, those with much are reduced, and "
        "those with the most are left out.",
    ),
)  # fmt: skip
_SPACINGS = (
    Choice("even", "Even, without rows"),
    Choice("lloyd", "Lloyd's, with rows"),
    Choice("delaunay-mean", "Mean of neighbours"),
    Choice("springs", "Springs"),
)
_PENS = (
    Choice("technical-pen", "Technical pen", "Round dots."),
    Choice("quill", "Quill", "Dots a little longer than wide."),
    Choice("brush", "Brush", "Long dots."),
    Choice("rough-paper", "Rough paper", "Round dots with ragged edges."),
    Choice("stick", "Stick", "Coarse dots in any direction."),
)


@dataclass(frozen=True, slots=True)
class Style:
    """How an area is drawn: what was asked for, not what came out; areas may share it.

    Its fields are those of `PARAMETERS`, and `name`, as a person calls it.
    """

    n_dots: int | None = parameter(
        Kind.WHOLE, None, "Number", "Number of dots; else as many as suit the page or the sizes.",
        low=1, high=MAX_DOTS, may_lack=True, keyword="dots",
    )  # fmt: skip
    size_range_mm: tuple[float, float] | None = parameter(
        Kind.RANGE, None, "Dot radius", "Dot radii in mm; else 1:2, as the number asks for.",
        low=0.0, unit="mm", may_lack=True, keyword="size_range",
    )  # fmt: skip
    iterations: int = parameter(
        Kind.WHOLE, 20, "Evening out", "Relaxation steps: each evens out the spacing a little "
        "more; 10 to 20 suffice.", low=0, high=100_000,
    )  # fmt: skip
    seed: int = parameter(
        Kind.WHOLE, 1, "Seed", "Chooses what is left to chance; same seed, same drawing.",
        low=0, high=2**63 - 1, is_more=True,
    )  # fmt: skip
    first_dots: str = parameter(
        Kind.CHOICE, "pulse-density", "First dots", "How dots are set before they are evened out.",
        choices=_FIRST_DOTS, is_more=True,
    )  # fmt: skip
    growth: str = parameter(
        Kind.CHOICE, "circular", "Room by", "How pulse-density regions grow.",
        choices=_GROWTHS, is_more=True, only=("first_dots", ("pulse-density",)),
    )  # fmt: skip
    start: str = parameter(
        Kind.CHOICE, "top", "First row", "Where pulse-density begins.",
        choices=_STARTS, is_more=True, only=("first_dots", ("pulse-density",)),
    )  # fmt: skip
    sizes: str = parameter(
        Kind.CHOICE, "tone", "Sizes by", "Dot sizes solved for the tone, or the paper's, by room.",
        choices=_SIZES, is_more=True, only=("first_dots", ("pulse-density",)),
    )  # fmt: skip
    weighted: bool = parameter(
        Kind.FLAG, True, "Keep the tone", "Dark parts stay dense while dots are evened out; else, "
        "as in the paper, light parts fill up.", is_more=True, flag="--unweighted",
    )  # fmt: skip
    spacing: str = parameter(
        Kind.CHOICE, "even", "Spacing", "How dots are spaced: evenly without rows; by Lloyd's "
        "relaxation alone, which grows rows, like cloth; or by the paper's comparisons.",
        choices=_SPACINGS,
    )  # fmt: skip
    pen: str = parameter(
        Kind.CHOICE, DEFAULT_PEN, "Pen", "Whose shapes the dots have.", choices=_PENS,
    )  # fmt: skip
    name: str = ""

    def to_json(self) -> dict[str, Any]:
        """Return it in JSON's types."""
        return asdict(self)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> Self:
        """Make a style of what `to_json` gave; what is left out is as at first.

        Raises
        ------
        ParameterError
            If a name or a value is unknown.
        """
        unknown = [name for name in data if name not in _FIELDS]
        if unknown:
            raise ParameterError(
                f"{unknown[0]!r} is unknown", "style", f"one of {', '.join(_FIELDS)}"
            )
        return cls(**data)

    @classmethod
    def of(cls, base: Self | None = None, **keywords: Any) -> Self:
        """Make a style of Python's keywords for its parameters; others are as in `base`.

        Raises
        ------
        ParameterError
            If a keyword or a value is unknown.
        """
        for word in keywords:
            if word not in BY_WORD:
                raise ParameterError(
                    f"{word!r} is unknown", "style", f"one of {', '.join(BY_WORD)}"
                )
        kept = {} if base is None else {name: getattr(base, name) for name in _FIELDS}
        return cls(**kept | {BY_WORD[word].name: value for word, value in keywords.items()})

    def __post_init__(self) -> None:
        for about in PARAMETERS:
            value = getattr(self, about.name)
            if value is not about.default:
                object.__setattr__(self, about.name, about.checked(value))
        if not isinstance(self.name, str):
            raise ParameterError(f"{self.name!r} is no name", "style", "give a text")
        if self.sizes == "regions" and self.first_dots != "pulse-density":
            raise ParameterError(
                f"{self.first_dots} has no regions", "sizes", "take pulse-density, or sizes by tone"
            )


PARAMETERS: tuple[Parameter, ...] = parameters_of(Style)
BY_WORD = {about.word: about for about in PARAMETERS}
"""The parameters by what Python calls them."""

_FIELDS = tuple(field.name for field in fields(Style))


def parameter_of(name: str) -> Parameter:
    """Return a parameter by the name of its field."""
    return next(one for one in PARAMETERS if one.name == name)


FIRST_DOTS = parameter_of("first_dots").values
GROWTHS = parameter_of("growth").values
STARTS = parameter_of("start").values
SIZES = parameter_of("sizes").values
SPACINGS = parameter_of("spacing").values
