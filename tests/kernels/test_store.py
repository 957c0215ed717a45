"""Machine code that is loaded without numba: what it takes, what it leaves to numba, its bits."""

import json
import os
import subprocess
import sys
import threading
import time
from collections import namedtuple
from pathlib import Path

import numpy as np
import pytest

from stippler.kernels.machine import entry_ir, export, processor, store
from stippler.kernels.machine.jit import inner

pytestmark = pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")

Pair = namedtuple("Pair", "row factor")
OPTIONS = {"nogil": True, "error_model": "numpy", "fastmath": {"contract"}}


def total(row, n, factor, doubled):
    s = 0.0
    for i in range(n):
        s += row[i] * factor
    return 2.0 * s if doubled else s


def scaled(pair, out):
    room = np.empty(len(pair.row))
    for i in range(len(room)):
        room[i] = pair.row[i] * pair.factor
    for i in range(len(room)):
        out[i, 0] = room[len(room) - 1 - i] + np.sin(out[i, 1])


def spun(n):
    x = 1
    for i in range(n):
        x ^= (x << 1) + i
    return x


def several(x, n):
    return n, 0.5 * x, -n, x + n, n + 1


def pair_of(x):
    return x, 2.0 * x


def mixed(x):
    return x, x > 0.0


def texts(a):
    return str(a)


def other(*args):
    return "other"


@pytest.fixture(scope="module")
def entry(tmp_path_factory):
    """Make a callable of a function for arguments of the kinds given."""
    folder = tmp_path_factory.mktemp("objects")

    def make(function, *args, options=OPTIONS):
        with export.recording(folder):
            address = export.recorded(function, options, args)
        return None if address is None else store.bound(function.__name__, [address], other)

    return make


def test_numbers_and_arrays_reach_the_code(entry):
    row = np.arange(6.0)
    call = entry(total, row, 3, 0.5, True)
    assert call(row, 3, 0.5, True) == 3.0
    assert call(row, np.int64(3), np.float64(0.5), np.bool_(False)) == 1.5
    assert call(np.arange(3.0), 3, -1.0, False) == -3.0


def test_other_kinds_are_left_to_another(entry):
    row = np.arange(6.0)
    call = entry(total, row, 3, 0.5, True)
    frozen = row.copy()
    frozen.flags.writeable = False
    for args in (
        (row.astype(np.float32), 3, 0.5, True), (row[::2], 3, 0.5, True), (row[None], 3, 0.5, True),
        (frozen, 3, 0.5, True), (row.astype(">f8"), 3, 0.5, True), (list(row), 3, 0.5, True),
        (row, 3.0, 0.5, True), (row, 3, 1, True), (row, 3, 0.5, 1), (row, 3, 0.5),
        (None, 3, 0.5, True), (row, True, 0.5, True), (row, np.int32(3), 0.5, True), (),
        (row, 3, np.float32(0.5), True),
    ):  # fmt: skip
        assert call(*args) == "other", args


def test_a_number_too_large_is_an_error(entry):
    row = np.arange(6.0)
    with pytest.raises(OverflowError):
        entry(total, row, 3, 0.5, True)(row, 2**70, 0.5, True)


def test_named_tuples_strides_and_room_of_its_own(entry):
    row, out = np.arange(4.0), np.zeros((2, 4)).T
    call = entry(scaled, Pair(row, 2.0), out)
    before = sys.getrefcount(row), sys.getrefcount(None)
    for _ in range(1000):
        assert call(Pair(row, 2.0), out) is None
    assert out[:, 0].tolist() == [6.0, 4.0, 2.0, 0.0]
    assert sys.getrefcount(row) == before[0]
    assert abs(sys.getrefcount(None) - before[1]) < 500
    assert call((row, 2.0), out) is None  # a tuple is one with or without a name
    assert call((row,), out) == "other"
    assert call([row, 2.0], out) == "other"


def test_read_only_code_takes_both(entry):
    frozen = np.arange(6.0)
    frozen.flags.writeable = False
    call = entry(total, frozen, 3, 0.5, True)
    assert call(np.arange(6.0), 3, 0.5, True) == call(frozen, 3, 0.5, True) == 3.0


def test_the_interpreter_lock_is_released(entry):
    call = entry(spun, 1)
    ticks, done = [], threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    thread = threading.Thread(target=tick)
    thread.start()
    start = time.perf_counter()
    while time.perf_counter() - start < 0.3:
        call(20_000_000)
    done.set()
    thread.join()
    assert len(ticks) > 20


def test_several_numbers_come_back_as_a_tuple(entry):
    call, both = entry(several, 2.5, 7), entry(pair_of, 1.5)
    before = sys.getrefcount(tuple)
    for _ in range(1000):
        assert call(2.5, 7) == (7, 1.25, -7, 9.5, 8)
        assert both(1.5) == (1.5, 3.0)
    assert [type(value) for value in call(2.5, 7)] == [int, float, int, float, int]
    assert call(1e300, -(2**62)) == (-(2**62), 5e299, 2**62, 1e300, 1 - 2**62)
    assert abs(sys.getrefcount(tuple) - before) < 500


@inner
def twice(x):
    return 2.0 * x


def of_twice(x):
    return twice(x) + 1.0


def test_numba_loads_no_part_of_what_is_stored_and_can_go_on_with_it(entry, monkeypatch):
    import numba
    from numba.core import codegen

    load, loaded = codegen.JITCPUCodegen._add_module, []

    def counted(self, module):
        loaded.append(module)
        return load(self, module)

    monkeypatch.setattr(codegen.JITCPUCodegen, "_add_module", counted)
    assert entry(of_twice, 3.0)(3.0) == 7.0
    assert loaded == []
    assert numba.njit(of_twice)(3.0) == 7.0  # with the same part of it
    assert loaded


def test_what_an_entry_cannot_do_is_left_to_numba(entry):
    assert entry(texts, 1, options={"nogil": True}) is None
    assert entry(mixed, 1.0) is None


def test_what_may_be_called_is_known():
    names = [*store.MATH, *store.MEMORY, *entry_ir.DECLARATIONS]
    module = export._parsed(
        "declare double @unheard_of(double)\n"
        "define double @f(double %x) {\n  %y = call double @unheard_of(double %x)\n"
        "  ret double %y\n}\n"
    )
    assert "unheard_of" not in names
    with pytest.raises(entry_ir.UnsupportedError, match="unheard_of"):
        export._stripped(module, "f")


def test_objects_lie_where_entries_look():
    """The layouts that `entry_ir` reads, by what numpy and CPython say of one array and tuple."""
    import ctypes

    array = np.zeros((3, 5), np.float32)[:, ::2]
    at = id(array)
    read = ctypes.c_void_p.from_address
    assert read(at + entry_ir._TYPE).value == id(np.ndarray)
    assert read(at + entry_ir._DATA).value == array.ctypes.data
    assert ctypes.c_int.from_address(at + entry_ir._ND).value == 2
    assert read(at + entry_ir._DTYPE).value == id(np.dtype(np.float32))
    assert ctypes.c_int.from_address(at + entry_ir._FLAGS).value == array.flags.num
    shape = ctypes.c_int64.from_address(read(at + entry_ir._SHAPE).value + 8)
    assert shape.value == 3
    assert ctypes.c_int64.from_address(read(at + entry_ir._STRIDES).value + 8).value == 8


@pytest.mark.parametrize("text", ["", "{", "[]", '{"format": 0}'])
def test_a_cut_list_is_no_store(text, tmp_path, monkeypatch):
    monkeypatch.setattr(store, "local_store", lambda: tmp_path)
    monkeypatch.setattr(store, "packed_stores", lambda: tmp_path / "none")
    (tmp_path / store.LIST).write_text(text)
    assert list(store._found()) == []


def test_a_cut_library_is_no_store(tmp_path):
    (tmp_path / store.LIBRARY).write_bytes(b"\x7fELF cut")
    assert store._addresses(tmp_path) is None


def test_another_processor_has_another_store(monkeypatch):
    here = store.local_store()
    monkeypatch.setenv("NUMBA_CPU_NAME", "nehalem")
    assert store.local_store() != here


def test_levels_ask_for_all_below_them(monkeypatch):
    monkeypatch.setattr(processor.platform, "machine", lambda: "x86_64")
    two = processor._LEVELS["x86-64-v2"]
    three = two | processor._LEVELS["x86-64-v3"]
    for features, expected in ((two, "x86-64-v2"), (three, "x86-64-v3"), (three - two, "none")):
        monkeypatch.setattr(processor, "_about", lambda found=features: ("", frozenset(found)))
        assert processor.level() == expected


SCRIPT = """
import json, sys
import numpy as np
import stippler
from stippler.kernels.tone.union_share import shares_of_union
rng = np.random.default_rng(1)
discs = rng.random((3000, 3)).astype(np.float32) * np.float32([9, 9, 0.3])
found = [shares_of_union(discs).tobytes().hex()]
points, radii = stippler.pulse_density(rng.random((40, 60)), 500)
found += [points.tobytes().hex(), radii.tobytes().hex()]
if sys.argv[1] == "all":
    drawing = stippler.stipple(rng.random((90, 70)), 3000, pen="stick")
    found += [drawing.dots.position_mm.tobytes().hex(), drawing.dots.radius_mm.tobytes().hex()]
print(json.dumps({"found": found, "numba": "numba" in sys.modules}))
"""


def test_the_same_bits_with_and_without_numba():
    """Of some kernels; with ``HYPOTHESIS_PROFILE=long`` of a whole drawing."""
    which = "all" if os.environ.get("HYPOTHESIS_PROFILE") == "long" else "some"
    results = []
    for kernels in ("", "numba"):
        done = subprocess.run(
            [sys.executable, "-c", SCRIPT, which], capture_output=True, text=True, check=True,
            env={**os.environ, "STIPPLER_KERNELS": kernels, "PYTHONPATH": _root()},
        )  # fmt: skip
        results.append(json.loads(done.stdout))
    assert results[0]["found"] == results[1]["found"]
    assert results[1]["numba"]
    if store.is_complete():
        assert not results[0]["numba"]


def _root():
    return str(Path(__file__).parents[2])
