"""The command line gives the pairs of brute force, in every format, and says where a file is wrong."""

from __future__ import annotations

import csv
import gzip
import importlib
import io
import json
import os
import re
import signal
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracle import Array, in_order, pairs, pairs_between, random_boxes

from sweep_and_prune._command import main

BOXES = random_boxes(120, 2, np.float64)
NAMES = ["xmin", "ymin", "xmax", "ymax"]
SAP = [sys.executable, "-m", "sweep_and_prune"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def csv_of(boxes: Array, delimiter: str = ",", header: list[str] | None = NAMES) -> str:
    rows = [delimiter.join(f"{number}" for number in box) for box in boxes.tolist()]
    return "\n".join([*([delimiter.join(header)] if header else []), *rows]) + "\n"


def run(*arguments: str) -> str:
    """Standard output of a call that must succeed."""
    done = subprocess.run([*SAP, *arguments], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    return done.stdout


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The message of a call that must fail."""
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    return captured.err


def with_ctrl_c(command: list[str]) -> subprocess.Popen[str]:
    """Starts a program that Ctrl-C ends: a shell starts what runs in the background, these tests too, without it."""
    default = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # noqa: E731
    return subprocess.Popen(command, stderr=subprocess.PIPE, text=True, preexec_fn=default)


def numbers(text: str) -> Array:
    lines = text.splitlines()
    assert lines[0] == "a,b"
    return in_order(np.array([line.split(",") for line in lines[1:]], np.int64).reshape(-1, 2))


def write(name: str, boxes: Array = BOXES) -> str:
    """A file of boxes in the format that its name tells."""
    if name.endswith(".npy"):
        np.save(name, boxes)
    elif name.endswith(".npz"):
        np.savez(name, boxes=boxes, other=np.zeros(3))
    elif name.endswith(".gz"):
        with gzip.open(name, "wt") as file:
            file.write(csv_of(boxes))
    elif name.endswith((".csv", ".tsv", ".txt")):
        delimiter = "  " if "spaces" in name else {"tsv": "\t", "txt": ";"}.get(name[-3:], ",")
        Path(name).write_text(csv_of(boxes, delimiter, None if name.startswith("bare") else NAMES))
    elif name.endswith("json"):
        features = [
            {"type": "Feature", "properties": {"n": index}, "geometry": {"type": "LineString", "coordinates": corners}}
            for index, corners in enumerate(boxes.reshape(-1, 2, 2).tolist())
        ]
        Path(name).write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    else:
        arrow = pytest.importorskip("pyarrow")
        table = arrow.table(dict(zip(NAMES, boxes.T)))
        if name.startswith("nested"):
            table = arrow.table({"n": np.arange(len(boxes)), "bbox": table.to_struct_array()})
        if name.endswith("parquet"):
            importlib.import_module("pyarrow.parquet").write_table(table, name)
        else:
            importlib.import_module("pyarrow.feather").write_feather(table, name)
    return name


FILES = "a.csv a.tsv a.txt bare.csv bare.spaces.txt a.csv.gz a.npy a.npz a.geojson a.json a.parquet nested.parquet"
FILES += " a.feather a.arrow"


@pytest.mark.parametrize("name", FILES.split())
def test_every_format_is_read(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["pairs", write(name), "-o", "pairs.csv"]) == 0
    assert np.array_equal(numbers(Path("pairs.csv").read_text()), pairs(BOXES))
    assert main(["count", name]) == 0
    assert capsys.readouterr().out == f"{len(pairs(BOXES))}\n"
    assert main(["join", name, write("b.npy", BOXES[:50]), "-o", "pairs.csv"]) == 0
    assert np.array_equal(numbers(Path("pairs.csv").read_text()), pairs_between(BOXES, BOXES[:50]))


def test_geometries_of_geoparquet_are_read(capsys: pytest.CaptureFixture[str]) -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    frame = geopandas.GeoDataFrame({"n": range(120)}, geometry=shapely.box(*BOXES.T))
    for options in ({}, {"geometry_encoding": "geoarrow"}, {"write_covering_bbox": True}):
        frame.to_parquet("a.parquet", **options)
        assert main(["count", "a.parquet"]) == 0
        assert capsys.readouterr().out == f"{len(pairs(BOXES))}\n"
        assert main(["pairs", "a.parquet", "--id", "n", "-o", "pairs.csv"]) == 0
        assert np.array_equal(numbers(Path("pairs.csv").read_text()), pairs(BOXES))


def test_times_are_intervals() -> None:
    arrow = pytest.importorskip("pyarrow")
    times = {name: arrow.array(column, arrow.timestamp("ns")) for name, column in (("start", [0, 5]), ("end", [5, 9]))}
    importlib.import_module("pyarrow.parquet").write_table(arrow.table(times), "a.parquet")
    assert run("count", "a.parquet") == "1\n" and run("count", "a.parquet", "--closed", "left") == "0\n"


def test_times_are_written_as_in_the_file() -> None:
    pandas = pytest.importorskip("pandas")
    arrow = pytest.importorskip("pyarrow.parquet")
    first = pandas.Timestamp("2024-01-01")
    for unit, end, text in (("us", first, ""), ("ns", first, ""), ("ns", first + pandas.Timedelta(1), ".000000001")):
        frame = pandas.DataFrame(
            {"start": [first, first], "end": [end, end + pandas.Timedelta("2D")], "n": [None, end]}
        )
        frame = frame.astype(f"M8[{unit}]")
        frame.to_parquet("a.parquet")
        lines = ["a_start,a_end,a_n,b_start,b_end,b_n"]
        lines += [f"2024-01-01 00:00:00,2024-01-01 00:00:00{text},,2024-01-01 00:00:00,"]
        lines[1] += f"2024-01-03 00:00:00{text},2024-01-01 00:00:00{text}"
        assert run("pairs", "a.parquet", "--rows").splitlines() == lines
        assert run("merge", "a.parquet").splitlines()[1] == f"2024-01-01 00:00:00,2024-01-03 00:00:00{text},2"
        assert run("pairs", "a.parquet", "--measure", "size").splitlines()[1] in (
            "0,1,0:00:00", "0,1,0:00:00.000000001"
        )  # fmt: skip
        # With a zone, in UTC; where columns have types, as it is.
        zoned = frame.apply(lambda column: column.dt.tz_localize("UTC").dt.tz_convert("Asia/Tokyo"))
        zoned.to_parquet("z.parquet")
        wanted = [lines[0], ",".join(cell and f"{cell}Z" for cell in lines[1].split(","))]
        assert run("pairs", "z.parquet", "--rows").splitlines() == wanted
        run("join", "z.parquet", "z.parquet", "--how", "left", "--left-id", "start,n", "-o", "p.parquet")
        found = arrow.read_table("p.parquet")
        assert found.schema.field("a_start").type == arrow.read_table("z.parquet").schema.field("start").type
        assert found.column("a_n").null_count == 2
        (zoned + pandas.Timedelta("90D")).to_parquet("far.parquet")
        run("join", "z.parquet", "far.parquet", "--how", "left", "--id", "end", "-o", "p.parquet")
        far = arrow.read_table("p.parquet").column("b")
        assert str(far.type) == f"timestamp[{unit}, tz=Asia/Tokyo]" and far.null_count == 2


def test_a_column_of_lists_is_written_as_json() -> None:
    arrow = pytest.importorskip("pyarrow")
    parquet = importlib.import_module("pyarrow.parquet")
    boxes = [[0.0, 0, 2, 2], [1.0, 1, 3, 3]]
    for more in ({"a": [[1], [2, 3]]}, {"a": [[1, 2], None]}, {"a": [{"b": 1}, {"b": 2}]}):
        parquet.write_table(arrow.table({"bbox": boxes, **more}), "a.parquet")
        rows = list(csv.reader(run("pairs", "a.parquet", "--rows").splitlines()))[1]
        assert [json.loads(cell) if cell else None for cell in rows] == [boxes[0], more["a"][0], boxes[1], more["a"][1]]
        run("pairs", "a.parquet", "--rows", "-o", "p.arrow")
        assert arrow.ipc.open_file("p.arrow").read_all().column("b_a").to_pylist() == more["a"][1:]


@pytest.mark.parametrize("name", ["p.csv", "p.tsv", "p.npy", "p.parquet", "p.arrow", "p.feather"])
def test_every_format_is_written_to_a_file_and_to_a_pipe(name: str) -> None:
    write("a.npy")
    if name.endswith(("parquet", "arrow", "feather")):
        pytest.importorskip("pyarrow")
    kind = "arrow" if name.endswith("feather") else name.split(".")[1]
    run("pairs", "a.npy", "-o", name)
    piped = subprocess.run([*SAP, "pairs", "a.npy", "--to", kind], capture_output=True, check=True).stdout
    for number, data in enumerate((Path(name).read_bytes(), piped)):
        found: Any
        if kind == "npy":
            found = np.load(io.BytesIO(data))
        elif kind in ("csv", "tsv"):
            found = numbers(data.decode().replace("\t", ","))
        elif kind == "parquet":
            table = pytest.importorskip("pyarrow.parquet").read_table(io.BytesIO(data))
            found = np.stack([np.asarray(table[column]) for column in ("a", "b")], axis=1)
        else:
            ipc = pytest.importorskip("pyarrow").ipc
            table = (ipc.open_stream if number else ipc.open_file)(data).read_all()
            found = np.stack([np.asarray(table[column]) for column in ("a", "b")], axis=1)
        assert np.array_equal(in_order(found), pairs(BOXES))
    assert sorted(path.name for path in Path().iterdir()) == sorted(["a.npy", name])


@pytest.mark.parametrize("kind", ["npy", "parquet", "arrow", "csv"])
def test_no_pairs_are_a_file_without_rows(kind: str) -> None:
    np.save("a.npy", [[0.0, 1.0]])
    if kind in ("parquet", "arrow"):
        pytest.importorskip("pyarrow")
    assert main(["pairs", "a.npy", "-o", f"p.{kind}"]) == 0
    assert Path(f"p.{kind}").stat().st_size > 0


def test_intervals_of_bed_are_half_open_and_of_one_chromosome() -> None:
    Path("r.bed").write_text("track name=x\n#c\nchr1\t0\t10\tr1\nchr1\t10\t20\tr2\nchr2\t5\t9\tr3\n")
    Path("g.bed").write_text("chr1\t5\t15\tg1\nchr2\t9\t12\tg2\n")
    assert run("join", "r.bed", "g.bed", "--id", "name") == "a,b\nr1,g1\nr2,g1\n"
    assert run("join", "r.bed", "g.bed", "--closed", "both", "--to", "tsv") == "a\tb\n0\t0\n1\t0\n2\t1\n"
    assert run("pairs", "r.bed") == "a,b\n"
    assert run("count", "r.bed", "--distance", "1") == "1\n"


def test_options_are_those_of_find_pairs() -> None:
    sizes = np.hstack([BOXES[:, :2], BOXES[:, 2:] - BOXES[:, :2]])
    frame = np.arange(120) % 2
    rows = [f"{i},{','.join(map(str, box))}" for i, box in zip(frame, sizes.tolist())]
    Path("a.csv").write_text("\n".join(["frame,x,y,width,height", *rows]))
    wanted = pairs(BOXES)
    assert np.array_equal(numbers(run("pairs", "a.csv", "--format", "xywh", "--threads", "-1")), wanted)
    wanted = wanted[frame[wanted[:, 0]] == frame[wanted[:, 1]]]
    chosen = ["--columns", "x,y,width,height", "--format", "xywh"]
    assert np.array_equal(numbers(run("pairs", "a.csv", *chosen, "--by", "frame")), wanted)
    both = [*chosen, "--by", "frame, kind"]
    Path("a.csv").write_text(
        "\n".join(["frame,x,y,width,height,kind", *(f"{row},{n % 3}" for n, row in enumerate(rows))])
    )
    kind = np.arange(120) % 3
    assert np.array_equal(numbers(run("pairs", "a.csv", *both)), wanted[kind[wanted[:, 0]] == kind[wanted[:, 1]]])
    only_x = np.column_stack([BOXES[:, 0], BOXES[:, 2]])
    assert run("count", "a.csv", "--columns", "x,width", "--format", "xywh") == f"{len(pairs(only_x))}\n"


def test_names_are_quoted_where_it_is_needed() -> None:
    Path("a.csv").write_text('start,end,name\n0,2,"a,b"\n1,3,"say ""x"""\n')
    assert run("pairs", "a.csv", "--id", "name") == 'a,b\n"a,b","say ""x"""\n'


def test_standard_input_is_read() -> None:
    done = subprocess.run([*SAP, "count", "-"], input=csv_of(BOXES), capture_output=True, text=True)
    assert done.stdout == f"{len(pairs(BOXES))}\n"


def test_missing_numbers_are_refused_with_their_line_or_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("xmin,ymin,xmax,ymax\n0,0,1,1\n\n0,NA,2,2\n0,0,3,3\n")
    assert refused(capsys, "pairs", "a.csv").startswith("sap: a.csv, line 4, column ymin: the box has a NaN on axis 1")
    assert "remove it, or pass --missing skip" in refused(capsys, "pairs", "a.csv", "--columns", "ymin,xmax")
    assert run("pairs", "a.csv", "--missing", "skip") == "a,b\n0,2\n"


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.csv", "xmin,ymin,xmax,ymax\n0,0,1,1\n0,0,x,1\n", "a.csv, line 3, column xmax: 'x' is not a number"),
        ("a.csv", "xmin,ymin,xmax,ymax\n0,0,1,1\n0,0\n", "a.csv, line 3: it has 2 columns, where 4 are expected"),
        (
            "a.csv",
            "xmin,ymin,xmax,ymax\n3,0,2,1\n",
            "a.csv, line 2, columns xmin and xmax: the box is inverted on axis 0: ",
        ),
        (
            "a.csv",
            "a,b,c\n1,2,3\n",
            "a.csv has no columns that are known as boxes: choose them by --columns; its columns are a, b, c",
        ),
        (
            "a.csv",
            "x,y,width,height\n1,2,3,4\n",
            "a.csv has no columns that are known as boxes: pass --format xywh; its columns are x, y, width, height",
        ),
        ("a.csv", "1,2,3\n", "a.csv has no header and 3 columns; boxes have 2, 4 or 6"),
        ("a.csv", "", "a.csv is empty"),
        ("a.bed", "chr1\t5\n", "a.bed, line 1: chrom, start and end are expected"),
        ("a.json", "{", "a.json, line 1: "),
        ("a.json", "[5]", "a.json is not a FeatureCollection"),
        ("a.json", '{"features": [null]}', "a.json, feature 0 (the first is 0) is not valid GeoJSON"),
        (
            "a.json",
            '{"features": [{}, {"geometry": {"coordinates": ["ab"]}}]}',
            "a.json, feature 1 (the first is 0) is not",
        ),
        ("a.csv", "xmin,xmax,ymin\n0,1,0\n", "a.csv has no columns that are known as boxes: choose them by --columns"),
        ("a.npy", "", "a.npy is not an array of NumPy"),
        ("a.parquet", "nonsense", "a.parquet cannot be read"),
        ("a.feather", "nonsense", "a.feather cannot be read"),
        ("a.xyz", "", "a.xyz has an unknown ending"),
    ],
)
def test_what_is_wrong_with_a_file_is_said(
    name: str, content: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    if name.endswith((".parquet", ".feather")):
        pytest.importorskip("pyarrow")
    Path(name).write_text(content)
    assert refused(capsys, "pairs", name).startswith(f"sap: {message}")


def test_what_is_wrong_with_the_arguments_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    write("a.csv")
    write("a.npy")
    for name in ("no-file.csv", "no-file", "no-file.xyz"):
        assert f"{name} cannot be read: No such file" in refused(capsys, "pairs", name)
    assert "a.csv has no column 'q'; its columns are xmin" in refused(capsys, "pairs", "a.csv", "--by", "q")
    assert "a.csv has no column 'q'" in refused(capsys, "pairs", "a.csv", "--columns", "xmin,q")
    assert "margin is -1.0" in refused(capsys, "count", "a.npy", "--margin", "-1")
    assert "threads must be -1 or from" in refused(capsys, "count", "a.npy", "--threads", "0")
    assert "has an unknown ending" in refused(capsys, "pairs", "a.npy", "-o", "pairs.xyz")
    assert "cannot be written" in refused(capsys, "pairs", "a.npy", "-o", "no/such/folder.csv")
    Path("r.bed").write_text("chr1\t0\t10\n")
    assert "a.npy has no groups, but the other file has" in refused(capsys, "join", "r.bed", "a.npy")
    for arguments in (
        [],
        ["pairs"],
        ["unknown"],
        ["pairs", "a.npy", "--format", "abc"],
        ["join", "a.npy"],
        ["count", *3 * ["a.npy"]],
    ):
        assert main(arguments) == 2, arguments
    capsys.readouterr()


def test_help_and_version_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    for command in ([], ["pairs"], ["join"], ["count"], ["stats"], ["plot"]):
        assert main([*command, "--help"]) == 0
    assert "Examples:" in capsys.readouterr().out
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("sap ")


def test_stats_describe_the_boxes(capsys: pytest.CaptureFixture[str]) -> None:
    np.save("a.npy", np.array([[0.0, 2, 1, 3], [1, 2, 5, 9], [np.nan, 0, 0, 0], [20, 20, 21, 21]]))
    assert main(["stats", "a.npy", "--missing", "skip"]) == 0
    lines = [" ".join(line.split()) for line in capsys.readouterr().out.splitlines()]
    assert lines == [
        "4 boxes in 2D, 1 pairs",
        "1 boxes with missing numbers",
        "axis from to smallest size median largest",
        "x 0 21 1 1 4",
        "y 2 21 1 1 7",
        "pairs of each box: 0.50 on average, 1 at most",
        "pairs boxes",
        f"0 2 {'━' * 40}",
        f"1 2 {'━' * 40}",
    ]
    np.save("a.npy", np.zeros((0, 4)))
    assert main(["stats", "a.npy"]) == 0


@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_plots_are_drawn(dimensions: int, capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    np.save("a.npy", random_boxes(30, dimensions, np.float64))
    for name in ("a.svg", "a.png"):
        assert main(["plot", "a.npy", "--pairs", "-o", name]) == 0
    text = Path("a.svg").read_text()
    assert text.count("#4c78a8") >= 30 and "#e45756" in text
    assert "cannot be written" in refused(capsys, "plot", "a.npy", "-o", "a.nonsense")
    for rows in ([[0, 0, 1, 1], [3, 0, 2, 1]], [[0, 1], [3, 2]]):
        np.save("inverted.npy", rows)
        for options in ([], ["--pairs"]):
            said = refused(capsys, "plot", "inverted.npy", *options, "-o", "inverted.svg")
            assert "inverted.npy, row 1 (the first is 0): the box is inverted on axis 0: min 3" in said
    assert not Path("inverted.svg").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="pipes end in another way there")
@pytest.mark.parametrize("unbuffered", ["", "1"])
@pytest.mark.parametrize("boxes", [300, 3000])  # 45 thousand pairs, in one chunk, and 4.5 million
def test_a_pipe_that_is_closed_ends_the_program_quietly(boxes: int, unbuffered: str) -> None:
    np.save("a.npy", np.zeros((boxes, 2)))
    environment = {**os.environ, "PYTHONUNBUFFERED": unbuffered}
    arguments = [*SAP, "pairs", "a.npy"]
    with subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=environment) as program:
        assert program.stdout and program.stderr
        assert program.stdout.readline() == b"a,b\n"
        program.stdout.read(10_000)  # so that it is closed in the middle of a write
        program.stdout.close()
        assert program.stderr.read() == b"" and program.wait(60) == 141


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such terminals there")
def test_a_terminal_shows_progress_with_the_time_that_is_left() -> None:
    import os
    import pty

    np.save("a.npy", np.zeros((4000, 2)))  # 8 million pairs
    terminal, end = pty.openpty()
    program = subprocess.Popen([*SAP, "pairs", "a.npy", "-o", "p.csv"], stderr=end)
    os.close(end)
    shown = b""
    try:
        while chunk := os.read(terminal, 4096):
            shown += chunk
    except OSError:  # the other end is closed
        pass
    assert program.wait(60) == 0
    assert re.search(rb"writing .*\d%.*\d:\d\d:\d\d.* left", shown)


def test_too_large_a_file_is_refused_before_it_is_read(monkeypatch: pytest.MonkeyPatch) -> None:
    from sweep_and_prune import _tables
    from sweep_and_prune._file_error import FileError

    monkeypatch.setattr("os.sysconf", lambda name: 1000)
    with pytest.raises(FileError, match=r"a\.parquet has 100000000 boxes; searching them takes about 22 GB"):
        _tables.check_memory("a.parquet", "100000000 boxes", 4 * 10**8 * _tables._BYTES)
    for name, contents in (("a.csv", "0.0 GB of boxes"), ("a.csv.gz", "0.0 GB of boxes")):
        with pytest.raises(FileError, match=contents):
            monkeypatch.setattr("os.sysconf", lambda name: 100)
            _tables.read(write(name))
    with pytest.raises(FileError, match="120 boxes"):
        monkeypatch.setattr("os.sysconf", lambda name: 100)
        _tables.read(write("a.npy"))


def test_more_boxes_than_fit_in_memory_go_through_files(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("distributed")
    a, b = write("a.parquet"), write("b.parquet", random_boxes(80, 2, np.float64, 2))
    limited = ["--memory-limit", "1GB", "--workers", "0", "--quiet"]
    assert main(["pairs", a, *limited, "-o", "out"]) == 0
    import pyarrow.parquet

    assert np.array_equal(in_order(np.stack(pyarrow.parquet.read_table("out").columns, axis=1)), pairs(BOXES))
    assert main(["pairs", a, *limited, "-o", "out"]) == 0, "it is finished"
    assert main(["join", a, b, *limited, "-o", "between", "--margin", "1"]) == 0
    wanted = pairs_between(BOXES + [0, 0, 1, 1], random_boxes(80, 2, np.float64, 2) + [0, 0, 1, 1])
    found = np.stack(pyarrow.parquet.read_table("between").columns, axis=1)
    assert np.array_equal(in_order(found), wanted)
    assert capsys.readouterr() == ("", "")
    assert main(["count", a, *limited]) == main(["count", a, b, *limited]) == 0
    assert capsys.readouterr().out.split() == [
        str(len(pairs(BOXES))),
        str(len(pairs_between(BOXES, random_boxes(80, 2, np.float64, 2)))),
    ]
    assert "other boxes or other options" in refused(capsys, "pairs", a, *limited, "-o", "out", "--margin", "2")
    assert "-o FOLDER" in refused(capsys, "pairs", a, *limited)
    assert "other boxes or other options" in refused(capsys, "pairs", a, *limited, "-o", "out", "--by", "xmin")
    assert "b.npy: --memory-limit reads files of text, Par" in refused(capsys, "count", write("b.npy"), *limited)
    assert "memory_limit is 1MB" in refused(capsys, "pairs", a, "--memory-limit", "1MB", "--workers", "1", "-o", "new")
    assert "memory_limit must be" in refused(capsys, "pairs", a, "--memory-limit", "much", "-o", "new")


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such signals there")
def test_ctrl_c_keeps_what_is_done_and_the_same_command_continues() -> None:
    pytest.importorskip("distributed")
    import pyarrow.parquet

    boxes = random_boxes(400_000, 2, np.float64)
    table = pyarrow.table(dict(zip(NAMES, boxes.T)))
    pyarrow.parquet.write_table(table, "a.parquet", row_group_size=20_000)
    command = [*SAP, "pairs", "a.parquet", "-o", "out", "--memory-limit", "400MB", "--workers", "0"]
    program = with_ctrl_c(command)
    while not list(Path().glob("out.unfinished/spill/*.json")):
        assert program.poll() is None
    program.send_signal(signal.SIGINT)
    _, said = program.communicate(timeout=600)
    assert (program.returncode, said.strip()) == (130, "sap: cancelled; the same command continues")
    assert Path("out.unfinished").exists() and not Path("out").exists()
    assert subprocess.run(command, capture_output=True).returncode == 0
    found = np.stack(pyarrow.parquet.read_table("out").columns, axis=1)
    import sweep_and_prune as sap

    assert np.array_equal(in_order(found), in_order(sap.find_pairs(boxes)))


def test_the_output_takes_the_place_of_no_other_file(capsys: pytest.CaptureFixture[str]) -> None:
    write("a.npy")
    Path("p.csv.part").write_text("mine")
    assert main(["pairs", "a.npy", "-o", "p.csv"]) == 0
    assert Path("p.csv.part").read_text() == "mine"
    assert sorted(path.name for path in Path().iterdir()) == ["a.npy", "p.csv", "p.csv.part"]
    before = Path("a.npy").read_bytes()
    os.link("a.npy", "link.npy")
    assert "choose another file by -o" in refused(capsys, "pairs", "a.npy", "-o", "link.npy")
    assert "choose another file by -o" in refused(capsys, "pairs", "link.npy", "-o", "a.npy")
    assert "a name cannot contain a zero byte" in refused(capsys, "pairs", "a.npy", "-o", "p\0.csv")
    Path("folder.csv").mkdir()
    assert "folder.csv cannot be written" in refused(capsys, "pairs", "a.npy", "-o", "folder.csv")
    assert "no/p.csv cannot be written: No such file" in refused(capsys, "pairs", "a.npy", "-o", "no/p.csv")
    assert Path("a.npy").read_bytes() == before and not list(Path().glob(".sap-*"))


@pytest.mark.skipif(sys.platform == "win32", reason="files have other modes there")
def test_a_file_that_is_replaced_keeps_its_mode_its_links_and_its_other_names(
    capsys: pytest.CaptureFixture[str],
) -> None:
    write("a.npy")
    umask = os.umask(0o027)
    try:
        assert main(["pairs", "a.npy", "-o", "new.csv"]) == 0
    finally:
        os.umask(umask)
    assert Path("new.csv").stat().st_mode & 0o7777 == 0o640
    wanted = Path("new.csv").read_bytes()
    Path("folder").mkdir()
    for mode in (0o600, 0o664, 0o755):
        target = Path(f"folder/p{mode}.csv")
        target.write_text("old")
        target.chmod(mode)
        Path("link.csv").symlink_to(target)
        assert main(["pairs", "a.npy", "-o", "link.csv"]) == 0
        assert Path("link.csv").is_symlink() and not target.is_symlink()
        assert (target.read_bytes(), target.stat().st_mode & 0o7777) == (wanted, mode)
        Path("link.csv").unlink()
    Path("dangling.csv").symlink_to("folder/later.csv")
    assert main(["pairs", "a.npy", "-o", "dangling.csv"]) == 0
    assert Path("dangling.csv").is_symlink() and Path("folder/later.csv").read_bytes() == wanted
    Path("one.csv").write_text("old")
    os.link("one.csv", "two.csv")
    assert main(["pairs", "a.npy", "-o", "one.csv"]) == 0
    assert Path("two.csv").read_bytes() == wanted and Path("one.csv").stat().st_nlink == 2
    Path("circle.csv").symlink_to("circle.csv")
    assert "circle.csv cannot be written" in refused(capsys, "pairs", "a.npy", "-o", "circle.csv")
    assert not list(Path().rglob(".sap-*"))


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such files there")
def test_devices_pipes_and_descriptors_are_written_to_directly() -> None:
    write("a.npy")
    wanted = run("pairs", "a.npy")
    os.mkfifo("pipe.csv")
    reader = subprocess.Popen(["cat", "pipe.csv"], stdout=subprocess.PIPE, text=True)
    assert main(["pairs", "a.npy", "-o", "pipe.csv"]) == 0
    assert reader.communicate(timeout=60)[0] == wanted and Path("pipe.csv").is_fifo()
    # A terminal stands for every device: root could replace it by a file.
    terminal, device = os.openpty()
    name = os.ttyname(device)
    before = os.stat(name)
    Path("device.csv").symlink_to(name)
    assert main(["pairs", "a.npy", "-o", "device.csv"]) == 0
    assert os.path.samestat(before, os.stat(name)) and os.read(terminal, 3) == b"a,b"
    assert main(["pairs", "a.npy", "-o", "/dev/null", "--to", "npy"]) == 0
    assert Path("/dev/null").is_char_device()
    with open("both.csv", "w") as file:
        print("above", file=file, flush=True)
        subprocess.run([*SAP, "pairs", "a.npy", "-o", "/dev/stdout", "--to", "csv"], stdout=file, check=True)
    assert Path("both.csv").read_text() == "above\n" + wanted


@pytest.mark.skipif(sys.platform == "win32", reason="pipes end in another way there")
def test_a_named_pipe_whose_reader_ends_ends_the_program_quietly() -> None:
    np.save("a.npy", np.zeros((3000, 2)))  # 4.5 million pairs
    os.mkfifo("pipe.csv")
    program = subprocess.Popen([*SAP, "pairs", "a.npy", "-o", "pipe.csv"], stderr=subprocess.PIPE)
    with open("pipe.csv", "rb") as reader:
        assert reader.readline() == b"a,b\n"
    assert program.communicate(timeout=60)[1] == b"" and program.returncode == 141


@pytest.mark.skipif(sys.platform == "win32", reason="a file that is open cannot be replaced there")
def test_runs_at_the_same_time_do_not_disturb_each_other() -> None:
    write("a.npy")
    wanted = run("pairs", "a.npy")
    command = [*SAP, "pairs", "a.npy", "-o", "p.csv"]
    programs = [subprocess.Popen(command, stderr=subprocess.PIPE) for _ in range(8)]
    assert [(program.communicate()[1], program.returncode) for program in programs] == [(b"", 0)] * 8
    assert Path("p.csv").read_text() == wanted and len(list(Path().iterdir())) == 2


def test_a_picture_that_cannot_be_drawn_leaves_the_old_one(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("matplotlib")
    write("a.npy")
    for name in ("a.nonsense", "picture", "picture.png"):
        Path(name).write_text("mine")
    assert "a.nonsense cannot be written" in refused(capsys, "plot", "a.npy", "-o", "a.nonsense")
    assert "picture has no ending" in refused(capsys, "plot", "a.npy", "-o", "picture")
    assert [Path(name).read_text() for name in ("a.nonsense", "picture", "picture.png")] == ["mine"] * 3
