"""Preferences, keys and brushes: read at the start, written some seconds after they change."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from stippler.editor.keymap import load_keys
from stippler.editor.messages import WARNING
from stippler.errors import StipplerError

if TYPE_CHECKING:
    from stippler.editor.commands import Commands
    from stippler.editor.session import Session
    from stippler.editor.tools.toolbox import Toolbox
    from stippler.ui.preferences import Preferences
    from stippler.ui.window.gui import Gui
    from stippler.ui.window.window import Window

_KEEP_EVERY_S = 5.0  # preferences are looked at no more often than this


class KeptChoices:
    """What a person has chosen, between the window and the disk.

    Attributes
    ----------
    may_have_changed : bool
        Since it was last looked at.
    """

    def __init__(
        self,
        kept: Preferences,
        window: Window,
        session: Session,
        gui: Gui,
        toolbox: Toolbox,
        now_s: float,
    ) -> None:
        self._kept, self._window, self._session = kept, window, session
        self._gui, self._toolbox = gui, toolbox
        self._kept_s, self._failure = now_s, ""
        self.may_have_changed = False

    def load_keys(self, commands: Commands) -> None:
        """Take the keys that a person has given commands; say what could not be read."""
        problems = [self._kept.problem]
        if self._kept.folder is not None:
            problems.append(load_keys(self._kept.folder, commands))
        for problem in filter(None, problems):
            self._session.messages.say(problem, WARNING)

    def keep(self, *, again: bool = True) -> None:
        """Write the preferences, if they have changed; `again` repeats what has failed before."""
        kept = self._kept
        kept.note_values(self._session)
        kept.place = self._window.place
        kept.layout, kept.layout_scale = self._gui.layout, self._gui.scale
        try:
            kept.keep()
        except StipplerError as error:
            if again or str(error) != self._failure:
                self._session.messages.say(str(error), WARNING)
            self._failure = str(error)

    def keep_soon(self, now_s: float) -> Iterator[float]:
        """Write what has changed some seconds ago; yield when to ask again."""
        if (at_s := self._toolbox.save_soon(now_s)) is not None:
            yield at_s
        if not self.may_have_changed:
            return
        if now_s - self._kept_s > _KEEP_EVERY_S:
            self._kept_s, self.may_have_changed = now_s, False
            self.keep(again=False)
        else:
            yield self._kept_s + _KEEP_EVERY_S + 0.01
