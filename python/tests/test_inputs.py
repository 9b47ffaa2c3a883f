"""Whatever is passed: the right pairs, or an exception that says what is wrong. Never a panic, and no copy where
none is needed."""

from __future__ import annotations

import copy
import itertools
import pickle
from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from names import name_of
from oracle import FLOATS, in_order, pairs, random_boxes

import sweep_and_prune as sap

PAIR = [[0, 1]]


@pytest.mark.parametrize("make", [list, tuple, lambda rows: [tuple(row) for row in rows]])
def test_lists_and_tuples_are_boxes(make: Any) -> None:
    assert sap.find_pairs(make([[0, 0, 2, 2], [2, 2, 3, 3]])).tolist() == PAIR


@pytest.mark.parametrize("dtype", ["i1", "u1", "i4", "u8", "f2", "f4", "f8", ">f4", ">f8", "<f8", ">i2", "g"])
def test_every_type_of_number_is_taken(dtype: str) -> None:
    boxes = random_boxes(50, 2, np.float64) * 2
    found = sap.find_pairs(boxes.astype(dtype))
    assert np.array_equal(in_order(found), pairs(boxes))


@pytest.mark.parametrize("dtype", FLOATS)
def test_layouts_are_brought_into_order(dtype: Any) -> None:
    boxes = random_boxes(60, 3, dtype)
    wanted = sap.find_pairs(boxes)
    every_other = np.repeat(boxes, 2, axis=0)[::2]
    wide = np.hstack([boxes, boxes])[:, :6]
    backwards = boxes[::-1].copy()[::-1]
    odd = np.frombuffer(b"x" + boxes.tobytes(), np.uint8)[1:].view(boxes.dtype).reshape(boxes.shape)
    assert not odd.flags.aligned
    locked = boxes.copy()
    locked.flags.writeable = False
    for form in (np.asfortranarray(boxes), every_other, wide, backwards, odd, locked, boxes.view(Rows)):
        assert np.array_equal(sap.find_pairs(form), wanted)
        assert np.array_equal(sap.PairFinder(3, dtype).find(form), wanted)


class Rows(np.ndarray[Any, np.dtype[Any]]):
    """An array of another class."""


def test_precision_is_that_of_the_array() -> None:
    tiny = 2.0**-40
    boxes = np.array([[0, 1], [1 + tiny, 2]])
    assert len(sap.find_pairs(boxes)) == 0
    assert sap.find_pairs(boxes.astype(np.float32)).tolist() == PAIR
    # If one set is in double precision, both are compared so.
    assert len(sap.find_pairs_between(boxes[:1].astype(np.float32), boxes[1:])) == 0
    # A finder has a type of its own.
    assert len(sap.PairFinder(1, np.float64).find(boxes)) == 0
    assert sap.PairFinder(1, np.float32).find(boxes).tolist() == PAIR
    assert sap.PairFinder(1, "float32").dtype == np.float32


@pytest.mark.parametrize("empty", [[], (), np.empty((0, 2)), np.empty((0, 6), np.float32), np.empty((0, 4), int)])
def test_no_boxes_have_no_pairs(empty: Any) -> None:
    found = sap.find_pairs(empty)
    assert found.shape == (0, 2) and found.dtype == np.int64
    assert sap.count_pairs(empty) == 0
    assert sap.find_pairs_between(empty, [[0, 0, 1, 1]]).shape == (0, 2)
    assert sap.find_pairs_between([[0, 0, 1, 1]], empty).shape == (0, 2)
    assert sap.for_each_chunk(empty, lambda chunk: pytest.fail("there is none"))


WRONG: list[Any] = [
    None,
    5,
    "boxes",
    b"boxes",
    object(),
    {},
    {0: [1, 2]},
    {(0, 1)},
    Decimal(1),
    np.float64(3),
    np.array(3.0),
    [1, 2, 3, 4],
    [[1, 2, 3]],
    [[]],
    [[], []],
    [[0, 0, 1, 1], [0, 0]],
    [["a", "b"]],
    [[None, None]],
    [[object(), object()]],
    [[1j, 2j]],
    [[True, False]],
    [[Decimal(1), Decimal(2)]],
    np.zeros((2, 4), object),
    np.zeros(3, [("min", "f8", 2), ("max", "f8", 2)]),
    np.zeros((3, 2), [("x", "f8")]),
    np.zeros((2, 8)),
    np.zeros((0, 3)),
    np.zeros((2, 0)),
    np.zeros((0, 4), complex),
    np.zeros(0, object),
    lambda: None,
    sap,
]


@pytest.mark.parametrize("wrong", WRONG, ids=name_of)
def test_what_is_no_boxes_is_refused(wrong: Any) -> None:
    right = [[0.0, 0.0, 1.0, 1.0]]
    world = sap.BroadPhase(2)
    for call in (
        lambda: sap.find_pairs(wrong),
        lambda: sap.count_pairs(wrong),
        lambda: sap.for_each_chunk(wrong, print),
        lambda: sap.find_pairs_between(wrong, right),
        lambda: sap.find_pairs_between(right, wrong),
        lambda: sap.PairFinder(2).find(wrong),
        lambda: world.insert_many(wrong),
        lambda: world.overlapping_many(wrong),
    ):
        with pytest.raises((TypeError, ValueError)):
            call()
    assert len(world) == 0


def test_shapes_in_messages_name_the_argument() -> None:
    with pytest.raises(ValueError, match=r"b must be of shape \(n, 2\), \(n, 4\) or \(n, 6\).*\(1, 3\)"):
        sap.find_pairs_between([[0, 1]], [[1, 2, 3]])
    with pytest.raises(ValueError, match="same number of columns"):
        sap.find_pairs_between([[0, 1]], [[0, 0, 1, 1]])
    with pytest.raises(ValueError, match=r"\(n, 4\)"):
        sap.PairFinder(2).find([[0, 1]])


@pytest.mark.parametrize("count", [1, 30, 500, 5000, 20_000])
@pytest.mark.parametrize("dtype", FLOATS)
def test_the_first_box_that_makes_no_sense_is_named(count: int, dtype: Any) -> None:
    random = np.random.default_rng(3)
    for bad, threads in itertools.product((np.nan, -1.0, -np.inf), (1, 2)):
        boxes = random_boxes(count, 2, dtype)
        first, second = sorted(random.integers(0, count, 2))
        boxes[second, 0] = np.nan
        boxes[first, 3] = bad
        with pytest.raises(sap.InvalidBoxError) as caught:
            sap.find_pairs(boxes, threads=threads)
        assert (caught.value.index, caught.value.axis) == (first, 1 if first != second else 0)
        assert caught.value.argument == "boxes"
        with pytest.raises(sap.InvalidBoxError):
            sap.count_pairs(boxes)
        with pytest.raises(sap.InvalidBoxError):
            sap.for_each_chunk(boxes, lambda chunk: pytest.fail("called in spite of it"))


def test_the_set_of_an_invalid_box_is_named() -> None:
    good, bad = np.zeros((7, 2)), np.zeros((9, 2))
    bad[4, 1] = -1
    for arguments, name in (((bad, good), "a"), ((good, bad), "b")):
        with pytest.raises(sap.InvalidBoxError) as caught:
            sap.find_pairs_between(*arguments)
        assert (caught.value.index, caught.value.axis, caught.value.argument) == (4, 0, name)


def test_after_an_error_a_finder_goes_on() -> None:
    finder = sap.PairFinder(1, np.float32)
    for count in (3, 2000, 6000):
        boxes = random_boxes(count, 1, np.float32)
        broken = boxes.copy()
        broken[1] = np.nan
        with pytest.raises(sap.InvalidBoxError):
            finder.find(broken)
        assert np.array_equal(finder.find(boxes), sap.find_pairs(boxes))


HUGE = [0.0, -0.0, 1.0, -1.0, 3.4e38, -3.4e38, 1e-45, 1e308, -1e308, np.inf, -np.inf, np.nan]


@given(
    hnp.arrays(np.float64, st.tuples(st.integers(0, 30), st.sampled_from([2, 4, 6])), elements=st.sampled_from(HUGE))
)
@settings(max_examples=300)
def test_any_numbers_at_all(boxes: Any) -> None:
    with np.errstate(under="ignore"):
        single = np.clip(boxes, -3.4e38, 3.4e38).astype(np.float32)
    for form in (boxes, single):
        half = form.shape[1] // 2
        valid = (form[:, :half] <= form[:, half:]).all(axis=1)
        if valid.all():
            assert np.array_equal(in_order(sap.find_pairs(form)), pairs(form))
        else:
            with pytest.raises(sap.InvalidBoxError) as caught:
                sap.find_pairs(form)
            assert caught.value.index == int(np.argmin(valid))


@pytest.mark.parametrize("threads", [0, -2, 1025, 2**70, -(2**70), 1.5, "2", [1], np.nan])
def test_numbers_of_threads_that_make_no_sense(threads: Any) -> None:
    for call in (
        lambda: sap.find_pairs([[0, 1]], threads=threads),
        lambda: sap.count_pairs([[0, 1]], threads=threads),
        lambda: sap.find_pairs_between([[0, 1]], [[0, 1]], threads=threads),
        lambda: sap.PairFinder(1, threads=threads),
    ):
        with pytest.raises((TypeError, ValueError), match="threads"):
            call()


@pytest.mark.parametrize("dimensions", [0, 4, -1, 2**64, 2.0, "2", None])
def test_dimensions_that_there_are_not(dimensions: Any) -> None:
    for kind in (sap.PairFinder, sap.BroadPhase):
        with pytest.raises((TypeError, ValueError), match="dimensions"):
            kind(dimensions)


@pytest.mark.parametrize("dtype", [None, int, "f2", "g", object, "nonsense", 7, [], ">f4", np.complex128])
def test_types_that_are_not_coordinates(dtype: Any) -> None:
    for kind in (sap.PairFinder, sap.BroadPhase):
        with pytest.raises(ValueError, match="dtype"):
            kind(2, dtype)


@pytest.mark.parametrize("size", [0, -5, 2**24 + 1, 2**70, 1.5, None, "7"])
def test_sizes_of_chunks_that_make_no_sense(size: Any) -> None:
    with pytest.raises((TypeError, ValueError), match="size"):
        sap.for_each_chunk([[0, 1]], print, size=size)


@pytest.mark.parametrize("each", [None, 5, "print", []])
def test_what_cannot_be_called_back(each: Any) -> None:
    with pytest.raises(TypeError, match="each"):
        sap.for_each_chunk([[0, 1]], each)


def test_errors_can_be_caught_by_kind_copied_and_pickled() -> None:
    for error, kinds in (
        (sap.InvalidBoxError(3, 1, "a", 2.0, 1.0), (ValueError,)),
        (sap.StaleProxyError(77, 2), (LookupError,)),
        (sap.InvalidQueryError(5, "limits", -1.0, "0 or more"), (ValueError,)),
        (sap.SnapshotError("why"), (ValueError,)),
    ):
        assert isinstance(error, sap.SweepAndPruneError) and isinstance(error, kinds)
        for again in (copy.copy(error), pickle.loads(pickle.dumps(error))):
            assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)


def test_boxes_that_change_their_mind() -> None:
    class Fickle:
        def __array__(self, dtype: Any = None, copy: Any = None) -> Any:
            raise ZeroDivisionError("mine")

    with pytest.raises(ZeroDivisionError):
        sap.find_pairs(Fickle())
