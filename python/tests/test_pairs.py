"""Finding pairs equals brute force, however it is asked."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracle import DIMENSIONS, FLOATS, box_sets, in_order, pairs, pairs_between, random_boxes

import sweep_and_prune as sap

kinds = pytest.mark.parametrize(("dimensions", "dtype"), [(d, t) for d in DIMENSIONS for t in FLOATS])


def chunks_of(finder: sap.PairFinder, boxes: Any, size: int) -> list[Any]:
    chunks: list[Any] = []
    assert finder.for_each_chunk(boxes, chunks.append, size=size)
    return chunks


@kinds
@given(data=st.data())
def test_every_way_to_ask_equals_brute_force(dimensions: int, dtype: Any, data: st.DataObject) -> None:
    boxes = data.draw(box_sets(dimensions)).astype(dtype)
    wanted = pairs(boxes)
    found = sap.find_pairs(boxes)
    assert found.dtype == np.int64 and found.shape == wanted.shape
    assert (in_order(found) == wanted).all()
    assert sap.count_pairs(boxes) == len(wanted)
    finder = sap.PairFinder(dimensions, dtype)
    assert (finder.find(boxes) == found).all()
    assert finder.count(boxes) == len(wanted)
    size = data.draw(st.integers(1, 50))
    chunks = chunks_of(finder, boxes, size)
    assert (np.concatenate([np.empty((0, 2), np.int64), *chunks]) == found).all()
    assert all(len(chunk) == size for chunk in chunks[:-1]) and all(0 < len(chunk) <= size for chunk in chunks)


@kinds
@given(data=st.data())
def test_pairs_between_two_sets_equal_brute_force(dimensions: int, dtype: Any, data: st.DataObject) -> None:
    a = data.draw(box_sets(dimensions)).astype(dtype)
    b = data.draw(box_sets(dimensions)).astype(dtype)
    wanted = pairs_between(a, b)
    found = sap.find_pairs_between(a, b)
    assert found.dtype == np.int64 and (in_order(found) == wanted).all() and found.shape == wanted.shape
    finder = sap.PairFinder(dimensions, dtype)
    assert (finder.find_between(a, b) == found).all()
    assert finder.count_between(a, b) == len(wanted)
    chunks: list[Any] = []
    assert finder.for_each_chunk_between(a, b, chunks.append, size=7)
    assert (np.concatenate([np.empty((0, 2), np.int64), *chunks]) == found).all()


@kinds
@pytest.mark.parametrize("count", [3, 40, 41, 1023, 1024, 2500])
def test_sizes_at_which_something_else_is_done(dimensions: int, dtype: Any, count: int) -> None:
    boxes = random_boxes(count, dimensions, dtype)
    wanted = pairs(boxes)
    assert len(wanted) >= count // 4 - 1
    assert np.array_equal(in_order(sap.find_pairs(boxes)), wanted)
    half = count // 2
    found = in_order(sap.find_pairs_between(boxes[:half], boxes[half:]))
    assert np.array_equal(found, pairs_between(boxes[:half], boxes[half:]))


@kinds
def test_threads_give_the_same_pairs_in_the_same_order(dimensions: int, dtype: Any) -> None:
    boxes = random_boxes(140_000, dimensions, dtype)
    alone = sap.find_pairs(boxes)
    for threads in (2, 3, 8):
        assert np.array_equal(sap.find_pairs(boxes, threads=threads), alone)
        assert sap.count_pairs(boxes, threads=threads) == len(alone)
    between = sap.find_pairs_between(boxes[:90_000], boxes[90_000:])
    finder = sap.PairFinder(dimensions, dtype, threads=2)
    assert np.array_equal(finder.find_between(boxes[:90_000], boxes[90_000:]), between)
    assert np.array_equal(finder.find(boxes), alone)
    assert len(between) > 1000


def test_a_finder_called_again_and_again_forgets_what_it_found() -> None:
    finder = sap.PairFinder(3, np.float32)
    kept = []
    for seed in range(5):
        boxes = random_boxes(300 * (seed % 3 + 1), 3, np.float32, seed)
        kept.append((boxes, finder.find(boxes)))
        moved = boxes + np.float32(0.5) * (np.arange(len(boxes)) % 7 == 0)[:, None]
        kept.append((moved, finder.find(moved)))
    # What was found earlier is the caller's own, and as it was.
    for boxes, found in kept:
        assert np.array_equal(in_order(found), pairs(boxes))


@settings(max_examples=30)
@given(box_sets(2, 12), st.integers(1, 5))
def test_a_stream_ends_where_it_is_told_to(boxes: Any, calls: int) -> None:
    seen: list[Any] = []

    def each(chunk: Any) -> bool:
        seen.append(chunk)
        return len(seen) < calls

    total = len(pairs(boxes))
    ended = sap.for_each_chunk(boxes, each, size=1)
    assert len(seen) == min(total, calls)
    assert ended == (total < calls)
    answers: list[Any] = [False, 0, np.False_, "", None, True, 1, np.True_]
    for answer in answers:
        ended = sap.for_each_chunk(boxes, lambda chunk: answer, size=1)
        assert ended == (total == 0 or answer is None or bool(answer))


def test_what_a_callback_raises_comes_through_and_the_finder_goes_on() -> None:
    finder = sap.PairFinder(1)
    boxes = np.zeros((10, 2))

    def fail(chunk: Any) -> None:
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        finder.for_each_chunk(boxes, fail)
    assert finder.count(boxes) == 45


def test_within_a_callback_another_finder_can_be_used_and_the_boxes_be_written_to() -> None:
    finder = sap.PairFinder(1)
    boxes = np.zeros((3000, 2))
    counts = []

    def each(chunk: Any) -> None:
        boxes[:] = np.nan
        counts.append((len(chunk), sap.count_pairs([[0, 1], [1, 2]])))
        with pytest.raises(RuntimeError, match="in use"):
            finder.find(np.zeros((2, 2)))

    assert finder.for_each_chunk(boxes, each, size=1_000_000)
    assert sum(count for count, _ in counts) == 3000 * 2999 // 2
    assert {inner for _, inner in counts} == {1}
    assert len(finder.find(np.zeros((2, 2)))) == 1


def test_streams_hold_no_more_than_a_chunk() -> None:
    largest = 0

    def each(chunk: Any) -> None:
        nonlocal largest
        largest = max(largest, chunk.nbytes)

    assert sap.for_each_chunk(np.zeros((5000, 2)), each)
    assert largest == 65_536 * 16


@pytest.mark.parametrize("dtype", [np.int64, np.int32, np.uint32, np.uint64])
@pytest.mark.parametrize("count", [200, 240, 4500])
def test_many_pairs_are_complete_and_in_order(count: int, dtype: Any) -> None:
    """From 2^20 pairs of 4,096 boxes on, they are converted as they are found."""
    left = np.arange(5000)[::-1]
    boxes = np.stack([left, left + np.where(left < count, 10_000, 0)], axis=1)  # the first ones overlap all that follow
    found = sap.find_pairs(boxes, dtype=dtype)
    assert found.dtype == dtype and found.flags.writeable and found.flags.c_contiguous
    chunks: list[Any] = []
    assert sap.for_each_chunk(boxes, chunks.append)
    assert np.array_equal(found, np.concatenate(chunks))
    first, second = np.triu_indices(5000, 1)
    wanted = np.stack([first, second], axis=1)[left[second] < count]  # the second one begins first
    assert np.array_equal(in_order(found), wanted)
    # Of these, some are left out.
    by = np.where(left % 7 == 0, 1, 0)
    wanted = wanted[by[wanted[:, 0]] == by[wanted[:, 1]]]
    assert np.array_equal(
        in_order(sap.find_pairs(np.hstack([boxes[:, [0, 0, 0]], boxes[:, [1, 1, 1]]]), by=by)), wanted
    )


def test_results_are_ordinary_arrays_of_your_own() -> None:
    boxes = np.zeros((3, 2))
    found = sap.find_pairs(boxes)
    assert found.flags.c_contiguous and found.flags.writeable and found.flags.owndata
    found[:] = 7
    assert sap.find_pairs(boxes).tolist() == [[0, 1], [0, 2], [1, 2]]
