"""Boxes on an axis that is a circle, such as longitude: each becomes one or two boxes on a line.

Coordinates are compared exactly: the remainder of two floating point numbers is not rounded, nor is the difference that
brings it into the turn of the circle around 0.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._arrays import Floats, real


def checked_wrap(wrap: object) -> float:
    """The length of the circle."""
    length = real(wrap, "wrap")
    if not (1e-300 < length < 1e300):
        raise ValueError(f"wrap is {wrap}; it must be finite and greater than 0, such as 360 for degrees of longitude")
    return length


def precise_enough(boxes: Floats, wrap: float) -> Floats:
    """Boxes in a precision that holds half of the circle exactly."""
    with np.errstate(all="ignore"):  # what is too large for float32 becomes infinite, and what is too small 0
        is_exact = float(boxes.dtype.type(wrap)) == wrap
    return boxes if is_exact else boxes.astype(np.float64)


def without_crossings(boxes: NDArray[Any]) -> NDArray[Any]:
    """A copy in which no box crosses the end of the circle, so that those that are inverted on other axes are left."""
    half = boxes.shape[1] // 2
    checked = boxes.copy()
    crosses = boxes[:, 0] > boxes[:, half]
    checked[crosses, half] = boxes[crosses, 0]
    return checked


def refuse_infinite(boxes: Floats, name: str, kept: NDArray[np.int64] | None) -> None:
    """Refuses boxes with one infinite end on the circle. From minus infinity to infinity is the whole circle."""
    half = boxes.shape[1] // 2
    low, high = boxes[:, 0], boxes[:, half]
    wrong = np.flatnonzero((np.isinf(low) | np.isinf(high)) & ~((low == -np.inf) & (high == np.inf)))
    if len(wrong):
        index = int(wrong[0] if kept is None else kept[wrong[0]])
        raise ValueError(
            f"{name}[{index}] has an infinite end on axis 0, which wraps: pass finite ends, or -inf and inf for all "
            "of the circle"
        )


def in_one_turn(boxes: Floats, wrap: float) -> Floats:
    """Boxes of which those whose min is greater than their max are brought to the same turn of the circle."""
    half = boxes.shape[1] // 2
    crosses = np.flatnonzero(boxes[:, 0] > boxes[:, half])
    if len(crosses):
        boxes = boxes.copy()
        for column in (0, half):
            boxes[crosses, column] = _place(boxes[crosses, column], wrap)
    return boxes


def cut(boxes: Floats, reach: Floats, wrap: float) -> tuple[Floats, NDArray[np.int64]]:
    """Boxes on a line that overlap where boxes on the circle do.

    Args:
        boxes: rows in one turn; a min greater than the max on axis 0 means that the box crosses the end of the circle.
        reach: their max on axis 0 with the margin; elsewhere they have it already.
        wrap: the length of the circle.

    Returns:
        A row for each box, and after these a second row for each that crosses the end; and the rows of the latter.
    """
    half, end = boxes.shape[1] // 2, wrap / 2
    low, high = boxes[:, 0], boxes[:, half]
    is_whole = np.where(low <= high, _is_as_long(low, reach, wrap), reach >= low)
    on_line = boxes.copy()
    on_line[:, 0], on_line[:, half] = _place(low, wrap), _place(reach, wrap)
    on_line[is_whole, 0], on_line[is_whole, half] = -end, end
    crossing = np.flatnonzero(on_line[:, 0] > on_line[:, half])
    second = on_line[crossing]
    second[:, 0] = -end
    on_line[crossing, half] = end
    return np.concatenate([on_line, second]), crossing


def _place(numbers: Floats, wrap: float) -> Floats:
    """The place on the circle, from `-wrap / 2` up to and without `wrap / 2`. Exact."""
    with np.errstate(all="ignore"):
        place: Floats = np.fmod(numbers, numbers.dtype.type(wrap))
        place[place >= wrap / 2] -= wrap
        place[place < -wrap / 2] += wrap
        return place


def _is_as_long(low: Floats, high: Floats, wrap: float) -> NDArray[np.bool_]:
    """Whether `high - low >= wrap`, exactly: the error of the rounded difference decides where that equals `wrap`."""
    with np.errstate(all="ignore"):
        difference = high - low
        rest = difference - high
        error = (high - (difference - rest)) - (low + rest)
        return np.asarray((difference > wrap) | ((difference == wrap) & ~(error < 0)))


def is_repeated(pairs: NDArray[Any], sets: list[Floats], crossing: list[NDArray[np.int64]]) -> NDArray[np.bool_]:
    """Whether a pair of rows is one that other rows of the same two boxes have, too.

    Args:
        pairs: rows of the first and of the last set.
        sets: what `cut` returned, one set or two.
        crossing: which rows have a second one, for each set.
    """
    sides = [(sets[0], crossing[0]), (sets[-1], crossing[-1])]
    numbers = [len(boxes) - len(rows) for boxes, rows in sides]
    are_second = [pairs[:, side] >= number for side, number in enumerate(numbers)]
    repeated = np.zeros(len(pairs), bool)
    for side in (0, 1):
        at = np.flatnonzero(are_second[side])
        if len(at) == 0:
            continue
        (boxes, rows), (others, other_rows) = sides[side], sides[1 - side]
        first, other = rows[pairs[at, side] - numbers[side]], pairs[at, 1 - side]
        # Two boxes that cross the end share it: their first rows pair. Otherwise the first row has the pair, or not.
        crosses = are_second[1 - side][at] | np.isin(other, other_rows)
        half = boxes.shape[1] // 2
        meets = (boxes[first, 0] <= others[other, half]) & (others[other, 0] <= boxes[first, half])
        repeated[at] |= crosses | meets
    return repeated


def first_rows(rows: NDArray[Any], boxes: Floats, crossing: NDArray[np.int64]) -> NDArray[Any]:
    """The rows with those of second rows replaced by the first ones."""
    number = len(boxes) - len(crossing)
    second = rows >= number
    if not second.any():
        return rows
    rows = rows.copy()
    rows[second] = crossing[rows[second] - number]
    return rows


def shared_length(a: NDArray[Any], b: NDArray[Any], wrap: float) -> NDArray[np.float64]:
    """How long the intersection is on the circle, of pairs of `(m, 2)` min and max."""
    starts, lengths = zip(*(_arc(ends, wrap) for ends in (a, b)))
    total = np.zeros(len(a))
    for turn in (-wrap, 0.0, wrap):
        low = np.maximum(starts[0], starts[1] + turn)
        high = np.minimum(starts[0] + lengths[0], starts[1] + lengths[1] + turn)
        total += np.maximum(high - low, 0)
    return np.asarray(np.minimum(total, np.minimum(*lengths)))


def _arc(ends: NDArray[Any], wrap: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    starts: NDArray[np.float64] = ends[:, 0].astype(np.float64)
    return np.asarray(_place(starts, wrap), np.float64), length_on_circle(ends[:, 0], ends[:, 1], wrap)


def length_on_circle(low: NDArray[Any], high: NDArray[Any], wrap: float) -> NDArray[np.float64]:
    """How long boxes are on the circle, at most all of it."""
    ends = in_one_turn(np.stack([low, high], axis=1).astype(np.float64), wrap)
    with np.errstate(all="ignore"):
        length = ends[:, 1] - ends[:, 0]
    return np.asarray(np.minimum(np.where(length < 0, length + wrap, length), wrap))
