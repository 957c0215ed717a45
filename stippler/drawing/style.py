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
    Choice("pulse-density", "By the picture", "Follows the picture best (pulse-density)."),
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
    Choice("lloyd", "Even, with rows", "Lloyd's relaxation alone; rows grow, like cloth."),
    Choice("hexagonal", "Hexagonal grid", "At equal distances; sizes alone carry the tone."),
    Choice("square", "Square grid", "At equal distances; sizes alone carry the tone."),
    Choice("along", "Rows along a direction", "Strokes of dots, closer in the dark."),
    Choice("delaunay-mean", "Mean of neighbours", "Each dot goes to the middle of its neighbours."),
    Choice("springs", "Springs", "Neighbours push and pull each other."),
)
_JITTERS = (
    Choice("spacing", "Spacing", "As far everywhere, by the mean spacing."),
    Choice("cell", "Cell", "By each dot's own cell: dots in the dark move less."),
)
AUTOMATIC, WALL, THROUGH, BLEED = "automatic", "wall", "through", "bleed"
AS_STYLE = ""
"""What the border of an area is that leaves it to its style."""

_BORDERS = (
    Choice(AUTOMATIC, "Automatic", "Dots run off the page's edge; other borders are walls."),
    Choice(WALL, "Wall", "Dots line up along the border, at the page's edge too."),
    Choice(
        THROUGH, "Through",
        "Neighbours of one style that are processed together are drawn as one, without a seam.",
    ),
    Choice(BLEED, "Bleed", "Dots run off all of the border, as off the edge of a page."),
)  # fmt: skip
_DIRECTIONS = (
    Choice("pen", "Pen's", "As the pen has it."),
    Choice("set", "Set", "Along the direction given."),
    Choice("edges", "Edges", "Along the edges of the picture; along the direction on flat ground."),
)
WHITE_ON_BLACK = "white-on-black"
_POLARITIES = (
    Choice("black-on-white", "Black on white", "Dots of ink on paper."),
    Choice(WHITE_ON_BLACK, "White on black", "Dots of paper left in a ground of ink."),
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
    density_per_cm2: float | None = parameter(
        Kind.NUMBER, None, "Density", "Dots per square centimetre, instead of a number.",
        low=0.01, high=1e6, unit="/cm²", may_lack=True, keyword="density",
    )  # fmt: skip
    iterations: int = parameter(
        Kind.WHOLE, 20, "Evening out", "Steps of relaxation; each evens out the spacing a little "
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
        "relaxation alone, which grows rows, like cloth; in a grid or in rows along a direction; "
        "or by the paper's comparisons.", choices=_SPACINGS,
    )  # fmt: skip
    jitter: float = parameter(
        Kind.NUMBER, 0.0, "Jitter", "Moves each dot by chance, by up to so much of a spacing.",
        low=0.0, high=100.0, unit="%",
    )  # fmt: skip
    jitter_by: str = parameter(
        Kind.CHOICE, "cell", "Jitter by", "What the jitter is a share of.", choices=_JITTERS,
        is_more=True,
    )  # fmt: skip
    direction_deg: float = parameter(
        Kind.NUMBER, 0.0, "Direction", "Of rows, long dots and grain, clockwise from the "
        "horizontal.", low=-90.0, high=90.0, unit="°", keyword="direction",
    )  # fmt: skip
    pen: str = parameter(
        Kind.CHOICE, DEFAULT_PEN, "Pen", "Whose shapes the dots have.", choices=_PENS,
    )  # fmt: skip
    elongation: float = parameter(
        Kind.NUMBER, 1.0, "Long dots", "How much longer than wide dots are; 1 leaves the pen's.",
        low=1.0, high=4.0,
    )  # fmt: skip
    direction_by: str = parameter(
        Kind.CHOICE, "pen", "Lie along", "What long dots lie along.", choices=_DIRECTIONS,
    )  # fmt: skip
    size_noise: float = parameter(
        Kind.NUMBER, 0.0, "Mottling", "How much larger and smaller dots get from place to place, "
        "as in stone and wood.", low=0.0, high=100.0, unit="%",
    )  # fmt: skip
    size_noise_mm: float = parameter(
        Kind.NUMBER, 6.0, "Mottles", "How wide such places are.", low=0.1, high=1_000.0,
        unit="mm", is_more=True, keyword="size_noise_width",
    )  # fmt: skip
    size_noise_stretch: float = parameter(
        Kind.NUMBER, 1.0, "Grain", "How much longer such places are along the direction.",
        low=1.0, high=50.0, is_more=True,
    )  # fmt: skip
    tone_white: float = parameter(
        Kind.NUMBER, 0.0, "Paper up to", "Tones up to this darkness stay paper.",
        low=0.0, high=0.95, is_more=True,
    )  # fmt: skip
    tone_black: float = parameter(
        Kind.NUMBER, 1.0, "Deepest from", "Tones from this darkness on get the deepest ink.",
        low=0.05, high=1.0, is_more=True,
    )  # fmt: skip
    tone_gamma: float = parameter(
        Kind.NUMBER, 1.0, "Middle tones", "Above 1 they get lighter, below 1 darker.",
        low=0.2, high=5.0, is_more=True,
    )  # fmt: skip
    tone_deepest: float = parameter(
        Kind.NUMBER, 1.0, "Deepest ink", "Share of the paper that ink covers at most.",
        low=0.05, high=1.0, is_more=True,
    )  # fmt: skip
    polarity: str = parameter(
        Kind.CHOICE, "black-on-white", "Polarity", "Black dots on white paper, or white dots on a "
        "ground of ink.", choices=_POLARITIES, is_more=True,
    )  # fmt: skip
    border: str = parameter(
        Kind.CHOICE, AUTOMATIC, "Border", "What its border is to the dots of an area that "
        "says nothing else itself.",
        choices=_BORDERS, is_more=True,
    )  # fmt: skip
    name: str = ""

    @property
    def is_inverse(self) -> bool:
        """Whether dots are white on a ground of ink."""
        return self.polarity == WHITE_ON_BLACK

    @property
    def is_grid(self) -> bool:
        """Whether dots lie at equal distances, and their sizes alone carry the tone."""
        return self.spacing in ("hexagonal", "square")

    @property
    def is_relaxed(self) -> bool:
        """Whether dots are evened out after they are set."""
        return self.spacing in RELAXATIONS

    @property
    def relaxation(self) -> str:
        """How dots are evened out: as the spacing says, or evenly where that is none."""
        return self.spacing if self.is_relaxed else "even"

    @property
    def has_curve(self) -> bool:
        """Whether the tones of the picture are changed."""
        tones = (self.tone_white, self.tone_black, self.tone_gamma, self.tone_deepest)
        return tones != (0.0, 1.0, 1.0, 1.0)

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
        given = {BY_WORD[word].name: value for word, value in keywords.items()}
        for one, other in (_COUNTED, _COUNTED[::-1]):
            if given.get(one) is not None and given.get(other) is None:
                kept[other] = None  # what is given counts before the base's
        return cls(**kept | given)

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
        if self.sizes == "regions" and not self.is_relaxed:
            raise ParameterError(
                f"{self.spacing} has no regions", "sizes", "take another spacing, or sizes by tone"
            )
        if self.n_dots is not None and self.density_per_cm2 is not None:
            raise ParameterError("stands beside a number of dots", "density", "give one of them")
        if not self.tone_white < self.tone_black:
            raise ParameterError(
                f"{self.tone_white:g} is not below {self.tone_black:g}", "tone white",
                "give less than tone black",
            )  # fmt: skip


PARAMETERS: tuple[Parameter, ...] = parameters_of(Style)
BY_WORD = {about.word: about for about in PARAMETERS}
"""The parameters by what Python calls them."""

_COUNTED = ("n_dots", "density_per_cm2")
_FIELDS = tuple(field.name for field in fields(Style))


def parameter_of(name: str) -> Parameter:
    """Return a parameter by the name of its field."""
    return next(one for one in PARAMETERS if one.name == name)


FIRST_DOTS = parameter_of("first_dots").values
GROWTHS = parameter_of("growth").values
STARTS = parameter_of("start").values
BORDERS = parameter_of("border").values
RELAXATIONS = ("even", "lloyd", "delaunay-mean", "springs")
"""Those spacings that even dots out; the others set them where they stay."""

SPACINGS = parameter_of("spacing").values
