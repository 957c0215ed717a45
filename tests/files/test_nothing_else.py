"""Nothing in a file runs, no path in it is followed, and nothing is fetched, as the system sees it.

A process of its own reads files that try to; Python's audit hooks tell it of every opening, import,
compilation, connection and new process.
"""

import json
import pickle
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image

from stippler.drawing.reference import Picture, Reference
from stippler.files.native import container
from stippler.files.native.drawing_file import members_of
from stippler.files.read.picture import picture_of_bytes
from tests.corpus.contents import dots

READ = """
import sys
from pathlib import Path
import stippler
from stippler.errors import StipplerError
from stippler.files.read.outlines import read_outlines

read = {".stipple": stippler.open, ".csv": stippler.open, ".svg": read_outlines,
        ".geojson": read_outlines}
harmless, hostile = (sorted(Path(sys.argv[1], name).iterdir()) for name in ("a", "b"))
told = []

def hook(event, args):
    if told is not None and event.split(".")[0] in WATCHED:
        told.append(f"{event} {args[0] if args else ''!s}")

WATCHED = ("open", "socket", "subprocess", "os", "exec", "compile", "pickle", "import", "ctypes",
           "urllib", "http", "ftplib", "shutil", "webbrowser", "code", "marshal", "mmap", "glob")
for path in harmless:  # what readers import, they import here
    read[path.suffix](path)
sys.addaudithook(hook)
for path in hostile:
    told.clear()
    try:
        read[path.suffix](path)
        end = "read"
    except StipplerError as error:
        end = "refused"
    except Exception as error:
        end = type(error).__name__
    seen, told[:] = sorted(set(told)), []
    print(path.name, end, *(one for one in seen if one != f"open {path}"), sep="|")
"""


class Shell:
    """What a pickle may hold: something to be done when it is read."""

    def __reduce__(self):
        return len, ("a pickle was read",)


def written(path, members):
    with path.open("wb") as stream:
        container.write_container(stream, members, "another")


def pictured(picture):
    """Return the members of a drawing with a picture."""
    drawing = dots()
    drawing.reference = Reference.of(picture, 40.0)
    return members_of(drawing)


SVG = '<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" {}'
SHAPE = '<rect width="9" height="9"/></svg>'


def hostile(secret):
    """Return files that ask for more, by name."""
    members, png = members_of(dots()), secret.read_bytes()
    bare = Picture.of(np.zeros((3, 4), np.float32), "linear", str(secret))
    elsewhere = json.loads(members["document.json"])
    elsewhere["pictures"] = {"p": {"name": "", "tone": "linear", "file": str(secret)}}
    frozen = {
        name: pickle.dumps(Shell()) if name.startswith("dots/") else data
        for name, data in members.items()
    }
    same = pickle.dumps(Shell())
    padded = {
        name: (same + data)[: len(data)] if name.startswith("dots/") else data
        for name, data in members.items()
    }
    uri = secret.as_uri()
    return {
        "linked.stipple": pictured(picture_of_bytes(png, str(secret), "linear")),
        "elsewhere.stipple": {**members, "document.json": json.dumps(elsewhere).encode()},
        "frozen.stipple": frozen,
        "padded.stipple": padded,
        "code.stipple": {**members, "document.json": b"__import__('os').getcwd()"},
        "named.stipple": pictured(bare),
        "entity.svg": f'<!DOCTYPE svg [<!ENTITY e SYSTEM "{uri}">]>' + SVG.format(">&e;") + SHAPE,
        "inner.svg": '<!DOCTYPE svg [<!ENTITY e "<g/>">]>' + SVG.format(">&e;") + SHAPE,
        "outer.svg": f'<!DOCTYPE svg SYSTEM "{uri}">' + SVG.format(">") + SHAPE,
        "image.svg": SVG.format(f'><image href="{secret}"/><image xlink:href="{uri}"/>') + SHAPE,
        "use.svg": SVG.format(f'><use href="{uri}#a"/><use xlink:href="{secret}#a"/>') + SHAPE,
        "sheet.svg": f'<?xml-stylesheet href="{uri}"?>' + SVG.format(">") + SHAPE,
        "style.svg": SVG.format(f"><style>@import url({uri});</style>") + SHAPE,
        "script.svg": SVG.format('onload="alert()"><script href="x">1</script>') + SHAPE,
        "ref.geojson": json.dumps({"type": "Feature", "$ref": uri, "geometry": None}),
        "link.geojson": json.dumps({"type": "Link", "properties": {}, "href": uri}),
        "formula.csv": "x,y,r\n=cmd|'/c calc'!A0,1,1\n",
    }


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """Return what became of each hostile file, and what was touched meanwhile."""
    folder = tmp_path_factory.mktemp("files")
    for name in ("a", "b"):
        (folder / name).mkdir()
    secret = folder / "secret.png"
    Image.new("L", (4, 3), 7).save(secret)
    harmless = pictured(picture_of_bytes(secret.read_bytes(), "", "linear"))
    written(folder / "a" / "one.stipple", harmless)
    (folder / "a" / "one.svg").write_text(SVG.format(">") + SHAPE)
    box = [[[0, 0], [9, 0], [9, 9], [0, 0]]]
    (folder / "a" / "one.geojson").write_text(json.dumps({"type": "Polygon", "coordinates": box}))
    (folder / "a" / "one.csv").write_text("x,y,r\n1,1,1\n")
    for name, content in hostile(secret).items():
        path = folder / "b" / name
        written(path, content) if isinstance(content, dict) else path.write_text(content)
    done = subprocess.run(
        [sys.executable, "-c", READ, str(folder)], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr
    lines = [line.split("|") for line in done.stdout.splitlines()]
    return {name: (end, more) for name, end, *more in lines}


REFUSED = (
    "code.stipple", "elsewhere.stipple", "entity.svg", "formula.csv", "frozen.stipple",
    "inner.svg", "link.geojson", "padded.stipple",
)  # fmt: skip
READ_AS_IT_IS = (
    "image.svg", "linked.stipple", "named.stipple", "outer.svg", "script.svg", "sheet.svg",
    "style.svg", "use.svg",
)  # fmt: skip


@pytest.mark.parametrize("name", [*REFUSED, *READ_AS_IT_IS, "ref.geojson"])
def test_reading_a_file_touches_nothing_but_the_file(told, name):
    end, touched = told[name]
    assert touched == []
    if name != "ref.geojson":
        assert end == ("refused" if name in REFUSED else "read")


def test_every_hostile_file_was_tried(told):
    assert set(told) == {*REFUSED, *READ_AS_IT_IS, "ref.geojson"}
