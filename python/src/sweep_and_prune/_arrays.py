"""Checks arguments and converts them to the arrays that the compiled part takes: rows in native byte order, of
`float32` or `float64`. The compiled part copies them, so an array that is right already is passed on as it is."""

from __future__ import annotations

import operator
from collections.abc import Mapping
from typing import Any, Protocol, Union

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._columns import as_array, exact_numbers, in_double
from ._errors import StaleProxyError
from ._inputs import Raw, intervals, is_named, point_rows, raw_boxes


class ArrowData(Protocol):
    """A table of any library that gives its columns to others by Arrow's C interface."""

    def __arrow_c_stream__(self, requested_schema: Any = None) -> Any: ...


Boxes = Union[ArrayLike, Mapping[Any, Any], ArrowData]
"""Boxes in any form that `find_pairs` accepts: an array of rows, a table, a dict of columns, geometries, intervals."""
Points = Union[ArrayLike, Mapping[Any, Any], ArrowData]
"""Points or directions: an array of rows, or a table with the columns `x`, `y` and `z`."""
Floats = Union[NDArray[np.float32], NDArray[np.float64]]
"""Coordinates, in single or in double precision."""
Pairs = NDArray[Any]
"""Indices of boxes, two in each row: `int64`, or another integer type on request."""
Ids = NDArray[np.int64]
"""Ids of bodies."""

_WIDTHS = {2: 1, 4: 2, 6: 3}
_MAX_BOXES = 2**32 - 1
_MAX_THREADS = 1024


def float_dtype(dtype: DTypeLike) -> np.dtype[Any]:
    """`float32` or `float64`, or a `ValueError`."""
    try:
        wanted = np.dtype(dtype)
    except TypeError:
        raise ValueError(f"dtype must be float32 or float64, not {dtype!r}") from None
    if dtype is None or wanted not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype must be float32 or float64, not {dtype!r}")
    return wanted


def index_dtype(dtype: DTypeLike) -> str:
    """The name of the type of indices, or a `ValueError`."""
    if dtype is np.int64:  # by default; to ask NumPy for its name takes a quarter of a search of 100 boxes
        return "int64"
    try:
        name = np.dtype(dtype).newbyteorder("=").name
    except (TypeError, ValueError):
        name = ""
    if dtype is None or name not in ("int64", "int32", "uint32", "uint64"):
        raise ValueError(f"dtype must be int64, int32, uint32 or uint64, not {dtype!r}")
    return name


def checked_closed(closed: object, *sets: Any) -> bool:
    """Whether intervals contain both their ends. An IntervalIndex says so itself, unless the argument is given."""
    if closed is None:
        own = [getattr(intervals(boxes), "closed", "both") for boxes in sets]
        if len(set(own)) > 1:
            raise ValueError(f'one set is closed "{own[0]}" and one "{own[1]}": pass the closed that counts')
        closed = own[0]
    if not (isinstance(closed, str) and closed in ("both", "left", "right", "neither")):
        raise ValueError(f'closed must be "both", "left", "right" or "neither", not {closed!r}')
    return closed == "both"


def thread_count(threads: object) -> int:
    """How many threads to use at most: -1 is one for each processor, and None is one, as in joblib."""
    if threads is None:
        return 1
    if isinstance(threads, (int, np.integer)) and threads == -1:
        return _MAX_THREADS  # the compiled part takes no more than there are processors
    return whole(threads, "threads", 1, _MAX_THREADS, "-1 or ")


def whole(value: object, name: str, least: int, most: int, others: str = "") -> int:
    """A whole number in a range. What else the caller takes is only for the message."""
    try:
        number = operator.index(None if isinstance(value, np.bool_) else value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {_described(value)}") from None
    if not least <= number <= most:
        raise ValueError(f"{name} must be {others}from {least} to {most}, not {number}")
    return number


def real(value: object, name: str) -> float:
    """A number as Python's own `float`."""
    if isinstance(value, (str, bytes)) or (isinstance(value, np.ndarray) and value.ndim > 0):
        raise TypeError(f"{name} must be a number, not {_described(value)}")
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} must be a number, not {_described(value)}") from None


def numbers(values: ArrayLike, name: str, dtype: np.dtype[Any] | None = None) -> Floats:
    """An array of coordinates of any shape: of `dtype`, or else of its own precision."""
    array = in_double(as_array(values, name), name)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers, not of dtype {array.dtype}")
    if dtype is None:
        is_single = array.dtype.kind == "f" and array.dtype.itemsize == 4
        dtype = np.dtype(np.float32 if is_single else np.float64)
    if array.dtype == dtype and array.dtype.isnative:
        return array
    if array.dtype.kind != "f":
        return array.astype(dtype)
    with np.errstate(all="ignore"):  # what is too large for float32 becomes infinite, and what is too small 0
        return array.astype(dtype)


def box_rows(
    boxes: Boxes,
    name: str,
    dtype: np.dtype[Any] | None = None,
    dimensions: int = 0,
) -> Floats:
    """Corners of boxes as rows. Their number of dimensions must be `dimensions`, unless that is 0."""
    array = read_boxes(boxes, name, dimensions, None).array
    if array.dtype.kind == "O":
        array = _rounded(array, name)
    return numbers(array, name, dtype)


def _rounded(array: NDArray[Any], name: str) -> NDArray[np.float64]:
    """Numbers of Python in double precision: they are converted as all others are."""
    try:
        return array.astype(np.float64)
    except OverflowError:
        raise ValueError(f"{name} has numbers that are too large for float64") from None


def read_boxes(boxes: Boxes, name: str, dimensions: int = 0, format: str | None = "xyxy") -> Raw:
    """Boxes as rows, in the type in which they were passed. With the format None, these are corners."""
    raw = raw_boxes(boxes, name, format)
    array = raw.array
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, 2 * (dimensions or 1))
    is_wide = array.ndim == 2 and (_WIDTHS.get(array.shape[1]) in ((dimensions,) if dimensions else (1, 2, 3)))
    if not is_wide:
        wanted = f"(n, {2 * dimensions})" if dimensions else "(n, 2), (n, 4) or (n, 6)"
        raise ValueError(f"{name} must be of shape {wanted}, min corner and then max corner, not {array.shape}")
    if len(array) > _MAX_BOXES:
        raise ValueError(f"{name} are {len(array)} boxes, more than the limit of {_MAX_BOXES}")
    return raw._replace(array=array)


def same_width(first: NDArray[Any], second: NDArray[Any]) -> tuple[NDArray[Any], NDArray[Any]]:
    """Two sets of boxes of the same dimensions."""
    if first.shape[1] != second.shape[1]:
        # The width of an empty set does not matter.
        if len(first) == 0:
            first = first.reshape(0, second.shape[1])
        elif len(second) == 0:
            second = second.reshape(0, first.shape[1])
        else:
            raise ValueError(
                f"a and b must have the same number of columns: they are of shape {first.shape} and {second.shape}"
            )
    return first, second


def row(values: ArrayLike, name: str, dtype: np.dtype[Any], width: int) -> Floats:
    """One box, point or direction, as an array of one row."""
    if is_named(values):
        named: Any = [values]
        return rows(named, name, dtype, width)
    array = _number_array(values, name)
    if array.shape != (width,):
        raise ValueError(f"{name} must be {width} numbers, not of shape {array.shape}")
    return numbers(array[None], name, dtype)


def rows(values: Points, name: str, dtype: np.dtype[Any], width: int) -> Floats:
    """Points or directions as rows."""
    array = _number_array(point_rows(values, name, width), name)
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} must be of shape (n, {width}), not {array.shape}")
    return numbers(array, name, dtype)


def each(values: ArrayLike, name: str, dtype: np.dtype[Any], count: int) -> Floats:
    """A number for each of `count`, or one for all of them."""
    array = _number_array(values, name)
    if array.ndim > 1 or (array.ndim == 1 and len(array) != count):
        raise ValueError(f"{name} must be a number or {count} of them, not of shape {array.shape}")
    return numbers(np.broadcast_to(array, (count,)), name, dtype)


def _number_array(values: Any, name: str) -> NDArray[Any]:
    """Numbers as an array. Lists may have integers that no type of NumPy has."""
    array = as_array(values, name)
    if array.dtype.kind == "O" and isinstance(values, (list, tuple)):
        exact = exact_numbers(values, array)
        return array if exact is array else _rounded(exact, name)
    return array


def one_id(id: object, *, or_none: bool = False) -> Ids:
    """An id as an array of one. With `or_none`, a number that is too large for an id is -1, which is no id."""
    return np.array([_id(id, 0, or_none)], np.int64)


def two_ids(a: object, b: object) -> Ids:
    """Two ids as an array."""
    return np.array([_id(a, 0), _id(b, 1)], np.int64)


def truth(value: object, name: str) -> bool:
    """An argument that is True or False."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} must be True or False, not a {type(value).__name__}")
    return bool(value)


def id_array(ids: ArrayLike, name: str = "ids", *, or_none: bool = False) -> Ids:
    """Ids as an array. With `or_none`, numbers that are too large for an id are -1, which is no id."""
    array = as_array(ids, name)
    if array.ndim != 1:
        raise ValueError(f"{name} must be of shape (n,), not {array.shape}")
    if array.size == 0 and array.dtype.kind == "f":
        return np.empty(0, np.int64)
    if array.dtype.kind in "fO" and isinstance(ids, (list, tuple)):
        # NumPy makes floats or objects of integers of which some are too large for int64.
        array = np.array([_id(id, index, or_none) for index, id in enumerate(ids)], np.int64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be whole numbers, not of dtype {array.dtype}")
    if array.dtype.kind == "u" and array.dtype.itemsize == 8 and (array >= 2**63).any():
        if or_none:
            return np.where(array < 2**63, array.astype(np.int64), -1)
        index = int(np.argmax(array >= 2**63))
        raise StaleProxyError(int(array[index]), index)
    return array.astype(np.int64, copy=False)


def _id(id: object, index: int, or_none: bool = False) -> int:
    if isinstance(id, (bool, np.bool_)):
        raise TypeError(f"an id must be a whole number, not {id!r}")
    try:
        number = operator.index(id)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"an id must be a whole number, not {_described(id)}") from None
    if not -(2**63) <= number < 2**63:
        if or_none:
            return -1
        raise StaleProxyError(number, index)
    return number


def _described(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"a {type(value).__name__}"
