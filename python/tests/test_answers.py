"""The commands that answer more than which boxes overlap, on random BED files, against their definitions."""

from __future__ import annotations

import csv
import importlib
import io
import math
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from sweep_and_prune._command import main
from sweep_and_prune._file_error import FileError
from sweep_and_prune._writers import writer

Row = tuple[str, int, int, str]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def a_file(random: Random, name: str) -> list[Row]:
    rows = []
    for number in range(random.choice([1, 4, 9])):
        start = random.randint(0, 12)
        rows.append((random.choice(["c1", "c2"]), start, start + random.randint(1, 6), f"{name[0]}{number}"))
    Path(name).write_text("".join("\t".join(map(str, row)) + "\n" for row in rows))
    return rows


def table(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[list[str], list[list[str]]]:
    assert main(arguments) == 0, capsys.readouterr().err
    names, *rows = csv.reader(io.StringIO(capsys.readouterr().out))
    return names, rows


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == "" and captured.err.count("\n") == 1
    return captured.err


def shared(a: Row, b: Row) -> int:
    return min(a[2], b[2]) - max(a[1], b[1]) if a[0] == b[0] else -1


@pytest.mark.parametrize("seed", range(25))
def test_the_answers_are_their_definitions(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    random = Random(seed)
    a, b = a_file(random, "a.bed"), a_file(random, "b.bed")
    files = ["a.bed", "b.bed"]
    pairs = [(x, y) for x in a for y in b if shared(x, y) > 0]

    # bedtools intersect -wao, -loj, -u, -v, -f .5, -F .5, -f .5 -r
    names, rows = table(capsys, "join", *files, "--how", "left", "--rows", "--measure", "size")
    assert names == [f"{side}_{name}" for side in "ab" for name in ("chrom", "start", "end", "name")] + ["size"]
    wanted = []
    for x in a:
        matches = [y for other, y in pairs if other == x]
        wanted += [[*map(str, x), *map(str, y), str(shared(x, y))] for y in matches] or [[*map(str, x), *[""] * 5]]
    assert rows == wanted
    names, rows = table(capsys, "join", *files, "--how", "right", "--id", "name")
    assert names == ["a", "b"] and len(rows) == len(pairs) + sum(y not in [z for _, z in pairs] for y in b)
    assert [row[1] for row in rows] == sorted([row[1] for row in rows], key=lambda name: int(name[1:]))
    for how in ("semi", "anti"):
        names, rows = table(capsys, "join", *files, "--how", how, "--rows")
        kept = [x for x in a if (x in [z for z, _ in pairs]) == (how == "semi")]
        assert rows == [[*map(str, x)] for x in kept] and names == ["a_chrom", "a_start", "a_end", "a_name"]
    for text, of_a, of_b in (("0.5", 0.5, 0.5), ("0.5,0", 0.5, 0), ("0,0.75", 0, 0.75)):
        names, rows = table(
            capsys, "join", *files, "--fraction", text, "--id", "name,start", "--measure", "iou,fraction_b"
        )
        enough = [
            (x, y, shared(x, y) / (x[2] - x[1] + y[2] - y[1] - shared(x, y)), shared(x, y) / (y[2] - y[1]))
            for x, y in pairs
            if shared(x, y) / (x[2] - x[1]) >= of_a and shared(x, y) / (y[2] - y[1]) >= of_b
        ]
        assert names == ["a_name", "a_start", "b_name", "b_start", "iou", "fraction_b"]
        wanted = [[x[3], str(x[1]), y[3], str(y[1]), str(iou), str(share)] for x, y, iou, share in enough]
        assert sorted(rows) == sorted(wanted)

    # bedtools intersect -c, coverage, merge, cluster, closest
    names, rows = table(capsys, "count", *files, "--each", "--left-id", "name")
    counts = [sum(x == other for other, _ in pairs) for x in a]
    assert names == ["a", "count"] and rows == [[x[3], str(count)] for x, count in zip(a, counts)]
    names, rows = table(capsys, "coverage", *files)
    covered = [len({p for y in b if y[0] == x[0] for p in range(max(x[1], y[1]), min(x[2], y[2]))}) for x in a]
    assert names == ["a", "count", "covered", "fraction"]
    assert rows == [
        [str(at), str(count), str(length), str(length / (x[2] - x[1]))]
        for at, (x, count, length) in enumerate(zip(a, counts, covered))
    ]
    for options, gap in (([], -1), (["--closed", "both"], 0), (["--closed", "both", "--margin", "2"], 2)):
        label = [*range(len(a))]
        for _ in a:
            for i, x in enumerate(a):
                for j, y in enumerate(a):
                    if x[0] == y[0] and (shared(x, y) > 0 or 0 <= -shared(x, y) <= gap):
                        label[i] = label[j] = min(label[i], label[j])
        numbers: dict[int, int] = {}
        clusters = [numbers.setdefault(one, len(numbers)) for one in label]
        names, rows = table(capsys, "cluster", "a.bed", *options)
        assert names == ["a", "cluster"] and rows == [[str(at), str(one)] for at, one in enumerate(clusters)]
        names, rows = table(capsys, "merge", "a.bed", *options)
        of_each = [[x for x, one in zip(a, clusters) if one == number] for number in numbers.values()]
        assert names == ["chrom", "start", "end", "count"]
        assert rows == [
            [of[0][0], str(min(x[1] for x in of)), str(max(x[2] for x in of)), str(len(of))] for of in of_each
        ]
    for k, limit in ((1, math.inf), (2, 3)):
        reach = [] if limit == math.inf else ["--max-distance", str(limit)]
        names, rows = table(capsys, "nearest", *files, "-k", str(k), "--how", "left", "--id", "name", *reach)
        wanted = []
        for x in a:
            # What overlaps comes before what only touches.
            near = sorted(
                (max(-1, -shared(x, y)) - (shared(x, y) > 0), at, y[3]) for at, y in enumerate(b) if x[0] == y[0]
            )
            near = [one for one in near if one[0] <= limit][:k]
            wanted += [[x[3], name, str(max(distance, 0))] for distance, _, name in near] or [[x[3], "", ""]]
        assert names == ["a", "b", "distance"] and rows == wanted


def test_the_ids_of_coverage_are_those_of_the_first_file(capsys: pytest.CaptureFixture[str]) -> None:
    Path("g.gtf").write_text('1\tx\tgene\t1\t10\t.\t+\t.\tgene_id "a";\n')
    Path("r.bed").write_text("1\t5\t7\n")
    assert table(capsys, "coverage", "g.gtf", "r.bed", "--id", "gene_id")[1] == [["a", "1", "2", "0.2"]]
    assert "pass --left-id" in refused(capsys, "coverage", "g.gtf", "r.bed", "--right-id", "chrom")


def test_files_without_a_chromosome_in_common_are_noted(capsys: pytest.CaptureFixture[str]) -> None:
    for name, chromosome in (("a", "chr1"), ("b", "1"), ("c", "chr1")):
        Path(f"{name}.bed").write_text(f"{chromosome}\t5\t7\n")
    for other, wanted in (
        (
            "b",
            "sap: no boxes pair: column chrom has no value that is in both files, such as 'chr1' in a.bed and",
        ),
        ("c", ""),
    ):
        assert main(["count", "a.bed"]) == 0 and main(["join", "a.bed", f"{other}.bed"]) == 0
        said = capsys.readouterr().err
        assert said.startswith(wanted) and said.count("\n") == (other == "b")
    Path("m.bed").write_text("chrM\t5\t7\n1\t1\t2\n")
    Path("n.bed").write_text("chrM\t5\t7\nchr1\t1\t2\nchr2\t1\t2\n")
    assert main(["join", "m.bed", "n.bed", "--how", "anti"]) == 0
    wanted = (
        "sap: column chrom has values that differ in what is before them, such as '1' in m.bed and 'chr1' in n.bed\n"
    )
    assert capsys.readouterr().err == wanted
    Path("d.bed").write_text("0\t5\t7\n1\t1\t2\n")
    Path("e.bed").write_text("0\t5\t7\n2\t1\t2\n")
    assert main(["join", "d.bed", "e.bed"]) == 0 and capsys.readouterr().err == ""


def test_the_rows_of_a_large_join_are_sorted(capsys: pytest.CaptureFixture[str]) -> None:
    starts = np.random.default_rng(3).integers(0, 9000, 3000)
    np.save("a.npy", np.stack([starts, starts + 3], axis=1))
    for how, kept in (("left", 0), ("right", 1)):
        _, rows = table(capsys, "join", "a.npy", "a.npy", "--how", how)
        keys = [(int(row[kept]), int(row[1 - kept])) for row in rows]
        assert len(keys) > 6000 and keys == sorted(keys)


def test_answers_are_written_in_each_format(capsys: pytest.CaptureFixture[str]) -> None:
    a_file(Random(1), "a.bed")
    np.save("a.npy", np.array([[0, 2], [1, 5], [7, 9]]))
    assert main(["count", "a.npy", "--each", "-o", "c.npy"]) == 0
    assert np.load("c.npy").tolist() == [[0, 1], [1, 1], [2, 0]]
    for output in (["-o", "d.npy"], ["--to", "npy"]):  # nothing is written before
        assert "whole numbers only" in refused(capsys, "coverage", "a.npy", "a.npy", *output)
    arrow = pytest.importorskip("pyarrow.parquet")
    large = importlib.import_module("pyarrow").table({"start": [0, 0], "end": [1, 1], "n": np.array([1, 2**63], "u8")})
    arrow.write_table(large, "large.parquet")
    assert "below 2^63 only" in refused(capsys, "pairs", "large.parquet", "--id", "n", "-o", "d.npy")
    assert main(["join", "a.bed", "a.bed", "--how", "left", "--rows", "--measure", "size,iou", "-o", "p.parquet"]) == 0
    found: Any = arrow.read_table("p.parquet")
    assert found.column_names[-2:] == ["size", "iou"] and str(found.schema.field("iou").type) == "double"
    assert main(["nearest", "a.npy", "a.npy", "-k", "2", "-o", "n.parquet"]) == 0
    assert str(arrow.read_table("n.parquet").schema.field("distance").type) == "int64"


@pytest.mark.parametrize("kind", ["parquet", "arrow"])
def test_chunks_without_values_are_of_the_type_of_their_column(kind: str) -> None:
    pytest.importorskip("pyarrow")
    pandas = pytest.importorskip("pandas")
    values = np.array([None, None, "x"], object)
    with writer(f"p.{kind}", kind, 3, ["a", "b"], [values, np.arange(3)]) as file:
        for rows in ([0, 1], [2]):
            file.write([values[rows], np.array(rows)])
    with writer(f"q.{kind}", kind, 0, ["a"], [values]) as file:
        pass
    read = pandas.read_parquet if kind == "parquet" else pandas.read_feather
    assert read(f"p.{kind}")["a"].isna().tolist() == [True, True, False]
    assert read(f"q.{kind}")["a"].tolist() == []
    with pytest.raises(FileError, match="cannot hold a column"):
        with writer(f"r.{kind}", kind, 2, ["a"], [np.array(["x", 1], object)]):
            pass
    assert not Path(f"r.{kind}").exists()


def test_options_that_do_not_fit_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    np.save("a.npy", np.array([[0, 2], [1, 5]]))
    Path("a.bed").write_text("c\t0\t5\n")
    Path("n.csv").write_text("start,end,count\n0,5,x\n3,8,x\n")
    assert main(["merge", "n.csv", "--by", "count", "--to", "bed"]) == 0 and capsys.readouterr().out == "x\t0\t8\t2\n"
    for arguments, said in (
        (["count", "a.npy", "--id", "x"], "are for --each"),
        (["count", "a.npy", "-o", "x.csv"], "are for --each"),
        (["count", "a.bed", "a.bed", "--left-id", "chrom"], "are for --each"),
        (["count", "a.npy", "--each", "--threads", "2"], "--each counts on one thread"),
        (["count", "a.npy", "--workers", "0"], "--workers is for --memory-limit"),
        (["pairs", "a.npy", "--spill", "x"], "--spill is for --memory-limit"),
        (["join", "a.npy", "a.npy", "--overwrite"], "--overwrite is for --memory-limit"),
        (["join", "a.npy", "a.npy", "--rows"], "a.npy has no named columns: leave out --rows"),
        (["join", "a.bed", "a.bed", "--rows", "--id", "chrom"], "pass --id or --rows"),
        (["join", "a.npy", "a.npy", "--how", "semi", "--measure", "size"], "leave out --measure"),
        (["join", "a.npy", "a.npy", "--measure", "area"], "must be of size, fraction_a, fraction_b, iou, not area"),
        (["pairs", "a.npy", "--fraction", "50%"], "--fraction is 50%; it must be a number from 0 to 1"),
        (["pairs", "a.npy", "--fraction", "0.5,nan"], "--fraction is 0.5,nan; it must be a number from 0 to 1"),
        (["merge", "n.csv", "--by", "count"], "--by count: merge writes a column of its own with this name"),
        (["coverage", "a.npy", "a.npy", "--margin", "1"], "leave out --margin"),
        (["nearest", "a.npy", "a.npy", "--margin", "1"], "pass --max-distance"),
        (["nearest", "a.npy", "a.npy", "-k", "0"], "k must be from 1"),
        (
            ["pairs", "a.parquet", "--memory-limit", "1GB", "--fraction", "0.5", "-o", "x"],
            "--fraction cannot be combined",
        ),
        (["count", "a.npy", "--memory-limit", "1GB"], "a.npy: --memory-limit reads files of text, Parquet files and"),
        (["count", "-", "--memory-limit", "1GB"], "-: --memory-limit reads files of text, Parquet files and folders"),
        (["count", "a.parquet", "--memory-limit", "1GB", "--each"], "--each cannot be combined"),
    ):
        if "--memory-limit" in arguments:
            pytest.importorskip("distributed")
        assert said in refused(capsys, *arguments), arguments
    np.save("b.npy", np.array([[0, 0, 2, 2], [5, 5, 6, 6], [1, 1, 3, 9]]))
    assert table(capsys, "cluster", "b.npy")[1] == [["0", "0"], ["1", "1"], ["2", "0"]]
    names, rows = table(capsys, "merge", "b.npy")
    assert names == ["minx", "miny", "maxx", "maxy", "count"] and rows == [[*"00392"], [*"55661"]]
    assert "b.npy: " in refused(capsys, "coverage", "b.npy", "b.npy")


def test_intervals_with_chromosomes_that_no_one_asks_for_are_noted(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("Chr,start,end\n1,0,5\n2,3,8\n")
    assert main(["count", "a.csv"]) == 0
    captured = capsys.readouterr()
    assert captured.out == "1\n" and captured.err.endswith("intervals pair: pass --by Chr\n")
    assert main(["count", "a.csv", "--by", "Chr"]) == 0 and capsys.readouterr() == ("0\n", "")
    Path("b.csv").write_text("chr,x1,y1,x2,y2\n1,0,0,5,5\n")
    assert main(["count", "b.csv"]) == 0 and capsys.readouterr().err == ""


def test_pairs_that_overlap_enough_are_written_in_chunks(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    starts = np.random.default_rng(5).integers(0, 60, 60)
    np.save("a.npy", np.stack([starts, starts + 9], axis=1))
    options = ["--fraction", "0.4", "--measure", "size"]
    at_once = table(capsys, "pairs", "a.npy", *options)[1]
    monkeypatch.setattr("sweep_and_prune._command._PAIRS_AT_ONCE", 7)
    widths = []
    write = importlib.import_module("sweep_and_prune._writers")._TextWriter.write

    def noted(self: Any, columns: Any) -> None:
        widths.append(len(columns[0]))
        write(self, columns)

    monkeypatch.setattr("sweep_and_prune._writers._TextWriter.write", noted)
    assert sorted(table(capsys, "pairs", "a.npy", *options)[1]) == sorted(at_once) and len(at_once) > 100
    assert max(widths) <= 7
    assert all(int(size) >= 4 for *_, size in at_once)
    assert main(["pairs", "a.npy", *options, "-o", "p.npy"]) == 0
    assert sorted(np.load("p.npy").tolist()) == sorted([*map(int, row)] for row in at_once)


def test_what_cannot_be_measured_is_refused_before_the_search(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    np.save("a.npy", np.zeros((9, 2)))
    monkeypatch.setattr("sweep_and_prune._command.read", None)
    for option in (["--measure", "IoU"], ["--fraction", "2"], ["--fraction", "0.5,x"]):
        assert option[0] in refused(capsys, "pairs", "a.npy", *option)


def test_rows_of_bed_are_written_as_bed(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.bed").write_text("1\t0\t9\ta\t.\t+\n1\t20\t29\tb\t.\t-\n")
    Path("b.bed").write_text("1\t5\t7\n")
    assert main(["join", "a.bed", "b.bed", "--how", "semi", "--rows", "-o", "s.bed"]) == 0
    assert Path("s.bed").read_text() == "1\t0\t9\ta\t.\t+\n"
    assert main(["join", "a.bed", "b.bed", "--how", "left", "--rows", "--to", "bed"]) == 0
    assert capsys.readouterr().out.splitlines()[1] == "1\t20\t29\tb\t.\t-\t.\t.\t."
    assert main(["merge", "a.bed", "--by", "chrom,strand", "--to", "bed"]) == 0
    assert capsys.readouterr().out == "1\t0\t9\t1\t+\n1\t20\t29\t1\t-\n"
    Path("c.csv").write_text('start,end,note\n0,9,"a\tb"\n')
    assert "cannot hold a cell with a tab" in refused(capsys, "join", "c.csv", "c.csv", "--rows", "-o", "c.bed")


def test_quotes_within_a_cell_stay_as_they_are_in_tsv(capsys: pytest.CaptureFixture[str]) -> None:
    attributes = 'gene_id "a, b"; note "x";'
    Path("g.gtf").write_text(f"1\tx\tgene\t1\t10\t.\t+\t.\t{attributes}\n")
    assert main(["count", "g.gtf", "--each", "--id", "attributes", "--to", "tsv"]) == 0
    assert capsys.readouterr().out == f"a\tcount\n{attributes}\t0\n"
    Path("q.csv").write_text('start,end,note\n0,9,"""a"" b"\n0,9,"c\td"\n0,9," e"\n')
    assert main(["count", "q.csv", "--each", "--id", "start,end,note", "-o", "n.tsv"]) == 0
    with open("n.tsv", newline="") as file:
        assert [row[2] for row in csv.reader(file, delimiter="\t")] == ["a_note", '"a" b', "c\td", " e"]


def test_numbers_of_text_are_numbers_in_files_with_types(capsys: pytest.CaptureFixture[str]) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    Path("a.bed").write_text("1\t5\t7\tx\t0.5\t+\n1\t6\t9\t007\t1\t-\n")
    for arguments in (["pairs", "a.bed"], ["coverage", "a.bed", "a.bed"], ["count", "a.bed", "--each"]):
        assert main([*arguments, "--rows", "-o", "p.parquet"]) == 0
        schema = parquet.read_schema("p.parquet")
        kinds = [str(schema.field(f"a_{name}").type) for name in ("chrom", "start", "end", "name", "score")]
        assert kinds == ["string", "int64", "int64", "string", "double"]


def test_commands_of_bedtools_and_empty_names_are_told_apart(capsys: pytest.CaptureFixture[str]) -> None:
    a_file(Random(1), "a.bed")
    assert main(["intersect", "a.bed", "a.bed"]) == 2 and "here it is sap join" in capsys.readouterr().err
    assert main(["count", "a.bed", "--by", ""]) == 2 and "a name is empty" in capsys.readouterr().err
    Path("b.csv").write_text("start,end,name\n0,4,x\n")
    Path("c.csv").write_text("start,end\n1,2\n")
    assert "pass --left-id and --right-id" in refused(capsys, "join", "b.csv", "c.csv", "--id", "name")
    assert table(capsys, "join", "b.csv", "c.csv", "--how", "semi", "--id", "name")[1] == [["x"]]
    assert "pass --right-by" in refused(capsys, "join", "b.csv", "c.csv", "--left-by", "name")
