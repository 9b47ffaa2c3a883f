"""Two hundred runs in which something goes wrong: each ends with the same pairs, or with one error."""

from __future__ import annotations

import os
import random
import shutil
import signal
import subprocess
import sys
import time
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from disk import children_of, write
from oracle import random_boxes

import sweep_and_prune as core

pytest.importorskip("distributed")
from sweep_and_prune._partitioned.dataset import hash_pairs

pytestmark = [
    pytest.mark.skipif("TEST_LONG" not in os.environ, reason="takes minutes: ./test python --long"),
    pytest.mark.skipif(sys.platform != "linux", reason="processes are found and ended in the way of Linux"),
]

RUNS_OF_EACH_KIND = int(os.environ.get("FAULT_RUNS", "50"))
CELLS = 20
MOST_FILES = 40
"""In the folder of a run, about."""

SCRIPT = """
import resource, sys
import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned import run

if __name__ == "__main__":
    source, out, workers, size = sys.argv[1], sys.argv[2], int(sys.argv[3]), int(sys.argv[4])
    run._CHUNK_ROWS = 10_000
    if size:
        resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
    try:
        sap.find_pairs(source, out=out, memory_limit="2GB", workers=workers, cells=%d)
    except sap.DatasetError as error:
        print(error)
        sys.exit(3)
    print(sap.read_manifest(out).hash)
"""


class Case:
    """A folder with runs in it, and with files of the user's that must stay as they are."""

    def __init__(self, folder: Path, source: Path, seed: int) -> None:
        self.folder, self.source, self.some = folder, source, random.Random(seed)
        self.out, self.work = folder / "out", folder / "out.unfinished"
        for name in ("thesis/cell-00000.parquet", "out.parquet", "out.unfinished.part"):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text("all that I have")
        (folder / "script.py").write_text(SCRIPT % CELLS)
        self.before = self._others()

    def _others(self) -> dict[str, bytes]:
        own = {self.out, self.work}
        return {
            str(path): path.read_bytes()
            for path in self.folder.rglob("*")
            if path.is_file() and own.isdisjoint(path.parents)
        }

    def start(self, workers: int, size: int = 0) -> subprocess.Popen[str]:
        command = [sys.executable, "script.py", str(self.source), str(self.out), str(workers), str(size)]
        pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
        return subprocess.Popen(command, cwd=self.folder, start_new_session=True, **pipes)

    def ended(self, program: subprocess.Popen[str]) -> tuple[int, str]:
        """Its status and what it said. It must not hang, show a traceback, or touch a file of the user's."""
        try:
            out, err = program.communicate(timeout=300)
        except subprocess.TimeoutExpired:
            os.killpg(program.pid, signal.SIGKILL)
            raise AssertionError(f"it hangs in {self.folder}") from None
        assert "Traceback" not in err, err
        assert program.returncode in (0, 3), (program.returncode, out, err)
        assert self._others() == self.before
        return program.returncode, out.strip()

    def wait_for(self, files: int, program: subprocess.Popen[str]) -> bool:
        """Waits until there are `files` files in the folder of the run; False if it ended before."""
        while program.poll() is None:
            if not files or sum(1 for _ in self.work.rglob("*")) >= files:
                return True
            time.sleep(0.002)
        return False

    def interrupted(self) -> bool:
        """A run that is killed as a whole at some moment."""
        program = self.start(self.some.choice([0, 0, 1, 2]))
        is_interrupted = self.wait_for(self.some.randint(1, MOST_FILES), program)
        if is_interrupted:
            with suppress(ProcessLookupError):
                os.killpg(program.pid, signal.SIGKILL)
        program.communicate()
        assert self._others() == self.before
        return is_interrupted


def kill_workers(case: Case, wanted: str) -> str:
    program = case.start(case.some.choice([1, 2]))
    kills = 0
    for _ in range(case.some.randint(1, 4)):
        if case.wait_for(case.some.randint(0, MOST_FILES), program):
            found: list[int] = []
            while not found and program.poll() is None:
                with suppress(Exception):  # it has just ended
                    found = children_of(program.pid)
            if found:
                with suppress(ProcessLookupError):
                    os.kill(case.some.choice(found), signal.SIGKILL)
                    kills += 1
    assert case.ended(program) == (0, wanted)
    return "killed" if kills else "none was killed"


def kill_all(case: Case, wanted: str) -> str:
    interruptions = sum(case.interrupted() for _ in range(case.some.randint(1, 3)))
    assert case.ended(case.start(case.some.choice([0, 0, 1]))) == (0, wanted)
    return "killed" if interruptions else "none was killed"


def fill_disk(case: Case, wanted: str) -> str:
    """No file may become larger than a limit; `test_dask_long.py` fills a disk that is really small."""
    size = int(10 ** case.some.uniform(2, 6.5))
    status, said = case.ended(case.start(case.some.choice([0, 1]), size))
    assert said == wanted if status == 0 else ("the disk is full" in said or "too large" in said), said
    assert case.out.exists() == (status == 0)
    assert case.ended(case.start(0)) == (0, wanted)
    return "error" if status else "same pairs"


def flip_byte(case: Case, wanted: str) -> str:
    if not case.interrupted():
        return "none was flipped"
    files = sorted(path for path in case.work.rglob("*") if path.is_file() and path.stat().st_size)
    if not files:
        return "none was flipped"
    path = case.some.choice(files)
    content = bytearray(path.read_bytes())
    content[case.some.randrange(len(content))] ^= case.some.randint(1, 255)
    path.write_bytes(content)
    status, said = case.ended(case.start(case.some.choice([0, 0, 1])))
    if status == 0:
        assert said == wanted, path
        return "same pairs"
    assert str(path) in said and not case.out.exists()
    shutil.rmtree(case.work)
    assert case.ended(case.start(0)) == (0, wanted)
    return "error"


@pytest.mark.parametrize("fault", [kill_workers, kill_all, fill_disk, flip_byte])
def test_fifty_runs(fault: Any, tmp_path: Path) -> None:
    boxes = random_boxes(100_000, 2, np.float64)
    source = Path(write(str(tmp_path / "a.parquet"), boxes, group=5000))
    pairs = core.find_pairs(boxes)
    wanted = f"{hash_pairs(pairs[:, 0], pairs[:, 1]):016x}"

    def one(number: int) -> str:
        folder = tmp_path / f"{number}"
        folder.mkdir()
        try:
            return str(fault(Case(folder, source, number), wanted))
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    with ThreadPoolExecutor(3) as threads:
        outcomes = Counter(threads.map(one, range(RUNS_OF_EACH_KIND)))
    print(f"{fault.__name__}: {dict(outcomes)}")
    assert outcomes["killed"] + outcomes["error"] + outcomes["same pairs"] >= RUNS_OF_EACH_KIND * 2 // 3
