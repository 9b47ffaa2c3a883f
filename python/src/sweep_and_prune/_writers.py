"""Writes rows of results to files, for the command line."""

from __future__ import annotations

import io
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from pathlib import Path
from typing import IO, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from ._file_error import FileError, printable
from ._output import output_file

WRITABLE = ("csv", "tsv", "bed", "npy", "parquet", "arrow")
ARROW_ENDINGS = (".arrow", ".feather", ".ipc")


class Writer(Protocol):
    """Takes columns of results, chunk by chunk."""

    def write(self, columns: Sequence[NDArray[Any]]) -> None: ...
    def close(self) -> None: ...


class _TextWriter:
    """Rows of cells: with a header and quotes where they are needed, or as in .bed without both."""

    def __init__(self, file: IO[bytes], kind: str, names: Sequence[str]) -> None:
        self._file, self._delimiter = file, "," if kind == "csv" else "\t"
        self._cell = {"csv": _cell_of_csv, "tsv": _cell_of_tsv, "bed": _cell_of_bed}[kind]
        if kind != "bed":
            self._file.write((self._delimiter.join(map(self._cell, names)) + "\n").encode())

    def write(self, columns: Sequence[NDArray[Any]]) -> None:
        delimiter, cell = self._delimiter, self._cell
        lists = [texts_of_times(column) if column.dtype.kind in "mM" else column.tolist() for column in columns]
        if len(lists) == 2 and all(column.dtype.kind in "iu" for column in columns):
            lines = [f"{i}{delimiter}{j}\n" for i, j in zip(*lists)]
        else:
            lines = [delimiter.join(map(cell, row)) + "\n" for row in zip(*lists)]
        self._file.write("".join(lines).encode())

    def close(self) -> None:
        self._file.flush()


def texts_of_times(times: NDArray[Any]) -> list[str | None]:
    """Times as text, as Python writes them; it has no nanoseconds of its own, and no year above 9999."""
    unit = np.datetime_data(times.dtype)[0]
    if unit == "ns":
        micro, nano = np.divmod(times.astype(np.int64), 1000)
        whole = micro.astype(f"{times.dtype.kind}8[us]").tolist()
        texts = [
            f"{value}{'' if '.' in str(value) else '.000000'}{rest:03}" if rest else str(value)
            for value, rest in zip(whole, nano.tolist())
        ]
    else:
        counts = zip(times, times.tolist())
        texts = [(str(time) if isinstance(value, int) else str(value)).replace("T", " ") for time, value in counts]
    return [None if is_missing else text for text, is_missing in zip(texts, np.isnat(times).tolist())]


def _cell_of_csv(value: object) -> str:
    text = _text_of(value)
    return _quoted(text) if "," in text or '"' in text or "\n" in text or "\r" in text else text


def _cell_of_tsv(value: object) -> str:
    """A quote is one of text, unless it is the first character: programs that know no quotes read most rows, too."""
    text = _text_of(value)
    return _quoted(text) if "\t" in text or text.startswith('"') or "\n" in text or "\r" in text else text


def _cell_of_bed(value: object) -> str:
    text = _text_of(value)
    if "\t" in text or "\n" in text or "\r" in text:
        raise FileError(f"--to bed cannot hold a cell with a tab or a line end: {printable(text[:60])!r}; write tsv")
    return text or "."


def _text_of(value: object) -> str:
    return "" if value is None or value != value else str(value)


def _quoted(text: str) -> str:
    return '"' + text.replace('"', '""') + '"'


class _NumpyWriter:
    def __init__(self, file: IO[bytes], count: int, width: int) -> None:
        self._file, self._shape = file, (count, width)
        self._has_header = False

    def write(self, columns: Sequence[NDArray[Any]]) -> None:
        if any(column.dtype.kind not in "iu" for column in columns):
            raise FileError("an array of NumPy holds whole numbers only: write another format")
        if any(column.dtype.kind == "u" and int(column.max(initial=0)) >= 2**63 for column in columns):
            raise FileError("an array of NumPy holds numbers below 2^63 only: write another format")
        rows = np.stack([column.astype("<i8") for column in columns], axis=1)
        self._write_header()
        self._file.write(rows.tobytes())

    def _write_header(self) -> None:
        if not self._has_header:
            header = {"descr": "<i8", "fortran_order": False, "shape": self._shape}
            np.lib.format.write_array_header_1_0(self._file, header)
            self._has_header = True

    def close(self) -> None:
        self._write_header()
        self._file.flush()


class _ArrowWriter:
    def __init__(
        self, file: IO[bytes], kind: str, names: Sequence[str], is_pipe: bool, examples: Sequence[NDArray[Any]] | None
    ) -> None:
        self._arrow = pyarrow_for(f"--to {kind}")
        self._file, self._kind, self._names, self._is_pipe = file, kind, names, is_pipe
        self._writer: Any = None
        # A chunk whose values are all missing does not tell the type of its column.
        self._types = [None for _ in names]
        if examples is not None:
            self._types = [array.type for array in self._arrays(examples)]

    def _arrays(self, columns: Sequence[NDArray[Any]]) -> list[Any]:
        try:
            return [self._arrow.array(column, kind) for column, kind in zip(columns, self._types)]
        except self._arrow.ArrowException as error:
            raise FileError(f"--to {self._kind} cannot hold a column: {error}; write csv") from None

    def write(self, columns: Sequence[NDArray[Any]]) -> None:
        arrays = self._arrays(columns)
        table = self._arrow.table(arrays, names=list(self._names))
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
            types = [kind or self._arrow.int64() for kind in self._types]
            self._writer = self._open(self._arrow.schema(list(zip(self._names, types))))
        self._writer.close()


def pyarrow_for(what: str) -> Any:
    """The library, or an error that says what needs it."""
    try:
        import pyarrow
    except ImportError:
        raise FileError(f"{what} needs pyarrow: pip install 'sweep-and-prune[files]'") from None
    return pyarrow


@contextmanager
def writer(
    path: str | None, kind: str, count: int, names: Sequence[str], examples: Sequence[NDArray[Any]] | None = None
) -> Iterator[Writer]:
    """Opens a file for this many rows, or standard output. A file that could not be completed is removed.

    Args:
        path: the name of the file; None for standard output.
        kind: one of `WRITABLE`.
        count: the number of rows.
        names: those of the columns.
        examples: all values of which each column has some, where rows are written chunk by chunk.
    """
    if path is None:
        with _standard_output() as file:
            yield from _closing(file, kind, count, names, True, examples)
        return
    try:
        with output_file(path) as (file, is_stream):
            yield from _closing(file, kind, count, names, is_stream, examples)
    except BrokenPipeError:
        raise  # the program that reads a named pipe ended
    except OSError as error:
        raise FileError(f"{printable(path)} cannot be written: {error.strerror or error}") from None


def _standard_output() -> AbstractContextManager[IO[bytes]]:
    """Standard output with a buffer. With PYTHONUNBUFFERED it has none, and writes a part of what it is given."""
    output = sys.stdout.buffer
    return open(output.fileno(), "wb", closefd=False) if isinstance(output, io.RawIOBase) else nullcontext(output)


def _closing(
    file: IO[bytes],
    kind: str,
    count: int,
    names: Sequence[str],
    is_pipe: bool,
    examples: Sequence[NDArray[Any]] | None,
) -> Iterator[Writer]:
    made: Writer
    if kind == "npy":
        made = _NumpyWriter(file, count, len(names))
    elif kind in ("csv", "tsv", "bed"):
        made = _TextWriter(file, kind, names)
    else:
        made = _ArrowWriter(file, kind, names, is_pipe, examples)
    yield made
    made.close()


def kind_of(path: str | None, kind: str | None) -> str:
    """The format to write: as told, or as the name of the file tells, or CSV."""
    if kind is not None:
        return kind
    if path is None:
        return "csv"
    suffix = Path(path).suffix.lower()
    known = "arrow" if suffix in ARROW_ENDINGS else suffix[1:]
    if known not in WRITABLE:
        raise FileError(f"{path} has an unknown ending: use .csv, .tsv, .bed, .npy, .parquet or .arrow, or pass --to")
    return known
