"""A sheet of each kind."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))

from sheets_tried import SHEETS, SIZE

from stippler.files.write.sheet import Sheet


@pytest.fixture(params=SHEETS)
def sheet(request) -> Sheet:
    return Sheet(*SIZE, SHEETS[request.param])
