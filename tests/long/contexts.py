"""Lets coverage note what each test goes through: ``coverage run -m pytest -p tests.long.contexts``."""

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
