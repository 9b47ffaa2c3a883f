"""What takes long: scenes with many boxes, workers that are killed again and again, limits of memory, a full disk."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import write_scenes
from oracle import Array, in_order

import sweep_and_prune as core

pytest.importorskip("distributed")
import psutil
import pyarrow
import pyarrow.parquet
from distributed import Client, LocalCluster

import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned.dataset import hash_pairs

pytestmark = [
    pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning"),
    pytest.mark.skipif("TEST_LONG" not in os.environ, reason="takes minutes: ./test python --long"),
    pytest.mark.skipif(sys.platform != "linux", reason="processes and memory are read in the way of Linux"),
]

NAMES = {2: ["start", "end"], 4: ["minx", "miny", "maxx", "maxy"], 6: ["x0", "y0", "z0", "x1", "y1", "z1"]}
MOST_PAIRS = 5_000_000
MANY_PAIRS = 500_000


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    yield
    shutil.rmtree(tmp_path)


def write(name: str, boxes: Array, group: int = 2**20) -> None:
    table = pyarrow.table(dict(zip(NAMES[boxes.shape[1]], boxes.T)))
    pyarrow.parquet.write_table(table, name, row_group_size=group)


def hash_of(boxes: Array) -> str:
    pairs = core.find_pairs(boxes, threads=-1)
    return f"{hash_pairs(pairs[:, 0], pairs[:, 1]):016x}"


@pytest.fixture(scope="module")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> list[tuple[Path, int, str]]:
    """A file with 100,000 boxes of each scene whose pairs are not too many, their number and their hash."""
    folder = tmp_path_factory.mktemp("scenes")
    found = []
    for path in sorted(write_scenes(folder, "100000").iterdir()):
        _, space, kind = path.name.split()
        boxes = np.fromfile(path, "<f4" if kind == "f32" else "<f8").reshape(-1, 2 * int(space[0]))
        count = core.count_pairs(boxes)
        if count <= MOST_PAIRS:
            file = path.with_name(f"{path.name}.parquet")
            write(str(file), boxes, 20_000)
            found.append((file, count, hash_of(boxes)))
        path.unlink()
    assert len(found) > 80
    return found


@pytest.mark.parametrize("workers", [0, 1, 2, 3, 4])
def test_all_scenes_with_100_000_boxes_and_1_to_200_cells(scenes: list[tuple[Path, int, str]], workers: int) -> None:
    with LocalCluster(n_workers=workers, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster):
        for file, count, wanted in scenes:
            # Each scene has each of these once, and each with another number of workers; one with many pairs has one.
            some = random.Random(file.name)
            cells = some.sample([1, 17, 200, some.randint(2, 30), some.randint(30, 199)], 5)[workers]
            if count > MANY_PAIRS and some.randrange(5) != workers:
                continue
            sap.find_pairs(str(file), out="out", cells=cells, workers=0 if workers == 0 else None, overwrite=True)
            manifest = sap.read_manifest("out")
            assert (manifest.pairs, manifest.hash) == (count, wanted), (file.name, cells)


def test_a_million_boxes_from_disk_take_at_most_five_times_as_long_as_in_memory() -> None:
    write("a.parquet", squares(10**6))

    def from_disk() -> None:
        sap.find_pairs("a.parquet", out="out", overwrite=True, progress=False)

    def in_memory() -> None:
        table = pyarrow.parquet.read_table("a.parquet")
        pairs = core.find_pairs(np.column_stack([table[name].to_numpy() for name in NAMES[4]]))
        pyarrow.parquet.write_table(pyarrow.table({"a": pairs[:, 0], "b": pairs[:, 1]}), "pairs.parquet")

    times: dict[Any, list[float]] = {from_disk: [], in_memory: []}
    for _ in range(5):
        for call, of_call in times.items():
            began = time.perf_counter()
            call()
            of_call.append(time.perf_counter() - began)
    ratio = min(times[from_disk]) / min(times[in_memory])
    print(f"from disk {ratio:.1f} times as long as in memory, with reading and writing")
    assert ratio <= 5


SCRIPT = """
import sys
import sweep_and_prune.dask as sap
if __name__ == "__main__":
    sap.find_pairs("a.parquet", out="out", memory_limit=sys.argv[1], workers=int(sys.argv[2]), overwrite=True)
"""


def start(*arguments: str) -> Any:
    Path("script.py").write_text(SCRIPT)
    return psutil.Popen([sys.executable, "script.py", *arguments])


def workers_of(process: Any) -> list[Any]:
    found = []
    with suppress(psutil.Error):
        for one in process.children(recursive=True):
            with suppress(psutil.Error):  # it has just ended
                if "spawn_main" in " ".join(one.cmdline()):
                    found.append(one)
    return found


def squares(count: int) -> Array:
    low = np.random.default_rng(1).random((count, 2))
    return np.hstack([low, low + count**-0.5])


def test_killing_a_worker_at_ten_random_moments_gives_the_same_hash() -> None:
    boxes = squares(10**7)
    write("a.parquet", boxes)
    wanted = hash_of(boxes)
    moments = random.Random(1)
    kills = 0
    while kills < 10:  # a fast machine finishes some runs before the first moment
        process = start("2GB", "2")
        while not Path("out.unfinished/_plan.json").exists() and process.poll() is None:
            time.sleep(0.01)
        began = time.monotonic()
        while process.poll() is None:  # again and again, until it is finished
            time.sleep(moments.uniform(0.5, 12))
            found = workers_of(process)
            if found and time.monotonic() - began < 60:
                with suppress(ProcessLookupError):
                    os.kill(moments.choice(found).pid, signal.SIGKILL)
                    kills += 1
        assert process.wait() == 0
        assert sap.read_manifest("out").hash == wanted


def test_a_run_that_is_killed_as_a_whole_ten_times_ends_with_the_same_hash() -> None:
    boxes = squares(3 * 10**6)
    write("a.parquet", boxes, 100_000)
    script = SCRIPT.replace("overwrite=True", "cells=50")
    Path("killed.py").write_text(script)
    moments = random.Random(2)
    for _ in range(10):
        process = subprocess.Popen([sys.executable, "killed.py", "2GB", "1"], start_new_session=True)
        time.sleep(moments.uniform(1.5, 6))
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
    assert subprocess.run([sys.executable, "killed.py", "2GB", "1"], check=True).returncode == 0
    assert sap.read_manifest("out").hash == hash_of(boxes)


@pytest.mark.parametrize(
    ("limit", "workers"), [("1GB", "1"), ("1GB", "2"), ("1500MB", "3"), ("2GB", "4"), ("4GB", "2"), ("500MB", "0")]
)
@pytest.mark.parametrize("shape", ["squares", "crowded", "giants"])
def test_the_memory_of_all_processes_stays_within_the_limit(limit: str, workers: str, shape: str) -> None:
    boxes = squares(5 * 10**6)
    if shape == "crowded":  # more boxes in one place than a cell may have, at the end of each row group
        boxes[2**20 - 600_000 : 2**20] = boxes[:600_000] / 1000
    elif shape == "giants":
        boxes[::10_000, :2], boxes[::10_000, 2:] = 0, 0.3
    write("a.parquet", boxes)
    process = start(limit, workers)
    peak = 0
    while process.poll() is None:
        resident = 0
        for one in [process, *process.children(recursive=True)]:
            try:
                resident += one.memory_info().rss
            except psutil.Error:
                pass
        peak = max(peak, resident)
        time.sleep(0.02)
    assert process.wait() == 0
    size = float(limit[:-2]) * (1e9 if limit.endswith("GB") else 1e6)
    print(f"{shape}, {limit}, {workers} workers: {peak / 1e6:.0f} MB at most")
    assert peak <= 1.2 * size
    if shape != "giants":
        assert sap.read_manifest("out").pairs == core.count_pairs(boxes, threads=-1)


def test_a_cell_of_nothing_but_pairs_streams_its_output() -> None:
    boxes = np.ones((30_000, 4))  # 450 million pairs, 7.2 GB
    write("a.parquet", boxes)
    process = start("600MB", "0")
    peak = 0
    while process.poll() is None:
        peak = max(peak, process.memory_info().rss)
        time.sleep(0.02)
    assert process.wait() == 0 and peak < 1.2 * 600e6
    assert sap.read_manifest("out").pairs == 30_000 * 29_999 // 2


def test_a_disk_that_is_really_full(tmp_path: Path) -> None:
    small = tmp_path / "small"
    small.mkdir()
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", small], capture_output=True).returncode:
        pytest.skip("only root may mount a small disk")
    try:
        boxes = squares(300_000)
        boxes[:, 2:] += 0.004
        write("a.parquet", boxes)
        with pytest.raises(sap.DatasetError, match="the disk is full"):
            sap.find_pairs("a.parquet", out=str(small / "out"), workers=0, cells=8, spill=str(tmp_path))
        assert not (small / "out").exists()
        subprocess.run(["mount", "-o", "remount,size=500m", small], check=True)
        sap.find_pairs("a.parquet", out=str(small / "out"), workers=0, cells=8, spill=str(tmp_path))
        assert sap.read_manifest(small / "out").pairs == core.count_pairs(boxes)
    finally:
        subprocess.run(["umount", small], check=False)


def test_a_nan_in_row_123_456_789_of_the_third_file() -> None:
    block, row = 2**20, 123_456_789
    rows = np.repeat(np.array([[0, 1]], np.float32), block, axis=0)
    for name in "ab":
        write(f"{name}.parquet", rows[:10])
    wrong = rows.copy()
    wrong[row % block, 1] = np.nan
    plain, with_nan = (pyarrow.table(dict(zip(NAMES[2], boxes.T))) for boxes in (rows, wrong))
    with pyarrow.parquet.ParquetWriter("c.parquet", plain.schema) as writer:
        for number in range(row // block + 1):
            writer.write_table(with_nan if number == row // block else plain)
    with pytest.raises(sap.InvalidRowError, match=rf"^c\.parquet, row {row} \(the first is 0\)") as caught:
        sap.find_pairs(["a.parquet", "b.parquet", "c.parquet"], out="out", memory_limit="4GB", workers=1)
    assert (caught.value.row, caught.value.index) == (row, row + 20)
    assert not Path("out").exists()


def test_two_sets_of_a_million() -> None:
    a, b = squares(10**6), squares(10**6)[:, [1, 0, 3, 2]]
    write("a.parquet", a)
    write("b.parquet", b)
    sap.find_pairs_between("a.parquet", "b.parquet", out="out", workers=0, cells=30)
    found = pyarrow.parquet.read_table("out")
    pairs = in_order(np.column_stack([found["a"].to_numpy(), found["b"].to_numpy()]))
    assert np.array_equal(pairs, in_order(core.find_pairs_between(a, b)))
