"""The process ends without a crash while daemon threads search."""

from __future__ import annotations

import subprocess
import sys

import pytest

PROGRAM = """
import sys, threading, time
import numpy as np
import sweep_and_prune as sap

low = np.random.default_rng(1).random((1500, 3))
boxes = np.hstack([low, low + 0.1]).astype(np.float32)
started = threading.Semaphore(0)

def work():
    world = sap.BroadPhase(3, np.float32)
    ids = world.insert_many(boxes)
    finder = sap.PairFinder(3, np.float32, threads=2)
    invalid = np.full((1500, 6), np.nan)
    started.release()
    while True:
        if sys.argv[1] == "callback":
            sap.for_each_chunk(boxes, lambda chunk: None, size=3)
        elif sys.argv[1] == "iterate":
            for _ in sap.iter_chunks(boxes, size=3):
                pass
        elif sys.argv[1] == "world":
            world.set_many(ids, boxes)
            world.update()
        elif sys.argv[1] == "error":
            try:
                finder.find(invalid)
            except sap.InvalidBoxError:
                pass
        else:
            finder.find(boxes)

for _ in range(3):
    threading.Thread(target=work, daemon=True).start()
for _ in range(3):
    started.acquire()
time.sleep(0.05)
"""


@pytest.mark.parametrize("work", ["callback", "iterate", "find", "world", "error"])
def test_the_interpreter_exits_while_daemon_threads_search(work: str) -> None:
    for _ in range(6 if work == "callback" else 2):
        done = subprocess.run([sys.executable, "-c", PROGRAM, work], capture_output=True, text=True, timeout=600)
        assert (done.returncode, done.stderr) == (0, "")


AT_EXIT = """
import atexit, threading, time
import numpy as np

def after_the_package():
    time.sleep(0.1)
    before = calls
    time.sleep(0.2)
    print(calls - before, len(sap.find_pairs([[0, 1], [1, 2]])))
    for left in (chunks, sap.iter_chunks([[0, 1], [1, 2]])):  # nothing goes on in other threads
        try:
            next(left)
        except RuntimeError as error:
            print(error)
    sap.for_each_chunk([[0, 1], [1, 2]], print)

atexit.register(after_the_package)  # the last one that is registered is called first
import sweep_and_prune as sap

calls = 0
boxes = np.zeros((2000, 2))
chunks = sap.iter_chunks(boxes, size=3)  # its thread waits for ever
next(chunks)

def work():
    global calls
    finder, small = sap.PairFinder(1), np.zeros((2, 2))
    while True:
        finder.find(small)
        calls += 1

threading.Thread(target=work, daemon=True).start()
while calls < 100:
    time.sleep(0.001)
"""


def test_when_the_interpreter_exits_other_threads_stop_and_its_own_goes_on() -> None:
    done = subprocess.run([sys.executable, "-c", AT_EXIT], capture_output=True, text=True, timeout=600)
    refused = "no other thread can search while the interpreter exits: use for_each_chunk\n"
    assert (done.returncode, done.stdout, done.stderr) == (0, f"0 1\n{2 * refused}[[0 1]]\n", "")
