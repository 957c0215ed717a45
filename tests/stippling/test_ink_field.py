"""What relaxation is weighted by: the ink of a page in blocks, mirrored in its bleed."""

import numpy as np
import pytest

from stippler.drawing.reference import Reference
from stippler.stippling.page_raster import PageRaster


def raster_of(values, n, bleeds=True):
    return PageRaster.of(Reference(values, 100.0), n, None, bleeds=bleeds)


@pytest.mark.parametrize("shape", [(301, 403), (600, 601)])
@pytest.mark.parametrize("bleeds", [False, True])
def test_blocks_hold_the_ink_of_their_pixels(shape, bleeds):
    steps = np.random.default_rng(1).integers(0, 30_000, shape)  # few enough to be kept to the bit
    values = (0.2 + steps / 60_000).astype(np.float32)
    raster = raster_of(values, 800, bleeds)
    field = raster.ink_field()
    k = round(field.pixel_mm[0] / raster.pixel_mm)
    assert k > 1
    bleed = round(-field.origin_mm[0] / raster.pixel_mm)
    assert bleed >= raster.bleed
    padded = np.pad(values, bleed + k, mode="symmetric")[k:, k:]
    rows, columns = field.values.shape
    fine = padded[: rows * k, : columns * k].reshape(rows, k, columns, k)
    np.testing.assert_allclose(field.values, fine.mean(axis=(1, 3)), rtol=1e-5)
    assert rows * k >= shape[0] + 2 * raster.bleed


def test_few_pixels_a_dot_are_taken_as_they_are():
    values = np.random.default_rng(1).random((100, 120)).astype(np.float32)
    raster = raster_of(values, 2000, bleeds=False)
    assert np.array_equal(raster.ink_field().values, values)
