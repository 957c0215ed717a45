"""The tools, as the strip, menus and the palette show them; each is made when it is first taken.

A start imports no tool but the brushes: their modules cost more than what the first frame shows.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from importlib import import_module

from stippler.brushes.kinds import KINDS
from stippler.editor.tools.brush_shelf import BrushShelf
from stippler.editor.tools.brush_tool import BrushTool
from stippler.editor.tools.tool import Tool


@dataclass(frozen=True, slots=True)
class Card:
    """What is known of a tool before it is made.

    Attributes
    ----------
    name : str
        Unique; "select". Its command is "tool.select", and its icon is found by it.
    label, tip : str
        As the strip, menus and its panel show it, and what it does.
    key : str
        One letter, at first.
    make : callable
        Makes the tool, and imports what it needs.
    """

    name: str
    label: str
    key: str
    tip: str
    make: Callable[[], Tool]

    def made(self) -> Tool:
        """Make the tool; it is called as its card."""
        tool = self.make()
        tool.name, tool.label, tool.key, tool.tip = self.name, self.label, self.key, self.tip
        return tool


def all_cards(shelf: BrushShelf) -> tuple[Card, ...]:
    """Return a card for every tool, in the order of the strip; a new one is a line below."""
    brushes = (Card(k.name, k.label, k.key, k.tip, partial(BrushTool, k, shelf)) for k in KINDS)
    return (*brushes, *_OTHERS)


def _of(module: str, name: str) -> Callable[[], Tool]:
    """Return what makes a tool of a module beside this one."""
    return lambda: getattr(import_module(f"stippler.editor.tools.{module}"), name)()


_OTHERS = (
    Card(
        "select",
        "Select",
        "m",
        "Selects dots; Shift adds, Alt takes away. Drag what is selected, or its handles.",
        _of("select_tool", "SelectTool"),
    ),
    Card(
        "area",
        "Area",
        "o",
        "Draws the outline of an area. What it takes from, and whether it changes the chosen areas "
        "instead, is set below. Backspace takes a corner back.",
        _of("area_tool", "AreaTool"),
    ),
    Card(
        "knife",
        "Knife",
        "Shift+K",
        "Parts areas along a line: the chosen ones, or all that it crosses. The largest part keeps "
        "name and style; the others are new areas of the same style.",
        _of("knife_tool", "KnifeTool"),
    ),
    Card(
        "bucket",
        "Fill place",
        "Shift+B",
        "Click into a place that borders and drawn lines enclose: it becomes an area. The outline "
        "is seen before.",
        _of("bucket_tool", "BucketTool"),
    ),
    Card(
        "grow",
        "Grow area",
        "Shift+G",
        "Scribble within a thing of the picture, and with Alt beside it: the outline follows the "
        "tones. Enter makes an area, Backspace takes a scribble back, Esc all.",
        _of("grow_tool", "GrowTool"),
    ),
    Card(
        "proposals",
        "Propose areas",
        "Shift+O",
        "Outlines by the picture's tones, a help: a stroke across regions makes them one, a click "
        "parts a region in two, a stroke with Alt parts off what it covers. Enter makes areas of "
        "all, Backspace takes a change back.",
        _of("proposal_tool", "ProposalTool"),
    ),
    Card(
        "nodes",
        "Nodes",
        "Shift+N",
        "Edits borders and lines: drag a node, a handle or what lies between two nodes; all "
        "areas there follow. Shift chooses several, dragging beside chooses by a box. A double "
        "click adds a node, Delete removes. Alt breaks a smooth node, or keeps from snapping.",
        _of("node_tool", "NodeTool"),
    ),
    Card(
        "line",
        "Line",
        "/",
        "Pen: click for corners, drag for curves; Enter or a double click ends, a click on the "
        "start closes, Backspace takes a node back. Freehand: draw. Move: drag a line; what "
        "adheres to it goes along.",
        _of("line_tool", "LineTool"),
    ),
    Card(
        "pattern",
        "Pattern",
        "",
        "Lays polygons over the chosen area, or the page, which its dots are drawn in. Move: drag, "
        "corners scale, sides shear, the handle above turns (Shift by steps). Perspective: "
        "corners. Cage: points. Pins: click to set one, drag it; Alt and a click takes it away.",
        _of("pattern_tool", "PatternTool"),
    ),
    Card(
        "warp",
        "Warp",
        "",
        "Bends chosen dots and lines, or chosen areas with their dots, lines and borders, or all, "
        "by one cage. Dots' sizes follow, so that tone is kept; where spacing has suffered it is "
        "relaxed when you let go.",
        _of("warp_tool", "WarpTool"),
    ),
)
