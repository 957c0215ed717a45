"""A plugin of pytest: lets coverage note which test goes through which line (`make coverage`)."""

from collections.abc import Iterator

import pytest
from coverage import Coverage


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Iterator[None]:
    """Call what runs from now on by a test's name, without its parameters."""
    current = Coverage.current()
    if current is not None:
        current.switch_context(item.nodeid.split("[")[0])
    return (yield)
