"""What partial uploads leave on the GPU is what a full one would."""

import numpy as np
import pytest

from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.render.dot_buffer import DotBuffer

ORIGIN = (10.0, 10.0)


def some_dots(rng: np.random.Generator, n: int) -> Dots:
    return Dots.round(rng.uniform(0, 20, (n, 2)), rng.uniform(0.1, 0.3, n))


def by_row(buffer: DotBuffer) -> np.ndarray:
    """Return what lies on the GPU, in the order of the drawing's rows."""
    on_gpu = np.frombuffer(buffer.gl.read(buffer.n * 24), np.uint32).reshape(-1, 6)
    assert np.array_equal(on_gpu, buffer.rows)
    return on_gpu[buffer._slot_of_row]


@pytest.mark.parametrize("seed", range(4))
def test_dots_that_come_go_and_move_between_uploads(ctx, seed: int) -> None:
    rng = np.random.default_rng(seed)
    drawing = Drawing.blank(Page(20, 20))
    drawing.dots = some_dots(rng, 400)
    document = Document(drawing)
    buffer, fresh = DotBuffer(ctx), DotBuffer(ctx)
    none = np.zeros(2000, np.bool_)
    cursor = document.changes.now
    buffer.set(document.dots, none[:400], ORIGIN)
    for _ in range(30):
        document.begin("stroke")
        for _ in range(rng.integers(1, 4)):
            act, n = rng.integers(3), len(document.dots)
            rows = rng.integers(0, n, 12)
            if act == 0:
                document.remove(rows)
            elif act == 1:
                document.insert(some_dots(rng, 9))
            else:
                rows = np.unique(rows)
                document.move(rows, rng.uniform(0, 20, (len(rows), 2)))
        document.commit()
        if rng.random() < 0.3:
            document.undo()
        changed = document.changes.since(cursor)
        n, rows, cursor = len(document.dots), changed.rows, changed.cursor
        assert rows is not None
        buffer.update(document.dots, rows, none[:n], ORIGIN)
        fresh.set(document.dots, none[:n], ORIGIN)
        assert buffer.n == n
        assert np.array_equal(by_row(buffer), by_row(fresh))
    buffer.release()
    fresh.release()


def test_removing_the_last_rows_alone_uploads_nothing_else(ctx) -> None:
    dots = some_dots(np.random.default_rng(1), 100)
    buffer = DotBuffer(ctx)
    buffer.set(dots, np.zeros(100, np.bool_), ORIGIN)
    fewer = dots.take(slice(0, 95))
    buffer.update(fewer, np.empty(0, np.int64), np.zeros(95, np.bool_), ORIGIN)
    expected = DotBuffer(ctx)
    expected.set(fewer, np.zeros(95, np.bool_), ORIGIN)
    assert np.array_equal(by_row(buffer), by_row(expected))
    buffer.release()
    expected.release()
