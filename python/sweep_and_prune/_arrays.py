"""From whatever a user passes to the arrays that the compiled part takes: C-contiguous rows, in the machine's
own byte order, of `float32` or `float64`. An array that is so already is not copied."""

from __future__ import annotations

import operator
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._errors import StaleProxyError

Floats = Union[NDArray[np.float32], NDArray[np.float64]]
"""Coordinates, in single or in double precision."""
Pairs = NDArray[np.uint32]
"""Indices of boxes, two in each row."""
Ids = NDArray[np.uint64]
"""Ids of bodies."""

_WIDTHS = {2: 1, 4: 2, 6: 3}
_MOST = 2**32 - 1


def float_dtype(dtype: DTypeLike) -> np.dtype[Any]:
    """`float32` or `float64`, or a `ValueError`."""
    try:
        wanted = np.dtype(dtype)
    except TypeError:
        raise ValueError(f"dtype must be float32 or float64, not {dtype!r}") from None
    if dtype is None or wanted not in (np.dtype(np.float32), np.dtype(np.float64)):
        raise ValueError(f"dtype must be float32 or float64, not {dtype!r}")
    return wanted


def whole(value: object, name: str, least: int, most: int) -> int:
    """A whole number in a range."""
    try:
        number = operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {_said(value)}") from None
    if not least <= number <= most:
        raise ValueError(f"{name} must be from {least} to {most}, not {number}")
    return number


def real(value: object, name: str) -> float:
    """A number as Python's own `float`."""
    if isinstance(value, (str, bytes)):
        raise TypeError(f"{name} must be a number, not {_said(value)}")
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{name} must be a number, not {_said(value)}") from None


def numbers(values: ArrayLike, name: str, dtype: np.dtype[Any] | None = None) -> Floats:
    """An array of coordinates of any shape: of `dtype`, or else of its own precision."""
    array = np.asarray(values)
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers, not of dtype {array.dtype}")
    if dtype is None:
        is_single = array.dtype.kind == "f" and array.dtype.itemsize == 4
        dtype = np.dtype(np.float32 if is_single else np.float64)
    shape = array.shape
    with np.errstate(over="ignore"):  # what is too large for float32 is infinite there
        array = np.ascontiguousarray(array, dtype).reshape(shape)  # a 0-d array stays one
    return array if array.flags.aligned else array.copy()


def box_rows(boxes: ArrayLike, name: str, dtype: np.dtype[Any] | None = None, dimensions: int = 0) -> Floats:
    """Boxes as rows, of so many dimensions unless that is 0."""
    array = np.asarray(boxes)
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, 2 * (dimensions or 1))
    is_wide = array.ndim == 2 and (_WIDTHS.get(array.shape[1]) in ((dimensions,) if dimensions else (1, 2, 3)))
    if not is_wide:
        wanted = f"(n, {2 * dimensions})" if dimensions else "(n, 2), (n, 4) or (n, 6)"
        raise ValueError(f"{name} must be of shape {wanted}, least corner and then greatest, not {array.shape}")
    if len(array) > _MOST:
        raise ValueError(f"{name} are {len(array)} boxes, more than the limit of {_MOST}")
    return numbers(array, name, dtype)


def box_sets(a: ArrayLike, b: ArrayLike) -> tuple[Floats, Floats]:
    """Two sets of boxes of the same dimensions and type; if one is in double precision, both are."""
    first, second = box_rows(a, "a"), box_rows(b, "b")
    if first.shape[1] != second.shape[1]:
        # Of no boxes it does not matter how wide they are.
        if len(first) == 0:
            first = first.reshape(0, second.shape[1])
        elif len(second) == 0:
            second = second.reshape(0, first.shape[1])
        else:
            raise ValueError(f"a and b must be as wide: they are of shape {first.shape} and {second.shape}")
    if first.dtype != second.dtype:
        return first.astype(np.float64, copy=False), second.astype(np.float64, copy=False)
    return first, second


def row(values: ArrayLike, name: str, dtype: np.dtype[Any], width: int) -> Floats:
    """One box, point or direction, as an array of one row."""
    array = np.asarray(values)
    if array.shape != (width,):
        raise ValueError(f"{name} must be {width} numbers, not of shape {array.shape}")
    return numbers(array[None], name, dtype)


def rows(values: ArrayLike, name: str, dtype: np.dtype[Any], width: int) -> Floats:
    """Points or directions as rows."""
    array = np.asarray(values)
    if array.ndim == 1 and array.size == 0:
        array = array.reshape(0, width)
    if array.ndim != 2 or array.shape[1] != width:
        raise ValueError(f"{name} must be of shape (n, {width}), not {array.shape}")
    return numbers(array, name, dtype)


def each(values: ArrayLike, name: str, dtype: np.dtype[Any], count: int) -> Floats:
    """A number for each of `count`, or one for all of them."""
    array = np.asarray(values)
    if array.ndim > 1 or (array.ndim == 1 and len(array) != count):
        raise ValueError(f"{name} must be a number or {count} of them, not of shape {array.shape}")
    return numbers(np.broadcast_to(array, (count,)), name, dtype)


def one_id(id: object) -> Ids:
    """An id as an array of one."""
    return np.array([_id(id, 0)], np.uint64)


def id_array(ids: ArrayLike) -> Ids:
    """Ids as an array."""
    array = np.asarray(ids)
    if array.ndim != 1:
        raise ValueError(f"ids must be of shape (n,), not {array.shape}")
    if array.size == 0 and array.dtype.kind == "f":
        return np.empty(0, np.uint64)
    if array.dtype.kind in "fO" and isinstance(ids, (list, tuple)):
        # NumPy takes whole numbers of which some are below and some above 2^63 for floats, or for objects.
        array = np.array([_id(id, index) for index, id in enumerate(ids)], np.uint64)
    if array.dtype.kind not in "iu":
        raise TypeError(f"ids must be whole numbers, not of dtype {array.dtype}")
    if array.dtype.kind == "i" and (array < 0).any():
        index = int(np.argmax(array < 0))
        raise StaleProxyError(int(array[index]), index)
    array = np.ascontiguousarray(array, np.uint64)
    return array if array.flags.aligned else array.copy()


def _id(id: object, index: int) -> int:
    try:
        number = operator.index(id)  # type: ignore[arg-type]
    except TypeError:
        raise TypeError(f"an id must be a whole number, not {_said(id)}") from None
    if not 0 <= number < 2**64:
        raise StaleProxyError(number, index)
    return number


def _said(value: object) -> str:
    text = repr(value)
    return text if len(text) <= 60 else f"a {type(value).__name__}"
