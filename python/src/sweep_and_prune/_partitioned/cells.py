"""Cells: space split by a KD tree, so that each cell gets about the same number of boxes.

Cells are half-open: a point belongs to exactly one of them. Boxes are closed: a box goes to each cell that has a point
of it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._arrays import Floats

MOST_COPIES = 4
"""A plan that would make more copies of each box, on average, gets fewer cells."""

_ALWAYS_NARROW = 8
_WIDE_SHARE = 4
_BLOCK = 65_536


class Cells(NamedTuple):
    """A KD tree: node `i` splits its part of space where the coordinate on `axes[i]` is `splits[i]`.

    A point below the split belongs to `below[i]`, any other to `above[i]`. A child of 0 or more is another node; the
    child `-1 - c` is cell `c`. The root is node 0; a tree without nodes is one cell.
    """

    dimensions: int
    axes: list[int]
    splits: list[float]
    below: list[int]
    above: list[int]

    @property
    def number(self) -> int:
        """The number of cells."""
        return len(self.axes) + 1

    @property
    def most_copies(self) -> int:
        """A box that touches more cells than this is wide: it is not copied to them, but joined with each of them."""
        return max(_ALWAYS_NARROW, self.number // _WIDE_SHARE)

    def regions(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """The min corner, which belongs to the cell, and the max corner, which does not: `(cells, dimensions)` each.

        At the border of space they are infinite, and all points beyond belong to the cell.
        """
        low = np.full((self.number, self.dimensions), -np.inf)
        high = np.full((self.number, self.dimensions), np.inf)
        waiting = [(0, low[0].copy(), high[0].copy())] if self.axes else []
        while waiting:
            node, least, most = waiting.pop()
            axis, split = self.axes[node], self.splits[node]
            for child, is_above in ((self.below[node], False), (self.above[node], True)):
                child_least, child_most = least.copy(), most.copy()
                (child_least if is_above else child_most)[axis] = split
                if child < 0:
                    low[-1 - child], high[-1 - child] = child_least, child_most
                else:
                    waiting.append((child, child_least, child_most))
        return low, high

    def assign(self, boxes: Floats) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
        """The rows of the boxes of each group: a group for each cell, and one for the wide boxes.

        Returns:
            The rows of all groups, and where each group begins: group `g` is `rows[starts[g] : starts[g + 1]]`. Within
            a group, rows ascend. A box that is not wide is in each cell that it touches.
        """
        if self.number == 1:
            return np.arange(len(boxes), dtype=np.int32), np.array([0, len(boxes), len(boxes)])
        # In blocks, so that the columns stay in the cache, and boxes that touch all cells take little memory.
        blocks = [self._groups(boxes[start : start + _BLOCK], start) for start in range(0, len(boxes), _BLOCK)]
        groups = [[block[group] for block in blocks] for group in range(self.number + 1)]
        sizes = [sum(map(len, group)) for group in groups]
        starts = np.concatenate([[0], np.cumsum(sizes)]).astype(np.int64)
        rows = [rows for group in groups for rows in group]
        return np.concatenate(rows) if rows else np.empty(0, np.int32), starts

    def _groups(self, boxes: Floats, first: int) -> list[NDArray[np.int32]]:
        half = self.dimensions
        columns = np.ascontiguousarray(boxes.T)
        groups: list[Any] = [None] * (self.number + 1)
        everything = np.arange(len(boxes), dtype=np.int32)
        waiting: list[tuple[int, NDArray[np.int32]]] = [(0, everything)]
        while waiting:
            node, rows = waiting.pop()
            if node < 0:
                groups[-1 - node] = rows
                continue
            axis, split = self.axes[node], self.splits[node]
            low, high = columns[axis], columns[axis + half]
            if len(rows) < len(boxes):
                low, high = low[rows], high[rows]
            waiting.append((self.below[node], rows[low < split]))
            waiting.append((self.above[node], rows[high >= split]))
        groups[-1] = everything[:0]
        if sum(map(len, groups)) > len(boxes) + self.most_copies:
            copies = np.bincount(np.concatenate(groups), minlength=len(boxes))
            is_wide = copies > self.most_copies
            if is_wide.any():
                groups = [rows[~is_wide[rows]] for rows in groups]
                groups[-1] = np.flatnonzero(is_wide).astype(np.int32)
        return [rows + np.int32(first) for rows in groups]


def rows_of_sample(number: int, step: int, seed: int = 0) -> NDArray[np.int64]:
    """One row in each `step` consecutive rows of `number`, at a pseudo-random place among them.

    A fixed place would miss what a periodic pattern puts elsewhere. The rows ascend, and depend on the arguments alone.
    """
    starts = np.arange(0, number, step)
    places = np.random.default_rng(seed).random(len(starts))
    return starts + (places * np.minimum(step, number - starts)).astype(np.int64)


def choose_cells(sample: Floats, count: int) -> Cells:
    """Splits space into at most `count` cells that get about equally many boxes, by a sample of the boxes.

    There are fewer cells where splits do not separate boxes, or would copy each box too often. Deterministic. Time
    O(s log s log count) for s boxes.
    """
    while True:
        cells = _kd_tree(sample, count)
        rows, starts = cells.assign(sample)
        wide = rows[starts[-2] :]
        if len(wide):  # They do not go to the cells, so they have no say in where these are.
            narrow = np.delete(sample, wide, axis=0)
            cells = _kd_tree(narrow, count)
            rows, starts = cells.assign(sample)
        kept = len(sample) - (starts[-1] - starts[-2])
        if starts[-2] <= MOST_COPIES * kept or cells.number == 1:
            return cells
        count = cells.number // 2


def _kd_tree(sample: Floats, count: int) -> Cells:
    half = sample.shape[1] // 2
    cells = Cells(half, [], [], [], [])
    leaves = 0
    # Where a child is noted in its parent: which list, and which node.
    waiting: list[tuple[Floats, int, list[int] | None, int]] = [(sample, max(count, 1), None, 0)]
    while waiting:
        boxes, wanted, children, parent = waiting.pop()
        best = _best_split(boxes, wanted) if wanted > 1 and len(boxes) > 1 else None
        if children is not None:
            children[parent] = -1 - leaves if best is None else len(cells.axes)
        if best is None:
            leaves += 1
            continue
        axis, split = best
        node = len(cells.axes)
        cells.axes.append(axis)
        cells.splits.append(split)
        cells.below.append(0)
        cells.above.append(0)
        waiting.append((boxes[boxes[:, axis + half] >= split], wanted - wanted // 2, cells.above, node))
        waiting.append((boxes[boxes[:, axis] < split], wanted // 2, cells.below, node))
    return cells


def _best_split(boxes: Floats, wanted: int) -> tuple[int, float] | None:
    """The axis and the coordinate that split boxes evenly and cut few of them; None if nothing separates them."""
    half, number = boxes.shape[1] // 2, len(boxes)
    below_wanted = wanted // 2
    best, least_cost = None, np.inf
    for axis in range(half):
        low, high = np.sort(boxes[:, axis]), np.sort(boxes[:, axis + half])
        candidates = np.unique(low[np.isfinite(low)])
        below = np.searchsorted(low, candidates, "left")
        above = number - np.searchsorted(high, candidates, "left")
        load = np.maximum(below / below_wanted, above / (wanted - below_wanted)) * (wanted / number)
        load[np.maximum(below, above) == number] = np.inf
        if len(load) == 0 or load.min() == np.inf:
            continue
        # How many boxes a split cuts, smoothly: a small sample would say 0 on every axis.
        with np.errstate(all="ignore"):
            extent = high[-1 - number // 20] - low[number // 20]
            widths = boxes[:, axis + half] - boxes[:, axis]
            cut = np.minimum(widths / extent, 1).mean() if extent > 0 else 1.0
        cost = load.min() + (cut if np.isfinite(cut) else 1.0)
        if cost < least_cost:
            best, least_cost = (axis, float(candidates[np.argmin(load)])), cost
    return best
