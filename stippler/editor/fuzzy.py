"""How well a few typed letters name something."""

from __future__ import annotations

_START, _RUN, _GAP = 8.0, 5.0, 0.15


def match(typed: str, text: str) -> float | None:
    """Return how well `typed` fits; larger is better, None is not at all.

    Every word must be found: whole, or as letters in order. Beginnings of words count most.
    """
    total = 0.0
    lower = text.lower()
    for word in typed.lower().split():
        score = _match_word(word, lower)
        if score is None:
            return None
        total += score
    return total - 0.01 * len(text)


def _match_word(word: str, text: str) -> float | None:
    at = text.find(word)
    starts = [k for k in range(len(text)) if text.startswith(word, k) and _begins(text, k)]
    if starts:
        return 3 * _START + _RUN * len(word) - _GAP * starts[0]
    if at >= 0:
        return _START + _RUN * len(word) - _GAP * at
    score, last = 0.0, -1
    for sign in word:
        found = _next(sign, text, last + 1)
        if found < 0:
            return None
        score += _START if _begins(text, found) else 0.0
        score += _RUN if found == last + 1 else 0.0
        score -= _GAP * (found - last - 1)
        last = found
    return score / 2


def _begins(text: str, k: int) -> bool:
    return k == 0 or not text[k - 1].isalnum()


def _next(sign: str, text: str, begin: int) -> int:
    """Return where a letter comes next, at the beginning of a word if it can be."""
    k = text.find(sign, begin)
    if k < 0 or k == begin:
        return k
    return next((j for j in range(k, len(text)) if text[j] == sign and _begins(text, j)), k)
