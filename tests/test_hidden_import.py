"""Modules that are hidden or emptied for a while, and are what they were afterwards."""

import subprocess
import sys

import pytest

from stippler.hidden_import import emptied, hidden


def test_an_emptied_module_is_there_later():
    with emptied("this"):
        import this as empty

        assert not hasattr(empty, "s")
    assert "this" not in sys.modules


def test_one_that_is_imported_stays():
    import json

    with emptied("json"), hidden("json"):
        import json as same

        assert same is json
    assert sys.modules["json"] is json


def test_they_come_back_after_an_error():
    with pytest.raises(ImportError), hidden("this"):
        import this  # noqa: F401
    assert "this" not in sys.modules


def test_everything_that_leans_on_numpy_does_without_docstrings():
    code = (
        "from stippler.cli_plain import _DOCSTRINGS\n"
        "from stippler.hidden_import import emptied\n"
        "with emptied(*_DOCSTRINGS):\n"
        "    import numpy\n"
        "import numpy.ma, scipy.spatial, scipy.sparse.linalg, scipy.optimize, scipy.ndimage\n"
        "import cv2, PIL.Image, shapely, tifffile, imagecodecs, numba\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)
