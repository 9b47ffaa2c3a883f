"""Finds the pairs of one cell, each pair in only one cell."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .._pairs import for_each_chunk, for_each_chunk_between

CHUNK = 131_072
"""How many pairs a chunk has: large enough for NumPy, small enough for the cache."""

Report = Callable[[NDArray[Any], NDArray[Any]], object]
"""Takes the ids of both boxes of some pairs."""


class Boxes(NamedTuple):
    """Boxes with an id each: whole numbers, or text as an array of objects."""

    ids: NDArray[Any]
    rows: Floats

    def take(self, rows: NDArray[Any]) -> Boxes:
        """Some of the boxes."""
        return Boxes(self.ids[rows], self.rows[rows])


def search(
    a: Boxes,
    b: Boxes | None,
    low: NDArray[np.float64],
    report: Report,
    size: int = CHUNK,
) -> None:
    """Reports the pairs of `a`, or of `a` and `b`, whose intersection has its lower corner in a cell.

    All boxes must touch the cell. Then the lower corner of an intersection is in the cell unless both boxes begin
    before the cell on the same axis: where one of them begins within the cell, so does the intersection. So one bit for
    each axis and box decides.

    Args:
        a: boxes that touch the cell.
        b: more boxes that touch the cell, or None.
        low: the min corner of the cell.
        report: called with the ids of `a` and of `b`. Within one set, in no order.
        size: the most pairs to report at once.
    """
    early_a, early_b = begins_early(a.rows, low), None if b is None else begins_early(b.rows, low)
    other_ids, other_early = (a.ids, early_a) if b is None else (b.ids, early_b)

    def each(pairs: NDArray[Any]) -> None:
        first, second = pairs[:, 0], pairs[:, 1]
        if early_a is not None and other_early is not None:
            is_here = (early_a[first] & other_early[second]) == 0
            first, second = first[is_here], second[is_here]
        if len(first):
            report(a.ids[first], other_ids[second])

    if b is None:
        for_each_chunk(a.rows, each, size=size, dtype=np.uint32)
    else:
        for_each_chunk_between(a.rows, b.rows, each, size=size, dtype=np.uint32)


def begins_early(rows: Floats, low: NDArray[np.float64]) -> NDArray[np.uint8] | None:
    """One bit for each axis on which a box begins before a cell; None if no box does."""
    half = rows.shape[1] // 2
    early = np.zeros(len(rows), np.uint8)
    for axis in range(half):
        if low[axis] > -np.inf:
            early |= (rows[:, axis] < low[axis]).astype(np.uint8) << np.uint8(axis)
    return early if early.any() else None


def touches(rows: Floats, low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether boxes touch a cell."""
    half = rows.shape[1] // 2
    inside = np.ones(len(rows), bool)
    for axis in range(half):
        if high[axis] < np.inf:
            inside &= rows[:, axis] < high[axis]
        if low[axis] > -np.inf:
            inside &= rows[:, axis + half] >= low[axis]
    return inside


def in_order(first: NDArray[Any], second: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Pairs of one set with the smaller id first."""
    if first.dtype.kind == "O":
        is_swapped = np.fromiter((a > b for a, b in zip(first.tolist(), second.tolist())), bool, len(first))
        return np.where(is_swapped, second, first), np.where(is_swapped, first, second)
    return np.minimum(first, second), np.maximum(first, second)
