"""What the benchmarks of the Python package share: the machine, times in turn, peak memory, files of results."""

from __future__ import annotations

import json
import os
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from datetime import date
from importlib import metadata
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent
RESULTS = FOLDER / "results"
Call = Callable[[], Any]


def machine() -> dict[str, Any]:
    """Where it ran; `load` is the load average when the run began: above 0.5, other programs were running."""
    cpu = platform.processor()
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        cpu = next((line.split(":")[1].strip() for line in lines if line.startswith("model name")), cpu)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    system = f"{platform.system()} {platform.machine()}"
    return {"cpu": cpu, "cores": os.cpu_count(), "memory_bytes": memory, "system": system, "load": os.getloadavg()[0]}


def versions(names: list[str]) -> dict[str, str]:
    """The versions of those packages that are installed."""
    found = {"python": platform.python_version()}
    for name in names:
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            pass
    return found


def revision() -> str:
    """The commit that is measured, with `+` if there are changes."""
    done = subprocess.run(["git", "describe", "--always", "--dirty=+"], cwd=FOLDER, capture_output=True, text=True)
    return done.stdout.strip()


def in_turn(calls: dict[str, Call], least_seconds: float, least_rounds: int = 3) -> dict[str, list[float]]:
    """Seconds of each call in each round. A round runs each call once; a short one twice, since the first time it finds
    in the caches what the call before left there."""
    times: dict[str, list[float]] = {name: [] for name in calls}
    began = time.perf_counter()
    while min(map(len, times.values())) < least_rounds or time.perf_counter() - began < least_seconds:
        for name, call in calls.items():
            if times[name] and times[name][-1] < 0.05:
                call()
            start = time.perf_counter()
            call()
            times[name].append(time.perf_counter() - start)
    return times


def peak_bytes(call: Call) -> int:
    """The most memory that a call takes beyond what there was, measured in a process of its own (Linux)."""
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            Path("/proc/self/clear_refs").write_text("5")  # the peak begins here
            before = _status("VmRSS")
            call()
            os.write(writer, str(_status("VmHWM") - before).encode())
        finally:
            os._exit(0)
    os.close(writer)
    with os.fdopen(reader) as pipe:
        said = pipe.read()
    os.waitpid(child, 0)
    return int(said or 0)


def _status(field: str) -> int:
    lines = Path("/proc/self/status").read_text().splitlines()
    return next(int(line.split()[1]) * 1024 for line in lines if line.startswith(field))


def summary(times: list[float], own: list[float], peak: int | None) -> dict[str, Any]:
    """The fields of one library's result; `ratio` is to sweep-and-prune in the same round."""
    return {
        "median_seconds": statistics.median(times),
        "min_seconds": min(times),
        "ratio": statistics.median(time / of_own for time, of_own in zip(times, own)),
        "peak_bytes": peak,
    }


def write_results(kind: str, content: dict[str, Any]) -> Path:
    """Writes what was measured so far to the file of this kind, machine and day."""
    RESULTS.mkdir(exist_ok=True)
    name = "-".join(content["machine"]["cpu"].lower().replace("(r)", "").split()[:3])
    path = RESULTS / f"{kind}-{name}-{date.today().isoformat()}.json"
    path.write_text(json.dumps(content, indent=1) + "\n")
    return path


def note(text: str) -> None:
    """Says how far it is."""
    print(text, file=sys.stderr, flush=True)
