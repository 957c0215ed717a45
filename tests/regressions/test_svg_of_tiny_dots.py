"""An SVG on a page of half a millimetre: a thousandth of a millimetre was 6 % of a dot."""

import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest

import stippler
from stippler.files.write.svg import svg_chunks

CIRCLE = ".//{http://www.w3.org/2000/svg}circle"


@pytest.mark.parametrize("width_mm", [0.5, 5.0, 150.0])
def test_dots_are_written_where_they_are(width_mm):
    drawing = stippler.stipple(np.full((20, 20), 0.5), 800, width_mm, iterations=0)
    circles = ElementTree.fromstring(b"".join(svg_chunks(drawing))).findall(CIRCLE)
    written = np.array([[float(c.attrib["cx"]), float(c.attrib["cy"])] for c in circles])
    off = np.abs(written - drawing.dots.position_mm).max()
    assert off <= 0.0101 * drawing.dots.radius_mm.min()
    assert len(circles) == len(drawing.dots)


def test_dots_of_real_pens_need_three_decimals():
    drawing = stippler.stipple(
        np.full((20, 20), 0.9), None, size_range=(0.05, 0.1), width=9.0, iterations=0
    )
    texts = [c.attrib["cx"] for c in ElementTree.fromstring(drawing._repr_svg_()).findall(CIRCLE)]
    assert max(len(text.partition(".")[2]) for text in texts) == 3
