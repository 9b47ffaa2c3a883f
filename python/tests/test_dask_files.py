"""Runs through files remove, replace and believe only files of their own, wherever they are interrupted."""

from __future__ import annotations

import json
import os
import random
import shutil
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from disk import BOXES, PAIRS, Interrupted, dataset, interrupt, write
from oracle import in_order

import sweep_and_prune as core

pytest.importorskip("distributed")

import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned import files, tasks, workers
from sweep_and_prune._partitioned import run as run_module

pytestmark = pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")
IS_LONG = "TEST_LONG" in os.environ


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def small_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cells of more than 500 boxes are split, and the in-memory shortcut is never taken."""
    monkeypatch.setattr(run_module, "_LEAST_ROWS", 500)
    monkeypatch.setattr(run_module, "_CHUNK_ROWS", 700)
    monkeypatch.setattr(workers, "_for_boxes", lambda memory, limit: 500)


def tree(folder: str) -> dict[str, tuple[int, bytes]]:
    """The names, modes and contents of all files in a folder."""
    found = {}
    for path in [Path(folder), *sorted(Path(folder).rglob("*"))]:
        content = os.readlink(path).encode() if path.is_symlink() else path.read_bytes() if path.is_file() else b""
        found[str(path)] = path.lstat().st_mode, content
    return found


def thesis(folder: str) -> dict[str, tuple[int, bytes]]:
    """A folder of the user's, with names that a run has, too."""
    Path(folder, "spill").mkdir(parents=True)
    for name in ("thesis.txt", "lock", "cell-00000.parquet", "spill/chunk-000000.arrow", "_manifest.json.part"):
        Path(folder, name).write_text("all that I have")
    return tree(folder)


def crowded() -> None:
    boxes = BOXES.copy()
    boxes[:900] /= 10  # so that some cell is split again
    write("a.parquet", boxes)


def refused(match: str, source: Any = "a.parquet", out: str = "out", **options: Any) -> None:
    before = tree(".")
    with pytest.raises(sap.DatasetError, match=match):
        sap.find_pairs(source, out=out, workers=0, **options)
    assert tree(".") == before, "nothing is changed"


def find(**options: Any) -> sap.Manifest:
    sap.find_pairs("a.parquet", out="out", workers=0, **options)
    return sap.read_manifest("out")


def interrupted(monkeypatch: pytest.MonkeyPatch, after: int, **options: Any) -> None:
    with monkeypatch.context() as patch:
        interrupt(patch, after)
        with pytest.raises(Interrupted):
            find(**options)


@pytest.mark.parametrize("overwrite", [False, True])
@pytest.mark.parametrize("options", [{}, {"cells": 5}], ids=["in memory", "in cells"])
def test_a_folder_beside_out_with_the_name_of_an_interrupted_run_is_left_alone(
    overwrite: bool, options: dict[str, Any]
) -> None:
    write("a.parquet")
    thesis("thesis.unfinished")
    refused("thesis.unfinished exists and is no folder of a run", out="thesis", overwrite=overwrite, **options)
    for name in ("thesis.txt", "lock"):
        shutil.rmtree("thesis.unfinished")
        Path("thesis.unfinished").mkdir()
        Path("thesis.unfinished", name).write_text("all that I have")
        refused("thesis.unfinished exists and is no folder", out="thesis", overwrite=overwrite, **options)
    shutil.rmtree("thesis.unfinished")
    Path("thesis.unfinished").write_text("all that I have")
    refused("thesis.unfinished exists and is no folder", out="thesis", overwrite=overwrite, **options)
    Path("thesis.unfinished").unlink()
    thesis("elsewhere")
    if sys.platform != "win32":
        Path("thesis.unfinished").symlink_to("elsewhere")
        refused("thesis.unfinished exists and is no folder", out="thesis", overwrite=overwrite, **options)


def test_overwriting_a_dataset_removes_nothing_else(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    find(cells=5)
    for name in ("thesis.txt", "cell-00099.parquet", ".hidden", "thesis/thesis.txt", "_replaced.txt"):
        Path("out", name).parent.mkdir(exist_ok=True)
        Path("out", name).write_text("all that I have")
        refused("out has files that are not of this dataset: ", overwrite=True, margin=1)
        shutil.rmtree("out/thesis") if "/" in name else Path("out", name).unlink()
    write("a.parquet", BOXES[::-1])
    before = tree("out")
    interrupted(monkeypatch, 4, cells=5, overwrite=True)
    assert tree("out") == before, "it is replaced at the end"
    find(cells=5, overwrite=True)
    assert np.array_equal(dataset(), in_order(core.find_pairs(BOXES[::-1])))
    assert not list(Path("out").glob("_replaced"))


def test_files_within_an_interrupted_run_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    interrupted(monkeypatch, 4, cells=5)
    names = ["thesis.txt", "cell-00099.parquet", "chunk-000000.arrow", "spill/thesis.txt", "spill/chunk-000099.arrow"]
    for name in names:
        path = Path("out.unfinished", name)
        path.write_text("all that I have")
        for overwrite in (False, True):
            refused(f"files that are not of this run: {name}", cells=5, overwrite=overwrite)
            refused(f"files that are not of this run: {name}", cells=5, overwrite=overwrite, margin=1)
        path.unlink()
    find(cells=5)
    assert np.array_equal(dataset(), PAIRS)


def test_other_files_in_the_folder_for_spill_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    before = thesis("scratch")
    interrupted(monkeypatch, 4, cells=5, spill="scratch")
    (inside,) = Path("scratch").glob("sweep-and-prune-*")
    (inside / "thesis.txt").write_text("all that I have")
    find(cells=5)
    assert [path.name for path in inside.iterdir()] == ["thesis.txt"]
    shutil.rmtree(inside)
    assert tree("scratch") == before
    # And what the note of a run names, whatever it says.
    for options in ({}, {"overwrite": True, "margin": 1}):
        interrupted(monkeypatch, 4, cells=6, overwrite=True)
        before = thesis("thesis")
        note = Path("out.unfinished/_spill.json")
        assert note.exists()
        files.write_sealed(note, {"folder": str(Path("thesis").absolute())})
        find(cells=6, **{"overwrite": True, **options})
        assert tree("thesis") == before
        shutil.rmtree("thesis")


@pytest.mark.skipif(sys.platform == "win32", reason="symbolic links need a right there")
def test_out_is_found_through_a_symbolic_link_and_may_be_an_empty_folder() -> None:
    write("a.parquet")
    Path("disk/pairs").mkdir(parents=True)
    Path("out").symlink_to("disk/pairs")
    for cells in (5, 6):
        find(cells=cells, overwrite=True)
        assert Path("out").is_symlink() and [path.name for path in Path("disk").iterdir()] == ["pairs"]
    assert sap.read_manifest("disk/pairs").pairs == len(PAIRS)


def test_an_error_in_few_boxes_leaves_nothing() -> None:
    boxes = BOXES.copy()
    boxes[77, 0] = np.nan
    write("a.parquet", boxes)
    with pytest.raises(sap.InvalidRowError):
        sap.find_pairs("a.parquet", out="out")
    assert [path.name for path in Path().iterdir()] == ["a.parquet"]
    write("a.parquet")
    sap.find_pairs("a.parquet", out="out")
    assert np.array_equal(dataset(), PAIRS)


def test_out_within_the_boxes_is_refused() -> None:
    Path("boxes/more").mkdir(parents=True)
    write("boxes/a.parquet")
    for out in ("boxes/pairs", "boxes/more/pairs", "boxes", "./boxes/../boxes/pairs"):
        with pytest.raises(ValueError, match="the pairs would be read as boxes, too; choose an out elsewhere"):
            sap.find_pairs("boxes", out=out, workers=0)
    assert sorted(tree("boxes")) == ["boxes", "boxes/a.parquet", "boxes/more"]
    sap.find_pairs("boxes", out="boxes/_pairs", workers=0, cells=3)  # names like this one are passed over
    for _ in range(2):
        assert sap.find_pairs("boxes", out="boxes/_pairs", workers=0, cells=3).shape[0].compute() == len(PAIRS)
    shutil.rmtree("boxes/_pairs")
    sap.find_pairs("boxes/**/*.parquet", out="boxes/more/pairs", workers=0, cells=3)
    with pytest.raises(ValueError, match=r"has boxes and is in out \(.*\): choose another out"):
        sap.find_pairs("boxes/**/*.parquet", out="boxes/more/pairs", workers=0, cells=3)


def test_wrong_paths_and_columns_are_refused() -> None:
    write("a.parquet")
    before = tree(".")
    for call in (sap.find_pairs, sap.count_pairs):
        with pytest.raises(TypeError, match=r"columns must be a list of names, .* not the text 'minx'"):
            call("a.parquet", columns="minx")
        with pytest.raises(ValueError, match="boxes is an empty list: pass the path of one file or more"):
            call([])
        with pytest.raises(ValueError, match=r"boxes is 'a\\x00.parquet': a name cannot contain a zero byte"):
            call(["a.parquet", "a\0.parquet"])
        with pytest.raises(ValueError, match="boxes is an empty text"):
            call("")
    with pytest.raises(ValueError, match="b is an empty list"):
        sap.find_pairs_between("a.parquet", [])
    for name in ("out", "spill"):
        with pytest.raises(ValueError, match=rf"{name} is 'p\\x00airs': a name cannot contain a zero byte"):
            options: dict[str, Any] = {"out": "out", name: "p\0airs"}
            sap.find_pairs("a.parquet", **options)
    with pytest.raises(ValueError, match="a name cannot contain a zero byte"):
        sap.read_manifest("p\0airs")
    with pytest.raises(ValueError, match="it must be the name of a folder"):
        sap.find_pairs("a.parquet", out="/")
    with pytest.raises(ValueError, match=r"a\.parquet has boxes and is in out"):
        sap.find_pairs("a.parquet", out=".")
    assert tree(".") == before


class Killed(BaseException):
    pass


def kill(patch: pytest.MonkeyPatch, after: int) -> Callable[[], int]:
    """Ends the process, as it were, at a change of a name on disk: no later change happens either."""
    changes = 0

    def counted(real: Any) -> Any:
        def change(*arguments: Any, **options: Any) -> Any:
            nonlocal changes
            changes += 1
            if changes > after:
                raise Killed
            return real(*arguments, **options)

        return change

    for name in ("rename", "replace", "unlink", "rmdir", "mkdir"):
        patch.setattr(os, name, counted(getattr(os, name)))
    return lambda: changes


def test_boxes_that_are_written_are_not_written_again(monkeypatch: pytest.MonkeyPatch, small_memory: None) -> None:
    write("a.parquet")
    tasks_of: list[list[int]] = []
    real = workers.Workers.run

    def noted(self: Any, task: Any, arguments: Any, done: Any) -> None:
        if task is tasks.scatter_chunk:
            tasks_of.append([number for _, number, *_ in arguments])
        real(self, task, arguments, done)

    monkeypatch.setattr(workers.Workers, "run", noted)
    for spill in (None, "scratch"):
        options = {"spill": spill}
        interrupted(monkeypatch, 3, cells=6, **options)
        find(cells=6, **options)
        assert tasks_of == [[*range(7)], [3, 4, 5, 6]]
        tasks_of.clear()
        shutil.rmtree("out")


@pytest.mark.parametrize("is_overwriting", [False, True])
def test_a_run_continues_after_each_change_on_disk(
    monkeypatch: pytest.MonkeyPatch, small_memory: None, is_overwriting: bool
) -> None:
    crowded()
    if is_overwriting:
        find(cells=2)
        shutil.copytree("out", "old")
    wanted = find(cells=6, overwrite=True)
    shutil.rmtree("out")
    before = thesis("thesis")
    after, complete = 0, 0
    step = 1 if IS_LONG else 5
    while not complete:
        if is_overwriting:
            shutil.copytree("old", "out")
        with monkeypatch.context() as patch:
            changes = kill(patch, after)
            try:
                find(cells=6, overwrite=is_overwriting)
                complete = changes()
            except Killed:
                pass
        assert find(cells=6, overwrite=is_overwriting) == wanted, after
        assert not any(path.name.startswith("out.") for path in Path().iterdir()) and tree("thesis") == before
        assert {path.suffix for path in Path("out").iterdir()} == {".parquet", ".json"}
        shutil.rmtree("out")
        after += step
    assert complete > 20


def damage(path: Path, some: random.Random) -> None:
    """Flips a bit, or else removes the file or the second half of it."""
    what = "flip" if path.name == "_plan.json" else some.choice(["flip", "flip", "remove", "cut"])
    if what == "flip":
        flipped(path, some)
    elif what == "remove":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def flipped(path: Path, some: random.Random) -> None:
    content = bytearray(path.read_bytes())
    content[some.randrange(len(content))] ^= 1 << some.randrange(8)
    path.write_bytes(content)


@pytest.fixture
def halves(monkeypatch: pytest.MonkeyPatch, small_memory: None) -> Iterator[list[Path]]:
    """Interrupted runs: while boxes are written, while cells are split, while cells are joined, and at the very end."""
    crowded()
    found = []
    for after in (3, 9, 20):
        interrupted(monkeypatch, after, cells=6)
        found.append(Path("out.unfinished").rename(f"half-{after}"))
    with monkeypatch.context() as patch:
        patch.setattr(run_module, "finish", lambda *_: 1 / 0)
        with pytest.raises(ZeroDivisionError):
            find(cells=6)
    found.append(Path("out.unfinished").rename("half-complete"))
    yield found


def test_damage_to_any_file_of_a_run_gives_the_same_pairs_or_one_error(halves: list[Path]) -> None:
    wanted = find(cells=6)
    expected = dataset()
    shutil.rmtree("out")
    some, outcomes = random.Random(1), {"same": 0, "error": 0}
    for half in halves:
        for path in sorted(half.rglob("*")):
            name = path.relative_to(half)
            flips = 1 if not IS_LONG else 8
            for _ in range(flips * (8 if name.name == "_plan.json" else 1) if path.is_file() else 0):
                if not path.stat().st_size:
                    continue
                shutil.copytree(half, "out.unfinished")
                damage(Path("out.unfinished") / name, some)
                damaged = tree("out.unfinished")
                try:
                    found = find(cells=6)
                except sap.DatasetError as error:
                    outcomes["error"] += 1
                    assert name.name in str(error) and tree("out.unfinished") == damaged
                    shutil.rmtree("out.unfinished")
                    continue
                outcomes["same"] += 1
                assert (found.pairs, found.hash) == (wanted.pairs, wanted.hash), (half, name)
                assert np.array_equal(dataset(), expected), (half, name)
                shutil.rmtree("out")
    print(outcomes)
    assert outcomes["same"] > 50 and outcomes["error"] >= 30


def test_a_changed_plan_is_not_followed(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    interrupted(monkeypatch, 4, cells=5)
    plan = Path("out.unfinished/_plan.json")
    text = plan.read_text()
    # Another number of a row group, as one flipped bit makes it: its boxes would be left out, and others taken twice.
    changed = json.loads(text)
    chunks = changed["chunks"] if isinstance(changed, dict) else changed[2]
    chunks[0][2][0] ^= 1
    plan.write_text(json.dumps(changed))
    refused("_plan.json is damaged: its checksum does not match", cells=5)
    refused("_plan.json is damaged: its checksum does not match", cells=5, overwrite=True)
    plan.write_text(text)
    find(cells=5)
    assert np.array_equal(dataset(), PAIRS)


def test_a_flipped_bit_in_a_dataset_is_found_by_its_manifest() -> None:
    write("a.parquet")
    find(cells=3)
    before = Path("out/_manifest.json").read_text()
    some = random.Random(2)
    for _ in range(100):
        flipped(Path("out/_manifest.json"), some)
        try:
            assert sap.read_manifest("out") == sap.Manifest(
                **{name: value for name, value in json.loads(before).items() if name != "checksum"}
            )
        except sap.DatasetError as error:
            assert "_manifest.json is damaged" in str(error)
        Path("out/_manifest.json").write_text(before)
    Path("out/cell-00001.parquet").write_bytes(b"PAR1")
    refused(r"cell-00001.parquet is missing or damaged: choose another out, or pass overwrite=True", cells=3)
    find(cells=3, overwrite=True)
    assert np.array_equal(dataset(), PAIRS)
