"""Finds the pairs of more boxes than fit in memory, through files, and continues where a run was interrupted."""

from __future__ import annotations

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._arrays import Floats
from .boxes import Chunk, File, Form, chunks_of_files, form_of_files, list_files, sample_file
from .cells import Cells, choose_cells
from .dataset import MANIFEST, DatasetError, Manifest, read_manifest, summary_of, sync, write_text
from .spill import counts_of
from .tasks import (
    ARGUMENTS,
    PLAN,
    Folders,
    Joined,
    Node,
    Plan,
    join_everything,
    join_node,
    nodes,
    scatter_chunk,
    split_node,
    split_of,
)
from .workers import Workers, memory_of, started

_CHUNK_ROWS = 2_000_000
_SLAB_ROWS = 500_000
CELL_BOXES = 1_000_000
_MOST_CELLS = 2000
_SMALL = 3_000_000
_SAMPLE = 20_000
_LEAST_ROWS = 1000
_SPILL = "_spill.txt"
SAMPLE_PER_CELL = 400


class Source(NamedTuple):
    """One set of boxes: files, or partitions of a Dask collection with the number of rows of each."""

    files: list[File]
    partitions: list[Any]
    rows: list[int]
    form: Form
    sample: Floats | None


class Job(NamedTuple):
    """What to do, and with what."""

    out: Path | None
    memory_limit: int | str | float | None
    workers: int | None
    spill: Path | None
    overwrite: bool
    cells: int | None
    progress: Callable[[float], object]


def source_of_files(paths: Any, columns: list[str] | None, ids: str | None, options: dict[str, Any]) -> Source:
    """The boxes of Parquet files."""
    files = list_files(paths)
    return Source(files, [], [sum(file.rows) for file in files], form_of_files(files, columns, ids, options), None)


def run(sources: list[Source], job: Job) -> Manifest:
    """Finds all pairs; without `out`, only counts them."""
    if job.out is None:
        with tempfile.TemporaryDirectory(prefix="sweep-and-prune-", dir=job.spill) as folder:
            return _run(sources, job, Folders(folder, str(Path(folder) / "spill")))
    request = _request(sources, job)
    if os.path.lexists(job.out):
        finished = _finished(job, sources, request)
        if finished is not None:
            return finished
    work = job.out.with_name(job.out.name + ".unfinished")
    spill = work / "spill"
    if job.spill is not None:
        name = hashlib.sha256(str(job.out.absolute()).encode()).hexdigest()[:16]
        spill = job.spill / f"sweep-and-prune-{name}"
    try:
        work.mkdir(parents=True, exist_ok=True)
        with _locked(work / "lock"):
            return _run(sources, job, Folders(str(work), str(spill)))
    except OSError as error:
        if isinstance(error, DatasetError) or error.errno is None:
            raise
        raise DatasetError(f"{work}: {error.strerror}; the run can be continued by the same call") from error


def _request(sources: list[Source], job: Job) -> dict[str, Any]:
    partitions = [getattr(source, "rows", []) if source.partitions else [] for source in sources]
    return {"version": 1, "cells": job.cells, "partitions": partitions}


def _is_same(plan: Plan, sources: list[Source], request: dict[str, Any]) -> bool:
    return (
        plan.files == [source.files for source in sources]
        and plan.forms == [source.form for source in sources]
        and plan.request == request
    )


def _finished(job: Job, sources: list[Source], request: dict[str, Any]) -> Manifest | None:
    """The manifest of a finished run of the same boxes; removes that of others if they may be overwritten."""
    assert job.out is not None
    is_dataset = (job.out / MANIFEST).exists()
    if not is_dataset:
        if job.out.is_dir() and not any(job.out.iterdir()):
            job.out.rmdir()
            return None
        raise DatasetError(f"{job.out} exists and is no dataset of pairs: remove it, or choose another out")
    manifest = read_manifest(job.out)
    if job.overwrite:
        shutil.rmtree(job.out)
        return None
    try:
        if _is_same(Plan.from_json((job.out / PLAN).read_text(encoding="utf-8")), sources, request):
            return manifest
    except (OSError, ValueError, TypeError):
        pass
    raise DatasetError(
        f"{job.out} has the pairs of other boxes or other options: choose another out, or pass overwrite=True"
    )


@contextmanager
def _locked(path: Path) -> Any:
    try:
        import fcntl
    except ImportError:  # there are no such locks on Windows
        yield
        return
    with open(path, "w") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise DatasetError(f"{path.parent} is in use by another run: wait for it, or choose another out") from None
        yield


def _run(sources: list[Source], job: Job, folders: Folders) -> Manifest:
    total = sum(sum(source.rows) for source in sources)
    request = _request(sources, job)
    plan = _continued(sources, request, job, folders)
    plan_file = Path(folders.work) / PLAN
    if plan is not None and (Path(folders.work) / MANIFEST).exists():
        return _named(job, folders)
    is_small = total <= _SMALL and job.cells is None and not any(source.partitions for source in sources)
    if plan is None and is_small and job.workers is None and _fits(sources, total, job):
        plan = Plan(
            [source.files for source in sources],
            [source.form for source in sources],
            chunks_of(sources),
            Cells(dimensions_of(sources), [], [], [], []),
            request,
        )
        joined, boxes = join_everything(folders, plan, "everything", max(total, 1), job.out is None)
        job.progress(1.0)
        write_text(plan_file, plan.to_json())
        return _complete(job, folders, [joined], boxes, 1.0)
    with started(job.memory_limit, job.workers) as workers:
        rows = max(workers.memory // _bytes_of_box(sources), _LEAST_ROWS)
        if plan is None:
            plan = _planned(sources, job, workers, rows, request, total)
            write_text(plan_file, plan.to_json())
        return _steps(plan, sources, job, folders, workers, rows)


def _continued(sources: list[Source], request: dict[str, Any], job: Job, folders: Folders) -> Plan | None:
    """The plan of a run that was interrupted; None if it has to start again."""
    work, plan = Path(folders.work), None
    if (work / PLAN).exists():
        try:
            plan = Plan.from_json((work / PLAN).read_text(encoding="utf-8"))
        except (ValueError, TypeError):
            pass
        if plan is not None and _is_same(plan, sources, request):
            for part in [*work.glob("*.part"), *Path(folders.spill).glob("*.part")]:
                part.unlink(missing_ok=True)
            return plan
        if not job.overwrite:
            raise DatasetError(
                f"{folders.work} is an interrupted run of other boxes or other options: repeat that call to continue "
                "it, choose another out, or pass overwrite=True to start again"
            )
    # Without its plan, nothing tells what the other files are.
    shutil.rmtree(folders.spill, ignore_errors=True)
    for path in work.iterdir():
        if path.name == "lock":
            continue
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    return None


def _fits(sources: list[Source], total: int, job: Job) -> bool:
    return total * _bytes_of_box(sources) + 300_000_000 < memory_of(job.memory_limit)


def _bytes_of_box(sources: list[Source]) -> int:
    """The memory that a box takes while its cell is searched: the finder's copies of it, and its id."""
    double = any(source.form.dtype == "float64" for source in sources)
    text = any(source.form.id_type == "large_string" for source in sources)
    return 2 * dimensions_of(sources) * (8 if double else 4) * 7 + (160 if text else 16)


def dimensions_of(sources: list[Source]) -> int:
    for source in sources:
        if source.sample is not None and source.sample.shape[1]:
            return int(source.sample.shape[1]) // 2
        for file in source.files:
            for boxes in sample_file(file, source.form, "boxes", 1):
                return int(boxes.rows.shape[1]) // 2
    return 1


def chunks_of(sources: list[Source]) -> list[Chunk]:
    chunks = []
    for argument, source in enumerate(sources):
        if source.partitions:
            index = 0
            for number, rows in enumerate(source.rows):
                chunks.append(Chunk(argument, number, [], 0, index, rows))
                index += rows
        else:
            chunks.extend(chunks_of_files(source.files, argument, _CHUNK_ROWS))
    return chunks


def _planned(sources: list[Source], job: Job, workers: Workers, rows: int, request: dict[str, Any], total: int) -> Plan:
    count = job.cells
    if count is None:
        # Many more cells than workers, so that none of them waits long for the last cell. And not too many: each cell
        # reads a part of each spill file. Cells that are too large for this are split again.
        of_cell = min(rows * 6 // 10, max(CELL_BOXES, total // _MOST_CELLS))
        count = min(max(-(-total // of_cell), 4 * workers.number), _MOST_CELLS)
    sample = sample_of(sources, SAMPLE_PER_CELL * count, dimensions_of(sources))
    return Plan(
        [source.files for source in sources],
        [source.form for source in sources],
        chunks_of(sources),
        choose_cells(sample, count),
        request,
    )


def sample_of(sources: list[Source], wanted: int, dimensions: int) -> Floats:
    """A sample of the boxes of all sets, with about so many boxes or a few more."""
    total = sum(sum(source.rows) for source in sources)
    samples = []
    for argument, source in enumerate(sources):
        name = ARGUMENTS[len(sources) - 1][argument]
        share = max(1, max(_SAMPLE, wanted) * sum(source.rows) // max(total, 1))
        blocks = [source.sample] if source.sample is not None else []
        for file in source.files:
            of_file = max(1, share * sum(file.rows) // max(sum(source.rows), 1))
            blocks.extend(boxes.rows for boxes in sample_file(file, source.form, name, of_file))
        for block in blocks:
            if len(block) and block.shape[1] != 2 * dimensions:
                raise DatasetError(
                    f"{name} has boxes of {block.shape[1] // 2} dimensions, and others have {dimensions}: they must be "
                    "the same"
                )
            samples.append(block.reshape(len(block), 2 * dimensions).astype(np.float64))
    return np.concatenate(samples) if samples else np.empty((0, 2 * dimensions))


def _steps(plan: Plan, sources: list[Source], job: Job, folders: Folders, workers: Workers, rows: int) -> Manifest:
    Path(folders.spill).mkdir(parents=True, exist_ok=True)
    _forget_other_spill(folders)
    progress = _Progress(job.progress, sum(chunk.rows for chunk in plan.chunks))
    missing = [number for number in range(len(plan.chunks)) if counts_of(folders.chunk(number)) is None]
    _check_disk(plan, missing, folders)
    slab = min(max(rows // 3, _LEAST_ROWS), _SLAB_ROWS)
    arguments = []
    for number in missing:
        chunk = plan.chunks[number]
        partitions = sources[chunk.argument].partitions
        arguments.append((folders, number, slab, partitions[chunk.source] if partitions else None))
    progress.scattered(plan, [number for number in range(len(plan.chunks)) if number not in set(missing)])
    workers.run(scatter_chunk, arguments, progress.advance)
    groups = plan.cells.number + 1
    totals = np.zeros((plan.sets, groups), np.int64)
    boxes = [0] * plan.sets
    for number, chunk in enumerate(plan.chunks):
        counts = counts_of(folders.chunk(number))
        if counts is None:
            raise DatasetError(
                f"{folders.chunk(number)} is missing: something removed it; call again to repeat the run"
            )
        totals[chunk.argument] += counts.groups
        boxes[chunk.argument] += counts.boxes
    border = np.full(plan.cells.dimensions, np.inf)
    found = nodes(plan.cells, totals.tolist(), "", -border, border, [])
    leaves = _split(found, folders, workers, rows)
    progress.joining(leaves)
    joined = []
    waiting = []
    for node in leaves:
        summary = None if job.out is None else summary_of(folders.pairs(node.name))
        if summary is None:
            waiting.append(node)
        else:
            joined.append(Joined(node.name, summary[0], int(summary[1], 16)))
            progress.joined(node.name)

    def done(result: Joined) -> None:
        joined.append(result)
        progress.joined(result.name)

    # The largest first, so that none of them is alone at the end.
    waiting.sort(key=lambda node: (-sum(node.counts), node.name))
    workers.run(join_node, [(folders, node, rows, job.out is None) for node in waiting], done)
    if not leaves:  # no boxes: a dataset has a file even so
        joined.append(join_everything(folders, plan._replace(chunks=[]), "nothing", 1, job.out is None)[0])
    job.progress(1.0)
    copies = float(totals.sum()) / max(sum(boxes), 1)
    return _complete(job, folders, joined, boxes, copies)


def _forget_other_spill(folders: Folders) -> None:
    """Removes the boxes of the interrupted run if they were in another folder."""
    noted = Path(folders.work) / _SPILL
    if noted.exists() and noted.read_text(encoding="utf-8") not in ("", folders.spill):
        shutil.rmtree(noted.read_text(encoding="utf-8"), ignore_errors=True)
    write_text(noted, folders.spill)


def _split(found: list[Node], folders: Folders, workers: Workers, rows: int) -> list[Node]:
    """The nodes with those that are too large replaced by what they are split into."""
    leaves: list[Node] = []
    while found:
        large = []
        following = []
        for node in found:
            if summary_of(folders.pairs(node.name)) is not None:
                leaves.append(node)  # it is joined already, with more memory than there is now
                continue
            split = split_of(folders, node)
            if split is not None and split.children is not None:
                if split.cells is None:
                    leaves.append(node)
                following.extend(split.children)
            elif split is not None or sum(node.counts) > rows:
                large.append(node)
            else:
                leaves.append(node)
        workers.run(
            split_node,
            [(folders, node, max(2, -(-2 * sum(node.counts) // rows))) for node in large],
            lambda _: None,
        )
        found = following + large
    return leaves


def _check_disk(plan: Plan, missing: list[int], folders: Folders) -> None:
    double = any(form.dtype == "float64" for form in plan.forms)
    size = 2 * plan.cells.dimensions * (8 if double else 4) + 8
    needed = sum(plan.chunks[number].rows for number in missing) * size
    free = shutil.disk_usage(folders.spill).free
    if needed > free:
        raise DatasetError(
            f"{folders.spill}: the boxes take {needed / 1e9:.1f} GB there, and {free / 1e9:.1f} GB are free: free some "
            "space, or choose another folder by spill"
        )


def _complete(job: Job, folders: Folders, joined: list[Joined], boxes: list[int], copies: float) -> Manifest:
    """Writes the manifest and gives the dataset its name."""
    joined = sorted(joined)
    files = [
        {"name": f"{one.name}.parquet", "pairs": one.pairs, "hash": f"{one.hash:016x}"}
        for one in joined
        if job.out is not None
    ]
    total = sum(one.hash for one in joined) & (2**64 - 1)
    manifest = Manifest(sum(one.pairs for one in joined), f"{total:016x}", boxes, round(copies, 4), files)
    if job.out is None:
        return manifest
    for one in files:
        sync(Path(folders.work) / str(one["name"]))
    write_text(Path(folders.work) / MANIFEST, json.dumps(manifest._asdict(), indent=1))
    return _named(job, folders)


def _named(job: Job, folders: Folders) -> Manifest:
    """Gives a complete dataset its name."""
    assert job.out is not None
    shutil.rmtree(folders.spill, ignore_errors=True)
    for name in ("lock", _SPILL):
        (Path(folders.work) / name).unlink(missing_ok=True)
    for path in Path(folders.work).glob("_*.split.json"):
        path.unlink()
    os.replace(folders.work, job.out)
    return read_manifest(job.out)


class _Progress:
    """The share of the work that is done: half of it is to scatter, half to join."""

    def __init__(self, report: Callable[[float], object], rows: int) -> None:
        self._report, self._rows = report, max(rows, 1)
        self._scattered = self._joined = 0
        self._leaves: dict[str, int] = {}

    def scattered(self, plan: Plan, numbers: list[int]) -> None:
        """These chunks were scattered before."""
        self.advance(sum(plan.chunks[number].rows for number in numbers))

    def advance(self, rows: int) -> None:
        """So many rows are scattered."""
        self._scattered += rows
        self._say()

    def joining(self, leaves: list[Node]) -> None:
        """These cells will be joined."""
        self._scattered = self._rows
        self._leaves = {node.name: sum(node.counts) for node in leaves}

    def joined(self, name: str) -> None:
        """A cell is joined."""
        self._joined += self._leaves[name]
        self._say()

    def _say(self) -> None:
        whole = max(sum(self._leaves.values()), 1)
        self._report(min(self._scattered / self._rows / 2 + self._joined / whole / 2, 0.999))
