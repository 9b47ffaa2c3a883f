"""Reads boxes from files, for the command line."""

from __future__ import annotations

import gzip
import io
import json
import math
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from itertools import chain
from pathlib import Path
from typing import Any, Union
from zipfile import BadZipFile

import numpy as np
from numpy.typing import NDArray

from . import _crs
from ._columns import Column, objects_of, read_column, side_by_side
from ._file_error import FileError
from ._inputs import (
    Raw,
    bounds_of_geometries,
    box_columns,
    chosen_boxes,
    crs_of,
    geometry_column,
    listed,
    raw_boxes,
    unknown_columns,
)
from ._text import (
    GENOMIC,
    Text,
    corners_of_bare,
    genomic_parts,
    no_column,
    number,
    read_genomic,
    read_table,
    table_parts,
)
from ._writers import ARROW_ENDINGS, pyarrow_for, texts_of_times

_KINDS = {
    **{".csv": "csv", ".txt": "csv", ".tsv": "tsv", ".npy": "npy", ".npz": "npy"},
    **{".bed": "bed", ".narrowpeak": "narrowpeak", ".broadpeak": "broadpeak", ".bedgraph": "bedgraph"},
    **{".bdg": "bedgraph", ".bg": "bedgraph", ".gtf": "gtf", ".gff": "gff3", ".gff3": "gff3", ".vcf": "vcf"},
    **dict.fromkeys((".json", ".geojson", ".geojsonl", ".geojsons", ".ndjson", ".jsonl", ".topojson"), "json"),
    **{".parquet": "parquet", ".geoparquet": "parquet", **dict.fromkeys(ARROW_ENDINGS, "arrow")},
    **{".shp": "gis", ".gpkg": "gis", ".fgb": "gis"},
}
FORMATS = tuple(kind for kind in dict.fromkeys(_KINDS.values()) if kind != "gis")
"""The formats that `--from` names."""
_OF_TEXT = ("csv", "tsv", *GENOMIC)
_GZIP = b"\x1f\x8b"
"""What a compressed file begins with."""
READABLE = (
    ".csv, .tsv, .bed, .narrowPeak, .broadPeak, .bedGraph, .gtf, .gff3, .vcf, .npy, .npz, .json, .geojson, .geojsonl, "
    ".parquet, .arrow, .feather, .shp, .gpkg, .fgb"
)
_BYTES = 8 * 7
"""Of memory for each number: the table, the boxes, and what the search keeps."""
_BYTES_OF_TEXT = 11
"""Of memory for each byte of text (measured: 400 MB for a million boxes in 36 MB)."""

_PART_OF_TEXT = 2**23
"""This many bytes are read at once where a file need not fit in memory."""
_BYTES_OF_ROW = 64
"""The size of a row of CSV that decides how many are read at once."""
_DEPTHS = {"Point": 0, "MultiPoint": 1, "LineString": 1, "MultiLineString": 2, "Polygon": 2, "MultiPolygon": 3}
"""How many lists there are around each position of a geometry of GeoJSON."""
_POINTS = {
    ("x", "y"),
    ("lon", "lat"),
    ("lat", "lon"),
    ("lng", "lat"),
    ("longitude", "latitude"),
    ("latitude", "longitude"),
}
"""Names of two columns that are a point, and no interval."""
_READ_AT_ONCE = 2**22
"""This many bytes are read between two reports of progress."""
_OF_NUMPY, _OF_ARCHIVE = b"\x93NUMPY", b"PK"
"""What an array of NumPy begins with, and several of them."""
_OF_ARROW_FILES = (b"ARROW1", b"FEA1")
"""What files of Arrow begin with, those that can be read from any place; streams of Arrow do not."""

_File = Union[str, io.BytesIO]


class Source:
    """A file with a box in each row."""

    closed: str | None = None
    """What the format says about the ends of boxes."""
    by: Sequence[str] = []
    """The columns that the format groups by."""
    is_bare = False
    """Whether the columns have no names in the file."""
    are_corners = False
    """Whether the format says where boxes begin and end, so that no other one can be chosen."""
    has_shapes = False
    """Whether the boxes are the bounds of geometries."""
    crs: Any = None
    """The coordinate reference system, if it is known."""
    row = "row"
    """What a row is called in messages."""

    def __init__(self, name: str, values: Any, labels: dict[str, Any] | None = None) -> None:
        self.name, self.values, self.labels = name, values, labels or {}

    def __len__(self) -> int:
        return len(self.values.array if isinstance(self.values, Raw) else self.values)

    @property
    def columns(self) -> list[str]:
        """The names of its columns, none for an array of numbers."""
        if isinstance(self.values, np.ndarray):
            names: Sequence[str] = self.values.dtype.names or ()
        else:
            names = getattr(self.values, "column_names", getattr(self.values, "columns", ()))
        return [*map(str, names), *self.labels]

    def boxes(self, columns: Sequence[str], format: str) -> Any:
        """The corners of boxes, from columns with these names or else from those that are recognized."""
        if not columns and self.are_corners:
            format = "xyxy"
        if not columns and format != "xyxy" and self._width == 6:
            raise FileError(
                f"{self.name} has 6 columns without names, which may be boxes in space, or boxes in the plane with a "
                "score and a class: pass --columns 1,2,3,4,5,6, or those of the boxes"
            )
        if not columns and self.is_bare:
            columns = corners_of_bare(self.values)
        if not columns:
            if self.columns and not self.box_columns(format) and not self._are_boxes:
                way = unknown_columns(self.columns, "choose them by --columns", "--format {}")
                raise FileError(f"{self.name} has no columns that are known as boxes: {way}; {listed(self.columns)}")
            return raw_boxes(self.values, "boxes", format)
        self._refuse_order(columns, format)
        return chosen_boxes(self._column, columns, self.name, format)

    @property
    def _width(self) -> int:
        """How many columns there are if they have no names; else 0."""
        if self.is_bare:
            return len(self.columns)
        shape = np.shape(self.values) if isinstance(self.values, np.ndarray) else ()
        return shape[1] if len(shape) == 2 and not self.are_corners else 0

    def _refuse_order(self, columns: Sequence[str], format: str) -> None:
        """Refuses columns whose names say that they are something else in this order."""
        if tuple(name.lower() for name in columns) in _POINTS:
            both = ",".join(columns)
            raise FileError(f"{both} of {self.name} are points: pass --columns {both},{both}")
        with suppress(ValueError):  # two names of one coordinate
            known = box_columns([*columns], format)
            if sorted(known) == sorted(columns) and known != [*columns]:
                given = ",".join(columns)
                raise FileError(f"--columns {given}: their names say {','.join(known)}: pass them in this order")

    @property
    def text(self) -> Text | None:
        """The table of text, if it was one."""
        return self.values if isinstance(self.values, Text) else None

    @property
    def _are_boxes(self) -> bool:
        return isinstance(self.values, Raw) or (isinstance(self.values, np.ndarray) and not self.values.dtype.names)

    def box_columns(self, format: str) -> list[str]:
        """The columns that are recognized as boxes."""
        if self.is_bare:
            return self.columns
        return [] if self._are_boxes else box_columns(self.columns, format)

    def group(self, name: str) -> Column:
        """The values of a column to group by.

        Those of a file of text are text, and what is empty is missing. In the formats of genomics "." is missing, too,
        so that a row without a strand pairs with none.
        """
        if isinstance(self.values, Text):
            return self.values.group(name)
        return read_column(self._labels(name), f"column {name}")

    def group_of_numbers(self, name: str) -> Column:
        """The same, if the values of the other file are numbers."""
        if isinstance(self.values, Text):
            return self.values.group_of_numbers(name)
        return read_column(self._column(name), f"column {name}")

    def label(self, name: str) -> Any:
        """A column as it is written in text: an array, or something that has an array of some rows at `[rows]`."""
        if isinstance(self.values, Text):
            return self.values.label(name)
        values = self._labels(name)
        return objects_of([_written(one) for one in values.to_pylist()]) if _is_nested(values) else _label_of(values)

    def typed_label(self, name: str) -> Any:
        """A column as it is written where columns have types: one of text that has plain numbers becomes numbers."""
        text = self.text
        if text is None:
            return _label_of(self._labels(name))
        is_number = name not in self.by and text.are_plain_numbers(name)
        return text.plain_numbers(name) if is_number else text.label(name)

    def _labels(self, name: str) -> Any:
        values = self._column(name)
        if name not in self.labels:
            return values
        is_nested = isinstance(values, np.ndarray) and any(isinstance(one, (list, dict)) for one in values.tolist())
        return objects_of([_written(one) for one in values.tolist()]) if is_nested else values

    def _column(self, name: str) -> Any:
        """The numbers of a column."""
        if isinstance(self.values, Text):
            return self.values[name]
        if isinstance(self.values, np.ndarray) and self.values.ndim == 2 and name.isdecimal() and not self.labels:
            if 1 <= int(name) <= self.values.shape[1]:  # it has no header
                return self.values[:, int(name) - 1]
            raise FileError(f"{self.name} has no column {name}; it has {self.values.shape[1]} columns")
        if self.columns.count(name) != 1:
            raise no_column(self.name, self.columns, name)
        return self.labels[name] if name in self.labels else self.values[name]

    def place(self, index: int) -> str:
        """Where a row is."""
        if isinstance(self.values, Text):
            return f"{self.name}, line {self.values.line(index)}"
        return f"{self.name}, {self.row} {index} (the first is 0)"


class Zoned:
    """Times with a time zone, which arrays of NumPy do not have; in text they are those of UTC."""

    dtype = np.dtype(object)

    def __init__(self, times: Any) -> None:
        """`times` are of Arrow."""
        self._times = times

    def __len__(self) -> int:
        return len(self._times)

    def __getitem__(self, rows: NDArray[Any]) -> Zoned:
        """The times of some rows; a row of -1 has none."""
        import pyarrow

        return Zoned(self._times.take(pyarrow.array(rows, mask=rows < 0)))

    def __arrow_array__(self, type: Any = None) -> Any:
        times = self._times if type is None else self._times.cast(type)
        return times.combine_chunks() if hasattr(times, "combine_chunks") else times

    def tolist(self) -> list[str | None]:
        """The times as text."""
        texts = texts_of_times(np.asarray(self._times))
        return [None if text is None else f"{text}Z" for text in texts]


def _label_of(values: Any) -> Any:
    """A column of Arrow or NumPy as it is written."""
    kind = getattr(values, "type", None)
    if kind is None:
        return np.asarray(values)
    import pyarrow

    types = pyarrow.types
    if types.is_timestamp(kind) and kind.tz is not None:
        return Zoned(values)
    has_missing = types.is_timestamp(kind) or types.is_date(kind) or types.is_duration(kind)
    if values.null_count and not has_missing:  # as an array of NumPy, integers would become floating point
        return objects_of(values.to_pylist())
    return np.asarray(values)


def _is_nested(values: Any) -> bool:
    kind = getattr(values, "type", None)
    if kind is None:
        return False
    import pyarrow

    return bool(pyarrow.types.is_nested(kind))


class _Watched(io.RawIOBase):
    """A file that reports which share of it was read."""

    def __init__(self, path: str, progress: Callable[[float], object]) -> None:
        self._file, self._progress = open(path, "rb", buffering=0), progress
        self._size, self._done = max(os.fstat(self._file.fileno()).st_size, 1), 0

    def readable(self) -> bool:
        """Says so, since readers ask."""
        return True

    def readinto(self, into: Any) -> int:
        """Reads what comes next."""
        count = self._file.readinto(memoryview(into)[:_READ_AT_ONCE]) or 0
        self._done += count
        self._progress(min(self._done / self._size, 0.99))
        return count

    def close(self) -> None:
        """Closes the file."""
        self._file.close()
        super().close()


def read(
    path: str, kind: str | None = None, header: bool | None = None, progress: Callable[[float], object] | None = None
) -> Source:
    """Reads a file, or standard input if it is `-`.

    Args:
        path: the name of the file.
        kind: one of `FORMATS`: what standard input is, by default CSV, and a file whose name does not tell.
        header: whether the first row of a table of text names its columns; None to find out.
        progress: called with the share of a file of text that was read, from 0 to 1.
    """
    name = "standard input" if path == "-" else path
    kind = kind_of_file(path) or kind or ("csv" if path == "-" else None)
    if kind is None:
        with _readable(name):
            os.stat(path)
        raise FileError(f"{path} has an unknown ending: the known ones are {READABLE}; or pass --from")
    _refuse_header(name, kind, header)
    with _readable(name):
        if path == "-":
            if sys.stdin is None:
                raise FileError("standard input is closed")
            opened: Any = sys.stdin.fileno()
            with open(opened, "rb", closefd=False) as file:
                data = file.read()
            if data.startswith(_GZIP):
                raise FileError(f"{name} is compressed with gzip: unpack it, as by gzip -dc")
            if kind in _OF_TEXT:
                return _read_text(name, data, kind, header)
            return _read_binary(name, io.BytesIO(data), kind)
        if kind == "json":
            with _opened_text(path, progress) as file:
                return _read_json(path, file.read())
        if kind not in _OF_TEXT:
            if _unpacked(path) != path:
                raise FileError(f"{path} is compressed, and only text is read so: unpack it first")
            return _read_binary(name, path, kind)
        # Of what is compressed, a box takes about a third.
        size = os.path.getsize(path) * (3 if _unpacked(path) != path else 1)
        check_memory(path, f"{size / 1e9:.1f} GB of boxes", size * _BYTES_OF_TEXT)
        with _opened_text(path, progress) as file:
            return _read_text(name, file.read(), kind, header)


def header_of(path: str, paths: Sequence[str], header: bool | None) -> bool | None:
    """What the option `header` says of one of these files: lines of genomics have none, so it is for the others."""
    are_genomic = [kind_of_file(one) in GENOMIC for one in (path, *paths)]
    return None if are_genomic[0] and not all(are_genomic) else header


def _refuse_header(name: str, kind: str, header: bool | None) -> None:
    if header and kind in GENOMIC:
        raise FileError(f"{name} is of a format whose lines have no header: leave out --header")


def is_text(path: str) -> bool:
    """Whether a file's name tells that it is of text."""
    return kind_of_file(path) in _OF_TEXT


def read_parts(path: str, header: bool | None, progress: Callable[[float], object] | None = None) -> Iterator[Source]:
    """A file of text, a part at a time, as `read` would read all of it."""
    kind, size = kind_of_file(path), _PART_OF_TEXT
    assert kind in _OF_TEXT
    _refuse_header(path, kind, header)
    with _readable(path), _opened_text(path, progress) as data:
        if kind in GENOMIC:
            for table in genomic_parts(path, data, kind, size):
                yield _source_of_lines(path, table)
        else:
            delimiter = "\t" if kind == "tsv" else ""
            text = io.TextIOWrapper(data, "utf-8-sig", newline="")
            for table, is_bare in table_parts(path, text, delimiter, header, max(size // _BYTES_OF_ROW, 1)):
                yield _source_of_text(path, table, is_bare)


@contextmanager
def _opened_text(path: str, progress: Callable[[float], object] | None) -> Iterator[Any]:
    """The bytes of a file of text, unpacked."""
    with ExitStack() as files:
        plain = files.enter_context(io.BufferedReader(_Watched(path, progress or (lambda _: None)), 2**16))
        is_packed = _unpacked(path) != path
        if not is_packed and plain.peek(len(_GZIP)).startswith(_GZIP):
            raise FileError(f"{path} is compressed with gzip: name it {path}.gz")
        yield files.enter_context(gzip.open(plain)) if is_packed else plain


@contextmanager
def _readable(name: str) -> Iterator[None]:
    """Says of any error in reading a file which one it is."""
    try:
        yield
    except OSError as error:
        raise FileError(f"{name} cannot be read: {error.strerror or error}") from None
    except UnicodeDecodeError:
        raise FileError(f"{name} is not text in UTF-8") from None
    except (FileError, MemoryError):
        raise
    except Exception as error:  # what readers of other formats raise for damaged files is not documented
        raise FileError(f"{name} cannot be read, it seems damaged: {error}") from None


def kind_of_file(path: str) -> str | None:
    """The format that a file's name tells."""
    return None if path == "-" else _KINDS.get(Path(_unpacked(path)).suffix.lower())


def _unpacked(path: str) -> str:
    """The name without the ending of a compressed file."""
    return path.removesuffix(".gz").removesuffix(".bgz")


def _source_of_lines(name: str, table: Text) -> Source:
    source = Source(name, table)
    source.closed, source.by, source.are_corners = "left", ["chrom"], True
    return source


def _read_text(name: str, data: bytes, kind: str, header: bool | None) -> Source:
    if kind in GENOMIC:
        return _source_of_lines(name, read_genomic(name, data, kind))
    return _source_of_text(name, *read_table(name, data, "\t" if kind == "tsv" else "", header))


def _source_of_text(name: str, table: Text, is_bare: bool) -> Source:
    source = Source(name, table)
    source.is_bare = is_bare
    return source


def _read_binary(name: str, file: _File, kind: str) -> Source:
    if kind == "npy":
        return Source(name, _read_numpy(name, file))
    if kind == "json":
        assert isinstance(file, io.BytesIO)
        return _read_json(name, file.getvalue())
    if kind == "gis":
        return _read_gis(name, file)
    return _read_arrow(name, file, kind)


def _read_numpy(name: str, file: _File) -> NDArray[Any]:
    begins = b""
    try:
        opened = open(file, "rb") if isinstance(file, str) else file
        with opened:  # NumPy leaves a damaged archive open that it opened
            begins = opened.read(len(_OF_NUMPY))
            if begins.startswith(_OF_ARCHIVE):
                opened.seek(0)
                with np.load(opened, allow_pickle=False) as arrays:
                    return _boxes_of_archive(name, arrays)
            if not isinstance(file, str):
                opened.seek(0)
                return np.asarray(np.load(opened, allow_pickle=False))
        loaded = np.load(file, mmap_mode="r", allow_pickle=False)
    except (ValueError, EOFError, BadZipFile) as error:
        if begins.startswith((_OF_NUMPY, _OF_ARCHIVE)):
            if "object" in str(error).lower():
                raise FileError(f"{name} holds Python objects, not numbers: save it as an array of numbers") from None
            raise FileError(f"{name} is not all of an array of NumPy: was the file cut off? ({error})") from None
        raise FileError(f"{name} is not an array of NumPy") from None
    check_memory(name, f"{loaded.shape[0] if loaded.ndim else 0} boxes", loaded.size * _BYTES)
    return np.asarray(loaded)


def _boxes_of_archive(path: str, arrays: Any) -> NDArray[Any]:
    names = arrays.files
    if "boxes" not in names and len(names) != 1:
        raise FileError(f"{path} has the arrays {', '.join(names)}: one of them must be called boxes")
    return np.asarray(arrays["boxes" if "boxes" in names else names[0]])


def _read_json(name: str, data: bytes) -> Source:
    """GeoJSON: a collection, a feature, a geometry, or one of these on each line; or COCO's detections."""
    document = _document(name, data.decode("utf-8-sig"))
    if isinstance(document, dict) and document.get("type") == "Topology":
        raise FileError(f"{name} is TopoJSON: convert it to GeoJSON first, as by ogr2ogr or mapshaper")
    if isinstance(document, dict) and isinstance(document.get("annotations"), list):
        return _read_coco(name, document["annotations"])
    items = [document] if isinstance(document, dict) else document
    if isinstance(items, list) and (not items or _is_detection(items[0])):  # a detector may have found nothing
        return _read_coco(name, items)
    features = _features(document)
    if features is None:
        raise FileError(f"{name} is not a FeatureCollection of GeoJSON, nor annotations of COCO")
    bounds = []
    for index, feature in enumerate(features):
        try:
            bounds.append(_bounds(feature.get("geometry")))
        except (AttributeError, IndexError, KeyError, TypeError, ValueError):
            raise FileError(f"{name}, feature {index} (the first is 0) is not valid GeoJSON") from None
    names = ["minx", "miny", "maxx", "maxy"]
    ends = [read_column([of_shape[end] for of_shape in bounds], name) for end, name in enumerate(names)]
    boxes = Raw(*side_by_side(ends, names, name))
    labels = _labels_of([feature.get("properties") or {} for feature in features])
    labels.setdefault("id", np.array([feature.get("id") for feature in features], object))
    source = Source(name, boxes, labels)
    source.are_corners, source.has_shapes, source.row = True, True, "feature"
    source.crs = _crs.of_geojson(document) if isinstance(document, dict) else _crs.LONGITUDE_LATITUDE
    return source


def _document(name: str, text: str) -> Any:
    """What a file of JSON has; a list if each line is a document."""
    try:
        return json.loads(text)
    except json.JSONDecodeError as error:
        lines = [(at, line.strip("\x1e \t\r")) for at, line in enumerate(text.split("\n"), 1)]
        given = [(at, line) for at, line in lines if line]
        if error.msg != "Extra data" and not text.startswith("\x1e"):
            raise FileError(
                f"{name}, line {error.lineno}: it is not JSON ({error.msg}); was the file cut off or damaged?"
            ) from None
    documents = []
    for at, line in given:
        try:
            documents.append(json.loads(line))
        except json.JSONDecodeError as error:
            raise FileError(f"{name}, line {at}: it is not JSON ({error.msg})") from None
    return documents


def _features(document: Any) -> list[Any] | None:
    """The features of GeoJSON; None if it is something else."""
    if isinstance(document, list):
        found = [_features(one) for one in document]
        return None if None in found or not found else [feature for of_line in found for feature in of_line or []]
    if not isinstance(document, dict):
        return None
    if isinstance(document.get("features"), list):
        features: list[Any] = document["features"]
        return features
    if document.get("type") == "Feature":
        return [document]
    return [{"geometry": document}] if {"coordinates", "geometries"} & set(document) else None


def _labels_of(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The values of each name in any of the rows."""
    return {name: objects_of([row.get(name) for row in rows]) for name in sorted({key for row in rows for key in row})}


def _written(value: Any) -> Any:
    """A value of JSON in a cell."""
    return json.dumps(value, default=str) if isinstance(value, (list, dict)) else value


def _is_detection(item: Any) -> bool:
    return isinstance(item, dict) and _features(item) is None and not {"bbox", "image_id"}.isdisjoint(item)


def _read_coco(name: str, annotations: list[Any]) -> Source:
    """Detections of COCO, whose boxes are a corner and a size. They pair within their image."""
    for index, item in enumerate(annotations):
        fault = _fault_of_detection(item)
        if fault:
            raise FileError(f"{name}, annotation {index} (the first is 0): {fault}")
    names = ["x", "y", "width", "height"]
    given = [item["bbox"] or [None] * 4 for item in annotations]
    ends = [read_column([box[end] for box in given], name) for end, name in enumerate(names)]
    boxes = raw_boxes(Raw(*side_by_side(ends, names, name)), name, "xywh")
    source = Source(name, boxes, _labels_of(annotations) or {"image_id": np.empty(0, object)})
    source.by, source.are_corners, source.row = ["image_id"], True, "annotation"
    return source


def _fault_of_detection(item: Any) -> str:
    """What is wrong with an annotation of COCO. Numbers may be missing in its box, or all of it."""
    if not isinstance(item, dict):
        return f"it is {_shown(item)}, not an object with an image_id and a bbox"
    for key in ("image_id", "bbox"):
        if key not in item:
            return f"it has no {key}"
    image, box = item["image_id"], item["bbox"]
    if type(image) not in (int, float, str):
        return f"its image_id is {_shown(image)}, not a number or text"
    if box is None:
        return ""
    if not isinstance(box, list):
        return f"its bbox is {_shown(box)}, not a list of 4 numbers"
    if len(box) != 4:
        return f"its bbox has {len(box)} items, not 4 numbers"
    wrong = [one for one in box if one is not None and type(one) not in (int, float)]
    return f"its bbox has {_shown(wrong[0])}, which is not a number" if wrong else ""


def _shown(value: Any) -> str:
    """A value of JSON as a message shows it."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _bounds(geometry: Any) -> tuple[float, float, float, float]:
    points = list(_points(geometry)) if geometry else []
    if not points:
        return (math.nan,) * 4
    x, y = zip(*points)
    if any(type(number) is bool or number != number for number in chain(x, y)):
        raise ValueError("coordinates are numbers")
    return min(x), min(y), max(x), max(y)


def _points(geometry: Any) -> Iterator[tuple[float, float]]:
    if geometry["type"] == "GeometryCollection":
        for part in geometry["geometries"]:
            yield from _points(part)
        return
    items = [geometry["coordinates"] or []]
    for _ in range(_DEPTHS[geometry["type"]]):
        if not all(isinstance(item, list) for item in items):
            raise TypeError("coordinates are lists")
        items = [*chain.from_iterable(items)]
    for position in items:
        if position:  # a point without coordinates is empty
            x, y = position[:2]
            if not (isinstance(position, list) and isinstance(x, (int, float)) and isinstance(y, (int, float))):
                raise TypeError("a position has numbers")
            yield x, y


def _read_gis(name: str, file: _File) -> Source:
    """A shapefile, a GeoPackage or a FlatGeobuf: the bounds of its geometries."""
    try:
        import geopandas
    except ImportError:
        raise FileError(f"{name} needs geopandas: pip install 'sweep-and-prune[join]'") from None
    if isinstance(file, str):
        import pyogrio

        layers = [layer for layer, kind in pyogrio.list_layers(file) if kind is not None]
        if len(layers) > 1:
            raise FileError(
                f"{name} has several layers ({', '.join(layers)}): write one to a file of its own, as ogr2ogr does"
            )
    frame = geopandas.read_file(file)
    if not hasattr(frame, "total_bounds"):
        raise FileError(f"{name} has no geometries")
    shapes = frame.geometry
    others = {str(column): frame[column] for column in frame.columns if column != shapes.name}
    others.update(_whole_columns(name, file, others))
    return _of_geometries(name, shapes.bounds.to_numpy(), others, shapes.crs)


def _whole_columns(name: str, file: _File, columns: dict[str, Any]) -> dict[str, Any]:
    """The columns of integers in which some are missing, exactly: pandas has them in floating point."""
    import pyogrio

    info = pyogrio.read_info(file)
    types = dict(zip(info["fields"], info["dtypes"]))
    names = [one for one in types if not types[one].startswith("float") and columns[one].dtype.kind == "f"]
    if not names:
        return {}
    pyarrow_for(name)
    _, table = pyogrio.read_arrow(file, columns=names, read_geometry=False)
    return {one: table[one] for one in names}


def _of_geometries(name: str, bounds: NDArray[Any], labels: dict[str, Any], crs: Any) -> Source:
    source = Source(name, bounds, labels)
    source.are_corners, source.has_shapes, source.crs = True, True, crs
    return source


def _read_arrow(name: str, file: _File, kind: str) -> Source:
    arrow = pyarrow_for(name)
    try:
        if kind == "arrow":
            import pyarrow.feather

            with open(file, "rb") if isinstance(file, str) else file as opened:
                is_stream = not opened.read(8).startswith(_OF_ARROW_FILES)  # such as those that this program writes
                opened.seek(0)
                table = arrow.ipc.open_stream(opened).read_all() if is_stream else pyarrow.feather.read_table(opened)
        else:
            import pyarrow.parquet

            parquet = pyarrow.parquet.ParquetFile(file)
            rows = parquet.metadata.num_rows
            check_memory(name, f"{rows} boxes", 4 * rows * _BYTES)
            table = parquet.read()
    except arrow.ArrowInvalid as error:
        raise FileError(f"{name} cannot be read: {error}") from None
    return source_of_table(name, table)


def source_of_table(name: str, table: Any) -> Source:
    """The boxes of a table of Arrow, with what its metadata say about geometries."""
    column = geometry_column(table.schema)
    if column is not None:
        others = {one: table[one] for one in table.column_names if one != column}
        try:
            bounds = bounds_of_geometries(table, column)
        except (TypeError, ValueError) as error:
            raise FileError(f"{name}: {error}") from None
        return _of_geometries(name, bounds, others, crs_of(table))
    source = Source(name, table)
    source.crs = crs_of(table)
    return source


def columns_of_groups(sources: list[Source], by: Sequence[Sequence[str]]) -> list[list[Column]]:
    """The columns to group by, of each file.

    In a file of text, numbers are text, too: they are numbers if all values of the column are, and also those of the
    other file.
    """
    groups = [[source.group(name) for name in names] for source, names in zip(sources, by)]
    for at, columns in enumerate(zip(*groups)):
        kinds = [column.kinds() for column in columns]
        texts = [source.text for source in sources]
        plain = [
            kind == {"numbers"} if text is None else text.are_plain_numbers(names[at])
            for text, kind, names in zip(texts, kinds, by)
        ]
        if all(plain):
            for side, text in enumerate(texts):
                if text is not None:
                    groups[side][at] = sources[side].group_of_numbers(by[side][at])
        elif {"text"} in kinds and {"numbers"} in kinds:
            side = kinds.index({"text"})
            if texts[side] is not None:  # of which not all are plain: this refuses those that are none
                groups[side][at] = sources[side].group_of_numbers(by[side][at])
        elif any("text" in kind for kind in kinds):
            _refuse_written_otherwise(sources, [names[at] for names in by], columns)
    return groups


def _refuse_written_otherwise(sources: list[Source], names: list[str], columns: Sequence[Column]) -> None:
    """Refuses a number that is another text in the other file, such as 1.0 or 01 for 1: they may be meant to be equal.

    In one file, the numbers of a column (as JSON has them) are compared with its text.
    """
    whose = [(source.name, name) for source, name in zip(sources, names)]
    if len(columns) == 2:
        sides = [_different(column) for column in columns]
    elif "numbers" in columns[0].kinds():
        found = _different(columns[0])
        sides = [{one: None for one in found if isinstance(one, str) is is_text} for is_text in (True, False)]
        whose *= 2
    else:
        return
    alone = [[value for value in side if value not in other] for side, other in zip(sides, sides[::-1])]
    for side, (values, other) in enumerate(zip(alone, sides[::-1])):
        lookalikes = {_number_of(value): value for value in (other if values else ())}
        lookalikes.pop(None, None)
        for value in values:
            alike = lookalikes.get(_number_of(value))
            if alike is not None:
                (own, column), (others, _) = whose[side], whose[1 - side]
                raise FileError(
                    f"{own} has {value!r} in column {column}, and {others} has {alike!r} there: write the values alike"
                )


def _different(column: Column) -> dict[Any, None]:
    """The different values of a column, in the order in which they appear."""
    return dict.fromkeys(column.present.tolist())


def _number_of(value: Any) -> Any:
    """The number that a value is, or is written as; None if there is none."""
    found = number(value) if isinstance(value, str) else value if type(value) in (int, float) else None
    return found if found == found else None


def check_memory(path: str, contents: str, needed: int) -> None:
    """Refuses a file whose boxes need `needed` bytes to be searched, if this machine has not that much memory."""
    try:
        memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, ValueError, OSError):
        return
    if needed > memory:
        gigabytes = f"{needed / 1e9:.0f} GB of memory, and this machine has {memory / 1e9:.0f} GB"
        is_parquet = path.endswith((".parquet", ".geoparquet"))
        way = "--memory-limit searches them" if is_parquet else "a Parquet file can be searched"
        raise FileError(f"{path} has {contents}; searching them takes about {gigabytes}; {way} from disk")
