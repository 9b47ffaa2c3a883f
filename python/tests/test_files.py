"""Files as people have them: each gives the boxes that its format says, or one line that says what is wrong."""

from __future__ import annotations

import gzip
import importlib
import io
import json
import subprocess
import sys
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest

from sweep_and_prune import _text
from sweep_and_prune._columns import group_codes
from sweep_and_prune._command import main
from sweep_and_prune._file_error import FileError
from sweep_and_prune._tables import read

SAP = [sys.executable, "-m", "sweep_and_prune"]


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def boxes_of(name: str, *columns: str, format: str = "xyxy", **options: Any) -> list[list[float]]:
    found: list[list[float]] = read(name, **options).boxes(columns, format).array.tolist()
    return found


def said(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """What a call prints that must succeed."""
    assert main(arguments) == 0, capsys.readouterr().err
    return capsys.readouterr().out


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(arguments) == 1
    captured = capsys.readouterr()
    assert captured.out == "" and captured.err.count("\n") == 1
    return captured.err.removeprefix("sap: ")


# Headers.


@pytest.mark.parametrize("width", [2, 4, 6])
def test_a_header_of_numbers_is_asked_for(width: int, capsys: pytest.CaptureFixture[str]) -> None:
    boxes = np.tile(np.repeat([0, 9], width // 2), (3, 1))
    header = ",".join(map(str, range(width)))
    rows = "\n".join(",".join(map(str, row)) for row in boxes.tolist())
    Path("a.csv").write_text(f"{header}\n{rows}\n")
    for command in (["count"], ["pairs"], ["stats"]):
        assert refused(capsys, *command, "a.csv").startswith(f"a.csv begins with {header}, which may be a box, or")
    assert said(capsys, "count", "a.csv", "--header", "--columns", header) == "3\n"
    assert said(capsys, "count", "a.csv", "--no-header") == "6\n"
    pandas = pytest.importorskip("pandas")
    pandas.DataFrame(boxes).to_csv("b.csv")  # with a column for the index, whose name is empty
    assert "b.csv begins with a row of text and numbers (, 0, 1" in refused(capsys, "count", "b.csv")
    assert said(capsys, "count", "b.csv", "--header", "--columns", header) == "3\n"


def test_a_first_column_of_text_needs_no_guess(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("cat,0,0,2,2\ndog,1,1,3,3\ncat,2,2,4,4\n")
    message = refused(capsys, "count", "a.csv")
    assert "(cat, 0, 0, 2, 2): pass --header if it names the columns, or --no-header, which numbers them" in message
    chosen = ["a.csv", "--no-header", "--columns", "2,3,4,5"]
    assert said(capsys, "count", *chosen) == "3\n"
    assert said(capsys, "pairs", *chosen, "--by", "1", "--id", "1") == "a,b\ncat,cat\n"
    assert "a.csv has no header and 5 columns; boxes have 2, 4 or 6" in refused(capsys, "count", "a.csv", "--no-header")
    assert "2 columns '0'" in refused(capsys, "count", "a.csv", "--header", "--columns", "0,0,2,2")
    # Numbers among names that are known are names.
    Path("a.csv").write_text("name,2024,start,end\na,5,0,1\nb,6,1,2\n")
    assert said(capsys, "pairs", "a.csv", "--id", "2024") == "a,b\n5,6\n"


def test_comments_are_left_out() -> None:
    Path("a.csv").write_text('# made by "x\n#\n#again, 5\nstart,end,name\n0,1,#1\n# 5, 6\n2,3,b\n')
    assert boxes_of("a.csv") == [[0, 1], [2, 3]]
    assert read("a.csv").values.text("name") == ["#1", "b"]
    assert read("a.csv").place(1) == "a.csv, line 7"
    Path("a.tsv").write_text("#chrom\tstart\tend\n1\t0\t1\n")
    assert boxes_of("a.tsv") == [[0, 1]] and read("a.tsv").columns == ["chrom", "start", "end"]


@pytest.mark.parametrize(
    "names", ["start,stop", "begin,end", "start_time,end_time", "Start_Date,end_date", "start,end"]
)
def test_names_of_intervals_are_known(names: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text(f"{names}\n0,1\n1,2\n")
    assert said(capsys, "count", "a.csv") == "1\n"
    if names != "start,end":
        Path("a.csv").write_text(f"start,end,{names.replace('end', 'END_')}\n0,1,5,6\n")
        assert "a.csv: the columns start" in refused(capsys, "count", "a.csv")


# Genomics.

GENES = (
    "#c\nchr1\tx\texon\t11\t20\t.\t+\t.\t{}\nchr1\tx\tgene\t21\t21\t.\t+\t.\t{}\n\nchr2\tx\texon\t1\t20\t.\t-\t0\t\n"
)
OF_GTF = 'gene_id "g 1"; exon_number 2;', 'exon_number 3; note "a; gene_id 5"; gene_id "g2";'
OF_GFF3 = "ID=e1;gene_id=g%201;Parent=a,b", "gene_id=g2 ;ID=e2"
GENOMIC = {
    "a.bed": ("browser position chr1\ntrack name=x\n#c\nchr1\t10\t20\nchr1\t20\t21\nchr2\t0\t20\n", []),
    "a.bed.gz": ("chr1\t10\t20\r\nchr1\t20\t21\r\nchr2\t0\t20\r\n", []),
    "a.bed.bgz": ("chr1\t10\t20\nchr1\t20\t21\nchr2\t0\t20\n", []),
    "a.narrowPeak": (
        "chr1\t10\t20\tp\t9\t.\t1.5\t2\t3\t4\nchr1\t20\t21\tq\t9\t.\t1.5\t2\t3\t-1\nchr2\t0\t20\tr\t9\t.\t1\t2\t3\t0\n",
        [("peak", ["4", "-1", "0"]), ("signalValue", ["1.5", "1.5", "1"])],
    ),
    "a.broadPeak": (
        "chr1\t10\t20\tp\t9\t.\t1\t2\t3\nchr1\t20\t21\tq\t9\t.\t1\t2\t3\nchr2\t0\t20\tr\t9\t.\t1\t2\t3\n",
        [],
    ),
    "a.bg": ("chr1\t10\t20\t0.5\nchr1\t20\t21\t7\nchr2\t0\t20\t8\n", [("value", ["0.5", "7", "8"])]),
    "a.bedGraph": ("chr1\t10\t20\t0.5\nchr1\t20\t21\t7\nchr2\t0\t20\t8\n", [("value", ["0.5", "7", "8"])]),
    "a.gtf": (GENES.format(*OF_GTF), [("gene_id", ["g 1", "g2", ""]), ("exon_number", ["2", "3", ""])]),
    "a.gff3": (
        "##gff-version 3\n" + GENES.format(*OF_GFF3) + "##FASTA\n>chr1\nACGT\n",
        [("gene_id", ["g 1", "g2", ""]), ("ID", ["e1", "e2", ""]), ("feature", ["exon", "gene", "exon"])],
    ),
    "a.vcf": (
        "##fileformat=VCFv4.3\n#CHROM\tPOS\tID\tREF\tALT\tQUAL\tFILTER\tINFO\n"
        "chr1\t11\trs1\tACGTACGTAC\tA\t.\t.\tDP=3\nchr1\t21\trs2\tA\tT\t.\t.\t.\nchr2\t1\tsv\tA\t<DEL>\t.\t.\tX=1;END=20\n",
        [("id", ["rs1", "rs2", "sv"])],
    ),
}


@pytest.mark.parametrize("name", GENOMIC)
def test_formats_of_genomics_have_the_intervals_of_bed(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    text, labels = GENOMIC[name]
    data = text.encode()
    Path(name).write_bytes(gzip.compress(data[:30]) + gzip.compress(data[30:]) if name.endswith("gz") else data)
    assert boxes_of(name) == [[10, 20], [20, 21], [0, 20]]
    source = read(name)
    for label, values in labels:
        assert source.label(label)[np.arange(len(source))].tolist() == values
    Path("b.bed").write_text("chr1\t19\t20\tx\nchr2\t20\t30\ty\nchr1\t20\t21\tz\n")
    assert said(capsys, "join", name, "b.bed") == "a,b\n0,0\n1,2\n"
    assert said(capsys, "count", name, "b.bed", "--closed", "both") == "5\n"
    if not name.endswith(("gz", "bg")):
        kind = name.split(".")[1].lower()
        done = subprocess.run([*SAP, "join", "-", "b.bed", "--from", kind], input=data, capture_output=True)
        assert (done.stdout, done.stderr) == (b"a,b\n0,0\n1,2\n", b"")


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        (
            "a.gtf",
            "chr1\tx\texon\t1\n",
            "a.gtf, line 1: chrom, source, feature, start, end, score, strand and frame are",
        ),
        ("a.vcf", "chr1\tabc\tx\tA\tC\n", "a.vcf, line 1, column start: 'abc' is not a number"),
        ("a.vcf", "chr1\t5\tx\tAC\n", "a.vcf, line 1: chrom, pos, id, ref and alt are expected, separated by tabs"),
        ("a.gff3", "c\tx\texon\t9\t5\t.\t+\t.\t\n", "a.gff3, line 1: the end, 5, is before the start, 9"),
        ("a.bed", "c\t.\t5\n", "a.bed, line 1, column start: there is no number"),
        ("a.bedGraph", "chr1 0 10 5\n", "a.bedGraph, line 1: chrom, start and end are expected, separated by tabs"),
        ("a.bed", "chrom\tstart\tend\n", "a.bed, line 1, column start: 'start' is not a number: is this a header?"),
        ("a.bed", "chr1\tabc\t5\n", "a.bed, line 1, column start: 'abc' is not a number\n"),
        (
            "a.bed",
            "chr1\tx\texon\t1\t9\t.\t+\t.\t\n",
            "a.bed, line 1, column start: 'x' is not a number: is this GTF or GFF? Name it .gtf or .gff3",
        ),
        ("a.bed", "c\t-3\t5\n", "a.bed, line 1, column start: it is -3; positions in this format count from 0"),
        ("a.gtf", "c\tx\texon\t0\t5\t.\t+\t.\t\n", "a.gtf, line 1, column start: it is 0; positions in this format"),
        ("a.gff3", "c\tx\tx\t1\t5\t.\t+\t.\nc\tx\tx\t-2\t5\t.\t+\t.\n", "a.gff3, line 2, column start: it is -2; pos"),
        ("a.vcf", "chr1\t-1\tx\tA\tC\n", "a.vcf, line 1, column start: it is -1; positions in this format"),
    ],
)
def test_what_is_wrong_with_a_file_of_genomics_is_said(
    name: str, text: str, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    Path(name).write_text(text)
    assert refused(capsys, "count", name).startswith(message)


@pytest.mark.parametrize("size", [10, 1000, None])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lines_of_genomics_have_as_many_columns_as_the_first(size: int | None, end: str) -> None:
    def columns(*more: str) -> list[str]:
        data = "".join(f"{line}{end}" for line in ("#c", *(f"c\t1\t5{one}" for one in more))).encode()
        if size is None:
            return _text.read_genomic("a.bed", data, "bed").columns
        parts = [*_text.genomic_parts("a.bed", io.BytesIO(data), "bed", size)]
        assert sum(map(len, parts)) == len(more)
        (found,) = {(*part.columns,) for part in parts}
        return [*found]

    assert columns("", "", "") == ["chrom", "start", "end"]
    all_of_bed = "\tn\t0\t+" + 6 * "\tx"
    assert columns(*[f"{all_of_bed}\t13\t14"] * 2) == [*_text.GENOMIC["bed"].columns, "13", "14"]
    for first, other in (("", "\tn"), ("\tn", ""), ("\tn", "\tn\t0\t+"), (all_of_bed, f"{all_of_bed}\t13"), ("", "\t")):
        found, wanted = (3 + one.count("\t") for one in (other, first))
        with pytest.raises(FileError) as error:
            columns(first, first, first, other)
        assert error.value.message == f"a.bed, line 5: it has {found} columns, where {wanted} are expected"


def test_rows_of_genomics_have_all_columns(capsys: pytest.CaptureFixture[str]) -> None:
    Path("b.bed").write_text("c\t0\t90\n")
    for name, line, columns in (
        ("a.narrowPeak", "c\t5\t9\tp\t9\t.\t1\t2\t3\t4\tX\tY", ["peak", "11", "12"]),
        ("a.bedGraph", "c\t5\t9\t1\tX", ["value", "5"]),
        ("a.gtf", 'c\tx\texon\t5\t9\t.\t+\t.\tgene_id "a";\tX', ["attributes", "10"]),
        ("a.vcf", "c\t5\tid\tA\tC\t.\t.\tDP=3\tGT\t0/1\t1/1", ["info", "format", "10", "11"]),
    ):
        Path(name).write_text(f"{line}\n")
        assert read(name).columns[-len(columns) :] == columns
        header, row = said(capsys, "join", name, "b.bed", "--rows", "--to", "tsv").split("\n")[:2]
        assert header.count("\t") == row.count("\t")
        without_quotes = [text.replace('"', "").split("\t") for text in (line, row)]
        assert [cell for cell in without_quotes[0] if cell not in without_quotes[1]] == []


def test_columns_of_a_file_without_a_header_have_numbers(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.bed").write_text("c\t0\t5\tx\nc\t5\t9\tx\n")
    Path("a.gtf").write_text("c\ty\texon\t1\t5\t.\t+\t.\t\nc\ty\texon\t5\t9\t.\t+\t.\t\n")
    Path("a.vcf").write_text("c\t5\tid\tAC\tC\nc\t6\tid\tA\tC\n")
    Path("a.csv").write_text("start,end\n0,5\n")
    np.save("a.npy", np.array([[7, 0, 0, 5, 5], [7, 1, 1, 6, 6], [8, 0, 0, 5, 5]]))
    assert boxes_of("a.bed", "2", "3") == [[0, 5], [5, 9]] and boxes_of("a.gtf", "4", "5") == [[0, 5], [4, 9]]
    assert said(capsys, "pairs", "a.vcf", "--id", "2,4") == "a_2,a_4,b_2,b_4\n5,AC,6,A\n"
    assert said(capsys, "count", "a.bed", "--by", "4", "--closed", "both") == "1\n"
    assert said(capsys, "pairs", "a.npy", "--columns", "2,3,4,5", "--by", "1") == "a,b\n0,1\n"
    assert "a.npy has no column 6; it has 5 columns" in refused(capsys, "count", "a.npy", "--columns", "1,6")
    assert "a.bed has no column '5'" in refused(capsys, "count", "a.bed", "--columns", "2,5")
    message = refused(capsys, "count", "a.csv", "--columns", "1,2")
    assert message == "a.csv has no column '1'; numbers are for files without a header; its columns are start, end\n"


@pytest.mark.parametrize("name", ["a.gtf", "a.gff3"])
def test_an_attribute_that_no_row_has_is_refused(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    Path(name).write_text(GENOMIC[name][0])
    for command in (["pairs", name, "--id", "gene_idd"], ["count", name, "--by", "chrom,gene_i"]):
        message = refused(capsys, *command)
        assert message.startswith(f"{name} has no column and no attribute '{command[-1].split(',')[-1]}'; its columns")
        assert "gene_id" in message.split("attributes, ")[1]
    assert said(capsys, "pairs", name, "--id", "gene_id") == "a,b\n"
    with open(name, "rb") as file:
        codes = [part.group("gene_id").kinds() for part in _text.genomic_parts(name, file, name[2:], 10)]
    assert set() in codes and {"text"} in codes, "a part may have none"
    with open(name, "rb") as file, pytest.raises(FileError, match=f"{name} has no column and no attribute 'gene_idd'"):
        for part in _text.genomic_parts(name, file, name[2:], 10):
            part.label("gene_idd")
    Path(name).write_text("")
    assert said(capsys, "pairs", name, "--id", "gene_idd") == "a,b\n"


@pytest.mark.parametrize("is_fast", [True, False])
@pytest.mark.parametrize(
    ("alleles", "info", "end"),
    [
        ("<DEL>", "SVTYPE=DEL;SVLEN=-100", 150),
        ("<DUP:TANDEM>", "SVLEN=100", 150),
        ("<INV>", "SVLEN=+20", 70),
        ("<CNV:TR>,<DEL>", "SVLEN=-100,-200", 250),
        ("<DEL>,<DEL>", "SVLEN=-100", 150),
        ("<INS>,<DEL>", "SVLEN=500,-20", 70),
        ("<DEL>", "END=60;SVLEN=-100", 60),
        ("<DEL>", "XSVLEN=9;SVLEN=.", 51),
        ("<INS>", "SVLEN=100", 51),
        ("<DELX>", "SVLEN=100", 51),
        ("A", "SVLEN=100", 51),
        ("<DEL>", f"SVLEN={10**20}", 50 + 10**20),
    ],
)
def test_a_variant_may_name_its_length(alleles: str, info: str, end: int, is_fast: bool) -> None:
    before = "" if is_fast else "#\r"  # such an end of a line is left to the slow reader
    data = f"{before}c\t50\tx\tNN\t{alleles}\t.\t.\t{info}\n".encode()
    table = _text.read_genomic("a.vcf", data, "vcf")
    assert isinstance(table, _text.Lines) == (is_fast and end < 10**18)
    assert [*table["start"].tolist(), *table["end"].tolist()] == [49, end]


def test_a_point_is_no_group_in_genomics(capsys: pytest.CaptureFixture[str]) -> None:
    rows = [("c", 0, 9, "a", 1, "."), ("c", 0, 9, "b", ".", "."), ("c", 0, 9, "c", 1, "+"), ("c", 0, 9, "d", 1, "+")]
    Path("a.bed").write_text("".join("\t".join(map(str, row)) + "\n" for row in rows))
    Path("a.csv").write_text("start,end,score,strand\n0,9,1.0,.\n0,9,1.0,.\n")
    for file in (["a.bed"], ["a.bed", "a.bed", "--how", "anti"]):
        command = "pairs" if len(file) == 1 else "join"
        found = said(capsys, command, *file, "--by", "chrom,strand", "--id" if len(file) == 1 else "--left-id", "name")
        assert found == ("a,b\nc,d\n" if len(file) == 1 else "a\na\nb\n")
    assert said(capsys, "count", "a.bed", "a.csv", "--by", "score", "--closed", "both") == "6\n"
    assert said(capsys, "count", "a.csv", "--by", "strand") == "1\n", "elsewhere it may be a name"


def test_compressed_files_are_told_by_their_names(capsys: pytest.CaptureFixture[str]) -> None:
    documents = {"a.json": b"[]", "a.bed": b"c\t0\t5\nc\t1\t5\n", "a.csv": b"start,end\n0,5\n"}
    for name, data in documents.items():
        Path(name).write_bytes(gzip.compress(data))
        assert refused(capsys, "count", name) == f"{name} is compressed with gzip: name it {name}.gz\n"
        Path(name).rename(f"{name}.gz")
        said(capsys, "count", f"{name}.gz")
    data = Path("a.csv.gz").read_bytes()
    done = subprocess.run([*SAP, "count", "-"], input=data, capture_output=True)
    assert done.stderr == b"sap: standard input is compressed with gzip: unpack it, as by gzip -dc\n"
    Path("a.npy.gz").write_bytes(data)
    assert "a.npy.gz is compressed, and only text is read so" in refused(capsys, "count", "a.npy.gz")


def test_a_header_of_a_format_without_one_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.bed").write_text("c\t0\t5\n")
    message = refused(capsys, "count", "a.bed", "--header")
    assert message == "a.bed is of a format whose lines have no header: leave out --header\n"
    assert said(capsys, "count", "a.bed", "--no-header") == "0\n"
    Path("b.csv").write_text("chrom,start,end\nc,4,9\n")
    arguments = ["count", "a.bed", "b.csv", "--header", "--closed", "left", "--by", "chrom"]
    assert said(capsys, *arguments) == "1\n"
    pytest.importorskip("distributed")
    limited = ["--memory-limit", "1GB", "--workers", "0", "--quiet"]
    assert said(capsys, *arguments, *limited) == "1\n"
    assert "a.bed is of a format whose lines have no header" in refused(capsys, "count", "a.bed", "--header", *limited)


# Arrow.


def test_arrow_of_a_pipe_is_read_from_a_file(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("pyarrow")
    Path("a.csv").write_text("start,end\n0,5\n3,8\n20,30\n")
    written = subprocess.run([*SAP, "merge", "a.csv", "--to", "arrow"], capture_output=True)
    for name in ("a.arrow", "a.feather"):
        Path(name).write_bytes(written.stdout)
        assert boxes_of(name) == [[0, 8], [20, 30]]
    Path("a.arrow").write_text("start,end\n0,5\n")
    assert refused(capsys, "count", "a.arrow").startswith("a.arrow cannot be read: ")


# Arrays of NumPy.


def test_an_array_of_numpy_may_have_named_columns(capsys: pytest.CaptureFixture[str]) -> None:
    rows = np.array([(5, 0, 1), (8, 3, 1), (9, 4, 2)], [("end", "i4"), ("start", "i4"), ("n", "i4")])
    np.save("a.npy", rows)
    assert said(capsys, "count", "a.npy") == "3\n"
    assert said(capsys, "pairs", "a.npy", "--by", "n", "--id", "end,n") == "a_end,a_n,b_end,b_n\n5,1,8,1\n"
    assert boxes_of("a.npy", "start", "n") == [[0, 1], [3, 1], [4, 2]]
    assert "a.npy has no column 'x'; its columns are end, start, n" in refused(capsys, "count", "a.npy", "--by", "x")
    np.save("a.npy", rows[["n"]])
    assert "a.npy has no columns that are known as boxes" in refused(capsys, "count", "a.npy")


def test_what_is_wrong_with_an_array_of_numpy_is_said(capsys: pytest.CaptureFixture[str]) -> None:
    np.save("a.npy", np.array([[0, 1], [None, 2]], object), allow_pickle=True)
    assert refused(capsys, "count", "a.npy").startswith("a.npy holds Python objects, not numbers")
    np.save("a.npy", np.zeros((99, 4)))
    np.savez("a.npz", np.zeros((99, 4)))
    for name in ("a.npy", "a.npz"):
        Path(name).write_bytes(Path(name).read_bytes()[:300])
        assert refused(capsys, "count", name).startswith(f"{name} is not all of an array of NumPy: was the file cut")
    done = subprocess.run([*SAP, "count", "-", "--from", "npy"], input=Path("a.npy").read_bytes(), capture_output=True)
    assert b"standard input is not all of an array of NumPy" in done.stderr


# JSON.


def point(x: int, name: str) -> dict[str, Any]:
    return {"type": "Feature", "properties": {"n": name}, "geometry": {"type": "Point", "coordinates": [x, 1]}}


def test_geojson_is_read_in_each_of_its_forms(capsys: pytest.CaptureFixture[str]) -> None:
    features = [point(0, "a"), point(0, "b"), point(2, "c")]
    collection = {"type": "FeatureCollection", "features": features}
    texts = {
        "a.geojson": json.dumps(collection, indent=1),
        "b.geojson": "\ufeff" + json.dumps(collection),
        "a.geojsonl": "\n".join(map(json.dumps, features)) + "\n",
        "a.ndjson": "\r\n\r\n".join(map(json.dumps, features)),
        "a.geojsons": "".join(f"\x1e{json.dumps(feature, indent=None)}\n" for feature in features),
        "a.json": json.dumps(features),
    }
    for name, text in texts.items():
        Path(name).write_bytes(text.encode())
        assert boxes_of(name) == [[0, 1, 0, 1], [0, 1, 0, 1], [2, 1, 2, 1]]
        assert said(capsys, "pairs", name, "--id", "n") == "a,b\na,b\n"
    for name, document in (("one.geojson", features[2]), ("shape.geojson", features[2]["geometry"])):
        Path(name).write_text(json.dumps(document))
        assert boxes_of(name) == [[2, 1, 2, 1]]
    done = subprocess.run(
        [*SAP, "count", "-", "--from", "json"], input=texts["a.geojsonl"], capture_output=True, text=True
    )
    assert (done.stdout, done.stderr) == ("1\n", "")
    Path("a.geojsonl").write_text(texts["a.geojsonl"] + '{"x":\n')
    assert refused(capsys, "count", "a.geojsonl").startswith("a.geojsonl, line 4: it is not JSON (")
    Path("a.geojson").write_text(json.dumps(collection) + "garbage")
    assert refused(capsys, "count", "a.geojson") == "a.geojson, line 1: it is not JSON (Extra data)\n"
    Path("a.geojson").write_text(json.dumps(collection))
    Path("a.topojson").write_text('{"type": "Topology", "objects": {}, "arcs": []}')
    assert "a.topojson is TopoJSON: convert it to GeoJSON first" in refused(capsys, "count", "a.topojson")
    message = refused(capsys, "count", "a.geojson", "--format", "xywh")
    assert message == "a.geojson is of a format that says where boxes begin and end: leave out --format\n"


def test_boxes_may_be_properties_of_shapes(capsys: pytest.CaptureFixture[str]) -> None:
    point = {"type": "Point", "coordinates": [0, 0]}
    features = [
        {"type": "Feature", "properties": {"from": start, "to": end}, "geometry": point}
        for start, end in ((0, 3), (2, 2**53 + 1), (4, None))
    ]
    Path("a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    assert said(capsys, "count", "a.geojson") == "3\n"
    assert said(capsys, "pairs", "a.geojson", "--columns", "from,to", "--missing", "skip") == "a,b\n0,1\n"
    message = refused(capsys, "count", "a.geojson", "--columns", "from,to")
    assert message.startswith("a.geojson, feature 2 (the first is 0), column to: the box has a NaN")
    message = refused(capsys, "count", "a.geojson", "--columns", "from,end")
    assert message == "a.geojson has no column 'end'; its columns are from, to, id\n"


def test_detections_of_coco_pair_within_their_image(capsys: pytest.CaptureFixture[str]) -> None:
    rows = [(1, 1, [0, 0, 2, 2]), (1, 2, [1, 1, 2.5, 2]), (2, 1, [1, 1, 1, 1]), (1, 1, [2, 2, 1, 1])]
    annotations = [
        {"id": 10 + at, "image_id": image, "category_id": kind, "bbox": box, "segmentation": [[1, 2]]}
        for at, (image, kind, box) in enumerate(rows)
    ]
    for document in ({"images": [], "annotations": annotations}, annotations):
        Path("a.json").write_text(json.dumps(document))
        assert boxes_of("a.json") == [[0, 0, 2, 2], [1, 1, 3.5, 3], [1, 1, 2, 2], [2, 2, 3, 3]]
        assert sorted(said(capsys, "pairs", "a.json", "--id", "id").split()[1:]) == ["10,11", "10,13", "11,13"]
        assert said(capsys, "pairs", "a.json", "--by", "image_id,category_id") == "a,b\n0,3\n"
    Path("b.csv").write_text("image_id,x,y,width,height\n2,0,0,1,1\n1,3,2,1,1\n")
    assert sorted(said(capsys, "join", "a.json", "b.csv", "--format", "xywh", "--by", "image_id").split()[1:]) == [
        *("1,1", "2,0", "3,1"),
    ]
    assert said(capsys, "join", "a.json", "a.json", "--left-id", "bbox", "--right-id", "id").split("\n")[1] == (
        '"[0, 0, 2, 2]",10'
    )
    header = said(capsys, "pairs", "a.json", "--rows").split("\n")[0]
    assert header.startswith("a_bbox,a_category_id,a_id,a_image_id,a_segmentation,b_bbox")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bbox": [1, 2, 3]}, "its bbox has 3 items, not 4 numbers"),
        ({"bbox": [1, 2, "3", 4]}, 'its bbox has "3", which is not a number'),
        ({"bbox": "1,2,3,4"}, 'its bbox is "1,2,3,4", not a list of 4 numbers'),
        ({"bbox": ...}, "it has no bbox"),
        ({"bbox": None}, "the box has a NaN on axis 0 (min nan, max nan): remove it, or pass --missing skip"),
        ({"bbox": [0, 1, None, 4]}, "the box has a NaN on axis 0 (min 0, max nan): remove it, or pass --missing skip"),
        ({"image_id": ...}, "it has no image_id"),
        ({"image_id": None}, "its image_id is null, not a number or text"),
        ({"image_id": [7]}, "its image_id is [7], not a number or text"),
    ],
)
def test_what_is_wrong_with_a_detection_is_said(
    change: dict[str, Any], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    good = {"image_id": 7, "bbox": [0, 0, 2, 2]}
    bad = {key: value for key, value in {**good, **change}.items() if value is not ...}
    for rows in ([good, bad, good], [bad, good, good]):
        for document in (rows, {"annotations": rows}):
            Path("a.json").write_text(json.dumps(document))
            found = refused(capsys, "count", "a.json")
            assert found == f"a.json, annotation {rows.index(bad)} (the first is 0): {message}\n"
        if "NaN" in message:
            assert said(capsys, "count", "a.json", "--missing", "skip") == "1\n"


def test_a_detector_may_find_nothing(capsys: pytest.CaptureFixture[str]) -> None:
    Path("b.json").write_text(json.dumps([{"image_id": 7, "bbox": [0, 0, 2, 2]}]))
    for document in ("[]", '{"images": [], "annotations": []}'):
        Path("a.json").write_text(document)
        assert said(capsys, "pairs", "a.json") == "a,b\n"
        assert said(capsys, "join", "a.json", "b.json") == said(capsys, "join", "b.json", "a.json") == "a,b\n"


def test_ids_that_are_written_otherwise_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    def write(name: str, *ids: Any) -> None:
        Path(name).write_text(json.dumps([{"image_id": one, "bbox": [0, 0, 2, 2]} for one in ids]))

    write("mixed.json", 1, "2", 3)
    write("numbers.json", 1, 2, 3)
    write("both.json", 12, "12")
    write("text.json", "1", "2", "12a")
    write("words.json", 12, "12a")
    Path("text.csv").write_text("image_id,x,y,width,height\n12,0,0,1,1\n12a,0,0,1,1\n")
    Path("padded.csv").write_text("image_id,x,y,width,height\n0001,0,0,1,1\n12,0,0,1,1\n")
    Path("plain.csv").write_text("image_id,x,y,width,height\n1,0,0,1,1\n12,0,0,1,1\n")
    options = ["--by", "image_id", "--format", "xywh"]
    assert said(capsys, "count", "words.json", "words.json") == "2\n", "of one kind each"
    assert said(capsys, "count", "text.json", "plain.csv", *options) == "1\n"
    assert said(capsys, "count", "mixed.json") == "0\n"
    for files, own, other in (
        (["mixed.json", "numbers.json"], "'2'", "2"),
        (["words.json", "text.csv", *options], "12", "'12'"),
        (["both.json"], "'12'", "12"),
        (["padded.csv", "plain.csv", *options], "'0001'", "'1'"),
        (["plain.csv", "padded.csv", *options], "'1'", "'0001'"),
        (["text.json", "padded.csv", *options], "'1'", "'0001'"),
    ):
        message = refused(capsys, "count", *files)
        places = [files[0], files[1] if len(files) > 1 else files[0]]
        assert message == (
            f"{places[0]} has {own} in column image_id, and {places[1]} has {other} there: write the values alike\n"
        )
    arrow = pytest.importorskip("pyarrow")
    table = arrow.table({"image_id": ["0001"], "x": [0], "y": [0], "w": [5], "h": [5]})
    importlib.import_module("pyarrow.parquet").write_table(table, "a.parquet")
    message = refused(capsys, "count", "a.parquet", "plain.csv", *options)
    assert message.startswith("a.parquet has '0001' in column image_id, and plain.csv has '1' there")


def test_columns_of_trackers_are_chosen_by_number(capsys: pytest.CaptureFixture[str]) -> None:
    # MOT: frame, id, left, top, width, height, confidence, ..; YOLO: class, center, size.
    Path("det.txt").write_text("1,7,10,10,5,5,0.9,-1,-1,-1\n1,8,15,15,5,5,0.8,-1,-1,-1\n2,7,15,15,5,5,0.8,-1,-1,-1\n")
    message = refused(capsys, "count", "det.txt")
    assert "det.txt has no header and 10 columns; boxes have 2, 4 or 6: choose columns by --columns 1,2,.." in message
    chosen = ["det.txt", "--columns", "3,4,5,6", "--format", "xywh"]
    assert said(capsys, "pairs", *chosen, "--by", "1", "--id", "2") == "a,b\n7,8\n"
    assert said(capsys, "count", *chosen) == "3\n"
    Path("frame.txt").write_text("0 0.5 0.5 0.2 0.2\n1 0.75 0.5 0.125 0.5\n0 0.65 0.5 0.2 0.2\n")
    assert said(capsys, "count", "frame.txt", "--columns", "2,3,4,5", "--format", "cxcywh") == "2\n"
    Path("names.txt").write_text("car 0.5 0.5 0.2 0.2\ncar 0.65 0.5 0.2 0.2\n")
    assert "pass --header" in refused(capsys, "count", "names.txt", "--columns", "2,3,4,5")


# Standard input, and both files of a join.


@pytest.mark.parametrize("kind", ["csv", "tsv", "npy", "npz", "parquet", "arrow", "stream"])
def test_standard_input_has_any_format(kind: str) -> None:
    boxes = np.array([[0.0, 1], [1, 2], [5, 6]])
    buffer: Any = io.BytesIO()
    if kind in ("csv", "tsv"):
        np.savetxt(buffer, boxes, delimiter="," if kind == "csv" else "\t", header="xmin xmax"[:0], comments="")
        buffer = io.BytesIO(buffer.getvalue().strip())
    elif kind == "npy":
        np.save(buffer, boxes)
    elif kind == "npz":
        np.savez(buffer, boxes=boxes)
    else:
        arrow = pytest.importorskip("pyarrow")
        table = arrow.table({"start": boxes[:, 0], "end": boxes[:, 1]})
        if kind == "parquet":
            importlib.import_module("pyarrow.parquet").write_table(table, buffer)
        else:
            with (arrow.ipc.new_file if kind == "arrow" else arrow.ipc.new_stream)(buffer, table.schema) as file:
                file.write_table(table)
    name = {"npz": "npy", "stream": "arrow"}.get(kind, kind)
    done = subprocess.run([*SAP, "count", "-", "--from", name], input=buffer.getvalue(), capture_output=True)
    assert (done.stdout, done.stderr) == (b"1\n", b"")
    np.save("b.npy", boxes)
    done = subprocess.run([*SAP, "count", "b.npy", "-", "--from", name], input=buffer.getvalue(), capture_output=True)
    assert (done.stdout, done.stderr) == (b"5\n", b"")


def test_standard_input_is_read_once(capsys: pytest.CaptureFixture[str]) -> None:
    assert "standard input can be read once" in refused(capsys, "join", "-", "-")


def test_each_file_has_its_own_columns_and_groups(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("p,q,kind,of\n0,1,x,1\n5,6,y,2\n")
    Path("b.csv").write_text("from,to,sort,by\n6,9,y,2.0\n1,2,x,1.0\n5,5,z,9.0\n")
    files = ["a.csv", "b.csv", "--left-columns", "p,q", "--right-columns", "from,to"]
    assert said(capsys, "count", *files) == "3\n"
    assert said(capsys, "join", *files, "--left-by", "kind", "--right-by", "sort") == "a,b\n0,1\n1,0\n"
    assert said(capsys, "join", *files, "--left-by", "kind,of", "--right-by", "sort,by") == "a,b\n0,1\n1,0\n"
    assert "must name as many columns" in refused(capsys, "join", *files, "--left-by", "kind,of", "--right-by", "sort")
    message = refused(capsys, "join", *files, "--by", "kind", "--right-by", "sort")
    assert message == "pass --by, or --left-by and --right-by\n"
    Path("b.csv").write_text("from,to\n6,9\n2,1\n")
    message = refused(capsys, "count", *files)
    assert message.startswith("b.csv, line 3, columns from and to: the box is inverted")


# Coordinate reference systems.


def test_files_of_different_coordinate_reference_systems_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")

    def write(name: str, crs: str | None, **options: Any) -> str:
        frame = geopandas.GeoDataFrame({"n": [1, 2]}, geometry=shapely.box([0, 5], 0, [1, 6], 1), crs=crs)
        if name.endswith("parquet"):
            frame.to_parquet(name, **options)
        else:
            frame.to_file(name)
        return name

    degrees = [write("a.parquet", "EPSG:4326"), write("b.parquet", "OGC:CRS84", write_covering_bbox=True)]
    degrees += [write("a.geojson", "EPSG:4326"), write("a.gpkg", "EPSG:4326"), write("c.parquet", None)]
    meters = [write("d.parquet", "EPSG:25832"), write("e.parquet", "EPSG:25832", write_covering_bbox=True)]
    meters += [
        write("b.geojson", "EPSG:25832"),
        write("d.shp", "EPSG:25832"),
        write("d.fgb", "EPSG:25832"),
        "c.parquet",
    ]
    for group in (degrees, meters):
        for first in group:
            for second in group:
                assert said(capsys, "count", first, second) == "2\n", (first, second)
    for first in degrees[:-1]:
        for second in meters[:-1]:
            message = refused(capsys, "join", first, second)
            assert message.startswith(f"{first} and {second} have different coordinate reference systems, "), message
            assert "EPSG:25832" in message
    pytest.importorskip("distributed")
    import sweep_and_prune.dask as dask

    with pytest.raises(ValueError, match="different coordinate reference systems, EPSG:4326 and EPSG:25832"):
        dask.count_pairs_between("a.parquet", "e.parquet", workers=0, progress=False)
    assert dask.count_pairs_between("a.parquet", "b.parquet", workers=0, progress=False) == 2
    with pytest.raises(dask.DatasetError, match=r"a\.parquet and d\.parquet have different coordinate"):
        dask.count_pairs_between(["a.parquet", "d.parquet"], "a.parquet", workers=0, progress=False)


def test_files_of_gis_are_read_with_their_attributes(capsys: pytest.CaptureFixture[str]) -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    shapes = [shapely.box(0, 0, 1, 1), None, shapely.Polygon(), shapely.Point(1, 1)]
    frame = geopandas.GeoDataFrame({"n": list("abcd")}, geometry=shapes, crs="EPSG:25832")
    for name in ("a.gpkg", "a.fgb", "a.shp"):
        (frame if name == "a.gpkg" else frame.iloc[[0]]).to_file(name)
    assert said(capsys, "pairs", "a.gpkg", "--missing", "skip", "--id", "n") == "a,b\na,d\n"
    for name in ("a.fgb", "a.shp"):
        assert boxes_of(name) == [[0, 0, 1, 1]]


@pytest.mark.parametrize("name", ["a.gpkg", "a.fgb", "a.shp"])
def test_integers_of_gis_are_not_rounded_because_others_are_missing(
    name: str, capsys: pytest.CaptureFixture[str]
) -> None:
    geopandas, pandas = pytest.importorskip("geopandas"), pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    numbers = {"n": pandas.array([2**53 + 1, 2**53, None], "Int64"), "yes": pandas.array([1, 0, None], "boolean")}
    frame = geopandas.GeoDataFrame(numbers, geometry=geopandas.points_from_xy([0, 0, 0], [0, 0, 0]), crs=3857)
    frame.assign(half=[0.5, None, 2]).to_file(name)
    assert said(capsys, "count", name, "--by", "n") == "0\n"
    assert said(capsys, "pairs", name, "--id", "n") == f"a,b\n{2**53 + 1},{2**53}\n{2**53 + 1},\n{2**53},\n"
    rows = said(capsys, "join", name, name, "--how", "semi", "--id", "yes,half").splitlines()
    assert rows == ["a_yes,a_half", "True,0.5", "False,", ",2.0"]


GENES = "chr1\thavana\texon\t{}\t{}\t.\t+\t.\tgene_id {}"
LINES = {
    "bed": [
        "chr1\t5\t9\tx\ty",
        "chr2\t0\t1\t.\t.",
        "chr1\t7\t7\t\t",
        "# no\t1\t2",
        "track name=a",
        "browser",
        "1\t007\t10\té\t1",
    ],
    "gtf": [GENES.format(5, 9, '"a"; level 2'), GENES.format(1, 7, "b"), "#!x", "chr2\tx\tx\t3\t4\t1.5\t.\t."],
    "gff3": [GENES.format(5, 9, "ID=a"), "##gff-version 3", "1\tx\tx\t3\t4\t\t-\t0\tID=g%20a;Parent=b"],
    "vcf": [
        "##fileformat=VCFv4.2",
        "chr1\t5\trs1\tACG\tT\t1.5\tPASS\tDP=3;END=12;END=x",
        "chr1\t5\trs1\té\tT\t.\tPASS\tXEND=3;END=",
        "2\t9\t.\tN\t<DEL>,<INS>\t.\t.\tSVLEN=-9,20",
        "2\t0\t\tA\tT",
        "2\t10\t.\t\tT\t\t\tEND=7",
    ],
    "csv": [
        "5,9,x",
        "-1,+7,",
        '"3", 4,"a,b"',
        " 0,007,é",
        "2,3,#x,,",
        "#,5",
        '3,4,inch 5"',
        "1.5,2,y",
        ",3,z",
        "1e2,100.0,z",
    ],
}
ODD_LINES = {
    "bed": [
        "chr1\t5\t9",
        "chr1\t5\t9x",
        "chr1\t5\t9x\t\t",
        "chr1\t-1\t9",
        "chr1\t5",
        "\t1\t2",
        "chr1\t5\t9\rchr2\t1\t2",
        "chr1\t1_0\t20",
        "a\t 1\t2",
    ]
    + ["a\t1\t2 ", "track\t1\t2", "trackx\t1\t2", "a\t1.5\t2", f"a\t1\t{10**18}", f"a\t1\t{10**30}", "a b\t1\t2\r"],
    "gtf": [
        "##FASTA",
        "chr1\tx\tx\t3\t4",
        GENES.format("x", 5, ""),
        GENES.format(".", "", ""),
        GENES.format(-5, 2**60, ""),
    ],
    "gff3": ["##FASTA", "##FASTA x", GENES.format("1_0", 5, ""), GENES.format("1e1", "\u0661", "ID=a"), "chr1 x"],
    "vcf": ["1\t007\t.\tA\tT", "1\tx\t.\tA\tT\t.\t.\tEND=5", "1\t5\t.\tA", f"1\t5\t.\tA\tT\t.\t.\tEND={10**20}"]
    + ["1\t-2\t.\tA\tT", "1\t+2\t.\tA\tT", "1\t5 \t.\tA\tT", f"1\t{10**19}\t.\tA\tT", "1\t-0\t.\tA\tT"],
    "csv": [
        '1,2,"a""b"',
        '1,2,"a\nb"',
        '1,2,"a',
        '1,"2"x,a',
        "1,2",
        "1,2,a,b",
        "1,2,a\r3,4,b",
        "1_0,20,a",
        "x,1,a",
        "inf,-inf,a",
    ]
    + [
        f"1,{2**53},a",
        f"{2**53 + 1},1,a",
        f"1,{10**18},",
        f"{10**18 - 1},-{10**18 - 1},",
        "1e16,1,",
        "1e999,1,",
        "\u0661,1,a",
    ]
    + [
        "NA,5,a",
        ".,nan,a",
        "1 ,2,a",
        "-0,0,",
        "   ",
        "0x10,1,a",
        '"#",1',
        "1,2," + "a" * 131_073,
        "+-1,2,a",
        "1.e2,.5,",
        "e,1,",
    ],
}


@pytest.mark.parametrize("kind", [*LINES])
def test_lines_are_read_as_cell_by_cell(kind: str) -> None:
    random = Random(2)
    fast = 0
    for _ in range(600):
        chosen = [random.choice(LINES[kind]) for _ in range(random.randint(0, 12))]
        lines = [
            random.choice(ODD_LINES[kind]) if random.random() < 0.03 else random.choice([line, line, ""])
            for line in chosen
        ]
        end = random.choice(["\n", "\r\n"])
        header = None
        if kind == "csv":
            header = random.choice([True, False])
            lines = [*random.choice([[], ["# by x"]]), *(["start, end,name"] if header else []), *lines]
        elif random.random() < 0.3:
            lines = [f"{line}\tmore\t" if "\t" in line else line for line in lines]
        data = (random.choice(["", "\ufeff"]) + end.join(lines) + random.choice(["", end])).encode()
        tables: list[_text.Text] = []

        def fast_table(data: bytes = data, header: Any = header) -> Any:
            if kind == "csv":
                return _text.read_table("a.csv", data, ",", header)[0]
            return _text.read_genomic("a.bed", data, kind)

        def plain_table(data: bytes = data, header: Any = header) -> Any:
            text = io.StringIO(data.decode("utf-8-sig"), newline="")
            if kind == "csv":
                return next(_text.table_parts("a.csv", text, ",", header, 1000))[0]
            return _text._read_genomic("a.bed", text, kind)

        def outcome(read: Any, tables: list[_text.Text] = tables) -> Any:
            try:
                table = read()
                tables.append(table)
                count = np.arange(len(table))
                names = [*table.columns, *(["gene_id", "ID"] if kind in ("gtf", "gff3") else [])]
                cells = [np.asarray(table.label(name)[count]).tolist() for name in names]
                assert cells == [[*table.text(name)] for name in names]
                codes = [group_codes([[table.group(name)]], ["a"])[0].tolist() for name in names]
                plain = [table.are_plain_numbers(name) for name in names]
                for name in [name for name, is_plain in zip(names, plain) if is_plain]:
                    codes.append(group_codes([[table.group_of_numbers(name)]], ["a"])[0].tolist())
                lines = [table.line(row) for row in count]
                result = [table.columns, cells, plain, codes, lines]
                for name in table.columns[:2] if kind == "csv" else ("start", "end"):
                    numbers = table[name]
                    result.append((str(numbers.dtype), [str(one) for one in numbers.tolist()]))
                return result
            except FileError as error:
                return str(error)

        assert outcome(fast_table) == outcome(plain_table), data
        fast += isinstance(tables[0], _text.Lines) if tables else 0
    assert fast > 300
    with pytest.raises(UnicodeDecodeError):
        _text.read_genomic("a.bed", b"a\t1\t2\t\xff\n", "bed")
    with pytest.raises(UnicodeDecodeError):
        _text.read_table("a.csv", b"start,end\n1,2\n3,\xff\n", ",", None)


@pytest.mark.parametrize("name", ["a.bed", "a.bed.gz", "a.csv", "a.csv.gz"])
def test_reading_a_file_of_text_reports_how_far_it_is(name: str) -> None:
    rows = [f"chr1\t{at}\t{at + 5}" if ".bed" in name else f"{at},{at + 5}" for at in range(500_000)]
    text = "\n".join(rows).encode()
    Path(name).write_bytes(gzip.compress(text, 0) if name.endswith(".gz") else text)
    shares: list[float] = []
    assert len(read(name, progress=shares.append)) == 500_000
    assert shares == sorted(shares) and len(shares) >= 3 and shares[0] < 0.7 and shares[-1] == 0.99


@pytest.mark.parametrize(
    "geometry",
    [
        {"type": "Polygon", "coordinates": [[0, 0], [1, 0], [1, 1], [0, 0]]},
        {"type": "MultiPolygon", "coordinates": [[[0, 0], [1, 0], [1, 1], [0, 0]]]},
        {"type": "Point", "coordinates": [[1, 1]]},
        {"type": "MultiPoint", "coordinates": [1, 1]},
        {"type": "LineString", "coordinates": [[[0, 0], [1, 1]]]},
        {"type": "Circle", "coordinates": [0, 0]},
        {"coordinates": [0, 0]},
        {"type": "Point", "coordinates": [1, None]},
        {"type": "Point", "coordinates": [1]},
        {"type": "GeometryCollection"},
        {"type": "GeometryCollection", "geometries": [{"type": "Point", "coordinates": [[1, 1]]}]},
    ],
)
def test_geometries_of_another_form_than_their_type_are_refused(
    geometry: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    features = [{"type": "Feature", "properties": {}, "geometry": geometry}]
    Path("a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))
    assert "feature 0 (the first is 0) is not valid GeoJSON" in refused(capsys, "count", "a.geojson")


def test_columns_in_an_order_that_contradicts_their_names_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("lon,lat,minx,maxx,miny,maxy\n10,48,0,1,2,3\n")
    assert "pass --columns lon,lat,lon,lat" in refused(capsys, "count", "a.csv", "--columns", "lon,lat")
    assert main(["count", "a.csv", "--columns", "lon,lat,lon,lat"]) == 0 and capsys.readouterr().out == "0\n"
    message = refused(capsys, "count", "a.csv", "--columns", "minx,maxx,miny,maxy")
    assert message.endswith("their names say minx,miny,maxx,maxy: pass them in this order\n")
    assert main(["count", "a.csv", "--columns", "minx,miny,maxx,maxy"]) == 0


def test_six_columns_without_names_may_have_scores(capsys: pytest.CaptureFixture[str]) -> None:
    rows = [[7, 5, 5, 2, 2, 0.5], [7, 6, 6, 2, 2, 0.9]]
    Path("a.txt").write_text("\n".join(" ".join(map(str, row)) for row in rows))
    np.save("a.npy", rows)
    for name in ("a.txt", "a.npy"):
        assert "6 columns without names" in refused(capsys, "count", name, "--format", "cxcywh")
        assert main(["count", name, "--format", "cxcywh", "--columns", "2,3,4,5"]) == 0
        assert capsys.readouterr().out == "1\n"


def test_a_file_of_several_layers_is_refused(capsys: pytest.CaptureFixture[str]) -> None:
    geopandas = pytest.importorskip("geopandas")
    pytest.importorskip("pyogrio")
    frame = geopandas.GeoDataFrame(geometry=geopandas.points_from_xy([0, 1], [0, 1]), crs=3857)
    frame.to_file("a.gpkg", layer="one")
    assert main(["count", "a.gpkg"]) == 0 and capsys.readouterr().out == "0\n"
    frame.to_file("a.gpkg", layer="two")
    assert "has several layers (one, two)" in refused(capsys, "count", "a.gpkg")
