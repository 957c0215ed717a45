"""The editor's commands, each with its keys; one module for what belongs together."""

from __future__ import annotations

from stippler.editor.commands import Commands
from stippler.ui.actions.areas import area_commands
from stippler.ui.actions.files import edit_commands, file_commands, help_commands, work_commands
from stippler.ui.actions.lines import line_commands
from stippler.ui.actions.nodes import node_commands
from stippler.ui.actions.parts import Parts
from stippler.ui.actions.patterns import pattern_commands
from stippler.ui.actions.tools import selection_commands, tool_commands
from stippler.ui.actions.views import panel_commands, view_commands

__all__ = ["Parts", "commands_for"]


def commands_for(parts: Parts) -> Commands:
    """Make the commands of an editor."""
    makers = (
        file_commands,
        edit_commands,
        selection_commands,
        work_commands,
        line_commands,
        pattern_commands,
        area_commands,
        node_commands,
        tool_commands,
        view_commands,
        panel_commands,
        help_commands,
    )
    return Commands([command for make in makers for command in make(parts)])
