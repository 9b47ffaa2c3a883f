"""Damaged files, full disks and closed standard streams: `sap` answers, or says in one line what is wrong."""

from __future__ import annotations

import gzip
import importlib
import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sweep_and_prune._command import main

SAP = [sys.executable, "-m", "sweep_and_prune"]
COMMANDS = ["count", "pairs", "stats", "plot", "merge"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def archive(damage: bool) -> bytes:
    np.savez("other.npz", boxes=np.zeros((9, 2)))
    content = bytearray(Path("other.npz").read_bytes())
    content[content.find(b"NUMPY") + 100] ^= 255 if damage else 0
    return bytes(content)


def objects(name: str) -> bytes:
    save: Any = np.save if name.endswith("npy") else np.savez
    save(name, np.array([None, 1], object))
    return Path(name).read_bytes()


def an_array() -> bytes:
    np.save("other.npy", np.zeros((9, 2)))
    return Path("other.npy").read_bytes()


def features(*parts: str) -> bytes:
    return ('{"features": [{' + "}, {".join(parts) + "}]}").encode()


def a_point(x: str) -> str:
    return f'"geometry": {{"type": "Point", "coordinates": [{x}, 0]}}'


CSV = b"start,end\n0,1\n0,1\n"
FILES: dict[str, Callable[[], bytes]] = {
    "crc.npz": lambda: archive(True),
    "cut.npz": lambda: archive(False)[:-30],
    "objects.npz": lambda: objects("objects.npz"),
    "objects.npy": lambda: objects("objects.npy"),
    "cut.npy": lambda: an_array()[:-20],
    "cut-header.npy": lambda: an_array()[:20],
    "scalar-header.npy": lambda: an_array().replace(b"(9, 2)", b"(9,-2)"),
    "dtype.npy": lambda: an_array().replace(b"<f8", b"<q9"),
    "deep.json": lambda: b"[" * 100_000,
    "deep.geojson": lambda: features('"geometry": {"coordinates": ' + "[" * 100_000 + "]" * 100_000 + "}"),
    "digits.geojson": lambda: features(a_point("9" * 5000)),
    "properties.geojson": lambda: features('"properties": [1], ' + a_point("0")),
    "properties-text.geojson": lambda: features('"properties": "x", ' + a_point("0")),
    "geometry.geojson": lambda: features('"geometry": [1]'),
    "utf8.geojson": lambda: b"\xff",
    "null.geojson": lambda: b"null",
    "cut.csv.gz": lambda: gzip.compress(CSV)[:-6],
    "cut-header.csv.gz": lambda: gzip.compress(CSV)[:12],
    "crc.csv.gz": lambda: gzip.compress(CSV)[:-8] + b"12345678",
    "deflate.csv.gz": lambda: gzip.compress(CSV)[:10] + b"\xff" * 30,
    "none.csv.gz": lambda: CSV,
    "wide.csv": lambda: ",".join(f"c{n}" for n in range(100_000)).encode() + b"\n",
    "utf8.csv": lambda: b"start,end\n0,1\xff\n",
    "zero.csv": lambda: b"start,end\n0,\0\n",
    "empty.csv": lambda: b"",
    "utf8.bed": lambda: b"chr\xff\t0\t1\n",
    "empty.arrow": lambda: b"",
    "empty.parquet": lambda: b"",
}
GEO = {
    "cut": b"{",
    "list": b"[]",
    "empty": b"{}",
    "name": b'{"primary_column": "q"}',
    "number": b'{"primary_column": 3}',
    "utf8": b"\xff",
    "shape": b'{"version": "1.0.0", "primary_column": "geometry", "columns": {"geometry": {"encoding": "WKB"}}}',
}


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("name", FILES)
def test_damaged_files_are_refused_in_one_line(name: str, command: str, capsys: pytest.CaptureFixture[str]) -> None:
    if name.endswith(("arrow", "parquet")):
        pytest.importorskip("pyarrow")
    Path(name).write_bytes(FILES[name]())
    refused(command, name, capsys)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("damage", GEO)
def test_damaged_geoparquet_is_refused_in_one_line(
    damage: str, command: str, capsys: pytest.CaptureFixture[str]
) -> None:
    arrow = pytest.importorskip("pyarrow")
    pytest.importorskip("geopandas")
    table = arrow.table({"geometry": [b"no geometry", b"xx"]}).replace_schema_metadata({b"geo": GEO[damage]})
    importlib.import_module("pyarrow.parquet").write_table(table, "a.parquet")
    refused(command, "a.parquet", capsys)


def refused(command: str, name: str, capsys: pytest.CaptureFixture[str]) -> None:
    if command == "plot":
        pytest.importorskip("matplotlib")
    output = {"pairs": ["-o", "p.csv"], "plot": ["-o", "p.png"]}.get(command, [])
    assert main([command, name, *output]) == 1
    said = capsys.readouterr()
    assert said.out == "" and said.err.startswith(f"sap: {name}") and said.err.count("\n") == 1
    assert len(said.err) < 600
    assert not Path("p.csv").exists() and not Path("p.png").exists()


def test_plain_geoparquet_is_read(capsys: pytest.CaptureFixture[str]) -> None:
    arrow, shapely = pytest.importorskip("pyarrow"), pytest.importorskip("shapely")
    pytest.importorskip("geopandas")
    geo = json.dumps({"version": "1.0.0", "primary_column": "g", "columns": {"g": {"encoding": "WKB"}}})
    shapes = shapely.to_wkb(shapely.box([0, 1, 5], [0, 1, 5], [1, 2, 6], [1, 2, 6]))
    table = arrow.table({"g": shapes}).replace_schema_metadata({b"geo": geo.encode()})
    importlib.import_module("pyarrow.parquet").write_table(table, "a.parquet")
    assert main(["count", "a.parquet"]) == 0 and capsys.readouterr().out == "1\n"


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files there")
@pytest.mark.parametrize(
    "arguments",
    [
        *(["pairs", "a.npy", "--to", kind] for kind in ("csv", "tsv", "npy", "parquet", "arrow")),
        ["count", "a.npy"],
        ["stats", "a.npy"],
        ["--help"],
        ["pairs", "--help"],
        ["--version"],
    ],
    ids=" ".join,
)
@pytest.mark.parametrize("output", [">/dev/full", ">&-"])
def test_an_output_that_is_full_or_closed_is_said_in_one_line(arguments: list[str], output: str) -> None:
    if arguments[-1] in ("parquet", "arrow"):
        pytest.importorskip("pyarrow")
    np.save("a.npy", np.zeros((500, 2)))
    done = subprocess.run(["sh", "-c", f'"$@" {output}', "sh", *SAP, *arguments], stderr=subprocess.PIPE, text=True)
    why = "No space left on device" if "full" in output else "it is closed"
    assert (done.returncode, done.stderr) == (1, f"sap: standard output cannot be written: {why}\n")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such streams there")
def test_standard_input_is_read_as_files_are() -> None:
    for content, status, said in (
        (b"\xef\xbb\xbf" + CSV, 0, ""),
        (b"\xff" + CSV, 1, "sap: standard input is not text in UTF-8\n"),
    ):
        done = subprocess.run([*SAP, "count", "-"], input=content, capture_output=True)
        assert (done.returncode, done.stderr.decode()) == (status, said)
    done = subprocess.run(["sh", "-c", '"$@" <&-', "sh", *SAP, "count", "-"], capture_output=True)
    assert (done.returncode, done.stderr) == (1, b"sap: standard input is closed\n")


def test_a_large_box_that_is_inverted_is_refused_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text(f"start,end\n{2**64 + 1},{2**64}\n")
    refused("count", "a.csv", capsys)


def test_a_long_name_does_not_hide_what_is_wrong(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["count", "x" * 3000 + ".csv"]) == 1
    said = capsys.readouterr().err
    assert len(said) < 600 and "cannot be read" in said
