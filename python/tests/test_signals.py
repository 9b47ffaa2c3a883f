"""Signals end `sap` with their exit status, and leave either the whole output or none of it."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

SAP = [sys.executable, "-m", "sweep_and_prune"]
POINTS = str(Path(__file__).with_name("signal_points.py"))
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals there")


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


OUTPUT = ["sweep_and_prune/_output.py", "sweep_and_prune/_signals.py"]
"""Where files are made and removed."""
PACKAGE = ["sweep_and_prune/", "contextlib.py"]


@pytest.mark.parametrize(
    ("name", "ignored"), [("SIGINT", None), ("SIGTERM", None), ("SIGHUP", None), ("SIGTERM", "SIGHUP")]
)
@pytest.mark.parametrize("second", [0, 1, 15])
def test_a_signal_at_any_instruction_leaves_no_file_that_is_not_complete(
    name: str, ignored: str | None, second: int
) -> None:
    def ignore() -> None:  # as nohup does
        if ignored is not None:
            signal.signal(getattr(signal, ignored), signal.SIG_IGN)

    is_long = "TEST_LONG" in os.environ
    for places, stride, least in (
        (OUTPUT, 1 if is_long or name == "SIGINT" else 7, 200),
        (PACKAGE, 1 if is_long else 101, 3000),
    ):
        command = [sys.executable, POINTS, name, str(stride), str(second), *places]
        done = subprocess.run(command, capture_output=True, text=True, check=True, preexec_fn=ignore)
        points, *wrong = done.stdout.splitlines()
        assert wrong == []
        assert int(points) > least / stride


INTERRUPTED = """
import os, signal, threading
import numpy as np, sweep_and_prune as sap

boxes = np.random.default_rng(1).random((60_000, 2))
boxes = np.hstack([boxes, boxes + 0.002])
expected = sap.count_pairs(boxes)
interrupts = lost = 0
while interrupts < 20:
    world, begun, ended, threads = sap.BroadPhase(dimensions=2), 0, 0, []

    def interrupted(call):
        global interrupts
        begins = threading.Event()
        threads.append(threading.Thread(target=lambda: (begins.wait(), os.kill(os.getpid(), signal.SIGINT))))
        threads[-1].start()
        returned = []
        try:
            begins.set()
            returned.append(call())
        except KeyboardInterrupt:
            interrupts += not returned
        try:
            threads[-1].join()  # it may be late
        except KeyboardInterrupt:
            pass
        return returned[0] if returned else None

    ids = interrupted(lambda: world.insert_many(boxes))
    lost += ids is None and len(world) > 0  # bodies whose ids are lost
    if len(world) == 0:
        ids = world.insert_many(boxes)
    changes = interrupted(world.update)
    if changes is None and ids is not None:  # the next one reports what moved meanwhile, too
        now = boxes.copy()
        now[::7] += 10
        world.set_many(ids[::7], now[::7])
        world.remove(ids[1])
        after = world.update()
        wanted = np.delete(ids, 1)[sap.find_pairs(np.delete(now, 1, axis=0))]
        found, wanted = (set(map(frozenset, pairs.tolist())) for pairs in (after.begun, wanted))
        lost += found != wanted or len(after.ended) > 0
        continue
    after = world.update()
    reported = len(after.begun) + (0 if changes is None else len(changes.begun))
    assert reported in (0, expected), "doubled"
    lost += reported == 0
print(lost)
"""


def test_ctrl_c_loses_no_event_and_no_id() -> None:
    done = subprocess.run([sys.executable, "-c", INTERRUPTED], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    # Nothing can be done where it comes in the moment between the end of a call and the next instruction of Python.
    assert int(done.stdout) <= 2


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_ends_a_program_that_writes(number: signal.Signals) -> None:
    np.save("a.npy", np.zeros((30_000, 2)))  # 450 million pairs
    program = subprocess.Popen(
        [*SAP, "pairs", "a.npy", "-o", "p.csv"],
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: signal.signal(number, signal.SIG_DFL),
    )
    while not list(Path().glob(".sap-*.part")):
        assert program.poll() is None
    program.send_signal(number)
    _, said = program.communicate(timeout=600)
    assert (program.returncode, said.strip()) == (128 + number, "sap: cancelled")
    assert os.listdir() == ["a.npy"]


def test_a_signal_that_is_ignored_stays_so() -> None:
    np.save("a.npy", [[0.0, 1.0]])
    os.mkfifo("pipe.csv")
    program = subprocess.Popen(
        [*SAP, "pairs", "a.npy", "-o", "pipe.csv"], preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_IGN)
    )
    with open("pipe.csv") as pipe:  # opens when the program does
        program.send_signal(signal.SIGHUP)
        assert pipe.read() == "a,b\n"
    assert program.wait(600) == 0


START = "import sys; from sweep_and_prune_command import program; sys.exit(program())"


def test_ctrl_c_while_modules_are_loaded_gives_one_line() -> None:
    Path("numpy.py").write_text(
        "import os, signal; os.kill(os.getpid(), signal.SIGINT); print('not ended', flush=True)"
    )
    for ignored, status, printed, said in ((False, 130, "", "sap: cancelled\n"), (True, 1, "not ended\n", None)):
        handler = signal.SIG_IGN if ignored else signal.SIG_DFL
        done = subprocess.run(
            [sys.executable, "-c", START],
            capture_output=True,
            text=True,
            preexec_fn=lambda handler=handler: signal.signal(signal.SIGINT, handler),  # type: ignore[misc]
        )
        assert (done.returncode, done.stdout) == (status, printed), done.stderr
        assert said is None or done.stderr == said


def test_ctrl_c_that_a_library_swallows_while_it_is_loaded_ends_the_program() -> None:
    Path("a.csv").write_text("start,end\n0,1\n")
    Path("dask").mkdir()
    Path("dask/__init__.py").write_text(SWALLOWS)
    done = subprocess.run(
        [*SAP, "pairs", "a.csv", "--memory-limit", "1GB", "-o", "out"],
        capture_output=True,
        text=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr.strip() == "sap: cancelled"


@pytest.mark.skipif(find_spec("distributed") is None, reason="needs dask")
def test_ctrl_c_of_a_terminal_does_not_reach_the_workers() -> None:
    program = subprocess.Popen(
        [sys.executable, "-c", WITH_WORKERS],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    assert program.stdout is not None and program.stdout.readline() == "started\n"
    os.killpg(program.pid, signal.SIGINT)
    _, said = program.communicate(timeout=600)
    assert (program.returncode, said) == (0, "")


SWALLOWS = """
import os
try:
    os.kill(os.getpid(), 2)
except BaseException:
    pass
"""
WITH_WORKERS = """
import time
from sweep_and_prune._partitioned.workers import started

if __name__ == "__main__":
    try:
        with started("4GB", 2) as workers:
            workers.client.wait_for_workers(2)
            workers.client.run(abs, 0)  # they have begun
            print("started", flush=True)
            time.sleep(600)
    except KeyboardInterrupt:
        pass
"""


AT_ONCE = """
import os, signal
from pathlib import Path
from sweep_and_prune import _signals

_signals.end_by_signals()
_signals.remove_at_end("a.part")
Path("a.part").touch()
try:
    os.kill(os.getpid(), signal.SIGTERM)
finally:
    try:
        os.kill(os.getpid(), signal.SIGINT)
    finally:
        print("not at once", flush=True)
"""


def test_a_second_signal_ends_at_once_while_the_first_one_is_handled() -> None:
    done = subprocess.run([sys.executable, "-c", AT_ONCE], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "")
    assert os.listdir() == []


def test_what_a_killed_program_left_is_removed_and_nothing_else() -> None:
    np.save("a.npy", np.zeros((30_000, 2)))  # 450 million pairs
    first, second = (subprocess.Popen([*SAP, "pairs", "a.npy", "-o", f"{name}.csv"]) for name in "pq")
    while len(parts := list(Path().glob(".sap-*.part"))) < 2 or not all(part.stat().st_size for part in parts):
        assert first.poll() is second.poll() is None
    first.kill()
    first.wait()
    second.send_signal(signal.SIGSTOP)
    os.waitid(os.P_PID, second.pid, os.WSTOPPED | os.WNOWAIT)
    others = [".sap-1.part", f".sap-{32 * 'g'}.part", f".sap-{32 * 'a'}.part.csv", f".sap-{32 * 'b'}.part"]
    for name in others:
        Path(name).mkdir() if "b" in name else Path(name).touch()
    fresh = Path(f".sap-{32 * 'c'}.part")
    fresh.touch()
    for path in [*parts, *map(Path, others)]:
        os.utime(path, (1e9, 1e9))
    np.save("b.npy", [[0.0, 1.0], [1.0, 2.0]])
    assert subprocess.run([*SAP, "pairs", "b.npy", "-o", "b.csv"]).returncode == 0
    left = {path for path in parts if path.exists()}
    assert len(left) == 1 and second.poll() is None, "the program that still runs keeps its file"
    assert all(Path(name).exists() for name in others) and fresh.exists()
    second.terminate()
    second.send_signal(signal.SIGCONT)
    second.wait()
    assert not any(path.exists() for path in parts)
