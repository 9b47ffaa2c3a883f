"""Finds the pairs of more boxes than fit in memory, through files, and continues where a run was interrupted."""

from __future__ import annotations

import os
import shutil
import tempfile
import uuid
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from .._arrays import Floats
from .._errors import SweepAndPruneError
from .boxes import Chunk, File, Form, chunks_of_files, folders_of, form_of_files, is_data, list_files, sample_file
from .cells import Cells, choose_cells
from .dataset import (
    MANIFEST,
    DatasetError,
    Manifest,
    has_its_pairs,
    read_manifest,
    summary_of,
    write_manifest,
)
from .files import read_sealed, sync
from .folder import (
    Folders,
    boxes_of,
    claimed,
    finish,
    has_results,
    is_empty,
    nodes_of,
    refuse_others_in_dataset,
    remove_replaced,
    spill_of,
    spilled_nodes_of,
    start_over,
    use_spill,
    work_of,
)
from .plan import ARGUMENTS, PLAN, Plan
from .spill import counts_of, forget
from .tasks import Joined, Node, check_file, join_everything, join_node, nodes, scatter_chunk, split_node, split_of
from .workers import Workers, memory_of, started

_CHUNK_ROWS = 2_000_000
_SLAB_ROWS = 500_000
CELL_BOXES = 1_000_000
_MOST_CELLS = 2000
_SMALL = 3_000_000
_SAMPLE = 20_000
_LEAST_ROWS = 1000
SAMPLE_PER_CELL = 400


class Source(NamedTuple):
    """One set of boxes: files, or partitions of a Dask collection with the number of rows of each."""

    files: list[File]
    partitions: list[Any]
    rows: list[int]
    form: Form
    sample: Floats | None
    crs: Any = None
    """The coordinate reference system, if it is known."""
    digests: Sequence[str] = ()
    """Of each partition, where pairs are written."""


class Job(NamedTuple):
    """What to do, and with what."""

    out: Path | None
    memory_limit: int | str | float | None
    workers: int | None
    spill: Path | None
    overwrite: bool
    cells: int | None
    progress: Callable[[float], object]


def source_of_files(
    paths: Any, columns: list[str] | None, ids: str | None, options: dict[str, Any], out: Path | None
) -> Source:
    """The boxes of Parquet files, whose pairs will be in `out`."""
    files = list_files(paths)
    if out is not None:
        refuse_own_files(paths, files, out)
    form, crs = form_of_files(files, columns, ids, options)
    return Source(files, [], [sum(file.rows) for file in files], form, None, crs)


def run(sources: list[Source], job: Job) -> Manifest:
    """Finds all pairs; without `out`, only counts them."""
    try:
        if job.out is None:
            with tempfile.TemporaryDirectory(prefix="sweep-and-prune-", dir=job.spill) as folder:
                return _run(sources, job._replace(spill=None), Path(folder), None)
        job = job._replace(out=_place(job.out))
        assert job.out is not None
        work = work_of(job.out)
        if os.path.lexists(job.out):
            finished = _finished(job, job.out, sources)
            if finished is not None:
                return finished
        with claimed(work) as plan:
            return _run(sources, job, work, plan)
    except OSError as error:
        if isinstance(error, SweepAndPruneError) or error.errno is None:
            raise
        place = job.spill if job.out is None else work_of(job.out)
        ending = "" if job.out is None else "; the run can be continued by the same call"
        raise DatasetError(f"{place or 'the folder for temporary files'}: {error.strerror}{ending}") from error


def _place(out: Path) -> Path:
    """The folder that `out` names, through symbolic links."""
    place = Path(os.path.realpath(out)) if out.is_symlink() or out.name in ("", "..") else out
    if not place.name:
        raise ValueError(f"out is {os.fspath(out)!r}: it must be the name of a folder for the pairs")
    return place


def refuse_own_files(paths: Any, files: list[File], out: Path) -> None:
    """Raises an error if the files of boxes are files of pairs of this call, now or when it is repeated."""
    place = _place(out)
    own = {Path(os.path.realpath(folder)) for folder in (place, work_of(place), boxes_of(place))}
    for folder in folders_of(paths):
        if is_data(os.path.realpath(place / "x.parquet"), os.path.realpath(folder)):
            raise ValueError(
                f"out ({out}) is in {folder}, whose files are the boxes: the pairs would be read as boxes, too; choose "
                "an out elsewhere"
            )
    for path in (file.path for file in files if "://" not in file.path):
        if not own.isdisjoint(Path(os.path.realpath(path)).parents):
            raise ValueError(f"{path} has boxes and is in out ({out}): choose another out")


def _request(sources: list[Source], job: Job) -> dict[str, Any]:
    partitions = [getattr(source, "rows", []) if source.partitions else [] for source in sources]
    digests = [[*source.digests] for source in sources]
    return {"version": 1, "cells": job.cells, "partitions": partitions, "digests": digests}


def _is_same(plan: Plan, sources: list[Source], request: dict[str, Any]) -> bool:
    return (
        plan.files == [source.files for source in sources]
        and plan.forms == [source.form for source in sources]
        and plan.request == request
    )


def _finished(job: Job, out: Path, sources: list[Source]) -> Manifest | None:
    """The manifest of a finished run of the same boxes; None if the run has to begin, to replace what is there."""
    if is_empty(out):
        return None
    if not (out / MANIFEST).exists():
        raise DatasetError(f"{out} exists and is no dataset of pairs: rename it, or choose another out")
    manifest = read_manifest(out)
    if job.overwrite:
        refuse_others_in_dataset(out, manifest)
        remove_replaced(out)
        return None
    try:
        plan = Plan.read(out)
    except (OSError, ValueError) as error:
        raise DatasetError(
            f"{out / PLAN} is missing or damaged ({error}): choose another out, or pass overwrite=True"
        ) from None
    if not _is_same(plan, sources, _request(sources, job)):
        raise DatasetError(
            f"{out} has the pairs of other boxes or other options: choose another out, or pass overwrite=True"
        )
    _check_dataset(out, manifest)
    remove_replaced(out)
    return manifest


def _check_dataset(out: Path, manifest: Manifest) -> None:
    for one in manifest.files:
        if summary_of(out / one["name"]) != (one["pairs"], int(one["hash"], 16)):
            raise DatasetError(f"{out / one['name']} is missing or damaged: choose another out, or pass overwrite=True")


def _run(sources: list[Source], job: Job, work: Path, interrupted: Plan | None) -> Manifest:
    total = sum(sum(source.rows) for source in sources)
    request = _request(sources, job)
    plan = _continued(sources, request, job, work, interrupted)
    if plan is not None and job.out is not None and _is_complete(work, plan):
        return finish(plan, work, job.out)
    is_small = total <= _SMALL and job.cells is None and not any(source.partitions for source in sources)
    if is_small and job.workers is None and (plan is None or plan.cells.number == 1) and _fits(sources, total, job):
        if plan is not None:
            start_over(plan, work)
        whole = Cells(dimensions_of(sources), [], [], [], [])
        return _in_memory(_plan(sources, whole, request), job, work, max(total, 1))
    with started(job.memory_limit, job.workers) as workers:
        rows = max(workers.memory // _bytes_of_box(sources), _LEAST_ROWS)
        is_continued = plan is not None
        if plan is None:
            plan = _planned(sources, job, workers, rows, request, total)
            plan.write(work)
        spill = spill_of(plan, work, job.spill)
        use_spill(plan, work, spill)
        folders = Folders(str(work), str(spill))
        if is_continued:
            _check_files(folders, workers)
        return _steps(plan, sources, job, folders, workers, rows)


def _in_memory(plan: Plan, job: Job, work: Path, rows: int) -> Manifest:
    """Finds the pairs of few boxes at once; after an error there is nothing to continue."""
    plan.write(work)
    try:
        folders = Folders(str(work), str(work))
        joined, boxes = join_everything(folders, plan, "everything", rows, job.out is None)
        job.progress(1.0)
    except Exception:
        start_over(plan, work)
        raise
    return _complete(job, plan, work, [joined], boxes, 1.0)


def _continued(
    sources: list[Source], request: dict[str, Any], job: Job, work: Path, interrupted: Plan | None
) -> Plan | None:
    """The plan of a run that was interrupted; None if it has to start again."""
    if interrupted is None or _is_same(interrupted, sources, request):
        return interrupted
    if not job.overwrite and has_results(interrupted, work):
        raise DatasetError(
            f"{work} is an interrupted run of other boxes or other options: repeat that call to continue it, choose "
            "another out, or pass overwrite=True to start again"
        )
    start_over(interrupted, work)
    return None


def _is_complete(work: Path, plan: Plan) -> bool:
    """Whether an interrupted run has only to name its dataset. If a file is damaged, it has to find pairs again."""
    if not (work / MANIFEST).exists():
        return False
    with suppress(DatasetError):
        manifest = read_manifest(work)
        if all(
            summary_of(work / one["name"]) == (one["pairs"], int(one["hash"], 16))
            and has_its_pairs(work / one["name"], plan.id_types)
            for one in manifest.files
        ):
            return True
    (work / MANIFEST).unlink()
    return False


def _check_files(folders: Folders, workers: Workers) -> None:
    """Removes damaged files of an interrupted run, and those of a cell of which it is not known how it was split."""
    of_nodes, spilled = nodes_of(Path(folders.work)), spilled_nodes_of(Path(folders.spill))
    split = set()
    for name, path in of_nodes:
        if path == folders.split(name):
            try:
                noted = read_sealed(path)["cells"]
            except (OSError, ValueError):
                path.unlink()
                continue
            if noted is not None:
                split.add(name)
    for name, path in of_nodes:
        if not split.issuperset(_split_into(name)):
            path.unlink(missing_ok=True)
    for name, path in spilled:
        if name and not split.issuperset([*_split_into(name), name]):
            forget(path)
    pairs = [path for _, path in of_nodes if path.suffix == ".parquet" and path.exists()]
    workers.run(check_file, [(folders, path) for path in (*pairs, *(path for _, path in spilled))], lambda _: None)


def _split_into(name: str) -> list[str]:
    """The cells that were split so that there is a cell of this name."""
    parts = name.split(".")
    return [".".join(parts[:number]) for number in range(1, len(parts))]


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
    return _plan(sources, choose_cells(sample, count), request)


def _plan(sources: list[Source], cells: Cells, request: dict[str, Any]) -> Plan:
    files, forms = [source.files for source in sources], [source.form for source in sources]
    return Plan(files, forms, chunks_of(sources), cells, request, uuid.uuid4().hex)


def sample_of(sources: list[Source], wanted: int, dimensions: int) -> Floats:
    """A sample of the boxes of all sets: `wanted` boxes or a few more."""
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
            joined.append(Joined(node.name, *summary))
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
    return _complete(job, plan, Path(folders.work), joined, boxes, copies)


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


def _complete(job: Job, plan: Plan, work: Path, joined: list[Joined], boxes: list[int], copies: float) -> Manifest:
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
        sync(work / str(one["name"]))
    write_manifest(work, manifest)
    return finish(plan, work, job.out)


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
        """Notes that `rows` more rows are scattered."""
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
