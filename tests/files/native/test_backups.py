import os

import pytest

from stippler.files.native.backups import Backups, backups_root
from stippler.files.native.drawing_file import file_bytes, save_drawing
from stippler.opening import open_file
from tests.corpus.contents import CONTENTS


@pytest.fixture
def path(tmp_path):
    path = tmp_path / "ear.stipple"
    save_drawing(CONTENTS["dots"](), path)
    return path


def test_files_are_numbered_and_the_oldest_go(path, tmp_path):
    backups = Backups(tmp_path / "kept", path)
    contents = []
    for k in range(6):
        contents.append(path.read_bytes())
        assert backups.keep_file(path, 3).read_bytes() == contents[-1]
        drawing = open_file(path)
        drawing.dots.radius_mm[0] = 0.1 + k / 10
        save_drawing(drawing, path)
    assert [backup.number for backup in backups.listed()] == [6, 5, 4]
    found = [backup.path.read_bytes() for backup in backups.listed()]
    assert found == contents[:2:-1]
    assert not any(backup.is_auto for backup in backups.listed())
    assert sorted(tmp_path.iterdir()) == [path, tmp_path / "kept"]  # nothing beside the file


def test_autosaves_stand_among_them(path, tmp_path):
    backups = Backups(tmp_path / "kept", path)
    backups.keep_file(path, 5)
    data = file_bytes(CONTENTS["lines"]())
    made = backups.keep_bytes(data, 5)
    assert [(b.number, b.is_auto) for b in backups.listed()] == [(2, True), (1, False)]
    assert made.read_bytes() == data
    assert len(open_file(made).lines) == 1


def test_drawings_do_not_share_a_folder(path, tmp_path):
    folders = {Backups(tmp_path, whose).folder for whose in (path, "untitled a", "untitled b")}
    assert len(folders) == 3
    assert Backups(tmp_path, path).folder == Backups(tmp_path, path.absolute()).folder


def test_none_are_kept_where_none_are_wanted(path, tmp_path):
    backups = Backups(tmp_path / "kept", path)
    assert backups.keep_file(path, 0) is None
    assert backups.keep_bytes(b"PK", 0) is None
    assert not (tmp_path / "kept").exists()
    assert backups.listed() == []


def test_what_is_no_drawing_is_not_kept(tmp_path):
    (tmp_path / "a.stipple").write_bytes(b"something else")
    assert Backups(tmp_path / "kept", "a").keep_file(tmp_path / "a.stipple", 5) is None


def test_other_files_in_the_folder_are_left_alone(path, tmp_path):
    backups = Backups(tmp_path / "kept", path)
    backups.keep_file(path, 1)
    (backups.folder / "mine.stipple").write_bytes(b"x")
    backups.keep_file(path, 1)
    assert (backups.folder / "mine.stipple").exists()
    assert len(backups.listed()) == 1


def test_a_folder_that_cannot_be_written_is_told(path, tmp_path):
    (tmp_path / "kept").write_text("a file")
    with pytest.raises((FileExistsError, NotADirectoryError)):
        Backups(tmp_path / "kept", path).keep_file(path, 3)


def test_the_root_can_be_moved(monkeypatch, tmp_path):
    monkeypatch.setenv("STIPPLER_STATE_DIR", str(tmp_path))
    assert backups_root() == tmp_path / "backups"
    monkeypatch.delenv("STIPPLER_STATE_DIR")
    assert os.fspath(backups_root()).endswith("backups")
