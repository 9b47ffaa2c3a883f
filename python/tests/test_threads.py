"""Threads of Python beside a search, signals in the midst of one, processes forked from one."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from oracle import FLOATS, random_boxes

import sweep_and_prune as sap


@pytest.mark.parametrize("threads", [1, 2])
def test_others_go_on_while_a_search_runs(threads: int) -> None:
    boxes = random_boxes(1_000_000, 3, np.float32)
    finder = sap.PairFinder(3, np.float32, threads=threads)
    finder.count(boxes)
    searches: list[float] = []

    def search() -> None:
        for _ in range(5):
            began = time.monotonic()
            finder.count(boxes)
            searches.append(time.monotonic() - began)

    thread = threading.Thread(target=search)
    thread.start()
    steps, last = [], time.monotonic()
    while thread.is_alive():
        time.sleep(0.001)
        now = time.monotonic()
        steps.append(now - last)
        last = now
    thread.join()
    # If no other thread could run, each step would take as long as a search.
    assert np.median(steps) < min(searches) / 2


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
    end = time.monotonic() + 2
    try:
        while time.monotonic() < end:
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


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="there are no such timers here")
@pytest.mark.parametrize("threads", [1, 2])
def test_a_signal_ends_a_long_search(threads: int) -> None:
    # Each takes many times as long as it takes to see a signal, 20 ms: beams across each other many
    # tests and not so many pairs, boxes in a heap 800 million pairs, too many to store.
    random = np.random.default_rng(1)
    centers, half = random.random((120_000, 3)), np.full((120_000, 3), 1e-3)
    np.fill_diagonal(half, 1, wrap=True)
    beams = np.hstack([centers - half, centers + half]).astype(np.float32)
    many = np.hstack([np.zeros((40_000, 3)), random.random((40_000, 3)) + 1]).astype(np.float32)
    finder = sap.PairFinder(3, np.float32, threads=threads)
    calls: list[Callable[[], Any]] = [
        lambda: finder.find(beams),
        lambda: finder.find_between(beams[:60_000], beams),
        lambda: finder.count(many),
        lambda: finder.count_between(many[::5], many),
        lambda: sap.find_pairs(beams, threads=threads),
        lambda: sap.count_pairs(many, threads=threads),
    ]

    def handler(number: int, frame: Any) -> None:
        raise Cancelled

    before = signal.signal(signal.SIGALRM, handler)

    def cost(call: Callable[[], Any]) -> float:
        began = time.process_time()
        assert call() is not None
        return time.process_time() - began

    def cost_until_the_signal(call: Callable[[], Any]) -> float:
        began = time.process_time()
        with pytest.raises(Cancelled):
            signal.setitimer(signal.ITIMER_REAL, 0.005)
            call()
        return time.process_time() - began

    try:
        for number, call in enumerate(calls):
            whole = min(cost(call), cost(call))
            # A busy machine may keep one search from seeing its signal in time; not ten.
            costs = [cost_until_the_signal(call) for _ in range(10)]
            assert min(costs) < 0.7 * whole, (number, whole, costs)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)
    assert finder.count(many[:100]) == 4950


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


def count_in_child(results: Any, boxes: Any) -> None:
    results.put(sap.count_pairs(boxes, threads=2))


@pytest.mark.skipif(sys.platform == "win32", reason="processes are not forked there")
@pytest.mark.filterwarnings("ignore:.*fork:DeprecationWarning")
def test_a_forked_process_has_threads_of_its_own() -> None:
    boxes = random_boxes(20_000, 3, np.float32)
    wanted = sap.count_pairs(boxes, threads=2)
    fork = multiprocessing.get_context("fork")
    results = fork.Queue()
    child = fork.Process(target=count_in_child, args=(results, boxes))
    child.start()
    assert results.get(timeout=60) == wanted
    child.join(timeout=60)
    assert child.exitcode == 0 and child.pid != os.getpid()
    assert sap.count_pairs(boxes, threads=2) == wanted
