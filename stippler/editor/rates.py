"""How fast frames and relaxation steps come."""

from __future__ import annotations

from collections import deque

_WINDOW_S = 1.0


class FrameRate:
    """Frames a second over the last second in which frames were drawn."""

    def __init__(self) -> None:
        self._at: deque[float] = deque(maxlen=240)

    def tick(self, now_s: float) -> None:
        """Note a frame."""
        if self._at and now_s - self._at[-1] > 0.5:  # slept: the pause is no slow frame
            self._at.clear()
        self._at.append(now_s)
        while now_s - self._at[0] > _WINDOW_S:
            self._at.popleft()

    @property
    def per_s(self) -> float:
        """The rate; 0 while it is not known."""
        if len(self._at) < 3:
            return 0.0
        return (len(self._at) - 1) / max(self._at[-1] - self._at[0], 1e-9)


class StepRate:
    """Steps a second over the last second in which steps were reported."""

    def __init__(self) -> None:
        self._at: deque[tuple[float, int]] = deque()
        self.per_s = 0.0

    def note(self, now_s: float, done: int) -> None:
        """Note how many steps are done; not every step is reported."""
        self._at.append((now_s, done))
        while now_s - self._at[0][0] > _WINDOW_S and len(self._at) > 2:
            self._at.popleft()
        (start_s, first), (end_s, last) = self._at[0], self._at[-1]
        if end_s > start_s:
            self.per_s = (last - first) / (end_s - start_s)

    def forget(self) -> None:
        """Begin anew after a pause; the rate is kept until there is a new one."""
        self._at.clear()
