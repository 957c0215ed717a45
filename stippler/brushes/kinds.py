"""The types of brushes: what each does, how it is paced, and its parameters."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from stippler.drawing.parameter import Parameter, by_default

Rhythm = Literal["click", "arc", "time", "drag"]
Value = float | str | bool


@dataclass(frozen=True, slots=True)
class Kind:
    """A type of brush.

    Attributes
    ----------
    rhythm : {"click", "arc", "time", "drag"}
        Whether it acts once a press, by arc length, by time, or on what is dragged.
    key : str
        One letter.
    previews : bool
        Whether what it would do can be shown before it is done.
    most_ticks : int
        For one that makes `per_s` whole steps a second: as many at one call, a machine that is
        behind drops the rest. 0 is for those that do as much a second, whatever the steps.
    inverse : str
        The type that does the opposite; what both have is the same.
    opposite : (str, mapping) or None
        A parameter, and for values of it those that do the opposite.
    nothing : str
        Said where a stroke has changed nothing; with the brush's values in braces.
    """

    name: str
    label: str
    key: str
    rhythm: Rhythm
    tip: str
    parameters: tuple[Parameter, ...] = ()
    previews: bool = False
    most_ticks: int = 0
    inverse: str = ""
    opposite: tuple[str, Mapping[str, str]] | None = None
    nothing: str = ""

    @property
    def has_tip(self) -> bool:
        """Whether it has an outline of its own and works along a stroke."""
        return self.rhythm in ("arc", "time")

    def parameter(self, name: str) -> Parameter:
        """Find a parameter."""
        return next(p for p in self.parameters if p.name == name)


_STRENGTH = by_default("strength", "Strength", 100.0, "Share of the effect.", 1.0, 100.0, "%")
_RADIUS = by_default("dot_mm", "Dot radius", 0.2, "Radius of new dots in mm.", 0.02, 2.0, "mm")
_DOTS_PER_S = by_default(
    "per_s", "Dots / s", 200.0, "Dots a second, however fast the brush moves.", 1, 5000
)

KINDS: tuple[Kind, ...] = (
    Kind(
        "add",
        "Add a dot",
        "a",
        "click",
        "Adds one dot where you click.",
        (_RADIUS,),
        inverse="remove",
    ),
    Kind(
        "spray",
        "Spray dots",
        "s",
        "time",
        "Adds dots evenly over the tip for as long as you hold.",
        (
            _DOTS_PER_S,
            _RADIUS,
            by_default(
                "apart_mm",
                "Distance",
                0.4,
                "Least distance to other dots in mm; 0 is none.",
                0,
                5,
                "mm",
            ),
            by_default(
                "by_tone", "Follow the picture", False, "Fewer dots where the picture is light."
            ),
        ),
        inverse="thin",
        nothing="no room for more dots: they keep {apart_mm:g} mm from all others; lower Distance",
    ),
    Kind(
        "remove",
        "Remove a dot",
        "x",
        "click",
        "Removes the dot nearest to where you click.",
        inverse="add",
    ),
    Kind(
        "thin",
        "Thin out",
        "h",
        "time",
        "Removes dots at random for as long as you hold.",
        (_DOTS_PER_S,),
        inverse="spray",
    ),
    Kind("erase", "Erase", "e", "arc", "Removes all dots under the tip."),
    Kind(
        "fix",
        "Fix",
        "i",
        "arc",
        "Fixes dots: they stay where they are from now on.",
        inverse="unfix",
    ),
    Kind("unfix", "Free", "u", "arc", "Frees fixed dots.", inverse="fix"),
    Kind(
        "relax",
        "Relax",
        "l",
        "time",
        "Evens out the spacing for as long as you hold.",
        (
            _STRENGTH,
            by_default("per_s", "Steps / s", 30.0, "Relaxation steps a second.", 1, 60),
            by_default(
                "by_tone", "Keep the tone", True, "Dots stay denser where the picture is darker."
            ),
        ),
        most_ticks=6,
    ),
    Kind(
        "jitter",
        "Jitter",
        "j",
        "arc",
        "Shifts dots a little, at random.",
        (
            by_default("amount", "Amount", 20.0, "In percent of the measure below.", 1, 200, "%"),
            by_default(
                "measure",
                "Measure",
                "distance",
                "The mean distance of the dots under the tip; or the root of each dot's cell "
                "area, which moves dense regions less.",
                options=("distance", "cell"),
            ),
        ),
    ),
    Kind(
        "size",
        "Size",
        "b",
        "arc",
        "Makes dots larger, smaller, or a given size.",
        (
            by_default(
                "how",
                "How",
                "enlarge",
                "By a percentage at each stamp, towards a value, or towards the picture's tone.",
                options=("enlarge", "reduce", "set", "tone"),
            ),
            by_default(
                "amount",
                "Amount",
                5.0,
                "Change at each stamp, in percent.",
                0.5,
                100,
                "%",
                only=("how", ("enlarge", "reduce", "tone")),
            ),
            by_default(
                "dot_mm", "Dot radius", 0.25, "In mm.", 0.02, 2.0, "mm", only=("how", ("set",))
            ),
        ),
        previews=True,
        opposite=("how", {"enlarge": "reduce", "reduce": "enlarge"}),
    ),
    Kind(
        "shape",
        "Shape",
        "w",
        "arc",
        "Deforms dots, or makes them round again.",
        (
            by_default(
                "how",
                "How",
                "stretch",
                "What to change.",
                options=("stretch", "round", "roughen", "smooth"),
            ),
            by_default("amount", "Amount", 10.0, "Change at each stamp, in percent.", 1, 100, "%"),
            by_default(
                "along",
                "Along",
                "stroke",
                "Direction of the stretch: the stroke's own, a set angle, the edges of the "
                "picture, or each dot's own at random.",
                options=("stroke", "angle", "edge", "random"),
                only=("how", ("stretch",)),
            ),
            by_default(
                "angle",
                "Angle",
                0.0,
                "Clockwise from the right, in degrees.",
                0,
                180,
                "°",
                only=("along", ("angle",)),
            ),
        ),
        previews=True,
        opposite=(
            "how",
            {"stretch": "round", "round": "stretch", "roughen": "smooth", "smooth": "roughen"},
        ),
    ),
    Kind("drag", "Drag a dot", "g", "drag", "Moves the dot nearest to where you press."),
    Kind("push", "Push", "k", "arc", "Takes dots along with the stroke.", (_STRENGTH,)),
    Kind(
        "comb",
        "Comb",
        "c",
        "arc",
        "Draws dots into lines along the stroke.",
        (
            by_default("strength", "Strength", 15.0, "Share of the way, a stamp.", 1, 100, "%"),
            by_default("teeth_mm", "Teeth", 1.0, "Distance of the lines in mm.", 0.1, 20, "mm"),
        ),
    ),
)

_BY_NAME = {kind.name: kind for kind in KINDS}


def kind_of(name: str) -> Kind:
    """Find a type of brush by its name; KeyError if there is none."""
    return _BY_NAME[name]
