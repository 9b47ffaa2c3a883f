"""Ends the command line when a signal asks for it, so that no file is left that is not complete.

Python raises an exception between any two of its instructions, also before `finally` has begun to clean up. So the
names of unfinished files are known before the files are made, and `main` removes what is left of them at its end.
(No program sees SIGKILL: what it leaves, a later one removes.)
"""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from types import FrameType

_SIGNALS = ("SIGINT", "SIGTERM", "SIGHUP")  # Windows has no SIGHUP

_unfinished: list[str] = []
_came: int | None = None
_is_at_end = False
_is_held_back = False


def remove_at_end(path: str) -> None:
    """Notes a file that is about to be made, and that no one may see after the end of the program."""
    _unfinished.append(path)


def remove_unfinished() -> None:
    """Removes the files that are noted."""
    for path in tuple(_unfinished):
        with suppress(OSError):
            os.remove(path)
    _unfinished.clear()


def end_by_signals() -> None:
    """From now on, Ctrl-C, SIGTERM and SIGHUP raise `KeyboardInterrupt`. The second signal ends the program at once."""
    for name in _SIGNALS:
        number = getattr(signal, name, None)
        # Those that are ignored, as by nohup, stay so.
        if number is not None and signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _end)


def end_at_once() -> None:
    """From now on, the first signal ends the program at once, too: an exception would come too late."""
    global _is_at_end
    _is_at_end = True


@contextmanager
def held_back() -> Iterator[None]:
    """What the first signal raises is raised after this: some libraries swallow it while they are imported."""
    global _is_held_back
    _is_held_back = True
    try:
        yield
    finally:
        _is_held_back = False
        if _came is not None:
            raise KeyboardInterrupt


def signal_status() -> int:
    """The exit status after the signal that came, as 130 for Ctrl-C; 0 if none did."""
    return 0 if _came is None else 128 + _came


def _end(number: int, _frame: FrameType | None) -> None:
    global _came
    is_first, _came = _came is None, number
    if is_first and _is_held_back:
        return
    if is_first and not _is_at_end:
        raise KeyboardInterrupt
    remove_unfinished()
    os._exit(signal_status())
