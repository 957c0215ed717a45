"""No kernel reads or writes beside its arrays."""

import pytest

from tests.conftest import EXAMPLES
from tests.long import bounds_checked


@pytest.mark.skipif(EXAMPLES == 1, reason="compiles all kernels anew: in the long profile")
def test_no_index_is_out_of_bounds():
    assert bounds_checked.main() == 0
