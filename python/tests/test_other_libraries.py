"""Each row of the guide's tables for people who come from other libraries: both calls return the same."""

from __future__ import annotations

import csv
import io
import re
import shutil
import subprocess
from math import inf
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import sweep_and_prune as sap
from sweep_and_prune._command import main

PAGE = Path(__file__).parents[2] / "docs/guide/from-other-libraries.md"
ROWS = re.findall(r"^\| `([^`]+)` \| `([^`]+)` \| ?(.*?) ?\|$", PAGE.read_text(encoding="utf-8"), re.MULTILINE)
CALLS = [row[:2] for row in ROWS if not row[0].startswith("bedtools")]
COMMANDS = [row for row in ROWS if row[0].startswith("bedtools")]


def names() -> dict[str, Any]:
    """The tables and arrays of the page, and the libraries that are installed."""
    random = np.random.default_rng(4)
    found: dict[str, Any] = {"sap": sap, "np": np, "inf": inf, "len": len, "list": list, "enumerate": enumerate}
    for name in ("bioframe", "geopandas", "pandas", "scipy.spatial", "shapely", "rtree.index"):
        try:
            pytest.importorskip(name)
            top = name.split(".")[0]
            found[top] = __import__(top)
        except pytest.skip.Exception:
            pass
    found["points"], found["places"] = random.random((150, 2)), random.random((40, 2))
    for name, count in (("boxes", 120), ("others", 80)):
        corner = random.random((count, 2))
        found[name] = np.hstack([corner, corner + random.random((count, 2)) / 9])
    if "rtree" in found:
        found["index"] = found["rtree"].index.Index((row, box, None) for row, box in enumerate(found["others"]))
    if "pandas" in found:
        for name, count in (("a", 90), ("b", 60)):
            start = random.integers(0, 1500, count)
            columns = {"chrom": random.choice(["chr1", "chr2"], count), "start": start, "end": start + count // 8}
            found[name] = found["pandas"].DataFrame(columns)
    if "geopandas" in found:
        for name, count, size in (("p", 50, 0.03), ("q", 9, 0.15)):
            shapes = found["shapely"].buffer(found["shapely"].points(random.random((count, 2))), size)
            columns = {"kind": random.choice(["x", "y"], count)}
            found[name] = found["geopandas"].GeoDataFrame(columns, geometry=shapes)
    return found


def rows_of(found: Any) -> list[str]:
    """What a call returned, in no order."""
    if hasattr(found, "total_bounds"):
        return sorted(found.sort_index(axis=1).reset_index().apply(lambda row: "|".join(map(str, row)), axis=1))
    if isinstance(found, set):
        found = sorted(found)
    array = np.asarray(found)
    rows = array.reshape(-1, 1) if array.ndim < 2 else array
    return sorted(",".join(f"{float(one):.9g}" for one in row) for row in rows.tolist())


@pytest.mark.filterwarnings("ignore")  # those of the other libraries
@pytest.mark.parametrize(("other", "call"), CALLS, ids=[other for other, _ in CALLS])
def test_a_call_returns_the_same(other: str, call: str) -> None:
    known = names()
    library = "rtree" if "index." in other and "isin" not in other else re.sub(r"\W.*", "", other)
    library = {"p": "geopandas"}.get(library, library)
    if library not in known:
        pytest.skip(f"{library} is not installed")
    wanted, found = rows_of(eval(other, known)), rows_of(eval(call, known))
    assert len(wanted) > 0 and found == wanted


def test_the_tables_have_rows_for_each_library() -> None:
    assert len(CALLS) == 17 and len(COMMANDS) == 16
    page = PAGE.read_text(encoding="utf-8")
    assert len(re.findall(r"^\| `", page, re.MULTILINE)) == len(ROWS)


@pytest.mark.parametrize(("other", "command", "differs"), COMMANDS, ids=[other for other, _, _ in COMMANDS])
def test_a_command_writes_what_bedtools_writes(
    other: str,
    command: str,
    differs: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """What each writes is also compared with its definition, in `test_answers.py`: not everyone has bedtools."""
    monkeypatch.chdir(tmp_path)
    random = np.random.default_rng(8)
    for name in "ab":
        starts = np.sort(random.integers(0, 300, 40)).tolist()
        rows = [
            f"chr1\t{start}\t{start + int(random.integers(1, 20))}\t{name}{at}\t0\t{random.choice(['+', '-'])}\n"
            for at, start in enumerate(starts)
        ]
        Path(f"{name}.bed").write_text("".join(rows))
    program, *arguments = command.split()
    assert program == "sap" and main(arguments) == 0
    names, *found = csv.reader(io.StringIO(capsys.readouterr().out))
    assert found and all(len(row) == len(names) for row in found)
    if not differs and shutil.which("bedtools"):
        done = subprocess.run(other.split(), capture_output=True, text=True, check=True)
        assert sorted(found) == sorted(line.split("\t") for line in done.stdout.splitlines())
