"""The join as a graph of Dask: the same cells, with the shuffle of Dask instead of files."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats
from .boxes import Chunk, Form, id_type_of, read_chunk
from .cells import Cells, choose_cells, rows_of_sample
from .dataset import DatasetError
from .plan import ARGUMENTS
from .run import CELL_BOXES, SAMPLE_PER_CELL, Source, chunks_of, dimensions_of, sample_of
from .search import Boxes, in_order, search, touches

_SAMPLE_OF_PARTITION = 20_000


def source_of_collection(
    collection: Any, columns: Any, ids: str | None, name: str, options: dict[str, Any], is_written: bool = False
) -> Source:
    """The boxes of a Dask DataFrame or array. Computes each partition once, for its length and a sample.

    If the pairs are written, also for a digest, by which a later call knows whether it has the same boxes.
    """
    import dask

    if hasattr(collection, "divisions"):
        form = _form_of_frame(collection._meta, columns, ids, options)
        # Only ids and coordinates travel; the geometry of a GeoDataFrame has no columns for them.
        if form.kind != "geometry":
            collection = collection[form.names()]
        partitions = list(collection.to_delayed())
    else:
        if columns or ids:
            raise ValueError("columns and ids name columns: a Dask array has none, so leave them out")
        if collection.ndim != 2:
            raise ValueError(f"{name} must be a Dask array of shape (n, 2), (n, 4) or (n, 6), not {collection.shape}")
        form = Form([], "array", None, "int64", "float32" if collection.dtype == np.float32 else "float64", **options)
        partitions = list(collection.rechunk({1: -1}).to_delayed().ravel())
    lenient = form._replace(missing="skip", ids=None)
    summary = dask.delayed(_summary, pure=False)
    summaries = dask.compute([summary(one, lenient, name, form if is_written else None) for one in partitions])[0]
    samples = [sample for _, sample, _ in summaries if len(sample)]
    sample = np.concatenate(samples) if samples else None
    meta = getattr(collection, "_meta", None)
    crs = getattr(meta, "crs", None) if form.kind == "geometry" else None
    return Source([], partitions, [rows for rows, *_ in summaries], form, sample, crs, [each[2] for each in summaries])


def _form_of_frame(meta: Any, columns: Any, ids: str | None, options: dict[str, Any]) -> Form:
    import pyarrow

    from .._inputs import box_columns, listed, refuse_sizes, unknown_columns

    names = [str(name) for name in meta.columns]
    kind, chosen = "chosen", list(columns or [])
    if not chosen and hasattr(meta, "total_bounds"):
        kind, chosen = "geometry", [meta.geometry.name]
        refuse_sizes(options["format"], "boxes")
    elif not chosen:
        kind, chosen = "recognized", box_columns(names, options["format"])
    if not chosen:
        raise DatasetError(
            f"boxes has no columns that are known as boxes: {unknown_columns(names, 'choose them by columns')}; "
            f"{listed(names)}"
        )
    for name in chosen + ([ids] if ids is not None else []):
        if name not in names:
            raise DatasetError(f"boxes has no column {name!r}; {listed(names)}")
    id_type = "int64"
    if ids is not None:
        schema = pyarrow.Schema.from_pandas(meta[[ids]], preserve_index=False)
        kind_of_ids = schema.field(0).type
        # A column of objects has no type while it is empty.
        is_object = pyarrow.types.is_null(kind_of_ids)
        id_type = "large_string" if is_object else id_type_of(kind_of_ids, f"column {ids}")
    return Form(chosen, kind, ids, id_type, "float64", **options).in_precision_of(meta)


def _summary(table: Any, form: Form, name: str, digested: Form | None) -> tuple[int, Floats, str]:
    rows = len(table)
    digest = "" if digested is None else _digest(table, digested, name)
    of_sample = rows_of_sample(rows, max(1, rows // _SAMPLE_OF_PARTITION))
    sampled = table.iloc[of_sample] if hasattr(table, "iloc") else table[of_sample]
    try:
        return rows, form.read(sampled, name, 0, 0, name).rows, digest
    except ValueError:  # reading the whole partition reports it
        return rows, np.empty((0, 0)), digest


def _digest(table: Any, form: Form, name: str) -> str:
    """A checksum of all coordinates and ids."""
    known = hashlib.blake2b(digest_size=16)
    try:
        columns = [form.raw(table, name).array]
        if form.ids is not None:
            columns.append(form.ids_of(table, name, 0))
    except (TypeError, ValueError):  # reading the whole partition reports it
        return ""
    for column in columns:
        known.update(repr(column.tolist()).encode() if column.dtype.kind == "O" else column.tobytes())
    return known.hexdigest()


def lazy_pairs(sources: list[Source], cells: int | None, least_cells: int) -> Any:
    """A Dask DataFrame of the pairs, with the columns `a` and `b`."""
    import dask.dataframe

    return dask.dataframe.from_delayed(
        _joined(sources, cells, least_cells, False), meta=_meta(sources), verify_meta=False
    )


def lazy_count(sources: list[Source], cells: int | None, least_cells: int) -> int:
    """Computes the number of the pairs."""
    import dask

    return int(sum(dask.compute(_joined(sources, cells, least_cells, True))[0]))


def _joined(sources: list[Source], wanted: int | None, least: int, is_counted: bool) -> list[Any]:
    """The pairs of each cell, or their number, as delayed objects."""
    import dask
    import dask.dataframe

    delayed = dask.delayed
    total = sum(sum(source.rows) for source in sources)
    if wanted is None:
        wanted = max(-(-total // CELL_BOXES), least if total > CELL_BOXES else 1)
    dtype = "float64" if any(source.form.dtype == "float64" for source in sources) else "float32"
    dimensions = dimensions_of(sources)
    cells = choose_cells(sample_of(sources, SAMPLE_PER_CELL * wanted, dimensions), wanted)
    blocks = [
        delayed(_read, pure=False)(
            sources[chunk.argument].partitions[chunk.source] if sources[chunk.argument].partitions else None,
            sources[chunk.argument].files[chunk.source] if sources[chunk.argument].files else None,
            chunk,
            sources[chunk.argument].form,
            ARGUMENTS[len(sources) - 1][chunk.argument],
            dtype,
        )
        for chunk in chunks_of(sources)
    ]
    is_between = len(sources) == 2
    if cells.number == 1 or not blocks:
        return [delayed(_join_blocks, pure=False)(blocks, cells, is_between, is_counted, _meta(sources))]
    meta = _scattered_meta(sources, dimensions, dtype)
    scattered = [delayed(_scatter, nout=2, pure=False)(block, cells, meta) for block in blocks]
    wide = delayed(_concatenated, pure=False)([one[1] for one in scattered], meta)
    frame = dask.dataframe.from_delayed([one[0] for one in scattered], meta=meta, verify_meta=False)
    # Each cell is a partition.
    shuffled = frame.set_index("cell", divisions=list(range(cells.number + 1)))
    lows, highs = cells.regions()
    join = delayed(_join_cell, pure=False)
    pairs_meta = _meta(sources)
    found = [
        join(partition, wide, lows[cell], highs[cell], is_between, is_counted, pairs_meta)
        for cell, partition in enumerate(shuffled.to_delayed())
    ]
    border = np.full(dimensions, np.inf)
    found.append(join(wide, None, -border, border, is_between, is_counted, pairs_meta))
    return found


def _meta(sources: list[Source]) -> Any:
    import pandas

    types = [_pandas_type(source.form.id_type) for source in (sources[0], sources[-1])]
    return pandas.DataFrame({name: pandas.Series([], dtype=kind) for name, kind in zip("ab", types)})


def _pandas_type(id_type: str) -> Any:
    return "object" if id_type == "large_string" else id_type


def _scattered_meta(sources: list[Source], dimensions: int, dtype: str) -> Any:
    import pandas

    # Ids of two sets may differ in type: each set has its own column then.
    columns = {"cell": "int64", "set": "int8", "id": _common_type(sources)}
    columns.update({f"c{number}": dtype for number in range(2 * dimensions)})
    return pandas.DataFrame({name: pandas.Series([], dtype=kind) for name, kind in columns.items()})


def _common_type(sources: list[Source]) -> Any:
    types = {source.form.id_type for source in sources}
    return types.pop() if len(types) == 1 and "large_string" not in types else "object"


def _read(partition: Any, file: Any, chunk: Chunk, form: Form, name: str, dtype: str) -> tuple[int, Boxes]:
    """The boxes of a chunk and the number of its set."""
    if file is not None:
        blocks = list(read_chunk(file, chunk, form, name, 2**20))
    else:
        blocks = [form.read(partition, f"partition {chunk.source} of {name}", 0, chunk.first, name)]
    rows = np.concatenate([block.rows for block in blocks]).astype(dtype, copy=False)
    return chunk.argument, Boxes(np.concatenate([block.ids for block in blocks]), rows)


def _scatter(block: tuple[int, Boxes], cells: Cells, meta: Any) -> tuple[Any, Any]:
    """A frame with a row for each box and cell that it touches, and one of the wide boxes."""
    argument, boxes = block
    rows, starts = cells.assign(boxes.rows)
    numbers = np.repeat(np.arange(cells.number + 1), np.diff(starts))
    frame = _frame(boxes.take(rows), argument, numbers, meta)
    return frame.iloc[: starts[-2]], frame.iloc[starts[-2] :]


def _frame(boxes: Boxes, argument: int, cells: NDArray[Any], meta: Any) -> Any:
    import pandas

    columns = {"cell": cells, "set": np.full(len(cells), argument, np.int8), "id": boxes.ids.astype(meta["id"].dtype)}
    columns.update({f"c{number}": column for number, column in enumerate(boxes.rows.T)})
    return pandas.DataFrame(columns)


def _concatenated(frames: list[Any], meta: Any) -> Any:
    import pandas

    frames = [frame for frame in frames if len(frame)]
    return pandas.concat(frames, ignore_index=True) if frames else meta


def _sets(frame: Any, is_between: bool) -> list[Boxes]:
    """The boxes of each set in a frame."""
    coordinates = [name for name in frame.columns if name not in ("cell", "set", "id")]
    boxes = Boxes(frame["id"].to_numpy(), np.ascontiguousarray(frame[coordinates].to_numpy()))
    if not is_between:
        return [boxes]
    of_set = frame["set"].to_numpy()
    return [boxes.take(np.flatnonzero(of_set == number)) for number in (0, 1)]


def _join_cell(
    frame: Any,
    wide: Any,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    is_between: bool,
    is_counted: bool,
    meta: Any,
) -> Any:
    own = _sets(frame, is_between)
    found = _Found(is_between, is_counted)
    search(own[0], own[1] if is_between else None, low, found.add)
    if wide is not None and len(wide):
        others = [boxes.take(touches(boxes.rows, low, high)) for boxes in _sets(wide, is_between)]
        search(own[0], others[-1], low, found.add)
        if is_between:
            search(others[0], own[1], low, found.add)
    return found.result(meta)


def _join_blocks(blocks: list[tuple[int, Boxes]], cells: Cells, is_between: bool, is_counted: bool, meta: Any) -> Any:
    found = _Found(is_between, is_counted)
    low = np.full(cells.dimensions, -np.inf)
    sets = []
    for number in range(2 if is_between else 1):
        own = [boxes for argument, boxes in blocks if argument == number and len(boxes.rows)]
        if not own:
            return found.result(meta)
        sets.append(Boxes(np.concatenate([one.ids for one in own]), np.concatenate([one.rows for one in own])))
    search(sets[0], sets[1] if is_between else None, low, found.add)
    return found.result(meta)


class _Found:
    """Pairs of a cell in memory, or their number."""

    def __init__(self, is_between: bool, is_counted: bool) -> None:
        self._is_between, self._is_counted = is_between, is_counted
        self._chunks: list[tuple[NDArray[Any], NDArray[Any]]] = []
        self._number = 0

    def add(self, first: NDArray[Any], second: NDArray[Any]) -> None:
        self._number += len(first)
        if not self._is_counted:
            self._chunks.append((first, second) if self._is_between else in_order(first, second))

    def result(self, meta: Any) -> Any:
        if self._is_counted:
            return self._number
        if not self._chunks:
            return meta
        import pandas

        columns = [np.concatenate([chunk[side] for chunk in self._chunks]) for side in (0, 1)]
        return pandas.DataFrame(
            {name: column.astype(meta[name].dtype, copy=False) for name, column in zip("ab", columns)}
        )
