"""What the tests of pairs from disk share: files of boxes, datasets of pairs, and runs that are interrupted."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracle import Array, in_order, random_boxes

import sweep_and_prune as core

pytest.importorskip("distributed")
import pyarrow
import pyarrow.parquet

import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned import tasks, workers

NAMES = {1: ["start", "end"], 2: ["minx", "miny", "maxx", "maxy"], 3: ["x0", "y0", "z0", "x1", "y1", "z1"]}
BOXES = random_boxes(3000, 2, np.float64)
PAIRS = in_order(core.find_pairs(BOXES))


def table(boxes: Array, first: int = 0) -> Any:
    """With an id in each row: descending numbers and text."""
    columns = dict(zip(NAMES[boxes.shape[1] // 2], boxes.T))
    number = 10_000 - np.arange(first, first + len(boxes))
    return pyarrow.table({**columns, "number": number, "name": [f"n{one}" for one in number.tolist()]})


def write(name: str, boxes: Array = BOXES, first: int = 0, group: int = 400) -> str:
    pyarrow.parquet.write_table(table(boxes, first), name, row_group_size=group)
    return name


def found(result: Any) -> Array:
    """The pairs of a Dask DataFrame, sorted."""
    frame = result.compute()
    assert list(frame.columns) == ["a", "b"]
    return in_order(frame.to_numpy().reshape(-1, 2))


def dataset(name: str = "out") -> Array:
    """The pairs of a finished dataset, sorted; its files and its manifest must agree."""
    manifest = sap.read_manifest(name)
    assert sorted(path.name for path in Path(name).glob("*.parquet")) == sorted(one["name"] for one in manifest.files)
    assert not Path(name + ".unfinished").exists()
    pairs = pyarrow.parquet.read_table(name) if manifest.files else table(BOXES[:0]).select([0, 1])
    assert len(pairs) == manifest.pairs == sum(one["pairs"] for one in manifest.files)
    return in_order(np.column_stack([pairs[0].to_numpy(), pairs[1].to_numpy()]).astype(np.int64).reshape(-1, 2))


class Interrupted(Exception):
    pass


def interrupt(monkeypatch: pytest.MonkeyPatch, after: int) -> None:
    """Ends the process, as it were, after `after` tasks; the first tasks are those that scatter."""
    calls = 0
    real = tasks.guarded

    def counted(task: Any, *arguments: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > after:
            raise Interrupted
        return real(task, *arguments)

    monkeypatch.setattr(workers, "guarded", counted)


def children_of(process: int) -> list[int]:
    """The workers of a process, which it started as processes of Python."""
    psutil = pytest.importorskip("psutil")
    found = []
    for child in psutil.Process(process).children(recursive=True):
        with suppress(psutil.Error):  # it has just ended
            if "spawn_main" in " ".join(child.cmdline()):
                found.append(child.pid)
    return found
