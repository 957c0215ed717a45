"""Pins in one line were met by up to hundredths of a millimetre only: their equations are singular,
and were solved as if they were not.
"""

import numpy as np
import pytest

from stippler.drawing.deformation import Deformation


@pytest.mark.parametrize("slope", [0.0, 2.0, 0.37])
def test_pins_in_line_that_move_together_meet_their_places(slope):
    start = np.column_stack([100.0 + np.arange(5.0), 70.0 + slope * np.arange(5.0)])
    end = np.add(start, (0.5, -0.25))
    pins = tuple((tuple(a), tuple(b)) for a, b in zip(start.tolist(), end.tolist(), strict=True))
    assert np.allclose(Deformation(pins_mm=pins).apply(start), end, rtol=0, atol=1e-6)
