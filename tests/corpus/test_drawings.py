"""Every file ever released opens, and nothing in it is lost by saving it again."""

import json
from pathlib import Path

import pytest

from stippler.files.native.container import VERSION, read_container
from stippler.files.native.drawing_file import STRUCTURE, save_drawing
from stippler.files.native.thumbnail import MEMBER as THUMBNAIL
from stippler.opening import open_document, open_file
from tests.corpus.contents import CONTENTS

FILES = sorted((Path(__file__).parent / "drawings").glob("*.stipple"))


def lacks(before, after, at=""):
    """Name what is in one JSON value and not, or otherwise, in another."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key, value in before.items():
            if key not in after:
                yield f"{at}/{key}"
            else:
                yield from lacks(value, after[key], f"{at}/{key}")
    elif before != after:
        yield at


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_every_released_file_opens_and_keeps_what_it_holds(path, tmp_path):
    before = read_container(path)
    drawing = open_file(path)
    assert len(drawing.dots)
    save_drawing(drawing, tmp_path / "again.stipple")
    after = read_container(tmp_path / "again.stipple")
    for name, data in before.items():
        if name == STRUCTURE:
            assert list(lacks(json.loads(data), json.loads(after[name]))) == []
        elif name != THUMBNAIL:
            assert after[name] == data, name
    assert open_file(tmp_path / "again.stipple").areas == drawing.areas


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_the_history_in_a_released_file_is_undone(path):
    document, note = open_document(path)
    assert note == ""
    n_dots = len(document.dots)
    assert document.undo()
    assert len(document.dots) == n_dots + 2


def test_every_version_and_every_kind_of_content_is_there():
    for version in range(1, VERSION + 1):
        stems = [path.stem for path in FILES if path.stem.startswith(f"format-{version}-")]
        for name in CONTENTS:
            assert any(stem.endswith(f"-{name}") for stem in stems), (version, name)
    assert sum(path.stat().st_size for path in FILES) < 100_000 * VERSION
