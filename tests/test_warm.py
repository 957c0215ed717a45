"""After `make run` has compiled the kernels, nothing a person does compiles another."""

import json
import subprocess
import sys
from pathlib import Path

from stippler import warm

# in a process of its own, where no other test has compiled anything
SCRIPT = """
import importlib, json, pkgutil, sys, tempfile
import numpy as np
import stippler, stippler.kernels
from stippler import warm
from stippler.stippling.plan import FIRST_DOTS

def compiled():
    found = set()
    for module in pkgutil.walk_packages(stippler.kernels.__path__, "stippler.kernels."):
        for name, value in vars(importlib.import_module(module.name)).items():
            if hasattr(value, "nopython_signatures"):
                found |= {f"{name} {signature}" for signature in value.signatures}
    return found

told = []
warm.warm(lambda name, done, total: told.append((done, total)))
warmed = compiled()
picture = np.random.default_rng(0).integers(0, 256, (50, 70, 3), np.uint8)
white = np.full((40, 40), 255, np.uint8)
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
print(json.dumps({"told": told, "warmed": len(warmed), "late": sorted(compiled() - warmed)}))
"""


def test_after_warming_drawing_compiles_nothing():
    result = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, check=False
    )
    assert result.returncode == 0, result.stderr
    found = json.loads(result.stdout)
    assert found["warmed"] > 10
    assert found["late"] == []
    done, total = zip(*found["told"], strict=True)
    assert list(done) == list(range(total[0] + 1))
    assert warm.is_warm()


def test_without_the_mark_it_is_cold(monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path))
    assert not warm.is_warm()
    assert list(Path(tmp_path).iterdir()) == []
