"""A line on a terminal that shows how far a search is."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable


class ProgressLine:
    """Shows the share that is done and the time that is left on standard error, once half a second has passed."""

    def __init__(self, what: str, also: Callable[[float], object] | None, is_wanted: bool) -> None:
        """`also` is called, too."""
        self._what, self._also, self._is_wanted = what, also, is_wanted
        self._began, self._is_shown = time.monotonic(), False

    def __call__(self, done: float) -> None:
        """Shows the share that is done, from 0 to 1."""
        if self._also is not None:
            self._also(done)
        passed = time.monotonic() - self._began
        if not self._is_wanted or (passed < 0.5 and not self._is_shown):
            return
        left = f", {passed / done * (1 - done):.0f} s left" if 0 < done < 1 else ""
        self._show(f"{self._what}: {100 * done:.0f} %{left}" if done < 1 else "")

    def _show(self, line: str) -> None:
        self._is_shown = bool(line)
        sys.stderr.write(f"\r{line:<60}" + ("" if line else "\r"))
        sys.stderr.flush()

    def __enter__(self) -> ProgressLine:
        """Begins."""
        return self

    def __exit__(self, *_: object) -> None:
        """Removes the line, also after an error."""
        if self._is_shown:
            self._show("")
