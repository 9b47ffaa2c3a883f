"""Starts the command line `sap`, so that Ctrl-C ends it without a traceback while its modules are loaded, too.

(A module of `sweep_and_prune` could not: Python loads all of the package first.)
"""

from __future__ import annotations

import os
import signal
import sys


def program() -> int:
    """Runs the command line as a program, and returns its exit status."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # it may be ignored
        signal.signal(signal.SIGINT, _end)
    from sweep_and_prune._command import program

    return program()


def _end(_number: int, _frame: object) -> None:
    # An exception would pass through modules that are half loaded, and some make another one of it.
    if sys.stderr is not None:
        os.write(2, b"sap: cancelled\n")
    os._exit(130)
