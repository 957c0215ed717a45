"""After `make run` has compiled the kernels, nothing a person does compiles another."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from stippler import warm
from stippler.kernels.machine import store

# in a process of its own, where no other test has compiled anything
SCRIPT = """
import json, sys, tempfile
import numpy as np
import stippler
from stippler.drawing.style import FIRST_DOTS

picture = np.random.default_rng(0).integers(0, 256, (50, 70, 3), np.uint8)
white = np.full((40, 40), 255, np.uint8)
late = []
with tempfile.TemporaryDirectory() as folder:
    for method in FIRST_DOTS:
        for tone in ("linear", "perceptual"):
            for image, options in [
                (picture, {}), (picture / 255, {"size_range": (0.2, 0.4)}), (white, {}),
            ]:
                drawing = stippler.stipple(
                    image, 200, 50, iterations=2, tone=tone, first_dots=method, **options
                )
                for ending in ("svg", "png", "csv"):
                    drawing.save(f"{folder}/d.{ending}", dpi=60)
                if "numba" in sys.modules:
                    late.append([method, tone, list(options)])
    for dots, options in ((1000, {}), (200, {"elongation": 2.0})):  # enough to bleed; long ones
        drawing = stippler.stipple(picture, dots, 50, iterations=2, **options)
        drawing.save(f"{folder}/d.svg", round_dots="compound")
        if "numba" in sys.modules:
            late.append([dots, list(options)])
print(json.dumps(late))
"""


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_after_warming_drawing_imports_no_numba():
    for command in (["-m", "stippler.warm"], ["-c", SCRIPT]):
        done = subprocess.run(
            [sys.executable, *command], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == []


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_what_was_made_for_another_processor_is_not_compiled(monkeypatch):
    monkeypatch.setenv("NUMBA_CPU_NAME", "nehalem")
    store.stores.cache_clear()
    assert not warm.is_warm()
    monkeypatch.undo()
    store.stores.cache_clear()


def test_without_the_mark_it_is_cold(monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(store, "packed_stores", lambda: tmp_path / "none")
    store.stores.cache_clear()
    assert not warm.is_warm()
    assert list(Path(tmp_path).iterdir()) == []
    store.stores.cache_clear()


AREAS = """
import json, sys
import numpy as np, shapely
from stippler.drawing.deformation import Cage, Deformation
from stippler.drawing.line import Line
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.planar.planar_map import PlanarMap
from stippler.drawing.reference import Reference
from stippler.drawing.line_index import adhering, keeping_distance
from stippler.stippling.picture_field import PictureField
from stippler.stippling.relax import Relaxation
from stippler.stippling.radii import solve_radii
from stippler.stippling.tone import DotRule

late, rng = [], np.random.default_rng(7)

def look(what):
    if "numba" in sys.modules and not late:
        late.append(what)

areas = PlanarMap.of_page(30.0, 20.0)
for x in (1, 6):
    square = [(x, 2), (x + 9, 2), (x + 9, 11), (x, 11)]
    areas = edits.add(areas, Path.polyline(square, closed=True), edits.IS_CUT).map
areas.area_at(rng.random((10, 2)) * 20)
look("borders")
bent = Deformation(cage=Cage.over((0.0, 0.0, 9.0, 9.0)).moved({3: (4.0, 4.0)}))
bent.apply(rng.random((10, 2)))
look("cage")
line = Line("line", Path.polyline([(1.0, 1.0), (5.0, 9.0)]))
keeping_distance([line]).keep_distance(rng.random((9, 2)) * 9)
adhering([line]).nearest(rng.random((9, 2)) * 9)
look("lines")
reference = Reference(rng.random((60, 90)).astype(np.float32), 30.0)
shapes = [areas.outline(k) for k in areas.areas[1:]]
dots = [shapely.get_coordinates(s.centroid) + rng.random((40, 2)) for s in shapes]
owner = np.repeat(np.arange(len(shapes)), 40)
for method in ("lloyd", "even"):
    for field in (None, PictureField.of(reference)):
        engine = Relaxation(np.concatenate(dots), shapes, None, owner, field, method=method)
        engine.run(3)
        look(f"{method}, {field is not None}")
solve_radii(engine.tessellation(), DotRule(0.1, 0.2))
look("sizes")
print(json.dumps(late))
"""


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_after_warming_areas_and_lines_import_no_numba():
    for command in (["-m", "stippler.warm"], ["-c", AREAS]):
        done = subprocess.run(
            [sys.executable, *command], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == []


EVERY_KERNEL = """
import importlib, json, pkgutil
import stippler.kernels
from stippler.kernels.machine.jit import Kernel

modules = pkgutil.walk_packages(stippler.kernels.__path__, "stippler.kernels.")
every = [value for one in modules for value in vars(importlib.import_module(one.name)).values()]
kernels = {value.function.__qualname__: value for value in every if type(value) is Kernel}
print(json.dumps([len(kernels), sorted(k for k, value in kernels.items() if not value.is_stored)]))
"""


@pytest.mark.skipif(not store.can_load(), reason="no store is loaded here")
def test_after_warming_every_kernel_is_stored():
    for command in (["-m", "stippler.warm"], ["-c", EVERY_KERNEL]):
        done = subprocess.run(
            [sys.executable, *command], capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, done.stderr
    n, left_out = json.loads(done.stdout)
    assert n > 80
    assert left_out == []
