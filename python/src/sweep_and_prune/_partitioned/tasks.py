"""What workers do: scatter a chunk of boxes to cells, split a cell that is too large, join a cell.

A task reads the plan from the folder of the run, and leaves a file that is complete or not there at all. So it can be
repeated, and a run that was interrupted goes on with the tasks whose files are missing.
"""

from __future__ import annotations

import errno
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._errors import SweepAndPruneError
from .boxes import Chunk, read_chunk
from .cells import Cells, choose_cells, rows_of_sample
from .dataset import DatasetError, has_its_pairs, pair_file
from .files import read_sealed, write_sealed
from .folder import Folders
from .plan import Plan
from .search import Boxes, search, touches
from .spill import counts_of, forget_if_damaged, gathered, read_groups, scatter

_SAMPLE_PER_CELL = 400
_ALL_IN_ONE = 0.8
"""If a cell of the sample has more than this share of the boxes, splitting does not help."""


class Node(NamedTuple):
    """A cell, or the wide boxes of some cells, which are joined among themselves as if they were a cell."""

    name: str
    level: str
    """Which files its boxes are in: the empty string for those of the chunks, or else the node that was split."""
    group: int
    groups: int
    low: list[float]
    high: list[float]
    counts: list[int]
    """The number of boxes of each set."""
    wide: list[tuple[str, int, int]]
    """The levels, groups and numbers of the wide boxes with which it is joined, too."""


class Joined(NamedTuple):
    """The result of a cell."""

    name: str
    pairs: int
    hash: int


def guarded(task: Callable[..., Any], *arguments: Any) -> Any:
    """Calls a task. An error that would occur each time is a result, so that the task is not repeated."""
    try:
        return task(*arguments)
    except SweepAndPruneError as error:
        return error
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return DatasetError(
                f"the disk is full ({error}): free some space, or choose another folder by spill, and call again: "
                "the run continues where it stopped"
            )
        raise


def scatter_chunk(folders: Folders, number: int, rows: int, partition: Any = None) -> int:
    """Writes the boxes of a chunk to its spill file, grouped by cell, and returns how many there are."""
    plan = folders.plan()
    chunk = plan.chunks[number]
    form = plan.forms[chunk.argument]
    return scatter(
        _chunk_boxes(plan, chunk, rows, partition), plan.cells, folders.chunk(number), form.id_type, _dtype(plan)
    ).boxes


def _dtype(plan: Plan) -> str:
    return "float64" if any(form.dtype == "float64" for form in plan.forms) else "float32"


def _chunk_boxes(plan: Plan, chunk: Chunk, rows: int, partition: Any) -> Iterator[Boxes]:
    form, name = plan.forms[chunk.argument], plan.name(chunk.argument)
    if partition is not None:
        blocks: Iterable[Boxes] = [form.read(partition, f"partition {chunk.source} of {name}", 0, chunk.first, name)]
    else:
        blocks = read_chunk(plan.files[chunk.argument][chunk.source], chunk, form, name, rows)
    for block in blocks:
        yield Boxes(block.ids, block.rows.astype(_dtype(plan), copy=False))


def check_file(folders: Folders, path: Path) -> None:
    """Removes a finished file of an interrupted run if it is damaged, so that it is written again."""
    if path.suffix == ".arrow":
        forget_if_damaged(path)
    elif not has_its_pairs(path, folders.plan().id_types):
        path.unlink(missing_ok=True)


def split_node(folders: Folders, node: Node, wanted: int) -> None:
    """Splits a node into at most `wanted` cells, and writes its boxes to them, unless splitting does not help.

    How it is split is noted first: if this is repeated, the cells are the same, and their finished pairs are kept.
    """
    plan = folders.plan()
    noted = split_of(folders, node)
    if noted is None:
        cells = _chosen(folders, plan, node, wanted)
        write_sealed(folders.split(node.name), {"cells": cells})
    else:
        cells = noted.cells
    if cells is None:
        return
    for argument, form in enumerate(plan.forms):
        path = folders.boxes(plan, node.name, argument)[0]
        if counts_of(path) is None:
            blocks = read_groups(folders.boxes(plan, node.level, argument), node.group, node.groups)
            scatter(blocks, cells, path, form.id_type, _dtype(plan))


def _chosen(folders: Folders, plan: Plan, node: Node, wanted: int) -> Cells | None:
    low, high = np.array(node.low), np.array(node.high)
    step = max(1, sum(node.counts) // (_SAMPLE_PER_CELL * wanted))
    sample = _clipped(_sample(folders, plan, node, step), low, high)
    cells = choose_cells(sample, wanted)
    _, starts = cells.assign(sample)
    helps = cells.number > 1 and np.diff(starts).max() <= _ALL_IN_ONE * len(sample)
    return cells if helps else None


def _sample(folders: Folders, plan: Plan, node: Node, step: int) -> NDArray[np.float64]:
    blocks = (
        boxes.rows
        for argument in range(plan.sets)
        for boxes in read_groups(folders.boxes(plan, node.level, argument), node.group, node.groups)
    )
    sampled = [rows[rows_of_sample(len(rows), step, number)] for number, rows in enumerate(blocks)]
    return np.concatenate(sampled).astype(np.float64)


def _clipped(sample: NDArray[np.float64], low: NDArray[np.float64], high: NDArray[np.float64]) -> NDArray[np.float64]:
    """Boxes without what is outside of a cell, so that no split is there."""
    half = sample.shape[1] // 2
    clipped = sample.copy()
    np.maximum(clipped[:, :half], low, out=clipped[:, :half])
    np.minimum(clipped[:, half:], high, out=clipped[:, half:])
    return clipped


class Split(NamedTuple):
    """How a node was split."""

    cells: Cells | None
    """None if splitting does not help."""
    children: list[Node] | None
    """None if the boxes are not, or no longer, in files of their own."""


def split_of(folders: Folders, node: Node) -> Split | None:
    """How a node was split; None if it was not."""
    try:
        noted = read_sealed(folders.split(node.name))["cells"]
    except (OSError, ValueError):
        return None
    if noted is None:
        return Split(None, [])
    cells, plan = Cells(*noted), folders.plan()
    counts = [counts_of(folders.boxes(plan, node.name, argument)[0]) for argument in range(plan.sets)]
    if None in counts:
        return Split(cells, None)
    groups = [one.groups for one in counts if one is not None]
    return Split(cells, nodes(cells, groups, node.name, np.array(node.low), np.array(node.high), node.wide))


def nodes(
    cells: Cells,
    counts: list[list[int]],
    level: str,
    low: NDArray[np.float64],
    high: NDArray[np.float64],
    wide: list[tuple[str, int, int]],
) -> list[Node]:
    """The cells of a level and its wide boxes: those in which there may be pairs.

    Args:
        cells: how space is split.
        counts: for each set the number of boxes of each cell, and of the wide ones.
        level: the name of the node that was split, or the empty string.
        low: the min corner of that node.
        high: its max corner.
        wide: the wide boxes of the levels above.
    """
    group, groups = cells.number, cells.number + 1
    wide_counts = [of_set[group] for of_set in counts]
    lows, highs = cells.regions()
    prefix = f"{level}." if level else "cell-"
    own_wide = [*wide, (level, group, groups)] if any(wide_counts) else wide
    found = [
        Node(
            f"{prefix}{cell:05}",
            level,
            cell,
            groups,
            np.maximum(lows[cell], low).tolist(),
            np.minimum(highs[cell], high).tolist(),
            [of_set[cell] for of_set in counts],
            own_wide,
        )
        for cell in range(cells.number)
    ]
    found.append(Node(f"{prefix}wide", level, group, groups, low.tolist(), high.tolist(), wide_counts, wide))
    return [node for node in found if any(node.counts) and (node.wide or all(node.counts))]


def join_node(folders: Folders, node: Node, rows: int, is_counted: bool) -> Joined:
    """Writes the pairs of a node to its file, or only counts them. Takes at most `rows` boxes into memory at once."""
    plan = folders.plan()
    low, high = np.array(node.low), np.array(node.high)
    is_whole = sum(node.counts) <= rows
    size = max((rows if is_whole else rows // 2), 1)

    def own(argument: int, skip: int = 0) -> Iterator[Boxes]:
        blocks = read_groups(folders.boxes(plan, node.level, argument), node.group, node.groups)
        return _from(gathered(blocks, size), skip)

    def wide(argument: int) -> Iterator[Boxes]:
        for level, group, groups in node.wide:
            blocks = read_groups(folders.boxes(plan, level, argument), group, groups)
            here = (boxes.take(touches(boxes.rows, low, high)) for boxes in blocks)
            yield from gathered(here, max(rows // 2, 1))

    with _pair_file(folders, plan, node.name, is_counted) as file:
        if plan.sets == 1:
            for number, boxes in enumerate(own(0)):
                search(boxes, None, low, file.write)
                for other in own(0, number + 1) if not is_whole else ():
                    search(boxes, other, low, file.write)
                for other in wide(0):
                    search(boxes, other, low, file.write)
        else:
            for boxes in own(0):
                for other in own(1):
                    search(boxes, other, low, file.write)
                for other in wide(1):
                    search(boxes, other, low, file.write)
            for other in own(1):
                for boxes in wide(0):
                    search(boxes, other, low, file.write)
    return Joined(node.name, file.pairs, file.hash)


def _from(blocks: Iterator[Boxes], skip: int) -> Iterator[Boxes]:
    for number, block in enumerate(blocks):
        if number >= skip:
            yield block


def join_everything(folders: Folders, plan: Plan, name: str, rows: int, is_counted: bool) -> tuple[Joined, list[int]]:
    """Writes the pairs of all boxes, which fit in memory, without spill files; and returns how many boxes there are."""
    low = np.full(plan.cells.dimensions, -np.inf)
    total = sum(chunk.rows for chunk in plan.chunks)
    sets = []
    for argument in range(plan.sets):
        blocks = (
            block
            for chunk in plan.chunks
            if chunk.argument == argument
            for block in _chunk_boxes(plan, chunk, rows, None)
        )
        sets.append(next(gathered(blocks, total + 1), None))
    with _pair_file(folders, plan, name, is_counted) as file:
        if sets[0] is not None and (plan.sets == 1 or sets[1] is not None):
            search(sets[0], sets[1] if plan.sets == 2 else None, low, file.write)
    return Joined(name, file.pairs, file.hash), [0 if boxes is None else len(boxes.rows) for boxes in sets]


def _pair_file(folders: Folders, plan: Plan, name: str, is_counted: bool) -> Any:
    return pair_file(None if is_counted else folders.pairs(name), plan.id_types, plan.sets == 1)
