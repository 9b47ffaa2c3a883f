"""Recognizes the forms in which users have boxes: arrays, data frames, geometries, tensors."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from . import _crs
from ._columns import (
    Column,
    arrow_array,
    as_array,
    exact_numbers,
    in_double,
    is_rounded,
    read_column,
    read_groups,
    side_by_side,
)

_AXES = "xyz"
FORMATS = ("xyxy", "xywh", "cxcywh")
_INTERVALS = [("start", "end"), ("chromstart", "chromend"), ("start", "stop"), ("begin", "end")]
_INTERVALS += [("starttime", "endtime"), ("startdate", "enddate")]
_MOST_LISTED = 20


def _spellings(format: str | None) -> list[tuple[list[str], list[str]]]:
    """The names of columns for the first and for the second half of a row, in the order in which they are tried."""
    if format in (None, "xyxy"):
        found = [
            ([pattern.format(axis) for axis in _AXES], [other.format(axis) for axis in _AXES])
            for pattern, other in (("min{}", "max{}"), ("{}min", "{}max"), ("{}1", "{}2"), ("{}0", "{}1"))
        ]
        found += [(["left", "top"], ["right", "bottom"]), (["west", "south"], ["east", "north"])]
        return [*found, *(([start], [end]) for start, end in _INTERVALS)]
    sizes = (["w", "h", "d"], ["width", "height", "depth"])
    if format == "xywh":
        of_mot = (["bbleft", "bbtop"], ["bbwidth", "bbheight"])
        return [*((start, size) for start in (["x", "y", "z"], ["left", "top"]) for size in sizes), of_mot]
    centers = (["cx", "cy", "cz"], ["xcenter", "ycenter", "zcenter"], ["x", "y", "z"])
    return [(center, size) for center in centers for size in sizes]


def checked_format(format: object) -> str:
    """The name of a format of boxes, or a `ValueError`."""
    if not (isinstance(format, str) and format in FORMATS):
        raise ValueError(f'format must be "xyxy", "xywh" or "cxcywh", not {format!r}')
    return format


def with_rows(values: Any) -> Any:
    """What must be looked at only once, as a table; anything else as it is.

    A stream of Arrow, which has no length, is empty afterwards. Each look at a relation of DuckDB runs its query, which
    may return the rows in another order.
    """
    is_relation = type(values).__module__.split(".")[0] == "duckdb"
    if not hasattr(values, "__arrow_c_stream__") or (hasattr(values, "__len__") and not is_relation):
        return values
    import pyarrow

    return pyarrow.table(values)


class Raw(NamedTuple):
    """Boxes in the type in which the user has them."""

    array: NDArray[Any]
    """Two-dimensional if the form is known; of Python's own numbers if no other type has them exactly."""
    is_zoned: bool = False
    """Whether they are times with a time zone, in UTC here."""
    are_sized: bool = False
    """Whether each was a size and a corner or a center: where the max is less than the min, the size is negative."""


def raw_boxes(values: Any, name: str, format: str | None = "xyxy") -> Raw:
    """Boxes as an array, in one of the `FORMATS`; None is `"xyxy"` where the user cannot choose another.

    Forms that are not known are left to the caller.
    """
    if type(values) is np.ndarray and values.dtype.kind in "iuf" and values.ndim == 2 and format == "xyxy":
        return Raw(in_double(values, name))  # the common case, without further questions
    if isinstance(values, Raw):  # columns of a file, which have been read already
        return _corners(values, format, name)
    raw = _raw_boxes(_by_field(with_rows(values), name), name, format)
    return raw._replace(array=in_double(raw.array, name))


def _raw_boxes(values: Any, name: str, format: str | None) -> Raw:
    ends = intervals(values)
    if ends is not None:
        columns = [read_column(side, name) for side in (ends.left, ends.right)]
        return Raw(*side_by_side(columns, ["left", "right"], name))
    if hasattr(type(values), "collect"):  # polars' LazyFrame and its like, and no frame with a column of this name
        raise TypeError(f"{name} is a {type(values).__name__}, which has no rows yet: pass what its collect() returns")
    names = _column_names(values)
    if names is not None:
        return _corners(_from_columns(values, names, name, format), format, name)
    if _is_pair_of_arrays(values):
        raise ValueError(
            f"{name} must be one array with a row for each box, not a {type(values).__name__} of two arrays: "
            "pass np.column_stack((starts, ends)) for intervals, np.stack(rows) for rows"
        )
    nested = _from_arrow(values, name, format)
    if nested is not None:
        return _corners(nested, format, name)
    if isinstance(values, list) and values and all(isinstance(one, dict) for one in values):
        raise TypeError(f"{name} is a list of dicts: pass a data frame of them, such as pandas.DataFrame({name})")
    if isinstance(values, (list, tuple)) and values and isinstance(values[0], range):  # NumPy reads what is in them
        raise TypeError(f"{name} is a list of ranges: pass [[each.start, each.stop] for each in {name}]")
    array = as_array(values, name)
    if array.dtype.kind in "OS" and array.ndim == 1 and array.size and isinstance(array[0], bytes):
        raise TypeError(f"{name} is bytes, not numbers: for well-known binary (WKB), pass shapely.from_wkb({name})")
    if isinstance(values, (list, tuple)):
        exact = exact_numbers(values, array)
        is_exact, array = exact is not array, exact
    else:
        is_exact = False
    if array.ndim == 0:
        raise TypeError(f"{name} must be an array with a row for each box, not a {type(values).__name__}")
    if array.dtype.kind == "O" and array.ndim == 1:
        if _are_lists(array):
            return raw_boxes(_of_one_length(array), name, format)
        bounds = _from_geometries(array)
        if bounds is not array:
            refuse_sizes(format, name)
        array = bounds
    if array.dtype.kind == "O" and not is_exact and (array.ndim > 1 or array.size == 0):
        raise TypeError(f"{name} must be numbers, not of dtype object: convert them to one type of numbers")
    if array.ndim == 3 and array.shape[1] == 2 and 1 <= array.shape[2] <= 3:
        array = array.reshape(len(array), 2 * array.shape[2])  # -1 is not known without boxes
    return _corners(Raw(array), format, name)


def fields_of(row: Any) -> tuple[str, ...] | None:
    """The names in a named tuple, or in a row of a data frame or of a structured array; None for anything else."""
    names = getattr(row, "_fields", None)
    if isinstance(row, np.void):
        names = row.dtype.names
    elif hasattr(row, "iloc"):
        names = row.index
    return None if names is None else tuple(map(str, names))


def is_named(row: Any) -> bool:
    """Whether one box or point has names, whose order is not that of an array."""
    return type(row) not in (list, tuple, np.ndarray) and fields_of(row) is not None


def _fields_of_rows(rows: Any) -> tuple[str, ...]:
    """The names in the first one of a list of rows; none for anything else."""
    is_list = isinstance(rows, (list, tuple)) and len(rows) > 0
    return (fields_of(rows[0]) if is_list else None) or ()


def _as_columns(rows: Any, fields: tuple[str, ...], name: str) -> dict[str, Any]:
    """Rows that all have these names, as columns."""
    for index, row in enumerate(rows):
        if fields_of(row) != fields:
            raise ValueError(f"{name}[{index}] does not have the fields of {name}[0]: {', '.join(fields)}")
    return dict(zip(fields, zip(*map(tuple, rows))))


def _by_field(rows: Any, name: str) -> Any:
    """Rows whose fields are known as boxes, as columns: their order does not matter. Anything else as it is."""
    fields = () if _is_pair_of_arrays(rows) else _fields_of_rows(rows)
    return _as_columns(rows, fields, name) if any(box_columns(fields, format) for format in FORMATS) else rows


def point_rows(values: Any, name: str, width: int) -> Any:
    """Points or directions in columns or rows with the names x, y and z, by these; anything else as it is."""
    axes, labels, fields = list(_AXES[:width]), _labels(values), _fields_of_rows(values)
    names = [str(one).lower() for one in labels or fields]
    if any(names.count(axis) != 1 for axis in axes):
        if labels:
            raise ValueError(f"{name} must have one column for each of {', '.join(axes)}: {listed(labels)}")
        return values
    columns = values if labels else _as_columns(values, fields, name)
    known = dict(zip(names, labels or fields))
    return side_by_side([read_column(columns[known[axis]], name) for axis in axes], axes, name)[0]


def listed(columns: Sequence[object], whose: str = "") -> str:
    """The names of a table's columns for a message, not all of them if they are many."""
    if len(columns) == 0:
        return f"{whose or 'it'} has no named columns"
    shown = [name if len(name) <= 60 else f"{name[:57]}..." for name in map(str, columns[:_MOST_LISTED])]
    more = f" and {len(columns) - _MOST_LISTED:,} more" if len(columns) > _MOST_LISTED else ""
    return f"{f'the columns of {whose}' if whose else 'its columns'} are {', '.join(shown)}{more}"


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


def _column_names(values: Any) -> list[str] | None:
    """The names of the columns that may have boxes, of a data frame or a table; None for anything else."""
    if hasattr(type(values), "total_bounds") and hasattr(type(values), "bounds"):  # GeoSeries, GeoDataFrame
        return ["minx", "miny", "maxx", "maxy"]
    labels = _labels(values)
    return None if labels is None else [*map(str, labels)]


def _labels(values: Any) -> list[Any] | None:
    """The names of the columns of a data frame or a table, in pandas of any type; None for anything else."""
    if isinstance(values, np.ndarray):
        return None if values.dtype.names is None else list(values.dtype.names)
    if isinstance(values, dict):
        return list(values)
    if isinstance(values, (list, tuple)):
        return None
    # Those of pyarrow; or of pandas and polars. (A column of pandas may have the name `column_names`.)
    names = getattr(values, "column_names" if hasattr(type(values), "column_names") else "columns", None)
    if names is not None and not callable(names) and hasattr(values, "__getitem__"):
        with suppress(TypeError):
            return list(names)
    return None


def has_columns(values: Any) -> bool:
    """Whether it is a data frame, a table, a dict or a structured array, whose columns have names."""
    return bool(_labels(values))


def named_column(values: Any, column: Any, name: str) -> Column:
    """A column of a data frame, a table, a dict or a structured array, which `by` names."""
    columns = _labels(values) or []
    if columns.count(column) != 1:
        fault = f"{name} has several columns of that name: rename or drop one" if column in columns else ""
        raise ValueError(f"by is {column!r}, but {fault or listed(columns, name)}")
    return read_groups(values[column], f"column {column}")


def every_column(values: Any) -> list[Column]:
    """The columns of a data frame, a table, a dict or a structured array, all of which are keys of groups."""
    return [named_column(values, column, "by") for column in _labels(values) or []]


def chosen_boxes(column: Callable[[str], Any], names: Sequence[str], what: str, format: str = "xyxy") -> Raw:
    """The corners of boxes in columns with these names, which a function looks up."""
    read = [read_column(column(name), f"column {name}") for name in names]
    return _corners(Raw(*side_by_side(read, names, what)), format, what)


def _are_lists(array: NDArray[Any]) -> bool:
    """Whether these are lists, as in a column that has a list for each row. Some may be None."""
    kinds = set(map(type, array.tolist())) - {type(None)}
    return bool(kinds) and all(issubclass(kind, (list, tuple, np.ndarray)) for kind in kinds)


def _of_one_length(lists: NDArray[Any]) -> list[list[Any]]:
    """Lists, with as many missing values in place of one that is None."""
    nothing = [None] * max(len(one) for one in lists if one is not None)
    return [nothing if one is None else list(one) for one in lists]


def _from_arrow(values: Any, name: str, format: str | None) -> Raw | None:
    """Boxes of an Arrow array of lists or of structs; None for anything else."""
    array = arrow_array(values)
    if array is None:
        return None
    import pyarrow

    if pyarrow.types.is_struct(array.type):
        fields = [field.name for field in array.type]
        return _from_columns(dict(zip(fields, array.flatten())), fields, name, format)
    if pyarrow.types.is_list(array.type) or pyarrow.types.is_large_list(array.type):
        array = _of_one_size(array, name)
    if not pyarrow.types.is_fixed_size_list(array.type):
        return None
    width = array.type.list_size
    are_points = array.type.value_field.name in ("xy", "xyz", "xym", "xyzm")  # those of GeoArrow
    flat = array.values.slice(array.offset * width, len(array) * width)
    if array.null_count:  # the items of a list that is null are not null themselves
        import pyarrow.compute

        flat = pyarrow.compute.if_else(
            pyarrow.array(np.repeat(array.is_null().to_numpy(zero_copy_only=False), width)), None, flat
        )
    column = read_column(flat, name)
    parts = [
        Column(column.values[axis::width], None if column.missing is None else column.missing[axis::width])
        for axis in range(width)
    ]
    if are_points:
        parts = [*parts[:2], *parts[:2]]
    names = [f"{axis} of {name}" for axis in range(len(parts))]
    return Raw(*side_by_side([part._replace(is_zoned=column.is_zoned) for part in parts], names, name))


def _are_alike(parts: list[str], others: list[str]) -> bool:
    """Whether columns of boxes differ only in their first or in their second half: then the first spelling counts.

    (A frame may have x, y, w, h, and width, height of the image.)
    """
    half = len(parts) // 2
    return len(parts) == len(others) > 2 and (parts[:half] == others[:half] or parts[half:] == others[half:])


def _of_one_size(array: Any, name: str) -> Any:
    """Arrow's lists of any sizes as lists of a fixed size."""
    import pyarrow

    is_there = ~array.is_null().to_numpy(zero_copy_only=False)
    rows, sizes = np.flatnonzero(is_there), np.diff(array.offsets.to_numpy())[is_there]
    size = int(sizes[0]) if len(sizes) else 4
    other = int(np.argmax(sizes != size)) if len(sizes) else 0
    if len(sizes) and sizes[other] != size:
        raise ValueError(f"{name}[{rows[other]}] has {sizes[other]} values, but {name}[{rows[0]}] has {size}")
    lists = pyarrow.FixedSizeListArray.from_arrays(array.flatten(), size)  # which leaves out those that are null
    return lists.take(pyarrow.array(np.cumsum(is_there) - 1, mask=~is_there)) if array.null_count else lists


def box_columns(columns: Sequence[str], format: str | None) -> list[str]:
    """The columns that are recognized as boxes: min corner and then max corner, or one column of nested boxes.

    Raises:
        ValueError: if there are boxes or intervals in other columns, too.
    """
    known: dict[str, list[str]] = {}
    for column in columns:
        known.setdefault(column.lower().replace("_", ""), []).append(column)
    found = []
    for first, second in _spellings(format):
        ends = [(part in known) + (other in known) for part, other in zip(first, second)]
        count = ends.count(2)
        if count and ends == [2] * count + [0] * (len(ends) - count):  # no axis has one end only
            found.append(first[:count] + second[:count])
    if not found:
        return [_only(known["bbox"])] if "bbox" in known else []  # as in GeoParquet
    if len(found[0]) == 2 and "bbox" in known:
        found.append(["bbox"])
    apart = [found[0], *(parts for parts in found[1:] if not _are_alike(parts, found[0]))]
    if len(apart) > 1:
        named = " and ".join(", ".join(known[part][0] for part in parts) for parts in apart)
        raise ValueError(f"the columns {named} are all known as boxes: drop all but those of one, or choose by columns")
    return [_only(known[part]) for part in found[0]]


def _only(names: list[str]) -> str:
    if len(names) > 1:
        raise ValueError(
            f"the columns {' and '.join(names)} are both the same coordinate of the boxes: rename or drop all but one"
        )
    return names[0]


def unknown_columns(columns: list[str], otherwise: str, option: str = 'format="{}"') -> str:
    """What to do about columns that are not recognized: another format if they are known there."""
    formats = [format for format in FORMATS if len(box_columns(columns, format)) > 1]
    return f"pass {option.format(formats[0])}" if formats else otherwise


def _from_columns(values: Any, columns: list[str], name: str, format: str | None) -> Raw:
    if hasattr(type(values), "total_bounds"):  # asked of the class: the frame would compute them
        refuse_sizes(format, name)
        values = values.bounds
        if isinstance(values, np.ndarray):  # those of an array of geometries
            return Raw(values)
    shapes = geometry_column(_schema(values))
    if shapes is not None:
        refuse_sizes(format, name)
        return Raw(bounds_of_geometries(values, shapes))
    names = box_columns(columns, format)
    if len(names) > 1:
        raw = Raw(*side_by_side([read_column(values[column], f"column {column}") for column in names], names, name))
        if (
            format in (None, "xyxy") and len(names) == 4 and names[1].lower() == "top"
        ):  # the y axis may point up or down
            raw.array[:, [1, 3]] = np.sort(raw.array[:, [1, 3]], axis=1)
        return raw
    if names:
        nested = _from_arrow(values[names[0]], name, format)
        if nested is not None:
            return nested
        lists = as_array(values[names[0]], f"column {names[0]}")
        if lists.ndim > 1 or _are_lists(lists):
            return raw_boxes(lists, f"column {names[0]}")
    wanted = {"xywh": "x, y, w, h", "cxcywh": "cx, cy, w, h"}.get(format or "", "minx, miny, maxx, maxy")
    way = unknown_columns(columns, _other_way(values))
    if format is None and way.startswith("pass format"):
        way = "pass min and max corners"
    raise ValueError(f"{name} has no columns that are known as boxes, such as {wanted}: {listed(columns)}; {way}")


def _schema(values: Any) -> Any:
    """The schema of a table or a batch of pyarrow; None for anything else."""
    return getattr(values, "schema", None) if type(values).__module__.split(".")[0] == "pyarrow" else None


def geometry_column(schema: Any) -> str | None:
    """The column of a table of Arrow whose geometries have the boxes as their bounds; None if there is none.

    Geometries count before columns that are known as boxes, as in a `GeoDataFrame`; but the column `bbox` of GeoParquet
    has their bounds already.
    """
    return None if schema is None or "bbox" in schema.names else _geometry_column(schema)


def _geometry_column(schema: Any) -> str | None:
    """The column of geometries that GeoParquet names, or the first one of GeoArrow; None if there is none."""
    column, _ = _crs.of_geoparquet(schema.metadata)
    if column in schema.names:
        return column
    for field in schema:
        extension = (field.metadata or {}).get(b"ARROW:extension:name", b"").decode()
        if (extension or getattr(field.type, "extension_name", "")).startswith("geoarrow."):
            return str(field.name)
    return None


def crs_of(values: Any) -> Any:
    """The coordinate reference system of geometries; None if there are none or it is not known."""
    if hasattr(type(values), "total_bounds"):
        return values.crs
    schema = _schema(values)
    column = None if schema is None else _geometry_column(schema)
    if column is None:
        return None
    named, crs = _crs.of_geoparquet(schema.metadata)
    metadata = schema.field(column).metadata or {}
    return crs if column == named else json.loads(metadata.get(b"ARROW:extension:metadata") or b"{}").get("crs")


def refuse_sizes(format: str | None, name: str) -> None:
    """Refuses boxes with sizes where the boxes are the bounds of geometries."""
    if format not in (None, "xyxy"):
        raise ValueError(f'{name} has geometries, whose bounds are corners: leave out format="{format}"')


def bounds_of_geometries(table: Any, column: str) -> NDArray[Any]:
    """The bounds of geometries in a column of a table or a batch of Arrow; NaN for those that are empty or null."""
    is_binary = _is_binary(table.schema.field(column).type)
    try:
        import shapely

        if not is_binary:
            import geopandas
    except ImportError:
        raise TypeError(
            f"column {column} has geometries, which geopandas reads: pip install 'sweep-and-prune[join]'"
        ) from None
    if not is_binary:
        return np.asarray(geopandas.GeoDataFrame.from_arrow(table.select([column])).geometry.bounds)
    try:
        return np.asarray(shapely.bounds(shapely.from_wkb(np.array(table[column].to_pylist(), object))))
    except shapely.errors.ShapelyError as error:
        raise ValueError(f"column {column} has a geometry that is not valid: {error}") from None


def _is_binary(kind: Any) -> bool:
    return str(kind) in ("binary", "large_binary", "binary_view")


def _other_way(values: Any) -> str:
    """What to do about columns that are not known in any format."""
    for field in _schema(values) or []:
        if _is_binary(field.type):
            return f"if column {field.name} is well-known binary (WKB), pass shapely.from_wkb(table[{field.name!r}])"
    return "rename them, or pass an array"


def _from_geometries(array: NDArray[Any]) -> NDArray[Any]:
    """The bounds of geometries of shapely; those that are empty or None have bounds of NaN."""
    shapely = sys.modules.get("shapely")
    if shapely is None or not hasattr(shapely, "bounds"):
        return array
    are_geometries = shapely.is_geometry(array) | np.array([item is None for item in array], bool)
    return np.asarray(shapely.bounds(array)) if are_geometries.all() and len(array) else array


def _corners(raw: Raw, format: str | None, name: str) -> Raw:
    """The corners of boxes that are given by a size. Integers are added exactly."""
    array = raw.array
    if format in (None, "xyxy") or array.ndim != 2 or array.shape[1] % 2:
        return raw
    if array.dtype.kind not in "iufO":
        raise TypeError(f"{name} must be numbers, not of dtype {array.dtype}")
    half = array.shape[1] // 2
    if format == "xywh" and array.dtype.kind != "f":
        array = array.astype(object if array.dtype.kind == "O" or is_rounded(array) else np.int64)
        low, size = array[:, :half], array[:, half:]
        corners = np.hstack([low, low + size])
        is_exact = corners.dtype.kind == "O" or is_rounded(corners)
        return Raw(corners if is_exact else corners.astype(np.float64), are_sized=True)
    if array.dtype.kind == "O" or is_rounded(array):
        raise ValueError(
            f'{name} has numbers beyond 2^53, whose halves floating point rounds: pass corners instead of "{format}"'
        )
    if array.dtype.kind != "f" or array.dtype.itemsize == 2:  # half precision would round, and overflow
        array = array.astype(np.float64)
    start, size = array[:, :half], array[:, half:]
    with np.errstate(all="ignore"):  # what begins at -inf and is infinitely long has no end
        low = start if format == "xywh" else start - size / 2
        return Raw(np.hstack([low, low + size]), are_sized=True)
