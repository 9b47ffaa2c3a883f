"""Margins, progress and chunks equal brute force, and compose with the other options."""

from __future__ import annotations

import gc
import threading
import time
from collections.abc import Callable
from contextlib import suppress
from datetime import timedelta
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from oracle import DIMENSIONS, FLOATS, Array, box_sets, in_order, pairs, pairs_between, random_boxes

import sweep_and_prune as sap
from sweep_and_prune import _pairs, _prepare


def within(a: Array, b: Array, margin: Any, closed: str = "both") -> Array:
    """`(n, k)`: whether the boxes of two sets are within a margin, by definition."""
    half = a.shape[1] // 2
    low_a, high_a, low_b, high_b = a[:, None, :half], a[:, None, half:], b[None, :, :half], b[None, :, half:]
    if closed == "both":
        return np.asarray(((low_a <= high_b + margin) & (low_b <= high_a + margin)).all(axis=2))
    near = ((low_a < high_b + margin) & (low_b < high_a + margin)).all(axis=2)
    return np.asarray(near & (low_a < high_a).all(axis=2) & (low_b < high_b).all(axis=2))


@pytest.mark.parametrize("dtype", FLOATS)
@pytest.mark.parametrize("dimensions", DIMENSIONS)
@settings(max_examples=40)
@given(data=st.data())
def test_margins_follow_their_definition(dimensions: int, dtype: Any, data: st.DataObject) -> None:
    a = data.draw(box_sets(dimensions)).astype(dtype)
    b = data.draw(box_sets(dimensions)).astype(dtype)
    closed = data.draw(st.sampled_from(["both", "left", "neither"]))
    numbers = st.sampled_from([0.0, 0.1, 0.5, 1.0, 3.0])
    margin: Any = data.draw(numbers | st.lists(numbers, min_size=dimensions, max_size=dimensions))
    rounded = np.asarray(margin).astype(dtype)
    wanted = np.argwhere(np.triu(within(a, a, rounded, closed), 1))
    assert np.array_equal(in_order(sap.find_pairs(a, margin=margin, closed=closed)), wanted)
    assert sap.count_pairs(a, margin=margin, closed=closed) == len(wanted)
    between = np.argwhere(within(a, b, rounded, closed))
    assert np.array_equal(in_order(sap.find_pairs_between(a, b, margin=margin, closed=closed)), between)
    assert sap.count_pairs_between(a, b, margin=margin, closed=closed) == len(between)
    if closed == "both":
        finder, chunks = sap.PairFinder(dimensions, dtype), []
        assert np.array_equal(in_order(finder.find(a, margin=margin)), wanted)
        assert np.array_equal(in_order(finder.find_between(a, b, margin=margin)), between)
        assert finder.count(a, margin=margin) == len(wanted)
        assert finder.count_between(a, b, margin=margin) == len(between)
        finder.for_each_chunk(a, lambda chunk: chunks.append(len(chunk)), margin=margin)
        assert sum(chunks) == len(wanted)
        finder.for_each_chunk_between(a, b, lambda chunk: chunks.append(len(chunk)), margin=margin)
        assert sum(chunks) == len(wanted) + len(between)


def test_a_finder_with_a_margin_refuses_what_it_refuses_without() -> None:
    finder = sap.PairFinder(1)
    with pytest.raises(sap.InvalidBoxError, match=r"a\[1\] is inverted"):
        finder.find_between([[0, 1], [3, 2]], [[0, 1]], margin=5)
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[0\] has a NaN"):
        finder.count([[np.nan, 1]], margin=5)
    with pytest.raises(ValueError, match="margin is -1"):
        finder.find([[0, 1]], margin=-1)


def test_margins_of_integers_and_times_are_exact() -> None:
    large = 2**62 + np.array([[0, 10], [13, 20], [24, 30]])
    assert sap.find_pairs(large, margin=3).tolist() == [[0, 1]]
    assert sap.find_pairs(large, margin=2).tolist() == []
    assert sap.find_pairs(large, margin=4.0, closed="left").tolist() == [[0, 1]]
    assert sap.find_pairs(large, margin=2**62).tolist() == [[0, 1], [0, 2], [1, 2]]
    with pytest.raises(ValueError, match="whole number for integers beyond"):
        sap.find_pairs(large, margin=0.5)
    times = np.datetime64("2026-11-22T12:00:00", "ns") + np.array([[0, 10], [13, 20], [24, 30]])
    for margin in (np.timedelta64(3, "ns"), np.timedelta64(3, "ns").reshape(1)):
        assert sap.find_pairs(times, margin=margin).tolist() == [[0, 1]]
    assert sap.find_pairs(times, margin=np.timedelta64(2, "ns")).tolist() == []
    assert len(sap.find_pairs(times, margin=timedelta(microseconds=1))) == 3
    assert len(sap.find_pairs_between(times[:1], times, margin=np.timedelta64(3, "ns"))) == 2
    for wrong in (3, 0.5, "3"):
        with pytest.raises(TypeError, match="margin must be a timedelta for times"):
            sap.find_pairs(times, margin=wrong)
    with pytest.raises(ValueError, match="0 or more"):
        sap.find_pairs(times, margin=timedelta(-1))
    assert len(sap.find_pairs(times, margin=np.timedelta64(2**63 - 1, "ns"))) == 3


@pytest.mark.parametrize("margin", [-1, np.nan, np.inf, [1, -1], "1", None, [1, 2, 3], [[1, 2]], timedelta(1), 1j])
def test_margins_that_make_no_sense(margin: Any) -> None:
    with pytest.raises((ValueError, TypeError), match="margin"):
        sap.find_pairs([[0, 0, 1, 1]], margin=margin)


def test_a_margin_does_not_hide_invalid_boxes_and_errors_name_the_row_that_was_passed() -> None:
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] is inverted"):
        sap.find_pairs([[0, 1], [3, 2]], margin=5)
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] has a NaN"):
        sap.find_pairs(np.array([[0, 1], [3, np.nan]]), margin=5)
    for margin in (0, 5):
        with pytest.raises(sap.InvalidBoxError, match=r"b\[2\] is inverted"):
            sap.find_pairs_between([[0, 1]], np.array([[np.nan, 1], [0, 1], [3, 2]]), missing="skip", margin=margin)


def test_numbers_that_become_0_or_infinite_raise_no_error_of_numpy() -> None:
    tiny, single = 1e-50, np.array([[0, 1], [2, 3]], np.float32)
    world, finder = sap.BroadPhase(1, np.float32), sap.PairFinder(1, np.float32)
    with np.errstate(all="raise"):
        assert world.box(world.insert([0, tiny])).tolist() == [0, 0]
        assert world.box_many(world.insert_many([[0, tiny]])).tolist() == [[0, 0]]
        assert len(world.within([0], tiny)) == len(world.nearest([0], 2, max_distance=tiny).ids) == 2
        assert finder.count([[0.0, tiny], [0.0, 1.0]], margin=tiny) == 1
        assert len(sap.find_pairs(single, margin=tiny)) == len(sap.find_pairs(single, wrap=1e200)) == 0
        assert len(sap.find_pairs([[0.0, 5e-324], [2.0, 3.0]], format="cxcywh")) == 0
        assert sap.nearest([[0, 0, 0, 0]], [[1e-200, 0, 1, 1]]).distances.tolist() == [0]


def test_options_compose() -> None:
    boxes = random_boxes(200, 2, np.float64)
    by = np.arange(200) % 3
    boxes[::20, 1] = np.nan
    kept: Array = np.array([not np.isnan(box).any() for box in boxes])
    same = (by[:, None] == by[None]) & kept[:, None] & kept[None]
    near = within(np.nan_to_num(boxes), np.nan_to_num(boxes), 0.5, "left")
    wanted = np.argwhere(np.triu(near & same, 1))
    options: dict[str, Any] = {"by": by, "missing": "skip", "margin": 0.5, "closed": "left"}
    assert len(wanted) > 10 and np.array_equal(in_order(sap.find_pairs(boxes, **options)), wanted)
    found = list(sap.iter_chunks(boxes, size=7, dtype=np.uint32, **options))
    assert np.array_equal(in_order(np.concatenate(found)), wanted) and found[0].dtype == np.uint32
    options["by"] = (by, by)
    between = np.concatenate(list(sap.iter_chunks_between(boxes, boxes, **options)))
    assert np.array_equal(in_order(between), np.argwhere(near & same))


@pytest.mark.parametrize("dimensions", DIMENSIONS)
def test_chunks_are_the_pairs_in_their_order(dimensions: int) -> None:
    a, b = random_boxes(300, dimensions, np.float32), random_boxes(200, dimensions, np.float32, 2)
    by = np.arange(300) % 2
    for options in ({}, {"by": by}, {"missing": "skip"}):
        found = sap.find_pairs(a, **options)
        for size in (1, 50, 10**6):
            chunks = list(sap.iter_chunks(a, size=size, **options))
            assert np.array_equal(np.concatenate(chunks), found) and all(0 < len(chunk) <= size for chunk in chunks)
    between = sap.find_pairs_between(a, b)
    assert np.array_equal(np.concatenate(list(sap.iter_chunks_between(a, b, size=9))), between)
    seen: list[Any] = []
    assert sap.for_each_chunk_between(a, b, seen.append, size=9)
    assert np.array_equal(np.concatenate(seen), between)
    assert not sap.for_each_chunk_between(a, b, lambda chunk: False)
    assert np.array_equal(in_order(between), pairs_between(a, b))


@pytest.mark.parametrize("closed", ["both", "left"])
def test_chunks_of_whole_intervals_in_groups_are_in_the_same_order(closed: str) -> None:
    random = np.random.default_rng(5)
    starts, lengths = random.integers(0, 2000, 500), random.integers(1, 90, 500)
    a, b = np.split(np.stack([starts, starts + lengths], axis=1), [300])
    of_a, of_b = np.arange(300) % 7, np.arange(200) % 7
    options: dict[str, Any] = {"closed": closed, "by": of_a}
    found = sap.find_pairs(a, **options)
    seen: list[Any] = []
    assert sap.for_each_chunk(a, seen.append, size=9, **options) and len(seen) > 9
    assert np.array_equal(np.concatenate(seen), found)
    assert np.array_equal(np.concatenate(list(sap.iter_chunks(a, size=9, **options))), found)
    options["by"] = (of_a, of_b)
    between = sap.find_pairs_between(a, b, **options)
    seen = []
    assert sap.for_each_chunk_between(a, b, seen.append, size=9, **options) and len(seen) > 9
    assert np.array_equal(np.concatenate(seen), between)
    assert np.array_equal(np.concatenate(list(sap.iter_chunks_between(a, b, size=9, **options))), between)


def test_an_iteration_that_is_left_ends_its_search() -> None:
    def threads_of_searches() -> int:
        return sum(thread.daemon for thread in threading.enumerate())

    before = threads_of_searches()
    boxes = np.zeros((50_000, 2))  # 1.2 billion pairs: far more than the test waits for
    for pairs_of_chunk in sap.iter_chunks(boxes):
        assert len(pairs_of_chunk) == 65_536
        break
    chunks = sap.iter_chunks(boxes)
    next(chunks)
    del chunks, pairs_of_chunk
    gc.collect()
    end = time.monotonic() + 600
    while threads_of_searches() > before and time.monotonic() < end:
        time.sleep(0.01)
    assert threads_of_searches() == before
    # One that is never begun starts no search.
    iterator = sap.iter_chunks(boxes)
    assert threads_of_searches() == before
    del iterator


def test_what_is_wrong_is_said_when_iterating() -> None:
    with pytest.raises(sap.InvalidBoxError):
        next(iter(sap.iter_chunks(np.array([[1.0, 0.0]]))))
    with pytest.raises(ValueError, match="boxes must be of shape"):
        sap.iter_chunks([[1, 2, 3]])
    with pytest.raises(ValueError, match="size must be"):
        sap.iter_chunks([[1, 2]], size=0)
    with pytest.raises(ValueError, match="dtype"):
        sap.iter_chunks([[1, 2]], dtype=float)
    assert list(sap.iter_chunks([[0, 1]])) == []


def heap(count: int) -> Array:
    """Boxes that all overlap."""
    return np.hstack([np.zeros((count, 3)), np.random.default_rng(1).random((count, 3)) + 1]).astype(np.float32)


@pytest.mark.parametrize("threads", [1, 2])
def test_progress_is_reported(threads: int) -> None:
    boxes = heap(30_000)
    finder = sap.PairFinder(3, np.float32, threads=threads)
    calls: list[Callable[[Callable[[float], None]], Any]] = [
        lambda report: sap.count_pairs(boxes, threads=threads, progress=report),
        lambda report: sap.count_pairs_between(boxes[:20_000], boxes, threads=threads, progress=report),
        lambda report: finder.count(boxes, progress=report),
        lambda report: finder.count_between(boxes[:20_000], boxes, progress=report),
        lambda report: sap.find_pairs(boxes[:8000], threads=threads, progress=report),
        lambda report: sap.find_pairs_between(boxes[:4000], boxes[:8000], threads=threads, progress=report),
        lambda report: finder.find(boxes[:8000], progress=report),
        lambda report: finder.find_between(boxes[:4000], boxes[:8000], progress=report),
    ]
    for call in calls:
        seen: list[float] = []
        call(seen.append)
        assert seen == sorted(seen) and all(type(done) is float and 0 <= done <= 1 for done in seen)
        assert seen[-1] == 1.0
    # Of a search that is long enough, however fast the machine.
    for count in (30_000, 60_000, 120_000):
        seen = []
        finder.count(heap(count), progress=seen.append)
        if len(seen) > 3:
            break
    assert len(seen) > 3
    sap.find_pairs([[0, 1]], progress=seen.append)
    assert seen[-1] == 1.0


@pytest.mark.parametrize("threads", [1, 2])
def test_what_progress_raises_ends_the_search(threads: int) -> None:
    boxes, calls = heap(40_000), 0
    finder = sap.PairFinder(3, np.float32, threads=threads)

    def fail(done: float) -> None:
        nonlocal calls
        calls += 1
        assert done < 0.9
        raise KeyError("enough")

    for call in (finder.count, lambda boxes, progress: sap.count_pairs(boxes, threads=threads, progress=progress)):
        calls = 0
        with pytest.raises(KeyError, match="enough"):
            call(boxes, progress=fail)
        assert calls == 1
    assert finder.count(boxes[:100]) == 4950


@pytest.mark.parametrize("progress", [5, "print", []])
def test_progress_must_be_callable(progress: Any) -> None:
    with pytest.raises(TypeError, match="progress must be callable"):
        sap.find_pairs([[0, 1]], progress=progress)


def test_large_results_are_those_of_small_ones_in_every_type() -> None:
    boxes = heap(1600)  # 1,279,200 pairs: more than are converted at once
    alone = pairs(boxes)
    for dtype in (np.int64, np.int32, np.uint32, np.uint64):
        found = sap.find_pairs(boxes, dtype=dtype)
        assert found.dtype == dtype and np.array_equal(in_order(found), alone)
    chunks = np.concatenate(list(sap.iter_chunks(boxes)))
    assert np.array_equal(chunks, sap.find_pairs(boxes))
    finder = sap.PairFinder(3, np.float32, threads=2)
    assert np.array_equal(finder.find(boxes), finder.find(boxes)) and len(finder.find(boxes[:3])) == 3


@pytest.mark.parametrize("closed", ["both", "left"])
@pytest.mark.parametrize("offset", [0, -(2**40), 2**50, 2**52 - 200, -(2**53) + 1, 2**53 - 100, 2**60, 2**63 - 200])
def test_whole_intervals_of_different_groups_never_pair(offset: int, closed: str) -> None:
    random = np.random.default_rng(4)
    for _ in range(20):
        sets, groups = [], []
        for count in random.integers(0, 40, 2):
            start = random.integers(0, 60, count)
            sets.append((np.stack([start, start + random.integers(0, 9, count)], axis=1) + np.int64(offset)))
            groups.append(random.choice([7, 8, 2**40, 2**40 + 1], count))
        a, b = (boxes.astype(object) for boxes in sets)
        near = (a[:, None, 0] <= b[None, :, 1]) & (b[None, :, 0] <= a[:, None, 1])
        if closed == "left":
            near = (a[:, None, 0] < b[None, :, 1]) & (b[None, :, 0] < a[:, None, 1])
            near &= (a[:, 0] < a[:, 1])[:, None] & (b[:, 0] < b[:, 1])[None]
        wanted = np.argwhere(near.astype(bool) & (groups[0][:, None] == groups[1][None]))
        found = sap.find_pairs_between(*sets, by=tuple(groups), closed=closed)
        assert np.array_equal(in_order(found), wanted)
        assert sap.count_pairs_between(*sets, by=tuple(groups), closed=closed) == len(wanted)
    with pytest.raises(
        sap.InvalidBoxError, match=rf"boxes\[1\] is inverted on axis 0: min {offset + 5}(\.0)? is greater"
    ):
        sap.find_pairs(np.array([[0, 1], [5, 4]]) + offset, by=[1, 2], closed=closed)


def test_plain_arrays_are_prepared_quickly_and_as_all_others_are(monkeypatch: pytest.MonkeyPatch) -> None:
    random = np.random.default_rng(4)
    dtypes: Any = [np.int8, np.uint16, np.int32, np.int64, np.uint64, np.float16, np.float32, np.float64]
    plain, direct = _prepare._plain, 0
    for _ in range(2000):
        sets = []
        for _ in range(random.integers(1, 3)):
            low = random.integers(0, 5, (random.integers(0, 4), 2))
            boxes: Any = np.hstack([low, low + random.integers(random.choice([-1, 0, 1, 1]), 4, low.shape)])
            boxes = boxes.astype(random.choice(dtypes))
            if random.random() < 0.5 and boxes.dtype.itemsize == 8:
                boxes += boxes.dtype.type(2**53 - 2)  # some are beyond what double precision has
            if random.random() < 0.05 and boxes.dtype.kind == "f" and len(boxes):
                boxes[0, 1] = np.nan
            sets.append(boxes)
        closed: Any = random.choice(np.array(["both", "left", "right", "neither", None]))
        outcomes: list[Any] = []
        for plain_or_none in (plain, lambda sets: None):
            monkeypatch.setattr(_prepare, "_plain", plain_or_none)
            try:
                found = sap.find_pairs(*sets, closed=closed) if len(sets) == 1 else None
                found = sap.find_pairs_between(*sets, closed=closed) if found is None else found
                chunks: list[Any] = []
                for_each: Any = sap.for_each_chunk if len(sets) == 1 else sap.for_each_chunk_between
                for_each(*sets, chunks.extend, closed=closed)
                assert np.array(chunks).tolist() == found.tolist()
                outcomes.append(found.tolist())
            except (sap.InvalidBoxError, TypeError) as error:
                outcomes.append((str(error), repr(vars(error))))
        assert outcomes[0] == outcomes[1], (sets, closed)
        monkeypatch.setattr(_prepare, "_plain", plain)
        with suppress(Exception):
            prepared = _prepare.prepare(dict(zip("ab", sets)), closed=closed, fold=True)
            direct += prepared.whole is not None and _pairs.counts_of(prepared)[0] is prepared
    assert direct > 300
