"""The entry for desktops is one that desktops accept."""

import configparser
import io
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ET
import zipfile
from pathlib import Path

import pytest

from stippler import desktop
from stippler.errors import OutputError, StipplerError
from stippler.files.native.container import write_container

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="entries of Linux")


@pytest.fixture
def installed(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    return {path.relative_to(tmp_path).as_posix(): path for path in desktop.install()}


def test_entry_icon_and_kind(installed):
    parser = configparser.ConfigParser(interpolation=None, strict=True)
    parser.optionxform = str
    parser.read(installed["applications/stippler.desktop"])
    entry = parser["Desktop Entry"]
    program = Path(entry["Exec"].split()[0])
    assert program.is_file()
    assert entry["Exec"].endswith("edit %f")
    assert f"icons/hicolor/scalable/apps/{entry['Icon']}.svg" in installed
    assert entry["MimeType"].endswith(";")
    assert {"image/png", "application/x-stipple"} <= set(entry["MimeType"].split(";"))
    for path in installed.values():
        if path.suffix != ".desktop":
            ET.parse(path)


def test_windows_call_themselves_by_the_same_name():
    source = Path(desktop.__file__).parent / "ui" / "window" / "window.py"
    assert f'X11_CLASS_NAME, "{desktop.APP_ID}"' in source.read_text()


def test_the_kind_knows_drawings_by_their_first_bytes(installed):
    stream = io.BytesIO()
    write_container(stream, {"a": b"1"}, "test")
    data = stream.getvalue()
    assert zipfile.is_zipfile(io.BytesIO(data))
    for match in ET.parse(installed["mime/packages/stippler.xml"]).iter():
        if match.tag.endswith("}match"):
            at, value = int(match.get("offset")), match.get("value").encode()
            assert data[at : at + len(value)] == value


def test_twice_is_as_once(installed, tmp_path):
    before = {name: path.read_bytes() for name, path in installed.items()}
    assert {p.relative_to(tmp_path).as_posix(): p.read_bytes() for p in desktop.install()} == before


@pytest.mark.parametrize(
    ("path", "quoted"),
    [
        ("/opt/stippler", "/opt/stippler"),
        ("/my files/stippler", '"/my files/stippler"'),
        ("/50%/stippler", "/50%%/stippler"),
        ("/a$b/stippler", '"/a\\\\$b/stippler"'),
    ],
)
def test_odd_places(path, quoted):
    assert desktop._entry([path]).splitlines()[6] == f"Exec={quoted} edit %f"


def test_a_folder_that_cannot_be_written(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "file"))
    with pytest.raises(OutputError, match="XDG_DATA_HOME"):
        list(desktop.install())


def test_other_systems(monkeypatch):
    monkeypatch.setattr(sys, "platform", "darwin")
    with pytest.raises(StipplerError, match="is for Linux"):
        list(desktop.install())


@pytest.mark.skipif(not shutil.which("desktop-file-validate"), reason="needs desktop-file-utils")
def test_the_validator_has_nothing_to_say(installed):
    done = subprocess.run(
        ["desktop-file-validate", installed["applications/stippler.desktop"]],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert (done.returncode, done.stdout) == (0, "")
