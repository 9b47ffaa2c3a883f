"""All pairs of boxes from Parquet to Parquet within a limit of memory: `python disk.py`, in an environment with
requirements.txt and the package. Writes results/disk-...json after each run; `python report.py` makes tables of them.

Each library runs in a process of its own, with its limit of memory set as its documentation says. The resident set of
the process and its children is measured: a library that takes more than half again its limit is stopped, and so is one
that takes too long. Those that take geometries get them in a GeoParquet file, which is written beforehand. The number
of pairs has to be that of sweep-and-prune in memory.
"""

from __future__ import annotations

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
from common import machine, note, revision, versions, write_results

OWN = "sweep-and-prune"
LIMIT = 4_000_000_000
MOST = 10_000_000
"""The most boxes for which other libraries are tried, and for which everything fits in memory."""
BLOCK = 2_000_000
MANIFEST = "_manifest.json"
NAMES = ("minx", "miny", "maxx", "maxy")
PACKAGES = "numpy pyarrow dask distributed dask-geopandas geopandas duckdb sedonadb sweep-and-prune".split()


def write_boxes(path: Path, count: int, with_geometries: bool) -> None:
    """Squares of which each overlaps about four others, with an id; block by block, so that any number fits."""
    import pyarrow
    import pyarrow.parquet

    random = np.random.default_rng(1)
    schema = pyarrow.schema([("id", pyarrow.int64()), *((name, pyarrow.float64()) for name in NAMES)])
    if with_geometries:
        geo = {"version": "1.1.0", "primary_column": "geometry"}
        geo["columns"] = {"geometry": {"encoding": "WKB", "geometry_types": ["Polygon"], "crs": None}}  # type: ignore
        schema = pyarrow.schema([("id", pyarrow.int64()), ("geometry", pyarrow.binary())], {"geo": json.dumps(geo)})
    with pyarrow.parquet.ParquetWriter(path, schema) as writer:
        for first in range(0, count, BLOCK):
            number = min(BLOCK, count - first)
            low = random.random((number, 2))
            boxes = np.hstack([low, low + count**-0.5])
            ids = np.arange(first, first + number)
            if with_geometries:
                import shapely

                columns = [ids, shapely.to_wkb(shapely.box(*boxes.T))]
            else:
                columns = [ids, *boxes.T]
            writer.write_table(pyarrow.table(columns, schema=schema), row_group_size=2**17)


def in_memory(folder: Path, count: int) -> None:
    """For comparison: everything in memory at once, files read and written."""
    import pyarrow
    import pyarrow.parquet

    import sweep_and_prune as sap

    table = pyarrow.parquet.read_table(folder / "boxes.parquet", columns=list(NAMES))
    pairs = sap.find_pairs(np.column_stack([table[name].to_numpy() for name in NAMES]))
    pyarrow.parquet.write_table(pyarrow.table({"a": pairs[:, 0], "b": pairs[:, 1]}), folder / "out.parquet")


def own(folder: Path, count: int) -> None:
    import sweep_and_prune.dask as sap

    path, out = str(folder / "boxes.parquet"), folder / "out"
    workers = 2 if count > 3_000_000 else None
    sap.find_pairs(path, out=out, ids="id", memory_limit=LIMIT, workers=workers, progress=False)


def own_with_workers(folder: Path, count: int) -> None:
    import sweep_and_prune.dask as sap

    path, out = str(folder / "boxes.parquet"), folder / "out"
    sap.find_pairs(path, out=out, ids="id", memory_limit=LIMIT, workers=2, progress=False)


def duckdb(folder: Path, count: int) -> None:
    import duckdb

    connection = duckdb.connect(str(folder / "database.duckdb"))
    connection.execute(f"SET memory_limit = '{LIMIT // 10**6}MB'")
    connection.execute(f"SET temp_directory = '{folder / 'spill'}'")
    connection.execute("SET preserve_insertion_order = false")
    connection.execute(
        f"""COPY (
            SELECT a.id AS a, b.id AS b
            FROM '{folder / "boxes.parquet"}' a JOIN '{folder / "boxes.parquet"}' b
            ON a.minx <= b.maxx AND b.minx <= a.maxx AND a.miny <= b.maxy AND b.miny <= a.maxy AND a.id < b.id
        ) TO '{folder / "out.parquet"}' (FORMAT parquet)"""
    )


def sedona_db(folder: Path, count: int) -> None:
    import sedonadb

    context = sedonadb.connect()
    context.options.memory_limit = LIMIT
    context.options.temp_dir = str(folder / "spill")
    context.read_parquet(str(folder / "shapes.parquet")).to_view("boxes")
    found = context.sql(
        "SELECT a.id AS a, b.id AS b FROM boxes a JOIN boxes b ON ST_Intersects(a.geometry, b.geometry) WHERE a.id < b.id"
    )
    found.to_parquet(str(folder / "out"))


def dask_geopandas(folder: Path, count: int) -> None:
    import dask_geopandas
    from distributed import Client

    with Client(n_workers=2, threads_per_worker=1, memory_limit=LIMIT // 2, dashboard_address=":0"):
        frame = dask_geopandas.read_parquet(folder / "shapes.parquet", split_row_groups=8)
        # Spatial partitions, so that only those that overlap are joined.
        frame = frame.spatial_shuffle(npartitions=max(frame.npartitions, 4))
        joined = frame.sjoin(frame)
        pairs = joined[joined["id_left"] < joined["id_right"]][["id_left", "id_right"]]
        pairs.to_parquet(folder / "out", write_index=False)


LIBRARIES: dict[str, Callable[[Path, int], None]] = {
    OWN: own,
    "sweep-and-prune, 2 workers": own_with_workers,
    "sweep-and-prune, in memory": in_memory,
    "SedonaDB": sedona_db,
    "DuckDB": duckdb,
    "dask-geopandas": dask_geopandas,
}


def measured(library: str, folder: Path, count: int, seconds: float) -> dict[str, Any]:
    """Runs a library in a process of its own, and watches its memory and what it writes."""
    import psutil

    command = [sys.executable, __file__, "--child", library, "--folder", str(folder), "--sizes", str(count)]
    log = folder / "log.txt"
    began = time.perf_counter()
    with open(log, "w") as output:
        process = psutil.Popen(command, stdout=output, stderr=subprocess.STDOUT)
    peak, why = 0, None
    written = 0
    busy: dict[int, float] = {}
    while process.poll() is None:
        resident = of_all = 0
        try:
            family = [process, *process.children(recursive=True)]
        except psutil.Error:
            continue
        for one in family:
            try:
                resident += one.memory_info().rss
                # A process that has ended counts as a part of the one that started it.
                of_all += one.io_counters().write_chars
                busy[one.pid] = sum(one.cpu_times()[:2])
            except psutil.Error:
                pass
        peak, written = max(peak, resident), max(written, of_all)
        too_much = peak > 1.5 * LIMIT and library != "sweep-and-prune, in memory"
        if too_much or time.perf_counter() - began > seconds:
            why = f"over {1.5 * LIMIT / 1e9:.0f} GB of memory" if too_much else f"over {seconds:.0f} s"
            for one in reversed(family):
                try:
                    one.kill()
                except psutil.Error:
                    pass
        time.sleep(0.02)
    passed = time.perf_counter() - began
    result: dict[str, Any] = {"seconds": passed, "processor_seconds": sum(busy.values()), "peak_bytes": peak}
    result["written_bytes"] = written
    if why is None and process.wait() != 0:
        why = (log.read_text().strip().splitlines() or ["it failed"])[-1][:300]
    if why is None:
        result["pairs"] = pairs_in(folder)
        if (folder / "out" / MANIFEST).exists():
            result["copies"] = json.loads((folder / "out" / MANIFEST).read_text())["copies"]
    return result | {"why_not": why}


def pairs_in(folder: Path) -> int:
    import pyarrow.parquet

    files = [path for path in folder.glob("out*/**/*.parquet")] + list(folder.glob("out*.parquet"))
    return sum(pyarrow.parquet.read_metadata(path).num_rows for path in files if path.is_file())


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[1_000_000, 10_000_000])
    parser.add_argument("--folder", type=Path, help="where the files go; by default, that of temporary files")
    parser.add_argument("--seconds", type=float, default=1800, help="the most that a library may take")
    parser.add_argument("--only", nargs="+", default=list(LIBRARIES), metavar="LIBRARY")
    parser.add_argument("--rounds", type=int, default=1)
    parser.add_argument("--child", choices=LIBRARIES, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.child:
        LIBRARIES[options.child](options.folder, options.sizes[0])
        return
    content: dict[str, Any] = {"date": date.today().isoformat(), "machine": machine(), "revision": revision()}
    content |= {"versions": versions(PACKAGES), "limit_bytes": LIMIT, "cases": []}
    given_up: set[str] = set()
    for count in sorted(options.sizes):
        with tempfile.TemporaryDirectory(dir=options.folder) as name:
            folder = Path(name)
            write_boxes(folder / "boxes.parquet", count, False)
            tried = [one for one in options.only if count <= MOST or one == OWN]
            if {"SedonaDB", "dask-geopandas"} & set(tried) - given_up:
                write_boxes(folder / "shapes.parquet", count, True)
            inputs = {path.name: path.stat().st_size for path in folder.glob("*.parquet")}
            runs: dict[str, list[dict[str, Any]]] = {library: [] for library in tried}
            content["cases"].append({"boxes": count, "input_bytes": inputs, "runs": runs})
            for _ in range(options.rounds):
                for library in [one for one in tried if one not in given_up]:
                    result = measured(library, folder, count, options.seconds)
                    runs[library].append(result)
                    if result["why_not"] is not None:
                        given_up.add(library)  # larger ones would end in the same way
                    write_results("disk", content)
                    note(f"{count} boxes, {library}: {result}")
                    for path in folder.iterdir():
                        if path.name not in inputs:
                            shutil.rmtree(path) if path.is_dir() else path.unlink()
            found = {result["pairs"] for of in runs.values() for result in of if "pairs" in result}
            if len(found) > 1:
                raise SystemExit(f"the libraries do not agree: {found} pairs")


if __name__ == "__main__":
    main()
