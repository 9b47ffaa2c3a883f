"""Reads files of text: tables with a header or without one, and the formats of genomics.

Coordinates become those of BED here, and nowhere else: from 0, without the end.
"""

from __future__ import annotations

import csv
import math
import re
import sys
from array import array
from codecs import BOM_UTF8
from collections.abc import Iterator, Sequence
from contextlib import suppress
from io import BytesIO, TextIOWrapper
from itertools import chain
from typing import IO, Any, NamedTuple
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from ._columns import EXACT, Column, read_column
from ._file_error import FileError
from ._inputs import FORMATS, box_columns, listed
from ._native import read_bed

_MISSING = {"", "na", "n/a", "nan", "null", "none", "."}
_CORNERS = (2, 4, 6)
_PLAIN_NUMBER = re.compile(r"\s*-?(0|[1-9][0-9]*)(\.[0-9]+)?\s*")
"""A number that is no name: not as 007 or 1e5 may be."""
_OF_GTF = re.compile(r'\s*([^\s;"]+)\s+(?:"([^"]*)"|([^;"]*?))\s*(?:;|$)')
_OF_GFF3 = re.compile(r"\s*([^;=]+)=([^;]*)")
BED_LIKE = ("bed", "narrowpeak", "broadpeak", "bedgraph")


class Format(NamedTuple):
    """A format of genomics: lines of fixed columns, separated by tabs, without a header or quotes."""

    columns: list[str]
    least: int
    """How many columns each line has at least."""
    starts_at_one: bool = False
    """Whether the first position is 1, and ends belong to intervals."""
    attributes: str = ""
    """How the last column names more values: as in GTF or as in GFF3."""


_BED = ["chrom", "start", "end", "name", "score", "strand", "thickStart", "thickEnd", "itemRgb", "blockCount"]
_BED += ["blockSizes", "blockStarts"]
_PEAK = [*_BED[:6], "signalValue", "pValue", "qValue"]
_GENES = ["chrom", "source", "feature", "start", "end", "score", "strand", "frame", "attributes"]
GENOMIC = {
    "bed": Format(_BED, 3),
    "narrowpeak": Format([*_PEAK, "peak"], 3),
    "broadpeak": Format(_PEAK, 3),
    "bedgraph": Format([*_BED[:3], "value"], 3),
    "gtf": Format(_GENES, 8, True, "gtf"),
    "gff3": Format(_GENES, 8, True, "gff3"),
    "vcf": Format(["chrom", "pos", "id", "ref", "alt", "qual", "filter", "info"], 5, True),
}


class Text:
    """A table of text, whose columns become numbers when they are used."""

    def __init__(self, name: str, columns: list[str], cells: list[str], lines: Sequence[int]) -> None:
        """`cells` are those of all rows, one row after the other."""
        self.name, self.columns, self._cells, self._lines = name, columns, cells, lines
        self.format: Format | None = None

    def __len__(self) -> int:
        return len(self._lines)

    def line(self, index: int) -> int:
        """The line of the file in which a row ends."""
        return self._lines[index]

    def text(self, name: str) -> Sequence[str]:
        """The cells of a column, as they are in the file."""
        if self.columns.count(name) == 0 and self.format is not None and self.format.attributes:
            return [_attribute(cell, name, self.format.attributes) for cell in self.text("attributes")]
        return self._cells[self.place(name) :: len(self.columns)]

    def place(self, name: str) -> int:
        """Which column has a name."""
        number = self.columns.count(name)
        if number != 1:
            fault = f"{number} columns {name!r}: rename all but one" if number > 1 else f"no column {name!r}"
            raise FileError(f"{self.name} has {fault}; {listed(self.columns)}")
        return self.columns.index(name)

    def group(self, name: str) -> Column:
        """The values of a column to group by, which are text; what is empty is missing."""
        cells = np.array(self.text(name), object)
        missing = cells == ""
        return Column(cells, missing if missing.any() else None, name=f"column {name}")

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        return read_column(self[name], f"column {name}")

    def label(self, name: str) -> Any:
        """A column as it is written."""
        return np.array(self.text(name), object)

    def __getitem__(self, name: str) -> NDArray[Any]:
        numbers = self._numbers(name)
        return numbers - 1 if self.format is not None and self.format.starts_at_one and name == "start" else numbers

    def are_plain_numbers(self, name: str) -> bool:
        """Whether all values of a column are numbers that are no names, and some are there."""
        present = [cell for cell in self.text(name) if cell]
        return bool(present) and all(map(_PLAIN_NUMBER.fullmatch, present))

    def _numbers(self, name: str) -> NDArray[Any]:
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
        found = number(cell)
        if found is None or (found in (math.inf, -math.inf) and "inf" not in cell.lower()):
            what = "is not a number" if found is None else "is too large a number"
            shown = cell if len(cell) <= 60 else f"{cell[:57]}..."
            # The formats of genomics have no header, but tables are saved under their names.
            way = ": is this a header? Remove the line" if self.format is not None and index == 0 else ""
            raise FileError(f"{self.name}, line {self.line(index)}, column {name}: {shown!r} {what}{way}")
        return found


class Lines(Text):
    """A table of text of which only the intervals were read; other cells are when they are asked for."""

    def __init__(self, name: str, columns: list[str], data: bytes, found: Any, before: int = 0) -> None:
        """`found` is what `read_bed` returned for `data`, and `before` the number of lines before it in the file."""
        self._data, self._before = data, before
        self._offsets, self.corners, self._codes, self._names = found
        super().__init__(name, columns, [], self._offsets)

    def line(self, index: int) -> int:
        """The line of the file that has a row."""
        return self._before + self._data.count(b"\n", 0, int(self._offsets[index])) + 1

    def text(self, name: str) -> Sequence[str]:
        """The cells of a column, as they are in the file."""
        found: list[str] = self.cells(name)[np.arange(len(self))].tolist()
        return found

    def label(self, name: str) -> Any:
        """A column as it is written, whose cells are read when they are asked for."""
        return self.cells(name)

    def cells(self, name: str) -> Cells:
        """A column whose cells are read when they are asked for."""
        return Cells(self._data, self._offsets, self.place(name))

    def __getitem__(self, name: str) -> NDArray[Any]:
        known = {"start": 0, "end": 1}
        return self.corners[:, known[name]] if name in known else super().__getitem__(name)

    def are_plain_numbers(self, name: str) -> bool:
        if name != "chrom":
            return super().are_plain_numbers(name)
        return len(self) > 0 and all(map(_PLAIN_NUMBER.fullmatch, self._names))

    def group(self, name: str) -> Column:
        if name != "chrom":
            return super().group(name)
        return Column(np.array(self._names, object), name=f"column {name}", codes=self._codes)

    def group_of_numbers(self, name: str) -> Column:
        if name != "chrom":
            return super().group_of_numbers(name)
        table = Text(
            self.name,
            [name],
            self._names,
            [self.line(int(np.argmax(self._codes == code))) for code in range(len(self._names))],
        )
        return table.group_of_numbers(name)._replace(codes=self._codes)


class Cells:
    """The cells of a column of a table of text."""

    def __init__(self, data: bytes, offsets: NDArray[np.int64], place: int) -> None:
        self._data, self._offsets, self._place = data, offsets, place

    def __getitem__(self, rows: NDArray[Any]) -> NDArray[Any]:
        """The cells of some rows."""
        data, place = self._data, self._place
        cells = np.empty(len(rows), object)
        for at, offset in enumerate(self._offsets[rows].tolist()):
            end = data.find(b"\n", offset)
            row = data[offset : end if end >= 0 else len(data)].rstrip(b"\r").split(b"\t", place + 1)
            cells[at] = row[place].decode() if place < len(row) else ""
        return cells


def _attribute(cell: str, name: str, form: str) -> str:
    """A value that the last column of GTF or GFF3 names; empty if it does not."""
    pattern = _OF_GFF3 if form == "gff3" else _OF_GTF
    for found in pattern.finditer(cell):
        if found[1] == name:
            return unquote(found[2].strip()) if form == "gff3" else found[2] if found[2] is not None else found[3]
    return ""


def _is_plain(text: str) -> bool:
    """Whether Python reads numbers as others do: not as in 1_000, nor with digits of other scripts."""
    return "_" not in text and text.isascii()


def number(cell: str) -> float | None:
    """A number as it is written, or None if it is none."""
    if _is_plain(cell):
        for kind in (int, float):
            with suppress(ValueError):
                return kind(cell)
    return None


def read_genomic(name: str, data: bytes, kind: str) -> Text:
    """A file of one of the formats of genomics.

    Raises:
        UnicodeDecodeError: if it is not text in UTF-8.
    """
    return _part_of_genomic(name, data.removeprefix(BOM_UTF8), kind, [], 0)


def genomic_parts(name: str, file: IO[bytes], kind: str, size: int) -> Iterator[Text]:
    """A file of one of the formats of genomics, about `size` bytes at a time; all parts have the same columns.

    Raises:
        UnicodeDecodeError: if it is not text in UTF-8.
    """
    columns: list[str] = []
    before = 0
    data = file.read(size).removeprefix(BOM_UTF8)
    while True:
        more = file.read(size)
        end = data.rfind(b"\n") + 1 if more else len(data)
        if end or not more:
            table = _part_of_genomic(name, data[:end], kind, columns, before)
            if len(table) or not more:
                columns = table.columns
                yield table
            lines = data[:end]
            if not more or (b"##FASTA" in lines and not isinstance(table, Lines) and _has_sequences(lines)):
                return
            before += lines.count(b"\n") + lines.count(b"\r") - lines.count(b"\r\n")
        data = data[end:] + more


def _has_sequences(lines: bytes) -> bool:
    return any(line.startswith(b"##FASTA") for line in lines.splitlines())


def _part_of_genomic(name: str, data: bytes, kind: str, columns: list[str], before: int) -> Text:
    """Lines of such a file, after `before` others. Without `columns`, the first line tells how many there are."""
    form = GENOMIC[kind]
    found = read_bed(data) if kind in BED_LIKE else None
    if found is not None and len(found[0]):
        first = int(found[0][0])
        cells = data[first : data.find(b"\n", first) if b"\n" in data[first:] else len(data)].count(b"\t") + 1
        table: Text = Lines(name, columns or form.columns[:cells], data, found, before)
        table.format = form
        return table
    with TextIOWrapper(BytesIO(data), "utf-8", newline="") as file:
        return _read_genomic(name, file, kind, columns, before)


def _read_genomic(name: str, file: IO[str], kind: str, columns: Sequence[str] = (), before: int = 0) -> Text:
    form = GENOMIC[kind]
    cells: list[str] = []
    lines = array("Q")
    columns = [form.columns[0], "pos", *columns[3:]] if kind == "vcf" and columns else list(columns)
    for line, text in enumerate(file, before + 1):
        text = text.rstrip("\r\n")
        if text.startswith("##FASTA"):
            break  # what follows in GFF3 are sequences
        if not text or text.startswith("#") or re.match(r"(track|browser)( |$)", text):
            continue
        row = text.split("\t")
        if len(row) < form.least:
            *first, last = form.columns[: form.least]
            raise FileError(f"{name}, line {line}: {', '.join(first)} and {last} are expected, separated by tabs")
        if not columns:  # only the least ones are in each row
            columns = form.columns[: len(row) if kind in BED_LIKE else None]
        row = (row + [""] * len(columns))[: len(columns)]
        if kind == "vcf":
            row[1:2] = _replaced(*(row[at] for at in (1, 3, 7)))
        cells += row
        lines.append(line)
    columns = columns or form.columns
    if kind == "vcf":
        columns = ["chrom", "start", "end", *columns[2:]]
    table = Text(name, columns, cells, lines)
    table.format = form
    return table


def _replaced(position: str, reference: str, info: str) -> tuple[str, str]:
    """The start, from 1, and the end of what a variant replaces: its reference, or all up to an end that it names."""
    named = re.search(r"(?:^|;)END=([0-9]+)(?:;|$)", info)
    if named:
        return position, named[1]
    if not _PLAIN_NUMBER.fullmatch(position):
        return position, position  # reading the numbers says so
    return position, str(int(position) - 1 + len(reference))


def read_table(name: str, file: IO[str], delimiter: str, header: bool | None) -> tuple[Text, bool]:
    """A file of rows of cells, and whether it has no header.

    Args:
        name: of the file, for messages.
        file: its text.
        delimiter: between cells; empty to find out.
        header: whether the first row names the columns; None to find out.
    """
    return next(table_parts(name, file, delimiter, header, sys.maxsize))


def table_parts(
    name: str, file: IO[str], delimiter: str, header: bool | None, rows: int
) -> Iterator[tuple[Text, bool]]:
    """The same, at most `rows` rows at a time; at least one part."""
    text, skipped, first = _without_comments(file)
    if not delimiter:
        delimiter = max(",;\t", key=first.count)
        if delimiter not in first and " " in first.strip():
            delimiter = " "
    reader = csv.reader(text, delimiter=delimiter, skipinitialspace=True, strict=True)
    begun = 1
    # All cells are in one list: with a list for each row, reading takes twice as long.
    cells: list[str] = []
    lines = array("Q")
    try:
        first_row = next(filter(None, reader), [])
        if not first_row:
            raise FileError(f"{name} is empty")
        if header is None:
            header = _is_header(name, first_row)
        if header:
            columns = [cell.strip() for cell in first_row]
            columns[0] = columns[0].lstrip("#").lstrip() if len(columns) > 1 else columns[0]
        else:
            columns = [str(place) for place in range(1, len(first_row) + 1)]
            cells += first_row
            lines.append(reader.line_num + skipped)
        begun = reader.line_num + 1
        for row in reader:
            here = reader.line_num + skipped
            begun = reader.line_num + 1
            if not row or (row[0].startswith("#") and len(row) < len(columns)):
                continue
            if len(row) < len(columns) or any(row[len(columns) :]):
                raise FileError(f"{name}, line {here}: it has {len(row)} columns, where {len(columns)} are expected")
            if len(lines) == rows:
                yield Text(name, columns, cells, lines), not header
                cells, lines = [], array("Q")
            cells += row[: len(columns)]
            lines.append(here)
    except csv.Error as error:
        raise FileError(f"{name}, line {begun + skipped}: {_fault(error)}") from None
    yield Text(name, columns, cells, lines), not header


def _without_comments(file: IO[str]) -> tuple[Iterator[str], int, str]:
    """The lines after the comments at the beginning, how many these were, and the first line that is none."""
    skipped = 0
    for line in file:
        if line.startswith("#") and not _names_boxes(re.split("[,;\t ]+", line.lstrip("#").strip())):
            skipped += 1
            continue
        return chain([line], file), skipped, line
    return iter(()), skipped, ""


def _names_boxes(names: list[str]) -> bool:
    """Whether names of columns are known as those of boxes."""
    try:
        return any(box_columns([*names, ""], format) for format in FORMATS)
    except ValueError:  # two names of one coordinate
        return True


def _is_header(name: str, row: list[str]) -> bool:
    """Whether the first row names the columns. What cannot be known is refused."""
    numbers = [number(cell) is not None for cell in row]
    if not any(numbers):
        return True
    way = "pass --header if it names the columns, or --no-header, which numbers them from 1"
    if all(numbers):
        if [cell.strip() for cell in row] == [str(place) for place in range(len(row))]:
            raise FileError(
                f"{name} begins with {','.join(row)}, which may be a box, or the header of a table whose columns have "
                f"no names: {way}"
            )
        return False
    if _names_boxes([cell.strip() for cell in row]):
        return True
    shown = listed(row).removeprefix("its columns are ")
    raise FileError(f"{name} begins with a row of text and numbers ({shown}): {way}")


def corners_of_bare(text: Text) -> list[str]:
    """All columns of a file without a header, which are the corners of boxes."""
    width = len(text.columns)
    if width not in _CORNERS:
        raise FileError(
            f"{text.name} has no header and {width} columns; boxes have 2, 4 or 6: choose columns by --columns 1,2,.."
        )
    return text.columns


def _fault(error: csv.Error) -> str:
    """What is wrong with a row of a file of text."""
    if "unexpected end" in str(error) or "field larger" in str(error):
        return "a quote opens in this row and is not closed"
    return f"it has a quote in the wrong place ({error})" if "expected after" in str(error) else str(error)
