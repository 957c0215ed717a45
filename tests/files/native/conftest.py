from pathlib import Path

import pytest


@pytest.fixture
def sample_path():
    return Path(__file__).parents[3] / "assets" / "samples" / "ammonite.png"
