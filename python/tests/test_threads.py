"""Threads of Python beside a search, signals in the midst of one, processes forked from one."""

from __future__ import annotations

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
import pytest
from oracle import FLOATS, random_boxes

import sweep_and_prune as sap
from sweep_and_prune._native import processors


@pytest.mark.parametrize("threads", [1, 2])
def test_others_go_on_while_a_search_runs(threads: int) -> None:
    boxes = random_boxes(1_000_000, 3, np.float32)
    finder = sap.PairFinder(3, np.float32, threads=threads)
    searching, stop = threading.Event(), threading.Event()
    steps = 0

    def step() -> None:
        nonlocal steps
        while not stop.is_set():
            steps += searching.is_set()
            time.sleep(0)  # lets others have the GIL

    thread = threading.Thread(target=step)
    thread.start()
    most = 0
    for _ in range(100):
        steps = 0
        searching.set()
        finder.count(boxes)
        searching.clear()
        most = max(most, steps)
        # If no other thread could run during a search, it would make a step or two before and after it.
        if most > 20:
            break
    stop.set()
    thread.join()
    assert most > 20


def test_one_call_at_a_time() -> None:
    boxes = random_boxes(300_000, 3, np.float32)
    finder, world = sap.PairFinder(3, np.float32), sap.BroadPhase(3, np.float32)
    refusals: list[str] = []

    def insist(call: Any) -> None:
        for _ in range(8):
            try:
                call()
            except RuntimeError as error:
                refusals.append(str(error))

    for name, call in (("PairFinder", lambda: finder.count(boxes)), ("BroadPhase", lambda: world.insert_many(boxes))):
        refusals.clear()
        threads = [threading.Thread(target=insist, args=(call,)) for _ in range(3)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert refusals and all(f"this {name} is in use" in refusal for refusal in refusals)
    # And afterwards as if nothing had been.
    assert finder.count(boxes) == sap.count_pairs(boxes)
    assert len(world) % len(boxes) == 0 and len(world) > 0


@pytest.mark.parametrize("dtype", FLOATS)
@pytest.mark.parametrize("threads", [1, 2])
def test_writing_to_the_boxes_during_a_search_gives_some_pairs_or_an_error(dtype: Any, threads: int) -> None:
    boxes = random_boxes(5000, 3, dtype)
    others = [boxes.copy(), boxes * 1000, boxes * 0, np.full_like(boxes, np.nan), boxes[::-1].copy()]
    stop = threading.Event()

    def write() -> None:
        while not stop.is_set():
            for other in others:
                np.copyto(boxes, other)

    writer = threading.Thread(target=write)
    writer.start()
    finder = sap.PairFinder(3, dtype, threads=threads)
    seen: set[int] = set()
    try:
        for turn in range(10_000):
            if turn >= 200 and len(seen) > 2:
                break
            try:
                found = finder.find(boxes) if len(seen) % 2 else finder.find_between(boxes, boxes[:1000])
                assert found.size == 0 or found.max() < len(boxes)
                seen.add(len(found))
            except (sap.InvalidBoxError, MemoryError) as error:
                seen.add(-hash(type(error)))
    finally:
        stop.set()
        writer.join()
    assert len(seen) > 2
    np.copyto(boxes, others[0])
    assert np.array_equal(finder.find(boxes), sap.find_pairs(boxes))


class Cancelled(Exception):
    pass


# Each search takes ten seconds at least, and some find more pairs than fit into memory: beams across each other many
# tests, boxes in a heap 2,000 billion pairs. So they end in time only if the signal ends them.
LONG_SEARCH = """
import signal, sys
import numpy as np
import sweep_and_prune as sap

class Cancelled(Exception):
    pass

def handler(number, frame):
    raise Cancelled

random = np.random.default_rng(1)
centers, half = random.random((2_000_000, 3)), np.full((2_000_000, 3), 1e-3)
half[np.arange(2_000_000), np.arange(2_000_000) % 3] = 1
beams = np.hstack([centers - half, centers + half]).astype(np.float32)
many = np.hstack([np.zeros((2_000_000, 3)), random.random((2_000_000, 3)) + 1]).astype(np.float32)
threads = int(sys.argv[1])
finder = sap.PairFinder(3, np.float32, threads=threads)
calls = [
    lambda: finder.count(beams),
    lambda: finder.count_between(beams[:1_000_000], beams),
    lambda: finder.count(many),
    lambda: finder.count_between(many[::5], many),
    lambda: finder.find(many[:100_000]),
    lambda: sap.find_pairs(beams[:1_000_000], threads=threads),
    lambda: sap.count_pairs(many, threads=threads),
]
signal.signal(signal.SIGALRM, handler)
for call in calls:
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.5)
        call()
        print("it ended by itself")
    except Cancelled:
        print("cancelled")
print(finder.count(many[:100]))
"""


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no such timers here")
@pytest.mark.parametrize("threads", ["1", "2"])
def test_a_signal_ends_a_long_search(threads: str) -> None:
    done = subprocess.run([sys.executable, "-c", LONG_SEARCH, threads], capture_output=True, text=True, timeout=1200)
    assert (done.stdout.split("\n"), done.stderr) == (["cancelled"] * 7 + ["4950", ""], "")


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no such timers here")
def test_a_signal_ends_a_stream() -> None:
    def handler(number: int, frame: Any) -> None:
        raise Cancelled

    chunks: list[int] = []
    before = signal.signal(signal.SIGALRM, handler)
    try:
        with pytest.raises(Cancelled):
            signal.setitimer(signal.ITIMER_REAL, 0.05)
            sap.for_each_chunk(np.zeros((100_000, 2)), lambda chunk: chunks.append(1))
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert len(chunks) < 5_000_000_000 // 65_536


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no such timers here")
def test_a_signal_ends_a_stream_before_it_has_found_a_chunk() -> None:
    def handler(number: int, frame: Any) -> None:
        raise Cancelled

    low = np.arange(3_000_000, dtype=np.float32)[::-1]
    boxes = np.stack([low, low, low + 0.25, low + 0.25], axis=1)
    boxes[:2] = 0  # the only pair
    chunks: list[Any] = []
    before = signal.signal(signal.SIGALRM, handler)
    try:
        with pytest.raises(Cancelled):
            signal.setitimer(signal.ITIMER_REAL, 0.02)
            sap.for_each_chunk(boxes, chunks.append)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert not chunks


def count_in_child(results: Any, boxes: Any) -> None:
    results.put(sap.count_pairs(boxes, threads=2))


@pytest.mark.skipif(sys.platform == "win32", reason="processes are not forked there")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own() -> None:
    boxes = random_boxes(140_000, 3, np.float32)
    wanted = sap.count_pairs(boxes, threads=2)
    fork = multiprocessing.get_context("fork")
    results = fork.Queue()
    child = fork.Process(target=count_in_child, args=(results, boxes))
    child.start()
    assert results.get(timeout=600) == wanted
    child.join(timeout=600)
    assert child.exitcode == 0 and child.pid != os.getpid()
    assert sap.count_pairs(boxes, threads=2) == wanted


OF_EACH_SIZE = """
import os, sys
import numpy as np
import sweep_and_prune as sap

def threads():
    return len(os.listdir("/proc/self/task"))

low = np.random.default_rng(1).random((int(sys.argv[1]), 2))
boxes = np.hstack([low, low + float(sys.argv[2])])
before = threads()
finder = sap.PairFinder(2, threads=2)
for search in (finder.find, finder.count, lambda boxes: sap.find_pairs(boxes, threads=2)):
    search(boxes)
print(threads() - before)
"""


@pytest.mark.skipif(not os.path.exists("/proc/self/task"), reason="it does not tell how many threads there are")
@pytest.mark.parametrize(
    ("count", "size", "is_on_threads"),
    [(20_000, 1e-3, False), (5000, 1e-3, False), (5000, 0.2, True), (140_000, 1e-6, True), (3000, 1.0, False)],
)
def test_threads_search_what_takes_long_enough(count: int, size: float, is_on_threads: bool) -> None:
    """A short search is not worth waking a thread: then none is ever started."""
    if processors() < 2:
        pytest.skip("threads need processors")
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    command = [sys.executable, "-c", OF_EACH_SIZE, str(count), str(size)]
    done = subprocess.run(command, capture_output=True, text=True, env=environment, check=True)
    assert (int(done.stdout) > 0) == is_on_threads, done.stdout
