"""The bundled sample pictures: readable, large enough, documented, and what they claim to be."""

from __future__ import annotations

import hashlib
import re

import numpy as np
import pytest
from PIL import Image

from stippler.resources import assets

SAMPLES = assets() / "samples"
EXPECTED = {
    "ammonite.png": ((1800, 1500), "L"),
    "sandstone.jpg": ((1600, 1600), "L"),
    "step-wedge.png": ((1800, 1500), "I;16"),
    "honey-bee.jpg": ((1620, 1280), "RGB"),
}
LEFT, RIGHT = 92, 1708


def read(name: str) -> np.ndarray:
    with Image.open(SAMPLES / name) as picture:
        return np.asarray(picture)


def test_the_folder_holds_the_samples_and_nothing_else():
    assert {path.name for path in SAMPLES.iterdir()} == set(EXPECTED)
    assert sum(path.stat().st_size for path in SAMPLES.iterdir()) < 4_000_000


@pytest.mark.parametrize("name", EXPECTED)
def test_a_sample_decodes_with_its_size_and_mode(name: str):
    with Image.open(SAMPLES / name) as picture:
        picture.load()
        assert (picture.size, picture.mode) == EXPECTED[name]
        assert max(picture.size) >= 1500
        assert min(picture.size) >= 1000


@pytest.mark.parametrize("name", EXPECTED)
def test_the_readme_states_size_source_and_licence(name: str):
    text = (assets() / "README.md").read_text(encoding="utf-8")
    row = next(line for line in text.splitlines() if line.startswith(f"| `{name}`"))
    _, size, _, source, licence = (cell.strip() for cell in row.strip("|").split("|"))
    width, height = EXPECTED[name][0]
    assert size == f"{width} × {height}"
    assert re.search(r"MIT|public domain", licence)
    script = re.search(r"`(sources/\w+\.py)`", source)
    assert (assets() / script[1]).is_file() if script else "John Severns" in source


def test_the_photograph_is_the_one_the_readme_describes():
    digest = hashlib.sha256((SAMPLES / "honey-bee.jpg").read_bytes()).hexdigest()
    assert digest in (assets() / "README.md").read_text(encoding="utf-8")


def test_the_ammonite_lies_on_pure_white_with_margins_and_a_full_range():
    picture = read("ammonite.png")
    white = picture == 255
    assert white[:40].all()
    assert white[-40:].all()
    assert white[:, :40].all()
    assert white[:, -40:].all()
    assert 0.3 < white.mean() < 0.7
    inked = picture[~white]
    assert np.percentile(inked, 2) < 45
    assert np.percentile(inked, 90) > 215
    assert len(np.unique(inked)) > 230


def test_the_ammonites_shadow_fades_to_white_without_a_step():
    picture = read("ammonite.png").astype(int)
    # From the right and from below every row and column enters the shadow gently.
    for rows in (picture[500:1200, ::-1], picture[:, 500:1200].T[:, ::-1]):
        for row in rows:
            first = int(np.argmax(row < 255))
            assert row[first] >= 253


def test_the_sandstone_has_tone_everywhere():
    picture = read("sandstone.jpg")
    blocks = picture.reshape(8, 200, 8, 200).std((1, 3))
    assert blocks.min() > 8
    low, high = np.percentile(picture, (1, 99))
    assert low < 40
    assert high > 205


def test_the_ramp_is_even():
    row = read("step-wedge.png")[200, LEFT:RIGHT].astype(float) / 65535
    n = RIGHT - LEFT
    np.testing.assert_allclose(1 - row, (np.arange(n) + 0.5) / n, atol=1e-5)


@pytest.mark.parametrize(
    ("row", "left", "right", "values"),
    [
        (600, LEFT, RIGHT, range(0, 101, 10)),
        (920, LEFT, 858, range(0, 13, 2)),
        (920, 942, RIGHT, range(88, 101, 2)),
    ],
)
def test_the_steps_have_the_values_on_their_labels(row: int, left: int, right: int, values: range):
    picture = read("step-wedge.png")
    edges = np.linspace(left, right, len(values) + 1)
    for percent, start, stop in zip(values, edges[:-1], edges[1:], strict=True):
        step = picture[row - 60 : row + 60, round(start) + 2 : round(stop) - 2]
        assert (abs(step - 65535 * (1 - percent / 100)) < 0.51).all()
