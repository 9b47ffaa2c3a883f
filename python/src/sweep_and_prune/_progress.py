"""A bar on a terminal that shows how far a search is."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress


class ProgressBar:
    """Shows the share that is done and the time that is left on standard error, once half a second has passed."""

    def __init__(self, what: str, also: Callable[[float], object] | None, is_wanted: bool) -> None:
        """`also` is called, too."""
        self._what, self._also, self._is_wanted = what, also, is_wanted
        self._began = time.monotonic()
        self._bar: Progress | None = None

    def __call__(self, done: float) -> None:
        """Shows the share that is done, from 0 to 1."""
        if self._also is not None:
            self._also(done)
        if done >= 1:
            self.close()
        elif self._bar is not None:
            self._bar.update(self._bar.task_ids[0], completed=done)
        elif self._is_wanted and time.monotonic() - self._began >= 0.5:
            self._bar = _started(self._what, done)

    def close(self) -> None:
        """Removes the bar."""
        if self._bar is not None:
            self._bar.stop()
            self._bar = None

    def __enter__(self) -> ProgressBar:
        """Begins."""
        return self

    def __exit__(self, *_: object) -> None:
        """Removes the bar, also after an error."""
        self.close()


def _started(what: str, done: float) -> Progress:
    # Here, since a program that shows no bar need not load it.
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TaskProgressColumn(),
        TimeRemainingColumn(),
        TextColumn("left"),
    )
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    bar.update(bar.add_task(what, total=1), completed=done)
    bar.start()
    return bar
