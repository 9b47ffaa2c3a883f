"""A program of tests: `sap` in processes of which each is sent a signal at another point, counted in instructions.

    signal_points.py SIGNAL STRIDE SECOND PLACE...

A point is an instruction of Python in a file whose path has one of these texts, each one after a stride, until `sap`
ends before the point is reached. With SECOND, the signal is sent once more after this many instructions.
Prints the number of points, and where something was wrong.
"""

from __future__ import annotations

import functools
import os
import signal
import sys
from pathlib import Path
from typing import Any

import numpy as np

import sweep_and_prune._command as command
from sweep_and_prune import _signals

NAMES = ["a.npy", "p.csv"]
PLACES = sys.argv[4:]


@functools.cache
def is_place(path: str) -> bool:
    return any(place in path for place in PLACES)


def is_taken(number: int) -> bool:
    """Whether the program handles a signal. Before, Python ends as it always does.

    (It asks for this signal, since others may be ignored: under nohup, SIGHUP is.)
    """
    return signal.getsignal(number) is _signals._end


def run(number: int, points: list[int]) -> int:
    """The exit status of `sap` in this process, which is sent a signal at some points; 0 without a signal."""
    passed = 0

    def trace(frame: Any, event: str, _: Any) -> Any:
        nonlocal passed
        if not is_place(frame.f_code.co_filename):
            return None
        frame.f_trace_opcodes = True
        if event == "opcode" and is_taken(number):
            passed += 1
            if passed in points:
                os.kill(os.getpid(), number)
        return trace

    sys.argv = ["sap", "pairs", "a.npy", "-o", "p.csv", "--quiet"]
    sys.settrace(trace)
    try:
        return command.program()
    finally:
        sys.settrace(None)


def main() -> None:
    number = getattr(signal, sys.argv[1])
    stride, second = map(int, sys.argv[2:4])
    signal.signal(number, signal.default_int_handler if number == signal.SIGINT else signal.SIG_DFL)
    np.save("a.npy", [[0.0, 1.0], [1.0, 2.0]])
    command.main(["pairs", "a.npy", "-o", "p.csv"])  # so that everything is imported
    content = Path("p.csv").read_bytes()
    os.remove("p.csv")
    wrong, done, point = [], 0, 1 + second
    while True:
        child = os.fork()
        if child == 0:
            os.dup2(os.open(os.devnull, os.O_WRONLY), 2)
            status = 1
            try:
                status = run(number, [point - second, point])
            finally:
                os._exit(status)
        _, ended = os.waitpid(child, 0)
        status = os.waitstatus_to_exitcode(ended)
        left = sorted(os.listdir())
        is_there = left == NAMES and Path("p.csv").read_bytes() == content
        if status == 0 and is_there:
            break
        if status != 128 + number or not (left == NAMES[:1] or is_there):
            wrong.append(f"at {point}: status {status}, files {left}")
        for name in set(left) - {"a.npy"}:
            os.remove(name)
        done, point = done + 1, point + stride
    print(done, *wrong, sep="\n")


main()
