"""Small documents in the settings folder."""

from __future__ import annotations

from pathlib import Path

import pytest

from stippler.errors import StipplerError
from stippler.settings import read_document, settings_folder, write_document


def test_a_document_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "new" / "one.json"
    assert read_document(path) == ({}, "")
    write_document(path, {"a": [1, "ü"]})
    assert read_document(path) == ({"a": [1, "ü"]}, "")
    assert [one.name for one in path.parent.iterdir()] == ["one.json"]


@pytest.mark.parametrize("content", [b'{"a": 1', b"[1, 2]", b"\xff\xfe\x00"])
def test_a_broken_file_is_told_and_kept_aside(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "one.json"
    path.write_bytes(content)
    document, problem = read_document(path)
    assert document == {}
    assert str(path) in problem
    assert "one.broken.json" in problem
    assert "\n" not in problem
    assert (tmp_path / "one.broken.json").read_bytes() == content
    assert not path.exists()


def test_a_folder_that_is_none_is_one_line_and_leaves_nothing(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(StipplerError, match="cannot be kept") as told:
        write_document(tmp_path / "file" / "one.json", {})
    assert "\n" not in str(told.value)
    path = tmp_path / "one.json"
    write_document(path, {"kept": 1})
    with pytest.raises(TypeError):
        write_document(path, {"bad": object()})
    assert read_document(path)[0] == {"kept": 1}


def test_the_folder_can_be_moved(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("STIPPLER_CONFIG_DIR", str(tmp_path))
    assert settings_folder() == tmp_path
    monkeypatch.delenv("STIPPLER_CONFIG_DIR")
    assert settings_folder().name == "stippler"
