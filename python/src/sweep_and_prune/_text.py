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
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from io import BytesIO, TextIOWrapper
from itertools import chain
from typing import IO, Any, NamedTuple
from urllib.parse import unquote

import numpy as np
from numpy.typing import NDArray

from ._columns import EXACT, Column, read_column
from ._file_error import FileError
from ._inputs import FORMATS, box_columns, listed
from ._native import read_cells, read_ends_of_variants, read_lines, read_names, read_numbers

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

    def __init__(self, name: str, columns: list[str], cells: list[str], lines: Sequence[int] | NDArray[Any]) -> None:
        """`cells` are those of all rows, one row after the other."""
        self.name, self.columns, self._cells, self._lines = name, columns, cells, lines
        self.format: Format | None = None

    def __len__(self) -> int:
        return len(self._lines)

    def line(self, index: int) -> int:
        """The line of the file in which a row ends."""
        return int(self._lines[index])

    def text(self, name: str) -> Sequence[str]:
        """The cells of a column, as they are in the file."""
        if self._is_attribute(name):
            assert self.format is not None
            return [_attribute(cell, name, self.format.attributes) for cell in self.text("attributes")]
        return self._cells_of(name)

    def _is_attribute(self, name: str) -> bool:
        """Whether the last column names it, as in GTF and GFF3."""
        return self.columns.count(name) == 0 and self.format is not None and bool(self.format.attributes)

    def _cells_of(self, name: str) -> Sequence[str]:
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
        return _group_of(self.text(name), name)

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

    def plain_numbers(self, name: str) -> NDArray[Any]:
        """The numbers of a column as they are in the file."""
        return self._numbers(name)

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
    """A table of text of which only the rows were found; cells are read when they are asked for."""

    def __init__(
        self,
        name: str,
        columns: list[str],
        data: bytes,
        offsets: NDArray[np.int64],
        separator: str = "\t",
        is_csv: bool = False,
    ) -> None:
        """`offsets` is what `read_lines` returned for `data`."""
        self._data, self._form, self._offsets = data, (ord(separator), is_csv), offsets
        self._named: dict[str, tuple[NDArray[np.int64], list[str]]] = {}
        self.before = 0
        self.ends: NDArray[np.int64] | None = None
        super().__init__(name, columns, [], offsets)

    before: int
    """The number of lines before `data` in the file."""
    ends: NDArray[np.int64] | None
    """The ends of what variants replace, which are no column of VCF."""

    def line(self, index: int) -> int:
        """The line of the file that has a row."""
        return self.before + self._data.count(b"\n", 0, int(self._offsets[index])) + 1

    def label(self, name: str) -> Any:
        """A column as it is written, whose cells are read when they are asked for."""
        if self.ends is not None and name == "end":
            return super().label(name)
        convert = None
        if self._is_attribute(name):
            assert self.format is not None
            convert, name = partial(_attribute, name=name, form=self.format.attributes), "attributes"
        return Cells(self._data, self._offsets, self._form, self._in_line(name), convert)

    def are_plain_numbers(self, name: str) -> bool:
        """Whether all values of a column are numbers that are no names, and some are there."""
        present = [cell for cell in self._names(name)[1] if cell]
        return bool(present) and all(map(_PLAIN_NUMBER.fullmatch, present))

    def group(self, name: str) -> Column:
        """The values of a column to group by, which are text; what is empty is missing."""
        codes, names = self._names(name)
        return _group_of(names, name)._replace(codes=codes)

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        codes, names = self._names(name)
        first = np.unique(codes, return_index=True)[1]
        ends_of_lines = np.flatnonzero(np.frombuffer(self._data, np.uint8) == ord("\n"))
        lines = self.before + np.searchsorted(ends_of_lines, self._offsets[first]) + 1
        return Text(self.name, [name], names, lines).group_of_numbers(name)._replace(codes=codes)

    def _names(self, name: str) -> tuple[NDArray[np.int64], list[str]]:
        """The number of each cell of a column among its different ones, and these."""
        if name not in self._named:
            if self._is_attribute(name) or (self.ends is not None and name == "end"):
                known: dict[str, int] = {}
                codes = np.array([known.setdefault(cell, len(known)) for cell in self.text(name)], np.int64)
                self._named[name] = codes, [*known]
            else:
                found = read_names(self._data, self._offsets, *self._form, self._in_line(name))
                assert found is not None
                self._named[name] = found
        return self._named[name]

    def _cells_of(self, name: str) -> Sequence[str]:
        if self.ends is not None and name == "end":
            return [*map(str, self.ends.tolist())]
        found = read_cells(self._data, self._offsets, *self._form, self._in_line(name))
        assert found is not None
        return found

    def _numbers(self, name: str) -> NDArray[Any]:
        if self.ends is not None and name == "end":
            return self.ends
        found = None
        if not self._is_attribute(name):
            found = read_numbers(self._data, self._offsets, *self._form, self._in_line(name))
        return super()._numbers(name) if found is None else found

    def _in_line(self, name: str) -> int:
        """The place of a column in lines of the file."""
        place = self.place(name)
        return place - (self.ends is not None and place > 1)


class Cells:
    """The cells of a column of a table of text."""

    def __init__(
        self,
        data: bytes,
        offsets: NDArray[np.int64],
        form: tuple[int, bool],
        place: int,
        convert: Callable[[str], str] | None,
    ) -> None:
        """`convert` makes of a cell what is wanted of it, if that is not all."""
        self._data, self._offsets, self._form, self._place, self._convert = data, offsets, form, place, convert

    def __getitem__(self, rows: NDArray[Any]) -> NDArray[Any]:
        """The cells of some rows."""
        found = read_cells(self._data, self._offsets[rows], *self._form, self._place)
        assert found is not None
        return np.array(found if self._convert is None else [*map(self._convert, found)], object)


def _group_of(cells: Sequence[str], name: str) -> Column:
    values = np.array(cells, object)
    missing = values == ""
    return Column(values, missing if missing.any() else None, name=f"column {name}")


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
    offsets = read_lines(data, 0, form.least, ord("\t"), False)
    is_vcf = kind == "vcf"
    ends = read_ends_of_variants(data, offsets, ord("\t"), False) if is_vcf and offsets is not None else None
    if offsets is not None and len(offsets) and (ends is not None or not is_vcf):
        if not columns:
            first = data[int(offsets[0]) :].split(b"\n", 1)[0]
            columns = form.columns[: first.count(b"\t") + 1 if kind in BED_LIKE else None]
            columns = _with_ends(columns) if is_vcf else columns
        table = Lines(name, columns, data, offsets)
        table.format, table.before, table.ends = form, before, ends
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
        columns = _with_ends(columns)
    table = Text(name, columns, cells, lines)
    table.format = form
    return table


def _with_ends(columns: list[str]) -> list[str]:
    """The columns of VCF with the start and the end of what a variant replaces."""
    return ["chrom", "start", "end", *columns[2:]]


def _replaced(position: str, reference: str, info: str) -> tuple[str, str]:
    """The start, from 1, and the end of what a variant replaces: its reference, or all up to an end that it names."""
    named = re.search(r"(?:^|;)END=([0-9]+)(?:;|$)", info)
    if named:
        return position, named[1]
    if not _PLAIN_NUMBER.fullmatch(position):
        return position, position  # reading the numbers says so
    return position, str(int(position) - 1 + len(reference))


class _Begun(NamedTuple):
    """A file of rows of cells whose columns are known."""

    name: str
    reader: Any
    """The rows that follow."""
    delimiter: str
    columns: list[str]
    first: list[str] | None
    """The first row if it is none of names."""
    skipped: int
    """How many comments there were before the first row."""


def read_table(name: str, data: bytes, delimiter: str, header: bool | None) -> tuple[Text, bool]:
    """A file of rows of cells, and whether it has no header.

    Args:
        name: of the file, for messages.
        data: what it has.
        delimiter: between cells; empty to find out.
        header: whether the first row names the columns; None to find out.

    Raises:
        UnicodeDecodeError: if it is not text in UTF-8.
    """
    data = data.removeprefix(BOM_UTF8)
    with TextIOWrapper(BytesIO(data), "utf-8", newline="") as file:
        begun = _begin(name, file, delimiter, header)
        has_header = begun.first is None
        lines = begun.skipped + (begun.reader.line_num if has_header else 0)
        offsets = read_lines(data, lines, len(begun.columns), ord(begun.delimiter), True)
        if offsets is None:
            return next(_parts(begun, sys.maxsize)), not has_header
        return Lines(name, begun.columns, data, offsets, begun.delimiter, True), not has_header


def table_parts(
    name: str, file: IO[str], delimiter: str, header: bool | None, rows: int
) -> Iterator[tuple[Text, bool]]:
    """The same, at most `rows` rows at a time; at least one part."""
    begun = _begin(name, file, delimiter, header)
    return ((table, begun.first is not None) for table in _parts(begun, rows))


def _begin(name: str, file: IO[str], delimiter: str, header: bool | None) -> _Begun:
    text, skipped, first = _without_comments(file)
    if not delimiter:
        delimiter = max(",;\t", key=first.count)
        if delimiter not in first and " " in first.strip():
            delimiter = " "
    reader = csv.reader(text, delimiter=delimiter, skipinitialspace=True, strict=True)
    try:
        first_row = next(filter(None, reader), [])
    except csv.Error as error:
        raise FileError(f"{name}, line {1 + skipped}: {_fault(error)}") from None
    if not first_row:
        raise FileError(f"{name} is empty")
    if header is None:
        header = _is_header(name, first_row)
    if not header:
        columns = [str(place) for place in range(1, len(first_row) + 1)]
        return _Begun(name, reader, delimiter, columns, first_row, skipped)
    columns = [cell.strip() for cell in first_row]
    columns[0] = columns[0].lstrip("#").lstrip() if len(columns) > 1 else columns[0]
    return _Begun(name, reader, delimiter, columns, None, skipped)


def _parts(begun: _Begun, rows: int) -> Iterator[Text]:
    name, reader, _, columns, first_row, skipped = begun
    # All cells are in one list: with a list for each row, reading takes twice as long.
    cells = [*first_row] if first_row else []
    lines = array("Q", [reader.line_num + skipped] if first_row else [])
    line = reader.line_num + 1
    try:
        for row in reader:
            here = reader.line_num + skipped
            line = reader.line_num + 1
            if not row or (row[0].startswith("#") and len(row) < len(columns)):
                continue
            if len(row) < len(columns) or any(row[len(columns) :]):
                number = "1 column" if len(row) == 1 else f"{len(row)} columns"
                raise FileError(f"{name}, line {here}: it has {number}, where {len(columns)} are expected")
            if len(lines) == rows:
                yield Text(name, columns, cells, lines)
                cells, lines = [], array("Q")
            cells += row[: len(columns)]
            lines.append(here)
    except csv.Error as error:
        raise FileError(f"{name}, line {line + skipped}: {_fault(error)}") from None
    yield Text(name, columns, cells, lines)


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
