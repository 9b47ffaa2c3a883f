"""With a memory limit, files of any kind give the pairs that they give in memory, or one clear error."""

from __future__ import annotations

import datetime
import fcntl
import gzip
import os
import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sweep_and_prune import _tables, count_pairs_between, find_pairs
from sweep_and_prune._command import main

pytest.importorskip("distributed")
import pandas
import pyarrow
import pyarrow.parquet

import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned import plain

# Dask calls pandas in a way that a newer pandas warns of.
pytestmark = pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")

LIMITED = ["--memory-limit", "1GB", "--workers", "0", "--quiet"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(_tables, "_PART_OF_TEXT", 997)  # many parts
    monkeypatch.setattr(plain, "_ROWS", 37)


def write_files(random: np.random.Generator, side: str) -> list[str]:
    """The same intervals in groups, in files of all kinds, and their names."""
    count = int(random.integers(1, 150))
    start = random.integers(0, 300, count)
    end = start + random.integers(1, 20, count)
    group = random.choice(["1", "2", "X", "10"][: random.integers(1, 5)], count)
    strand = random.choice(["+", "-"], count)
    name = [f"{side}{row}" for row in range(count)]
    rows = list(zip(group, start.tolist(), end.tolist(), name, strand))
    bed = "".join(f"{g}\t{s}\t{e}\t{n}\t0\t{d}\n" for g, s, e, n, d in rows)
    Path(f"{side}.bed").write_text(f"track x\n#c\n{bed}")
    # A cell that the fast reader does not take: from there on, the file is read line by line.
    Path(f"{side}slow.bed").write_text(bed.replace("\t", "\t ", 1) if random.random() < 0.5 else f"{bed}\n#end\n")
    with gzip.open(f"{side}.bed.gz", "wt") as file:
        file.write(bed)
    gtf = "".join(f'{g}\tx\texon\t{s + 1}\t{e}\t.\t{d}\t.\tname "{n}";\n' for g, s, e, n, d in rows)
    Path(f"{side}.gtf").write_text(f"##x\n{gtf}")
    table: dict[str, Any] = {"chrom": group, "start": start, "end": end, "name": name, "strand": strand}
    frame = pandas.DataFrame(table)
    frame.to_csv(f"{side}.csv", index=False)
    frame.to_csv(f"{side}.tsv", index=False, sep="\t")
    if random.random() < 0.5:
        frame["chrom"] = frame["chrom"].astype("category")
    frame.to_parquet(f"{side}.parquet", row_group_size=max(count // 3, 1))
    return [f"{side}{ending}" for ending in (".bed", "slow.bed", ".bed.gz", ".gtf", ".csv", ".tsv", ".parquet")]


def answers(command: list[str], options: list[str]) -> list[tuple[str, str]] | str:
    """The rows that a command writes, sorted, or what it says instead."""
    for path in Path().glob("out*"):
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    limited = "--memory-limit" in options
    out = "out" if limited else "out.csv"
    if main([*command, *options, "-o", out]) != 0:
        return "refused"
    found = pyarrow.parquet.read_table(out).to_pandas() if limited else pandas.read_csv(out, dtype=str)
    rows = [tuple(map(str, row)) for row in found.to_numpy().tolist()]
    is_one = command[0] == "pairs"
    return sorted((min(row), max(row)) if is_one else (row[0], row[1]) for row in rows)


@pytest.mark.parametrize("seed", range(40))
def test_files_give_the_pairs_that_they_give_in_memory(seed: int, capsys: pytest.CaptureFixture[str]) -> None:
    random = np.random.default_rng(seed)
    a, b = (random.choice(write_files(random, side)) for side in "ab")
    command = ["pairs", a] if random.random() < 0.4 else ["join", a, b]
    if random.random() < 0.5:
        command += ["--closed", str(random.choice(["both", "left", "neither"]))]
    if random.random() < 0.5:
        command += ["--by", str(random.choice(["chrom", "strand", "chrom,strand", "name", "no"]))]
    if random.random() < 0.5:
        command += ["--margin", str(random.integers(0, 5))]
    if random.random() < 0.5:
        command += ["--id", "name"]
    in_memory = answers(command, ["--quiet"])
    said = capsys.readouterr().err
    assert answers(command, LIMITED) == in_memory, command
    limited = capsys.readouterr().err
    if in_memory == "refused":  # options are named as Python names them
        words = [set(re.findall(r"\w+", text)) for text in (said, limited)]
        assert len(words[0] & words[1]) >= len(words[0]) // 2, (said, limited)
    assert not Path("out.boxes").exists()


@pytest.mark.parametrize("unit", ["s", "ms", "us", "ns"])
@pytest.mark.parametrize("zone", [None, "Asia/Tokyo"])
def test_times_are_compared_exactly(unit: str, zone: str | None) -> None:
    random = np.random.default_rng(3)
    starts = np.datetime64("2024-01-01", "s") + random.integers(0, 5000, 300)
    ends = starts + random.integers(0, 90, 300)
    who = random.choice(["a", "b"], 300)
    for name, unit_of_file in (("a", unit), ("b", "s")):
        frame = pandas.DataFrame({"start": starts, "end": ends}).astype(f"M8[{unit_of_file}]")
        if zone is not None:
            frame = frame.apply(lambda column: column.dt.tz_localize("UTC").dt.tz_convert(zone))
        frame.assign(who=who).to_parquet(f"{name}.parquet")
        starts, ends, who = starts[:200], ends[:200], who[:200]
    a, b = (pandas.read_parquet(f"{name}.parquet") for name in "ab")
    for closed in ("both", "left"):
        for margin in (0, datetime.timedelta(seconds=3)):
            given: dict[str, Any] = {"closed": closed, "margin": margin}
            wanted = count_pairs_between(a, b, by="who", **given)
            assert sap.count_pairs_between("a.parquet", "b.parquet", by="who", workers=0, **given) == wanted
            wanted = count_pairs_between(a, b, **given)
            assert sap.count_pairs_between("a.parquet", "b.parquet", workers=0, **given) == wanted


def test_a_nanosecond_is_not_lost_and_too_many_are_refused() -> None:
    origin = np.datetime64("2024-01-01", "ns").astype(np.int64)
    steps = np.arange(0, 1000, 100)
    for last in (0, 2**53):
        start = (origin + np.append(steps, last)).view("M8[ns]")
        pyarrow.parquet.write_table(
            pyarrow.table({"start": start, "end": start + np.timedelta64(99, "ns")}), "a.parquet"
        )
        if last:
            with pytest.raises(
                sap.DatasetError, match="are not exact as float64: convert the columns to a coarser unit"
            ):
                sap.count_pairs("a.parquet", workers=0)
        else:
            assert sap.count_pairs("a.parquet", workers=0) == 1, "the first one is there twice"
            assert sap.count_pairs("a.parquet", margin=np.timedelta64(1, "ns"), workers=0) == 11


def test_ends_and_margins_have_the_precision_of_both_files() -> None:
    end = np.float32(0.1)
    between = (float(np.nextafter(end, np.float32(0))) + float(end)) / 2
    a, b = np.array([[0, end]], np.float32), np.array([[between, 1], [float(end) + 5e-10, 1]])
    for name, boxes in (("a", a), ("b", b)):
        pyarrow.parquet.write_table(pyarrow.table(dict(zip(("start", "end"), boxes.T))), f"{name}.parquet")
    options: list[dict[str, Any]] = [{"closed": "left"}, {"margin": 1e-9}, {}]
    for given in options:
        wanted = count_pairs_between(a, b, **given)
        assert sap.count_pairs_between("a.parquet", "b.parquet", workers=0, **given) == wanted, given
        assert sap.count_pairs_between("a.parquet", "b.parquet", **given) == wanted, "as a graph of Dask"


def test_a_run_that_was_interrupted_uses_its_files_again(monkeypatch: pytest.MonkeyPatch) -> None:
    write_files(np.random.default_rng(1), "a")

    def interrupted(*_: Any) -> None:
        raise KeyboardInterrupt

    given: dict[str, Any] = {"by": "chrom", "out": "out", "workers": 0}
    with monkeypatch.context() as changed, pytest.raises(KeyboardInterrupt):
        changed.setattr("sweep_and_prune.dask.run", interrupted)
        sap.find_pairs("a.csv", **given)
    assert sorted(os.listdir("out.boxes")) == ["0.parquet", "_boxes.json", "lock"]
    Path(f"out.boxes/1.parquet.{'0' * 32}.part").write_text("what was written when it was killed")
    with monkeypatch.context() as changed:
        changed.setattr(plain, "read_parts", None)
        found = sap.find_pairs("a.csv", **given).compute()
    assert not Path("out.boxes").exists()
    assert sap.find_pairs("a.csv", **given).compute().equals(found), "it is finished"
    with pytest.raises(sap.DatasetError, match="other boxes or other options"):
        sap.find_pairs("a.csv", **{**given, "by": "strand"})


def test_other_files_beside_the_pairs_are_left_alone() -> None:
    write_files(np.random.default_rng(1), "a")
    Path("out.boxes").mkdir()
    Path("out.boxes/mine.txt").write_text("mine")
    with pytest.raises(sap.DatasetError, match="has other files"):
        sap.find_pairs("a.csv", by="chrom", out="out", workers=0)
    assert os.listdir("out.boxes") == ["mine.txt"]
    os.rename("out.boxes/mine.txt", "out.boxes/0.parquet")
    with pytest.raises(sap.DatasetError, match="has other files"):
        sap.find_pairs("a.csv", by="chrom", out="out", workers=0)
    assert Path("out.boxes/0.parquet").read_text() == "mine"
    pyarrow.parquet.write_table(pyarrow.table({"start": [0], "end": [1]}), "out.boxes/0.parquet")
    with pytest.raises(ValueError, match="has boxes and is in out"):
        sap.find_pairs("out.boxes/0.parquet", out="out", workers=0)


def test_two_runs_do_not_share_a_folder() -> None:
    write_files(np.random.default_rng(1), "a")
    Path("out.boxes").mkdir()
    with open("out.boxes/lock", "w") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        with pytest.raises(sap.DatasetError, match="in use by another run"):
            sap.find_pairs("a.csv", by="chrom", out="out", workers=0)
    sap.find_pairs("a.csv", by="chrom", out="out", workers=0)
    assert not Path("out.boxes").exists()


def test_groups_of_floating_point_are_equal_as_in_memory() -> None:
    nan = float("nan")
    for groups in ([0.0, -0.0, 1.0, 1.0], [None, nan, 1.0, 1.0], [nan, None, 2.0, None], [0.0, 1.0, -0.0, 1.0]):
        table = pyarrow.table({"start": [0.0] * 4, "end": [1.0] * 4, "g": pyarrow.array(groups), "h": [7, 7, 8, 8]})
        pyarrow.parquet.write_table(table, "a.parquet")
        for by in ("g", ["g", "h"], ["h", "g"]):
            wanted = find_pairs(table, by=by)
            found = sap.find_pairs("a.parquet", by=by, out=f"out-{len(list(Path().iterdir()))}", workers=0).compute()
            assert np.array_equal(found.to_numpy(), wanted), (groups, by)


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main([*arguments, *LIMITED, *([] if arguments[0] == "count" else ["-o", "out"])]) == 1
    said = capsys.readouterr().err
    assert said.startswith("sap: ") and said.count("\n") == 1, said
    assert not list(Path().glob("out*"))
    return said


def test_what_cannot_be_done_is_one_clear_error(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("start,end,n\n" + "".join(f"{row},{row + 1},x\n" for row in range(400)))
    Path("bad.csv").write_text(Path("a.csv").read_text().replace("\n300,301", "\n300,299"))
    Path("word.csv").write_text(Path("a.csv").read_text().replace("\n300,301", "\n300,many"))
    Path("cut.csv").write_text(Path("a.csv").read_text() + "7\n")
    Path("large.csv").write_text("start,end\n0,9007199254740993\n")
    Path("a.bed").write_text("1\t0\t5\n" * 300 + "1\t5\n")
    Path("wide.bed").write_text("1\t0\t5\n" * 300 + "1\t5\t9\tname\n")
    Path("a.gtf").write_text('1\tx\texon\t1\t5\t.\t+\t.\tgene_id "a";\n' * 300)
    Path("b.npy").write_bytes(b"")
    Path("empty.csv").write_text("start,end\n")
    Path("plain.csv").write_text("a,0,1\nb,5,6\n")
    Path("deep.csv").write_text("minx,miny,minz,maxx,maxy,maxz,k\n0,0,0,1,1,1,x\n")
    for command, said in (
        (["pairs", "bad.csv"], "bad.csv, line 302: the box is inverted on axis 0: min 300"),
        (["pairs", "word.csv"], "word.csv, line 302, column end: 'many' is not a number"),
        (["pairs", "cut.csv"], "cut.csv, line 402: it has 1 column, where 3 are expected"),
        (["pairs", "large.csv"], "large.csv: coordinates beyond 2^53 are not exact"),
        (["pairs", "a.bed"], "a.bed, line 301: chrom, start and end are expected"),
        (["pairs", "wide.bed"], "wide.bed, line 301: it has 4 columns, where 3 are expected"),
        (["pairs", "a.gtf", "--by", "gene_i"], "a.gtf has no column and no attribute 'gene_i'"),
        (["pairs", "a.gtf", "--id", "gene_i"], "a.gtf has no column and no attribute 'gene_i'"),
        (["pairs", "a.csv", "--by", "no"], "a.csv has no column 'no'"),
        (["pairs", "b.npy"], "b.npy: --memory-limit reads files of text, Parquet files and folders of them"),
        (["pairs", "plain.csv"], "pass --header if it names the columns, or --no-header"),
        (
            ["pairs", "deep.csv", "--by", "k"],
            "deep.csv has boxes of three dimensions, which are grouped in memory only",
        ),
        (["join", "a.csv", "deep.csv"], "deep.csv has boxes of 3 dimensions, and others have 1"),
        (["join", "a.csv", "a.bed", "--by", "n"], "the formats of the files differ in whether ends belong"),
        (["join", "a.csv", "no.csv"], "no.csv"),
    ):
        assert said in refused(capsys, *command), command
    assert main(["count", "plain.csv", "--no-header", "--columns", "2,3", "--by", "1", *LIMITED]) == 0
    assert main(["count", "empty.csv", *LIMITED]) == main(["count", "a.csv", "empty.csv", *LIMITED]) == 0
    assert capsys.readouterr().out == "0\n0\n0\n"


def test_the_functions_take_groups_and_sides() -> None:
    Path("a.csv").write_text("k,s,e,n\n1,0,5,7\n2,0,5,8\n")
    Path("b.csv").write_text("group,from,to,id\n1.0,5,9,1\n3,0,9,2\n")
    given: dict[str, Any] = {"columns": (["s", "e"], ["from", "to"]), "by": ("k", "group"), "workers": 0}
    assert sap.count_pairs_between("a.csv", "b.csv", **given) == 1
    found = sap.find_pairs_between("a.csv", "b.csv", ids=("n", "id"), out="out", **given)
    assert found.compute().to_numpy().tolist() == [["7", "1"]]
    with pytest.raises(ValueError, match="pass out, a folder for the pairs"):
        sap.find_pairs("a.csv", columns=["s", "e"])
    with pytest.raises(ValueError, match="a tuple for two"):
        sap.count_pairs("a.csv", columns=["s", "e"], by=("k", "k"))  # type: ignore[arg-type]
    import dask.dataframe

    collection = dask.dataframe.from_pandas(pandas.DataFrame({"start": [0], "end": [1], "k": [2]}), npartitions=1)
    with pytest.raises(ValueError, match="write the collection to Parquet files first"):
        sap.count_pairs(collection, by="k")
