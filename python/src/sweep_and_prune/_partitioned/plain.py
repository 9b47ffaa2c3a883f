"""Brings boxes of other files into the form that a run reads: Parquet files of numbers.

Text becomes numbers, times are counted from the first of them, and groups become one more axis. Margins, open ends and
missing values are dealt with here, too, so that the run compares plain boxes. Files are read a part at a time: once to
learn the groups and the types, if need be, and once more to write the boxes.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _crs
from .._arrays import Floats, read_boxes
from .._columns import EXACT, group_codes, in_one_unit
from .._errors import InvalidBoxError
from .._file_error import FileError
from .._inputs import Raw
from .._prepare import duration, is_missing, kind_of_boxes, prepare, refuse_inverted
from .._tables import Source as Table
from .._tables import columns_of_groups, header_of, is_text, kind_of_file, read_parts
from .._text import GENOMIC, Text
from .boxes import File, Form, InvalidRowError, form_of_files, opened, recognized, refuse_rounded
from .dataset import DatasetError
from .files import PART, part_of, read_sealed, write_sealed
from .folder import LOCK, locked
from .run import Source

_ROWS = 2**17
"""How many boxes are read from Parquet at once."""
_BYTES_OF_GROUP = 400
"""The memory that a group takes while its number is looked up."""
_NOTE = "_boxes.json"
_BOXES = re.compile(rf"([01]\.parquet|{re.escape(_NOTE)})({PART})?")
_AXES = "xyzw"
_EPOCH = 10**18


class Wanted(NamedTuple):
    """A set of boxes, as the user asked for it."""

    argument: str
    files: list[File]
    columns: list[str] | None
    ids: str | None
    by: list[str]


class Options(NamedTuple):
    """What the user asked for of all sets."""

    format: str
    closed: str | None
    missing: str
    margin: Any
    header: bool | None


class _Part(NamedTuple):
    """Some rows of a file."""

    table: Table
    raw: Raw
    ids: NDArray[Any] | None
    place: str
    row: int
    """The number of the first row in the file."""


class _Set:
    """A set of boxes that is read in parts."""

    def __init__(self, wanted: Wanted, options: Options) -> None:
        self.wanted, self.options = wanted, options
        self.is_text = is_text(wanted.files[0].path)
        if any(is_text(file.path) != self.is_text for file in wanted.files):
            raise DatasetError(f"{wanted.argument} has files of text and others: convert them to one format")
        kinds = {str(kind_of_file(file.path)) for file in wanted.files} if self.is_text else set()
        self.is_genomic = bool(kinds & set(GENOMIC))
        if self.is_genomic and len(kinds) > 1:
            raise DatasetError(f"{wanted.argument} has files of the formats {', '.join(sorted(kinds))}")
        self.closed = options.closed or ("left" if self.is_genomic else None)
        self.by = wanted.by or (["chrom"] if self.is_genomic else [])
        self.crs: Any = None
        self.form: Form | None = None
        if not self.is_text:
            given = {"format": options.format, "closed": None, "missing": "raise", "margin": 0}
            self.form, self.crs = form_of_files(wanted.files, wanted.columns, wanted.ids, given, self.by)
        elif self.is_genomic and options.format != "xyxy" and not wanted.columns:
            raise DatasetError(
                f"{wanted.files[0].path} is of a format that says where boxes begin and end: leave out format"
            )

    @property
    def id_type(self) -> str:
        """The type of the ids in Arrow."""
        if self.wanted.ids is None:
            return "int64"
        return "large_string" if self.form is None else self.form.id_type

    def parts(self, progress: Callable[[float], object]) -> Iterator[_Part]:
        """All boxes, a part at a time."""
        files = self.wanted.files
        for number, file in enumerate(files):

            def share(of_file: float, number: int = number) -> None:
                progress((number + of_file) / len(files))

            row = 0
            for part in self._of_text(file, share) if self.form is None else self._of_parquet(file, share):
                yield part._replace(row=row)
                row += len(part.raw.array)

    def _of_text(self, file: File, progress: Callable[[float], object]) -> Iterator[_Part]:
        for table in read_parts(file.path, self.options.header, progress):
            boxes = table.boxes(self.wanted.columns or [], self.options.format)
            raw = read_boxes(boxes, self.wanted.argument)
            ids = None
            if self.wanted.ids is not None:
                ids = np.asarray(table.label(self.wanted.ids)[np.arange(len(table))], object)
            yield _Part(table, raw, ids, file.path, 0)

    def _of_parquet(self, file: File, progress: Callable[[float], object]) -> Iterator[_Part]:
        import pyarrow

        assert self.form is not None
        names = list(dict.fromkeys([*self.form.names(), *self.by]))
        row = 0
        try:
            with opened(file.path) as parquet:
                for batch in parquet.iter_batches(batch_size=_ROWS, columns=names, use_threads=False):
                    table = _decoded(pyarrow.Table.from_batches([batch]), self.by)
                    ids = None if self.form.ids is None else self.form.ids_of(table, file.path, row)
                    yield _Part(Table(file.path, table), self._raw(table, file.path), ids, file.path, 0)
                    row += len(batch)
                    progress(row / max(sum(file.rows), 1))
        except (OSError, pyarrow.ArrowException) as error:
            raise DatasetError(f"{file.path} is damaged after row {row}: {error}; write it again") from None

    def _raw(self, table: Any, place: str) -> Raw:
        assert self.form is not None
        try:
            return self.form.raw(table, self.wanted.argument)
        except TypeError as error:
            raise DatasetError(f"{place}: {error}") from None


def _decoded(table: Any, by: list[str]) -> Any:
    """A table whose columns to group by have plain values.

    Raises:
        DatasetError: if they have lists or the like, which are no groups.
    """
    import pyarrow

    for name in dict.fromkeys(by):
        column = table[name]
        if pyarrow.types.is_dictionary(column.type):
            column = pyarrow.chunked_array(
                [chunk.dictionary_decode() for chunk in column.chunks], column.type.value_type
            )
        kind = str(column.type)  # Arrow cannot take rows of some types, nor find their different values
        if kind in ("string_view", "binary_view"):
            column = column.cast(f"large_{kind.removesuffix('_view')}")
        elif kind.startswith(("decimal32", "decimal64")):
            column = column.cast(pyarrow.decimal128(column.type.precision, column.type.scale))
        table = table.set_column(table.column_names.index(name), name, column)
        if pyarrow.types.is_nested(column.type):
            raise DatasetError(f"column {name} has values of type {column.type}; groups must be numbers, text or times")
    return table


def is_plain(wanted: Sequence[Wanted], options: Options) -> bool:
    """Whether a run can read these files as they are: Parquet files of numbers, without groups."""
    import pyarrow

    if any(one.by or any(is_text(file.path) for file in one.files) for one in wanted):
        return False
    for one in wanted:
        with opened(one.files[0].path) as parquet:
            schema = parquet.schema_arrow
        names = one.columns or recognized(schema, options.format)[1]
        types = [kind for known, kind in zip(schema.names, schema.types) if known in names]
        if any(map(pyarrow.types.is_temporal, types)):
            return False
    return True


class _Groups:
    """The groups of a set, each with a number."""

    def __init__(self, by: list[str], most: int) -> None:
        self._by, self._most = by, most
        self._numbers: dict[tuple[Any, ...], int] = {}
        self._cells: list[str] = []
        self._lines: list[int] = []
        self._tables: list[Any] = []
        self._name = ""
        self._format: Any = None

    def numbers(self, table: Table) -> NDArray[np.int64]:
        """The number of each row's group; new groups get the next ones."""
        keys, codes = self._keys(table)
        known = self._numbers
        new = [at for at, key in enumerate(keys) if key not in known]
        if new:
            if len(known) + len(new) > self._most:
                raise DatasetError(
                    f"{table.name} has more than {self._most:,} groups ({', '.join(self._by)}), which do not fit in "
                    "the memory limit: pass a larger one"
                )
            first = np.empty(len(keys), np.int64)
            first[codes[::-1]] = np.arange(len(codes))[::-1]
            self._keep(table, first[new])
            for at in new:
                known[keys[at]] = len(known)
        return np.array([known[key] for key in keys], np.int64)[codes]

    def _keys(self, table: Table) -> tuple[list[tuple[Any, ...]], NDArray[np.int64]]:
        """The different groups of some rows, and which of them each row has."""
        columns = [self._factors(table, name) for name in self._by]
        values, codes = columns[0]
        keys = [(value,) for value in values]
        for more, of_rows in columns[1:]:
            both, codes = np.unique(codes * max(len(more), 1) + of_rows, return_inverse=True)
            keys = [(*keys[code // len(more)], more[code % len(more)]) for code in both.tolist()]
            codes = codes.reshape(-1)
        return keys, codes

    def _factors(self, table: Table, name: str) -> tuple[list[Any], NDArray[np.int64]]:
        if table.text is not None:
            column = table.group(name)
            if column.codes is not None:
                return column.values.tolist(), column.codes.astype(np.int64)
            return _numbered(column.values.tolist())
        import pyarrow
        import pyarrow.compute

        array = table.values[name].combine_chunks()
        kind = array.type
        if pyarrow.types.is_temporal(kind):
            wide = pyarrow.int32() if array.type.bit_width == 32 else pyarrow.int64()
            array = array.view(wide)
        found = array.dictionary_encode(null_encoding="encode")
        # Arrow tells zeros of both signs apart, and a missing value from a NaN.
        values, codes = _numbered(
            [None if value != value else (str(kind), value) for value in found.dictionary.to_pylist()]
        )
        return values, codes[found.indices.to_numpy(zero_copy_only=False)]

    def _keep(self, table: Table, rows: NDArray[np.int64]) -> None:
        """Keeps these rows, each the first of its group."""
        self._name = table.name
        if table.text is None:
            self._tables.append(table.values.select(self._by).take(rows))
            return
        self._format = table.text.format
        cells = [np.asarray(table.label(name)[rows], object).tolist() for name in self._by]
        self._cells += [cell for row in zip(*cells) for cell in row]
        self._lines += [table.text.line(row) for row in rows.tolist()]

    def table(self) -> Table:
        """A table with one row for each group."""
        if self._tables:
            import pyarrow

            return Table(self._name, pyarrow.concat_tables(self._tables, promote_options="permissive"))
        text = Text(self._name, self._by, self._cells, self._lines)
        text.format = self._format._replace(attributes="") if self._format is not None else None
        return Table(self._name, text)


def _numbered(values: list[Any]) -> tuple[list[Any], NDArray[np.int64]]:
    """The different values of a list, in the order in which they come, and which of them is at each place."""
    known: dict[Any, int] = {}
    codes = [known.setdefault(value, len(known)) for value in values]
    return list(known), np.array(codes, np.int64)


class _Types:
    """The types of all coordinates."""

    def __init__(self) -> None:
        self.kinds: dict[str, str] = {}
        self._ranges: dict[str, tuple[int, int]] = {}
        self._is_double = False

    def add(self, raw: Raw, argument: str) -> None:
        """Takes note of some boxes."""
        array = raw.array
        if not len(array) or is_missing(array).all():
            return
        kind = kind_of_boxes(raw)
        for other, has in self.kinds.items():
            if has != kind:
                raise DatasetError(
                    f"{other} has {has} and {argument} has {kind}, which do not compare: convert one"
                    if other != argument
                    else f"the files of {argument} have {has} and {kind}, which do not compare: convert some"
                )
        self.kinds[argument] = kind
        if array.dtype.kind in "mM":
            unit = np.datetime_data(array.dtype)[0]
            counts = array.view(np.int64)[~np.isnat(array)]
            low, high = self._ranges.get(unit, (2**63, -(2**63)))
            self._ranges[unit] = min(low, int(counts.min())), max(high, int(counts.max()))
        self._is_double |= array.dtype.kind != "f" or array.dtype.itemsize != 4

    def dtype(self) -> str:
        """The precision in which boxes are compared."""
        return "float64" if self._is_double or not self.kinds else "float32"

    def clock(self, margin: Any) -> tuple[str, int, Any] | None:
        """The unit of times, where counting begins, and the margin in that unit; None for numbers."""
        if not self._ranges:
            return None
        kind = "m" if "durations" in self.kinds.values() else "M"
        ends = [np.array(ends, np.int64).view(f"{kind}8[{unit}]") for unit, ends in self._ranges.items()]
        add = np.asarray(duration(margin)) if margin else np.zeros((), "m8[W]")
        *ends, add = in_one_unit([*ends, add.reshape(-1)])
        if ends[0].dtype.kind == "O":
            raise DatasetError("times are too far from each other for one unit: convert the columns to a coarser one")
        unit = np.datetime_data(ends[0].dtype)[0]
        counts = [int(count) for array in ends for count in array.view(np.int64)]
        margins = add.astype(np.int64).tolist()
        if max(counts) - min(counts) + max(margins) >= EXACT:
            raise DatasetError(
                f"times in {unit!r} over this long are not exact as float64: convert the columns to a coarser unit, "
                "such as microseconds"
            )
        return unit, min(counts), margins if len(margins) > 1 else margins[0]


@contextmanager
def plain_boxes(
    wanted: Sequence[Wanted], options: Options, folder: Path, memory: int, progress: Callable[[float], object]
) -> Iterator[list[Source]]:
    """Plain boxes of these sets, in files of a folder that is removed after a run without an error.

    Files that are there from a run that was interrupted are used again, if they are of the same boxes.
    """
    with ExitStack() as stack:
        try:
            paths = [file.path for one in wanted for file in one.files]
            sets = [
                _Set(one, options._replace(header=header_of(one.files[0].path, paths, options.header)))
                for one in wanted
            ]
            _check(sets)
            key = _key(wanted, options)
            _refuse_others(folder)
            folder.mkdir(parents=True, exist_ok=True)
            stack.enter_context(locked(folder / LOCK))
            noted = _noted(folder, key)
            if noted is None:
                _remove_boxes(folder)
                try:
                    noted = _written(sets, options, folder, memory, progress)
                except Exception:
                    _remove(folder)
                    raise
                for argument in range(len(sets)):
                    _stamp(folder / f"{argument}.parquet", key)
                write_sealed(folder / _NOTE, {"key": key, **noted})
        except FileError as error:
            raise DatasetError(error.message) from None
        except OSError as error:
            if isinstance(error, DatasetError):
                raise
            raise DatasetError(f"{folder}: {error.strerror or error}; the same call begins again") from None
        yield [_source(folder / f"{argument}.parquet", one, noted) for argument, one in enumerate(sets)]
        _remove(folder)


def _refuse_others(folder: Path) -> None:
    """Raises an error if a folder has other files than those of a run, which has a lock."""
    names = os.listdir(folder) if os.path.lexists(folder) else []
    if names and not (LOCK in names and all(name == LOCK or _BOXES.fullmatch(name) for name in names)):
        raise DatasetError(f"{folder} exists and has other files: rename it, or choose another out")


def _remove(folder: Path) -> None:
    _remove_boxes(folder)
    (folder / LOCK).unlink(missing_ok=True)
    with suppress(OSError):  # it has something else
        folder.rmdir()


def _remove_boxes(folder: Path) -> None:
    """Removes the files of a run, and those that it was writing when it was killed."""
    for name in filter(_BOXES.fullmatch, os.listdir(folder)):
        (folder / name).unlink(missing_ok=True)


def _check(sets: list[_Set]) -> None:
    by = [one.by for one in sets]
    if any(by) and not all(by):
        raise DatasetError(f"{sets[by.index([])].wanted.files[0].path} has no groups, but the other file has: pass by")
    if len(set(map(len, by))) > 1:
        raise DatasetError(f"by must have as many columns for a as for b, not {len(by[0])} and {len(by[1])}")
    if len({one.closed for one in sets}) > 1:
        raise DatasetError("the formats of the files differ in whether ends belong to boxes: pass closed")
    apart = _crs.difference(*(one.crs for one in sets)) if len(sets) == 2 else None
    if apart is not None:
        raise DatasetError(
            f"a and b have different coordinate reference systems, {apart[0]} and {apart[1]}: convert one of them"
        )


def _key(wanted: Sequence[Wanted], options: Options) -> str:
    files = [[[os.path.abspath(file.path), file.stamp] for file in one.files] for one in wanted]
    rest = [[one.columns, one.ids, one.by] for one in wanted]
    return hashlib.sha256(
        json.dumps([1, files, rest, options._replace(margin=repr(options.margin))]).encode()
    ).hexdigest()


def _noted(folder: Path, key: str) -> dict[str, Any] | None:
    """What is known of the files of an interrupted run of the same boxes."""
    try:
        noted = read_sealed(folder / _NOTE)
    except (FileNotFoundError, ValueError):
        return None
    return noted if noted.pop("key", None) == key else None


def _stamp(path: Path, key: str) -> None:
    """Gives a file the time that follows from the boxes in it: a run knows by its time that a file is the same."""
    time = _EPOCH + int(key[:12], 16) * 1000
    os.utime(path, ns=(time, time))


def _source(path: Path, one: _Set, noted: dict[str, Any]) -> Source:
    status = path.stat()
    rows: list[int] = noted["rows"][int(path.stem)]
    file = File(str(path), rows, [status.st_size, status.st_mtime_ns])
    half = noted["dimensions"]
    columns = [f"{end}{axis}" for end in ("min", "max") for axis in _AXES[:half]]
    form = Form(columns, "chosen", "id", one.id_type, noted["dtype"], "xyxy", None, "raise", 0)
    return Source([file], [], [sum(rows)], form, None, one.crs)


def _written(
    sets: list[_Set], options: Options, folder: Path, memory: int, progress: Callable[[float], object]
) -> dict[str, Any]:
    """Writes the plain boxes of all sets, and returns what has to be known to read them."""
    is_grouped = bool(sets[0].by)
    types = _Types()
    groups = [_Groups(one.by, max(memory // _BYTES_OF_GROUP // len(sets), 1000)) for one in sets]
    is_scanned = is_grouped or any(one.form is not None for one in sets)
    passes = 2 if is_scanned else 1

    def share(turn: int, number: int) -> Callable[[float], object]:
        return lambda done: progress((turn + (number + done) / len(sets)) / passes)

    if is_scanned:
        for number, (one, of_set) in enumerate(zip(sets, groups)):
            for part in one.parts(share(0, number)):
                types.add(part.raw, one.wanted.argument)
                if is_grouped:
                    of_set.numbers(part.table)
    codes = _codes(sets, groups) if is_grouped else [None for _ in sets]
    clock = types.clock(options.margin)
    dtype = types.dtype() if is_scanned else "float64"
    if is_grouped and max((int(one.max(initial=0)) for one in codes if one is not None), default=0) >= 2**24:
        dtype = "float64"
    dimensions: int | None = None
    rows = []
    for number, (one, of_set, of_groups) in enumerate(zip(sets, groups, codes)):
        path = folder / f"{number}.parquet"
        with _file(path, one.id_type, dtype) as file:
            index = 0
            for part in one.parts(share(passes - 1, number)):
                boxes: NDArray[Any]
                boxes, kept = _plain(part, one, options, dtype, clock, index)
                half = boxes.shape[1] // 2
                if len(boxes) and dimensions not in (None, half):
                    raise DatasetError(
                        f"{part.place} has boxes of {half} dimensions, and others have {dimensions}: they must be the "
                        "same"
                    )
                dimensions = half if len(boxes) else dimensions
                ids = np.arange(index, index + len(part.raw.array)) if part.ids is None else part.ids
                index += len(part.raw.array)
                if of_groups is not None:
                    of_rows = of_groups[of_set.numbers(part.table)][kept]
                    boxes, kept = boxes[of_rows >= 0], kept[of_rows >= 0]
                    if half == 3:
                        raise DatasetError(
                            f"{part.place} has boxes of three dimensions, which are grouped in memory only: "
                            "leave out the memory limit"
                        )
                    of_rows = of_rows[of_rows >= 0].astype(dtype)[:, None]
                    boxes = np.hstack([boxes[:, :half], of_rows, boxes[:, half:], of_rows])
                file.write(boxes, ids[kept])
            rows.append(file.rows)
            file.finish((dimensions or 1) + is_grouped)
    return {"rows": rows, "dimensions": (dimensions or 1) + is_grouped, "dtype": dtype}


def _codes(sets: list[_Set], groups: list[_Groups]) -> list[NDArray[np.int64]]:
    """For each set the final numbers of its groups, the same for equal groups; -1 for none."""
    tables = [of_set.table() for of_set in groups]
    try:
        columns = columns_of_groups(tables, [one.by for one in sets])
        return group_codes(columns, [one.wanted.argument for one in sets])
    except TypeError as error:
        raise DatasetError(f"{' and '.join(table.name for table in tables)}: {error}") from None


def _plain(
    part: _Part, one: _Set, options: Options, dtype: str, clock: tuple[str, int, Any] | None, index: int
) -> tuple[Floats, NDArray[np.int64]]:
    """Plain boxes of a part, and which of its rows they are."""
    array, margin = part.raw.array, options.margin
    kept = np.arange(len(array))
    try:
        if options.missing == "skip":
            kept = np.flatnonzero(~is_missing(array))
            array = array[kept]
        refuse_inverted(array, one.wanted.argument, kept)
        if clock is not None:
            unit, origin, margin = clock
            array = _counted(array, unit, origin)
        else:
            refuse_rounded(array, part.place)
        prepared = prepare({one.wanted.argument: array.astype(dtype)}, "xyxy", one.closed, "raise", None, margin)
    except InvalidBoxError as error:
        row, line = part.row + error.index, None
        if part.table.text is not None:
            line = part.table.text.line(error.index)
        raise InvalidRowError(
            part.place, row, index + error.index, error.axis, error.minimum, error.maximum, error.argument, line
        ) from None
    rows = prepared.kept[0]
    return prepared.sets[0].astype(dtype, copy=False), kept if rows is None else kept[rows]


def _counted(times: NDArray[Any], unit: str, origin: int) -> NDArray[np.int64]:
    """How long after the origin times are, in a unit that holds them exactly."""
    if times.dtype.kind not in "mM":  # a part without any value
        return np.zeros(times.shape, np.int64)
    of_unit = np.zeros((), times.dtype)
    scaled, _ = in_one_unit([times, of_unit.astype(f"{times.dtype.kind}8[{unit}]")])
    return np.asarray(scaled.astype(np.int64) - origin)


class _File:
    """A Parquet file of plain boxes that is written in parts."""

    def __init__(self, path: Path, id_type: str, dtype: str) -> None:
        import pyarrow

        self._path = path
        self._writer: Any = None
        self._id_type, self._number = getattr(pyarrow, id_type)(), getattr(pyarrow, dtype)()
        self.rows: list[int] = []
        """The number of rows of each row group."""

    def write(self, boxes: NDArray[Any], ids: NDArray[Any]) -> None:
        """Writes some boxes."""
        if len(boxes):
            self._write(boxes, ids)
            self.rows.append(len(boxes))

    def _write(self, boxes: NDArray[Any], ids: NDArray[Any]) -> None:
        import pyarrow
        import pyarrow.parquet

        half = boxes.shape[1] // 2
        names = [f"{end}{axis}" for end in ("min", "max") for axis in _AXES[:half]]
        columns = [pyarrow.array(np.ascontiguousarray(column), self._number) for column in boxes.T]
        table = pyarrow.table([*columns, pyarrow.array(ids, self._id_type)], names=[*names, "id"])
        if self._writer is None:
            self._writer = pyarrow.parquet.ParquetWriter(
                self._path, table.schema, compression="none", use_dictionary=False, write_statistics=False
            )
        self._writer.write_table(table)

    def finish(self, dimensions: int) -> None:
        """Writes a file even if there are no boxes."""
        if self._writer is None:
            self._write(np.empty((0, 2 * dimensions)), np.empty(0, np.int64))

    def close(self) -> None:
        """Completes the file."""
        if self._writer is not None:
            self._writer.close()


@contextmanager
def _file(path: Path, id_type: str, dtype: str) -> Iterator[_File]:
    """A file that appears when it is complete."""
    part = part_of(path)
    try:
        file = _File(part, id_type, dtype)
        try:
            yield file
        finally:
            file.close()
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
