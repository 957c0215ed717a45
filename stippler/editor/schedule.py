"""When to draw the next frame, and how long to sleep until then."""

from __future__ import annotations

import math

_FRAMES_AFTER_INPUT = 5  # a click takes ImGui three: move, press, release; then it settles
_LONGEST_SLEEP_S = 10.0
_LONGEST_REST_S = 0.25
_FREE_S = 0.02  # frames this fast need no rest


class Schedule:
    """Input is drawn at once; a worker's results only as often as leaves it time to work.

    Drawing by software takes as many cores as the worker would: between two frames that nobody
    but the worker asked for, as much time passes as the last one took.
    """

    def __init__(self) -> None:
        self._frames = _FRAMES_AFTER_INPUT
        self._waiting = False  # a worker's result has not been shown yet
        self._not_before_s = -math.inf
        self._wake_at_s = math.inf

    def note_input(self) -> None:
        """Take note of something that a person did."""
        self._frames = _FRAMES_AFTER_INPUT

    def note_result(self) -> None:
        """Take note that a worker has something to show."""
        self._waiting = True

    def wake_at(self, at_s: float) -> None:
        """Draw a frame at a time to come, or before."""
        self._wake_at_s = min(self._wake_at_s, at_s)

    def note_frame(self, began_s: float, ended_s: float, *, moving: bool) -> None:
        """Take note that a frame was drawn; `moving` asks for the next one."""
        self._frames = max(self._frames - 1, 1 if moving else 0)
        self._waiting = False
        cost = ended_s - began_s
        self._not_before_s = ended_s + min(cost, _LONGEST_REST_S) if cost > _FREE_S else -math.inf
        if self._wake_at_s <= ended_s:
            self._wake_at_s = math.inf

    @property
    def idle(self) -> bool:
        """Whether all that has happened so far has been drawn."""
        return self._frames == 0 and not self._waiting

    def due(self, now_s: float) -> bool:
        """Return whether a frame is to be drawn now."""
        if self._frames > 0 or now_s >= self._wake_at_s:
            return True
        return self._waiting and now_s >= self._not_before_s

    def sleep_s(self, now_s: float) -> float:
        """Return how long to wait for events before the next frame; 0 is not at all."""
        if self.due(now_s):
            return 0.0
        until = self._wake_at_s
        if self._waiting:
            until = min(until, self._not_before_s)
        return min(max(until - now_s, 0.0), _LONGEST_SLEEP_S)
