"""Values that a caller hands in, as numbers; what is none is refused by name."""

from __future__ import annotations

import operator
from typing import TYPE_CHECKING, Any

from stippler.errors import ParameterError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray


def floats(values: ArrayLike, name: str) -> NDArray[np.float64]:
    """Return a fresh array of real numbers; NaN is left to the caller.

    Raises
    ------
    ParameterError
        If they are none, or rows differ in length; the error calls them `name`.
    """
    import numpy as np  # here, so that a style is checked without it

    try:
        array = np.array(values)
        if array.dtype.kind not in "biufO":
            raise TypeError
        return np.array(array, np.float64, order="C")
    except (TypeError, ValueError):
        raise ParameterError(
            "is no array of numbers", name, "give real numbers in rows of one length"
        ) from None


def whole(value: Any, name: str) -> int:
    """Return an integer, or raise `ParameterError`."""
    try:
        return operator.index(value)
    except TypeError:
        raise ParameterError(f"{value!r} is no whole number", name) from None
