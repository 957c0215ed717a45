"""A quicker way through numba where machine code is made to be stored, not to be run at once.

Numba optimises each function that a kernel calls by itself, makes machine code of it and loads
that, before the kernel takes it in and all is optimised again. Of a kernel that is written to a
file only the last counts; without the rest compiling takes two thirds of the time. A numba that
lacks one of the names below is left as it is.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from typing import Any


@contextmanager
def only_for_objects() -> Iterator[Callable[[Any], None]]:
    """Let numba make code that is not run in this process; hold its lock meanwhile.

    Yields what finishes the library of a kernel itself, which is optimised as ever.
    """
    from numba.core import codegen

    library: Any = codegen.CPUCodeLibrary
    optimise: Any = getattr(library, "_optimize_final_module", None)
    whole: set[Any] = set()

    def optimise_whole(self: Any) -> None:
        optimise(self) if self in whole else _optimise_a_part(self)

    def finish(kernel: Any) -> None:
        whole.add(kernel)
        if not kernel._finalized:
            kernel.finalize()

    loader: Any = codegen.JITCPUCodegen
    changed = (
        (library, "_optimize_final_module", optimise_whole),
        (codegen.JITCodeLibrary, "_finalize_specific", _nothing),
        (loader, "_add_module", _nothing),
        (loader, "set_env", _nothing),
    )
    with ExitStack() as stack:
        if all(hasattr(owner, name) for owner, name, _ in changed):  # one without another: a crash
            for owner, name, instead in changed:
                stack.callback(setattr, owner, name, getattr(owner, name))
                setattr(owner, name, instead)
        yield finish


def _nothing(*_args: Any) -> None:
    """Do nothing."""


def _optimise_a_part(library: Any) -> None:
    """Simplify a function that is yet to become part of a kernel."""
    code = library._codegen
    manager, builder = code._module_pass_manager(
        loop_vectorize=False, slp_vectorize=False, opt=code._opt_level, cost="cheap"
    )
    manager.run(library._final_module, builder)
