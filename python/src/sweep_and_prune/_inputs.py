"""Recognizes the forms in which users have boxes: arrays, data frames, geometries, tensors."""

from __future__ import annotations

import re
import sys
import warnings
from typing import Any

import numpy as np
from numpy.typing import NDArray

_AXES = "xyz"
_FORMATS = ("xyxy", "xywh", "cxcywh")


def _spellings(format: str) -> list[tuple[list[str], list[str]]]:
    """The names of columns for the first and for the second half of a row, in the order in which they are tried."""
    if format == "xyxy":
        found = [
            ([pattern.format(axis) for axis in _AXES], [other.format(axis) for axis in _AXES])
            for pattern, other in (("min{}", "max{}"), ("{}min", "{}max"), ("{}1", "{}2"), ("{}0", "{}1"))
        ]
        found += [(["left", "top"], ["right", "bottom"]), (["west", "south"], ["east", "north"])]
        return [*found, (["start"], ["end"]), (["chromstart"], ["chromend"])]
    sizes = (["w", "h", "d"], ["width", "height", "depth"])
    starts = (["x", "y", "z"], ["left", "top"]) if format == "xywh" else (["cx", "cy", "cz"], ["x", "y", "z"])
    return [(start, size) for start in starts for size in sizes]


def checked_format(format: object) -> str:
    """The name of a format of boxes, or a `ValueError`."""
    if not (isinstance(format, str) and format in _FORMATS):
        raise ValueError(f'format must be "xyxy", "xywh" or "cxcywh", not {format!r}')
    return format


def raw_boxes(values: Any, name: str, format: str = "xyxy") -> NDArray[Any]:
    """Boxes as an array, two-dimensional if they are in a form that is known. Other forms are left to the caller."""
    if type(values) is np.ndarray and values.dtype.kind in "iuf" and values.ndim == 2 and format == "xyxy":
        return values  # the common case, without further questions
    ends = intervals(values)
    if ends is not None:
        return np.column_stack((np.asarray(ends.left), np.asarray(ends.right)))
    if hasattr(values, "collect"):  # polars' LazyFrame and its like
        raise TypeError(f"{name} is a {type(values).__name__}, which has no rows yet: pass what its collect() returns")
    columns = _column_names(values)
    if columns is not None:
        return _corners(_from_columns(values, columns, name, format), format, name)
    if _is_pair_of_arrays(values):
        raise ValueError(
            f"{name} must be one array with a row for each box, not a {type(values).__name__} of two arrays: "
            "pass np.column_stack((starts, ends)) for intervals, np.stack(rows) for rows"
        )
    nested = _from_arrow(values, name, format)
    if nested is not None:
        return _corners(nested, format, name)
    array = as_array(values, name)
    if array.ndim == 0:
        raise TypeError(f"{name} must be an array with a row for each box, not a {type(values).__name__}")
    if array.dtype.kind == "O" and array.ndim == 1:
        array = _from_geometries(array)
    if array.ndim == 3 and array.shape[1] == 2 and 1 <= array.shape[2] <= 3:
        array = array.reshape(len(array), 2 * array.shape[2])  # -1 is not known without boxes
    return _corners(array, format, name)


def intervals(values: Any) -> Any:
    """An `IntervalIndex` or `IntervalArray`, also that of a Series; None for anything else."""
    for found in (values, getattr(values, "array", None)):
        if all(hasattr(type(found), part) for part in ("closed", "left", "right")):
            return found
    return None


def _is_pair_of_arrays(values: Any) -> bool:
    """Whether it is probably all starts and all ends. (A list of two arrays of NumPy is two rows.)"""
    if not (isinstance(values, (tuple, list)) and len(values) == 2):
        return False
    of_column = ("__arrow_c_array__", "__arrow_c_stream__", "iloc")
    are_columns = all(any(hasattr(part, name) for name in of_column) for part in values)
    return are_columns or (isinstance(values, tuple) and all(hasattr(part, "__array__") for part in values))


def as_array(values: Any, name: str) -> NDArray[Any]:
    """Anything array-like as an array. Tensors are detached and brought to the CPU; masked values are refused."""
    if type(values) is np.ndarray:
        return values
    if isinstance(values, np.ma.MaskedArray):
        if np.ma.getmaskarray(values).any():
            if values.dtype.kind != "f":
                raise ValueError(
                    f'{name} has masked values: pass values.astype(float) and missing="skip", or drop them'
                )
            return np.asarray(values.filled(np.nan))
        return values.data
    if hasattr(values, "detach") and hasattr(values, "cpu"):
        values = values.detach().cpu()
    elif hasattr(values, "__dlpack__") and not hasattr(values, "__array__") and hasattr(np, "from_dlpack"):
        return np.from_dlpack(values)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # NumPy up to 1.23 only warns of rows of different lengths
            return np.asarray(values)
    except Warning as warning:
        raise ValueError(f"{name} must be an array: {warning}") from None


def _column_names(values: Any) -> list[str] | None:
    """The names of the columns of a data frame or a table; None for anything else."""
    if hasattr(type(values), "total_bounds") and hasattr(type(values), "bounds"):  # GeoSeries, GeoDataFrame
        return ["minx", "miny", "maxx", "maxy"]
    if isinstance(values, np.ndarray):
        return None if values.dtype.names is None else list(values.dtype.names)
    if isinstance(values, dict):
        return [*map(str, values)]
    if isinstance(values, (list, tuple)):
        return None
    for attribute in ("column_names", "columns"):  # pyarrow; pandas, polars
        names = getattr(values, attribute, None)
        if names is not None and not callable(names) and hasattr(values, "__getitem__"):
            try:
                return [str(column) for column in names]
            except TypeError:
                return None
    return None


def named_column(values: Any, column: str, name: str) -> Any:
    """A column of a data frame, a table, a dict or a structured array."""
    is_geometric = hasattr(type(values), "total_bounds")  # its own columns count, not those of its bounds
    columns = list(getattr(values, "columns", ())) if is_geometric else _column_names(values)
    if column not in (columns or ()):
        own = f"the columns of {name} are {', '.join(map(str, columns))}" if columns else f"{name} has no named columns"
        raise ValueError(f"by is {column!r}, but {own}")
    return values[column]


def _from_arrow(values: Any, name: str, format: str) -> NDArray[Any] | None:
    """Boxes of an Arrow array of lists of fixed size or of structs; None for anything else."""
    if not (hasattr(values, "__arrow_c_array__") or hasattr(values, "__arrow_c_stream__")):
        return None
    try:
        import pyarrow
    except ImportError:
        return None
    try:
        array = pyarrow.array(values) if hasattr(values, "__arrow_c_array__") else pyarrow.chunked_array(values)
    except pyarrow.ArrowException:  # such as a Series of objects
        return None
    if isinstance(array, pyarrow.ChunkedArray):
        array = array.combine_chunks()
        if isinstance(array, pyarrow.ChunkedArray):  # of no chunks
            array = pyarrow.concat_arrays([*array.chunks, pyarrow.array([], array.type)])
    if isinstance(array, pyarrow.ExtensionArray):  # such as geoarrow.box
        array = array.storage
    if pyarrow.types.is_struct(array.type):
        fields = [field.name for field in array.type]
        return _from_columns(dict(zip(fields, array.flatten())), fields, name, format)
    if not pyarrow.types.is_fixed_size_list(array.type):
        return None
    width = array.type.list_size
    flat = array.values.slice(array.offset * width, len(array) * width).to_numpy(zero_copy_only=False)
    rows: NDArray[Any] = flat.reshape(len(array), width)
    if array.null_count:
        rows = rows.astype(np.float64 if rows.dtype.kind != "f" else rows.dtype)
        _refuse_rounding(rows, str(array.type.value_type), name)
        rows[array.is_null().to_numpy(zero_copy_only=False)] = np.nan
    return rows


def box_columns(columns: list[str], format: str) -> list[str]:
    """The columns that are recognized as boxes: min corner and then max corner, or one column of nested boxes."""
    known = {column.lower().replace("_", ""): column for column in columns}
    for first, second in _spellings(format):
        ends = [(part in known) + (other in known) for part, other in zip(first, second)]
        count = ends.count(2)
        if count and ends == [2] * count + [0] * (len(ends) - count):  # no axis has one end only
            return [known[part] for part in first[:count] + second[:count]]
    return [known["bbox"]] if "bbox" in known and len(columns) > 1 else []  # as in GeoParquet


def unknown_columns(columns: list[str], otherwise: str, option: str = 'format="{}"') -> str:
    """What to do about columns that are not recognized: another format if they are known there."""
    formats = [format for format in _FORMATS if len(box_columns(columns, format)) > 1]
    return f"pass {option.format(formats[0])}" if formats else otherwise


def _from_columns(values: Any, columns: list[str], name: str, format: str) -> NDArray[Any]:
    if hasattr(type(values), "total_bounds"):  # asked of the class: the frame would compute them
        values = values.bounds
        if isinstance(values, np.ndarray):  # those of an array of geometries
            return values
    names = box_columns(columns, format)
    if len(names) > 1:
        table = np.column_stack([_column(values[column], column) for column in names])
        if format == "xyxy" and len(names) == 4 and names[1].lower() == "top":  # the y axis may point up or down
            table[:, [1, 3]] = np.sort(table[:, [1, 3]], axis=1)
        return table
    if names:
        nested = _from_arrow(values[names[0]], name, format)
        if nested is not None:
            return nested
    wanted = {"xyxy": "minx, miny, maxx, maxy", "xywh": "x, y, w, h", "cxcywh": "cx, cy, w, h"}[format]
    raise ValueError(
        f"{name} has no columns that are known as boxes, such as {wanted}: its columns are {', '.join(columns)}; "
        + unknown_columns(columns, "rename them, or pass an array")
    )


def _column(values: Any, column: str) -> NDArray[Any]:
    array: NDArray[Any] = np.asarray(values)
    _refuse_rounding(array, str(getattr(values, "dtype", getattr(values, "type", ""))), f"column {column}")
    if array.dtype.kind == "O":  # nullable integers of pandas
        if any(isinstance(value, str) for value in array.tolist()):
            raise TypeError(f"column {column} must have numbers, not text")
        if hasattr(values, "to_numpy"):
            try:
                return np.asarray(values.to_numpy(dtype=np.float64, na_value=np.nan))
            except TypeError:
                pass
        return np.array([np.nan if value is None else value for value in array.tolist()], np.float64)
    return array


def _refuse_rounding(array: NDArray[Any], dtype: str, what: str) -> None:
    """Refuses integers that floating point has rounded or will round, since values are missing among them."""
    if array.dtype.kind == "O":
        greatest: float = max((abs(value) for value in array.tolist() if isinstance(value, int)), default=0)
    elif array.dtype.kind == "f" and re.match(r"u?int\d", dtype.lower()) and array.size:
        greatest = np.abs(array).max(initial=0, where=~np.isnan(array))
    else:
        return
    if greatest > 2**53:
        raise ValueError(
            f"{what} has integers beyond 2^53, which floating point rounds: pass int64 without missing values"
        )


def _from_geometries(array: NDArray[Any]) -> NDArray[Any]:
    """The bounds of geometries of shapely; those that are empty or None have bounds of NaN."""
    shapely = sys.modules.get("shapely")
    if shapely is None or not hasattr(shapely, "bounds"):
        return array
    are_geometries = shapely.is_geometry(array) | np.array([item is None for item in array], bool)
    return np.asarray(shapely.bounds(array)) if are_geometries.all() and len(array) else array


def _corners(array: NDArray[Any], format: str, name: str) -> NDArray[Any]:
    if format == "xyxy" or array.ndim != 2 or array.shape[1] % 2:
        return array
    if array.dtype.kind not in "iuf":
        raise TypeError(f"{name} must be numbers, not of dtype {array.dtype}")
    if array.dtype.kind != "f":
        array = array.astype(np.float64)
    half = array.shape[1] // 2
    start, size = array[:, :half], array[:, half:]
    low = start if format == "xywh" else start - size / 2
    return np.hstack([low, low + size])
