"""Reads boxes: from Parquet files, chunk by chunk, or from a partition of a Dask collection."""

from __future__ import annotations

import glob
import os
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _crs
from .._arrays import read_boxes
from .._columns import is_missing_value, is_rounded, read_column, side_by_side
from .._errors import InvalidBoxError
from .._inputs import (
    Raw,
    bounds_of_geometries,
    box_columns,
    geometry_column,
    listed,
    refuse_sizes,
    unknown_columns,
)
from .._prepare import prepare, refuse_inverted
from .._tables import is_text
from .dataset import DatasetError
from .search import Boxes

_READ_BUFFER = 2**20


class InvalidRowError(InvalidBoxError):
    """A box in a file or a partition is inverted, or it has a NaN.

    It is an `InvalidBoxError` whose `index` is the number of the row in the whole set.
    """

    place: str
    """The file or the partition."""
    row: int
    """The row there; the first is 0."""
    line: int | None
    """The line of a file of text; the first is 1."""

    def __init__(
        self,
        place: str,
        row: int,
        index: int,
        axis: int,
        minimum: float,
        maximum: float,
        argument: str = "boxes",
        line: int | None = None,
    ) -> None:
        """Creates the error for a row of a file or a partition."""
        super().__init__(index, axis, argument, minimum, maximum)
        self.args = (place, row, index, axis, minimum, maximum, argument, line)
        self.place, self.row, self.line = place, row, line

    def __str__(self) -> str:
        """Names the file, the row, its values and what to do."""
        said = super().__str__().split(" ", 1)[1]
        if "NaN" in said:
            said += ', or pass missing="skip"'
        where = f"row {self.row} (the first is 0)" if self.line is None else f"line {self.line}"
        return f"{self.place}, {where}: the box {said}"


class Form(NamedTuple):
    """How a set of boxes is read from a table."""

    columns: list[str]
    """The columns that are read: of coordinates, or one of structs or geometries. None for an array."""
    kind: str
    """What they are: `"chosen"` or `"recognized"` columns, `"nested"` boxes in one, `"geometry"`, or an `"array"`."""
    ids: str | None
    """The column of ids; None for row numbers."""
    id_type: str
    """Its type in Arrow: `int64`, `uint64` or `large_string`."""
    dtype: str
    """The precision in which boxes are compared."""
    format: str
    closed: str | None
    missing: str
    margin: Any

    def names(self) -> list[str]:
        """All columns that are needed."""
        return list(dict.fromkeys([*self.columns, *([] if self.ids is None else [self.ids])]))

    def read(self, table: Any, place: str, first_row: int, first_index: int, argument: str) -> Boxes:
        """The valid boxes of a table or an array, with their ids.

        Args:
            table: the columns or rows.
            place: where they are from, for messages.
            first_row: the number of the first row there.
            first_index: its number in the whole set.
            argument: the name of the set.
        """
        try:
            array = self.raw(table, argument).array
        except TypeError as error:
            raise DatasetError(f"{place}: {error}") from None
        refuse_rounded(array, place)
        if array.dtype.kind in "iu":
            array = array.astype(np.float64)
        if array.dtype.kind != "f":
            raise DatasetError(f"{place}: coordinates must be numbers, not of type {array.dtype}; convert the columns")
        try:
            array = array.astype(self.dtype, copy=False)
            prepared = prepare({argument: array}, "xyxy", self.closed, self.missing, None, self.margin)
            rows, kept = prepared.sets[0], prepared.kept[0]
            refuse_inverted(rows, argument, kept)
        except InvalidBoxError as error:
            raise InvalidRowError(
                place,
                first_row + error.index,
                first_index + error.index,
                error.axis,
                error.minimum,
                error.maximum,
                argument,
            ) from None
        rows = rows.astype(self.dtype, copy=False)
        if self.ids is None:
            return Boxes((np.arange(len(rows)) if kept is None else kept) + np.int64(first_index), rows)
        ids = self.ids_of(table, place, first_row)
        return Boxes(ids if kept is None else ids[kept], rows)

    def raw(self, table: Any, argument: str) -> Raw:
        """The boxes of a table or an array, in the type that they have there."""
        if self.kind == "chosen":
            columns = [read_column(table[name], f"column {name}") for name in self.columns]
            values: Any = Raw(*side_by_side(columns, self.columns, argument))
        elif self.kind == "nested":
            values = table[self.columns[0]]
        elif self.kind == "geometry" and hasattr(type(table), "total_bounds"):  # a GeoDataFrame
            values = table[self.columns[0]]
        elif self.kind == "geometry":
            values = Raw(bounds_of_geometries(table, self.columns[0]))
        else:
            values = table
        return read_boxes(values, argument, 0, self.format)

    def in_precision_of(self, *empty: Any) -> Form:
        """The same, in the precision in which boxes of tables like these, without rows, are compared in memory."""
        return self._replace(dtype="float32" if all(map(self._is_single, empty)) else "float64")

    def _is_single(self, empty: Any) -> bool:
        if self.kind == "geometry":
            return False
        try:
            return self.raw(empty, "boxes").array.dtype == np.float32
        except (TypeError, ValueError):  # also a column of objects, which may have lists; reading rows tells
            return False

    def ids_of(self, table: Any, place: str, first_row: int) -> NDArray[Any]:
        """The ids of the rows of a table."""
        column = table[self.ids]
        ids = np.asarray(column)
        missing = np.array([*map(is_missing_value, ids.tolist())], bool) if ids.dtype.kind == "O" else ids != ids
        if missing.any():
            row = first_row + int(np.argmax(missing))
            raise DatasetError(f"{place}, row {row} (the first is 0): column {self.ids} has no id; give each box one")
        if self.id_type == "large_string":
            return ids.astype(object)
        return ids.astype(self.id_type, copy=False)


def refuse_rounded(array: NDArray[Any], place: str) -> None:
    """Refuses coordinates that are not exact in double precision."""
    are_objects = array.dtype.kind == "O"
    if are_objects and not set(map(type, array.ravel().tolist())) <= {int, float}:
        raise DatasetError(f"{place}: coordinates are decimals that float64 does not have: convert the columns")
    if are_objects or is_rounded(array):
        raise DatasetError(f"{place}: coordinates beyond 2^53 are not exact as float64; subtract an offset first")


class File(NamedTuple):
    """A Parquet file, or one of text."""

    path: str
    rows: list[int]
    """The number of rows of each row group."""
    stamp: list[int]
    """Its size and the time of its last change: a file that differs in these is another one."""


class Chunk(NamedTuple):
    """Row groups of a file, or a partition of a collection."""

    argument: int
    """0 for the first set, 1 for the second one."""
    source: int
    """The file or partition."""
    groups: list[int]
    row: int
    """The number of its first row in the file."""
    first: int
    """The number of its first row in the whole set."""
    rows: int


def list_files(paths: Any) -> list[File]:
    """The files of a path, a pattern, a folder (of Parquet files), or several of these, sorted within each.

    How many rows files of text have is not known yet.

    Raises:
        DatasetError: if a file is missing or damaged.
    """
    found = [name for path in _given(paths) for name in _expanded(path)]
    files = []
    for name in found:
        if is_text(name):
            files.append(File(name, [], _stamp(name)))
            continue
        with opened(name) as file:
            metadata = file.metadata
            rows = [metadata.row_group(group).num_rows for group in range(metadata.num_row_groups)]
        files.append(File(name, rows, _stamp(name)))
    return files


def _given(paths: Any) -> list[str]:
    return [os.fspath(path) for path in ([paths] if isinstance(paths, (str, os.PathLike)) else paths)]


def folders_of(paths: Any) -> list[str]:
    """Those of the paths that name a folder on this machine."""
    return [path for path in _given(paths) if "://" not in path and os.path.isdir(path)]


def _expanded(path: str) -> list[str]:
    if "://" in path:
        from pyarrow.fs import FileSelector, FileSystem, FileType

        system, inside = FileSystem.from_uri(path)
        if system.get_file_info(inside).type == FileType.File:
            return [path]
        scheme = path.split("://", 1)[0]
        infos = system.get_file_info(FileSelector(inside, recursive=True))
        names = sorted(f"{scheme}://{info.path}" for info in infos if is_data(info.path, inside))
    elif os.path.isdir(path):
        names = sorted(str(name) for name in Path(path).rglob("*") if is_data(str(name), path))
    elif os.path.exists(path):
        return [path]
    else:
        names = sorted(glob.glob(path, recursive=True))
    if not names:
        raise DatasetError(f"{path} names no Parquet file: is the path right?")
    return names


def is_data(name: str, folder: str) -> bool:
    """Whether a file is one of those that are read if this folder is named."""
    parts = Path(os.path.relpath(name, folder)).parts
    return name.endswith((".parquet", ".geoparquet", ".pq")) and not any(part[0] in "._" for part in parts)


def _stamp(name: str) -> list[int]:
    if "://" in name:
        from pyarrow.fs import FileSystem

        system, inside = FileSystem.from_uri(name)
        info = system.get_file_info(inside)
        return [int(info.size or 0), int(info.mtime_ns or 0)]
    status = os.stat(name)
    return [status.st_size, status.st_mtime_ns]


def opened(name: str, buffer_size: int = _READ_BUFFER) -> Any:
    """A Parquet file, read through a small buffer."""
    import pyarrow
    import pyarrow.parquet

    try:
        source: Any = name
        if "://" in name:
            system, inside = pyarrow.fs.FileSystem.from_uri(name)
            source = system.open_input_file(inside)
        return pyarrow.parquet.ParquetFile(source, buffer_size=buffer_size, pre_buffer=False)
    except FileNotFoundError:
        raise DatasetError(f"{name} is missing: is the path right?") from None
    except (OSError, pyarrow.ArrowException) as error:
        raise DatasetError(f"{name} cannot be read: {_first_line(error)}; is it a complete Parquet file?") from None


def _first_line(error: BaseException) -> str:
    return str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__


def recognized(schema: Any, format: str) -> tuple[str, list[str]]:
    """What is read if no columns are chosen, and its columns: geometries, or else those that are known as boxes."""
    geometry = geometry_column(schema)
    if geometry is None:
        return "recognized", box_columns(schema.names, format)
    return "geometry", [geometry]


def form_of_files(
    files: Sequence[File],
    columns: Sequence[str] | None,
    ids: str | None,
    options: dict[str, Any],
    by: Sequence[str] = (),
) -> tuple[Form, Any]:
    """How boxes are read from files (which columns, and in which precision), and their coordinate reference system.

    Raises:
        DatasetError: if a file has no such columns; so for those that `by` names, too.
    """
    schemas = []
    for file in files:
        with opened(file.path) as parquet:
            schemas.append(parquet.schema_arrow)
    schema = schemas[0]
    kind, names = "chosen", list(columns or [])
    if not names:
        kind, names = recognized(schema, options["format"])
    if kind == "geometry":
        refuse_sizes(options["format"], files[0].path)
    if not names:
        raise DatasetError(
            f"{files[0].path} has no columns that are known as boxes: "
            f"{unknown_columns(schema.names, 'choose them by columns')}; {listed(schema.names)}"
        )
    if len(names) not in (1, 2, 4, 6):
        raise ValueError(f"columns are {len(names)} names; they must be 2, 4 or 6: min corner and then max corner")
    kind = "nested" if len(names) == 1 and kind != "geometry" else kind
    id_types = set()
    for file, other in zip(files, schemas):
        for name in [*names, *([ids] if ids is not None else []), *by]:
            number = other.names.count(name)
            if number != 1:
                fault = f"{number} columns {name!r}: rename all but one" if number else f"no column {name!r}"
                raise DatasetError(f"{file.path} has {fault}; {listed(other.names)}")
        if ids is not None:
            id_types.add(id_type_of(other.field(ids).type, f"{file.path}: column {ids}"))
    if len(id_types) > 1:
        raise DatasetError(f"column {ids} is of different types in the files: {', '.join(sorted(id_types))}")
    form = Form(
        columns=names,
        kind=kind,
        ids=ids,
        id_type=id_types.pop() if id_types else "int64",
        dtype="float64",
        **options,
    )
    form = form.in_precision_of(*(one.empty_table().select(form.names()) for one in schemas))
    return form, _crs_of(files, [_crs.of_geoparquet(one.metadata)[1] for one in schemas])


def _crs_of(files: Sequence[File], systems: list[Any]) -> Any:
    known = [(file.path, crs) for file, crs in zip(files, systems) if crs is not None]
    for path, crs in known:
        apart = _crs.difference(known[0][1], crs)
        if apart is not None:
            raise DatasetError(
                f"{known[0][0]} and {path} have different coordinate reference systems, {apart[0]} and {apart[1]}: "
                "convert one of them"
            )
    return known[0][1] if known else None


def id_type_of(kind: Any, where: str) -> str:
    """The type in which ids of an Arrow type are kept."""
    import pyarrow

    types = pyarrow.types
    if types.is_dictionary(kind):
        kind = kind.value_type
    if types.is_integer(kind):
        return "uint64" if kind == pyarrow.uint64() else "int64"
    if types.is_string(kind) or types.is_large_string(kind) or types.is_string_view(kind):
        return "large_string"
    raise DatasetError(f"{where} has ids of type {kind}; they must be whole numbers or text")


def chunks_of_files(files: Sequence[File], argument: int, rows: int) -> list[Chunk]:
    """Chunks of consecutive row groups. A chunk is complete as soon as it has `rows` rows."""
    chunks = []
    index = 0
    for number, file in enumerate(files):
        row = 0
        groups: list[int] = []
        waiting = 0
        for group, of_group in enumerate(file.rows):
            if groups and waiting + of_group > rows:
                chunks.append(Chunk(argument, number, groups, row, index, waiting))
                row, index, groups, waiting = row + waiting, index + waiting, [], 0
            groups.append(group)
            waiting += of_group
        if waiting:
            chunks.append(Chunk(argument, number, groups, row, index, waiting))
            index += waiting
    return chunks


def read_chunk(file: File, chunk: Chunk, form: Form, argument: str, rows: int) -> Iterator[Boxes]:
    """The boxes of a chunk, at most `rows` at a time.

    Raises:
        DatasetError: if the file is damaged, or not as it was.
        InvalidRowError: for the first box that is inverted or has a NaN.
    """
    import pyarrow

    done = 0
    try:
        with opened(file.path) as parquet:
            if _stamp(file.path) != file.stamp:
                raise DatasetError(f"{file.path} has changed since the run began: pass overwrite=True to start again")
            batches = parquet.iter_batches(
                batch_size=rows, row_groups=chunk.groups, columns=_leaves(form), use_threads=False
            )
            for batch in batches:
                yield form.read(
                    pyarrow.Table.from_batches([batch]), file.path, chunk.row + done, chunk.first + done, argument
                )
                done += len(batch)
    except (OSError, pyarrow.ArrowException) as error:
        if getattr(error, "errno", None) is not None and not os.path.exists(file.path):
            raise DatasetError(f"{file.path} is missing: it was there when the run began") from None
        raise DatasetError(
            f"{file.path} is damaged after row {chunk.row + done}: {_first_line(error)}; write it again"
        ) from None
    if done != chunk.rows:
        raise DatasetError(f"{file.path} has changed since the run began: pass overwrite=True to start again")


def sample_file(file: File, form: Form, argument: str, rows: int) -> Iterator[Boxes]:
    """The first boxes of each row group, about `rows` in all; invalid ones are left out."""
    import pyarrow

    if not sum(file.rows):
        return
    lenient = form._replace(missing="skip")
    row = 0
    with opened(file.path, 2**16) as parquet:
        for group, of_group in enumerate(file.rows):
            size = max(-(-rows * of_group // sum(file.rows)), 16)
            try:
                batches = parquet.iter_batches(
                    batch_size=size, row_groups=[group], columns=_leaves(form), use_threads=False
                )
                batch = next(batches, None)
                if batch is not None:
                    yield lenient.read(pyarrow.Table.from_batches([batch]), file.path, row, 0, argument)
            except (OSError, pyarrow.ArrowException, InvalidBoxError, DatasetError):
                pass  # reading the whole group reports it
            row += of_group


def _leaves(form: Form) -> list[str]:
    return form.names()
