import errno
import os
import threading
import time

import pytest
from hypothesis import given
from hypothesis import strategies as st

from stippler.errors import DrawingFileError, StipplerError
from stippler.files.native import journal as module
from stippler.files.native.journal import Journal, parse_journal, read_journal

MARK = bytes(range(16))


def written(path, records):
    journal = Journal(path, MARK)
    for record in records:
        journal.append(lambda record=record: record)
    assert journal.flush()
    journal.close()
    return path.read_bytes()


@given(st.lists(st.binary(max_size=300) | st.just(bytes(9000)), max_size=6))
def test_records_come_back_in_order(tmp_path_factory, records):
    path = tmp_path_factory.mktemp("journal") / "one"
    data = written(path, records)
    replay = read_journal(path)
    assert (replay.drawing, replay.records, replay.n_torn) == (MARK, records, 0)
    assert data.startswith(b"STIPJRNL")


def test_every_cut_keeps_what_came_before(tmp_path):
    records = [b"first", b"second" * 20, bytes(6000), b"last"]
    data = written(tmp_path / "one", records)
    counts = []
    for end in range(len(data) + 1):
        try:
            replay = parse_journal(data[:end], "here")
        except DrawingFileError:
            assert end < 32
            continue
        assert replay.records == records[: len(replay.records)]
        counts.append(len(replay.records))
    assert counts == sorted(counts)
    assert counts[-1] == len(records)


def test_every_changed_byte_keeps_what_came_before_it(tmp_path):
    records = [b"first", b"second", b"third"]
    data = written(tmp_path / "one", records)
    for at in range(len(data)):
        for flip in (0x01, 0x80, 0xFF):
            broken = bytearray(data)
            broken[at] ^= flip
            try:
                replay = parse_journal(bytes(broken), "here")
            except DrawingFileError:
                assert at < 32
                continue
            assert replay.records == records[: len(replay.records)]
            assert len(replay.records) < len(records)


def test_records_that_were_swapped_or_repeated_are_not_taken(tmp_path):
    data = written(tmp_path / "one", [b"aaaa", b"bbbb"])
    head, a, b = data[:32], data[32:53], data[53:]
    assert len(a) == len(b)
    assert parse_journal(head + b + a, "here").records == []
    assert parse_journal(head + a + a, "here").records == [b"aaaa"]


@pytest.mark.parametrize("error", [errno.ENOSPC, errno.EIO])
@pytest.mark.parametrize("call", ["write", "fsync"])
def test_a_disk_that_fails_is_told_once_and_never_tried_again(tmp_path, monkeypatch, call, error):
    journal = Journal(tmp_path / "one", MARK)
    journal.append(lambda: b"kept")
    assert journal.flush()
    calls = []

    def fail(*args):
        calls.append(args)
        raise OSError(error, os.strerror(error))

    monkeypatch.setattr(module.os, call, fail)
    journal.append(lambda: b"lost")
    assert not journal.flush()
    assert os.strerror(error) in str(journal.problem)
    journal.append(lambda: b"lost too")
    journal.close()
    monkeypatch.undo()
    assert len(calls) == 1
    assert read_journal(tmp_path / "one").records[0] == b"kept"


def test_short_writes_are_gone_on_with(tmp_path, monkeypatch):
    real = os.write
    monkeypatch.setattr(module.os, "write", lambda file, data: real(file, bytes(data)[:3]))
    written(tmp_path / "one", [b"a" * 50, b"b"])
    assert read_journal(tmp_path / "one").records == [b"a" * 50, b"b"]


def test_a_record_that_cannot_be_made_is_told(tmp_path):
    journal = Journal(tmp_path / "one", MARK)
    journal.append(lambda: 1 / 0)  # type: ignore[arg-type]
    assert not journal.flush()
    assert journal.problem is not None
    journal.close()


def test_asking_does_not_wait_for_the_disk(tmp_path, monkeypatch):
    gate, real = threading.Event(), os.fsync
    journal = Journal(tmp_path / "one", MARK)
    monkeypatch.setattr(module.os, "fsync", lambda file: (gate.wait(10), real(file)))
    began = time.monotonic()
    for _ in range(3):
        journal.append(lambda: b"x")
    assert time.monotonic() - began < 2.0  # the disk takes 10
    assert journal.n_waiting == 3
    assert not journal.flush(0.05)
    gate.set()
    assert journal.flush()
    journal.close()


def test_a_file_that_is_there_is_not_written_over(tmp_path):
    (tmp_path / "one").write_bytes(b"mine")
    with pytest.raises(StipplerError):
        Journal(tmp_path / "one", MARK)
    assert (tmp_path / "one").read_bytes() == b"mine"
