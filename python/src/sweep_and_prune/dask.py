"""The join of more boxes than fit in memory: on one machine with files, or on a cluster of Dask.

`find_pairs` and its relatives have the names and the rules of the package itself. They take files of Parquet and text,
Dask DataFrames and Dask arrays. Needs `pip install "sweep-and-prune[dask]"`.

```python
import sweep_and_prune.dask as sap

# One machine: at most 4 GB of memory for this process and its workers together.
pairs = sap.find_pairs("boxes.parquet", out="pairs", memory_limit="4GB")
```

Space is split into cells with about equally many boxes, by a sample. A box goes to each cell that it touches; each
cell is one call of the finder; a pair is reported by the cell that contains the lower corner of its intersection.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from datetime import timedelta
from hashlib import sha256
from pathlib import Path
from typing import Any, NamedTuple, Union

import numpy as np

from ._crs import difference
from ._inputs import checked_format
from ._native import processors
from ._partitioned.boxes import InvalidRowError, list_files
from ._partitioned.dataset import DatasetError, Manifest, read_manifest
from ._partitioned.files import checked_path
from ._partitioned.folder import boxes_of
from ._partitioned.plain import Options, Wanted, is_plain, plain_boxes
from ._partitioned.plan import ARGUMENTS
from ._partitioned.run import Job, Source, refuse_own_files, run, source_of_files
from ._partitioned.workers import active_client, memory_of
from ._progress import ProgressBar

__all__ = [
    "DatasetError",
    "InvalidRowError",
    "Manifest",
    "count_pairs",
    "count_pairs_between",
    "find_pairs",
    "find_pairs_between",
    "read_manifest",
]

Names = Union[Sequence[str], None]
By = Union[str, list[str], None]
Limit = Union[int, str, None]
Progress = Union[bool, Callable[[float], object]]


def find_pairs(
    boxes: Any,
    *,
    out: str | os.PathLike[str] | None = None,
    ids: str | None = None,
    columns: Names = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    by: By = None,
    header: bool | None = None,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    overwrite: bool = False,
    progress: Progress = True,
) -> Any:
    """Finds all pairs of boxes that overlap, of more boxes than fit in memory.

    With `out`, the pairs are written to a dataset of Parquet files, one for each cell. This happens on the workers of
    the active client of Dask, which must see the same files, or else on local workers. A call that was interrupted
    (the process was killed, the disk was full) continues where it stopped when it is repeated. A finished dataset has
    a manifest: see `read_manifest`. A call that is repeated after that returns the dataset at once.

    Without `out`, the result is lazy: a graph of Dask, whose shuffle moves the boxes. Only a sample is read at once; of
    a Dask collection, each partition is computed once for its length.

    As a set, the pairs do not depend on cells, partitions, workers or failures. Time O(n log n + pairs). A box is
    written once, read once, and copied to each cell that it touches (1.02 times on average for small boxes).

    Boxes of CSV, TSV, BED, narrowPeak, broadPeak, bedGraph, GTF, GFF3 and VCF files, boxes of times, and those in
    groups (`by`) are first written to Parquet files of numbers, by one thread, which takes as much space again. Text is
    read twice if there are groups. Times over 2^53 of their unit (104 days in nanoseconds), and boxes of three
    dimensions in groups, are errors.

    Args:
        boxes: a Dask DataFrame, a Dask array of shape `(n, 2 * D)`, or files of Parquet or text: a path, a pattern such
            as `"boxes-*.parquet"`, a folder of Parquet files, an address such as `"s3://bucket/boxes"`, or several of
            these. GeoParquet is known, too: its column `bbox`, or the bounds of its geometries.
        out: a folder for the pairs. Until they are complete, it is called `out` + `".unfinished"`. Neither folder may
            have files of anything else: that is an error, and nothing is changed.
        ids: a column with an id for each box, whole numbers or text, each only once; by default, boxes are numbered
            from 0 in the order of files and rows.
        columns: the columns of the boxes, min corner and then max corner; by default, those with known names, such as
            `minx, miny, maxx, maxy`.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, as in `sweep_and_prune.find_pairs`; so the next three.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: finds boxes within this distance on each axis, too; a `timedelta` for times.
        by: only boxes of files with equal values in this column, or in each column of a list, pair. Boxes of BED and
            the like pair within their chromosome.
        header: whether the first row of a CSV file names its columns; by default, if it has text.
        memory_limit: for this process and its local workers together, in bytes or as text such as `"4GB"`; by default,
            half of the machine's memory. Workers of an active client have their own limits besides.
        workers: how many local workers; 0 for none but this process. By default, one for each processor, and none
            for few boxes.
        spill: a folder for the boxes on their way to the cells; by default, within `out`. They take as much space as
            the boxes themselves, uncompressed.
        cells: how many cells at most; by default, one for each million boxes, or more if memory is short.
        overwrite: replaces a finished dataset, once the new one is complete, or an interrupted run of other boxes.
        progress: `True` shows a bar on a terminal; a function is called with the share of the work that is done.

    Returns:
        A Dask DataFrame with the columns `a` and `b`: the ids of two boxes, the smaller one first, in no order.

    Raises:
        InvalidRowError: for the first box that is inverted or has a NaN; it names the file and the row. Without `out`,
            it is raised when the graph is computed, for one of them.
        DatasetError: if a file is missing, damaged or of another form, the disk is full, workers died too often, or
            `out` contains something else.
        ValueError: for unknown options.

    >>> import numpy as np, dask.array
    >>> import sweep_and_prune.dask as sap
    >>> boxes = dask.array.from_array(np.array([[0, 0, 2, 2], [5, 5, 6, 6], [2, 1, 3, 4]]), chunks=2)
    >>> sap.find_pairs(boxes).compute()
       a  b
    0  0  2
    """
    asked = _asked([boxes], ids, columns, by, format, closed, missing, margin, header)
    return _found(asked, out, memory_limit, workers, spill, cells, overwrite, progress)


def find_pairs_between(
    a: Any,
    b: Any,
    *,
    out: str | os.PathLike[str] | None = None,
    ids: str | tuple[str | None, str | None] | None = None,
    columns: Names | tuple[Names, Names] = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    by: By | tuple[By, By] = None,
    header: bool | None = None,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    overwrite: bool = False,
    progress: Progress = True,
) -> Any:
    """Finds all pairs of a box of `a` and a box of `b` that overlap, of more boxes than fit in memory.

    Otherwise as `find_pairs`. If one set is in double precision, both are compared in double precision.

    Args:
        a: a Dask DataFrame, a Dask array or files.
        b: another of these.
        out: a folder for the pairs.
        ids: a column with an id for each box; a tuple of two names if they differ.
        columns: the columns of the boxes, in both sets; a tuple of two lists if they differ.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: finds boxes within this distance on each axis, too; a `timedelta` for times.
        by: only boxes of files with equal values pair; a tuple of two if the columns differ.
        header: whether the first row of a CSV file names its columns.
        memory_limit: for this process and its local workers together.
        workers: how many local workers; 0 for none but this process.
        spill: a folder for the boxes on their way to the cells.
        cells: how many cells at most.
        overwrite: replaces a finished dataset, once the new one is complete, or an interrupted run of other boxes.
        progress: `True`, or a function of the share of the work that is done.

    Returns:
        A Dask DataFrame with the columns `a` and `b`: the ids of a box of `a` and of a box of `b`, in no order.

    Raises:
        InvalidRowError, DatasetError, ValueError: as `find_pairs`.

    >>> import numpy as np, dask.array
    >>> import sweep_and_prune.dask as sap
    >>> bullets = dask.array.from_array(np.array([[0, 0, 1, 1], [5, 5, 6, 6]]))
    >>> targets = dask.array.from_array(np.array([[4, 4, 7, 7]]))
    >>> sap.find_pairs_between(bullets, targets).compute()
       a  b
    0  1  0
    """
    asked = _asked([a, b], ids, columns, by, format, closed, missing, margin, header)
    return _found(asked, out, memory_limit, workers, spill, cells, overwrite, progress)


def count_pairs(
    boxes: Any,
    *,
    columns: Names = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    by: By = None,
    header: bool | None = None,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    progress: Progress = True,
) -> int:
    """Counts the pairs that `find_pairs` finds, without storing them. Computes at once.

    Args:
        boxes: a Dask DataFrame, a Dask array or files.
        columns: the columns of the boxes.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: counts boxes within this distance on each axis, too; a `timedelta` for times.
        by: only boxes of files with equal values pair, as in `find_pairs`.
        header: whether the first row of a CSV file names its columns.
        memory_limit: for this process and its local workers together.
        workers: how many local workers; 0 for none but this process.
        spill: a folder for the boxes on their way to the cells; by default, that of temporary files.
        cells: how many cells at most.
        progress: `True`, or a function of the share of the work that is done.

    Raises:
        InvalidRowError, DatasetError, ValueError: as `find_pairs`.

    >>> import numpy as np, dask.array
    >>> import sweep_and_prune.dask as sap
    >>> sap.count_pairs(dask.array.zeros((1000, 6), chunks=(100, 6)))
    499500
    """
    asked = _asked([boxes], None, columns, by, format, closed, missing, margin, header)
    return _counted(asked, memory_limit, workers, spill, cells, progress)


def count_pairs_between(
    a: Any,
    b: Any,
    *,
    columns: Names | tuple[Names, Names] = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    by: By | tuple[By, By] = None,
    header: bool | None = None,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    progress: Progress = True,
) -> int:
    """Counts the pairs that `find_pairs_between` finds, without storing them. Computes at once.

    Args:
        a: a Dask DataFrame, a Dask array or files.
        b: another of these.
        columns: the columns of the boxes, in both sets; a tuple of two lists if they differ.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: counts boxes within this distance on each axis, too; a `timedelta` for times.
        by: only boxes of files with equal values pair, as in `find_pairs`.
        header: whether the first row of a CSV file names its columns.
        memory_limit: for this process and its local workers together.
        workers: how many local workers; 0 for none but this process.
        spill: a folder for the boxes on their way to the cells; by default, that of temporary files.
        cells: how many cells at most.
        progress: `True`, or a function of the share of the work that is done.

    Raises:
        InvalidRowError, DatasetError, ValueError: as `find_pairs`.

    >>> import numpy as np, dask.array
    >>> import sweep_and_prune.dask as sap
    >>> a, b = dask.array.zeros((20, 4)), dask.array.ones((10, 4))
    >>> sap.count_pairs_between(a, b, margin=1)
    200
    """
    asked = _asked([a, b], None, columns, by, format, closed, missing, margin, header)
    return _counted(asked, memory_limit, workers, spill, cells, progress)


class _Asked(NamedTuple):
    """What the user asked for, and for each set: what it is, its columns, those of its groups, and that of its ids."""

    sets: list[Any]
    names: tuple[str, ...]
    columns: list[list[str] | None]
    by: list[list[str]]
    ids: list[str | None]
    options: Options


def _asked(
    sets: list[Any],
    ids: Any,
    columns: Any,
    by: Any,
    format: str,
    closed: str | None,
    missing: str,
    margin: Any,
    header: bool | None,
) -> _Asked:
    names_of_sets = ARGUMENTS[len(sets) - 1]
    for boxes, name in zip(sets, names_of_sets):
        _refuse_other_boxes(boxes, name)
    checked_format(format)
    if missing not in ("raise", "skip"):
        raise ValueError(f'missing must be "raise" or "skip", not {missing!r}')
    if closed not in (None, "both", "left", "right", "neither"):
        raise ValueError(f'closed must be "both", "left", "right" or "neither", not {closed!r}')
    if isinstance(columns, (str, bytes)):
        raise TypeError(f"columns must be a list of names, such as [{columns!r}, ..], not the text {columns!r}")
    are_names = columns is None or all(isinstance(one, str) for one in columns)
    of_sides = [columns] * len(sets) if are_names else _of_sides("columns", columns, len(sets))
    return _Asked(
        sets,
        names_of_sets,
        [list(names) if names else None for names in of_sides],
        [_names_of_groups(one) for one in _of_sides("by", by, len(sets))],
        _of_sides("ids", ids, len(sets)),
        Options(format, closed, missing, _checked_margin(margin), header),
    )


def _of_sides(name: str, given: Any, number: int) -> list[Any]:
    """What an argument says for each set; of two sets, a tuple says it for each."""
    if not isinstance(given, tuple):
        return [given] * number
    if len(given) != number or number == 1:
        raise ValueError(f"{name} must be of one set or a tuple for two, not {given!r}")
    return list(given)


def _names_of_groups(by: Any) -> list[str]:
    names = [] if by is None else [by] if isinstance(by, str) else by
    if not (isinstance(names, list) and all(isinstance(name, str) for name in names)):
        raise TypeError(f"by must be the name of a column, or a list of names, not {by!r}")
    return names


def _checked_margin(margin: Any) -> Any:
    if isinstance(margin, (timedelta, np.timedelta64)):
        return margin
    margins = [float(one) for one in margin] if hasattr(margin, "__len__") else float(margin)
    return margins or 0


@contextmanager
def _sources(
    asked: _Asked, out: Path | None, spill: Path | None, memory_limit: Limit, progress: Progress
) -> Iterator[list[Source]]:
    """The sets of boxes as a run reads them."""
    if any(hasattr(boxes, "to_delayed") for boxes in asked.sets):
        yield _checked([_source(asked, number, out) for number in range(len(asked.sets))])
        return
    wanted = _wanted(asked)
    if is_plain(wanted, asked.options):
        yield _checked([_source(asked, number, out) for number in range(len(asked.sets))])
        return
    if out is not None:
        for boxes, one in zip(asked.sets, wanted):
            refuse_own_files(boxes, one.files, out)
    with _folder_for_plain(out, spill) as folder, _shown(progress, "reading boxes") as report:
        with plain_boxes(wanted, asked.options, folder, memory_of(memory_limit), report) as sources:
            report(1.0)
            yield sources


@contextmanager
def _folder_for_plain(out: Path | None, spill: Path | None) -> Iterator[Path]:
    """Where boxes of other files than Parquet go: the same folder for the same `out`, so that a run can continue."""
    if out is None:
        with tempfile.TemporaryDirectory(prefix="sweep-and-prune-", dir=spill) as folder:
            yield Path(folder)
    elif spill is None:
        yield boxes_of(out)
    else:
        yield spill / f"sweep-and-prune-{sha256(os.path.abspath(out).encode()).hexdigest()[:32]}"


def _wanted(asked: _Asked) -> list[Wanted]:
    """The sets of boxes, which are all of files."""
    return [
        Wanted(name, list_files(boxes), columns, ids, by)
        for boxes, name, columns, ids, by in zip(asked.sets, asked.names, asked.columns, asked.ids, asked.by)
    ]


def _checked(sources: list[Source]) -> list[Source]:
    """Sets of boxes that can be compared, in one precision."""
    apart = difference(*(source.crs for source in sources)) if len(sources) == 2 else None
    if apart is not None:
        raise ValueError(
            f"a and b have different coordinate reference systems, {apart[0]} and {apart[1]}: convert one of them"
        )
    # Ends and margins depend on the precision, so it is that of both sets before they are applied.
    dtype = max(source.form.dtype for source in sources)
    return [source._replace(form=source.form._replace(dtype=dtype)) for source in sources]


def _refuse_other_boxes(boxes: Any, name: str) -> None:
    if hasattr(boxes, "to_delayed"):
        return
    is_path = isinstance(boxes, (str, os.PathLike))
    if not is_path and not (
        isinstance(boxes, (list, tuple)) and all(isinstance(one, (str, os.PathLike)) for one in boxes)
    ):
        raise TypeError(
            f"{name} must be a Dask DataFrame, a Dask array or paths of files, not a {type(boxes).__name__}; "
            "sweep_and_prune.find_pairs takes arrays and data frames in memory"
        )
    if not [checked_path(path, name) for path in ([boxes] if is_path else boxes)]:
        raise ValueError(f"{name} is an empty list: pass the path of one file or more")


def _source(asked: _Asked, number: int, out: Path | None) -> Source:
    """A set of boxes that a run reads as it is."""
    boxes, columns, ids = asked.sets[number], asked.columns[number], asked.ids[number]
    options = {name: getattr(asked.options, name) for name in ("format", "closed", "missing", "margin")}
    if any(asked.by) or isinstance(options["margin"], (timedelta, np.timedelta64)):
        raise ValueError(
            "by and a timedelta as margin are for files: write the collection to Parquet files first (to_parquet)"
        )
    if hasattr(boxes, "to_delayed"):
        from ._partitioned.graph import source_of_collection

        return source_of_collection(boxes, columns, ids, asked.names[number], options, out is not None)
    return source_of_files(boxes, columns, ids, options, out)


def _found(
    asked: _Asked,
    out: str | os.PathLike[str] | None,
    memory_limit: Limit,
    workers: int | None,
    spill: str | os.PathLike[str] | None,
    cells: int | None,
    overwrite: bool,
    progress: Progress,
) -> Any:
    if out is None:
        if memory_limit is not None or workers is not None or spill is not None or overwrite:
            raise ValueError(
                "memory_limit, workers, spill and overwrite are for pairs that are written: pass out, a folder for "
                "them. Without out, the workers of Dask and their limits are used"
            )
        from ._partitioned.graph import lazy_pairs

        _refuse_lazy(asked)
        with _sources(asked, None, None, None, False) as sources:
            return lazy_pairs(sources, _cells(cells), _threads())
    place, folder = checked_path(out, "out"), _folder(spill)
    with _sources(asked, place, folder, memory_limit, progress) as sources:
        with _shown(progress, "finding pairs") as report:
            run(sources, Job(place, memory_limit, workers, folder, overwrite, _cells(cells), report))
    import dask.dataframe

    return dask.dataframe.read_parquet(os.fspath(out))


def _refuse_lazy(asked: _Asked) -> None:
    if any(hasattr(boxes, "to_delayed") for boxes in asked.sets):
        return
    if not is_plain(_wanted(asked), asked.options):
        raise ValueError("boxes of text, of times or in groups go through files: pass out, a folder for the pairs")


def _counted(
    asked: _Asked,
    memory_limit: Limit,
    workers: int | None,
    spill: str | os.PathLike[str] | None,
    cells: int | None,
    progress: Progress,
) -> int:
    folder = _folder(spill)
    with _sources(asked, None, folder, memory_limit, progress) as sources:
        is_for_dask = active_client() is not None or any(source.partitions for source in sources)
        if is_for_dask and memory_limit is None and workers is None and spill is None:
            from ._partitioned.graph import lazy_count

            with _shown(progress, "counting") as report:
                number = lazy_count(sources, _cells(cells), _threads())
                report(1.0)
            return number
        with _shown(progress, "counting") as report:
            return run(sources, Job(None, memory_limit, workers, folder, False, _cells(cells), report)).pairs


def _shown(progress: Progress, what: str) -> ProgressBar:
    return ProgressBar(what, progress if callable(progress) else None, bool(progress) and sys.stderr.isatty())


def _folder(spill: str | os.PathLike[str] | None) -> Path | None:
    return None if spill is None else checked_path(spill, "spill")


def _cells(cells: int | None) -> int | None:
    if cells is not None and not (isinstance(cells, int) and cells >= 1):
        raise ValueError(f"cells must be a whole number of 1 or more, not {cells!r}")
    return cells


def _threads() -> int:
    """How many cells at least, so that all threads of the workers are busy."""
    client = active_client()
    if client is None:
        return 4 * processors()
    return 4 * max(1, int(sum(client.nthreads().values())))
