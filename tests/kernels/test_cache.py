"""A changed kernel, or a changed file it imports, is never loaded from the cache."""

import pytest

from stippler.kernels.machine import cache


@pytest.fixture
def house(tmp_path, monkeypatch):
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "low.py").write_text("A = 1\n")
    (tmp_path / "middle.py").write_text("from stippler.kernels.room.low import A\n")
    (tmp_path / "top.py").write_text("from stippler.kernels.middle import A\n")
    (tmp_path / "other.py").write_text("B = 1\n")
    monkeypatch.setattr(cache, "_KERNELS", tmp_path)
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(tmp_path / "cache"))
    cache._text.cache_clear()
    yield tmp_path
    cache._text.cache_clear()


def folders(house):
    cache._text.cache_clear()
    return {name: cache.module_folder(str(house / f"{name}.py")) for name in ("top", "other")}


def test_a_change_below_moves_the_folder_of_what_imports_it(house):
    before = folders(house)
    assert before == folders(house)
    (house / "room" / "low.py").write_text("A = 2\n")
    after = folders(house)
    assert after["top"] != before["top"]
    assert after["other"] == before["other"]


def test_the_mark_changes_with_every_file(house):
    before = cache.all_digest()
    (house / "other.py").write_text("B = 2\n")
    cache._text.cache_clear()
    assert cache.all_digest() != before


def test_the_folder_can_be_moved(house):
    assert cache.cache_root() == house / "cache"
    assert folders(house)["top"].parent == house / "cache"


def test_two_installations_do_not_share_a_mark(house, tmp_path_factory, monkeypatch):
    before = cache.all_digest()
    twin = tmp_path_factory.mktemp("twin")
    for source in house.rglob("*.py"):
        (twin / source.name).write_text(source.read_text())
    monkeypatch.setattr(cache, "_KERNELS", twin)
    cache._text.cache_clear()
    assert cache.all_digest() != before


CACHES = ("source_digest", "_kept_digests", "_content_digest", "_imported", "_text")


def forget():
    for name in CACHES:
        getattr(cache, name).cache_clear()


@pytest.fixture
def fresh(house):
    forget()
    yield house
    forget()


def digests(house):
    forget()
    return {name: cache.source_digest(str(house / f"{name}.py")) for name in ("top", "other")}


def computed(house):
    return {name: cache._own_digest(house / f"{name}.py") for name in ("top", "other")}


def test_digests_are_kept_until_a_file_changes_comes_or_goes(fresh, monkeypatch):
    before = digests(fresh)
    assert before == computed(fresh)
    with monkeypatch.context() as patch:
        patch.setattr(cache, "_own_digest", lambda _: pytest.fail("is kept"))
        assert digests(fresh) == before
    (fresh / "room" / "low.py").write_text("A = 3\n")
    after = digests(fresh)
    assert after == computed(fresh)
    assert after["top"] != before["top"]
    assert after["other"] == before["other"]
    (fresh / "other.py").write_text("from stippler.kernels.room import low\nB = 1\n")
    (fresh / "room" / "new.py").write_text("C = 1\n")
    with_folder = digests(fresh)
    assert with_folder == computed(fresh)
    (fresh / "room" / "new.py").unlink()
    without = digests(fresh)
    assert without == computed(fresh)


@pytest.mark.parametrize("text", ["", "{", "[]", '{"stamps": {}}', "null"])
def test_digests_that_were_cut_are_found_anew(fresh, text):
    before = digests(fresh)
    (place,) = (fresh / "cache").glob("digests-*.json")
    place.write_text(text)
    assert digests(fresh) == before
    assert len(place.read_text()) > 100


def test_where_nothing_can_be_kept_digests_are_found_each_time(fresh, monkeypatch):
    before = digests(fresh)
    (fresh / "file").write_text("")
    monkeypatch.setenv("STIPPLER_CACHE_DIR", str(fresh / "file"))
    assert digests(fresh) == before


def test_what_lies_elsewhere_has_a_digest_too(fresh, tmp_path_factory):
    twin = tmp_path_factory.mktemp("twin") / "top.py"
    twin.write_text((fresh / "top.py").read_text())
    assert cache.source_digest(str(twin)) == digests(fresh)["top"]
