"""Half of a short command went into importing scipy, of which a page takes nothing."""

import subprocess
import sys

import numpy as np
from PIL import Image

CODE = """
import sys
from stippler.start import main
try:
    main()
except SystemExit as end:
    assert not end.code, end.code
late = ("scipy", "numba", "http.client", "moderngl", "imgui_bundle")
print([name for name in late if name in sys.modules])
"""


def test_a_page_is_stippled_without_it(tmp_path):
    grey = np.tile(np.linspace(40, 220, 90, dtype=np.uint8), (60, 1))
    Image.fromarray(grey).save(tmp_path / "grey.png")
    command = [sys.executable, "-c", CODE, "render", str(tmp_path / "grey.png"),
               "-o", str(tmp_path / "out.svg"), "--dots", "300"]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "[]"
