"""Reads columns of any library exactly: no number is rounded, no time wraps around, no time zone is forgotten.

A column becomes an array of NumPy. What no type of NumPy holds exactly (integers beyond 2^53 beside fractions, signed
integers beside unsigned ones, large decimals) becomes an array of Python's own numbers, which compare exactly.
"""

from __future__ import annotations

import datetime as dt
from collections.abc import Sequence
from decimal import Decimal
from fractions import Fraction
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

EXACT = 2**53
"""Double precision has all integers up to this one."""

_NAT = np.iinfo(np.int64).min
"""The number by which NumPy says that there is no time."""

_ATTOSECONDS = {
    **dict(zip(("as", "fs", "ps", "ns", "us", "ms", "s"), (10 ** (3 * power) for power in range(7)))),
    **{"m": 60 * 10**18, "h": 3600 * 10**18, "D": 86_400 * 10**18, "W": 7 * 86_400 * 10**18},
}
"""The units of times that have a fixed length, in the finest one."""

_WORDS = {
    "b": "truth values",
    **dict.fromkeys("iuf", "numbers"),
    "M": "times",
    "m": "durations",
    **dict.fromkeys("UT", "text"),
    "S": "bytes",
}


class Column(NamedTuple):
    """The values of a column."""

    values: NDArray[Any]
    """One-dimensional; of Python's own objects where no other type has the values exactly."""
    missing: NDArray[np.bool_] | None = None
    """Which rows have no value, if some have none. (What `values` has there does not matter.)"""
    is_zoned: bool = False
    """Whether these are times with a time zone. They are in UTC here."""
    name: str = ""
    """What it is called in messages."""
    codes: NDArray[Any] | None = None
    """Which of the values each row has; None if there is a value for each row."""

    @property
    def rows(self) -> int:
        """How many rows it has."""
        return len(self.values if self.codes is None else self.codes)

    @property
    def present(self) -> NDArray[Any]:
        """The values without those that are missing."""
        return self.values if self.missing is None else self.values[~self.missing]

    def kinds(self) -> set[str]:
        """What the values are, in words; an empty set if there are none."""
        values = self.present
        if len(values) == 0:
            return set()
        if values.dtype.kind == "O":
            items = values.tolist()
            types = set(map(type, items))
            return set(map(_word, items)) if any(issubclass(one, dt.date) for one in types) else _words(types)
        word = _WORDS.get(values.dtype.kind, f"values of dtype {values.dtype}")
        return {f"{word} with a time zone" if self.is_zoned else word}


def read_column(values: Any, name: str) -> Column:
    """A column of a data frame, an Arrow table, a dict, or anything like an array, and what to call it in messages."""
    return _read(values, name)._replace(name=name)


def _read(values: Any, name: str) -> Column:
    if type(values) is np.ndarray:
        return _of_array(values, name)
    if isinstance(values, (list, tuple)):  # NumPy would make one type of 1 and "1"
        return _of_objects(list(values))
    library = type(values).__module__.split(".")[0]
    if library == "polars" and hasattr(values, "to_physical"):
        return _of_polars(values)
    if library == "pandas" and not isinstance(values.dtype, np.dtype):
        return _of_pandas(getattr(values, "array", values), name)
    if library == "duckdb" and hasattr(values, "columns"):
        import pyarrow

        values = pyarrow.table(values)
        if len(values.columns) != 1:
            raise ValueError(f"{name} must have one column, not {len(values.columns)}")
        return _of_arrow(arrow_array(values[0]))
    if library == "pyarrow" or not hasattr(values, "__array__"):
        array = arrow_array(values)
        if array is not None:
            return _of_arrow(array)
    return _of_array(as_array(values, name), name)


def read_groups(values: Any, name: str) -> Column:
    """As `read_column`, for values that are only compared: text and categories are numbered by the library itself."""
    found = _numbered(values)
    if found is None:
        return read_column(values, name)
    distinct, codes = read_column(found[0], name), found[1]
    is_used = np.bincount(codes + 1, minlength=distinct.rows + 1).astype(bool)
    missing = ~is_used[1:] if distinct.missing is None else distinct.missing | ~is_used[1:]
    # A code of -1 takes the last one, which is missing.
    last = np.zeros(1, distinct.values.dtype)
    return distinct._replace(
        values=np.concatenate([distinct.values, last]), missing=np.append(missing, True), codes=codes
    )


def _numbered(values: Any) -> tuple[Any, NDArray[np.int64]] | None:
    """The distinct values of a column of text or of categories, and which of them each row has; -1 for none."""
    library = type(values).__module__.split(".")[0]
    if library == "pandas" and hasattr(values, "dtype"):
        if hasattr(values.dtype, "categories"):
            array = getattr(values, "array", values)
            return array.categories, np.asarray(array.codes, np.int64)
        import pandas

        if not hasattr(values.dtype, "pyarrow_dtype"):
            if pandas.api.types.infer_dtype(values) != "string":
                return None
            codes, distinct = pandas.factorize(values)
            return np.asarray(distinct, object), np.asarray(codes, np.int64)
    array = arrow_array(values) if library in ("pandas", "polars", "pyarrow") else None
    if array is None:
        return None
    import pyarrow

    types = pyarrow.types
    if str(array.type) == "string_view":  # that of polars
        array = array.cast(pyarrow.large_string())
    if types.is_string(array.type) or types.is_large_string(array.type):
        array = array.dictionary_encode()
    if not types.is_dictionary(array.type):
        return None
    return array.dictionary, array.indices.cast(pyarrow.int64()).fill_null(-1).to_numpy(zero_copy_only=False)


def as_array(values: Any, name: str) -> NDArray[Any]:
    """Anything like an array as an array. Tensors are detached and brought to the CPU; masked values are refused."""
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
    # (No filter of warnings here: Python has one list of them for all threads.)
    is_list = isinstance(values, (list, tuple))
    try:
        array = np.asarray(values)
    except ValueError:
        if is_list:
            _refuse_unequal(values, name)
        raise
    if is_list and _has_masked(values, array.ndim):  # NumPy reads the values under a mask
        raise ValueError(
            f"{name} has masked values in a list: pass one masked array, such as np.ma.stack({name}), or drop them"
        )
    return array


def _has_masked(rows: Any, depth: int) -> bool:
    """Whether nested lists, of this depth, have an array with masked values in them."""
    for row in rows:
        if isinstance(row, np.ma.MaskedArray):
            if np.ma.getmaskarray(row).any():
                return True
        elif depth > 2 and isinstance(row, (list, tuple)) and _has_masked(row, depth - 1):
            return True
    return False


def _refuse_unequal(rows: Sequence[Any], name: str) -> None:
    """Refuses the first row whose length is not that of the first one."""
    sizes = [f"{len(row)} values" if hasattr(row, "__len__") else "one value" for row in rows]
    for index, size in enumerate(sizes):
        if size != sizes[0]:
            raise ValueError(f"{name}[{index}] has {size}, but {name}[0] has {sizes[0]}")


def exact_numbers(values: Any, array: NDArray[Any]) -> NDArray[Any]:
    """The integers and fractions of nested lists, if NumPy rounds them or has no type for them; else its `array`."""
    # (NumPy rounds integers to double precision only, and warns where half precision is compared with large ones.)
    is_double = array.dtype.kind == "f" and array.dtype.itemsize >= 8
    if array.dtype.kind == "O" or (is_double and bool((np.abs(array) >= EXACT).any())):
        objects = np.array(values, object)
        items = objects.ravel().tolist()
        types = set(map(type, items))
        has_missing, numbers = type(None) in types, types - {bool, type(None)}
        are_numbers = all(issubclass(one, (int, float, np.integer, np.floating)) for one in numbers)
        if are_numbers and (numbers or not has_missing):
            exact = _with_nan(_of_objects(items))
            return exact.reshape(objects.shape) if exact.dtype.kind in "iuO" or has_missing else array
    return array


def arrow_array(values: Any) -> Any:
    """An array of pyarrow that is not chunked, with what an extension type stores; None for anything else."""
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
    return array.storage if isinstance(array, pyarrow.ExtensionArray) else array


def _of_array(array: NDArray[Any], name: str) -> Column:
    if array.ndim != 1:
        raise ValueError(f"{name} must have one value for each row, not an array of shape {array.shape}")
    if array.dtype.kind in "OT":  # text of NumPy may have missing values, too
        return _of_objects(array.tolist())
    if array.dtype.kind in "fc":
        missing = np.isnan(array)
    elif array.dtype.kind in "mM":
        missing = np.isnat(array)
        array = in_simple_unit(array, name)
    else:
        return Column(array)
    return Column(array, missing if missing.any() else None)


def _of_pandas(array: Any, name: str) -> Column:
    """A column of one of the types that pandas adds to those of NumPy."""
    dtype = array.dtype
    if hasattr(dtype, "pyarrow_dtype"):
        found = arrow_array(array.__arrow_array__())
        if found is not None:
            return _of_arrow(found)
    if hasattr(dtype, "categories"):
        return _taken(read_column(array.categories, name), np.asarray(array.codes))
    if hasattr(dtype, "tz"):
        return _of_array(array.to_numpy(dtype=f"M8[{dtype.unit}]"), name)._replace(is_zoned=True)
    of_numpy = getattr(dtype, "numpy_dtype", None)
    if of_numpy is not None and of_numpy.kind in "iub":
        missing = np.asarray(array.isna(), bool)
        values = np.asarray(array.to_numpy(dtype=of_numpy, na_value=0))
        return Column(values, missing if missing.any() else None)
    if of_numpy is not None and of_numpy.kind == "f":
        array = array.to_numpy(dtype=of_numpy, na_value=np.nan)
    return _of_array(np.asarray(array), name)


def _of_polars(series: Any) -> Column:
    dtype = series.dtype
    missing = series.is_null().to_numpy() if series.null_count() else None
    if hasattr(dtype, "time_unit") or str(dtype) == "Date":
        unit = getattr(dtype, "time_unit", "D") or "us"
        counts = series.to_physical()
        # (Even without missing values, to fill them takes as long as all else here.)
        counts = (counts if missing is None else counts.fill_null(0)).to_numpy().astype(np.int64)
        times = counts.view(f"{'m' if str(dtype).startswith('Duration') else 'M'}8[{unit}]")
        return Column(times, missing, getattr(dtype, "time_zone", None) is not None)
    if dtype.is_integer() and not str(dtype).endswith("128"):
        return Column((series if missing is None else series.fill_null(0)).to_numpy(), missing)
    if dtype.is_float():
        return _of_array(series.to_numpy(), series.name)
    return _of_objects(series.to_list())


def _of_arrow(array: Any) -> Column:
    import pyarrow

    types = pyarrow.types
    if types.is_dictionary(array.type):
        array = array.dictionary_decode()
    elif hasattr(types, "is_run_end_encoded") and types.is_run_end_encoded(array.type):
        import pyarrow.compute

        array = pyarrow.compute.run_end_decode(array)
    kind = array.type
    missing = array.is_null().to_numpy(zero_copy_only=False) if array.null_count else None
    if types.is_timestamp(kind) or types.is_date(kind) or types.is_duration(kind):
        unit = "D" if types.is_date32(kind) else "ms" if types.is_date64(kind) else kind.unit
        counts = array.view(pyarrow.int32() if types.is_date32(kind) else pyarrow.int64()).fill_null(0)
        times = counts.to_numpy(zero_copy_only=False).astype(np.int64)
        is_zoned = types.is_timestamp(kind) and kind.tz is not None
        return Column(times.view(f"{'m' if types.is_duration(kind) else 'M'}8[{unit}]"), missing, is_zoned)
    if types.is_integer(kind) or types.is_boolean(kind):
        filled = array if missing is None else array.fill_null(False if types.is_boolean(kind) else 0)
        return Column(filled.to_numpy(zero_copy_only=False), missing)
    if types.is_floating(kind):
        return _of_array(array.to_numpy(zero_copy_only=False), "the column")
    return _of_objects(array.to_pylist())


def _taken(column: Column, rows: NDArray[Any]) -> Column:
    """Rows of a column; those below 0 are missing."""
    missing = rows < 0 if column.missing is None else (rows < 0) | column.missing[rows]
    values = column.values[rows] if len(column.values) else np.zeros(len(rows))
    return column._replace(values=values, missing=missing if missing.any() else None)


def _of_objects(items: list[Any]) -> Column:
    """A column of Python's objects: exact numbers or times if all are, or else the objects themselves."""
    never_missing = set(map(type, items)) <= {int, str, bool, bytes}
    missing = np.zeros(0, bool) if never_missing else np.fromiter(map(is_missing_value, items), bool, len(items))
    present = [item for item, is_none in zip(items, missing.tolist()) if not is_none] if missing.any() else items
    found = _exact_numbers(present) or _exact_times(present) or Column(objects_of(present))
    if len(present) == len(items):
        return found
    values = np.zeros(len(items), found.values.dtype)
    values[~missing] = found.values
    return found._replace(values=values, missing=missing)


def objects_of(items: Sequence[Any]) -> NDArray[Any]:
    """An array of objects, which may be lists."""
    array = np.empty(len(items), object)
    for index, item in enumerate(items):  # an assignment of all would look into those that are sequences
        array[index] = item
    return array


def is_missing_value(item: Any) -> bool:
    """Whether it is None, NaN, NaT or NA."""
    if item is None or type(item).__name__ == "NAType":
        return True
    try:
        return bool(item != item)
    except (TypeError, ValueError, ArithmeticError):
        return False


def _exact_numbers(items: list[Any]) -> Column | None:
    kinds = set(map(type, items))
    if not items or not all(_is_number(kind) for kind in kinds):
        return None
    items = [item.item() if isinstance(item, np.generic) else item for item in items]
    if all(isinstance(item, int) for item in items):
        for dtype in (np.int64, np.uint64):
            try:
                return Column(np.array(items, dtype))
            except OverflowError:
                pass
        return Column(objects_of(items))
    try:
        floats = np.array([float(item) for item in items])
    except OverflowError:
        return Column(objects_of(items))
    # Comparing Python's numbers of different types is exact. Sums with exact types must not be rounded, either.
    are_exact = not any(issubclass(kind, (float, np.floating)) for kind in kinds)
    is_rounded = floats.tolist() != items or (are_exact and bool((np.abs(floats) >= EXACT).any()))
    return Column(objects_of(items) if is_rounded else floats)


def _is_number(kind: type) -> bool:
    kinds = (int, float, np.integer, np.floating, Decimal, Fraction)
    return issubclass(kind, kinds) and not issubclass(kind, (bool, np.timedelta64))


def _exact_times(items: list[Any]) -> Column | None:
    """Times or durations, in the finest unit among them."""
    types = set(map(type, items))
    if not items or not all(issubclass(one, (dt.date, dt.timedelta, np.datetime64, np.timedelta64)) for one in types):
        return None
    words = set(map(_word, items))
    if len(words) > 1:
        return None
    of_unit: dict[str, list[tuple[int, Any]]] = {}
    for row, item in enumerate(items):
        time = _time_of_numpy(item)
        of_unit.setdefault(np.datetime_data(time.dtype)[0], []).append((row, time))
    arrays = in_one_unit([np.array([time for _, time in times]) for times in of_unit.values()])
    if arrays[0].dtype.kind == "O":
        raise ValueError(f"a column has times in the units {', '.join(of_unit)}, which no unit holds: convert them")
    values = np.empty(len(items), arrays[0].dtype)
    for array, times in zip(arrays, of_unit.values()):
        values[[row for row, _ in times]] = array
    return Column(values, None, words == {"times with a time zone"})


def _time_of_numpy(item: Any) -> Any:
    for convert in ("to_datetime64", "to_timedelta64"):  # of pandas, which has nanoseconds; the zone becomes UTC
        if hasattr(item, convert):
            return getattr(item, convert)()
    if isinstance(item, np.generic):
        return in_simple_unit(np.array([item]), "the column")[0]
    if isinstance(item, dt.datetime) and item.tzinfo is not None:
        since = item - dt.datetime(1970, 1, 1, tzinfo=dt.timezone.utc)
        return np.datetime64(since // dt.timedelta(microseconds=1), "us")
    if isinstance(item, dt.timedelta):
        try:
            return np.timedelta64(item // dt.timedelta(microseconds=1), "us")
        except OverflowError:
            raise ValueError(f"a duration is {item}, which is too long for microseconds of NumPy") from None
    return np.datetime64(item, "us" if isinstance(item, dt.datetime) else "D")


def _word(item: Any) -> str:
    """What a value is, in words."""
    (word,) = _words({type(item)})
    return f"{word} with a time zone" if getattr(item, "tzinfo", None) is not None and word == "times" else word


def _words(types: set[type]) -> set[str]:
    """What values of these types are, in words, whatever their time zones."""
    words = set()
    for one in types:
        if issubclass(one, (bool, np.bool_)):
            words.add("truth values")
        elif issubclass(one, (dt.timedelta, np.timedelta64)):
            words.add("durations")
        elif _is_number(one):
            words.add("numbers")
        elif issubclass(one, (dt.date, np.datetime64)):
            words.add("times")
        elif issubclass(one, str):
            words.add("text")
        else:
            words.add("bytes" if issubclass(one, bytes) else f"values of type {one.__name__}")
    return words


def in_simple_unit(times: NDArray[Any], name: str) -> NDArray[Any]:
    """Times in a unit of fixed length: not in months or years, nor in a multiple of a unit."""
    unit, step = np.datetime_data(times.dtype)
    if unit in _ATTOSECONDS and step == 1:
        return times
    if unit == "generic":
        if not np.isnat(times).all():
            raise TypeError(f"{name} has durations without a unit: pass np.timedelta64(3, 's') or the like")
        return times.astype(f"{times.dtype.kind}8[s]")
    if unit in "YM" and times.dtype.kind == "m":
        raise TypeError(f"{name} has durations in {'years' if unit == 'Y' else 'months'}, which differ in length")
    simple = "D" if unit in "YM" else unit
    try:
        found = times.astype(f"{times.dtype.kind}8[{simple}]")
        is_exact = bool(((found.astype(times.dtype) == times) | np.isnat(times)).all())
    except OverflowError:
        is_exact = False
    if not is_exact:
        raise ValueError(f"{name} has times that are too far away: those in {times.dtype} do not fit in {simple!r}")
    return found


def in_one_unit(arrays: Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Times in the finest of their units; as Python's integers if they do not fit.

    (NumPy would let them wrap around: the year 2554 in seconds becomes 1970 in nanoseconds.)
    """
    units = [np.datetime_data(array.dtype)[0] for array in arrays]
    finest = min(units, key=_ATTOSECONDS.__getitem__)
    if len(set(units)) == 1:
        return list(arrays)
    factors = [_ATTOSECONDS[unit] // _ATTOSECONDS[finest] for unit in units]
    missing = [np.isnat(array) for array in arrays]
    counts = [np.where(no, 0, array.astype(np.int64)) for array, no in zip(arrays, missing)]
    most = [max(int(count.max(initial=0)), -int(count.min(initial=0))) for count in counts]
    if all(number * factor < 2**63 for number, factor in zip(most, factors)):
        dtype = f"{arrays[0].dtype.kind}8[{finest}]"
        # (A factor beyond 2^62 is one of zeros.)
        scaled = [count * min(factor, 2**62) for count, factor in zip(counts, factors)]
        return [np.where(no, _NAT, count).view(dtype) for no, count in zip(missing, scaled)]
    exact = [np.empty(count.shape, object) for count in counts]
    for array, no, count, factor in zip(exact, missing, counts, factors):
        array[...] = count.astype(object) * factor
        array[no] = np.nan
    return exact


def side_by_side(columns: Sequence[Column], names: Sequence[str], what: str) -> tuple[NDArray[Any], bool]:
    """Columns as an array of two dimensions, and whether it has times with a time zone. Missing values are NaN or NaT.

    Args:
        columns: numbers, times or durations; all the same.
        names: those of the columns.
        what: the name of the table.
    """
    if len({len(column.values) for column in columns}) > 1:
        raise ValueError(f"the columns {', '.join(names)} of {what} must be of one length")
    kinds = [column.kinds() for column in columns]
    for kind, name in zip(kinds, names):
        others = sorted(kind - {"numbers", "times", "times with a time zone", "durations"})
        if others:
            raise TypeError(f"column {name} must have numbers, not {' and '.join(others)}")
        if len(kind) > 1:
            raise TypeError(f"column {name} has {' and '.join(sorted(kind))}, which do not compare: convert them")
    known = [(next(iter(kind)), name) for kind, name in zip(kinds, names) if kind]
    for word, name in known:
        if word != known[0][0]:
            raise TypeError(f"column {known[0][1]} has {known[0][0]}, but column {name} has {word}: convert one")
    if not known:
        # Times that are all missing are times; a column of objects may be anything.
        of_times = [column for column in columns if column.values.dtype.kind in "mM"]
        if of_times:
            nothing = np.full((len(columns[0].values), len(columns)), "NaT", of_times[0].values.dtype)
            return nothing, any(column.is_zoned for column in of_times)
    if not known or known[0][0] == "numbers":
        return np.stack(one_type([_with_nan(column) for column in columns]), axis=1), False
    dtype = next(column.values.dtype for column, kind in zip(columns, kinds) if kind)
    given = [
        column.values if kind else np.full(len(column.values), "NaT", dtype) for column, kind in zip(columns, kinds)
    ]
    times = in_one_unit(given)
    if times[0].dtype.kind == "O":
        units = sorted({f"{name} in {np.datetime_data(array.dtype)[0]}" for name, array in zip(names, given)})
        raise ValueError(f"{what} has times in units that none of them holds ({', '.join(units)}): convert them to one")
    table = np.stack(times, axis=1)
    for axis, column in enumerate(columns):
        if column.missing is not None:
            table[column.missing, axis] = "NaT"
    return table, known[0][0] == "times with a time zone"


def _with_nan(column: Column) -> NDArray[Any]:
    """Numbers, with NaN where a value is missing."""
    values, missing = column.values, column.missing
    if not column.kinds():
        return values if len(values) == 0 and values.dtype.kind in "iuf" else np.full(len(values), np.nan)
    if missing is None:
        return values
    is_exact = values.dtype.kind == "O" or is_rounded(values)
    values = values.astype(object if is_exact else values.dtype if values.dtype.kind == "f" else np.float64)
    values[missing] = np.nan
    return values


def one_type(arrays: Sequence[NDArray[Any]]) -> list[NDArray[Any]]:
    """Numbers in one type that has them exactly."""
    kinds = {array.dtype.kind for array in arrays}
    dtype = np.result_type(*arrays)
    if dtype.kind == "f" and kinds != {"f"} and any(map(is_rounded, arrays)):
        dtype = np.dtype(object)  # there may be another type of integers that has them all
        if kinds <= {"i", "u"}:
            if all(int(array.min(initial=0)) >= 0 for array in arrays):
                dtype = np.dtype(np.uint64)
            elif all(int(array.max(initial=0)) < 2**63 for array in arrays):
                dtype = np.dtype(np.int64)
    return [array.astype(dtype, copy=False) for array in arrays]


def in_double(array: NDArray[Any], name: str) -> NDArray[Any]:
    """Numbers of more than double precision in double precision, which must have them; others as they are."""
    if array.dtype.kind != "f" or array.dtype.itemsize <= 8:
        return array
    with np.errstate(all="ignore"):
        rounded = array.astype(np.float64)
        differs = np.flatnonzero((rounded != array) & (array == array))
    if len(differs):
        at = "".join(f"[{index}]" for index in np.unravel_index(differs[0], array.shape))
        raise ValueError(
            f"{name}{at} is {array.flat[differs[0]]!r}, which double precision does not have: "
            f"round it, as {name}.astype(float) does"
        )
    return rounded


def is_rounded(array: NDArray[Any]) -> bool:
    """Whether it has integers that double precision may round."""
    if array.dtype.kind not in "iu" or array.dtype.itemsize < 8 or array.size == 0:
        return False
    # (Methods of small arrays take longer than the functions that they call. NumPy before 2.0 rounds an unsigned number
    # to compare it with one of Python's.)
    return int(np.maximum.reduce(array, None)) > EXACT or int(np.minimum.reduce(array, None)) < -EXACT


def group_codes(sides: Sequence[Sequence[Column]], sets: Sequence[str]) -> list[NDArray[np.int64]]:
    """A number for the group of each row of one or two sets: the same for equal values, -1 where one is missing.

    Args:
        sides: for each set the columns that make its groups.
        sets: the names of the sets.

    Raises:
        TypeError: if the values of two sets are of different kinds, so that none could be equal.
    """
    combined: NDArray[np.int64] | None = None
    for of_sets in zip(*sides):
        kinds = [column.kinds() for column in of_sets]
        if len(kinds) == 2 and all(kinds) and not kinds[0] & kinds[1]:
            has = [f"{' and '.join(sorted(kind))} in {own}" for kind, own in zip(kinds, sets)]
            raise TypeError(f"{of_sets[0].name} has {has[0]}, but {has[1]}, which are never equal: convert one of them")
        found = _codes_of_columns(of_sets)
        if combined is not None:
            both = combined * (found.max(initial=0) + 1) + found
            both[(combined < 0) | (found < 0)] = -1
            found = np.unique(both, return_inverse=True)[1].reshape(-1) - int((both < 0).any())
        combined = found
    assert combined is not None
    return list(np.split(combined, np.cumsum([columns[0].rows for columns in sides])[:-1]))


def _codes_of_columns(columns: Sequence[Column]) -> NDArray[np.int64]:
    is_present = np.concatenate(
        [np.ones(len(one.values), bool) if one.missing is None else ~one.missing for one in columns]
    )
    present = [one.values if one.missing is None else one.values[~one.missing] for one in columns]
    found = np.full(len(is_present), -1, np.int64)
    found[is_present] = _codes_of_values([values for values in present if len(values)])
    parts = np.split(found, np.cumsum([len(one.values) for one in columns])[:-1])
    return np.concatenate([part if one.codes is None else part[one.codes] for part, one in zip(parts, columns)])


def _codes_of_values(arrays: list[NDArray[Any]]) -> NDArray[np.int64]:
    if not arrays:
        return np.empty(0, np.int64)
    kinds = {array.dtype.kind for array in arrays}
    if kinds <= set("biuf"):
        arrays = one_type(arrays)
    elif kinds <= {"M"} or kinds <= {"m"}:
        arrays = in_one_unit(arrays)
    if arrays[0].dtype.kind in "biufmM" and len({array.dtype for array in arrays}) == 1:
        return np.unique(np.concatenate(arrays), return_inverse=True)[1].reshape(-1).astype(np.int64)
    # Text and other objects: looking them up is several times faster than sorting them, and they need no order.
    values = [value for array in arrays for value in array.tolist()]
    known: dict[Any, int] = {}
    try:
        return np.fromiter((known.setdefault(value, len(known)) for value in values), np.int64, len(values))
    except TypeError:
        raise TypeError("by must have values that can be compared, such as numbers or text") from None
