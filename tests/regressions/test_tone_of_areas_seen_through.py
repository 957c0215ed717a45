"""Areas of 21 to 41 dots that see through their borders had up to 5 % too much or too little ink.

Sizes were solved for all of them together, in whole cells; the border cuts cells, whose ink is
not spread evenly.
"""

from stippler.jobs.processing import process_now
from tests.stippling.test_tone_of_each_area import divided, errors, pictured


def test_small_areas_that_see_through_meet_the_tone():
    document = divided(pictured("light"), 40, 1, n_dots=1500, iterations=15)
    process_now(document, list(document.drawing.areas))
    assert max(abs(off) for off, n in errors(document).values() if n >= 20) < 0.005
