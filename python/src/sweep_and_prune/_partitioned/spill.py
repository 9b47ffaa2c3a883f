"""The shuffle: boxes go to the cells that they touch through files, which any worker reads."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .cells import Cells
from .dataset import DatasetError
from .files import digest_of, part_of, read_sealed, write_sealed
from .search import Boxes


class Counts(NamedTuple):
    """What a spill file contains."""

    boxes: int
    """The number of boxes, each once."""
    groups: list[int]
    """The number of boxes of each cell, and of the wide ones."""
    digest: str
    """A checksum of the file."""


def scatter(blocks: Iterable[Boxes], cells: Cells, path: Path, id_type: str, dtype: str) -> Counts:
    """Writes boxes to a file, grouped by cell. The file and its counts appear when they are complete.

    It is a file of Arrow. Each block of boxes is one record batch for each cell and one for the wide boxes, so that a
    cell is read without the others.
    """
    import pyarrow

    half = cells.dimensions
    number = pyarrow.float32() if dtype == "float32" else pyarrow.float64()
    box_type = pyarrow.list_(number, 2 * half)
    id_kind = getattr(pyarrow, id_type)()
    schema = pyarrow.schema([("id", id_kind), ("box", box_type)])
    part = part_of(path)
    groups = np.zeros(cells.number + 1, np.int64)
    boxes = 0
    try:
        with pyarrow.OSFile(str(part), "wb") as sink, pyarrow.ipc.new_file(sink, schema) as writer:
            for block in blocks:
                boxes += len(block.rows)
                rows, starts = cells.assign(block.rows)
                groups += np.diff(starts)
                for start, end in zip(starts[:-1].tolist(), starts[1:].tolist()):
                    of_group = block.take(rows[start:end])
                    flat = pyarrow.array(of_group.rows.reshape(-1), number)
                    columns = [
                        pyarrow.array(of_group.ids, id_kind),
                        pyarrow.FixedSizeListArray.from_arrays(flat, type=box_type),
                    ]
                    writer.write_batch(pyarrow.record_batch(columns, schema=schema))
        digest = digest_of(part)
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise
    counts = Counts(boxes, groups.tolist(), digest)
    write_sealed(_counts_path(path), counts._asdict())
    return counts


def _counts_path(path: Path) -> Path:
    return path.with_suffix(".json")


def counts_of(path: Path) -> Counts | None:
    """What a spill file contains; None if it is not complete."""
    try:
        return Counts(**read_sealed(_counts_path(path)))
    except (OSError, ValueError, TypeError):
        return None


def forget_if_damaged(path: Path) -> None:
    """Removes a spill file and its counts if they do not match, so that they are written again."""
    counts = counts_of(path)
    try:
        if counts is not None and digest_of(path) == counts.digest:
            return
    except OSError:
        pass
    forget(path)


def forget(path: Path) -> None:
    """Removes a spill file and its counts."""
    for one in (_counts_path(path), path):
        one.unlink(missing_ok=True)


def read_groups(paths: Iterable[Path], group: int, groups: int) -> Iterator[Boxes]:
    """The boxes of a group, block by block."""
    for path in paths:
        yield from _read_group(path, group, groups)


def _read_group(path: Path, group: int, groups: int) -> Iterator[Boxes]:
    import pyarrow

    try:
        with pyarrow.OSFile(str(path), "rb") as source, pyarrow.ipc.open_file(source) as reader:
            for batch in range(group, reader.num_record_batches, groups):
                table = reader.get_batch(batch)
                if len(table):
                    yield _boxes(table)
    except FileNotFoundError:
        raise DatasetError(f"{path} is missing: something removed it; call again, and it is written again") from None
    except (pyarrow.ArrowException, OSError) as error:
        raise DatasetError(f"{path} cannot be read: {error}; call again, and it is written again") from None


def _boxes(table: Any) -> Boxes:
    box = table.column("box")
    width = box.type.list_size
    rows = box.values.to_numpy(zero_copy_only=False).reshape(len(table), width)
    return Boxes(table.column("id").to_numpy(zero_copy_only=False), rows)


def gathered(blocks: Iterable[Boxes], rows: int) -> Iterator[Boxes]:
    """The boxes of many small blocks in blocks of `rows` boxes; the last one may have fewer."""
    waiting: list[Boxes] = []
    number = 0
    for block in blocks:
        while number + len(block.rows) >= rows:
            taken = rows - number
            waiting.append(Boxes(block.ids[:taken], block.rows[:taken]))
            yield _joined(waiting)
            waiting, number = [], 0
            block = Boxes(block.ids[taken:], block.rows[taken:])
        if len(block.rows):
            waiting.append(block)
            number += len(block.rows)
    if waiting:
        yield _joined(waiting)


def _joined(blocks: list[Boxes]) -> Boxes:
    if len(blocks) == 1:
        return blocks[0]
    return Boxes(np.concatenate([block.ids for block in blocks]), np.concatenate([block.rows for block in blocks]))
