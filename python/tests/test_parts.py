"""Of two sets of millions of intervals, the larger one is converted a part at a time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import sweep_and_prune as sap

MANY = 2_200_000
"""Three parts, the last one short."""
FEW = 20_000

Intervals = NDArray[Any]


def intervals(count: int, longest: int, seed: int) -> Intervals:
    random = np.random.default_rng(seed)
    starts = random.integers(0, 50_000_000, count)
    return np.stack([starts, starts + random.integers(1, longest, count)], axis=1)


@pytest.fixture(scope="module")
def few() -> Intervals:
    return intervals(FEW, 200, 1)


@pytest.fixture(scope="module")
def many() -> Intervals:
    return intervals(MANY, 200, 2)


def at_once(a: Intervals, b: Intervals, **options: Any) -> NDArray[np.int64]:
    """The pairs that are passed on in chunks: these come from all boxes at once."""
    return np.concatenate(list(sap.iter_chunks_between(a, b, **options)))


def number_of_pairs(a: Intervals, b: Intervals) -> int:
    """Of half-open intervals, by NumPy: those that begin before an end, without those that end before a start."""
    starts, ends = np.sort(b[:, 0]), np.sort(b[:, 1])
    return int((np.searchsorted(starts, a[:, 1]) - np.searchsorted(ends, a[:, 0], "right")).sum())


@pytest.mark.parametrize("kind", [np.int64, np.int32, np.float64, np.float32])
def test_parts_have_the_pairs_of_all_at_once(few: Intervals, many: Intervals, kind: type) -> None:
    a: Intervals = few.astype(kind)
    b: Intervals = many.astype(kind)
    for first, second in ((a, b), (b, a)):
        found = sap.find_pairs_between(first, second, closed="left")
        np.testing.assert_array_equal(found, at_once(first, second, closed="left"))
        assert kind == np.float32 or len(found) == number_of_pairs(few, many) > 100_000
    closed = sap.find_pairs_between(a, b)
    np.testing.assert_array_equal(closed, at_once(a, b))


def test_a_smaller_set_that_does_not_fit_a_cache_has_parts_too(many: Intervals) -> None:
    others = intervals(300_000, 1000, 3)
    for first, second in ((many, others), (others, many)):
        found = sap.find_pairs_between(first, second, closed="left", dtype=np.uint32)
        assert found.dtype == np.uint32 and len(found) == number_of_pairs(many, others)
        np.testing.assert_array_equal(found, at_once(first, second, closed="left"))


@pytest.mark.parametrize("at", [5, MANY - 1])
def test_what_is_wrong_in_a_part_is_named_as_elsewhere(few: Intervals, many: Intervals, at: int) -> None:
    inverted = many.copy()
    inverted[at] = [7, 3]
    with pytest.raises(sap.InvalidBoxError, match=rf"b\[{at}\]") as error:
        sap.find_pairs_between(few, inverted)
    assert error.value.index == at
    with pytest.raises(sap.InvalidBoxError, match=rf"a\[{at}\]"):
        sap.find_pairs_between(inverted.astype(float), few)
    missing = many.astype(float)
    missing[at, 1] = np.nan
    with pytest.raises(sap.InvalidBoxError, match=rf"a\[{at}\]"):
        sap.find_pairs_between(missing, few)


@pytest.mark.parametrize("at", [5, MANY - 1])
def test_integers_that_floats_do_not_have_are_exact_in_every_part(few: Intervals, many: Intervals, at: int) -> None:
    far = few.copy()
    far[17] = [2**53 + 1, 2**53 + 1]
    for start, is_found in ((2**53, False), (2**53 + 1, True)):
        larger = many.copy()
        larger[at] = [start, start]
        found = sap.find_pairs_between(far, larger)
        assert ([17, at] in found.tolist()) == is_found
        assert len(found) == sap.count_pairs_between(far, larger)


@pytest.mark.parametrize("at", [5, MANY - 1])
def test_intervals_without_length_overlap_nothing_in_every_part(few: Intervals, many: Intervals, at: int) -> None:
    larger = many.copy()
    larger[at] = few[3, 0] + [1, 1]
    found = sap.find_pairs_between(few, larger, closed="left")
    assert len(found) == sap.count_pairs_between(few, larger, closed="left") and at not in found[:, 1]


def test_progress_is_that_of_all_parts(few: Intervals, many: Intervals) -> None:
    shares: list[float] = []
    # Enough pairs that each part tells of its progress several times.
    others = intervals(40_000, 20_000, 3)
    sap.find_pairs_between(many, others, progress=shares.append)
    assert shares == sorted(shares) and 0 <= shares[0] and shares[-1] == 1.0

    def stop(share: float) -> None:
        raise StopIteration(share)

    finder = sap.PairFinder(dimensions=1)
    with pytest.raises(StopIteration):
        finder.find_between(many, others, progress=stop)
    np.testing.assert_array_equal(finder.find_between(few, many), at_once(few.astype(float), many.astype(float)))
