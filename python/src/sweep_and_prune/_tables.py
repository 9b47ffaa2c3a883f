"""Reads boxes from files and writes pairs to files, for the command line."""

from __future__ import annotations

import csv
import gzip
import io
import json
import math
import os
import sys
from array import array
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext, suppress
from itertools import chain
from pathlib import Path
from typing import IO, Any, Protocol
from zipfile import BadZipFile

import click
import numpy as np
from numpy.typing import NDArray

from ._columns import EXACT, Column, read_column, side_by_side
from ._inputs import Raw, box_columns, unknown_columns
from ._output import output_file

_MISSING = {"", "na", "n/a", "nan", "null", "none", "."}
_BED = ["chrom", "start", "end", "name", "score", "strand"]
_ARROW = (".arrow", ".feather", ".ipc")
READABLE = ".csv, .tsv, .bed, .npy, .npz, .geojson, .json, .parquet, .arrow, .feather"
_BYTES = 8 * 7
"""Of memory for each number: the table, the boxes, and what the search keeps."""
_BYTES_OF_TEXT = 11
"""Of memory for each byte of text (measured: 400 MB for a million boxes in 36 MB)."""
WRITABLE = ("csv", "tsv", "npy", "parquet", "arrow")


_MOST_SAID = 500
_MOST_LISTED = 20


class FileError(click.ClickException):
    """What is wrong with a file, for people."""

    def show(self, file: IO[Any] | None = None) -> None:
        """Prints it, on one line that is not too long to read."""
        said = " ".join(self.message.split("\n"))
        if len(said) > _MOST_SAID:  # a name may be long; what is wrong is at the end
            said = f"{said[: _MOST_SAID // 2]} ... {said[-_MOST_SAID // 2 :]}"
        click.echo(f"sap: {said}", file or sys.stderr)


def printable(path: str) -> str:
    """A path as a message shows it, on one line."""
    return path if path.isprintable() else repr(path)


class Source:
    """A file with a box in each row."""

    closed: str | None = None
    """What the format says about the ends of boxes."""
    by: Sequence[str] = []
    """The columns that the format groups by."""
    is_bare = False
    """Whether the columns have no names in the file: the boxes are all of them."""

    def __init__(self, name: str, values: Any, labels: dict[str, Any] | None = None) -> None:
        self.name, self.values, self.labels = name, values, labels or {}

    def __len__(self) -> int:
        return len(self.values.array if isinstance(self.values, Raw) else self.values)

    @property
    def columns(self) -> list[str]:
        """The names of its columns, none for an array."""
        names = getattr(self.values, "column_names", getattr(self.values, "columns", []))
        return [*map(str, names), *self.labels]

    def boxes(self, columns: Sequence[str], format: str) -> Any:
        """The boxes, from columns with these names or else from those that are recognized."""
        if not columns and self.is_bare:
            columns = self.columns
        if not columns:
            if self.columns and not self.box_columns(format) and not self._are_boxes:
                way = unknown_columns(self.columns, "choose them by --columns", "--format {}")
                raise FileError(f"{self.name} has no columns that are known as boxes: {way}; {_listed(self.columns)}")
            return self.values
        read = [read_column(self._column(name), f"column {name}") for name in columns]
        return Raw(*side_by_side(read, columns, self.name))

    @property
    def is_text(self) -> bool:
        """Whether its values were text."""
        return isinstance(self.values, _Text)

    @property
    def _are_boxes(self) -> bool:
        return isinstance(self.values, (np.ndarray, Raw))

    def box_columns(self, format: str) -> list[str]:
        """The columns that are recognized as boxes."""
        if self.is_bare:
            return self.columns
        return [] if self._are_boxes else box_columns(self.columns, format)

    def group(self, name: str) -> Column:
        """The values of a column to group by; those of a file of text are text, and what is empty is missing."""
        if isinstance(self.values, _Text):
            cells = np.array(self.values.text(name), object)
            missing = cells == ""
            return Column(cells, missing if missing.any() else None, name=f"column {name}")
        return read_column(self._labels(name), f"column {name}")

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        return read_column(self._column(name), f"column {name}")

    def label(self, name: str) -> NDArray[Any]:
        """A column of any type, as it is written."""
        if isinstance(self.values, _Text):
            return np.array(self.values.text(name), object)
        values = self._labels(name)
        if getattr(values, "null_count", 0):  # as an array of NumPy, integers would become floating point
            values = values.to_pylist()
        return np.asarray(values, object if isinstance(values, list) else None)

    def _labels(self, name: str) -> Any:
        return self.labels[name] if name in self.labels else self._column(name)

    def _column(self, name: str) -> Any:
        number = self.columns.count(name)
        if number != 1 or not hasattr(self.values, "columns"):
            fault = f"{number} columns {name!r}: rename all but one" if number > 1 else f"no column {name!r}"
            raise FileError(f"{self.name} has {fault}; {_listed(self.columns)}")
        return self.values[name]

    def place(self, index: int) -> str:
        """Where a row is."""
        if isinstance(self.values, _Text):
            return f"{self.name}, line {self.values.line(index)}"
        return f"{self.name}, row {index} (the first is 0)"


def _listed(columns: list[str]) -> str:
    more = f" and {len(columns) - _MOST_LISTED:,} more" if len(columns) > _MOST_LISTED else ""
    return f"its columns are {', '.join(columns[:_MOST_LISTED])}{more}" if columns else "it has no columns with names"


class _Text:
    """A table of text, whose columns become numbers when they are used."""

    def __init__(self, name: str, columns: list[str], cells: list[str], lines: Sequence[int]) -> None:
        """`cells` are those of all rows, one row after the other."""
        self.name, self.columns, self._cells, self._lines = name, columns, cells, lines

    def __len__(self) -> int:
        return len(self._lines)

    def line(self, index: int) -> int:
        return self._lines[index]

    def text(self, name: str) -> Sequence[str]:
        number = self.columns.count(name)
        if number != 1:
            fault = f"{number} columns {name!r}: rename all but one" if number > 1 else f"no column {name!r}"
            raise FileError(f"{self.name} has {fault}; {_listed(self.columns)}")
        return self._cells[self.columns.index(name) :: len(self.columns)]

    def __getitem__(self, name: str) -> NDArray[Any]:
        cells = self.text(name)
        if _is_plain("".join(cells)):
            with suppress(ValueError, OverflowError):
                return np.array(list(map(int, cells)), np.int64)
            with suppress(ValueError):
                floats = np.array(list(map(float, cells)))
                if not (np.abs(floats) >= EXACT).any():
                    return floats
        numbers = [self._number(cell, name, index) for index, cell in enumerate(cells)]
        has_large = any(type(number) is int and abs(number) > EXACT for number in numbers)
        return np.array(numbers, object if has_large else np.float64)

    def _number(self, cell: str, name: str, index: int) -> float:
        if cell.strip().lower() in _MISSING:
            return math.nan
        number = _number(cell)
        if number is None or (number in (math.inf, -math.inf) and "inf" not in cell.lower()):
            what = "is not a number" if number is None else "is too large a number"
            shown = cell if len(cell) <= 60 else f"{cell[:57]}..."
            raise FileError(f"{self.name}, line {self.line(index)}, column {name}: {shown!r} {what}")
        return number


def _is_plain(text: str) -> bool:
    """Whether Python reads numbers as others do: not as in 1_000, nor with digits of other scripts."""
    return "_" not in text and text.isascii()


def _number(cell: str) -> float | None:
    """A number as it is written, or None if it is none."""
    if _is_plain(cell):
        for kind in (int, float):
            with suppress(ValueError):
                return kind(cell)
    return None


def read(path: str) -> Source:
    """Reads a file; its name tells the format, and `-` is CSV from standard input."""
    if path == "-":
        return _read_standard_input()
    suffix = Path(path.removesuffix(".gz")).suffix.lower()
    try:
        if suffix in (".csv", ".tsv", ".txt", ".bed"):
            # Of what is compressed, a box takes about a third.
            size = os.path.getsize(path) * (3 if path.endswith(".gz") else 1)
            check_memory(path, f"{size / 1e9:.1f} GB of boxes", size * _BYTES_OF_TEXT)
            opened: Any = gzip.open if path.endswith(".gz") else open
            with opened(path, "rt", encoding="utf-8-sig", newline="") as file:
                return _read_text(path, file, suffix)
        if suffix in (".npy", ".npz"):
            return Source(path, _read_numpy(path))
        if suffix in (".geojson", ".json"):
            return _read_geojson(path)
        if suffix in (".parquet", ".geoparquet", *_ARROW):
            return _read_arrow(path, suffix)
    except OSError as error:
        raise FileError(f"{path} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise FileError(f"{path} is not text in UTF-8") from None
    except (FileError, MemoryError):
        raise
    except Exception as error:  # what readers of other formats raise for damaged files is not documented
        raise FileError(f"{path} cannot be read, it seems damaged: {error}") from None
    raise FileError(f"{path} has an unknown ending: the known ones are {READABLE}")


def _read_standard_input() -> Source:
    if sys.stdin is None:
        raise FileError("standard input is closed")
    try:
        with open(sys.stdin.fileno(), encoding="utf-8-sig", newline="", closefd=False) as file:
            return _read_text("standard input", file, "")
    except OSError as error:
        raise FileError(f"standard input cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise FileError("standard input is not text in UTF-8") from None


def _read_text(name: str, file: IO[str], suffix: str) -> Source:
    delimiter, text = "\t", iter(file)
    is_bed = suffix == ".bed"
    if suffix not in (".tsv", ".bed"):
        first = next(text, "")
        delimiter = max(",;\t", key=first.count)
        if delimiter not in first and " " in first.strip():
            delimiter = " "
        text = chain([first] if first else [], text)
    # BED has no quotes: one in a name is a part of it.
    quotes: Any = {"quoting": csv.QUOTE_NONE} if is_bed else {"strict": True}
    reader = csv.reader(text, delimiter=delimiter, skipinitialspace=True, **quotes)
    begun = 1

    def rows_of_file() -> Iterator[list[str]]:
        nonlocal begun
        for row in reader:
            begun = reader.line_num + 1
            if row and not (is_bed and _is_comment(row)):
                yield row

    rows = rows_of_file()
    # All cells are in one list: with a list for each row, reading takes twice as long.
    cells: list[str] = []
    lines = array("Q")
    try:
        first_row = next(rows, [])
        is_bare = not is_bed and all(_number(cell) is not None for cell in first_row)
        if is_bed:
            columns = _BED[: len(first_row) or 3]
        else:
            columns = _bare_columns(name, first_row) if is_bare else [cell.strip() for cell in first_row]
        for row in chain([first_row] if first_row and (is_bed or is_bare) else [], rows):
            if is_bed and len(row) < 3:
                raise FileError(f"{name}, line {reader.line_num}: chrom, start and end are expected, separated by tabs")
            if is_bed:  # only these three are in each row
                row += [""] * (len(columns) - len(row))
            if len(row) < len(columns) or (not is_bed and any(row[len(columns) :])):
                raise FileError(
                    f"{name}, line {reader.line_num}: it has {len(row)} columns, where {len(columns)} are expected"
                )
            cells += row[: len(columns)]
            lines.append(reader.line_num)
    except csv.Error as error:
        raise FileError(f"{name}, line {begun}: {_fault(error)}") from None
    table = _Text(name, columns, cells, lines)
    if is_bed:
        source = Source(name, table)
        source.closed, source.by = "left", ["chrom"]
        return source
    source = Source(name, table)
    source.is_bare = is_bare
    return source


def _fault(error: csv.Error) -> str:
    """What is wrong with a row of a file of text."""
    if "unexpected end" in str(error) or "field larger" in str(error):
        return "a quote opens in this row and is not closed"
    return f"it has a quote in the wrong place ({error})" if "expected after" in str(error) else str(error)


def _is_comment(row: list[str]) -> bool:
    """Whether a row of a BED file has no interval."""
    return row[0].split(" ")[0].startswith(("#", "track", "browser"))


def _bare_columns(name: str, row: list[str]) -> list[str]:
    """Names for the columns of a file without a header, whose first row this is."""
    if not row:
        raise FileError(f"{name} is empty")
    corners = {2: "min0 max0", 4: "min0 min1 max0 max1", 6: "min0 min1 min2 max0 max1 max2"}
    if len(row) not in corners:
        raise FileError(f"{name} has no header and {len(row)} columns; boxes have 2, 4 or 6")
    return corners[len(row)].split()


def _read_numpy(path: str) -> NDArray[Any]:
    try:
        with open(path, "rb") as file:  # NumPy leaves a damaged archive open that it opened
            if file.read(2) == b"PK":
                file.seek(0)
                with np.load(file, allow_pickle=False) as arrays:
                    return _boxes_of_archive(path, arrays)
        loaded = np.load(path, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, BadZipFile) as error:
        raise FileError(f"{path} is not an array of NumPy: {error}") from None
    check_memory(path, f"{loaded.shape[0] if loaded.ndim else 0} boxes", loaded.size * _BYTES)
    return np.asarray(loaded)


def _boxes_of_archive(path: str, arrays: Any) -> NDArray[Any]:
    names = arrays.files
    if "boxes" not in names and len(names) != 1:
        raise FileError(f"{path} has the arrays {', '.join(names)}: one of them must be called boxes")
    return np.asarray(arrays["boxes" if "boxes" in names else names[0]])


def _read_geojson(path: str) -> Source:
    with open(path, encoding="utf-8") as file:
        try:
            document = json.load(file)
        except json.JSONDecodeError as error:
            raise FileError(f"{path}, line {error.lineno}: {error.msg}") from None
    features = document.get("features") if isinstance(document, dict) else None
    if not isinstance(features, list):
        raise FileError(f"{path} is not a FeatureCollection of GeoJSON")
    bounds = []
    for index, feature in enumerate(features):
        try:
            bounds.append(_bounds(feature.get("geometry")))
        except (AttributeError, IndexError, TypeError, ValueError):
            raise FileError(f"{path}, feature {index} (the first is 0) is not valid GeoJSON") from None
    names = ["minx", "miny", "maxx", "maxy"]
    ends = [read_column([of_shape[end] for of_shape in bounds], name) for end, name in enumerate(names)]
    boxes = Raw(*side_by_side(ends, names, path))
    properties = [feature.get("properties") or {} for feature in features]
    labels = {
        name: np.array([row.get(name) for row in properties], object)
        for name in sorted({name for row in properties for name in row})
    }
    labels.setdefault("id", np.array([feature.get("id") for feature in features], object))
    return Source(path, boxes, labels)


def _bounds(geometry: Any) -> tuple[float, float, float, float]:
    points = list(_points(geometry)) if geometry else []
    if not points:
        return (math.nan,) * 4
    x, y = zip(*points)
    if any(type(number) is bool or number != number for number in chain(x, y)):
        raise ValueError("coordinates are numbers")
    return min(x), min(y), max(x), max(y)


def _points(geometry: Any) -> Iterator[tuple[float, float]]:
    for part in geometry.get("geometries", []):
        yield from _points(part)
    waiting = [geometry.get("coordinates") or []]
    while waiting:
        item = waiting.pop()
        if not isinstance(item, list):
            raise TypeError("coordinates are lists")
        if item and isinstance(item[0], (int, float)):
            yield item[0], item[1]
        else:
            waiting.extend(item)


def _read_arrow(path: str, suffix: str) -> Source:
    arrow = _pyarrow(path)
    try:
        if suffix in _ARROW:
            import pyarrow.feather

            table = pyarrow.feather.read_table(path)
        else:
            import pyarrow.parquet

            parquet = pyarrow.parquet.ParquetFile(path)
            rows = parquet.metadata.num_rows
            check_memory(path, f"{rows} boxes", 4 * rows * _BYTES)
            table = parquet.read()
    except arrow.ArrowInvalid as error:
        raise FileError(f"{path} cannot be read: {error}") from None
    geo = (table.schema.metadata or {}).get(b"geo")
    if geo is not None and "bbox" not in table.column_names:
        try:
            import geopandas
        except ImportError:
            raise FileError(f"{path} has geometries: pip install 'sweep-and-prune[join]'") from None
        column = json.loads(geo)["primary_column"]
        others = {name: table[name] for name in table.column_names if name != column}
        if arrow.types.is_binary(table[column].type) and b"ARROW:extension:name" not in (
            table.schema.field(column).metadata or {}
        ):
            # A plain file, such as those of DuckDB, says in `geo` alone that this is well-known binary.
            return Source(path, _bounds_of_binary(path, table[column]), others)
        shapes = geopandas.GeoDataFrame.from_arrow(table.select([column])).geometry
        return Source(path, shapes.bounds.to_numpy(), others)
    return Source(path, table)


def _bounds_of_binary(path: str, column: Any) -> NDArray[Any]:
    import shapely

    values = np.array(column.to_pylist(), object)
    try:
        return np.asarray(shapely.bounds(shapely.from_wkb(values)))
    except shapely.errors.ShapelyError as error:
        raise FileError(f"{path} has a geometry that is not valid: {error}") from None


def _pyarrow(path: str) -> Any:
    try:
        import pyarrow
    except ImportError:
        raise FileError(f"{path} needs pyarrow: pip install 'sweep-and-prune[files]'") from None
    return pyarrow


def check_memory(path: str, contents: str, needed: int) -> None:
    """Refuses a file whose boxes cannot be searched in this machine's memory, of which they need so many bytes."""
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return
    if needed > memory:
        gigabytes = f"{needed / 1e9:.0f} GB of memory, and this machine has {memory / 1e9:.0f} GB"
        is_parquet = path.endswith((".parquet", ".geoparquet"))
        way = "--memory-limit searches them" if is_parquet else "a Parquet file can be searched"
        raise FileError(f"{path} has {contents}; searching them takes about {gigabytes}; {way} from disk")


class Writer(Protocol):
    """Takes pairs, chunk by chunk."""

    def write(self, pairs: Sequence[NDArray[Any]]) -> None: ...
    def close(self) -> None: ...


class _TextWriter:
    def __init__(self, file: IO[bytes], delimiter: str, names: tuple[str, str]) -> None:
        self._file, self._delimiter = file, delimiter
        self._file.write(f"{names[0]}{delimiter}{names[1]}\n".encode())

    def write(self, pairs: Sequence[NDArray[Any]]) -> None:
        a, b = (column.tolist() for column in pairs)
        delimiter = self._delimiter
        if pairs[0].dtype.kind in "iu" and pairs[1].dtype.kind in "iu":
            lines = [f"{i}{delimiter}{j}\n" for i, j in zip(a, b)]
        else:
            lines = [f"{_quoted(i, delimiter)}{delimiter}{_quoted(j, delimiter)}\n" for i, j in zip(a, b)]
        self._file.write("".join(lines).encode())

    def close(self) -> None:
        self._file.flush()


def _quoted(value: object, delimiter: str) -> str:
    text = "" if value is None else str(value)
    if delimiter in text or '"' in text or "\n" in text or "\r" in text:
        return '"' + text.replace('"', '""') + '"'
    return text


class _NumpyWriter:
    def __init__(self, file: IO[bytes], count: int) -> None:
        self._file = file
        header = {"descr": "<i8", "fortran_order": False, "shape": (count, 2)}
        np.lib.format.write_array_header_1_0(file, header)

    def write(self, pairs: Sequence[NDArray[Any]]) -> None:
        try:
            rows = np.stack(pairs, axis=1).astype("<i8", casting="same_kind")
        except TypeError:
            raise FileError(
                "an array of NumPy holds whole numbers only: leave out --id, or write another format"
            ) from None
        self._file.write(rows.tobytes())

    def close(self) -> None:
        self._file.flush()


class _ArrowWriter:
    def __init__(self, file: IO[bytes], kind: str, names: tuple[str, str], is_pipe: bool) -> None:
        self._arrow = _pyarrow(f"--to {kind}")
        self._file, self._kind, self._names, self._is_pipe = file, kind, names, is_pipe
        self._writer: Any = None

    def write(self, pairs: Sequence[NDArray[Any]]) -> None:
        table = self._arrow.table([self._arrow.array(column) for column in pairs], names=list(self._names))
        if self._writer is None:
            self._writer = self._open(table.schema)
        self._writer.write_table(table.cast(self._writer.schema if self._kind == "parquet" else table.schema))

    def _open(self, schema: Any) -> Any:
        if self._kind == "parquet":
            import pyarrow.parquet

            return pyarrow.parquet.ParquetWriter(self._file, schema)
        # A file of Arrow needs to seek; a pipe takes a stream.
        opened = self._arrow.ipc.new_stream if self._is_pipe else self._arrow.ipc.new_file
        return opened(self._file, schema)

    def close(self) -> None:
        if self._writer is None:
            integer = self._arrow.int64()
            self._writer = self._open(self._arrow.schema([(name, integer) for name in self._names]))
        self._writer.close()


@contextmanager
def writer(path: str | None, kind: str, count: int, names: tuple[str, str]) -> Iterator[Writer]:
    """Opens a file for so many pairs, or standard output. A file that could not be completed is removed."""
    if path is None:
        with _standard_output() as file:
            yield from _closing(file, kind, count, names, True)
        return
    try:
        with output_file(path) as (file, is_stream):
            yield from _closing(file, kind, count, names, is_stream)
    except BrokenPipeError:
        raise  # the program that reads a named pipe ended
    except OSError as error:
        raise FileError(f"{printable(path)} cannot be written: {error.strerror or error}") from None


def _standard_output() -> AbstractContextManager[IO[bytes]]:
    """Standard output with a buffer. With PYTHONUNBUFFERED it has none, and writes a part of what it is given."""
    output = sys.stdout.buffer
    return open(output.fileno(), "wb", closefd=False) if isinstance(output, io.RawIOBase) else nullcontext(output)


def _closing(file: IO[bytes], kind: str, count: int, names: tuple[str, str], is_pipe: bool) -> Iterator[Writer]:
    made: Writer
    if kind == "npy":
        made = _NumpyWriter(file, count)
    elif kind in ("csv", "tsv"):
        made = _TextWriter(file, "," if kind == "csv" else "\t", names)
    else:
        made = _ArrowWriter(file, kind, names, is_pipe)
    yield made
    made.close()


def kind_of(path: str | None, kind: str | None) -> str:
    """The format to write: as told, or as the name of the file tells, or CSV."""
    if kind is not None:
        return kind
    if path is None:
        return "csv"
    suffix = Path(path).suffix.lower()
    known = "arrow" if suffix in _ARROW else suffix[1:]
    if known not in WRITABLE:
        raise FileError(f"{path} has an unknown ending: use .csv, .tsv, .npy, .parquet or .arrow, or pass --to")
    return known
