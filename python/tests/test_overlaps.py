"""Counts, sizes, clusters, coverage and nearest boxes against their definitions, tested on all pairs of Python's own
numbers; and against bioframe and geopandas."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from decimal import Decimal
from fractions import Fraction
from random import Random
from typing import Any

import numpy as np
import pytest

import sweep_and_prune as sap
from sweep_and_prune import _intervals

CALLS = int(os.environ.get("CALLS", 20_000 if "TEST_LONG" in os.environ else 600))
SEED = int(os.environ.get("SEED", 1))


class Boxes:
    """Random boxes with few distinct coordinates, as they are passed and as Python's own numbers."""

    def __init__(self, random: Random, dimensions: int, kind: str, groups: list[Any], may_miss: bool) -> None:
        count = random.choice([0, 1, 2, 5, 9])
        offset = {"large": 2**62, "times": 10**9}.get(kind, 0)
        step = Fraction(1, 4) if kind in ("float32", "float64") else 1
        self.rows: list[list[Any]] = []
        self.groups = [random.choice(groups) for _ in range(count)]
        for _ in range(count):
            pairs = [sorted(random.randint(0, 12) * step + offset for _ in "lh") for _ in range(dimensions)]
            self.rows.append([*(low for low, _ in pairs), *(high for _, high in pairs)])
        self.missing = [may_miss and random.random() < 0.15 for _ in range(count)]
        numbers = [[float(one) if step != 1 else int(one) for one in row] for row in self.rows]
        shape = (count, 2 * dimensions)
        if kind == "times":
            array: Any = np.array(numbers, np.int64).reshape(shape).view("M8[s]")
            array[np.array(self.missing, bool)] = "NaT"
        elif kind == "large":
            array = np.array(numbers, np.uint64 if offset else np.int64).reshape(shape)
            self.missing = [False] * count
        else:
            array = np.array(numbers, kind).reshape(shape)
            if array.dtype.kind == "f":
                array[np.array(self.missing, bool)] = np.nan
            else:
                self.missing = [False] * count
        self.given = array

    def present(self) -> Iterator[int]:
        return (row for row, is_missing in enumerate(self.missing) if not is_missing)


def overlap(a: list[Any], b: list[Any], closed: str, margin: Any) -> bool:
    half = len(a) // 2
    if closed != "both" and any(box[axis] == box[axis + half] for box in (a, b) for axis in range(half)):
        return False
    ends = [(x[axis], y[axis + half] + margin) for axis in range(half) for x, y in ((a, b), (b, a))]
    return all(low <= high if closed == "both" else low < high for low, high in ends)


def gaps(a: list[Any], b: list[Any]) -> list[Any]:
    half = len(a) // 2
    return [max(a[axis] - b[axis + half], b[axis] - a[axis + half], 0) for axis in range(half)]


def plain(values: Any) -> list[Any]:
    """Results as Python's own numbers; durations in seconds."""
    array = np.asarray(values)
    items = array.astype("m8[s]").astype(np.int64).tolist() if array.dtype.kind == "m" else array.tolist()
    return [Fraction(one) if isinstance(one, float) and math.isfinite(one) else one for one in items]


def one_call(random: Random) -> None:
    kind = random.choice(["int64", "int32", "float32", "float64", "large", "times"])
    dimensions = random.choice([1, 1, 1, 2, 3]) if kind != "times" else 1
    has_groups = random.random() < 0.5
    groups: list[Any] = random.choice([["x", "y"], [1, 2, 3]]) if has_groups else [0]
    a, b = (Boxes(random, dimensions, kind, groups, random.random() < 0.5) for _ in "ab")
    closed = random.choice(["both", "left", "neither"])
    margin = 0 if random.random() < 0.5 else random.choice([1, 2])
    given = np.timedelta64(margin, "s") if kind == "times" and margin else margin
    options: dict[str, Any] = {"closed": closed, "missing": "skip", "margin": given}
    of_one: dict[str, Any]
    of_two: dict[str, Any]
    of_one, of_two = ({"by": a.groups}, {"by": (a.groups, b.groups)}) if has_groups else ({}, {})
    said = f"{kind} {options} {of_two}\n{a.given.tolist()}\n{b.given.tolist()}"

    def pairs(first: Boxes, second: Boxes, closed: str, margin: Any) -> list[tuple[int, int]]:
        return [
            (i, j)
            for i in first.present()
            for j in second.present()
            if first.groups[i] == second.groups[j] and overlap(first.rows[i], second.rows[j], closed, margin)
        ]

    between = pairs(a, b, closed, margin)
    among = [(i, j) for i, j in pairs(a, a, closed, margin) if i != j]
    counts = [sum(i == row for i, _ in between) for row in range(len(a.rows))]
    assert sap.count_overlaps(a.given, b.given, **options, **of_two).tolist() == counts, said
    counts = [sum(i == row for i, _ in among) for row in range(len(a.rows))]
    assert sap.count_overlaps(a.given, **options, **of_one).tolist() == counts, said

    touching = pairs(a, b, "both", 0)
    every = [(i, j) for i in a.present() for j in b.present()]
    found = sap.measure_overlaps(a.given, b.given, np.array(every, np.int64).reshape(-1, 2))
    half = dimensions

    def size(box: list[Any]) -> Any:
        return math.prod(max(high - low, 0) for low, high in zip(box[:half], box[half:]))

    assert {len(values) for values in found} == {len(every)}, said
    for (i, j), (shared, of_a, of_b, iou) in zip(every, zip(plain(found.size), *found[1:])):
        first, second = a.rows[i], b.rows[j]
        common = [*map(max, zip(first[:half], second[:half])), *map(min, zip(first[half:], second[half:]))]
        assert shared == size(common), said
        for share, whole in ((of_a, size(first)), (of_b, size(second)), (iou, size(first) + size(second) - shared)):
            assert math.isnan(share) if whole == 0 else share == pytest.approx(float(Fraction(shared) / whole)), said

    k = random.choice([1, 1, 2, 20])
    limit = random.choice([None, None, 0, 1, 3, 6])
    how = random.choice(["inner", "left"])
    near: list[Any] = []
    for i in range(len(a.rows)):
        squares = []
        for j in b.present() if not a.missing[i] else []:
            square = sum(gap * gap for gap in gaps(a.rows[i], b.rows[j]))
            if a.groups[i] == b.groups[j] and (limit is None or square <= limit * limit):
                apart = -1 if overlap(a.rows[i], b.rows[j], closed, 0) else square  # before what merely touches
                squares.append((apart, j, square))
        near += [(i, j, square) for _, j, square in sorted(squares)[:k]]
        if not squares and how == "left":
            near.append((i, -1, None))
    reach = np.timedelta64(limit, "s") if kind == "times" and limit is not None else limit
    asked = {"max_distance": reach, "how": how, "closed": closed, "missing": "skip", **of_two}
    nearest = sap.nearest(a.given, b.given, k, **asked)
    assert [tuple(pair) for pair in nearest.pairs.tolist()] == [(i, j) for i, j, _ in near], said
    assert len(nearest.distances) == len(near), said
    for exact, distance, (_, j, square) in zip(nearest.distances, plain(nearest.distances), near):
        if j == -1:
            assert exact == -1 if nearest.distances.dtype.kind in "iuO" else exact != exact, said  # or NaN, or NaT
        elif half == 1:
            assert distance * distance == square, said
        else:
            assert float(distance) == pytest.approx(math.sqrt(square)), said

    clusters = clusters_of(a, among)
    assert sap.cluster(a.given, **options, **of_one).tolist() == clusters, said
    merged = sap.merge(a.given, **options, **of_one)
    wanted = []
    for label in range(max(clusters, default=-1) + 1):
        rows = [row for row, of_row in enumerate(clusters) if of_row == label]
        sides = [*zip(*(a.rows[row] for row in rows))]
        wanted.append(((*map(min, sides[:half]), *map(max, sides[half:])), len(rows), rows[0]))
    corners = (merged.intervals.view(np.int64) if kind == "times" else merged.intervals).tolist()
    assert [(tuple(map(Fraction, ends)), *rest) for ends, *rest in zip(corners, *merged[1:])] == wanted, said
    if half == 1:
        covered = []
        for i in range(len(a.rows)):
            others = [b.rows[j] for other, j in touching if other == i]
            marks = sorted({end for box in [a.rows[i], *others] for end in box})
            inner = [
                high - low
                for low, high in zip(marks, marks[1:])
                if a.rows[i][0] <= low < high <= a.rows[i][1] and any(o[0] <= low and high <= o[1] for o in others)
            ]
            covered.append(sum(inner) if not a.missing[i] else 0)
        assert plain(sap.coverage(a.given, b.given, missing="skip", **of_two)) == covered, said


def clusters_of(boxes: Boxes, among: list[tuple[int, int]]) -> list[int]:
    """The components of a graph, numbered by their first rows."""
    label = [*range(len(boxes.rows))]
    for _ in label:
        for i, j in among:
            label[i] = label[j] = min(label[i], label[j])
    numbers: dict[int, int] = {}
    return [-1 if gone else numbers.setdefault(one, len(numbers)) for one, gone in zip(label, boxes.missing)]


def test_each_answer_is_that_of_its_definition() -> None:
    for seed in range(SEED, SEED + CALLS):
        try:
            one_call(Random(seed))
        except Exception as error:
            raise AssertionError(f"SEED={seed} CALLS=1: {type(error).__name__} {error}") from error


def join_call(random: Random, library: Any) -> None:
    """One join of frames whose columns have names of their own."""
    tables = []
    for side in "lr":
        count = random.choice([0, 1, 3, 8])
        ends = [sorted(random.randint(0, 9) for _ in "lh") for _ in range(count)]
        columns = {f"from_{side}": [low for low, _ in ends], f"to_{side}": [high for _, high in ends]}
        columns |= {f"kind_{side}": [random.choice([1, 2]) for _ in ends], f"row_{side}": [*range(count)]}
        tables.append((ends, columns[f"kind_{side}"], library.DataFrame(columns)))
    (ends_l, kinds_l, left), (ends_r, kinds_r, right) = tables
    how = random.choice(["inner", "left", "right", "semi", "anti"])
    fraction = random.choice([None, 0.5, (0.5, 0), (0, 1)])
    options: dict[str, Any] = {"left_columns": ["from_l", "to_l"], "right_columns": ["from_r", "to_r"]}
    if by := random.random() < 0.5:
        options |= {"left_by": "kind_l", "right_by": ["kind_r"]}
    least = (0, 0) if fraction is None else (fraction, fraction) if isinstance(fraction, float) else fraction
    wanted: list[Any] = []
    for i, (low, high) in enumerate(ends_l):
        for j, (start, end) in enumerate(ends_r):
            shared = min(high, end) - max(low, start)
            sizes = high - low, end - start
            is_enough = fraction is None or all(
                one and Fraction(shared, one) >= part for one, part in zip(sizes, least)
            )
            if shared >= 0 and (not by or kinds_l[i] == kinds_r[j]) and is_enough:
                wanted.append((i, j, shared, *(Fraction(shared, one) if one else None for one in sizes)))
    matched = [{row[side] for row in wanted} for side in (0, 1)]
    if how in ("semi", "anti"):
        found = sap.join(left, right, how, fraction=fraction, **options)
        rows = [row for row in range(len(ends_l)) if (row in matched[0]) == (how == "semi")]
        assert found["row_l"].to_list() == rows and list(found.columns) == list(left.columns)
        return
    if how == "left":
        wanted += [(i, None, None, None, None) for i in range(len(ends_l)) if i not in matched[0]]
    if how == "right":
        wanted += [(None, j, None, None, None) for j in range(len(ends_r)) if j not in matched[1]]
    kept = how == "right"
    wanted.sort(key=lambda row: (row[kept], -1 if row[not kept] is None else row[not kept]))
    measures = ["size", "fraction_left", "fraction_right"]
    joined = sap.join(left, right, how, fraction=fraction, measures=measures, **options)
    columns_of = [joined[name].to_list() for name in ("row_l", "row_r", *measures)]
    rows_of = [tuple(None if one is None or one != one else Fraction(one) for one in row) for row in zip(*columns_of)]
    close = [tuple(None if one is None else pytest.approx(float(one)) for one in row) for row in wanted]
    assert rows_of == close, f"{how} {fraction} {by}"


@pytest.mark.parametrize("library", ["pandas", "polars"])
def test_joins_measure_and_choose_their_pairs(library: str) -> None:
    frames = pytest.importorskip(library)
    for seed in range(SEED, SEED + CALLS // 4):
        try:
            join_call(Random(seed), frames)
        except Exception as error:
            raise AssertionError(f"SEED={seed} CALLS=4: {type(error).__name__} {error}") from error


def test_on_attribute_is_by() -> None:
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame({"start": [0, 0], "end": [1, 1], "kind": ["a", "b"]})
    assert sap.join(frame, frame, on_attribute="kind").equals(sap.join(frame, frame, by=["kind"]))
    with pytest.raises(ValueError, match="by and on_attribute are the same"):
        sap.join(frame, frame, by="kind", on_attribute="kind")
    with pytest.raises(ValueError, match="left_by and right_by must name as many columns"):
        sap.join(frame, frame, left_by="kind")
    for columns, said in ((["start", "q"], "left has no such column; its columns are start, end, kind"), ("start", "")):
        with pytest.raises((ValueError, TypeError), match=f"left_columns .*{said}"):
            sap.join(frame, frame, left_columns=columns)
    with pytest.raises(ValueError, match='how="anti" returns rows of the left frame, not pairs: leave out measures'):
        sap.join(frame, frame, "anti", measures=["size"])
    for fraction in (-1, 2, (0.5, 0.5, 0.5), float("nan")):
        with pytest.raises(ValueError, match="must be a number from 0 to 1, or two of them"):
            sap.join(frame, frame, fraction=fraction)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="measures must be of size, fraction_left, fraction_right, iou, not 'area'"):
        sap.join(frame, frame, measures=["area"])


def test_what_is_wrong_is_said() -> None:
    plane: Any = [[0, 0, 1, 1]]
    with pytest.raises(ValueError, match=r"intervals must be of shape \(n, 2\), starts and ends, not of 4 columns"):
        sap.coverage(plane, plane)
    for boxes in (plane, [[0, 0, 0, 1, 1, 1]]):
        with pytest.raises(ValueError, match=rf"starts and ends, not of {len(boxes[0])} columns"):
            sap.coverage(boxes, boxes, by=([1], [1]))
    call: Any
    for call in (sap.cluster, sap.merge):
        with pytest.raises(ValueError, match="format must be"):
            call(plane, format="wrong")
    with pytest.raises(sap.InvalidBoxError, match=r"a\[1\] is inverted"):
        sap.nearest([*plane, [2, 0, 1, 1]], plane)
    wrong: Any
    for wrong, kind in ((-1, ValueError), (float("nan"), TypeError), (math.inf, ValueError), ("x", TypeError)):
        with pytest.raises(kind, match="max_distance"):
            sap.nearest(plane, plane, max_distance=wrong)
    with pytest.raises(ValueError, match="how must be"):
        sap.nearest([[0, 1]], [[0, 1]], how="right")
    with pytest.raises(ValueError, match="k must be from 1"):
        sap.nearest([[0, 1]], [[0, 1]], 0)
    with pytest.raises(sap.InvalidBoxError, match=r"b\[0\] is inverted"):
        sap.coverage([[0, 1]], [[2, 1]])
    for pairs, said in (([[0, 1]], "the index 1; it must be from 0 to 0"), ([0], "must be"), ([[0.0, 0.5]], "must be")):
        with pytest.raises(ValueError, match=f"pairs .*{said}"):
            sap.measure_overlaps(plane, None, pairs)


def test_components_of_many_boxes_are_those_of_scipy() -> None:
    csgraph = pytest.importorskip("scipy.sparse.csgraph")
    sparse = pytest.importorskip("scipy.sparse")
    random = np.random.default_rng(5)
    low = random.random((20_000, 2))
    chain = np.arange(20_000)[::-1, None] * [1, 0]
    for boxes in (
        np.hstack([low, low + 0.006]),
        np.hstack([chain, chain + 1]),
        random.permutation(np.hstack([chain, chain + 1])),
    ):
        pairs = sap.find_pairs(boxes)
        graph = sparse.coo_matrix((np.ones(len(pairs), bool), tuple(pairs.T)), (len(boxes), len(boxes)))
        number, labels = csgraph.connected_components(graph, directed=False)
        found = sap.cluster(boxes)
        assert found.max() + 1 == number == len({*zip(found.tolist(), labels.tolist())})
        shifted = np.hstack([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]])
        assert sap.cluster(shifted, format="xywh").tolist() == found.tolist()
        assert sap.merge(boxes).counts.tolist() == np.bincount(found).tolist()


def test_infinite_intervals_have_distances() -> None:
    inf = math.inf
    a, b = np.array([[-inf, 0], [5, inf], [inf, inf]]), np.array([[-inf, inf], [1, 2], [inf, inf]])
    found = sap.nearest(a, b, 3)
    assert found.pairs[:, 0].tolist() == [0, 0, 0, 1, 1, 1, 2, 2, 2]
    assert found.distances.tolist() == [0, 1, inf, 0, 0, 3, 0, 0, inf]


@pytest.mark.parametrize("dimensions", [2, 3])
def test_the_nearest_boxes_are_found_however_far_away_they_are(dimensions: int) -> None:
    random = np.random.default_rng(dimensions)
    for number in range(60):
        sets = []
        for count, place in ((30, 0), (40, random.choice([0, 5, 1e3, 1e9]))):
            low = place + random.integers(0, 9, (count, dimensions)) * random.choice([1, 1.1])
            sets.append(np.hstack([low, low + random.choice([0, 1, 50], (count, dimensions))]))
        a, b = sets
        a[0, random.integers(dimensions)] = b[0, random.integers(dimensions)] = -math.inf
        a[1, dimensions:], a[2], b[1] = math.inf, math.inf, math.inf
        groups = [random.integers(0, random.choice([1, 5]), len(of_set)) for of_set in sets]
        k = int(random.choice([1, 3, 60]))
        with np.errstate(invalid="ignore"):
            gaps = np.maximum(a[:, None, :dimensions] - b[:, dimensions:], b[:, :dimensions] - a[:, None, dimensions:])
        distances = np.sqrt((np.where(gaps > 0, gaps, 0.0) ** 2).sum(axis=2))
        distances[groups[0][:, None] != groups[1]] = np.nan
        wanted = [
            (i, int(j))
            for i, of_row in enumerate(distances)
            for j in np.lexsort((range(len(b)), of_row))[:k]
            if not np.isnan(of_row[j])
        ]
        found = sap.nearest(a, b, k, by=(groups[0], groups[1]))
        assert list(map(tuple, found.pairs.tolist())) == wanted, number
        assert found.distances.tolist() == [distances[pair] for pair in wanted]


def test_few_boxes_are_looked_at_for_the_nearest_ones_far_away(monkeypatch: pytest.MonkeyPatch) -> None:
    looked_at: list[int] = []
    distances = _intervals._distances

    def counted(corners: Any, pairs: Any) -> Any:
        looked_at.append(len(pairs))
        return distances(corners, pairs)

    monkeypatch.setattr(_intervals, "_distances", counted)
    low = np.random.default_rng(1).random((1000, 2))
    a = np.hstack([low, low])
    for apart in ([50, 50], [50, 0], [0, 0]):
        looked_at.clear()
        assert len(sap.nearest(a, a + [*apart, *apart]).pairs) == 1000
        assert sum(looked_at) < 10_000  # of 1,000,000


def frame(random: np.random.Generator, count: int) -> Any:
    pandas = pytest.importorskip("pandas")
    start = random.integers(0, 3000, count)
    chrom = random.choice(["chr1", "chr2", "chrX"], count)
    return pandas.DataFrame({"chrom": chrom, "start": start, "end": start + random.integers(1, 40, count)})


def test_what_overlaps_is_nearer_than_what_merely_touches() -> None:
    pandas = pytest.importorskip("pandas")
    a, b = [[0, 10], [5, 5]], [[10, 20], [5, 7], [5, 5]]
    for closed, near in (("both", [[0, 0], [1, 1]]), ("left", [[0, 1], [1, 1]]), ("neither", [[0, 1], [1, 1]])):
        assert sap.nearest(a, b, closed=closed).pairs.tolist() == near
    # The empty one overlaps nothing, but its distance is 0.
    assert sap.nearest(a[:1], b, 3, max_distance=0, closed="right").pairs[:, 1].tolist() == [1, 0, 2]
    of_pandas = [pandas.IntervalIndex.from_arrays(*zip(*rows), closed="left") for rows in (a[:1], b)]
    assert sap.nearest(*of_pandas).pairs.tolist() == [[0, 1]]
    with pytest.raises(ValueError, match="closed must be"):
        sap.nearest(a, b, closed="half")


@pytest.mark.filterwarnings("ignore")  # bioframe's own
def test_the_answers_are_those_of_bioframe() -> None:
    bioframe = pytest.importorskip("bioframe")
    random = np.random.default_rng(5)
    a, b = frame(random, 400), frame(random, 300)
    assert (
        sap.count_overlaps(a, b, by="chrom", closed="left").tolist() == bioframe.count_overlaps(a, b)["count"].tolist()
    )
    assert sap.coverage(a, b, by="chrom").tolist() == bioframe.coverage(a, b)["coverage"].tolist()
    for distance in (0, 5):
        wanted_frame = bioframe.merge(a, min_dist=distance)
        found = sap.merge(a, by="chrom", margin=distance)
        rows = sorted(zip(a["chrom"][found.first], *found.intervals.T.tolist(), found.counts.tolist()))
        assert rows == sorted(wanted_frame[["chrom", "start", "end", "n_intervals"]].itertuples(index=False, name=None))
        labels = bioframe.cluster(a, min_dist=distance)["cluster"]
        matching = set(zip(sap.cluster(a, by="chrom", margin=distance).tolist(), labels.tolist()))
        assert len(matching) == labels.nunique() == len(found.counts)
    for k in (1, 3):
        wanted_frame = bioframe.closest(a, b, k=k, return_index=True)
        near = sap.nearest(a, b, k, by="chrom")
        wanted = sorted(wanted_frame[["index", "distance"]].astype(int).itertuples(index=False, name=None))
        assert sorted(zip(near.pairs[:, 0].tolist(), near.distances.tolist())) == wanted


def test_the_nearest_are_those_of_geopandas() -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    random = np.random.default_rng(6)
    corners = [random.random((200, 2)) for _ in "ab"]
    boxes = [np.hstack([corner, corner + random.random((200, 2)) / 50]) for corner in corners]
    a, b = (geopandas.GeoDataFrame(geometry=shapely.box(*of.T)) for of in boxes)
    wanted_frame = geopandas.sjoin_nearest(a, b, max_distance=0.05, distance_col="distance")
    wanted_frame = wanted_frame[~wanted_frame.index.duplicated()]
    found = sap.nearest(a, b, max_distance=0.05)
    assert found.pairs[:, 0].tolist() == wanted_frame.index.tolist()
    np.testing.assert_allclose(found.distances, wanted_frame["distance"])


@pytest.mark.parametrize("bad", [[5.0, 1.0], [math.nan, 1.0], [0.0, math.nan]])
@pytest.mark.parametrize("by", [None, "x"])
def test_intervals_that_are_no_boxes_are_refused_by_name(bad: list[float], by: str | None) -> None:
    good = [[0.0, 2.0], [1.0, 4.0]]
    one: Any = {} if by is None else {"by": [by] * 3}
    first: Any = {} if by is None else {"by": ([by] * 3, [by] * 2)}
    second: Any = {} if by is None else {"by": ([by] * 2, [by] * 3)}
    none: Any = {} if by is None else {"by": ([by] * 3, np.empty(0, "U1"))}
    for call in (sap.count_overlaps, sap.cluster, sap.merge):
        with pytest.raises(sap.InvalidBoxError, match=r"^boxes\[1\] "):
            call([good[0], bad, good[1]], **one)
    for between in (sap.count_overlaps, sap.coverage, sap.nearest):
        with pytest.raises(sap.InvalidBoxError, match=r"^a\[2\] "):
            between([*good, bad], good, **first)
        with pytest.raises(sap.InvalidBoxError, match=r"^b\[2\] "):
            between(good, [*good, bad], **second)
        with pytest.raises(sap.InvalidBoxError, match=r"^a\[2\] "):
            between([*good, bad], np.empty((0, 2)), **none)


@pytest.mark.filterwarnings("error")
def test_infinite_and_huge_boxes_need_no_warning() -> None:
    inf, huge = math.inf, 1e308
    rows: Any = [[0, inf], [-inf, inf], [5, 6]]
    assert sap.coverage(rows, [[inf, inf], [-inf, 5.5]]).tolist() == [5.5, inf, 0.5]
    assert sap.nearest([[huge, huge]], [[-huge, -huge]]).distances.tolist() == [inf]
    plane = [[huge, 0, huge, 0]], [[0, huge, 0, huge]]
    assert sap.nearest(*plane).pairs.tolist() == sap.nearest(*plane, max_distance=huge).pairs.tolist() + [[0, 0]]
    with pytest.raises(sap.InvalidBoxError, match="has a NaN on axis 0"):
        sap.find_pairs([[-inf, 0, inf, 5]], format="xywh")


@pytest.mark.parametrize("dtype", ["f2", "u1", "i1", "u2", "u8"])
def test_small_and_unsigned_types_do_not_overflow(dtype: str) -> None:
    high = {"f2": 60_000, "u8": 2**64 - 1}.get(dtype) or int(np.iinfo(dtype).max)
    low = -high if dtype == "f2" else 0 if dtype[0] == "u" else -high - 1
    a, b = np.array([[low, high], [low, low]], dtype), np.array([[low, high], [high, high]], dtype)
    assert sap.coverage(a[:1], b).tolist() == [high - low]
    assert sap.nearest(a[1:], b[1:]).distances.tolist() == [high - low]
    assert sap.measure_overlaps(a, b, [[0, 0], [1, 1]]).size.tolist() == [high - low, 0]
    assert sap.find_pairs(b, margin=b.dtype.type(1)).tolist() == [[0, 1]]


def test_decimals_have_distances_and_sizes_beside_floating_point() -> None:
    decimal: Any = Decimal
    names = ("minx", "miny", "maxx", "maxy")
    a, b = (dict(zip(names, ([decimal(x)], [decimal(0)]) * 2)) for x in ("0.1", "0.4"))
    for limit, count in ((0.5, 1), (0.3, 1), (decimal("0.3"), 1), (decimal("0.29"), 0), (0.25, 0)):
        assert len(sap.nearest(a, b, max_distance=limit).pairs) == count, limit
    one: Any = {"start": [decimal("0.1")], "end": [decimal("0.9")]}
    others = np.array([[0.5, 2], [-math.inf, 0.0625], [1, math.inf]])
    found = sap.measure_overlaps(one, others, sap.find_pairs_between(one, others))
    assert (found.size.tolist(), found.fraction_a.tolist()) == ([0.4], [0.5])
    assert sap.nearest(one, others, k=3).distances.tolist() == [0, 0.0375, 0.1]
    assert len(sap.nearest(one, others, k=3, max_distance=decimal("0.1")).pairs) == 3
    far: Any = {"start": [decimal(5), decimal("0.5")], "end": [decimal(6), decimal(1)]}
    for near in (one, {"start": [0.1], "end": [0.9]}):
        assert [math.isnan(each) for each in sap.nearest(far, near, max_distance=1, how="left").distances] == [
            True,
            False,
        ]
    assert math.isnan(
        sap.nearest({"start": [decimal(5)], "end": [decimal(6)]}, one, max_distance=1, how="left").distances[0]
    )
    assert sap.coverage(one, others).tolist() == [0.4]


def test_no_pairs_may_be_an_empty_list() -> None:
    found = sap.measure_overlaps([[0, 1]], None, [])
    assert [len(part) for part in found] == [0, 0, 0, 0] and found.size.dtype == np.int64


def test_an_inverted_box_is_named_and_not_measured() -> None:
    given: Any
    for given, row in (([[0, 1], [5, 3]], 1), ([[0.0, np.nan], [0, 1]], 0)):
        with pytest.raises(sap.InvalidBoxError) as raised:
            sap.measure_overlaps(given, None, [[0, 1]])
        assert (raised.value.argument, raised.value.index) == ("boxes", row)
        with pytest.raises(sap.InvalidBoxError) as raised:
            sap.measure_overlaps([[0, 1]], given, [[0, 0], [0, 1]])
        assert (raised.value.argument, raised.value.index) == ("b", row)
    assert sap.measure_overlaps([[0, 1], [5, 3]], None, [[0, 0]]).size.tolist() == [1], "no pair names the other"
    assert sap.measure_overlaps([[170, -170]], None, [[0, 0]], wrap=360).size.tolist() == [20]
