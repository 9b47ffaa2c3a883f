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
_BEFORE_ROW = r"#|(?:track|browser)(?: |\r?$)|\r?$"
"""What begins a line of genomics that has no interval."""
_NO_ROW = re.compile(_BEFORE_ROW)
_ROW = re.compile(rf"^(?!{_BEFORE_ROW}).*".encode(), re.MULTILINE)
_SIZED = re.compile("<(?:DEL|DUP|INV|CNV)[:>]")
"""An allele of VCF that has a length on the reference."""
_SIZE = re.compile("[+-]?([0-9]+)")
_ROWS_AT_ONCE = 2**10
"""This many rows are looked through at once for an attribute that is probably in the first ones."""


class Format(NamedTuple):
    """A format of genomics: lines of columns that are separated by tabs, without a header or quotes."""

    columns: list[str]
    """The names of the first columns; further ones have their numbers as names."""
    least: int
    """How many columns each line has at least."""
    fixed: int = 0
    """How many columns there are in any file, of which lines may lack the last ones. The first line tells of others."""
    first_position: int = 0
    """From what positions count: from 0, or from 1, and then ends belong to intervals."""
    least_position: int = 0
    """The least position that a line may have."""
    attributes: str = ""
    """How the last column names more values: as in GTF or as in GFF3."""

    def names(self, width: int) -> list[str]:
        """The names of the columns of a file whose first line has `width` ones; 0 if it has no line."""
        width = max(width or self.fixed or len(self.columns), self.fixed)
        return [*self.columns[:width], *map(str, range(len(self.columns) + 1, width + 1))]

    def widths(self, width: int) -> tuple[int, int]:
        """How many columns each line of this file has, at least and at most: none is lost, and none is made up."""
        return (self.least, self.fixed) if width <= self.fixed else (width, width)


_BED = ["chrom", "start", "end", "name", "score", "strand", "thickStart", "thickEnd", "itemRgb", "blockCount"]
_BED += ["blockSizes", "blockStarts"]
_PEAK = [*_BED[:6], "signalValue", "pValue", "qValue"]
_GENES = ["chrom", "source", "feature", "start", "end", "score", "strand", "frame", "attributes"]
GENOMIC = {
    "bed": Format(_BED, 3),
    "narrowpeak": Format([*_PEAK, "peak"], 3),
    "broadpeak": Format(_PEAK, 3),
    "bedgraph": Format([*_BED[:3], "value"], 3),
    "gtf": Format(_GENES, 8, 9, 1, 1, "gtf"),
    "gff3": Format(_GENES, 8, 9, 1, 1, "gff3"),
    # (Position 0 is that of a telomere.)
    "vcf": Format(["chrom", "pos", "id", "ref", "alt", "qual", "filter", "info", "format"], 5, 8, 1, 0),
}


class Text:
    """A table of text, whose columns become numbers when they are used."""

    def __init__(self, name: str, columns: list[str], cells: list[str], lines: Sequence[int] | NDArray[Any]) -> None:
        """`cells` are those of all rows, one row after the other."""
        self.name, self.columns, self._cells, self._lines = name, columns, cells, lines
        self.format: Format | None = None
        self.attributes: dict[str, bool] = {}
        self.is_part = False

    format: Format | None
    """What it is if it has no header, but columns of a format of genomics."""
    attributes: dict[str, bool]
    """Whether a row has each attribute that was asked for, in this or another part of the file."""
    is_part: bool
    """Whether it may be a part of a file."""

    def __len__(self) -> int:
        return len(self._lines)

    def line(self, index: int) -> int:
        """The line of the file in which a row ends."""
        return int(self._lines[index])

    def text(self, name: str) -> Sequence[str]:
        """The cells of a column, as they are in the file."""
        name = self.named(name)
        if self._is_attribute(name):
            assert self.format is not None
            return [_attribute(cell, name, self.format.attributes) or "" for cell in self.text("attributes")]
        return self._cells_of(name)

    def _is_attribute(self, name: str) -> bool:
        """Whether the last column names it, as in GTF and GFF3. One that no row has is refused: it is misspelled."""
        form = "" if self.format is None else self.format.attributes
        if not form or name in self.columns:
            return False
        if not self.attributes.get(name):
            found = any(_attribute(cell, name, form) is not None for cell in self._cells_until_found())
            if not found and not self.is_part and len(self):
                raise self.no_attribute(name)
            self.attributes[name] = found
        return True

    def no_attribute(self, name: str) -> FileError:
        """The error that no row has an attribute."""
        pattern = _OF_GFF3 if self.format is not None and self.format.attributes == "gff3" else _OF_GTF
        of_first = [found[1] for found in pattern.finditer(next(self._cells_until_found(), ""))]
        known = [*self.columns, *dict.fromkeys(of_first)]
        return no_column(self.name, known, name, "no column and no attribute")

    def _cells_until_found(self) -> Iterator[str]:
        """The cells of attributes."""
        return iter(self.text("attributes"))

    def _cells_of(self, name: str) -> Sequence[str]:
        return self._cells[self.place(name) :: len(self.columns)]

    def place(self, name: str) -> int:
        """Which column has a name."""
        if self.columns.count(name) != 1:
            raise no_column(self.name, self.columns, name)
        return self.columns.index(name)

    def named(self, name: str) -> str:
        """The name of a column that is given by its name, or by its number from 1 in a file of genomics."""
        if self.format is None or name in self.columns or not name.isdecimal() or not name.isascii():
            return name
        in_file = [one for one in self.columns if self.format is not GENOMIC["vcf"] or one != "end"]
        return in_file[int(name) - 1] if 1 <= int(name) <= len(in_file) else name

    def _is_missing(self, cell: str) -> bool:
        """Whether a cell of a column to group by has no value. In the formats of genomics this is a point."""
        return not cell or (cell == "." and self.format is not None)

    def group(self, name: str) -> Column:
        """The values of a column to group by, which are text; what is empty is missing, and "." in genomics."""
        return self._group_of(self.text(name), name)

    def _group_of(self, cells: Sequence[str], name: str) -> Column:
        missing = np.fromiter(map(self._is_missing, cells), bool, len(cells))
        return Column(np.array(cells, object), missing if missing.any() else None, name=f"column {name}")

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        return read_column(self[name], f"column {name}")

    def label(self, name: str) -> Any:
        """A column as it is written."""
        return np.array(self.text(name), object)

    def __getitem__(self, name: str) -> NDArray[Any]:
        name = self.named(name)
        numbers = self._numbers(name)
        if self.format is None or name != "start":
            return numbers
        first = self.format.first_position
        wrong = np.flatnonzero(numbers < self.format.least_position)
        if len(wrong):
            place = f"{self.name}, line {self.line(int(wrong[0]))}, column start"
            raise FileError(f"{place}: it is {numbers[wrong[0]]}; positions in this format count from {first}")
        return numbers - first if first else numbers

    def are_plain_numbers(self, name: str) -> bool:
        """Whether all values of a column are numbers that are no names, and some are there."""
        return self._are_plain(self.text(name))

    def _are_plain(self, cells: Sequence[str]) -> bool:
        present = [cell for cell in cells if not self._is_missing(cell)]
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
            way = self._other_format() if self.format is not None and index == 0 else ""
            raise FileError(f"{self.name}, line {self.line(index)}, column {name}: {shown!r} {what}{way}")
        return found

    def _other_format(self) -> str:
        """What the first row seems to be, if it is none of a format of genomics."""
        row = [str(self.label(name)[np.zeros(1, np.int64)][0]) for name in self.columns]
        are_numbers = [number(cell) is not None for cell in row]
        if not any(are_numbers):  # tables are saved under the names of these formats, too
            return ": is this a header? Remove the line"
        is_bed = self.format is not None and self.format.first_position == 0
        if is_bed and len(row) > 4 and not are_numbers[1] and row[3].isdecimal() and row[4].isdecimal():
            return ": is this GTF or GFF? Name it .gtf or .gff3, or pass --from gtf for standard input"
        return ""


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
        name = self.named(name)
        if self.ends is not None and name == "end":
            return super().label(name)
        convert = None
        if self._is_attribute(name):
            assert self.format is not None
            convert, name = partial(_label_of, name=name, form=self.format.attributes), "attributes"
        return Cells(self._data, self._offsets, self._form, self._in_line(name), convert)

    def are_plain_numbers(self, name: str) -> bool:
        """Whether all values of a column are numbers that are no names, and some are there."""
        return self._are_plain(self._names(name)[1])

    def group(self, name: str) -> Column:
        """The values of a column to group by, which are text; what is empty is missing, and "." in genomics."""
        codes, names = self._names(name)
        return self._group_of(names, name)._replace(codes=codes)

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        codes, names = self._names(name)
        first = np.unique(codes, return_index=True)[1]
        ends_of_lines = np.flatnonzero(np.frombuffer(self._data, np.uint8) == ord("\n"))
        lines = self.before + np.searchsorted(ends_of_lines, self._offsets[first]) + 1
        return Text(self.name, [name], names, lines).group_of_numbers(name)._replace(codes=codes)

    def _names(self, name: str) -> tuple[NDArray[np.int64], list[str]]:
        """The number of each cell of a column among its different ones, and these."""
        name = self.named(name)
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

    def _cells_until_found(self) -> Iterator[str]:
        """The cells of attributes, a part at a time: most often the first rows have what is looked for."""
        for at in range(0, len(self), _ROWS_AT_ONCE):
            found = read_cells(
                self._data, self._offsets[at : at + _ROWS_AT_ONCE], *self._form, self._in_line("attributes")
            )
            assert found is not None
            yield from found

    def _cells_of(self, name: str) -> Sequence[str]:
        if self.ends is not None and name == "end":
            return [*map(str, self.ends.tolist())]
        found = read_cells(self._data, self._offsets, *self._form, self._in_line(name))
        assert found is not None
        return found

    def _numbers(self, name: str) -> NDArray[Any]:
        name = self.named(name)
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


def _attribute(cell: str, name: str, form: str) -> str | None:
    """A value that the last column of GTF or GFF3 names, if it does."""
    pattern = _OF_GFF3 if form == "gff3" else _OF_GTF
    for found in pattern.finditer(cell):
        if found[1] == name:
            return unquote(found[2].strip()) if form == "gff3" else found[2] if found[2] is not None else found[3]
    return None


def _label_of(cell: str, name: str, form: str) -> str:
    return _attribute(cell, name, form) or ""


def no_column(file: str, columns: Sequence[str], name: str, none: str = "no column") -> FileError:
    """The error that a file has not one column of this name."""
    number = columns.count(name)
    fault = f"{number} columns {name!r}: rename all but one" if number > 1 else f"{none} {name!r}"
    way = "; numbers are for files without a header" if name.isdecimal() and number == 0 else ""
    return FileError(f"{file} has {fault}{way}; {listed(columns)}")


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
    return _part_of_genomic(name, data.removeprefix(BOM_UTF8), kind, 0, 0)


def genomic_parts(name: str, file: IO[bytes], kind: str, size: int) -> Iterator[Text]:
    """A file of one of the formats of genomics, about `size` bytes at a time; all parts have the same columns.

    Raises:
        UnicodeDecodeError: if it is not text in UTF-8.
    """
    width = before = 0
    attributes: dict[str, bool] = {}
    data = file.read(size).removeprefix(BOM_UTF8)
    while True:
        more = file.read(size)
        end = data.rfind(b"\n") + 1 if more else len(data)
        if end or not more:
            table = _part_of_genomic(name, data[:end], kind, width, before)
            table.attributes, table.is_part = attributes, True
            if len(table) or not more:
                width = len(table.columns) - (kind == "vcf") if len(table) else width
                yield table
            lines = data[:end]
            if not more or (b"##FASTA" in lines and not isinstance(table, Lines) and _has_sequences(lines)):
                break
            before += lines.count(b"\n") + lines.count(b"\r") - lines.count(b"\r\n")
        data = data[end:] + more
    for attribute in (one for one, is_there in attributes.items() if width and not is_there):
        raise table.no_attribute(attribute)


def _has_sequences(lines: bytes) -> bool:
    return any(line.startswith(b"##FASTA") for line in lines.splitlines())


def _part_of_genomic(name: str, data: bytes, kind: str, width: int, before: int) -> Text:
    """Lines of such a file, after `before` others. Its first line tells its `width`, which is 0 until then."""
    form = GENOMIC[kind]
    first = _ROW.search(data)
    of_first = width or (first[0].count(b"\t") + 1 if first else 0)
    is_vcf = kind == "vcf"
    offsets = ends = None
    if first and of_first >= form.least:
        offsets = read_lines(data, 0, *form.widths(of_first), ord("\t"), False)
        ends = read_ends_of_variants(data, offsets, ord("\t"), False) if is_vcf and offsets is not None else None
    if offsets is not None and (ends is not None or not is_vcf):
        table = Lines(name, _columns_of(kind, of_first), data, offsets)
        table.format, table.before, table.ends = form, before, ends
        return table
    with TextIOWrapper(BytesIO(data), "utf-8", newline="") as file:
        return _read_genomic(name, file, kind, width, before)


def _columns_of(kind: str, width: int) -> list[str]:
    """The names of the columns of a file; for VCF with the start and the end of what a variant replaces."""
    names = GENOMIC[kind].names(width)
    return ["chrom", "start", "end", *names[2:]] if kind == "vcf" else names


def _read_genomic(name: str, file: IO[str], kind: str, width: int = 0, before: int = 0) -> Text:
    form = GENOMIC[kind]
    cells: list[str] = []
    lines = array("Q")
    for line, text in enumerate(file, before + 1):
        text = text.rstrip("\r\n")
        if text.startswith("##FASTA"):
            break  # what follows in GFF3 are sequences
        if _NO_ROW.match(text):
            continue
        row = text.split("\t")
        if len(row) < form.least:
            *first, last = form.columns[: form.least]
            raise FileError(f"{name}, line {line}: {', '.join(first)} and {last} are expected, separated by tabs")
        width = width or len(row)
        least, most = form.widths(width)
        if not least <= len(row) <= most:
            raise _other_width(name, line, len(row), least if len(row) < least else most)
        row += [""] * (max(width, form.fixed) - len(row))
        if kind == "vcf":
            row[1:2] = _replaced(*(row[at] for at in (1, 3, 4, 7)))
        cells += row
        lines.append(line)
    table = Text(name, _columns_of(kind, width), cells, lines)
    table.format = form
    return table


def _other_width(name: str, line: int, found: int, expected: int) -> FileError:
    number = "1 column" if found == 1 else f"{found} columns"
    return FileError(f"{name}, line {line}: it has {number}, where {expected} are expected")


def _replaced(position: str, reference: str, alleles: str, info: str) -> tuple[str, str]:
    """The start, from 1, and the end of what a variant replaces.

    It is all up to an end that the variant names, or a deletion, duplication, inversion or change of copies of the
    length that it names, after its position; else its reference.
    """
    named = re.search(r"(?:^|;)END=([0-9]+)(?:;|$)", info)
    if named:
        return position, named[1]
    if not _PLAIN_NUMBER.fullmatch(position):
        return position, position  # reading the numbers says so
    size = _size_of(alleles, info)
    return position, str(int(position) + (len(reference) - 1 if size is None else size))


def _size_of(alleles: str, info: str) -> int | None:
    """The greatest length that a variant names of its alleles that have one on the reference."""
    named = re.search(r"(?:^|;)SVLEN=([^;]*)", info)
    are_sized = [bool(_SIZED.match(allele)) for allele in alleles.split(",")]
    if not named or not any(are_sized):
        return None
    values = named[1].split(",")
    # (A length may be written for all alleles at once.)
    own = [value for value, is_sized in zip(values, are_sized) if is_sized] if len(values) == len(are_sized) else values
    return max((int(found[1]) for found in map(_SIZE.fullmatch, own) if found), default=None)


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
        width = len(begun.columns)
        offsets = read_lines(data, lines, width, width, ord(begun.delimiter), True)
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
                raise _other_width(name, here, len(row), len(columns))
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
