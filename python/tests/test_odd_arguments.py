"""Odd values in every place of every public call: each call returns, or raises what the documents name. A panic would
be a `PanicException`, which is none of these."""

from __future__ import annotations

import importlib
import inspect
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from oracle import random_boxes

import sweep_and_prune as sap

try:
    pandas: Any = importlib.import_module("pandas")
except ImportError:
    pandas = None


class Stubborn:
    """Refuses to be anything."""

    def __index__(self) -> int:
        raise ZeroDivisionError

    def __float__(self) -> float:
        raise ZeroDivisionError

    def __array__(self, *arguments: Any, **named: Any) -> Any:
        raise ZeroDivisionError


ODD: list[Any] = [
    *[None, True, False, -1, 0, 1, 7, 2**31, 2**32, 2**63, 2**64 - 1, 2**64, 2**70, -(2**70)],
    *[
        0.0,
        0.5,
        -1e300,
        float("nan"),
        float("inf"),
        1j,
        "",
        "1",
        "\ud800",
        b"",
        b"SaPw",
        bytearray(9),
        memoryview(b"x"),
    ],
    *[
        [],
        (),
        {},
        set(),
        [[]],
        [None],
        [1],
        [1, 2],
        [1, 2, 3],
        [1, 2, 3, 4],
        [[1, 2, 3, 4]],
        [[4, 3, 2, 1]],
        [[1], [2, 3]],
    ],
    *[range(4), range(0), slice(3), Ellipsis, NotImplemented, object(), Stubborn(), int, print, lambda *_: False],
    *[
        np.float32(1),
        np.int8(-1),
        np.uint64(2**63),
        np.bool_(True),
        np.datetime64("2026-01-01"),
        np.array(3),
        np.array(None),
    ],
    *[np.zeros(0), np.zeros((0, 4)), np.zeros((3, 4)), np.zeros((3, 2)), np.zeros((1, 4, 4)), np.full((3, 4), np.nan)],
    *[np.zeros((3, 4), "f2"), np.zeros((3, 4), ">f8"), np.zeros((3, 4), bool), np.zeros((3, 4), object)],
    *[np.zeros((4, 3)).T, np.zeros((6, 8))[::2, ::2], np.zeros((3, 4), "S3"), np.zeros(3, [("a", "f8"), ("b", "i4")])],
    *[
        np.ma.array(np.zeros((3, 4)), mask=True),
        np.arange(3),
        np.arange(3) - 1,
        np.arange(3, dtype="u8"),
        sap.Filter(),
        sap.Filter(-1, -1),
    ],
]

ALLOWED = (TypeError, ValueError, sap.SweepAndPruneError, MemoryError, ZeroDivisionError)

ROWS = random_boxes(3, 2, np.float64)
POINTS = ROWS[:, :2]


def world() -> tuple[sap.BroadPhase, Any]:
    made = sap.BroadPhase(2)
    ids = made.insert_many(ROWS)
    made.update()
    return made, ids


def sensible(name: str, ids: Any) -> Any:
    """A value for a parameter of this name."""
    values = {
        **dict.fromkeys(("boxes", "a", "b", "starts", "ends"), ROWS),
        **dict.fromkeys(("box", "start", "end"), ROWS[0]),
        **dict.fromkeys(("points", "centers", "origins", "directions"), POINTS),
        **dict.fromkeys(("point", "center", "origin", "direction", "offset"), POINTS[0]),
        **dict.fromkeys(("radius", "radii", "limit", "limits", "margin", "prediction", "max_distance"), 1.0),
        **dict.fromkeys(("threads", "k", "size", "index", "axis", "group", "category", "mask"), 1),
        **{
            "id": int(ids[0]),
            "first": int(ids[0]),
            "second": int(ids[1]),
            "enabled": False,
            "ids": ids,
            "filter": sap.Filter(),
            "each": lambda chunk: None,
            "snapshot": b"",
        },
        **{"format": "xyxy", "closed": "both", "missing": "raise", "by": None, "index_dtype": np.int64},
        **{"how": "inner", "predicate": "intersects", "distance": None, "lsuffix": "left", "rsuffix": "right"},
        **dict.fromkeys(
            ("on_attribute", "left_by", "right_by", "left_columns", "right_columns", "fraction", "measures", "wrap")
        ),
        **{"intervals": ROWS[:, [0, 2]], "pairs": np.array([[0, 1], [2, 2]])},
        **dict.fromkeys(("left", "right"), pandas and pandas.DataFrame(ROWS, columns=["x1", "y1", "x2", "y2"])),
        **{
            "dimensions": 2,
            "progress": None,
            "dtype": np.float64,
            "report": "exact",
            "other": sap.Filter(),
            "is_static": False,
            "sorted": True,
            "ignore_touching": True,
            "exclude": [0],
        },
    }
    return values[name]


def calls() -> Iterator[tuple[str, Any]]:
    """The name of each public call, and what makes the function to call and ids that go with it."""

    def free(name: str) -> Any:
        return lambda: (getattr(sap, name), world()[1])

    def method(kind: str, name: str) -> Any:
        def make() -> Any:
            made, ids = world()
            owner: Any = {"BroadPhase": made, "PairFinder": sap.PairFinder(2), "Filter": sap.Filter()}[kind]
            return getattr(owner, name), ids

        return make

    for name in (
        "find_pairs",
        "find_pairs_between",
        "count_pairs",
        "count_pairs_between",
        "for_each_chunk",
        "for_each_chunk_between",
        "iter_chunks",
        "iter_chunks_between",
        *(["join"] if pandas else []),
        *("count_overlaps", "measure_overlaps", "nearest", "cluster", "merge"),
        "slots_of",
        "PairFinder",
        "BroadPhase",
    ):
        yield name, free(name)
    for kind in ("PairFinder", "BroadPhase", "Filter"):
        for name, member in vars(getattr(sap, kind)).items():
            if (inspect.isfunction(member) or isinstance(member, classmethod)) and not name.startswith("_"):
                yield f"{kind}.{name}", method(kind, name)


def test_no_call_is_left_out() -> None:
    assert len(list(calls())) > 45


# Older versions of NumPy warn where newer ones raise.
@pytest.mark.filterwarnings(
    "ignore:Creating an ndarray from ragged", "ignore:The truth value of an empty array", "ignore:elementwise"
)
@pytest.mark.parametrize(("name", "make"), list(calls()), ids=[name for name, _ in calls()])
def test_odd_values(name: str, make: Any) -> None:
    function, ids = make()
    parameters = list(inspect.signature(function).parameters)
    refused = 0
    for at in parameters:
        for odd in ODD:
            function, ids = make()
            arguments = {parameter: sensible(parameter, ids) for parameter in parameters} | {at: odd}
            try:
                if {"boxes", "a"} & set(parameters) and arguments.get("dtype") is np.float64:
                    arguments["dtype"] = np.int64  # that of indices
                result = function(**arguments)
                if isinstance(result, Iterator):
                    list(result)
            except ALLOWED as error:
                refused += 1
                assert str(error) or isinstance(error, ZeroDivisionError)
    assert refused > len(parameters) or not parameters or name == "BroadPhase.contains"


def test_ids_may_be_asked_for_whatever_they_are() -> None:
    made, ids = world()
    for odd in ODD:
        try:
            assert (odd in made) == (type(odd) is int and odd in ids.tolist())
        except ZeroDivisionError:
            assert isinstance(odd, Stubborn)
    assert len(made) == 3
