"""Brings one or two sets of boxes into the form that is searched: open ends, margins, missing values, groups and
integers beyond 2^53 become plain boxes in floating point that have exactly the wanted pairs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from ._arrays import Floats, checked_closed, numbers, read_boxes, same_width
from ._columns import (
    EXACT,
    Column,
    as_array,
    exact_numbers,
    group_codes,
    in_double,
    in_one_unit,
    in_simple_unit,
    is_rounded,
    one_type,
    read_column,
    read_groups,
)
from ._crs import difference
from ._errors import InvalidBoxError
from ._inputs import Raw, checked_format, crs_of, every_column, has_columns, named_column, with_rows
from ._native import take_ends
from ._wrap import (
    checked_wrap,
    cut,
    first_rows,
    in_one_turn,
    is_repeated,
    precise_enough,
    refuse_infinite,
    without_crossings,
)

NAME = (str, int, np.integer)
"""The types of what `by` may name a column with. (Those of a table without a header have numbers in pandas.)"""

_BLOCK = 2**18
"""How many pairs are translated at once: a second array of all of them would take as much memory as the result."""

Rows = Optional[NDArray[np.int64]]


class Whole(NamedTuple):
    """How the compiled part converts integers while it copies them."""

    take_ends: bool
    """Whether max corners become the next smaller whole numbers, so that boxes that touched do not overlap."""
    in_floats: Callable[[], Prepared]
    """Prepares what is searched instead if numbers may be rounded, or boxes have no length and lose their ends."""


class Prepared(NamedTuple):
    """Boxes to search, and how their pairs are translated back."""

    sets: list[NDArray[Any]]
    """In floating point, or as the user passed them if they are `whole`."""
    kept: list[Rows]
    """The row of each box in what the user passed; None if no row was left out."""
    lengths: list[int]
    """How many boxes the user passed in each set."""
    groups: list[NDArray[Any]] | None = None
    """Groups that have to be compared after the search, because there is no axis left for them."""
    crossing: list[NDArray[np.int64]] | None = None
    """On a circle: the boxes of each set that cross its end. Their second parts follow all boxes of `sets`."""
    whole: Whole | None = None
    """How integers become floating point, if `sets` has them."""

    def in_floats(self) -> Prepared:
        """The same with `sets` that are in floating point."""
        return self if self.whole is None else self.whole.in_floats()

    @property
    def is_filtered(self) -> bool:
        """Whether some pairs that are found are none of those that are wanted."""
        return self.groups is not None or self.crossing is not None

    @property
    def is_translated(self) -> bool:
        """Whether pairs that are found are not yet those that the user wants."""
        return self.is_filtered or any(rows is not None for rows in self.kept)

    def translate(self, pairs: NDArray[Any]) -> NDArray[Any]:
        """The pairs in rows of what the user passed, in the memory of `pairs`, which is written to and shortened."""
        if self.is_translated:
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
            if self.crossing is not None:
                block = self._of_boxes(block, self.crossing)
            into = pairs[left : left + len(block)]
            for column, rows in enumerate((self.kept[0], self.kept[-1])):
                into[:, column] = block[:, column] if rows is None else rows[block[:, column]]
            left += len(block)
        return left

    def _of_boxes(self, pairs: NDArray[Any], crossing: list[NDArray[np.int64]]) -> NDArray[Any]:
        """The pairs of boxes, once each, of pairs of boxes or of their second parts."""
        pairs = pairs[~is_repeated(pairs, self.sets, crossing)]
        sides = zip(pairs.T, (self.sets[0], self.sets[-1]), (crossing[0], crossing[-1]))
        pairs = np.stack([first_rows(rows, boxes, of_set) for rows, boxes, of_set in sides], axis=1)
        if len(self.sets) == 1:
            pairs.sort(axis=1)
        return pairs


def prepare(
    sets: dict[str, Any],
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    by: list[Any] | None = None,
    margin: object = 0,
    wrap: object = None,
    fold: bool = False,
) -> Prepared:
    """Brings sets of boxes, by the names of their arguments, into the form that is searched.

    With `fold`, whole intervals in groups may stay intervals: those of each group are moved to a place of their own.
    And integers may stay as they are passed: see `Prepared.whole`.
    """
    checked_format(format)
    if not (isinstance(missing, str) and missing in ("raise", "skip")):
        raise ValueError(f'missing must be "raise" or "skip", not {missing!r}')
    has_margin = not is_zero(margin)
    is_plain = format == "xyxy" and missing == "raise" and by is None and wrap is None and not has_margin
    if is_plain and all(type(boxes) is np.ndarray and boxes.dtype.kind in "iuf" for boxes in sets.values()):
        is_closed = True if closed is None else checked_closed(closed)
        plain = _plain(sets)
        if plain is not None:  # the common case, quickly
            are_kept = fold and plain[0].dtype.kind != "f"
            whole = Whole(not is_closed, partial(prepare, sets, closed=closed)) if are_kept else None
            rows = plain if are_kept else _plain_rows(plain, is_closed)
            if rows is not None:
                return Prepared(rows, [None for _ in rows], [*map(len, rows)], whole=whole)
    sets = {name: with_rows(boxes) for name, boxes in sets.items()}
    is_closed = checked_closed(closed, *sets.values())
    names = list(sets)
    raw = [read_boxes(values, name, 0, format) for name, values in sets.items()]
    arrays = one_kind(raw, names)
    lengths = [*map(len, arrays)]
    if len(arrays) == 2:
        _refuse_other_coordinates(*sets.values())
        arrays = list(same_width(*arrays))
    of_group = None if by is None else _groups(by, sets, lengths)
    kept: list[Rows] = [None for _ in arrays]
    if missing == "skip":
        arrays, kept = _leave_out([is_missing(array) for array in arrays], arrays, kept)
    if has_margin and not any(map(len, arrays)) and _is_duration(margin):
        arrays = [array.astype("m8[s]") for array in arrays]  # nothing else tells that these would be times
    for one, array, name, own in zip(raw, arrays, names, kept):
        if one.are_sized:  # here, since a box whose max is less than its min is one that crosses the end of a circle
            refuse_inverted(array, name, own, is_size=True)
    are_grouped = of_group is None or all(bool((group >= 0).all()) for group in of_group)
    are_whole = all(array.dtype.kind in "iu" for array in arrays) and not has_margin
    are_times = arrays[0].dtype.kind in "mM"
    if not are_times:
        arrays = _comparable(arrays, names)
    is_float = arrays[0].dtype.kind == "f"
    if wrap is not None:
        return _on_circle(arrays, names, kept, lengths, of_group, is_closed, margin, checked_wrap(wrap))
    is_all = all(rows is None for rows in kept) and are_grouped
    # Most often, all intervals have a length: then none is inverted or empty.
    with np.errstate(all="ignore"):
        have_length = not is_closed and all(bool((low < high).all()) for array in arrays for low, high in _sides(array))
    are_as_passed = is_float and is_closed and is_all and not has_margin and not (fold and by is not None)
    if not (have_length or are_as_passed):
        # The compiled part would not see these boxes, or not by these indices, or with other coordinates.
        for array, name, own in zip(arrays, names, kept):
            refuse_inverted(array, name, own)
    if not (is_closed or have_length):
        # An interval without its ends that begins where it ends is empty, and overlaps nothing.
        arrays, kept = _leave_out([_is_empty(array) for array in arrays], arrays, kept)
    if of_group is not None and not are_grouped:
        # A box without a group pairs with none.
        lost = [(group if own is None else group[own]) < 0 for group, own in zip(of_group, kept)]
        arrays, kept = _leave_out(lost, arrays, kept)
    if has_margin:
        # Two boxes are within a margin if neither begins more than the margin after the other's end.
        arrays = _extended(arrays, margin)
    elif are_times:
        arrays = _counts(in_one_unit(arrays))
    rows = arrays if is_float else _ranks(arrays)
    are_whole |= not is_float
    if not is_closed:
        rows = [_without_ends(array, are_whole) for array in rows]
    return _grouped(Prepared(rows, kept, lengths), of_group, fold and are_whole)


def _plain(sets: dict[str, NDArray[Any]]) -> list[NDArray[Any]] | None:
    """Boxes of which all are integers, or all floating point; None for others."""
    arrays = [read_boxes(boxes, name).array for name, boxes in sets.items()]
    if len(arrays) == 2:
        arrays = list(same_width(*arrays))
    kinds = {array.dtype.kind for array in arrays}
    return arrays if kinds <= {"i", "u"} or kinds == {"f"} else None


def _plain_rows(arrays: list[NDArray[Any]], is_closed: bool) -> list[Floats] | None:
    """Boxes that need no change but open ends; None if there may be one that is not valid, empty or not exact."""
    are_whole = arrays[0].dtype.kind != "f"
    if are_whole and not is_closed:
        copies: list[Floats] = [array.astype(np.float64, order="C") for array in arrays]
        return copies if all(map(take_ends, copies)) else None
    if any(map(is_rounded, arrays)):
        return None
    # (The search itself refuses what is not valid, but does not see what is moved.)
    if not is_closed and not all(bool((low < high).all()) for array in arrays for low, high in _sides(array)):
        return None
    rows = [numbers(array, "boxes") for array in arrays]
    if len(rows) == 2 and rows[0].dtype != rows[1].dtype:  # both are compared in double precision
        rows = [array.astype(np.float64, copy=False) for array in rows]
    return rows if is_closed else [_without_ends(array, are_whole=False) for array in rows]


def _grouped(prepared: Prepared, of_group: list[NDArray[np.int64]] | None, fold: bool = False) -> Prepared:
    """Boxes of which only those of one group pair: it is one more axis, if there is one left."""
    if of_group is None:
        return prepared
    rows = prepared.sets
    groups = [group if own is None else group[own] for group, own in zip(of_group, prepared.kept)]
    if prepared.crossing is not None:
        groups = [np.concatenate([group, group[second]]) for group, second in zip(groups, prepared.crossing)]
    if fold and rows[0].shape[1] == 2:
        least, most = min(map(_least, rows)), max(map(_most, rows))
        step = most - least + 2
        if abs(least) + step * (max(map(_most, groups)) + 1) < EXACT:
            for boxes, group in zip(rows, groups):  # copies, of integers or of ranks
                boxes += (group * step)[:, None]
            return prepared
    if rows[0].shape[1] < 6:
        dtype = np.result_type(*rows)
        dtype = np.dtype(np.float64) if max(map(_most, groups)) >= 2**24 else dtype
        rows = [_with_axis(boxes, group.astype(dtype)[:, None]) for boxes, group in zip(rows, groups)]
        return prepared._replace(sets=rows)
    return prepared._replace(groups=groups)


def _on_circle(
    arrays: list[NDArray[Any]],
    names: list[str],
    kept: list[Rows],
    lengths: list[int],
    of_group: list[NDArray[np.int64]] | None,
    is_closed: bool,
    margin: object,
    wrap: float,
) -> Prepared:
    """Boxes whose first axis is a circle, as boxes on lines."""
    if arrays[0].dtype.kind != "f":
        raise TypeError("wrap is for numbers that floating point holds, not for times and integers beyond 2^53")
    boxes = [precise_enough(array, wrap) for array in arrays]
    boxes = [array.astype(np.result_type(*boxes), copy=False) for array in boxes]
    for array, name, own in zip(boxes, names, kept):
        refuse_inverted(without_crossings(array), name, own)
        refuse_infinite(array, name, own)
    boxes = [in_one_turn(array, wrap) for array in boxes]
    if not is_closed:
        boxes, kept = _leave_out([_is_empty(array) for array in boxes], boxes, kept)
    if of_group is not None:
        lost = [(group if own is None else group[own]) < 0 for group, own in zip(of_group, kept)]
        boxes, kept = _leave_out(lost, boxes, kept)
    extended = boxes if is_zero(margin) else _extended(boxes, margin)
    rows, crossing = [], []
    for array, reaching in zip(boxes, extended):
        half = array.shape[1] // 2
        there = np.hstack([reaching[:, :half], array[:, half : half + 1], reaching[:, half + 1 :]])
        on_line, second = cut(there, reaching[:, half], wrap)
        if not is_closed:
            # A second part without a length has nothing but the end of the circle, which does not belong to it.
            has_length = np.ones(len(on_line), bool)
            has_length[len(array) :] = on_line[len(array) :, 0] < on_line[len(array) :, half]
            on_line, second = _without_ends(on_line[has_length], False), second[has_length[len(array) :]]
        rows.append(on_line)
        crossing.append(second)
    return _grouped(Prepared(rows, kept, lengths, None, crossing), of_group)


def is_zero(margin: object) -> bool:
    """Whether there is no margin, which is so for times, too."""
    return type(margin) in (int, float) and margin == 0


def _with_axis(boxes: Floats, code: Any) -> Floats:
    half = boxes.shape[1] // 2
    extended: Floats = np.hstack([boxes[:, :half], code, boxes[:, half:], code])
    return extended


def _least(array: NDArray[Any]) -> int:
    return int(array.min()) if len(array) else 0


def _most(array: NDArray[Any]) -> int:
    return int(array.max()) if len(array) else 0


def is_missing(array: NDArray[Any]) -> NDArray[np.bool_]:
    """The boxes of which a coordinate is missing."""
    missing = np.zeros(len(array), bool)
    if array.dtype.kind not in "iu":
        for column in array.T:
            missing |= np.asarray(column != column, bool)  # so are NaN and NaT
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


def one_kind(raw: list[Raw], names: list[str]) -> list[NDArray[Any]]:
    """Boxes whose coordinates can be compared: all of them numbers, durations, or times with or without a zone."""
    are_one = len({kind_of_boxes(one) for one in raw}) == 1
    has_values = [bool(len(one.array)) if are_one else _has_value(one.array) for one in raw]
    filled = [one for one, has in zip(raw, has_values) if has]
    for one, name in zip(raw, names):
        if one.array.dtype.kind not in "iufOmM":
            raise TypeError(f"{name} must be numbers, not of dtype {one.array.dtype}")
    if len({kind_of_boxes(one) for one in filled}) > 1:
        first, second = map(kind_of_boxes, raw)
        raise TypeError(f"{names[0]} has {first} and {names[1]} has {second}, which do not compare: convert one")
    # The type of a set without values does not matter.
    dtype = filled[0].array.dtype if filled else np.dtype(np.float64)
    arrays = [one.array if has else _nothing(one.array.shape, dtype) for one, has in zip(raw, has_values)]
    return [in_simple_unit(one, name) for one, name in zip(arrays, names)] if dtype.kind in "mM" else arrays


def _nothing(shape: tuple[int, ...], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Boxes of which all coordinates are missing."""
    if dtype.kind in "mM":
        return np.full(shape, "NaT", dtype)
    return np.full(shape, np.nan, dtype if dtype.kind not in "iu" or shape[0] == 0 else np.float64)


def _has_value(array: NDArray[Any]) -> bool:
    """Whether something is neither NaN nor NaT."""
    return bool((array == array).any())


def kind_of_boxes(raw: Raw) -> str:
    kind = {"M": "times", "m": "durations"}.get(raw.array.dtype.kind, "numbers")
    return f"{kind} with a time zone" if raw.is_zoned else kind


def _refuse_other_coordinates(a: Any, b: Any) -> None:
    """Refuses geometries of which each set has a coordinate reference system of its own."""
    apart = difference(crs_of(a), crs_of(b))
    if apart is not None:
        raise ValueError(
            f"a and b have different coordinate reference systems, {apart[0]} and {apart[1]}: pass b.to_crs(a.crs)"
        )


def _comparable(arrays: list[NDArray[Any]], names: list[str]) -> list[NDArray[Any]]:
    """Coordinates of one type: floating point, or exact numbers if floating point would round them."""
    if any(array.dtype.kind == "O" or is_rounded(array) for array in arrays):
        return one_type(arrays)
    rows = [numbers(array, name) for array, name in zip(arrays, names)]
    # If one set is in double precision, both are compared so.
    return [array.astype(np.result_type(*rows), copy=False) for array in rows]


def _counts(times: list[NDArray[Any]]) -> list[NDArray[Any]]:
    """Times as integers, in the unit that they have."""
    return [array if array.dtype.kind == "O" else array.astype(np.int64) for array in times]


def _ranks(arrays: list[NDArray[Any]]) -> list[Floats]:
    """The ranks of coordinates among all of their axis, which are in the same order and exact in floating point."""
    half, ends = arrays[0].shape[1] // 2, np.cumsum([len(array) for array in arrays])[:-1]
    every = np.concatenate(arrays)
    ranks = np.empty(every.shape)
    for axis in range(half):
        both = every[:, [axis, axis + half]]
        ranks[:, [axis, axis + half]] = np.unique(both, return_inverse=True)[1].reshape(both.shape)
    return list(np.split(ranks, ends))


def _extended(arrays: list[NDArray[Any]], margin: object) -> list[NDArray[Any]]:
    """Comparable boxes whose max corners are moved by a margin, one for all axes or one for each."""
    half = arrays[0].shape[1] // 2
    if arrays[0].dtype.kind in "mM":
        *arrays, add = _counts(in_one_unit([*arrays, duration(margin)]))
    else:
        add = in_double(exact_numbers(margin, as_array(margin, "margin")), "margin")
        if add.dtype.kind not in "iuf" and not _are_integers(add):
            raise TypeError(f"margin must be a number, not {margin!r}")
        if add.dtype.kind == "O" and arrays[0].dtype.kind == "f":
            try:
                add = add.astype(np.float64)
            except OverflowError:
                raise ValueError(f"margin is {_shortened(margin)}; it must be at most 1.8e308") from None
        add = add.astype(np.float64) if add.dtype.kind == "f" else add
        if add.dtype.kind == "f" and not np.isfinite(add).all():
            raise ValueError(f"margin is {margin}; it must be finite and 0 or more")
        if arrays[0].dtype.kind in "iu" and add.dtype.kind == "f" and not (add == np.floor(add)).all():
            raise ValueError(f"margin is {margin}; it must be a whole number for integers beyond 2^53")
    if add.shape not in ((), (half,)):
        raise ValueError(f"margin must be a number or {half} of them, one for each axis, not of shape {add.shape}")
    if (add < 0).any():
        raise ValueError(f"margin is {margin}; it must be finite and 0 or more")
    return [np.hstack([boxes[:, :half], _sum(boxes[:, half:], add)]) for boxes in arrays]


def _are_integers(array: NDArray[Any]) -> bool:
    """Whether these are integers of Python that no type of NumPy has."""
    return array.dtype.kind == "O" and set(map(type, array.ravel().tolist())) == {int}


def _shortened(value: object) -> str:
    # Python refuses to write integers with more than some thousand digits.
    text = f"an integer of {value.bit_length()} bits" if isinstance(value, int) else repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _is_duration(margin: object) -> bool:
    column = read_column([margin] if np.ndim(margin) == 0 else margin, "margin")  # type: ignore[arg-type]
    return column.kinds() == {"durations"}


def duration(margin: object) -> NDArray[Any]:
    """A margin for times, or one for each axis."""
    is_single = np.ndim(margin) == 0  # type: ignore[arg-type]
    column = read_column([margin] if is_single else margin, "margin")
    if column.missing is not None:
        raise ValueError(f"margin is {margin}; it must be finite and 0 or more")
    if column.kinds() != {"durations"}:
        raise TypeError(f"margin must be a timedelta for times, not {margin!r}")
    return column.values[0] if is_single else column.values


def _sum(ends: NDArray[Any], add: NDArray[Any]) -> NDArray[Any]:
    """Ends that are moved: rounded once in floating point, exact elsewhere."""
    if ends.dtype.kind == "f":
        with np.errstate(all="ignore"):
            rounded = add.astype(ends.dtype)
            if np.isinf(rounded).any():  # the sum may be finite, or still infinitely low
                return np.asarray((ends.astype(np.float64) + add).astype(ends.dtype))
            return np.asarray(ends + rounded)
    whole = np.broadcast_to(add, ends.shape[1]).tolist()
    if ends.dtype.kind == "O":
        sums = np.empty(ends.shape, object)
        for axis, number in enumerate(map(Fraction, whole)):
            sums[:, axis] = [
                end if end in (math.inf, -math.inf) else Fraction(end) + number for end in ends[:, axis].tolist()
            ]
        return sums
    whole = [int(number) for number in whole]
    most = np.iinfo(ends.dtype).max
    if all(int(column.max(initial=0)) + number <= most for column, number in zip(ends.T, whole)):
        return np.asarray(ends + np.array(whole, ends.dtype))
    return np.asarray(ends.astype(object) + np.array(whole, object))  # Python's integers do not overflow


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


def refuse_inverted(array: NDArray[Any], name: str, kept: Rows, is_size: bool = False) -> None:
    half = array.shape[1] // 2
    with np.errstate(all="ignore"):  # Python's numbers may have a NaN among them
        if all(bool((low <= high).all()) for low, high in _sides(array)):
            return
        invalid = ~np.asarray(array[:, :half] <= array[:, half:], bool)
    index = int(np.argmax(invalid.any(axis=1)))
    axis = int(np.argmax(invalid[index]))
    low, high = array[index, axis], array[index, axis + half]
    is_size = is_size and bool(low > high)  # and not a NaN
    raise InvalidBoxError(index if kept is None else int(kept[index]), axis, name, low, high, is_size)


def _without_ends(boxes: Floats, are_whole: bool) -> Floats:
    """Boxes whose max corners are the next smaller numbers: boxes that touched do not overlap then.

    Among whole numbers these are the next smaller whole ones, which takes a fifth of the time.
    """
    if are_whole:  # they were integers or are ranks, so this is a copy
        for _, high in _sides(boxes):
            high -= 1
        return boxes
    shrunk = boxes.copy()
    with np.errstate(all="ignore"):
        for _, high in _sides(shrunk):
            np.nextafter(high, boxes.dtype.type(-np.inf), out=high)
    return shrunk


def _groups(by: list[Any], sets: dict[str, Any], counts: list[int]) -> list[NDArray[np.int64]]:
    """A number for the group of each box, -1 for none."""
    sides = [
        _group_columns(of_set, boxes, name, count) for of_set, (name, boxes), count in zip(by, sets.items(), counts)
    ]
    if len({len(columns) for columns in sides}) > 1:
        raise ValueError(f"by must have as many columns for a as for b, not {' and '.join(map(str, map(len, sides)))}")
    for columns, name, count in zip(sides, sets, counts):
        for column in columns:
            if column.rows != count:
                has = column.rows
                raise ValueError(f"by must have one value for each box of {name}: shape ({count},), not ({has},)")
    return group_codes(sides, list(sets))


def _are_several(by: Any, count: int) -> bool:
    """Whether these are several keys with a value for each box, and not the values of one."""
    if not isinstance(by, (list, tuple, np.ndarray)) or len(by) in (0, count):
        return False
    return all(hasattr(key, "__len__") and not isinstance(key, (str, bytes)) and len(key) == count for key in by)


def _refuse_another_order(by: Any, boxes: Any, name: str) -> None:
    """Refuses groups whose rows have the labels of the boxes in another order: rows count by position here."""
    own: Any = getattr(boxes, "index", None)
    other: Any = getattr(by, "index", None)
    if not (hasattr(own, "equals") and hasattr(other, "equals")) or len(own) != len(other) or own.equals(other):
        return
    if own.is_unique and own.isin(other).all():
        raise ValueError(f"by has the labels of {name} in another order: pass by.loc[{name}.index], or by.to_numpy()")


def _group_columns(by: Any, boxes: Any, name: str, count: int) -> list[Column]:
    """The columns that make the groups of a set: those that are named, or values for each box."""
    if isinstance(by, NAME):
        return [named_column(boxes, by, name)]
    if isinstance(by, list) and by and all(isinstance(one, Column) for one in by):
        return by  # those of a file, which have been read already
    if isinstance(by, (list, tuple)) and by and all(type(one) is str for one in by) and has_columns(boxes):
        return [named_column(boxes, one, name) for one in by]
    by = with_rows(by)
    _refuse_another_order(by, boxes, name)
    if has_columns(by):
        return every_column(by)
    if _are_several(by, count):
        raise ValueError(
            f"by must have one value for each box of {name}, not several arrays of them: pass a dict or a data frame "
            "of these keys"
        )
    return [read_groups(by, "by")]
