"""Runs tasks: in this process, or on the workers of Dask."""

from __future__ import annotations

import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import Any, NamedTuple

from .._errors import SweepAndPruneError
from .._native import processors
from . import uninterrupted
from .dataset import DatasetError
from .tasks import guarded

_WORKER_MEMORY = 190_000_000
"""What a worker takes before it has work: Python, Dask, NumPy and pyarrow."""
_TASK_MEMORY = 120_000_000
"""What a task takes besides its boxes: pairs that are written, and buffers."""
_MOST_DEATHS = 10
_LOST = (
    "the workers of Dask were closed, or died again and again while they started, maybe for want of memory: pass a "
    "larger memory_limit or fewer workers, and call again: the run continues where it stopped"
)


class Workers(NamedTuple):
    """What runs tasks."""

    client: Any
    """A client of Dask; None for this process."""
    number: int
    """How many tasks run at the same time."""
    memory: int
    """The memory for the boxes of one task, in bytes."""

    def run(self, task: Callable[..., Any], arguments: Sequence[tuple[Any, ...]], done: Callable[[Any], None]) -> None:
        """Calls a task once for each tuple of arguments; `done` takes the results, in any order.

        A task whose worker dies is repeated. After an error, the rest is cancelled; among errors of the data, that of
        the first tuple is raised, so that the message does not depend on timing.
        """
        if self.client is None:
            for one in arguments:
                computed = [value.compute(scheduler="sync") if _is_delayed(value) else value for value in one]
                result = guarded(task, *computed)
                if isinstance(result, Exception):
                    raise result
                done(result)
            return
        self._run_on_client(task, arguments, done)

    def _run_on_client(self, task: Any, arguments: Sequence[tuple[Any, ...]], done: Callable[[Any], None]) -> None:
        from distributed import KilledWorker, as_completed

        futures = {self._submitted(task, one, number): number for number, one in enumerate(arguments)}
        failed: tuple[int, Exception] | None = None
        try:
            waiting = as_completed(list(futures), loop=self.client.loop, raise_errors=False)
            for future in waiting:
                number = futures.pop(future)
                if failed is not None and number > failed[0]:
                    continue
                try:
                    result = future.result() if not future.cancelled() else DatasetError(_LOST)
                except KilledWorker:
                    result = DatasetError(
                        f"a task ({task.__name__}) failed {_MOST_DEATHS} times because its worker died, maybe for want "
                        "of memory: pass a larger memory_limit or fewer workers, and call again: the run continues "
                        "where it stopped"
                    )
                if isinstance(result, SweepAndPruneError):
                    failed = number, result
                    self._cancel([other for other, of_other in futures.items() if of_other > number])
                elif failed is None:
                    done(result)
            if failed is not None:
                raise failed[1]
        finally:
            self._cancel(list(futures), force=True)

    def _cancel(self, futures: list[Any], **options: bool) -> None:
        if futures and self.client.status == "running":
            self.client.cancel(futures, **options)

    def _submitted(self, task: Any, arguments: tuple[Any, ...], number: int) -> Any:
        if any(map(_is_delayed, arguments)):
            from dask import delayed

            return self.client.compute(delayed(guarded, pure=False)(task, *arguments), retries=2, priority=-number)
        return self.client.submit(guarded, task, *arguments, pure=False, retries=2, priority=-number)


def _is_delayed(value: object) -> bool:
    return hasattr(value, "__dask_graph__")


def active_client() -> Any:
    """The client of Dask that the user has started, or None."""
    if "distributed" not in sys.modules:
        return None
    from distributed import default_client

    try:
        return default_client()
    except ValueError:
        return None


def memory_of(limit: int | str | float | None) -> int:
    """A limit such as `"4GB"` in bytes; by default, half of what this machine has."""
    if limit is None:
        try:
            return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2
        except (AttributeError, ValueError, OSError):
            return 4 * 10**9
    if isinstance(limit, str):
        from dask.utils import parse_bytes

        try:
            return int(parse_bytes(limit))
        except ValueError:
            raise ValueError(f'memory_limit must be a size such as "4GB", not {limit!r}') from None
    return int(limit)


@contextmanager
def started(limit: int | str | float | None, number: int | None) -> Iterator[Workers]:
    """The workers of the active client; or else local ones, which together with this process stay below a limit.

    Args:
        limit: bytes of memory, or text such as `"4GB"`.
        number: how many workers; 0 for none but this process, None for as many as pay.
    """
    if number is not None and not (isinstance(number, int) and number >= 0):
        raise ValueError(f"workers must be a whole number of 0 or more, not {number!r}")
    client = active_client()
    if client is not None and number != 0:
        yield _of_client(client, limit)
        return
    memory, own = memory_of(limit), _resident()
    if number is None:
        number = processors()
        # Each worker costs memory, so that a small limit has fewer.
        while number > 1 and (memory - own) // number < _WORKER_MEMORY + 3 * _TASK_MEMORY:
            number -= 1
    if number == 0:
        yield Workers(None, 1, _for_boxes(memory - own, limit))
        return
    per_worker = _for_boxes((memory - own - 50_000_000) // number - _WORKER_MEMORY, limit)
    if getattr(multiprocessing.current_process(), "_inheriting", False):
        raise RuntimeError(
            "find_pairs starts processes, which run your script from its beginning: put the call below if __name__ == "
            '"__main__", or pass workers=0'
        )
    import dask
    from distributed import Client, LocalCluster

    settings = {
        "distributed.scheduler.allowed-failures": _MOST_DEATHS,
        "distributed.scheduler.worker-saturation": 1.0,
        "distributed.worker.memory.target": False,
        "distributed.worker.memory.spill": False,
        "distributed.worker.memory.pause": False,
        "distributed.worker.memory.terminate": False,
        "distributed.comm.timeouts.connect": "60s",
    }
    with dask.config.set(settings):
        with (
            # Without workers at first: Dask itself fails if one of them dies while it starts.
            LocalCluster(
                n_workers=0,
                threads_per_worker=1,
                processes=True,
                memory_limit=0,
                dashboard_address=":0",
                silence_logs=50,
                preload=[uninterrupted.__name__],
            ) as cluster,
            Client(cluster, set_as_default=False) as client,
            _kept_alive(cluster, client, number),
        ):
            yield Workers(client, number, per_worker)


@contextmanager
def _kept_alive(cluster: Any, client: Any, number: int) -> Iterator[None]:
    """Starts workers, and new ones for those that died while they started, which Dask does not replace."""
    from distributed import Status

    is_ended = Event()
    deaths = 0

    async def replace() -> None:  # on the thread that has the workers
        nonlocal deaths
        for name, nanny in list(cluster.workers.items()):
            if nanny.status in (Status.closed, Status.failed):
                del cluster.workers[name]
                deaths += 1
        if len(cluster.workers) < number and cluster.status == Status.running:
            while len(cluster.worker_spec) < number:
                cluster.worker_spec.update(cluster.new_worker_spec())
            # One that dies while it starts is an error here. It is counted at the next call.
            with suppress(Exception):
                await cluster._correct_state()  # `await cluster` would print the error

    def watch() -> None:
        cluster.loop.add_callback(replace)
        while not is_ended.wait(1):
            cluster.loop.add_callback(replace)
            if deaths > _MOST_DEATHS * number:
                client.close()  # so the tasks are lost, and the run ends
                return

    watcher = Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
    finally:
        is_ended.set()
        watcher.join()


def _of_client(client: Any, limit: int | str | float | None) -> Workers:
    def read(dask_scheduler: Any) -> list[tuple[int, int]]:
        return [(worker.nthreads, worker.memory_limit) for worker in dask_scheduler.workers.values()]

    # Not `scheduler_info`: it returns what the client's thread has stored, which lists no workers if that thread
    # renewed it just before.
    workers = client.run_on_scheduler(read)
    threads = sum(nthreads for nthreads, _ in workers)
    if threads == 0:
        raise DatasetError("the client of Dask has no workers: start some, or close the client")
    each = min((memory or memory_of(None)) // nthreads for nthreads, memory in workers)
    if limit is not None:
        each = min(each, memory_of(limit) // threads)
    return Workers(client, threads, _for_boxes(each - _WORKER_MEMORY, limit))


def _for_boxes(memory: int, limit: Any) -> int:
    left = int(memory) - _TASK_MEMORY
    if left < 20_000_000:
        raise ValueError(
            f"memory_limit is {limit}; Python, its libraries and one task with each worker take more than that: pass a "
            "larger limit or fewer workers"
        )
    return left


def _resident() -> int:
    """The memory that this process has now."""
    import psutil

    return int(psutil.Process().memory_info().rss)
