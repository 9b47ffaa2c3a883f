"""The files of a run: their names, and the rule that no other file is ever removed or replaced."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import lru_cache
from pathlib import Path
from typing import NamedTuple

from .dataset import MANIFEST, DatasetError, Manifest, read_manifest
from .files import PART, read_sealed, write_sealed
from .plan import PLAN, Plan

REPLACED = "_replaced"
"""The dataset that a finished run is about to replace."""
_SPILL = "_spill.json"
_SPILL_FOLDER = "spill"
LOCK = "lock"
"""The file that one process has while it uses a folder."""

_NODE = r"cell-(\d{5,}|wide)(\.(\d{5,}|wide))*"
_RESULT = re.compile(rf"(everything|nothing|{_NODE})\.parquet|_{_NODE}\.split\.json")
_NOTE = re.compile("|".join(map(re.escape, (LOCK, PLAN, MANIFEST, _SPILL))))
_SPILLED = re.compile(rf"(chunk-(?P<chunk>\d{{6,}})|{_NODE}-[01])\.(arrow|json)")


class Folders(NamedTuple):
    """Where a run keeps its files."""

    work: str
    """The plan and the finished cells."""
    spill: str
    """The boxes on their way to the cells."""

    def plan(self) -> Plan:
        """The plan of the run."""
        path = Path(self.work) / PLAN
        try:
            return _plan(self.work, path.stat().st_mtime_ns)
        except (OSError, ValueError) as error:
            raise DatasetError(f"{path} is missing or damaged ({error}): remove {self.work} and call again") from None

    def boxes(self, plan: Plan, level: str, argument: int) -> list[Path]:
        """The files with the boxes of a set."""
        if level:
            return [Path(self.spill) / f"{level}-{argument}.arrow"]
        return [self.chunk(number) for number, chunk in enumerate(plan.chunks) if chunk.argument == argument]

    def chunk(self, number: int) -> Path:
        """The file with the boxes of a chunk."""
        return Path(self.spill) / f"chunk-{number:06}.arrow"

    def split(self, name: str) -> Path:
        """The file that says how a node was split."""
        return Path(self.work) / f"_{name}.split.json"

    def pairs(self, name: str) -> Path:
        """The file with the pairs of a node."""
        return Path(self.work) / f"{name}.parquet"


@lru_cache(maxsize=2)
def _plan(folder: str, _changed: int) -> Plan:
    return Plan.read(Path(folder))


def work_of(out: Path) -> Path:
    """The folder of a run until its dataset is complete."""
    return out.with_name(out.name + ".unfinished")


def boxes_of(out: Path) -> Path:
    """The folder of the boxes of files that a run cannot read as they are."""
    return out.with_name(out.name + ".boxes")


@contextmanager
def claimed(work: Path) -> Iterator[Plan | None]:
    """Makes the folder of a run, or takes that of an interrupted run, for this process alone.

    Yields its plan, or None if it is a new one.

    Raises:
        DatasetError: if the folder has a file that is not of a run, or another process works in it. Nothing is changed
            then.
    """
    _check(work)
    work.mkdir(parents=True, exist_ok=True)
    with locked(work / LOCK):
        plan = _check(work)
        _remove(work, lambda name: re.fullmatch(re.escape(PLAN) + PART, name) or _is_part(plan, name))
        try:
            yield plan
        except BaseException:
            if work.is_dir() and set(os.listdir(work)) <= {LOCK}:  # nothing was done
                (work / LOCK).unlink(missing_ok=True)
                with suppress(OSError):
                    work.rmdir()
            raise


def _check(work: Path) -> Plan | None:
    """The plan of the run in a folder; None if there is none yet."""
    if not os.path.lexists(work):
        return None
    if work.is_symlink() or not work.is_dir():
        raise DatasetError(f"{work} exists and is no folder of a run: rename it, or choose another out")
    if (work / PLAN).exists():
        try:
            plan = Plan.read(work)
        except ValueError as error:
            raise DatasetError(
                f"{work / PLAN} is damaged: {error}; remove the folder {work} if you know what is in it, or choose "
                "another out"
            ) from None
        refuse_others(work, plan)
        return plan
    others = [
        name
        for name in os.listdir(work)
        if not re.fullmatch(re.escape(PLAN) + PART, name)
        and not (name == LOCK and (work / name).is_file() and (work / name).stat().st_size == 0)
    ]
    if others:
        raise DatasetError(
            f"{work} exists and is no folder of a run, it has {_some(others)}: rename it, or choose another out"
        )
    return None


@contextmanager
def locked(path: Path) -> Iterator[None]:
    """Makes a file, if need be, and keeps it for this process alone.

    Raises:
        DatasetError: if another process has it.
    """
    try:
        import fcntl
    except ImportError:  # there are no such locks on Windows
        path.touch()
        yield
        return
    with open(path, "a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise DatasetError(f"{path.parent} is in use by another run: wait for it, or choose another out") from None
        yield


def is_of_run(plan: Plan, name: str) -> bool:
    """Whether a run with this plan gives a file in its folder this name."""
    name = re.sub(PART + "$", "", name)
    if _NOTE.fullmatch(name):
        return True
    return _RESULT.fullmatch(name) is not None and _has_cell(plan, name)


def _is_spilled(plan: Plan, name: str) -> bool:
    name = re.sub(PART + "$", "", name)
    match = _SPILLED.fullmatch(name)
    if match is None:
        return False
    if match["chunk"] is not None:
        return int(match["chunk"]) < len(plan.chunks)
    return _has_cell(plan, name)


def _has_cell(plan: Plan, name: str) -> bool:
    match = re.match(r"_?cell-(\d+)", name)
    return match is None or int(match[1]) < plan.cells.number


def _is_part(plan: Plan | None, name: str) -> bool:
    return plan is not None and is_of_run(plan, name) and re.search(PART + "$", name) is not None


def refuse_others(work: Path, plan: Plan) -> None:
    """Raises an error if the folder of a run has something else."""
    others = _others(work, lambda name: is_of_run(plan, name), {_SPILL_FOLDER, REPLACED})
    spill = work / _SPILL_FOLDER
    if spill.is_dir():
        others += [f"{_SPILL_FOLDER}/{name}" for name in _others(spill, lambda name: _is_spilled(plan, name), set())]
    _refuse(work, others, "of this run")


def refuse_others_in_dataset(out: Path, manifest: Manifest) -> None:
    """Raises an error if the folder of a dataset has something else."""
    names = _names_of(manifest)
    _refuse(out, _others(out, lambda name: name in names, {REPLACED}), "of this dataset")


def _names_of(manifest: Manifest) -> set[str]:
    return {MANIFEST, PLAN, *(str(one["name"]) for one in manifest.files)}


def _others(folder: Path, is_known: Callable[[str], bool], folders: set[str]) -> list[str]:
    def is_other(entry: os.DirEntry[str]) -> bool:
        if entry.is_dir(follow_symlinks=False):
            return entry.name not in folders
        return not (entry.is_file(follow_symlinks=False) and is_known(entry.name))

    with os.scandir(folder) as entries:
        return [entry.name for entry in entries if is_other(entry)]


def _refuse(folder: Path, others: list[str], what: str) -> None:
    if others:
        raise DatasetError(f"{folder} has files that are not {what}: {_some(others)}; move them to another place")


def _some(names: list[str]) -> str:
    shown = [name if name.isprintable() else repr(name) for name in sorted(names)[:3]]
    return ", ".join(shown) + (f" and {len(names) - 3} more" if len(names) > 3 else "")


def _remove(folder: Path, is_known: Callable[[str], object]) -> None:
    """Removes the regular files with a known name, and nothing else."""
    try:
        names = [entry.name for entry in os.scandir(folder) if entry.is_file(follow_symlinks=False)]
    except (FileNotFoundError, NotADirectoryError):
        return
    for name in names:
        if is_known(name):
            (folder / name).unlink(missing_ok=True)


def spill_of(plan: Plan, work: Path, chosen: Path | None) -> Path:
    """The folder for the boxes on their way to the cells."""
    return work / _SPILL_FOLDER if chosen is None else chosen / f"sweep-and-prune-{plan.run}"


def use_spill(plan: Plan, work: Path, spill: Path) -> None:
    """Makes the folder of the spill files and notes where it is. Removes those of the interrupted run elsewhere."""
    if _noted_spill(work) not in (None, spill.absolute()):
        _remove_spill(plan, work)
    write_sealed(work / _SPILL, {"folder": str(spill.absolute())})
    spill.mkdir(parents=True, exist_ok=True)
    _remove(spill, lambda name: _is_spilled(plan, name) and re.search(PART + "$", name))


def _noted_spill(work: Path) -> Path | None:
    try:
        return Path(read_sealed(work / _SPILL)["folder"])
    except (OSError, ValueError):
        return None


def _remove_spill(plan: Plan, work: Path) -> None:
    for folder in {work / _SPILL_FOLDER, _noted_spill(work) or work / _SPILL_FOLDER}:
        _remove(folder, lambda name: _is_spilled(plan, name))
        with suppress(OSError):  # it is not there, or it has other files
            folder.rmdir()


def has_results(plan: Plan, work: Path) -> bool:
    """Whether a run has done more than to begin."""
    spill = _noted_spill(work) or work / _SPILL_FOLDER
    return any(_RESULT.fullmatch(name) or name == MANIFEST for name in os.listdir(work)) or (
        spill.is_dir() and any(_SPILLED.fullmatch(name) for name in os.listdir(spill))
    )


def start_over(plan: Plan, work: Path) -> None:
    """Removes the files of a run, its plan at last."""
    _remove_spill(plan, work)
    _remove(work, lambda name: name not in (LOCK, PLAN) and is_of_run(plan, name))
    (work / PLAN).unlink(missing_ok=True)


def nodes_of(work: Path) -> list[tuple[str, Path]]:
    """The files of a run that belong to a cell, with the name of the cell: of pairs, and of how cells were split."""
    found = []
    for path in work.iterdir():
        match = re.fullmatch(rf"_?({_NODE})(\.parquet|\.split\.json)", path.name)
        if match is not None:
            found.append((match[1], path))
    return found


def spilled_nodes_of(spill: Path) -> list[tuple[str, Path]]:
    """The files with boxes, there or not, of which there are counts; and the cell that they were split from, or ""."""
    found = []
    for path in spill.glob("*.json"):
        if _SPILLED.fullmatch(path.name):
            match = re.fullmatch(rf"({_NODE})-[01]", path.stem)
            found.append((match[1] if match is not None else "", path.with_suffix(".arrow")))
    return found


def finish(plan: Plan, work: Path, out: Path) -> Manifest:
    """Gives a complete dataset its name, in place of the dataset that has it so far."""
    refuse_others(work, plan)
    manifest = read_manifest(work)
    names = _names_of(manifest)
    _remove_spill(plan, work)
    if (work / _SPILL_FOLDER).exists():
        raise DatasetError(f"{work / _SPILL_FOLDER} has files that are not of this run: move them to another place")
    if os.path.lexists(out):
        if is_empty(out):
            out.rmdir()
        else:
            refuse_others_in_dataset(out, read_manifest(out))
            remove_replaced(work)
            os.rename(out, work / REPLACED)
    _remove(work, lambda name: name not in names and is_of_run(plan, name))
    os.rename(work, out)
    remove_replaced(out)
    return manifest


def remove_replaced(folder: Path) -> None:
    """Removes the dataset that was replaced, and nothing else."""
    replaced = folder / REPLACED
    try:
        names = _names_of(read_manifest(replaced))
    except DatasetError:
        names = set()
    _remove(replaced, lambda name: name in names - {MANIFEST})
    _remove(replaced, lambda name: name in names)
    with suppress(OSError):
        replaced.rmdir()


def is_empty(folder: Path) -> bool:
    """Whether this is a folder with nothing in it."""
    return folder.is_dir() and not folder.is_symlink() and not any(folder.iterdir())
