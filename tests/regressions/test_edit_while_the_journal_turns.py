"""An edit came just when a new journal took the old one's place, and the stroke failed."""

from stippler.files.native import recovery
from stippler.files.native.recovery import Keeper, lost_drawings


def test_an_edit_while_the_old_journal_closes_goes_on(tmp_path, monkeypatch):
    keeper = Keeper(tmp_path)
    keeper.begin(lambda: {"document.json": b"{}"}, "one", None, "test")
    assert keeper.wait()
    close = recovery.Journal.close

    def close_and_edit(journal, *args):
        close(journal, *args)
        if journal is not keeper._journals[-1]:
            keeper.append(lambda: b"an edit")  # as the other thread may at this very moment

    monkeypatch.setattr(recovery.Journal, "close", close_and_edit)
    keeper.begin(lambda: {"document.json": b"{}"}, "one", None, "test")
    assert keeper.wait()
    monkeypatch.undo()
    keeper._lock.close()  # as a crash would
    (lost,) = lost_drawings(tmp_path)
    assert lost.read()[1].records == [b"an edit"]
