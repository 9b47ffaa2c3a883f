"""Every form of input gives the pairs of brute force, or one clear error."""

from __future__ import annotations

import warnings
from collections import namedtuple
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracle import DIMENSIONS, in_order, pairs, pairs_between, random_boxes

import sweep_and_prune as sap

BOXES = random_boxes(60, 2, np.float64)
PAIRS = pairs(BOXES)


def same(found: Any, wanted: Any = PAIRS) -> bool:
    return np.array_equal(in_order(found), wanted)


@pytest.mark.parametrize("dtype", [np.int64, np.int32, np.uint32, np.uint64, "i4", int])
def test_indices_have_the_wanted_type(dtype: Any) -> None:
    found = sap.find_pairs(BOXES, dtype=dtype)
    assert found.dtype == np.dtype(dtype) and same(found)
    between = sap.find_pairs_between(BOXES, BOXES, dtype=dtype)
    assert between.dtype == np.dtype(dtype) and same(between, pairs_between(BOXES, BOXES))
    assert same(sap.PairFinder(2, index_dtype=dtype).find(BOXES))
    chunks: list[Any] = []
    sap.for_each_chunk(BOXES, chunks.append, dtype=dtype)
    assert same(np.concatenate(chunks)) and chunks[0].dtype == np.dtype(dtype)


@pytest.mark.parametrize("dtype", [None, float, "i2", "nonsense", object, bool])
def test_other_types_of_indices_are_refused(dtype: Any) -> None:
    with pytest.raises(ValueError, match="dtype must be int64, int32, uint32 or uint64"):
        sap.find_pairs(BOXES, dtype=dtype)


@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_corners_may_have_an_axis_of_their_own(dimensions: int) -> None:
    boxes = random_boxes(50, dimensions, np.float32)
    assert same(sap.find_pairs(boxes.reshape(-1, 2, dimensions)), pairs(boxes))


def test_boxes_may_be_given_by_their_size() -> None:
    sizes = BOXES[:, 2:] - BOXES[:, :2]
    assert same(sap.find_pairs(np.hstack([BOXES[:, :2], sizes]), format="xywh"))
    assert same(sap.find_pairs(np.hstack([BOXES[:, :2] + sizes / 2, sizes]), format="cxcywh"))
    assert sap.count_pairs(np.hstack([BOXES[:, :2], sizes]).tolist(), format="xywh") == len(PAIRS)
    with pytest.raises(sap.InvalidBoxError):
        sap.find_pairs([[0, 0, -1, 1]], format="xywh")
    for wrong in ("xyXY", None, 3):
        with pytest.raises(ValueError, match="format must be"):
            sap.find_pairs(BOXES, format=wrong)  # type: ignore[arg-type]


class Frame:
    """The part of a data frame that is used: columns by name."""

    def __init__(self, **columns: Any) -> None:
        self.data = columns

    @property
    def columns(self) -> list[str]:
        return list(self.data)

    def __len__(self) -> int:
        return len(next(iter(self.data.values())))

    def __getitem__(self, name: str) -> Any:
        return self.data[name]


@pytest.mark.parametrize(
    "names",
    ["minx miny maxx maxy", "xmin ymin xmax ymax", "x_min y_min x_max y_max", "x1 y1 x2 y2", "x0 y0 x1 y1"]
    + ["left top right bottom", "Left Bottom Right Top", "MinX MinY MaxX MaxY", "west south east north"],
)
def test_columns_are_recognized_by_their_names(names: str) -> None:
    named = dict(zip(names.split(), BOXES.T))
    backwards = dict(reversed(list(named.items())))
    for frame in (Frame(**named), Frame(label=np.array(["a"] * 60), **backwards)):
        assert same(sap.find_pairs(frame))  # type: ignore[arg-type]
        assert same(sap.PairFinder(2).find(frame))  # type: ignore[arg-type]
        assert len(sap.BroadPhase(2).insert_many(frame)) == 60  # type: ignore[arg-type]
        assert same(sap.find_pairs(frame.data))
    rows = np.array([tuple(box) for box in BOXES], [(name, float) for name in names.split()])
    assert same(sap.find_pairs(rows)) and same(sap.find_pairs(rows.view(np.recarray)))


def test_columns_of_other_dimensions_and_formats() -> None:
    x, y, _, _ = BOXES.T
    width, height = (BOXES[:, 2:] - BOXES[:, :2]).T
    sized = Frame(x=x, y=y, w=width, h=height)
    assert same(sap.find_pairs(sized, format="xywh"))  # type: ignore[arg-type]
    centered = Frame(cx=x + width / 2, cy=y + height / 2, width=width, height=height)
    assert same(sap.find_pairs(centered, format="cxcywh"))  # type: ignore[arg-type]
    placed = Frame(left=x, top=y, width=width, height=height)  # as in COCO: no column is one of y's ends
    assert same(sap.find_pairs(placed, format="xywh"))  # type: ignore[arg-type]
    intervals = Frame(chrom=["a"] * 60, start=x, end=x + width)
    assert same(sap.find_pairs(intervals), pairs(np.stack([x, x + width], 1)))  # type: ignore[arg-type]
    of_ucsc = {"chromStart": x, "chromEnd": x + width}
    assert same(sap.find_pairs(of_ucsc), pairs(np.stack([x, x + width], 1)))
    with pytest.raises(ValueError, match="no columns that are known as boxes"):
        sap.find_pairs(Frame(xmin=x, xmax=x, ymin=y))  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="column start must have numbers, not text"):
        sap.find_pairs(Frame(start=np.array(["0", 1], object), end=np.array([2, 3])))  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"no columns that are known as boxes.*its columns are a, b; rename"):
        sap.find_pairs(Frame(a=x, b=y))  # type: ignore[arg-type]
    assert sap.count_pairs(np.empty((0, 2, 3))) == 0  # without boxes, too
    with pytest.raises(ValueError, match=r'its columns are x, y, w, h; pass format="xywh"'):
        sap.find_pairs(sized)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("names", "others", "format"),
    [
        ("x1 y1 x2 y2", "start end", "xyxy"),
        ("minx miny maxx maxy", "xmin ymin xmax ymax", "xyxy"),
        ("x1 y1 x2 y2", "x0 y0 x1 y1", "xyxy"),
        ("x1 x2", "start end", "xyxy"),
        ("minx miny minz maxx maxy maxz", "left top right bottom", "xyxy"),
        ("x y w h", "left top width height", "xywh"),
        ("start end", "bbox", "xyxy"),
    ],
)
def test_two_sets_of_known_columns_are_refused(names: str, others: str, format: str) -> None:
    frame: Any = {name: [0] for name in f"score {names} {others}".split()}
    said = f"the columns {', '.join(names.split())} and {', '.join(others.split())} are all known as boxes"
    with pytest.raises(ValueError, match=said):
        sap.find_pairs(frame, format=format)
    one: Any = {name: frame[name] for name in names.split()}
    assert sap.count_pairs(one, format=format) == 0


def test_one_set_of_known_columns_is_found_beside_similar_ones() -> None:
    x, y, width, height = np.hstack([BOXES[:, :2], BOXES[:, 2:] - BOXES[:, :2]]).T
    of_image: Any = dict(x=x, y=y, w=width, h=height, width=np.zeros(60), height=np.zeros(60))
    assert same(sap.find_pairs(of_image, format="xywh"))
    of_mot: Any = dict(frame=x, bb_left=x, bb_top=y, bb_width=width, bb_height=height)
    assert same(sap.find_pairs(of_mot, format="xywh"))
    of_yolo: Any = dict(x_center=x + width / 2, y_center=y + height / 2, width=width, height=height, x=x, y=y)
    assert same(sap.find_pairs(of_yolo, format="cxcywh"))


def test_columns_of_lists() -> None:
    arrow, pandas = pytest.importorskip("pyarrow"), pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    rows: Any = BOXES.tolist()
    gaps: Any = [None if index == 3 else row for index, row in enumerate(rows)]
    for gaps_too in (False, True):
        given, wanted = (gaps, PAIRS[(PAIRS != 3).all(axis=1)]) if gaps_too else (rows, PAIRS)
        for column in (
            pandas.Series(given),
            polars.Series(given, dtype=polars.List(polars.Float64)),
            arrow.array(given),
            arrow.array([[], *given], arrow.large_list(arrow.float64()))[1:],
            arrow.chunked_array([given[:20], given[20:]]),
        ):
            assert same(sap.find_pairs(column, missing="skip"), wanted)
        of_library = pandas.DataFrame, polars.DataFrame, arrow.table, lambda frame: frame
        for make in of_library if not gaps_too else of_library[:3]:
            assert same(sap.find_pairs(make({"n": list(range(60)), "bbox": given}), missing="skip"), wanted)
            assert same(sap.find_pairs(make({"bbox": given}), missing="skip"), wanted)
    for uneven in (arrow.array([[0, 0, 1, 1], None, [0, 1]]), np.array([[0, 0, 1, 1], None, [0, 1]], object)):
        with pytest.raises(ValueError, match=r"boxes\[2\] has 2 values, but boxes\[0\] has 4"):
            sap.find_pairs(uneven)


def test_lists_with_missing_numbers() -> None:
    rows: Any = [[0, 0, 1, None], [0, 0, 1, 1], [2**53 + 1, 0, 2**53 + 2, 1], [1, 1, 2, 2]]
    assert sap.find_pairs(rows, missing="skip").tolist() == [[1, 3]]
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[0\] has a NaN on axis 1"):
        sap.find_pairs(rows)


def test_what_is_nearly_boxes_is_refused_with_a_way_out() -> None:
    dicts: Any = [{"x1": 0}]
    sized: Any = dict(x=[0], y=[0], w=[1], h=[1])
    call: Any
    for call, message in (
        (lambda: sap.find_pairs(dicts), r"list of dicts: pass .* pandas\.DataFrame\(boxes\)"),
        (lambda: sap.find_pairs([[0, 0, 1, 1], [0, 0, 1]]), r"boxes\[1\] has 3 values, but boxes\[0\] has 4"),
        (lambda: sap.find_pairs([[0, 1]] * 3, by=[[1, 1, 1], [2, 2, 2]]), "not several arrays of them: pass a dict"),
        (lambda: sap.find_pairs([[0, 1]] * 3, by=np.zeros((2, 3))), "not several arrays of them: pass a dict"),
        (lambda: sap.find_pairs([[0, 1]], threads=-2), "threads must be -1 or from 1 to 1024, not -2"),
        (lambda: sap.BroadPhase(2).insert_many(sized), "y, w, h; pass min and max corners$"),
        (lambda: sap.PairFinder(2).find(sized), "y, w, h; pass min and max corners"),
    ):
        with pytest.raises((TypeError, ValueError), match=message):
            call()
    for keys in (
        [(1, 2), (1, 2), (1, 3)],
        {"key": [1, 1, 1], 2: [2, 2, 3]},
        np.array([(1, 2.5)] * 2 + [(1, 3)], "i8,f4"),
    ):
        assert sap.find_pairs([[0, 1]] * 3, by=keys).tolist() == [[0, 1]]
    assert sap.find_pairs([[0, 1]] * 2, threads=np.int64(-1)).tolist() == [[0, 1]]  # type: ignore[arg-type]


@pytest.mark.parametrize("dtype", [np.int64, np.float32, np.float64])
@pytest.mark.parametrize("format", ["xywh", "cxcywh"])
def test_a_negative_size_is_refused_even_on_a_circle(dtype: Any, format: str) -> None:
    boxes = np.array([[0, 0, 1, 1], [5, 5, 1, -3]], dtype)
    options: Any
    for options in ({}, {"wrap": 360}, {"missing": "skip"}, {"closed": "left"}):
        with pytest.raises(sap.InvalidBoxError, match=r"^boxes\[1\] has the size -3 on axis 1; it must be 0 or more$"):
            sap.find_pairs(boxes, format=format, **options)
    around = [[0, 1], [5, -3]]
    for call in (
        lambda: sap.find_pairs(around, format=format, wrap=360),
        lambda: sap.measure_overlaps(around, None, [[0, 1]], format=format, wrap=360),
        lambda: sap.merge(around, format=format),
    ):
        with pytest.raises(sap.InvalidBoxError, match=r"\[1\] has the size -3 on axis 0; it must be 0 or more"):
            call()


def test_missing_boxes_are_refused_or_left_out() -> None:
    boxes = BOXES.copy()
    boxes[[3, 40], [0, 3]] = np.nan
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[3\] has a NaN on axis 0"):
        sap.find_pairs(boxes)
    left = PAIRS[~np.isin(PAIRS, [3, 40]).any(axis=1)]
    assert same(sap.find_pairs(boxes, missing="skip"), left)
    assert sap.count_pairs(boxes, missing="skip") == len(left)
    between = pairs_between(BOXES, BOXES)
    assert same(sap.find_pairs_between(boxes, BOXES, missing="skip"), between[~np.isin(between[:, 0], [3, 40])])
    with pytest.raises(sap.InvalidBoxError, match="inverted"):
        sap.find_pairs([[1, 0]], missing="skip")
    with pytest.raises(ValueError, match="missing must be"):
        sap.find_pairs(boxes, missing="drop")


def test_masked_values_are_missing_and_not_ignored() -> None:
    masked = np.ma.array(BOXES, mask=np.zeros(BOXES.shape, bool))
    assert same(sap.find_pairs(masked))
    masked[3, 0] = np.ma.masked
    with pytest.raises(sap.InvalidBoxError):
        sap.find_pairs(masked)
    assert same(sap.find_pairs(masked, missing="skip"), PAIRS[~np.isin(PAIRS, [3]).any(axis=1)])
    with pytest.raises(ValueError, match="masked"):
        sap.find_pairs(np.ma.array([[0, 1], [0, 1]], mask=[[True, False], [False, False]]))
    assert same(sap.find_pairs(list(masked[4:])), PAIRS[(PAIRS >= 4).all(axis=1)] - 4)
    for lists in (list(masked), tuple(masked), [[row[:2], row[2:]] for row in masked]):
        with pytest.raises(ValueError, match=r"boxes has masked values in a list: pass one masked array"):
            sap.find_pairs(lists)


def test_more_than_double_precision_is_refused_where_it_would_be_rounded() -> None:
    step = np.finfo(np.longdouble).eps
    if step == np.finfo(float).eps:
        pytest.skip("here it is double precision")
    assert same(sap.find_pairs(BOXES.astype(np.longdouble)))
    apart = np.array([[0, 1], [1, 2]], np.longdouble)
    apart[1, 0] += step  # which double precision rounds to 1
    for boxes in (apart, apart.tolist(), list(apart), {"start": apart[:, 0], "end": apart[:, 1]}):
        for find in (sap.find_pairs, sap.count_pairs, sap.count_overlaps, sap.BroadPhase(1).insert_many):
            with pytest.raises(ValueError, match=r"which double precision does not have: round it, as .*astype"):
                find(boxes)
    with pytest.raises(ValueError, match=r"^margin is .*, which double precision does not have"):
        sap.find_pairs([[0, 1], [2, 3]], margin=np.longdouble(1) - step)
    tiny = np.array([[0, np.finfo(np.longdouble).tiny]])
    with np.errstate(all="raise"), pytest.raises(ValueError, match=r"^boxes\[0\]\[1\] is .*, which double precision"):
        sap.find_pairs(tiny)


def test_rows_with_names_are_read_by_them() -> None:
    Sides = namedtuple("Sides", "minx maxx miny maxy")
    Rectangle = namedtuple("Rectangle", "x y w h")
    Corners = namedtuple("Corners", "a b c d")
    sides = [Sides(*row) for row in BOXES[:, [0, 2, 1, 3]].tolist()]
    assert same(sap.find_pairs(sides))
    assert same(sap.find_pairs(tuple(sides)))
    assert same(sap.find_pairs([Corners(*row) for row in BOXES.tolist()]))
    rectangles = [Rectangle(*row) for row in np.hstack([BOXES[:, :2], BOXES[:, 2:] - BOXES[:, :2]]).tolist()]
    assert len(sap.find_pairs(rectangles, format="xywh")) == len(PAIRS)
    with pytest.raises(ValueError, match=r'boxes has no columns that are known as boxes.*pass format="xywh"'):
        sap.find_pairs(rectangles)
    with pytest.raises(ValueError, match=r"boxes\[60\] does not have the fields of boxes\[0\]: minx, maxx, miny, maxy"):
        sap.find_pairs([*sides, (0, 0, 1, 1)])
    world = sap.BroadPhase(2, dtype=np.float64)
    ids = world.insert_many(sides)
    assert np.array_equal([world.box(id) for id in ids], BOXES)
    world.set(ids[0], sides[1])
    assert np.array_equal(world.box(ids[0]), BOXES[1])
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(BOXES[:, [3, 0, 1, 2]], columns=["maxy", "minx", "miny", "maxx"])
    rows = [row for _, row in frame.iterrows()]
    for boxes in (list(frame.itertuples()), rows, list(frame.to_records())):
        assert same(sap.find_pairs(boxes))
    for box in (rows[5], frame.to_records()[5]):
        world.set(ids[0], box)
        assert np.array_equal(world.box(ids[0]), BOXES[5])


def test_points_with_names_are_read_by_them() -> None:
    pandas = pytest.importorskip("pandas")
    Point = namedtuple("Point", "y x")
    world = sap.BroadPhase(2)
    world.insert_many([[0, 5, 1, 6], [5, 0, 6, 1]])
    frame = pandas.DataFrame({"y": [5.5, 0.5], "X": [0.5, 5.5], "name": ["a", "b"]})
    points: Any
    for points in (frame, dict(frame), frame.to_records(), [Point(5.5, 0.5), Point(0.5, 5.5)]):
        assert world.containing_many(points).ids.tolist() == [0, 1]
        assert world.within_many(points, 0.1).ids.tolist() == [0, 1]
    for point, body in (
        (Point(5.5, 0.5), 0),
        (frame[["y", "X"]].iloc[1], 1),
        ((5.5, 0.5), 1),
        (np.array([0.5, 5.5]), 0),
    ):
        assert world.containing(point).tolist() == [body]
    with pytest.raises(ValueError, match=r"points\[1\] does not have the fields of points\[0\]: y, x"):
        world.containing_many([Point(5.5, 0.5), (0.5, 5.5)])
    Pair = namedtuple("Pair", "a b")
    assert world.containing(Pair(0.5, 5.5)).tolist() == [0]
    with pytest.raises(ValueError, match="points must have one column for each of x, y: its columns are y, name"):
        world.containing_many(frame[["y", "name"]])


def test_groups_with_the_labels_of_the_boxes_in_another_order_are_refused() -> None:
    pandas = pytest.importorskip("pandas")
    boxes = pandas.DataFrame(BOXES, columns=["minx", "miny", "maxx", "maxy"], index=range(100, 160))
    by = pandas.Series(np.arange(60) % 3, index=boxes.index)
    wanted = in_order(sap.find_pairs(boxes, by=by))
    for keys in (by[::-1], by[::-1].to_frame()):
        with pytest.raises(
            ValueError, match=r"by has the labels of boxes in another order: pass by\.loc\[boxes\.index\]"
        ):
            sap.find_pairs(boxes, by=keys)
    assert same(sap.find_pairs(boxes, by=by[::-1].loc[boxes.index]), wanted)
    assert same(sap.find_pairs(boxes, by=by.reset_index(drop=True)), wanted)  # other labels


def test_ranges_are_not_read_as_what_is_in_them() -> None:
    with pytest.raises(TypeError, match=r"boxes is a list of ranges: pass \[\[each\.start, each\.stop\]"):
        sap.find_pairs([range(2), range(1, 3)])


def test_reading_an_array_leaves_the_filters_of_warnings_alone() -> None:
    """All threads share them: changed for a moment, they make a warning in another thread an error there."""

    class Boxes(list[Any]):
        def __array__(self, *_args: Any, **_options: Any) -> Any:
            seen.append((warnings.filters, list(warnings.filters)))
            return BOXES

    seen: list[Any] = []
    for boxes in (Boxes(BOXES.tolist()), Boxes([])):
        assert same(sap.find_pairs(boxes))
    assert seen
    assert all(filters is warnings.filters and copy == warnings.filters for filters, copy in seen)


def test_a_tuple_of_two_arrays_is_not_read_as_boxes() -> None:
    starts, ends = np.array([0.0, 5.0]), np.array([1.0, 6.0])
    with pytest.raises(ValueError, match=r"np\.column_stack"):
        sap.find_pairs((starts, ends))
    assert len(sap.find_pairs(np.column_stack((starts, ends)))) == 0
    pandas = pytest.importorskip("pandas")
    for pair in ((pandas.Series(starts), pandas.Series(ends)), [pandas.Series(starts), pandas.Series(ends)]):
        with pytest.raises(ValueError, match=r"np\.column_stack"):
            sap.find_pairs(pair)


@pytest.mark.parametrize("values", [None, 5, (box for box in BOXES), object()])
def test_what_is_no_array_is_refused(values: Any) -> None:
    with pytest.raises(TypeError, match="boxes must be an array with a row for each box, not a "):
        sap.find_pairs(values)


small = st.lists(st.tuples(st.integers(-3, 3), st.integers(0, 3)), min_size=1, max_size=25)


@pytest.mark.parametrize("closed", ["left", "right", "neither"])
@pytest.mark.parametrize("kind", ["f4", "f8", "i8", "large", "M8[ns]"])
@settings(max_examples=40)
@given(intervals=small)
def test_open_ends_follow_their_definition(closed: str, kind: str, intervals: Any) -> None:
    array: Any = np.array([(start, start + length) for start, length in intervals])
    given_as = array + 2**60 if kind == "large" else array.astype(kind)
    half = array.shape[1] // 2
    low, high = array[:, :half], array[:, half:]
    overlap = ((low[:, None] < high[None]) & (low[None] < high[:, None])).all(axis=2)
    filled = (low < high).all(axis=1)
    wanted = np.argwhere(np.triu(overlap & filled[:, None] & filled[None], 1))
    assert same(sap.find_pairs(given_as, closed=closed), wanted)
    assert sap.count_pairs(given_as, closed=closed) == len(wanted)


def test_ends_are_closed_unless_said_otherwise() -> None:
    touching = [[0, 1], [1, 2]]
    assert sap.count_pairs(touching) == sap.count_pairs(touching, closed="both") == 1
    with pytest.raises(sap.InvalidBoxError):
        sap.find_pairs([[0, 0], [3, 2]], closed="left")
    with pytest.raises(ValueError, match="closed must be"):
        sap.find_pairs(touching, closed="open")


def test_integers_and_times_are_compared_exactly() -> None:
    large = 2**62 + np.array([[0, 10], [11, 20], [20, 30]])
    assert sap.find_pairs(large).tolist() == [[1, 2]]
    assert sap.find_pairs_between(large[:1], large[1:]).tolist() == []
    times = np.datetime64("2026-11-22T12:00:00", "ns") + np.array([[0, 10], [20, 30], [30, 40]])
    assert sap.find_pairs(times).tolist() == [[1, 2]]
    assert in_order(sap.find_pairs_between(times, times.astype("M8[s]"))).tolist() == [[0, 0], [0, 1], [0, 2]]
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[0\] is inverted"):
        sap.find_pairs(large[:, ::-1])
    times[1, 0] = "NaT"
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] has a NaN"):
        sap.find_pairs(times)
    assert sap.find_pairs(times, missing="skip").tolist() == []


@pytest.mark.parametrize("dimensions", DIMENSIONS)
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_groups_never_pair_with_each_other(dimensions: int, dtype: Any) -> None:
    boxes = random_boxes(80, dimensions, dtype)
    by = np.array(["chr1", "chr2", "X"])[np.arange(80) % 3]
    wanted = pairs(boxes)
    wanted = wanted[by[wanted[:, 0]] == by[wanted[:, 1]]]
    assert len(wanted) and same(sap.find_pairs(boxes, by=by), wanted)
    assert sap.count_pairs(boxes, by=by.tolist()) == len(wanted)
    between = pairs_between(boxes[:30], boxes)
    between = between[by[between[:, 0]] == by[between[:, 1]]]
    assert same(sap.find_pairs_between(boxes[:30], boxes, by=(by[:30], by)), between)
    assert sap.count_pairs_between(boxes[:30], boxes, by=(by[:30], by)) == len(between)
    boxes[5, 0] = np.nan
    kept = wanted[(wanted != 5).all(axis=1)]
    assert same(sap.find_pairs(boxes, by=by, missing="skip"), kept)
    with pytest.raises(ValueError, match="by must have one value for each box"):
        sap.find_pairs(boxes, by=by[:-1])


def test_groups_may_be_a_column_of_the_boxes() -> None:
    labels = np.array(list("abc"))[np.arange(60) % 3]
    named = dict(zip(("xmin", "ymin", "xmax", "ymax"), BOXES.T), kind=labels)
    wanted, between = sap.find_pairs(BOXES, by=labels), sap.find_pairs_between(BOXES, BOXES, by=(labels, labels))
    for form in (Frame(**named), named):
        boxes: Any = form
        assert np.array_equal(sap.find_pairs(boxes, by="kind"), wanted)
        assert np.array_equal(sap.find_pairs_between(boxes, boxes, by="kind"), between)
        assert sap.count_pairs_between(boxes, BOXES, by=("kind", labels)) == len(between)
        with pytest.raises(ValueError, match="by is 'class', but the columns of a are xmin, ymin, xmax, ymax, kind"):
            sap.find_pairs_between(boxes, boxes, by="class")
    with pytest.raises(ValueError, match="by is 'kind', but boxes has no named columns"):
        sap.find_pairs(BOXES, by="kind")


def test_groups_may_be_of_any_type() -> None:
    boxes = np.zeros((6, 2))
    for by, wanted in (
        ([1, "1", None, 1, None, "1"], [[0, 3], [1, 5]]),  # a box without a group pairs with none
        ([0.5, np.nan, 1, np.nan, 0.5, 2], [[0, 4]]),
        (np.array(["a", np.nan, "a", float("nan"), None, "b"], object), [[0, 2]]),
        (np.array(["2026-01-01", "2026-01-02"] * 3, "M8[D]"), [[0, 2], [0, 4], [1, 3], [1, 5], [2, 4], [3, 5]]),
        ([True, False, True, False, False, False], [[0, 2], [1, 3], [1, 4], [1, 5], [3, 4], [3, 5], [4, 5]]),
    ):
        for values in (by, np.array(by, object)):
            assert in_order(sap.find_pairs(boxes, by=values)).tolist() == wanted
    for nothing in (np.nan, None) if hasattr(np, "dtypes") and hasattr(np.dtypes, "StringDType") else ():
        text = np.array(["a", nothing, nothing, "a", "b", "c"], np.dtypes.StringDType(na_object=nothing))
        assert sap.find_pairs(boxes, by=text).tolist() == [[0, 3]]
    with pytest.raises(TypeError, match="by has numbers in a, but text in b, which are never equal"):
        sap.find_pairs_between(boxes, boxes, by=([1] * 6, ["1"] * 6))
    unhashable = np.empty(6, object)
    unhashable[:] = [[1], [2], [3], [4], [5], [6]]
    with pytest.raises(TypeError, match="values that can be compared"):
        sap.find_pairs(boxes, by=unhashable)


def test_int32_is_compared_in_double_precision_and_rounded_only_by_single_finders() -> None:
    boxes = np.array([[0, 2**24], [2**24 + 1, 2**25]], np.int32)
    assert len(sap.find_pairs(boxes)) == 0
    assert len(sap.PairFinder(1, np.float32).find(boxes)) == 1
    assert len(sap.PairFinder(1, np.float64).find(boxes)) == 0


def test_frames_of_pandas() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(BOXES[:, ::-1], columns=["maxy", "maxx", "miny", "minx"], index=range(100, 160))
    assert same(sap.find_pairs(frame))
    frame = pandas.DataFrame((BOXES * 2).astype(int), columns=["x1", "y1", "x2", "y2"]).astype("Int64")
    assert same(sap.find_pairs(frame))
    frame.loc[3, "x2"] = pandas.NA
    assert same(sap.find_pairs(frame, missing="skip"), PAIRS[~np.isin(PAIRS, [3]).any(axis=1)])
    assert same(sap.find_pairs(frame.dropna().assign(collect=1, column_names=2)), sap.find_pairs(frame.dropna()))
    index = pandas.IntervalIndex.from_arrays([0, 1, 3], [1, 3, 4])  # closed on the right
    assert len(sap.find_pairs(index)) == 0
    assert sap.find_pairs(index.set_closed("both")).tolist() == [[0, 1], [1, 2]]
    for form in (index.array, pandas.Series(index)):
        assert len(sap.find_pairs(form)) == 0 and len(sap.find_pairs(form, closed="both")) == 2


def is_exact(form: Any) -> bool:
    return len(sap.find_pairs(form, missing="skip")) == 0 and len(sap.find_pairs(form, missing="skip", margin=1)) == 1


LARGE: Any = [2**60, 2**60 + 1]  # equal in floating point


def test_integers_of_pandas_are_not_rounded_because_others_are_missing() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({name: pandas.array([*LARGE, None], "Int64") for name in ("start", "end")})
    assert is_exact(frame) and is_exact(frame.astype(object))
    assert len(sap.find_pairs(frame[:2])) == 0


def test_integers_of_arrow_are_not_rounded_because_others_are_missing() -> None:
    arrow = pytest.importorskip("pyarrow")
    table = arrow.table({"start": [*LARGE, None], "end": [*LARGE, None]})
    rows = [[number, number] for number in LARGE]
    fixed = arrow.array([*rows, None], arrow.list_(arrow.int64(), 2))
    assert is_exact(table) and is_exact(table.to_struct_array()) and is_exact(fixed)
    assert len(sap.find_pairs(table[:2])) == len(sap.find_pairs(fixed[:2])) == 0


def test_geometries_of_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    shapes = shapely.box(*BOXES.T)
    assert same(sap.find_pairs(shapes))
    assert same(sap.find_pairs(shapes.tolist()))
    shapes[3] = None
    with pytest.raises(sap.InvalidBoxError):
        sap.find_pairs(shapes)
    assert same(sap.find_pairs(shapes, missing="skip"), PAIRS[~np.isin(PAIRS, [3]).any(axis=1)])


def test_series_and_frames_of_geometries() -> None:
    shapely, pandas = pytest.importorskip("shapely"), pytest.importorskip("pandas")
    shapes = shapely.box(*BOXES.T)
    assert same(sap.find_pairs(pandas.Series(shapes)))
    series = pytest.importorskip("geopandas").GeoSeries(shapes)
    frame = series.to_frame("shape").set_geometry("shape").assign(kind=np.arange(60) % 2)
    for form in (series, series.array, frame):
        assert same(sap.find_pairs(form))
    assert np.array_equal(sap.find_pairs(frame, by="kind"), sap.find_pairs(BOXES, by=np.arange(60) % 2))


def test_tables_of_arrow() -> None:
    arrow = pytest.importorskip("pyarrow")
    table = arrow.table(dict(zip(["xmin", "ymin", "xmax", "ymax"], BOXES.T)))
    assert same(sap.find_pairs(table))


def test_nested_arrays_of_arrow() -> None:
    arrow = pytest.importorskip("pyarrow")
    table = arrow.table(dict(zip(["xmin", "ymin", "xmax", "ymax"], BOXES.T)))
    struct = table.to_struct_array()
    fixed = arrow.FixedSizeListArray.from_arrays(arrow.array(BOXES.ravel()), 4)
    without_first = pairs(BOXES[1:])
    for nested in (struct, fixed, struct.combine_chunks(), arrow.chunked_array([fixed[:20], fixed[20:]])):
        assert same(sap.find_pairs(nested))
        assert same(sap.find_pairs(nested[1:]), without_first)
        assert len(sap.find_pairs(nested[:0])) == 0
        assert same(sap.PairFinder(2).find(nested))
    assert same(sap.find_pairs(arrow.table({"name": ["a"] * 60, "bbox": struct})))
    sizes = np.hstack([BOXES[:, :2], BOXES[:, 2:] - BOXES[:, :2]])
    fixed = arrow.FixedSizeListArray.from_arrays(arrow.array(sizes.ravel()), 4)
    assert same(sap.find_pairs(fixed, format="xywh"))
    rows: Any = [None if index == 3 else row for index, row in enumerate(BOXES.tolist())]
    rows[5][2] = None
    gaps = arrow.array(rows, arrow.list_(arrow.float64(), 4))
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[3\] has a NaN"):
        sap.find_pairs(gaps)
    assert same(sap.find_pairs(gaps, missing="skip"), PAIRS[~np.isin(PAIRS, [3, 5]).any(axis=1)])
    with pytest.raises(ValueError, match="no columns that are known"):
        sap.find_pairs(arrow.table({"a": [1], "b": [2]}).to_struct_array())


def test_frames_of_polars() -> None:
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame(dict(zip(["xmin", "ymin", "xmax", "ymax"], BOXES.T)))
    assert same(sap.find_pairs(frame))
    assert same(sap.find_pairs(frame.to_struct("box")))
    with pytest.raises(TypeError, match=r"boxes is a LazyFrame, .* collect\(\)"):
        sap.find_pairs(frame.lazy())
    assert same(sap.find_pairs(polars.Series(BOXES.tolist(), dtype=polars.Array(polars.Float64, 4))))


def test_tensors_of_torch() -> None:
    torch = pytest.importorskip("torch")
    assert same(sap.find_pairs(torch.tensor(BOXES, requires_grad=True)))


def test_what_is_like_a_tensor_of_torch() -> None:
    class Tensor:
        def __init__(self, where: str) -> None:
            self.where = where

        def detach(self) -> Tensor:
            return Tensor("gpu, without gradient" if self.where == "gpu" else self.where)

        def cpu(self) -> Tensor:
            return Tensor("cpu" if self.where == "gpu, without gradient" else self.where)

        def __array__(self, *_: Any, **__: Any) -> Any:
            if self.where != "cpu":
                raise TypeError("can't convert it to numpy")
            return BOXES

    assert same(sap.find_pairs(Tensor("gpu")))


@pytest.mark.parametrize("dtype", ["i8", "i4", "u1", "u8", ">i4"])
@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_whole_numbers_without_ends_in_any_order_of_memory(dimensions: int, dtype: str) -> None:
    boxes = np.arange(14 * dimensions).reshape(7, 2 * dimensions).astype(dtype) % 50
    boxes[:, dimensions:] += 40
    boxes[3] = boxes[2] + np.array(40, dtype)  # touches, in one corner
    wanted = sap.find_pairs(boxes.tolist(), closed="left").tolist()
    for form in (boxes, np.asfortranarray(boxes), np.repeat(boxes, 2, axis=0)[::2], boxes[:, ::-1][:, ::-1]):
        assert sap.find_pairs(form, closed="left").tolist() == wanted
        assert sorted(sap.find_pairs_between(form, form, closed="neither").tolist()) == sorted(
            [*wanted, *([b, a] for a, b in wanted), *([row, row] for row in range(7))]
        )
    assert sap.count_pairs(np.array([[2**53, 2**53 + 1], [2**53 + 1, 2**53 + 2]]), closed="left") == 0
    assert sap.count_pairs(np.array([[0, 0], [0, 2]]), closed="left") == 0
