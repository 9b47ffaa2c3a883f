"""The join of more boxes than fit in memory: on one machine with files, or on a cluster of Dask.

`find_pairs` and its relatives have the names and the rules of the package itself. They take Parquet files, Dask
DataFrames and Dask arrays. Needs `pip install "sweep-and-prune[dask]"`.

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
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, Union

from ._crs import difference
from ._inputs import checked_format
from ._partitioned.boxes import InvalidRowError
from ._partitioned.dataset import DatasetError, Manifest, read_manifest
from ._partitioned.files import checked_path
from ._partitioned.run import Job, Source, run, source_of_files
from ._partitioned.workers import active_client
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

    Args:
        boxes: a Dask DataFrame, a Dask array of shape `(n, 2 * D)`, or Parquet files: a path, a pattern such as
            `"boxes-*.parquet"`, a folder, an address such as `"s3://bucket/boxes"`, or several of these. GeoParquet
            is known, too: its column `bbox`, or the bounds of its geometries.
        out: a folder for the pairs. Until they are complete, it is called `out` + `".unfinished"`. Neither folder may
            have files of anything else: that is an error, and nothing is changed.
        ids: a column with an id for each box, whole numbers or text, each only once; by default, boxes are numbered
            from 0 in the order of files and rows.
        columns: the columns of the boxes, min corner and then max corner; by default, those with known names, such as
            `minx, miny, maxx, maxy`.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`, as in `sweep_and_prune.find_pairs`; so the next three.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: finds boxes within this distance on each axis, too.
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
    sources = _sources([boxes], [ids], columns, format, closed, missing, margin, ["boxes"], out)
    return _found(sources, out, memory_limit, workers, spill, cells, overwrite, progress)


def find_pairs_between(
    a: Any,
    b: Any,
    *,
    out: str | os.PathLike[str] | None = None,
    ids: str | tuple[str | None, str | None] | None = None,
    columns: Names = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
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
        a: a Dask DataFrame, a Dask array or Parquet files.
        b: another of these.
        out: a folder for the pairs.
        ids: a column with an id for each box; a tuple of two names if they differ.
        columns: the columns of the boxes, in both sets.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: finds boxes within this distance on each axis, too.
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
    both = list(ids) if isinstance(ids, tuple) else [ids, ids]
    sources = _sources([a, b], both, columns, format, closed, missing, margin, ["a", "b"], out)
    return _found(sources, out, memory_limit, workers, spill, cells, overwrite, progress)


def count_pairs(
    boxes: Any,
    *,
    columns: Names = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    progress: Progress = True,
) -> int:
    """Counts the pairs that `find_pairs` finds, without storing them. Computes at once.

    Args:
        boxes: a Dask DataFrame, a Dask array or Parquet files.
        columns: the columns of the boxes.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: counts boxes within this distance on each axis, too.
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
    sources = _sources([boxes], [None], columns, format, closed, missing, margin, ["boxes"], None)
    return _counted(sources, memory_limit, workers, spill, cells, progress)


def count_pairs_between(
    a: Any,
    b: Any,
    *,
    columns: Names = None,
    format: str = "xyxy",
    closed: str | None = None,
    missing: str = "raise",
    margin: Any = 0,
    memory_limit: Limit = None,
    workers: int | None = None,
    spill: str | os.PathLike[str] | None = None,
    cells: int | None = None,
    progress: Progress = True,
) -> int:
    """Counts the pairs that `find_pairs_between` finds, without storing them. Computes at once.

    Args:
        a: a Dask DataFrame, a Dask array or Parquet files.
        b: another of these.
        columns: the columns of the boxes, in both sets.
        format: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: `"both"`, `"left"`, `"right"` or `"neither"`.
        missing: `"raise"` or `"skip"`.
        margin: counts boxes within this distance on each axis, too.
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
    sources = _sources([a, b], [None, None], columns, format, closed, missing, margin, ["a", "b"], None)
    return _counted(sources, memory_limit, workers, spill, cells, progress)


def _sources(
    sets: list[Any],
    ids: list[str | None],
    columns: Names,
    format: str,
    closed: str | None,
    missing: str,
    margin: Any,
    names: list[str],
    out: str | os.PathLike[str] | None,
) -> list[Source]:
    place = None if out is None else checked_path(out, "out")
    checked_format(format)
    if missing not in ("raise", "skip"):
        raise ValueError(f'missing must be "raise" or "skip", not {missing!r}')
    if closed not in (None, "both", "left", "right", "neither"):
        raise ValueError(f'closed must be "both", "left", "right" or "neither", not {closed!r}')
    if isinstance(columns, (str, bytes)):
        raise TypeError(f"columns must be a list of names, such as [{columns!r}, ..], not the text {columns!r}")
    margins = [float(one) for one in margin] if hasattr(margin, "__len__") else float(margin)
    options = {"format": format, "closed": closed, "missing": missing, "margin": margins or 0}
    sources = [
        _source(boxes, list(columns) if columns else None, of_set, name, options, place)
        for boxes, of_set, name in zip(sets, ids, names)
    ]
    apart = difference(*(source.crs for source in sources)) if len(sources) == 2 else None
    if apart is not None:
        raise ValueError(
            f"a and b have different coordinate reference systems, {apart[0]} and {apart[1]}: convert one of them"
        )
    return sources


def _source(
    boxes: Any, columns: list[str] | None, ids: str | None, name: str, options: dict[str, Any], out: Path | None
) -> Source:
    if hasattr(boxes, "to_delayed"):
        from ._partitioned.graph import source_of_collection

        return source_of_collection(boxes, columns, ids, name, options)
    is_path = isinstance(boxes, (str, os.PathLike))
    if not is_path and not (
        isinstance(boxes, (list, tuple)) and all(isinstance(one, (str, os.PathLike)) for one in boxes)
    ):
        raise TypeError(
            f"{name} must be a Dask DataFrame, a Dask array or paths of Parquet files, not a {type(boxes).__name__}; "
            "sweep_and_prune.find_pairs takes arrays and data frames in memory"
        )
    paths = [checked_path(path, name) for path in ([boxes] if is_path else boxes)]
    if not paths:
        raise ValueError(f"{name} is an empty list: pass the path of one Parquet file or more")
    return source_of_files(boxes, columns, ids, options, out)


def _found(
    sources: list[Source],
    out: str | os.PathLike[str] | None,
    memory_limit: Limit,
    workers: int | None,
    spill: str | os.PathLike[str] | None,
    cells: int | None,
    overwrite: bool,
    progress: Progress,
) -> Any:
    if out is None:
        if memory_limit is not None or workers is not None:
            raise ValueError(
                "memory_limit and workers are for pairs that are written: pass out, a folder for them. Without out, "
                "the workers of Dask and their limits are used"
            )
        from ._partitioned.graph import lazy_pairs

        return lazy_pairs(sources, _cells(cells), _threads())
    with _shown(progress, "finding pairs") as report:
        run(sources, Job(Path(out), memory_limit, workers, _folder(spill), overwrite, _cells(cells), report))
    import dask.dataframe

    return dask.dataframe.read_parquet(os.fspath(out))


def _counted(
    sources: list[Source],
    memory_limit: Limit,
    workers: int | None,
    spill: str | os.PathLike[str] | None,
    cells: int | None,
    progress: Progress,
) -> int:
    is_for_dask = active_client() is not None or any(source.partitions for source in sources)
    if is_for_dask and memory_limit is None and workers is None and spill is None:
        from ._partitioned.graph import lazy_count

        return lazy_count(sources, _cells(cells), _threads())
    with _shown(progress, "counting") as report:
        return run(sources, Job(None, memory_limit, workers, _folder(spill), False, _cells(cells), report)).pairs


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
        return 4 * (os.cpu_count() or 1)
    return 4 * max(1, int(sum(client.nthreads().values())))
