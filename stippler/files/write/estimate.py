"""How large a file will be and how long writing it takes, measured on a part of it."""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing
from stippler.files.write.format import Format, Values
from stippler.files.write.proof import Window, part_of
from stippler.files.write.raster import size_px
from stippler.files.write.sheet import Sheet

_FEW_DOTS, _SOME_DOTS = 2_500, 10_000
_BANDS = 8  # of a picture, each of so many rows of pixels
_BAND_PX = 128
_WHOLE_PX = 3_000_000  # smaller pictures are written as they are


@dataclass(frozen=True, slots=True)
class Estimate:
    """What writing takes.

    Attributes
    ----------
    n_bytes : int
        Within a quarter, of pages that are alike all over.
    seconds : float
        Within a factor of three, on a machine that does nothing else.
    """

    n_bytes: int
    seconds: float


def estimate(one: Format, what: Sheet | Drawing, values: Values) -> Estimate:
    """Estimate a file, by writing a part of it to nowhere.

    Parameters
    ----------
    what : Sheet, or Drawing where the format holds data
    """
    if isinstance(what, Sheet) and "dpi" in values:
        return _of_pixels(one, what, values)
    return _of_dots(one, what, values)


def _of_dots(one: Format, what: Any, values: Values) -> Estimate:
    """Write few and some of the dots, and go on along that line."""
    n = _n_dots(what)
    if n <= _SOME_DOTS:
        return _written(lambda: one.write(what, values))
    few, some = _thinned(what, _FEW_DOTS), _thinned(what, _SOME_DOTS)
    less = _written(lambda: one.write(few, values))
    part = _written(lambda: one.write(some, values))
    more = (n - _n_dots(some)) / max(_n_dots(some) - _n_dots(few), 1)
    return Estimate(
        round(part.n_bytes + more * (part.n_bytes - less.n_bytes)),
        part.seconds + more * max(part.seconds - less.seconds, 0.0),
    )


def _of_pixels(one: Format, sheet: Sheet, values: Values) -> Estimate:
    """Write bands of a picture that lie evenly over its height."""
    size = size_px(sheet, values["dpi"])
    if size.width * size.height <= _WHOLE_PX or size.height <= _BANDS * _BAND_PX:
        return _written(lambda: one.write(sheet, values))
    band_mm = sheet.height_mm * _BAND_PX / size.height
    tops = (np.arange(_BANDS) + 0.5) / _BANDS * sheet.height_mm - band_mm / 2
    n_bytes, seconds = 0, 0.0
    for top in tops:
        band = part_of(sheet, Window(0.0, float(top), sheet.width_mm, band_mm, 1, 1))
        made = _written(lambda band=band: one.write(band, values))  # type: ignore[misc]
        n_bytes, seconds = n_bytes + made.n_bytes, seconds + made.seconds
    share = _BANDS * _BAND_PX / size.height
    return Estimate(round(n_bytes / share), seconds / share)


def _written(chunks: Callable[[], Iterable[bytes]]) -> Estimate:
    """Write to nowhere; twice where it is quick, since first calls load what they need."""
    fastest = math.inf
    for _ in range(2):
        start = time.perf_counter()
        n_bytes = sum(map(len, chunks()))
        fastest = min(fastest, time.perf_counter() - start)
        if fastest > 0.5:
            break
    return Estimate(n_bytes, fastest)


def _n_dots(what: Sheet | Drawing) -> int:
    if isinstance(what, Sheet):
        return sum(len(layer.dots) for layer in what.layers)
    return len(what.dots)


def _thinned(what: Any, n: int) -> Any:
    """Return about so many of the dots, from all over."""
    share = n / max(_n_dots(what), 1)
    if isinstance(what, Sheet):
        layers = tuple(replace(one, dots=_some(one.dots, share)) for one in what.layers)
        return replace(what, layers=layers)
    return replace(what, dots=_some(what.dots, share))


def _some(dots: Dots, share: float) -> Dots:
    n = round(share * len(dots))
    return dots.take(np.linspace(0, len(dots), n, endpoint=False).astype(np.intp))
