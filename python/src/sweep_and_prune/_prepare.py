"""Brings one or two sets of boxes into the form that is searched: open ends, margins, missing values, groups and
integers beyond 2^53 become plain boxes in floating point that have exactly the wanted pairs."""

from __future__ import annotations

from collections.abc import Iterator
from datetime import timedelta
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import Floats, box_array, box_rows, checked_closed, numbers, same_width
from ._errors import InvalidBoxError
from ._inputs import as_array, checked_format, named_column

_BLOCK = 2**18
"""So many pairs are translated at once: a second array of all of them would take as much memory as the result."""

Rows = Optional[NDArray[np.int64]]


class Prepared(NamedTuple):
    """Boxes to search, and how their pairs are translated back."""

    sets: list[Floats]
    kept: list[Rows]
    """The row of each box in what the user passed; None if no row was left out."""
    groups: list[NDArray[Any]] | None
    """Groups that have to be compared after the search, because there is no axis left for them."""

    def translate(self, pairs: NDArray[Any]) -> NDArray[Any]:
        """The pairs in rows of what the user passed, in the memory of `pairs`, which is written to and shortened."""
        if self.groups is not None or any(rows is not None for rows in self.kept):
            left = self._translate_in_place(pairs)
            if left < len(pairs):
                pairs.resize((left, 2), refcheck=False)
        return pairs

    def _translate_in_place(self, pairs: NDArray[Any]) -> int:
        """Writes the translated pairs over the first ones, and returns their number."""
        left = 0
        for start in range(0, len(pairs), _BLOCK):
            block = pairs[start : start + _BLOCK]
            if self.groups is not None:
                block = block[self.groups[0][block[:, 0]] == self.groups[-1][block[:, 1]]]
            into = pairs[left : left + len(block)]
            for column, rows in enumerate((self.kept[0], self.kept[-1])):
                into[:, column] = block[:, column] if rows is None else rows[block[:, column]]
            left += len(block)
        return left


def prepare(
    sets: dict[str, ArrayLike],
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: list[ArrayLike] | None = None,
    margin: object = 0,
) -> Prepared:
    """Brings sets of boxes, by the names of their arguments, into the form that is searched."""
    checked_format(format)
    if not (isinstance(missing, str) and missing in ("raise", "skip")):
        raise ValueError(f'missing must be "raise" or "skip", not {missing!r}')
    has_margin = not is_zero(margin)
    is_plain = format == "xyxy" and closed is None and missing == "raise" and by is None and not has_margin
    if is_plain and all(type(boxes) is np.ndarray and boxes.dtype.kind == "f" for boxes in sets.values()):
        rows = [box_rows(boxes, name) for name, boxes in sets.items()]  # the common case, quickly
        if len(rows) == 2:
            rows = list(same_width(*rows))
            if rows[0].dtype != rows[1].dtype:
                rows = [array.astype(np.float64, copy=False) for array in rows]
        return Prepared(rows, [None for _ in rows], None)
    is_closed = checked_closed(closed, *sets.values())
    names = list(sets)
    arrays = [box_array(values, name, 0, format) for name, values in sets.items()]
    if len(arrays) == 2:
        arrays = list(same_width(*arrays))
    kept: list[Rows] = [None for _ in arrays]
    counts = [len(array) for array in arrays]
    if missing == "skip":
        arrays, kept = _leave_out([_is_missing(array) for array in arrays], arrays, kept)
    are_whole = all(array.dtype.kind in "iu" for array in arrays) and not has_margin
    arrays = _comparable(arrays, names)
    is_float = arrays[0].dtype.kind == "f"
    is_all = all(rows is None for rows in kept)
    # Most often, all intervals have a length: then none is inverted or empty.
    have_length = not is_closed and all(bool((low < high).all()) for array in arrays for low, high in _sides(array))
    if not (have_length or (is_float and is_closed and is_all and not has_margin)):
        # The compiled part would not see these boxes, or not by these indices.
        for array, name, own in zip(arrays, names, kept):
            refuse_inverted(array, name, own)
    if not (is_closed or have_length):
        # An interval without its ends that begins where it ends is empty, and overlaps nothing.
        arrays, kept = _leave_out([_is_empty(array) for array in arrays], arrays, kept)
    if has_margin:
        # Two boxes are within a margin if neither begins more than the margin after the other's end.
        arrays = [_extended(array, margin) for array in arrays]
    rows = arrays if is_float else _ranks(arrays)
    if not is_closed:
        rows = [_without_ends(array, are_whole and is_float) for array in rows]
    groups = None if by is None else _groups(by, sets, counts, kept)
    if groups is not None and rows[0].shape[1] < 6:
        dtype = np.result_type(*rows)
        dtype = np.dtype(np.float64) if max(map(_most, groups)) >= 2**24 else dtype
        codes = [group.astype(dtype)[:, None] for group in groups]
        rows = [_with_axis(boxes, code) for boxes, code in zip(rows, codes)]
        groups = None
    return Prepared(rows, kept, groups)


def is_zero(margin: object) -> bool:
    """Whether there is no margin, which is so for times, too."""
    return type(margin) in (int, float) and margin == 0


def _with_axis(boxes: Floats, code: Any) -> Floats:
    half = boxes.shape[1] // 2
    extended: Floats = np.hstack([boxes[:, :half], code, boxes[:, half:], code])
    return extended


def _most(array: NDArray[Any]) -> int:
    return int(array.max()) if len(array) else 0


def _is_missing(array: NDArray[Any]) -> NDArray[np.bool_]:
    """The boxes of which a coordinate is missing."""
    if array.dtype.kind == "f":
        find: Any = np.isnan
    elif array.dtype.kind in "mM":
        find = np.isnat
    else:
        return np.zeros(len(array), bool)
    missing = np.zeros(len(array), bool)
    for column in array.T:
        missing |= find(column)
    return missing


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


def _comparable(arrays: list[NDArray[Any]], names: list[str]) -> list[NDArray[Any]]:
    """Coordinates of one type: times, integers if floating point would round them, or floating point."""
    kinds = {array.dtype.kind for array in arrays}
    if kinds <= {"m"} or kinds <= {"M"}:
        return arrays
    if kinds <= {"i", "u"} and any(_is_rounded(array) for array in arrays):
        is_mixed = any(array.dtype.kind == "u" for array in arrays) and len({array.dtype for array in arrays}) > 1
        # No integer type of NumPy holds both signed and unsigned ones.
        return [array.astype(object) for array in arrays] if is_mixed else arrays
    rows = [numbers(array, name) for array, name in zip(arrays, names)]
    # If one set is in double precision, both are compared so.
    return [array.astype(np.result_type(*rows), copy=False) for array in rows]


def _ranks(arrays: list[NDArray[Any]]) -> list[Floats]:
    """The ranks of coordinates among all of their axis, which are in the same order and exact in floating point."""
    half, ends = arrays[0].shape[1] // 2, np.cumsum([len(array) for array in arrays])[:-1]
    every = np.concatenate(arrays)
    ranks = np.empty(every.shape)
    for axis in range(half):
        both = every[:, [axis, axis + half]]
        ranks[:, [axis, axis + half]] = np.unique(both, return_inverse=True)[1].reshape(both.shape)
    return list(np.split(ranks, ends))


def _extended(boxes: NDArray[Any], margin: object) -> NDArray[Any]:
    """Boxes whose max corners are moved by a margin, one for all axes or one for each."""
    half, kind = boxes.shape[1] // 2, boxes.dtype.kind
    if kind in "mM":
        add = np.asarray(margin.to_timedelta64() if hasattr(margin, "to_timedelta64") else margin)
        if add.dtype.kind == "O" and add.shape == () and isinstance(margin, timedelta):
            add = np.asarray(np.timedelta64(margin))
        if add.dtype.kind != "m":
            raise TypeError(f"margin must be a timedelta for times, not {margin!r}")
        least: Any = np.zeros((), add.dtype)
    else:
        add = as_array(margin, "margin")
        if add.dtype.kind not in "iuf":
            raise TypeError(f"margin must be a number, not {margin!r}")
        least = 0
        if kind != "f" and not (np.asarray(add) == np.floor(add)).all():
            raise ValueError(f"margin is {margin}; it must be a whole number for integers beyond 2^53")
    if add.shape not in ((), (half,)):
        raise ValueError(f"margin must be a number or {half} of them, one for each axis, not of shape {add.shape}")
    if not (add >= least).all() or (add.dtype.kind == "f" and np.isinf(add).any()):
        raise ValueError(f"margin is {margin}; it must be finite and 0 or more")
    ends: Any = boxes[:, half:]
    if kind == "f":
        with np.errstate(over="ignore"):
            ends = ends + add.astype(boxes.dtype)
    elif kind in "mM":
        try:
            ends = ends + add
            is_too_large = bool((ends < boxes[:, half:]).any())
        except OverflowError:  # NumPy 2.5 and later; earlier ones wrap around
            is_too_large = True
        if is_too_large:
            raise ValueError(f"margin is {margin}; it must be so small that the ends of the boxes are times of NumPy")
    else:
        # Python's integers do not overflow.
        ends = ends.astype(object) + np.array([int(one) for one in np.broadcast_to(add, half)], object)
        return np.hstack([boxes[:, :half].astype(object), ends])
    return np.hstack([boxes[:, :half], ends])


def _is_rounded(array: NDArray[Any]) -> bool:
    most = 2**53
    return array.dtype.itemsize == 8 and array.size > 0 and bool(array.max() > most or array.min() < -most)


def _sides(array: NDArray[Any]) -> Iterator[tuple[NDArray[Any], NDArray[Any]]]:
    """The min and the max coordinates of each axis. (For rows of one or two numbers, NumPy takes much more time.)"""
    half = array.shape[1] // 2
    return ((array[:, axis], array[:, axis + half]) for axis in range(half))


def _is_empty(array: NDArray[Any]) -> NDArray[np.bool_]:
    """The boxes that end where they begin, on some axis."""
    empty = np.zeros(len(array), bool)
    for low, high in _sides(array):
        empty |= low == high
    return empty


def refuse_inverted(array: NDArray[Any], name: str, kept: Rows) -> None:
    if all(bool((low <= high).all()) for low, high in _sides(array)):
        return
    half = array.shape[1] // 2
    invalid = ~np.asarray(array[:, :half] <= array[:, half:], bool)
    index = int(np.argmax(invalid.any(axis=1)))
    axis = int(np.argmax(invalid[index]))
    low, high = array[index, axis], array[index, axis + half]
    raise InvalidBoxError(index if kept is None else int(kept[index]), axis, name, low, high)


def _without_ends(boxes: Floats, are_whole: bool) -> Floats:
    """Boxes whose max corners are the next smaller numbers: boxes that touched do not overlap then.

    Among whole numbers these are the next smaller whole ones, which takes a fifth of the time.
    """
    if are_whole:  # they were integers, so this is a copy
        for _, high in _sides(boxes):
            high -= 1
        return boxes
    shrunk = boxes.copy()
    with np.errstate(all="ignore"):
        for _, high in _sides(shrunk):
            np.nextafter(high, boxes.dtype.type(-np.inf), out=high)
    return shrunk


def _groups(by: list[ArrayLike], sets: dict[str, Any], counts: list[int], kept: list[Rows]) -> list[NDArray[np.int64]]:
    """A number for the group of each box that is kept."""
    named = [
        named_column(sets[name], values, name) if isinstance(values, str) else values for name, values in zip(sets, by)
    ]
    columns = [as_array(values, "by") for values in named]
    for column, name, count in zip(columns, sets, counts):
        if column.shape != (count,):
            raise ValueError(f"by must have one value for each box of {name}: shape ({count},), not {column.shape}")
    codes = _codes(columns)
    split = np.split(codes, np.cumsum([len(column) for column in columns])[:-1])
    return [group if rows is None else group[rows] for group, rows in zip(split, kept)]


def _codes(columns: list[NDArray[Any]]) -> NDArray[np.int64]:
    """A number for each value, the same for equal ones."""
    kinds = {column.dtype.kind for column in columns}
    if kinds <= set("biuf") or (len(kinds) == 1 and kinds <= set("mM")):
        return np.unique(np.concatenate(columns), return_inverse=True)[1].reshape(-1).astype(np.int64)
    # Text and other objects: looking them up is several times faster than sorting them, and they need no order.
    values = [
        value if type(value) is not float or value == value else None for column in columns for value in column.tolist()
    ]
    known: dict[Any, int] = {}
    try:
        return np.fromiter((known.setdefault(value, len(known)) for value in values), np.int64, len(values))
    except TypeError:
        raise TypeError("by must have values that can be compared, such as numbers or text") from None
