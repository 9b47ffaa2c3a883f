"""The static index: against brute force, whatever its bytes are."""

from __future__ import annotations

import copy
import math
import pickle
import sys
import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sweep_and_prune as sap

COORDINATES = [-math.inf, -2.0, -1.0, -0.0, 0.0, 0.5, 1.0, 1.5, 2.0, 3.0, math.inf]
FINITE = [at for at in COORDINATES if math.isfinite(at)]


def overlapping(boxes: np.ndarray, area: np.ndarray) -> list[int]:
    half = boxes.shape[1] // 2
    hits = (boxes[:, :half] <= area[half:]) & (area[:half] <= boxes[:, half:])
    return np.flatnonzero(hits.all(axis=1)).tolist()


def by_distance(boxes: np.ndarray, point: np.ndarray) -> tuple[list[int], list[float]]:
    half = boxes.shape[1] // 2
    gaps = np.maximum(np.maximum(boxes[:, :half] - point, point - boxes[:, half:]), 0)
    distances = np.sqrt((gaps.astype(np.float64) ** 2).sum(axis=1))
    order = np.lexsort((np.arange(len(boxes)), distances))
    return order.tolist(), distances[order].tolist()


@st.composite
def scenes(draw: st.DrawFn) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Boxes, areas, and a point."""
    dimensions = draw(st.integers(1, 3))
    dtype = draw(st.sampled_from([np.float32, np.float64]))
    corner = st.lists(st.sampled_from(COORDINATES), min_size=dimensions, max_size=dimensions)
    box = st.tuples(corner, corner).map(lambda ends: np.hstack([np.minimum(*ends), np.maximum(*ends)]))
    boxes = draw(st.lists(box, max_size=60))
    areas = draw(st.lists(box, min_size=1, max_size=5))
    point = draw(st.lists(st.sampled_from(FINITE), min_size=dimensions, max_size=dimensions))
    rows = np.array(boxes, dtype).reshape(-1, 2 * dimensions)
    return rows, np.array(areas, dtype), np.array(point, np.float64)


@settings(max_examples=200, deadline=None)
@given(scenes())
def test_equals_brute_force(scene: tuple[np.ndarray, np.ndarray, np.ndarray]) -> None:
    boxes, areas, point = scene
    index = sap.Index(boxes)
    assert (len(index), index.dimensions, index.dtype) == (len(boxes), boxes.shape[1] // 2, boxes.dtype)
    expected = []
    for query, area in enumerate(areas):
        found = index.search(area)
        wanted = overlapping(boxes, area)
        assert found.dtype == np.int64
        assert sorted(found.tolist()) == wanted
        assert set(index.search(area, limit=2).tolist()) <= set(wanted)
        assert len(index.search(area, limit=2)) == min(2, len(wanted))
        odd = index.search(area, predicate=lambda box: box % 2)
        assert sorted(odd.tolist()) == [box for box in wanted if box % 2]
        assert index.search(area, predicate=lambda box: box % 2, limit=1).tolist() == odd[:1].tolist()
        expected += [[query, box] for box in found]
    many = index.search_many(areas)
    assert many.shape == (2, len(expected))
    assert many.T.tolist() == expected
    ids, distances = by_distance(boxes, point)
    near = index.neighbors(point)
    assert (near.ids.tolist(), near.distances.tolist()) == (ids, distances)
    assert index.neighbors(point, 3).ids.tolist() == ids[:3]
    assert index.neighbors(point, max_distance=1).ids.tolist() == [i for i, d in zip(ids, distances) if d <= 1]
    kept = index.neighbors(point, 2, predicate=lambda box: box % 3 == 0)
    assert kept.ids.tolist() == [box for box in ids if box % 3 == 0][:2]


def formula() -> np.ndarray:
    """Boxes by a formula of whole numbers, which the tests of Rust and JavaScript have too."""
    state, boxes = 1, []
    for _ in range(5000):
        words = []
        for shift in (8, 8, 16, 16):
            state = (state * 1664525 + 1013904223) % 2**32
            words.append((state >> shift) / 2**16)
        x, y, width, height = words
        boxes.append([x, y, x + width, y + height])
    return np.array(boxes, np.float32)


def test_the_bytes_are_those_of_rust_and_javascript() -> None:
    value = 0xCBF29CE484222325
    for byte in sap.Index(formula()).data:
        value = ((value ^ byte) * 0x100000001B3) % 2**64
    assert f"{value:016x}" == "1ee420eb2337ff0b"


def test_bytes_are_an_index_again() -> None:
    index = sap.Index(formula())
    area = [10, 10, 40, 40]
    found = index.search(area).tolist()
    data = index.data
    count = sys.getrefcount(data)
    kept = sap.Index.from_buffer(data)
    assert sys.getrefcount(data) == count + 1  # not a copy
    copies = [kept, sap.Index.from_buffer(bytearray(data)), sap.Index.from_buffer(memoryview(data))]
    copies += [sap.Index.from_buffer(np.frombuffer(b"xyz" + data, np.uint8)[3:].data)]
    copies += [pickle.loads(pickle.dumps(index)), copy.deepcopy(index)]
    for other in copies:
        assert (other.data, other.search(area).tolist(), len(other)) == (data, found, 5000)
    del data
    assert kept.search(area).tolist() == found
    assert repr(index) == "<Index of 5000 boxes, 2D, float32>"


@settings(max_examples=200, deadline=None)
@given(st.lists(st.tuples(st.integers(0, 2**20), st.integers(0, 255)), max_size=40))
def test_any_bytes_are_harmless(changes: list[tuple[int, int]]) -> None:
    data = bytearray(sap.Index(formula()[:300]).data)
    for at, value in changes:
        data[at % len(data)] = value
    try:
        index = sap.Index.from_buffer(bytes(data))
    except sap.IndexDataError:
        return
    dimensions = index.dimensions
    for found in (index.search([0] * dimensions + [300] * dimensions), index.neighbors([0] * dimensions).ids):
        assert (found < len(index)).all()


@pytest.mark.parametrize(
    ("data", "message"),
    [(b"PNG", "not those of an index"), (b"SaPi", "ends within"), (sap.Index(formula()).data[:-1], "5000 boxes")],
)
def test_other_bytes_are_refused(data: bytes, message: str) -> None:
    with pytest.raises(sap.IndexDataError, match=message):
        sap.Index.from_buffer(data)


def test_rays_and_segments() -> None:
    index = sap.Index([[5, -1, 6, 1], [3, 1, 4, 2], [2, 0, 2, 0]])
    assert index.ray_cast([0, 0], [1, 0]) == (2, 2.0)
    assert index.ray_cast([0, 0], [-1, 0]) is None
    assert index.ray_cast([0, 0], [1, 0], limit=1.5) is None
    every = index.ray_cast_all([0, 0], [1, 0])
    assert (every.ids.tolist(), every.t.tolist()) == ([2, 0], [2.0, 5.0])
    assert index.ray_cast_all([0, 0], [1, 0], limit=4).ids.tolist() == [2]
    met = index.segment([0, 0], [5, 0])
    assert (met.ids.tolist(), met.t.tolist()) == ([2, 0], [0.4, 1.0])


def test_no_boxes() -> None:
    index = sap.Index(np.empty((0, 4)))
    assert index.search([0, 0, 1, 1]).tolist() == []
    assert index.search_many(np.empty((0, 4))).shape == (2, 0)
    assert index.neighbors([0, 0]).ids.tolist() == []
    assert len(sap.Index.from_buffer(index.data)) == 0


def test_threads_change_nothing() -> None:
    boxes = formula()
    index = sap.Index(boxes)
    expected = index.search_many(boxes)
    assert (index.search_many(boxes, threads=2) == expected).all()
    results: list[np.ndarray] = []
    workers = [threading.Thread(target=lambda: results.append(index.search_many(boxes))) for _ in range(4)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert len(results) == 4
    assert all((result == expected).all() for result in results)


def test_results_are_those_of_shapely() -> None:
    shapely = pytest.importorskip("shapely")
    boxes = formula().astype(np.float64)
    queries = boxes[:500] + 0.25
    tree = shapely.STRtree(shapely.box(*boxes.T))
    expected = tree.query(shapely.box(*queries.T))
    found = sap.Index(boxes).search_many(queries)
    in_order = found[:, np.lexsort(found[::-1])]
    assert (in_order == expected[:, np.lexsort(expected[::-1])]).all()
    assert (sap.Index(shapely.box(*boxes.T)).search_many(shapely.box(*queries.T)) == found).all()


def test_wrong_arguments_are_refused_by_name() -> None:
    index = sap.Index([[0, 0, 1, 1]])
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] is inverted on axis 0"):
        sap.Index([[0, 0, 1, 1], [3, 0, 2, 1]])
    with pytest.raises(sap.InvalidBoxError, match="box is inverted"):
        index.search([1, 0, 0, 1])
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\]"):
        index.search_many(np.array([[0, 0, 1, 1], [0, 0, 1, np.nan]]))
    with pytest.raises(ValueError, match="box must be 4 numbers"):
        index.search([0, 0, 1])
    with pytest.raises(ValueError, match=r"\(n, 4\)"):
        index.search_many([[0, 1]])
    with pytest.raises(ValueError, match="limit must be from 0"):
        index.search([0, 0, 1, 1], limit=-1)
    with pytest.raises(sap.InvalidQueryError, match="point is inf"):
        index.neighbors([0, np.inf])
    with pytest.raises(sap.InvalidQueryError, match=r"max_distance is -1\.0"):
        index.neighbors([0, 0], max_distance=-1)
    with pytest.raises(sap.InvalidQueryError, match="limit is nan"):
        index.ray_cast([0, 0], [1, 0], limit=math.nan)
    with pytest.raises(sap.InvalidQueryError, match="direction is nan"):
        index.ray_cast([0, 0], [1, math.nan])
    with pytest.raises(sap.InvalidQueryError, match="end is inf"):
        index.segment([0, 0], [0, math.inf])
    with pytest.raises(TypeError):
        sap.Index.from_buffer("text")  # type: ignore[arg-type]
    single = sap.Index(np.array([[0, 0, 1, 1]], np.float32))
    with pytest.raises(sap.InvalidQueryError, match="finite, in float32"):
        single.neighbors([0, 1e300])
    assert index.search([0, 0, 1, 1]).tolist() == [0]


def test_what_a_predicate_raises_is_raised() -> None:
    index = sap.Index(formula())

    def fails(box: int) -> bool:
        raise KeyError(box)

    with pytest.raises(KeyError):
        index.search([0, 0, 300, 300], predicate=fails)
    with pytest.raises(KeyError):
        index.neighbors([0, 0], 1, predicate=fails)
