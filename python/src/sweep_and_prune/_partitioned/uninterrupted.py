"""What each worker of Dask loads when it starts: Ctrl-C, which a terminal sends to all processes, is not for workers.

The process that started them ends them. Without this, each one would print where it was interrupted.
"""

import signal
from typing import Any


def dask_setup(_: Any) -> None:
    """Called by Dask."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
