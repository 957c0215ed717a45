"""What a document, its history and those who follow it do at the edges of what they are for."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely

from stippler.drawing import ids, records
from stippler.drawing.adjustment import Adjustment
from stippler.drawing.area import Area
from stippler.drawing.area_edits import current_map, edit_areas
from stippler.drawing.changes import Changes
from stippler.drawing.document import Document
from stippler.drawing.dots import Dots
from stippler.drawing.drawing import Drawing, Page
from stippler.drawing.edit import Edit
from stippler.drawing.history import History, Step, edit_of
from stippler.drawing.pens import Pen, pen_named
from stippler.drawing.planar import edits
from stippler.drawing.planar.path import Path
from stippler.drawing.preview import Footprint, Preview
from stippler.drawing.records import value_from_json
from stippler.drawing.reference import Picture, Reference
from stippler.drawing.shape_change import ShapeChange, to
from stippler.drawing.store import DotStore
from stippler.drawing.style import Style
from stippler.drawing.style_presets import _read, presets
from stippler.drawing.tone_curve import ToneCurve
from stippler.drawing.visible import hidden_areas, shown, sized_zero
from stippler.errors import GeometryError, ParameterError, StipplerError


def some_document(n=40):
    drawing = Drawing.blank(Page(20, 10))
    at = np.random.default_rng(3).random((n, 2)) * (20, 10)
    drawing.dots = Dots.round(at, 0.2)
    return Document(drawing)


class TestChanges:
    def test_only_what_came_after_a_cursor_is_told(self):
        changes = Changes()
        changes.note_all(100)
        first = changes.since(0)
        assert first.rows is None
        assert first.records == frozenset()
        changes.note_rows(np.array([5, 3, 200]), 100)
        changes.note_record("area", 2)
        told = changes.since(first.cursor)
        assert told.rows.tolist() == [3, 5]
        assert (told.has("area"), told.has("style"), told.places) == (True, False, False)
        changes.note_places()
        assert changes.since(told.cursor).places
        assert changes.since(told.cursor).rows.tolist() == []
        assert not changes.since(told.cursor).has("area")
        assert not changes.since(changes.now).places

    def test_rows_that_are_all_of_them_are_told_as_all(self):
        changes = Changes()
        changes.note_all(4)
        cursor = changes.now
        changes.note_rows(np.arange(4), 4)
        assert changes.since(cursor).rows is None
        assert changes.since(changes.now).rows.tolist() == []

    def test_who_keeps_up_is_told_rows_and_who_does_not_all(self):
        changes = Changes()
        changes.note_all(1000)
        late = changes.now
        cursors = []
        for k in range(700):
            changes.note_rows(np.array([k]), 1000)
            cursors.append(changes.now)
            assert changes.since(cursors[max(k - 100, 0)]).rows.tolist() == list(
                range(max(k - 100, 0) + 1, k + 1)
            )
        assert changes.since(late).rows is None


class TestHistory:
    def test_an_open_step_cannot_be_undone_by_hand(self):
        history = History()
        step = history.open("Relax")
        assert step.is_open
        with pytest.raises(ValueError, match="still being made"):
            edit_of(step)
        history.close()
        assert (history.steps, history.n_done) == ([], 0)

    def test_counts_are_held_to_what_there_is(self):
        document = some_document()
        document.begin("Move")
        document.move(np.array([1]), np.array([[3.0, 3.0]]))
        document.commit()
        history = document.history
        for given, kept in ((-3, 0), (9, 1), (1, 1)):
            history.go_to(given)
            assert history.n_done == kept

    def test_steps_stay_in_memory_where_they_cannot_be_written(self, monkeypatch, caplog):
        def full(path, **arrays):
            raise OSError(28, "No space left on device")

        monkeypatch.setattr("stippler.drawing.history.np.savez", full)
        document = Document(some_document().drawing, budget_bytes=1)
        start = document.dots.copy()
        for k in range(4):
            document.begin("Move")
            document.move(np.arange(20), document.dots.position_mm[:20] * 0.9 + 0.1 * k)
            document.commit()
        assert "stays in memory" in caplog.text
        assert caplog.text.count("stays in memory") == 1
        assert all(step.path is None for step in document.history.steps)
        while document.undo():
            pass
        assert np.array_equal(document.dots.position_mm, start.position_mm)

    def test_a_step_whose_file_is_damaged_is_lost(self, tmp_path, caplog):
        path = tmp_path / "0.npz"
        path.write_bytes(b"PK\3\4 no archive")
        assert edit_of(Step("One", path=path, rest=Edit("One"))) is None
        assert "cannot be read" in caplog.text


class TestDocument:
    def test_what_is_refused(self):
        document = some_document()
        with pytest.raises(ValueError, match="no stroke"):
            document.cancel()
        document.begin("One")
        with pytest.raises(ValueError, match="always a page"):
            document.set(records.PAGE, 0, None)
        assert document.steps() is None
        document.cancel()
        assert document.steps() == []
        document.begin_draft("Stipple", 0, Style(n_dots=9))
        with pytest.raises(ValueError, match="dots are being made"):
            document.begin("Two")
        document.drop_draft()
        for call in (document.end_draft, document.drop_draft):
            assert call() is None
        assert document.merge(np.zeros((3, 2))) == 0
        assert document.merge_radii(np.ones(3, np.float32)) == 0

    def test_results_of_another_run_are_refused(self):
        document = some_document()
        document.begin_run("Relax")
        with pytest.raises(ValueError, match="not one of this run"):
            document.merge(np.zeros((3, 2)))
        with pytest.raises(ValueError, match="not one of this run"):
            document.merge_radii(np.ones(3, np.float32))

    def test_radii_of_a_run_leave_held_and_painted_dots(self):
        document = some_document()
        document.begin("Fix")
        document.change("constraint", np.array([2]), np.array([1], np.int8))
        document.commit()
        frozen = document.begin_run("Sizes")
        document.begin("Paint")
        document.change("radius_mm", np.array([5]), np.array([0.7], np.float32))
        document.commit()
        n = document.merge_radii(np.full(len(frozen), 0.4, np.float32))
        assert n == len(frozen) - 2
        expected = np.full(40, 0.4, np.float32)
        expected[2], expected[5] = 0.2, 0.7
        assert np.array_equal(document.dots.radius_mm, expected)
        document.end_run()
        assert [s.label for s in document.steps()] == ["Fix", "Sizes", "Paint"]

    def test_dots_of_locked_areas_stay_as_they_are(self):
        document = some_document()
        document.begin("Lock")
        document.set(records.AREA, 0, replace(document.drawing.areas[0], locked=True))
        document.commit()
        before = document.dots.copy()
        document.begin("Try")
        document.remove(np.array([1, 2]))
        document.change("radius_mm", np.array([1]), np.array([0.9], np.float32))
        assert len(document.insert(Dots.round([(5, 5)], 0.1))) == 0
        document.move(np.array([3]), np.array([[1.0, 1.0]]))
        assert document.commit().is_empty
        assert np.array_equal(document.dots.position_mm, before.position_mm)
        frozen = document.begin_run("Relax")
        assert document.merge(frozen.position_mm * 0.5) == 0
        assert document.merge_radii(frozen.radius_mm * 2) == 0

    def test_dots_go_to_the_area_that_they_lie_in(self):
        document = some_document()
        document.begin("Area")
        k = document.add(records.AREA, Area("left", shapely.box(0, 0, 10, 10)))
        moved = document.own_by_place(np.arange(40))
        left = document.dots.position_mm[:, 0] < 10
        assert moved.tolist() == np.flatnonzero(left).tolist()
        assert np.array_equal(document.dots.area == k, left)
        document.cancel()
        assert (document.dots.area == 0).all()

    def test_a_page_of_another_size_finds_dots_again(self):
        document = some_document()
        document.begin("Page")
        document.set(records.PAGE, 0, Page(40, 30))
        document.commit()
        assert document.drawing.page == Page(40, 30)
        x, y = document.dots.position_mm.T
        box = (3.0, 2.0, 11.0, 7.5)
        inside = (x >= box[0]) & (x <= box[2]) & (y >= box[1]) & (y <= box[3])
        assert np.array_equal(document.in_box(box), np.flatnonzero(inside))

    def test_a_draft_keeps_fixed_dots_where_it_is_asked_to(self):
        document = some_document()
        document.begin("Fix")
        document.change("constraint", np.array([2, 7]), np.ones(2, np.int8))
        document.commit()
        ids_fixed = document.dots.id[[2, 7]]
        document.begin_draft("Stipple", 0, Style(n_dots=3), keeps_fixed=True)
        document.draft(np.array([[1.0, 1.0], [2.0, 2.0]]), np.full(2, 0.1, np.float32))
        assert len(document.dots) == 4
        document.draft(np.array([[1.5, 1.0], [2.0, 2.5]]), np.full(2, 0.3, np.float32))
        document.end_draft()
        assert sorted(document.dots.id)[:2] == sorted(ids_fixed)
        assert document.dots.position_mm[-2:].tolist() == [[1.5, 1.0], [2.0, 2.5]]
        assert document.dots.radius_mm[-1] == np.float32(0.3)
        document.undo()
        assert len(document.dots) == 40

    def test_dots_of_a_draft_lie_along_the_edges_where_they_have_come_to_lie(self):
        """Dark left of x = 10, with an edge that goes up and down."""
        darkness = np.zeros((20, 40), np.float32)
        darkness[:, :20] = 1.0
        document = Document(Drawing.blank(Page(20, 10)))
        style = Style(n_dots=2, elongation=2.0, direction_by="edges", direction_deg=10.0)
        document.begin_draft("Stipple", 0, style, Reference(darkness, 20.0))
        assert document.in_draft
        document.draft(np.array([[2.0, 5.0], [17.0, 5.0]]), np.full(2, 0.3, np.float32))
        document.draft(np.array([[10.0, 5.0], [17.0, 5.0]]), np.full(2, 0.3, np.float32))
        document.end_draft()
        along = np.mod(document.dots.angle_rad, np.pi)
        assert along[0] == pytest.approx(np.pi / 2, abs=0.2)
        assert along[1] == pytest.approx(np.radians(10.0), abs=0.2)
        assert (document.dots.elongation >= 2.0).all()
        document.draft(np.zeros((1, 2)), np.ones(1, np.float32))  # there is none to show
        assert len(document.dots) == 2

    def test_a_draft_of_nothing_is_no_step(self):
        document = Document(Drawing.blank(Page(20, 10)))
        document.begin_draft("Stipple", 0, document.drawing.styles[0])
        assert document.end_draft().is_empty
        assert not document.history.steps

    @pytest.mark.parametrize("back", [True, False])
    def test_a_step_for_which_memory_runs_out_is_not_counted(self, monkeypatch, back):
        document = some_document()
        document.begin("Move")
        document.move(np.array([1]), np.array([[3.0, 3.0]]))
        document.commit()
        if not back:
            document.undo()
        before, n_done = document.dots.copy(), document.history.n_done

        def none_left(self, edit):
            raise MemoryError

        step = document.undo if back else document.redo
        with monkeypatch.context() as patch:
            patch.setattr(DotStore, "apply", none_left)
            with pytest.raises(MemoryError):
                step()
        assert document.history.n_done == n_done
        assert np.array_equal(document.dots.position_mm, before.position_mm)
        assert step()
        assert document.history.n_done == (0 if back else 1)

    def test_memory_is_counted(self):
        little, much = some_document(10), some_document(5000)
        assert much.n_bytes - little.n_bytes > 4990 * 62

    def test_what_was_done_beside_an_edit_of_areas_goes_with_it(self):
        document = some_document()
        made = Path.polyline([(1, 1), (9, 1), (9, 9), (1, 9)], closed=True)

        def fails(outcome):
            raise RuntimeError("no")

        with pytest.raises(RuntimeError, match="no"):
            edit_areas(document, "Draw", lambda m: edits.add(m, made), also=fails)
        assert list(document.drawing.areas) == [0]
        assert not document.history.steps
        assert not document.in_stroke
        edit_areas(document, "Draw", lambda m: edits.add(m, made), names={2: "left"}, style=0)
        assert document.drawing.areas[2].name == "left"  # no id is given twice
        assert current_map(document) is current_map(document)

    def test_areas_without_borders_are_laid_over_each_other(self):
        drawing = Drawing.blank(Page(20, 10))
        drawing.areas[3] = Area("one", shapely.box(1, 1, 9, 9))
        drawing.areas[5] = Area("two", shapely.box(5, 1, 15, 9))
        drawing.areas[6] = Area("none", shapely.Polygon())
        document = Document(drawing)
        found = current_map(document)
        found.check()
        assert found.areas == [0, 3, 5]
        assert found.outline(3).area == pytest.approx(32)
        assert current_map(document) is found


class TestValues:
    @pytest.mark.parametrize(
        ("make", "why"),
        [
            (lambda: Dots.round([(0, np.nan)], 0.1), "finite positions"),
            (lambda: Dots.round([(0, 0)], 0.0), "above 0"),
            (lambda: Picture.of(np.zeros(3, np.float32)), "2-d field"),
            (lambda: Picture.of(np.zeros((0, 3), np.float32)), "2-d field"),
            (lambda: Picture.of(np.full((2, 2), 1.1, np.float32)), "0..1"),
            (lambda: Picture.of(np.full((2, 2), np.nan, np.float32)), "0..1"),
            (lambda: Reference(np.zeros((2, 2), np.float32), 0.0), "no width"),
            (lambda: Reference(np.zeros((2, 2), np.float32), np.inf), "no width"),
            (lambda: ToneCurve(0.5, 0.5), "is no range"),
            (lambda: ToneCurve(-0.1, 0.5), "is no range"),
            (lambda: ToneCurve(gamma=0.0), "gamma"),
            (lambda: ToneCurve(deepest=1.1), "deepest"),
            (lambda: Pen("p", elongation=(2.0, 1.5)), "out of range"),
            (lambda: Pen("p", roughness=(0.0, 1.1)), "out of range"),
            (lambda: Pen("p", angle_rad=np.inf), "out of range"),
            (lambda: pen_named("spoon"), "one of technical-pen"),
            (lambda: ShapeChange(stretch=np.nan), "finite"),
            (lambda: ShapeChange(radius=to(np.inf)), "finite"),
            (lambda: Page(0, 5), "page|mm"),
            (lambda: Style.of(doots=5), "'doots' is unknown"),
            (lambda: Style.from_json({"doots": 5}), "'doots' is unknown"),
            (lambda: Style(name=5), "is no name"),
            (lambda: Style(sizes="regions", first_dots="random"), "has no regions"),
            (lambda: Style(sizes="regions", spacing="square"), "has no regions"),
            (lambda: Style(n_dots=5, density_per_cm2=5.0), "beside a number"),
            (lambda: Style(tone_white=0.5, tone_black=0.5), "is not below"),
        ],
    )
    def test_values_that_are_none(self, make, why):
        with pytest.raises((ParameterError, GeometryError), match=why):
            make()

    def test_dots_whose_ids_are_none_are_refused(self):
        for wrong in ([3, 3], [-1, 2], [0, ids.MAX_ID + 1]):
            dots = Dots.round([(0, 0), (1, 1)], 0.1)
            dots.id[:] = wrong
            with pytest.raises(GeometryError, match="unique"):
                DotStore(dots)

    def test_ids_far_apart_need_room_and_are_found(self):
        table = ids.IdTable()
        rng = np.random.default_rng(5)
        some = rng.choice(ids.MAX_ID // 4096, 3000, replace=False) * 4096 + rng.integers(0, 4096)
        table.put(some[:2], np.arange(2))
        table.put(some, np.arange(3000))
        assert np.array_equal(table.find(some), np.arange(3000))
        assert (table.find(some + 1)[~np.isin(some + 1, some)] == ids.GONE).all()
        table.drop(some[:100])
        assert (table.find(some[:100]) == ids.GONE).all()
        assert np.array_equal(table.find(some[100:]), np.arange(100, 3000))

    def test_a_value_of_another_kind_is_refused(self):
        page = Page(20, 10).to_json()
        assert value_from_json(records.PAGE, page, {}) == Page(20, 10)
        area = Area("a", shapely.box(0, 0, 1, 1)).to_json()
        assert value_from_json(records.AREA, area, {}).name == "a"
        for damage in ({"name": 5}, {"style": 1.5}, {"locked": 1}, {"rank": True}):
            with pytest.raises(TypeError, match="is not of the kind"):
                value_from_json(records.AREA, {**area, **damage}, {})

    def test_references_are_equal_by_picture_width_and_adjustment(self):
        darkness = np.linspace(0, 1, 12, dtype=np.float32).reshape(3, 4)
        one = Reference(darkness, 40.0)
        assert one == Reference(darkness, 40.0)
        assert hash(one) == hash(Reference(darkness, 40.0))
        assert one != Reference(darkness, 41.0)
        assert one != Reference(darkness * np.float32(0.5), 40.0)
        assert one != 5
        darker = one.adjusted(Adjustment(brightness=-0.2))
        assert darker != one
        assert darker.picture is one
        assert one.picture is one
        assert darker.adjusted(darker.adjustment) is darker
        assert darker.adjusted(Adjustment()) is one
        light = darker.light()
        assert light == darker
        assert np.array_equal(light.darkness, Adjustment(brightness=-0.2).apply(darkness))
        alone = Reference.of(one.source, 40.0, Adjustment(invert=True))
        assert alone.picture == one
        assert alone.picture is alone.picture

    def test_dots_of_hidden_areas_have_no_size_and_are_not_in_files(self):
        document = some_document()
        drawing = document.drawing
        assert hidden_areas(drawing) == frozenset()
        assert sized_zero(drawing.dots, frozenset()) is drawing.dots
        assert shown(drawing) is drawing
        drawing.areas[1] = Area("left", shapely.box(0, 0, 10, 10), hidden=True)
        drawing.dots.area[drawing.dots.position_mm[:, 0] < 10] = 1
        assert hidden_areas(drawing) == {1}
        assert hidden_areas(drawing, solo=1) == {0}
        assert hidden_areas(drawing, solo=7) == {1}
        left = drawing.dots.area == 1
        sized = sized_zero(drawing.dots, frozenset({1}))
        assert (sized.radius_mm[left] == 0).all()
        assert (sized.radius_mm[~left] == drawing.dots.radius_mm[~left]).all()
        assert np.array_equal(shown(drawing).dots.id, drawing.dots.id[~left])

    def test_a_preview_has_a_footprint_where_it_is_under_a_tip(self):
        tip = Footprint((1.0, 2.0), (1.0, 0.0, 0.0, 1.0), 3.0)
        assert Preview(ShapeChange(), tip).footprint is tip
        assert Preview(ShapeChange()).footprint is None

    def test_what_a_change_of_shape_may_do_to_round_smooth_dots(self):
        keep = ShapeChange()
        assert (keep.elongates, keep.roughens, keep.turns) == (False, False, False)
        assert ShapeChange(stretch=0.1).elongates
        assert ShapeChange(elongation=to(1.5)).elongates
        assert not ShapeChange(elongation=to(1.0)).elongates
        assert ShapeChange(roughness=to(0.0, 0.1)).roughens
        assert ShapeChange(roughness=to(0.1)).roughens
        assert not ShapeChange(roughness=to(0.0)).roughens
        assert ShapeChange(angle_rad=0.0).turns
        assert ShapeChange(scatter_rad=0.1).turns

    def test_styles_of_the_program_are_read_and_a_damaged_one_is_told(self, tmp_path):
        for key, preset in presets().items():
            assert preset.label == preset.style.name
            assert preset.swatch.stem == key
        good = {"name": "One", "about": "It is.", "style": {}}
        path = tmp_path / "one.json"
        path.write_text(json.dumps(good))
        assert _read(path).label == "One"
        for text in ("{", json.dumps({**good, "style": 5}), json.dumps({"name": "One"}), "[]"):
            path.write_text(text)
            with pytest.raises(StipplerError, match="is no style"):
                _read(path)
        with pytest.raises(StipplerError, match="is no style"):
            _read(tmp_path / "none.json")
