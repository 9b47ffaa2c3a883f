"""Boxes that are joined cell by cell have the pairs of the finder, each in one cell, whatever the cells are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracle import DIMENSIONS, FLOATS, Array, box_sets, in_order, random_boxes
from oracle import pairs as brute_force
from oracle import pairs_between as brute_force_between

import sweep_and_prune as sap
from sweep_and_prune._partitioned.cells import Cells, choose_cells
from sweep_and_prune._partitioned.search import Boxes, search, touches

COUNTS = (1, 2, 3, 7, 40)


def by_cells(a: Array, b: Array | None, count: int, sample: Array | None = None) -> tuple[Array, Cells]:
    """The pairs of one set or of two, cell by cell."""
    both = a if b is None else np.concatenate([a, b])
    cells = choose_cells(both if sample is None else sample, count)
    lows, highs = cells.regions()
    found: list[Array] = []

    def report(first: Array, second: Array) -> None:
        found.append(np.stack([first, second], axis=1))

    def groups(boxes: Array) -> list[Boxes]:
        rows, starts = cells.assign(boxes)
        every = Boxes(np.arange(len(boxes)), boxes)
        return [every.take(rows[start:end]) for start, end in zip(starts, starts[1:])]

    of_a, of_b = groups(a), groups(b) if b is not None else []
    for cell, (low, high) in enumerate(zip(lows, highs)):
        wide = [every[-1].take(touches(every[-1].rows, low, high)) for every in (of_a, of_b) if every]
        assert touches(of_a[cell].rows, low, high).all()
        search(of_a[cell], of_b[cell] if of_b else None, low, report)
        search(of_a[cell], wide[-1], low, report)
        if of_b:
            search(wide[0], of_b[cell], low, report)
    search(of_a[-1], of_b[-1] if of_b else None, np.full(a.shape[1] // 2, -np.inf), report)
    pairs = np.concatenate([np.empty((0, 2), np.int64), *found])
    if b is None:
        pairs.sort(axis=1)
    return in_order(pairs), cells


def test_the_scenes_have_the_same_pairs_for_any_number_of_cells(scenes: Path) -> None:
    for path in sorted(scenes.iterdir()):
        _, space, kind = path.name.split()
        boxes = np.fromfile(path, "<f4" if kind == "f32" else "<f8").reshape(-1, 2 * int(space[0]))
        wanted = in_order(sap.find_pairs(boxes))
        between = in_order(sap.find_pairs_between(boxes[::3], boxes[1::2]))
        for count in (2, 13, 200):
            assert np.array_equal(by_cells(boxes, None, count)[0], wanted), (path.name, count)
        assert np.array_equal(by_cells(boxes[::3], boxes[1::2], 13)[0], between), path.name


@pytest.mark.parametrize("dtype", FLOATS)
@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_random_boxes_with_few_distinct_coordinates(dimensions: int, dtype: Any) -> None:
    @settings(max_examples=50)
    @given(box_sets(dimensions), box_sets(dimensions), st.sampled_from(COUNTS), st.integers(1, 9))
    def check(a: Array, b: Array, count: int, step: int) -> None:
        a, b = a.astype(dtype), b.astype(dtype)
        assert np.array_equal(by_cells(a, None, count, a[::step])[0], brute_force(a))
        assert np.array_equal(by_cells(a, b, count, b[::step])[0], brute_force_between(a, b))

    check()


@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_giant_coincident_and_no_boxes(dimensions: int) -> None:
    boxes = random_boxes(3000, dimensions, np.float64)
    boxes[::100, :dimensions], boxes[::100, dimensions:] = -1000, 1000
    found, cells = by_cells(boxes, None, 60)
    assert cells.number == 60 and np.array_equal(found, in_order(sap.find_pairs(boxes)))
    _, starts = cells.assign(boxes)
    assert starts[-1] - starts[-2] == 30, "they are wide, and go to no cell"
    found, cells = by_cells(np.zeros((300, 2 * dimensions)), None, 50)
    assert (cells.number, len(found)) == (1, 300 * 299 // 2)
    found, cells = by_cells(np.empty((0, 2 * dimensions)), None, 50)
    assert (cells.number, len(found)) == (1, 0)
    # All in one cell, and the others are empty: the sample was of other boxes.
    found, cells = by_cells(boxes + 5000, None, 50, random_boxes(500, dimensions, np.float64))
    assert cells.number == 50 and np.array_equal(found, in_order(sap.find_pairs(boxes + 5000)))


@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_each_point_is_in_one_cell_and_each_box_goes_to_the_cells_that_it_touches(dimensions: int) -> None:
    boxes = random_boxes(2000, dimensions, np.float64)
    cells = choose_cells(boxes, 30)
    lows, highs = cells.regions()
    points = np.concatenate([boxes[:, :dimensions], boxes[:, dimensions:], lows, [[np.inf] * dimensions]])
    # Infinity is in the last cell, which has no end.
    inside = [((points >= low) & ((points < high) | (high == np.inf))).all(axis=1) for low, high in zip(lows, highs)]
    assert (np.sum(inside, axis=0) == 1).all()
    rows, starts = cells.assign(boxes)
    for cell, (low, high) in enumerate(zip(lows, highs)):
        assert np.array_equal(rows[starts[cell] : starts[cell + 1]], np.flatnonzero(touches(boxes, low, high)))


@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_cells_get_about_equally_many_boxes_and_make_few_copies(dimensions: int) -> None:
    random = np.random.default_rng(1)
    points = random.normal(size=(200_000, dimensions)) ** 3  # crowded in the middle
    boxes = np.hstack([points, points + 1e-6])
    cells = choose_cells(boxes[:12_000], 37)
    _, starts = cells.assign(boxes)
    sizes = np.diff(starts)[:-1]
    assert cells.number == 37 and sizes.max() < 1.35 * sizes.mean()
    assert starts[-2] < 1.1 * len(boxes)


def test_long_needles_make_no_more_copies_than_are_allowed() -> None:
    random = np.random.default_rng(1)
    low = random.random((2000, 2))
    size = np.where(np.arange(2000)[:, None] % 2 == [0, 1], 0.8, 1e-4)
    boxes = np.hstack([low, low + size])
    found, cells = by_cells(boxes, None, 100)
    _, starts = cells.assign(boxes)
    assert 1 < cells.number < 100 and starts[-2] <= 4 * len(boxes)
    assert np.array_equal(found, in_order(sap.find_pairs(boxes)))
