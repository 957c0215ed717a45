"""A scene that follows a document holds what a fresh one would, whatever happened in between."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, precondition, rule
from shapely.geometry import box

from stippler import headless
from stippler.drawing import records
from stippler.drawing.area import Area
from stippler.drawing.document import Document
from stippler.drawing.dots import FIXED, Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.reference import Reference
from stippler.drawing.style import WHITE_ON_BLACK, Style
from stippler.render.dot_buffer import DotBuffer
from stippler.render.scene import Scene

NO_IDS = np.empty(0, np.int64)


def document_of(n: int, seed: int = 0) -> Document:
    rng = np.random.default_rng(seed)
    drawing = Drawing.blank(Page(20, 20))
    drawing.dots = Dots.round(rng.uniform(0, 20, (n, 2)), rng.uniform(0.1, 0.3, n))
    drawing.dots.elongation[:] = rng.uniform(1, 3, n)
    drawing.dots.constraint[::5] = FIXED
    return Document(drawing)


def by_row(buffer: DotBuffer) -> np.ndarray:
    """Return what lies on the GPU, in the order of the document's rows, but for shares."""
    if buffer.n == 0:
        return np.empty((0, 6), np.uint32)
    on_gpu = np.frombuffer(buffer.gl.read(buffer.n * 24), np.uint32).reshape(-1, 6).copy()
    assert np.array_equal(on_gpu, buffer.rows)
    on_gpu[:, 4] &= 0x00FFFFFF
    return on_gpu[buffer._slot_of_row]


def assert_like_a_fresh_one(ctx, scene: Scene, document: Document, selected) -> None:
    fresh = Scene(ctx)
    fresh.sync(document, selected)
    assert scene.n_dots == fresh.n_dots == len(document.dots)
    assert np.array_equal(by_row(scene.dots), by_row(fresh.dots))
    assert scene.grounds.n == fresh.grounds.n
    fresh.release()


class SceneMachine(RuleBasedStateMachine):
    """Strokes, runs, drafts, undo and selections, with looks at the page in between."""

    def __init__(self):
        super().__init__()
        self.ctx = headless.open_context()
        self.document, self.scene = document_of(60), Scene(self.ctx)
        self.selected, self.run = NO_IDS, None

    def teardown(self):
        self.look()
        self.scene.release()
        self.document.history.close()
        self.ctx.release()

    @rule()
    def look(self):
        with self.ctx:
            self.scene.sync(self.document, self.selected)
            assert_like_a_fresh_one(self.ctx, self.scene, self.document, self.selected)

    @precondition(lambda self: not self.document.in_draft)
    @rule(act=st.sampled_from(["remove", "insert", "move", "fix"]), seed=st.integers(0, 99))
    def stroke(self, act, seed):
        rng, document = np.random.default_rng(seed), self.document
        document.begin(act)
        rows = np.unique(rng.integers(0, max(len(document.dots), 1), 5))
        rows = rows[rows < len(document.dots)]
        if act == "insert":
            document.insert(Dots.round(rng.uniform(0, 20, (7, 2)), 0.2))
        elif act == "remove":
            document.remove(rows)
        elif act == "move":
            document.move(rows, rng.uniform(0, 20, (len(rows), 2)))
        else:
            values = np.full(len(rows), FIXED, document.dots.constraint.dtype)
            document.change("constraint", rows, values)
        document.commit()

    @rule(seed=st.integers(0, 99))
    def select(self, seed):
        rng = np.random.default_rng(seed)
        self.selected = np.unique(rng.integers(0, 100, 9))

    @precondition(lambda self: not self.document.in_draft)
    @rule(
        i=st.sampled_from([0, 5]),
        polarity=st.sampled_from(["black-on-white", WHITE_ON_BLACK]),
        hidden=st.booleans(),
    )
    def paint(self, i, polarity, hidden):
        """An area's dots become white, black or hidden; a small one comes where there is none."""
        document = self.document
        document.begin("paint")
        document.set(records.STYLE, i, Style(polarity=polarity))
        area = document.drawing.areas.get(i) or Area("five", box(4, 4, 9, 9), i)
        document.set(records.AREA, i, replace(area, hidden=hidden))
        document.own_by_place(np.arange(len(document.dots)))
        document.commit()

    @precondition(lambda self: not self.document.in_draft)
    @rule()
    def undo(self):
        self.document.undo()

    @precondition(lambda self: not self.document.in_draft)
    @rule(seed=st.integers(0, 99))
    def relax(self, seed):
        if not self.document.in_run:
            self.run = self.document.begin_run("Relax")
        rng = np.random.default_rng(seed)
        self.document.merge(rng.uniform(0, 20, (len(self.run), 2)))

    @precondition(lambda self: not self.document.in_draft)
    @rule()
    def begin_draft(self):
        self.document.begin_draft("Make", 0, Style())

    @precondition(lambda self: self.document.in_draft)
    @rule(n=st.integers(0, 40), seed=st.integers(0, 99))
    def draft(self, n, seed):
        rng = np.random.default_rng(seed)
        radius = rng.uniform(0.1, 0.3, n).astype(np.float32)
        self.document.draft(rng.uniform(0, 20, (n, 2)), radius)

    @precondition(lambda self: self.document.in_draft)
    @rule()
    def end_draft(self):
        self.document.end_draft()


TestScene = SceneMachine.TestCase
TestScene.settings = settings(max_examples=12, stateful_step_count=25, deadline=None)


def test_restarting_shows_round_free_dots_whatever_was_there(ctx) -> None:
    """The same number of dots came out long and fixed like those before."""
    document, scene, made = document_of(40), Scene(ctx), Scene(ctx)
    scene.sync(document)
    place = document.dots.position_mm[::-1].copy()
    document.begin_draft("Stipple", 0, Style())
    document.draft(place, np.full(40, 0.2, np.float32))
    scene.sync(document)
    made.set_page(20.0, 20.0)
    made.set_dots(Dots.round(place, 0.2))
    assert np.array_equal(by_row(scene.dots), by_row(made.dots))
    assert not scene.dots.has_flags
    document.end_draft()
    scene.sync(document)
    assert_like_a_fresh_one(ctx, scene, document, NO_IDS)
    scene.release()
    made.release()


def test_an_upload_that_fails_is_made_up_for(ctx, monkeypatch) -> None:
    document, scene = document_of(40), Scene(ctx)
    scene.sync(document)
    document.begin("Move")
    document.move(np.arange(30), np.full((30, 2), 5.0))
    document.commit()

    def fail(*_):
        raise MemoryError

    with monkeypatch.context() as broken:
        broken.setattr(DotBuffer, "_upload", fail)
        with pytest.raises(MemoryError):
            scene.sync(document)
    scene.sync(document)
    assert_like_a_fresh_one(ctx, scene, document, NO_IDS)
    scene.release()


def test_a_reference_wider_than_textures_are_is_shown(ctx, monkeypatch) -> None:
    monkeypatch.setitem(ctx.info, "GL_MAX_TEXTURE_SIZE", 64)
    scene = Scene(ctx)
    scene.set_reference(Reference(np.zeros((10, 1000), np.float32), 100.0))
    assert ctx.error == "GL_NO_ERROR"
    assert scene.reference.size_mm == (100.0, 1.0)
    assert scene.reference._texture.width <= 64
    scene.release()
