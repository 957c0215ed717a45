"""A checkout in which a wheel was made had no fonts: packed kernels were taken for all files."""

from stippler import resources


def test_the_checkouts_own_files_are_found(tmp_path, monkeypatch):
    (tmp_path / "stippler" / "_data" / "kernels").mkdir(parents=True)
    monkeypatch.setattr(resources, "__file__", str(tmp_path / "stippler" / "resources.py"))
    assert resources._root.__wrapped__() == tmp_path
    (tmp_path / "stippler" / "_data" / "shaders").mkdir()
    assert resources._root.__wrapped__() == tmp_path / "stippler" / "_data"
