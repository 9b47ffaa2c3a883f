"""Brings one or two sets of boxes into the form that is searched: open ends, missing values, groups and integers
beyond 2^53 become plain boxes in floating point that have exactly the wanted pairs."""

from __future__ import annotations

from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Floats, box_array, box_rows, checked_closed, numbers, same_width
from ._errors import InvalidBoxError
from ._inputs import checked_format

Rows = Optional[NDArray[np.int64]]


class Prepared(NamedTuple):
    """Boxes to search, and how their pairs are translated back."""

    sets: list[Floats]
    kept: list[Rows]
    """The row of each box in what the user passed; None if no row was left out."""
    groups: list[NDArray[Any]] | None
    """Groups that have to be compared after the search, because there is no axis left for them."""

    def translate(self, pairs: NDArray[Any]) -> NDArray[Any]:
        """The pairs in rows of what the user passed."""
        if self.groups is not None:
            first, second = self.groups[0], self.groups[-1]
            pairs = pairs[first[pairs[:, 0]] == second[pairs[:, 1]]]
        if all(rows is None for rows in self.kept):
            return pairs
        columns = zip((self.kept[0], self.kept[-1]), pairs.T)
        translated = [column if rows is None else rows[column] for rows, column in columns]
        return np.stack(translated, axis=1).astype(pairs.dtype, copy=False)


def prepare(
    sets: dict[str, ArrayLike], format: str, closed: str | None, missing: str, by: list[ArrayLike] | None
) -> Prepared:
    """Brings sets of boxes, by the names of their arguments, into the form that is searched."""
    is_plain = format == "xyxy" and closed is None and missing == "raise" and by is None
    if is_plain and all(type(boxes) is np.ndarray and boxes.dtype.kind == "f" for boxes in sets.values()):
        rows = [box_rows(boxes, name) for name, boxes in sets.items()]  # the common case, quickly
        if len(rows) == 2:
            rows = list(same_width(*rows))
            if rows[0].dtype != rows[1].dtype:
                rows = [array.astype(np.float64, copy=False) for array in rows]
        return Prepared(rows, [None for _ in rows], None)
    checked_format(format)
    if not (isinstance(missing, str) and missing in ("raise", "skip")):
        raise ValueError(f'missing must be "raise" or "skip", not {missing!r}')
    is_closed = checked_closed(closed, *sets.values())
    names = list(sets)
    arrays = [box_array(values, name, 0, format) for name, values in sets.items()]
    if len(arrays) == 2:
        arrays = list(same_width(*arrays))
    kept: list[Rows] = [None for _ in arrays]
    if missing == "skip":
        arrays, kept = _leave_out([_is_missing(array) for array in arrays], arrays, kept)
    rows = _exact(arrays, names)
    if not is_closed:
        for array, name in zip(rows, names):
            _refuse_inverted(array, name)
        half = rows[0].shape[1] // 2
        # An interval without its ends that begins where it ends is empty, and overlaps nothing.
        empty = [(array[:, :half] == array[:, half:]).any(axis=1) for array in rows]
        rows, kept = _leave_out(empty, rows, kept)
        rows = [_without_ends(array) for array in rows]
    groups = None if by is None else _groups(by, sets, kept)
    if groups is not None and rows[0].shape[1] < 6:
        half, dtype = rows[0].shape[1] // 2, np.result_type(*rows)
        dtype = np.dtype(np.float64) if max(map(_most, groups)) >= 2**24 else dtype
        codes = [group.astype(dtype)[:, None] for group in groups]
        rows = [_with_axis(boxes, code) for boxes, code in zip(rows, codes)]
        groups = None
    return Prepared(rows, kept, groups)


def _with_axis(boxes: Floats, code: Any) -> Floats:
    half = boxes.shape[1] // 2
    extended: Floats = np.hstack([boxes[:, :half], code, boxes[:, half:], code])
    return extended


def _most(array: NDArray[Any]) -> int:
    return int(array.max()) if len(array) else 0


def _is_missing(array: NDArray[Any]) -> NDArray[np.bool_]:
    """The boxes of which a coordinate is missing."""
    if array.dtype.kind == "f":
        return np.asarray(np.isnan(array).any(axis=1))
    if array.dtype.kind in "mM":
        return np.asarray(np.isnat(array).any(axis=1))
    return np.zeros(len(array), bool)


def _leave_out(masks: list[NDArray[np.bool_]], arrays: list[Any], kept: list[Rows]) -> tuple[list[Any], list[Rows]]:
    """Arrays without the rows that are masked, and what is left of the kept rows."""
    result, rows = [], []
    for mask, array, before in zip(masks, arrays, kept):
        if mask.any():
            left = np.flatnonzero(~mask)
            array, before = array[left], left if before is None else before[left]
        result.append(array)
        rows.append(before)
    return result, rows


def _exact(arrays: list[NDArray[Any]], names: list[str]) -> list[Floats]:
    """Coordinates in floating point. Times, and integers that would be rounded, become their ranks on each axis:
    these are in the same order."""
    if all(array.dtype.kind in "mM" for array in arrays) or (
        all(array.dtype.kind in "iu" for array in arrays) and any(_is_rounded(array) for array in arrays)
    ):
        for array, name in zip(arrays, names):
            _refuse_inverted(array, name)
        half, ends = arrays[0].shape[1] // 2, np.cumsum([len(array) for array in arrays])[:-1]
        if any(array.dtype.kind == "u" for array in arrays) and len({array.dtype for array in arrays}) > 1:
            arrays = [array.astype(object) for array in arrays]  # no integer type holds both
        every = np.concatenate(arrays)
        ranks = np.empty(every.shape)
        for axis in range(half):
            both = every[:, [axis, axis + half]]
            ranks[:, [axis, axis + half]] = np.unique(both, return_inverse=True)[1].reshape(both.shape)
        return list(np.split(ranks, ends))
    rows = [numbers(array, name) for array, name in zip(arrays, names)]
    # If one set is in double precision, both are compared so.
    return [array.astype(np.result_type(*rows), copy=False) for array in rows]


def _is_rounded(array: NDArray[Any]) -> bool:
    most = 2**53
    return array.dtype.itemsize == 8 and array.size > 0 and bool(array.max() > most or array.min() < -most)


def _refuse_inverted(array: NDArray[Any], name: str) -> None:
    half = array.shape[1] // 2
    invalid = ~(array[:, :half] <= array[:, half:])
    if invalid.any():
        index = int(np.argmax(invalid.any(axis=1)))
        axis = int(np.argmax(invalid[index]))
        low, high = array[index, axis], array[index, axis + half]
        raise InvalidBoxError(index, axis, name, low, high)


def _without_ends(boxes: Floats) -> Floats:
    """Boxes whose max corners are the next smaller numbers: boxes that touched do not overlap then."""
    half = boxes.shape[1] // 2
    with np.errstate(all="ignore"):
        before = np.nextafter(boxes[:, half:], boxes.dtype.type(-np.inf))
    shrunk: Floats = np.hstack([boxes[:, :half], before])
    return shrunk


def _groups(by: list[ArrayLike], sets: dict[str, Any], kept: list[Rows]) -> list[NDArray[np.int64]]:
    """A number for the group of each box that is kept."""
    columns = [np.asarray(values) for values in by]
    for column, (name, boxes) in zip(columns, sets.items()):
        if column.shape != (len(boxes),):
            raise ValueError(
                f"by must have one value for each box of {name}: shape ({len(boxes)},), not {column.shape}"
            )
    codes = np.unique(np.concatenate(columns), return_inverse=True)[1].reshape(-1).astype(np.int64)
    split = np.split(codes, np.cumsum([len(column) for column in columns])[:-1])
    return [group if rows is None else group[rows] for group, rows in zip(split, kept)]
