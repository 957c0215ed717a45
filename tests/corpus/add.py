"""Add a release's own files to the corpus: ``python -m tests.corpus.add 0.3.0``, once a release.

Writes a small drawing of every kind of content to ``tests/corpus/drawings``. Files that are there
stay as they are for ever: a test opens each, so that every version ever released opens.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

from stippler.drawing.document import Document
from stippler.files.native.container import VERSION
from stippler.files.native.drawing_file import save_drawing
from stippler.files.native.step_file import MEMBER, steps_to_bytes
from tests.corpus.contents import CONTENTS

FOLDER = Path(__file__).parent / "drawings"


def main() -> None:
    """Write the files of a release; one that is there is left alone."""
    (release,) = sys.argv[1:]
    for name, make in CONTENTS.items():
        path = FOLDER / f"format-{VERSION}-{release}-{name}.stipple"
        if path.exists():
            sys.stdout.write(f"{path.name} is there already\n")
            continue
        drawing = make()
        document = Document(drawing)
        document.begin("Erase")
        document.remove(document.rows(document.dots.id[:2]))
        document.commit()
        steps = document.steps()
        assert steps
        drawing = document.drawing.snapshot()
        members = {
            **drawing.foreign.members,
            MEMBER: steps_to_bytes(steps, 1, drawing),
            "editor.json": b'{"view": {"px_per_mm": 9.0}, "later": 1}',
        }
        drawing.foreign = replace(drawing.foreign, members=members)
        save_drawing(drawing, path)


if __name__ == "__main__":
    main()
