"""Tables of every library are read exactly: the pairs equal those of an oracle that compares Python's own integers,
fractions and times; or there is one clear error."""

from __future__ import annotations

import datetime as dt
import itertools
import json
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracle import in_order

import sweep_and_prune as sap
from sweep_and_prune import _columns
from sweep_and_prune._command import main

LARGE = 2**53


def between(a: Any, b: Any, **options: Any) -> list[list[int]]:
    found: list[list[int]] = in_order(sap.find_pairs_between(a, b, **options)).tolist()
    return found


def test_a_set_without_values_goes_with_every_kind() -> None:
    days = np.array([["2020-01-01", "2020-01-02"]], "M8[D]")
    missing: Any = {"start": [None], "end": [None]}
    for other in (days, days.astype("M8[ns]") - np.datetime64("2020", "ns"), np.array([[0, 2**60]]), [[0.5, 1.0]]):
        assert between(missing, other, missing="skip") == between(other, missing, missing="skip") == []
        with pytest.raises(sap.InvalidBoxError, match=r"b\[0\] has a NaN"):
            sap.find_pairs_between(other, missing)
    margins: list[Any] = [np.timedelta64(1, "s"), [dt.timedelta(1)], 1]
    for margin in margins:
        assert sap.count_pairs(missing, missing="skip", margin=margin) == sap.count_pairs([], margin=margin) == 0
    none_of_all = np.full((2, 2), "NaT", "M8[s]")
    assert between(none_of_all, days, missing="skip", margin=np.timedelta64(1, "s")) == []


def test_margins_beyond_every_integer_of_numpy_are_exact() -> None:
    far = [[0, 1], [2**70 + 1, 2**70 + 1]]
    for margin, wanted in ((2**70, 1), (2**70 - 1, 0), ([2**70], 1), (2**64, 0), (2**200, 1)):
        assert sap.count_pairs(far, margin=margin) == wanted
    low = np.array([[-(2**63), -(2**63)], [2**63 - 1, 2**63 - 1]])
    for margin, wanted in ((2**64 - 1, 1), (2**64 - 2, 0), (2**65, 1)):
        assert sap.count_pairs(low, margin=margin) == wanted
    assert sap.count_pairs([[0.0, 1.0], [1e30, 1e30]], margin=10**30) == 1
    with pytest.raises(ValueError, match="margin is an integer of 16610 bits; it must be at most"):
        sap.find_pairs([[0.0, 1.0]], margin=10**5000)


def test_margins_are_added_to_large_decimals_exactly() -> None:
    table: Any = {"start": [Decimal(LARGE), Decimal(LARGE + 4)], "end": [Decimal(LARGE + 2), Decimal(LARGE + 6)]}
    assert sap.count_pairs(table, margin=1) == 0 and sap.count_pairs(table, margin=2) == 1


# Groups.


@pytest.mark.parametrize(
    ("first", "second"),
    [
        (np.array([LARGE + 1]), np.array([float(LARGE)])),
        (np.array([LARGE + 1], np.uint64), np.array([float(LARGE)])),
        (np.array([2**63 + 1], np.uint64), np.array([2**63 - 1])),
        (np.array([2**64 - 1], np.uint64), np.array([-1])),
        (np.array([LARGE + 1, -1]), np.array([LARGE, 2**63], np.uint64)),
        ([LARGE + 1], [float(LARGE)]),
        ([2**70 + 1], [2.0**70]),
        (["a"], ["a\0"]),
        (np.array(["a"]), ["a\0"]),
        # The first, in nanoseconds, is the second one plus 2^64.
        (np.array(["2554-07-21T23:34:34"], "M8[s]"), np.array(["1970-01-01T00:00:00.290448384"], "M8[ns]")),
        (np.array([2**40], "m8[D]"), np.array([2**40 * 86_400 * 10**9 % 2**64], "m8[ns]")),
        (np.array(["2020-01-01"], "M8[D]"), np.array(["2020-01-01T00:00:01"], "M8[s]")),
        ([Decimal(LARGE) + Decimal("0.5")], [LARGE]),
    ],
)
def test_groups_that_are_not_equal_do_not_pair(first: Any, second: Any) -> None:
    a, b = np.zeros((len(first), 2)), np.zeros((len(second), 2))
    assert between(a, b, by=(first, second)) == between(b, a, by=(second, first)) == []
    assert between(a, a, by=(first, first)) == [[row, row] for row in range(len(a))]
    if type(first) is list:
        assert sap.count_pairs(np.zeros((2, 2)), by=[*first, *second]) == 0
        assert sap.count_pairs(np.zeros((2, 6)), by=[*first, *second]) == 0


def test_groups_that_are_equal_pair_whatever_their_types() -> None:
    one = np.zeros((1, 2))
    for first, second in itertools.combinations(
        [[1], [1.0], np.array([1], np.uint8), np.array([1], object), [np.int64(1)], [Decimal(1)], [Fraction(1)]], 2
    ):
        assert between(one, one, by=(first, second)) == [[0, 0]]
    times = [np.array(["2020-01-01"], f"M8[{unit}]") for unit in ("Y", "D", "h", "s", "ms", "us", "ns", "2D")]
    for first, second in itertools.combinations([*times, [dt.datetime(2020, 1, 1)], [dt.date(2020, 1, 1)]], 2):
        assert between(one, one, by=(first, second)) == [[0, 0]]
    zone = dt.timezone(dt.timedelta(hours=2))
    noon, also = [dt.datetime(2020, 1, 1, 12, tzinfo=dt.timezone.utc)], [dt.datetime(2020, 1, 1, 14, tzinfo=zone)]
    assert between(one, one, by=(noon, also)) == [[0, 0]]


def test_lists_of_mixed_values_are_not_made_text() -> None:
    boxes = np.zeros((5, 2))
    assert sap.find_pairs(boxes, by=[1, "1", b"1", 1.0, "1.0"]).tolist() == [[0, 3]]
    assert sap.find_pairs(boxes, by=(1, "1", "1\0", True, None)).tolist() == [[0, 3]]
    assert sap.find_pairs(boxes, by=["nan", float("nan"), "None", None, "nan"]).tolist() == [[0, 4]]
    assert sap.find_pairs(boxes, by=[("1", 2), ("1", 2.0), ("1", "2"), ("12",), ("1", 2)]).tolist() == [
        [0, 1],
        [0, 4],
        [1, 4],
    ]


@pytest.mark.parametrize(
    ("first", "second", "message"),
    [
        ([1], ["1"], "by has numbers in a, but text in b"),
        (np.array([1]), np.array(["1"]), "by has numbers in a, but text in b"),
        ([True], [1], "by has truth values in a, but numbers in b"),
        ([b"a"], ["a"], "by has bytes in a, but text in b"),
        (np.array([1]), np.array([1], "M8[ns]"), "by has numbers in a, but times in b"),
        (np.array([1], "m8[s]"), np.array([1], "M8[s]"), "by has durations in a, but times in b"),
        (
            [dt.datetime(2020, 1, 1)],
            [dt.datetime(2020, 1, 1, tzinfo=dt.timezone.utc)],
            "by has times in a, but times with a time zone in b",
        ),
    ],
)
def test_groups_of_different_kinds_are_refused(first: Any, second: Any, message: str) -> None:
    one = np.zeros((1, 2))
    with pytest.raises(TypeError, match=message):
        sap.find_pairs_between(one, one, by=(first, second))
    # Without values, there is no kind.
    assert len(sap.find_pairs_between(one[:0], one, by=(first[:0], second))) == 0
    assert len(sap.find_pairs_between(one, one, by=([None], second))) == 0


def test_names_of_groups_mean_the_same_everywhere() -> None:
    table: Any = {"start": [0, 0, 0, 0], "end": [1, 1, 1, 1], "chrom": list("aabb"), "strand": list("+-+-")}
    other: Any = {"start": [0, 0], "end": [1, 1], "chrom": list("ab"), "strand": list("+-"), "side": list("-+")}
    assert sap.count_pairs(table, by="chrom") == sap.count_pairs(table, by=["chrom"]) == 2
    assert sap.count_pairs(table, by=["chrom", "strand"]) == 0
    assert between(table, other, by="chrom") == [[0, 0], [1, 0], [2, 1], [3, 1]]
    assert between(table, other, by=["chrom", "strand"]) == [[0, 0], [3, 1]]
    assert between(table, other, by=(["chrom", "strand"], ["chrom", "side"])) == [[1, 0], [2, 1]]
    assert between(table, other, by=("strand", "side")) == [[0, 1], [1, 0], [2, 1], [3, 0]]
    rows = np.zeros((4, 2))
    assert sap.find_pairs(rows, by=["chrom", "strand", "chrom", "x"]).tolist() == [[0, 2]]
    for by, message in (
        (["chrom", "gene"], "by is 'gene', but the columns of boxes are start, end, chrom, strand"),
        (list("abab"), "by is 'a', but the columns of boxes are"),
        ([["a"] * 3], "by must have one value for each box of boxes"),
    ):
        with pytest.raises(ValueError, match=message):
            sap.find_pairs(table, by=by)
    with pytest.raises(ValueError, match="by must have as many columns for a as for b, not 2 and 1"):
        sap.find_pairs_between(table, other, by=(["chrom", "strand"], "chrom"))


def test_text_and_categories_are_looked_at_once_each(monkeypatch: pytest.MonkeyPatch) -> None:
    arrow, pandas = pytest.importorskip("pyarrow"), pytest.importorskip("pandas")
    polars = pytest.importorskip("polars")
    looked_at: list[int] = []
    codes_of_values = _columns._codes_of_values

    def counted(arrays: Any) -> Any:
        looked_at.append(sum(map(len, arrays)))
        return codes_of_values(arrays)

    monkeypatch.setattr(_columns, "_codes_of_values", counted)
    random = np.random.default_rng(3)
    boxes = np.sort(random.integers(0, 99, (200, 2)), axis=1)
    names = [["chr1", "chr2", None, "X"][at] for at in random.integers(0, 4, 200)]
    wanted = between(boxes, boxes[:50], by=(names, names[:50]))
    assert sum(looked_at) > 100
    makers: list[Any] = [
        *(lambda kind=kind: pandas.Series(names, dtype=kind) for kind in ("str", object, "category")),
        lambda: pandas.Categorical(names, categories=["unused", "X", "chr2", "chr1"]),
        lambda: pandas.Series(names, dtype=pandas.ArrowDtype(arrow.string())),
        lambda: polars.Series(names),
        lambda: polars.Series(names, dtype=polars.Categorical),
        lambda: arrow.array(names),
        lambda: arrow.chunked_array([names[:70], names[70:]], arrow.large_string()),
        lambda: arrow.array(names).dictionary_encode(),
    ]
    for make in makers:
        looked_at.clear()
        assert between(boxes, boxes[:50], by=(make(), make()[:50])) == wanted
        assert 0 < sum(looked_at) < 10
        assert between(boxes, boxes[:50], by=(make(), names[:50])) == wanted
        assert sap.count_pairs(boxes[:0], by=make()[:0]) == 0
        with pytest.raises(TypeError, match="by has text in a, but numbers in b, which are never equal"):
            sap.find_pairs_between(boxes, boxes, by=(make(), range(200)))
    mixed: Any = pandas.Series(["1", 1, 1.0, True], dtype=object)
    assert (
        sap.find_pairs(boxes[[0] * 4], by=mixed).tolist() == sap.find_pairs(boxes[[0] * 4], by=mixed.tolist()).tolist()
    )


def test_a_box_without_a_group_is_checked_all_the_same() -> None:
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\]"):
        sap.find_pairs([[0, 1], [1, 0]], by=["a", None])


# Coordinates.


def test_times_of_different_units_do_not_wrap_around() -> None:
    late = np.array([["2554-07-21T23:34:33", "2554-07-21T23:34:34"]], "M8[s]")
    early = np.array([["1970-01-01", "1970-01-02"]], "M8[ns]")
    assert between(late, early) == between(early, late) == []
    assert between(late, late.astype("M8[ms]")) == [[0, 0]]
    # The distance is exact, too: from the end of 1970-01-01 to 2554, in seconds and a nanosecond.
    apart = np.timedelta64(int((late[0, 0] - np.datetime64("1970-01-02", "s")).astype(int)), "s")
    assert between(late, early, margin=apart) == [[0, 0]]
    assert between(late, early, margin=apart - np.timedelta64(1, "s")) == []
    assert between(late, early, margin=[np.timedelta64(1, "ns")]) == []
    assert sap.count_pairs(np.array([[0, 1], [3, 4]], "M8[Y]"), margin=np.timedelta64(366, "D")) == 0
    assert sap.count_pairs(np.array([[0, 1], [3, 4]], "M8[Y]"), margin=np.timedelta64(731, "D")) == 1
    table: Any = {"start": np.array(["2554-07-21"], "M8[s]"), "end": np.array(["1970-01-01"], "M8[ns]")}
    with pytest.raises(ValueError, match=r"boxes has times in units that none of them holds \(end in ns, start in s\)"):
        sap.find_pairs(table)
    table["start"] = np.array(["1969"], "M8[Y]")
    assert sap.count_pairs_between(table, table) == 1


def test_times_with_a_zone_are_exact_in_every_unit() -> None:
    pandas = pytest.importorskip("pandas")
    steps = pandas.date_range("2020-01-01", periods=5, freq="100ns", tz="Europe/Berlin")
    close = pandas.DataFrame({"start": steps, "end": steps + pandas.Timedelta(99, "ns")})
    assert sap.count_pairs(close) == 0 and len(sap.join(close, close)) == 5
    assert sap.count_pairs(close, margin=pandas.Timedelta(1, "ns")) == 4
    days = pandas.DataFrame({"start": pandas.to_datetime(["2020-01-01", "2020-01-05"], utc=True)})
    days["end"] = days["start"] + pandas.Timedelta(1, "D")
    for unit in ("s", "ms", "us", "ns"):
        other = days.astype(dict.fromkeys(("start", "end"), f"datetime64[{unit}, Asia/Tokyo]"))
        assert between(days, other) == [[0, 0], [1, 1]] and len(sap.join(days, other)) == 2
        mixed = days.assign(start=other["start"])
        assert between(mixed, other) == [[0, 0], [1, 1]]
    naive = days.apply(lambda column: column.dt.tz_localize(None))
    with pytest.raises(TypeError, match="a has times with a time zone and b has times, which do not compare"):
        sap.find_pairs_between(days, naive)
    index = pandas.IntervalIndex.from_arrays(days["start"], days["end"], closed="left")
    assert between(index, days, closed="both") == [[0, 0], [1, 1]]
    dates: Any = {
        "start": [dt.date(2020, 1, 1), dt.date(2020, 1, 5)],
        "end": [dt.date(2020, 1, 2), dt.date(2020, 1, 6)],
    }
    assert between(dates, naive) == [[0, 0], [1, 1]]


def test_geometries_of_different_coordinates_are_refused() -> None:
    geopandas = pytest.importorskip("geopandas")
    a = geopandas.GeoSeries.from_xy([0], [0], crs=4326)
    with pytest.raises(
        ValueError, match="a and b have different coordinate reference systems, EPSG:4326 and EPSG:3857"
    ):
        sap.find_pairs_between(a, a.to_crs(3857))
    assert sap.count_pairs_between(a, a) == sap.count_pairs_between(a, geopandas.GeoSeries.from_xy([0], [0])) == 1


@pytest.mark.filterwarnings("ignore:The 'generic' unit")
def test_durations_are_boxes_and_months_are_not() -> None:
    hours = np.array([[0, 1], [2, 3]], "m8[h]")
    assert sap.count_pairs(hours) == 0
    assert sap.count_pairs(hours, margin=dt.timedelta(hours=1)) == 1
    for wrong, message in (
        (np.timedelta64(1, "M"), "has durations in months"),
        (np.timedelta64(1), "has durations without a unit"),
        ([dt.timedelta(1), 1], "margin must be a timedelta"),
    ):
        with pytest.raises(TypeError, match=message):
            sap.find_pairs(hours, margin=wrong)  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="a has durations and b has times, which do not compare"):
        sap.find_pairs_between(hours, np.array([[0, 1]], "M8[h]"))
    with pytest.raises(TypeError, match="a has times and b has numbers, which do not compare"):
        sap.find_pairs_between(np.array([[0, 1]], "M8[h]"), [[0, 1]])
    assert len(sap.find_pairs_between(np.empty((0, 2)), hours)) == 0


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_margins_that_a_precision_rounds_to_infinity(dtype: Any) -> None:
    low, most = -np.inf, np.finfo(dtype).max
    boxes = np.array([[low, low], [0, 1], [most, most], [-most, -most]], dtype)
    assert sap.find_pairs(boxes, margin=1e39).tolist() == ([[1, 2], [1, 3], [2, 3]] if dtype == np.float32 else [])
    # 3.5e38 is more than single precision has, but a sum with it need not be.
    assert sap.count_pairs(np.array([[-3e38, -3e38], [6e37, 6e37]], dtype), margin=3.5e38) == 0
    assert sap.count_pairs(np.array([[-3e38, -3e38], [4e37, 4e37]], dtype), margin=3.5e38) == 1
    assert sap.PairFinder(1, dtype).find(boxes[:2], margin=1e39).tolist() == []


def test_integers_and_fractions_are_compared_exactly() -> None:
    for a, b, wanted in (
        (np.array([[LARGE + 1, LARGE + 1]]), np.array([[float(LARGE), float(LARGE)]]), 0),
        (np.array([[LARGE + 1, LARGE + 1]]), np.array([[float(LARGE), LARGE + 2.0]]), 1),
        (np.array([[2**64 - 1, 2**64 - 1]], np.uint64), np.array([[-1, -1]]), 0),
        (np.array([[2**63, 2**63]], np.uint64), np.array([[-5, 2**63 - 1]]), 0),
        ([[2**70, 2**70]], [[2**70 + 1, 2**70 + 1]], 0),
        ([[LARGE + 1, LARGE + 1]], [[0.5, LARGE]], 0),
        ([[-(2**63), 2**63 - 1]], [[2**63, 2**63]], 0),
        ([[-np.inf, LARGE]], [[LARGE + 1, np.inf]], 0),
    ):
        assert sap.count_pairs_between(a, b) == sap.count_pairs_between(b, a) == wanted
        assert sap.count_pairs_between(a, b, margin=1) >= wanted
    table: Any = {"start": np.array([0, 2**63 + 1], np.uint64), "end": np.array([2**63 - 1, 2**63 - 1])}
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] is inverted"):
        sap.find_pairs(table)
    table["end"] = np.array([2**63 - 1, -1])
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] is inverted"):
        sap.find_pairs(table)
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[0\] has a NaN"):
        sap.find_pairs([[2**70, float("nan")]])
    assert sap.count_pairs([[2**70, float("nan")]], missing="skip") == 0
    # These have a precision of their own, as ever.
    assert sap.PairFinder(1).find([[2**70, 2**70], [2**70 + 1, 2**70 + 1]]).tolist() == [[0, 1]]


def test_sizes_are_added_exactly() -> None:
    x = np.array([LARGE, LARGE + 2])
    assert sap.count_pairs(np.column_stack([x, [1, 1]]), format="xywh") == 0
    assert sap.count_pairs(np.column_stack([x, [2, 1]]), format="xywh") == 1
    assert sap.count_pairs(np.array([[2**63 - 1, 1], [2**63 - 9, 8]]), format="xywh") == 1
    with pytest.raises(ValueError, match=r'numbers beyond 2\^53.*instead of "cxcywh"'):
        sap.find_pairs([[LARGE + 2, 2]], format="cxcywh")
    # Half precision has no 2049, and nothing beyond 65,504.
    half = np.array([[2048, 1], [2050, 1], [60_000, 60_000], [100, 1]], np.float16)
    assert sap.count_pairs(half, format="xywh") == 0
    assert sap.find_pairs(
        np.array([[0, 60_000], [65_000, 500], [30_000, 60_000]], np.float16), format="xywh"
    ).tolist() == [
        [0, 2],
        [1, 2],
    ]


def test_truth_values_are_no_numbers() -> None:
    with pytest.raises(TypeError, match="column start must have numbers, not truth values"):
        sap.find_pairs({"start": np.array([True]), "end": np.array([2])})


def test_two_columns_for_one_coordinate_are_refused() -> None:
    columns: Any = {"minx": [0, 5], "maxx": [1, 6], "Min_X": [0, 0], "miny": [0, 0], "maxy": [1, 1]}
    with pytest.raises(ValueError, match="columns minx and Min_X are both the same coordinate of the boxes"):
        sap.find_pairs(columns)
    pandas = pytest.importorskip("pandas")
    twice = pandas.DataFrame([[0, 1, 2]], columns=["start", "end", "end"])
    with pytest.raises(ValueError, match="columns end and end are both the same coordinate"):
        sap.find_pairs(twice)
    twice.columns = ["start", "end", "kind"]
    with pytest.raises(ValueError, match="by is 'kind', but boxes has several columns of that name"):
        sap.find_pairs(pandas.concat([twice, twice["kind"]], axis=1), by="kind")


def test_groups_of_joins_are_exact_and_missing_ones_match_nothing() -> None:
    pandas = pytest.importorskip("pandas")
    rows = {"start": [0, 0], "end": [1, 1]}
    frames = [pandas.DataFrame({**rows, "kind": [2**63 - 1, 1]}).astype({"kind": kind}) for kind in ("int64", "uint64")]
    assert len(sap.join(*frames, by="kind")) == 2
    frames[1]["kind"] = np.array([2**63, 1], np.uint64)  # as floating point, 2^63 - 1 is 2^63
    assert sap.join(*frames, by="kind").index.tolist() == [1]
    gaps = [pandas.DataFrame({**rows, "kind": ["a", None]}) for _ in "lr"]
    assert sap.join(*gaps, by="kind").index.tolist() == [0]
    assert sap.join(gaps[0], gaps[1], "left", by="kind")["index_right"].isna().tolist() == [False, True]
    with pytest.raises(TypeError, match="column kind has numbers in left, but text in right"):
        sap.join(frames[0], gaps[0], by="kind")
    polars = pytest.importorskip("polars")
    of_polars = [polars.from_pandas(frame) for frame in frames]
    assert len(sap.join(*of_polars, by="kind")) == 1
    assert len(sap.join(*(polars.from_pandas(frame) for frame in gaps), by="kind")) == 1
    enums = [
        polars.DataFrame({**rows, "kind": polars.Series(["a", "b"], dtype=polars.Enum(list(names)))})
        for names in ("abc", "bad")
    ]
    assert len(sap.join(*enums, by="kind")) == 2
    with pytest.raises(TypeError, match="column kind has numbers in left, but text in right"):
        sap.join(of_polars[0], enums[0], by="kind")


# Files.


@pytest.fixture
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def counted(capsys: pytest.CaptureFixture[str], *arguments: str) -> int:
    assert main(["count", *arguments]) == 0, capsys.readouterr().err
    return int(capsys.readouterr().out)


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main(["count", *arguments]) == 1
    said = capsys.readouterr().err
    assert said.count("\n") == 1
    return said


@pytest.mark.parametrize(
    ("rows", "wanted"),
    [
        ([f"{2**63},{2**63}", f"{2**63 + 1},{2**63 + 1}"], 0),
        ([f"{2**63},{2**63 + 1}", f"{2**63 + 1},{2**63 + 1}"], 1),
        ([f"-{2**64},{2**64}", f"{2**64 + 1},{2**70}"], 0),
        ([f"{LARGE},{LARGE}", f"{LARGE + 1},{LARGE + 1}", "0.5,1.5"], 0),
        ([f"{LARGE},{LARGE}", f"{LARGE + 1},{LARGE + 1}", ",1"], 0),
        ([f"{10**400},{10**400}", f"{10**400 + 1},{10**400 + 1}"], 0),
        (["0,1e3", "1E3,inf"], 1),
    ],
)
@pytest.mark.parametrize("header", ["start,end\n", ""])
def test_integers_of_text_are_exact(
    rows: list[str], wanted: int, header: str, in_a_folder: None, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("a.csv").write_text(header + "\n".join(rows))
    assert counted(capsys, "a.csv", "--missing", "skip") == wanted
    if header:
        assert counted(capsys, "a.csv", "--missing", "skip", "--columns", "start,end") == wanted


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("xmin,xmax\n0,1\n1_0,20\n", "a.csv, line 3, column xmin: '1_0' is not a number"),
        ("xmin,xmax\n0,1\n\u0661,20\n", "a.csv, line 3, column xmin: '\u0661' is not a number"),
        ("xmin,xmax\n0,1e999\n", "a.csv, line 2, column xmax: '1e999' is too large a number"),
        (f"xmin,xmax\n0,{'9' * 5000}\n", f"a.csv, line 2, column xmax: '{'9' * 57}...' is too large a number"),
        ('name,xmin,xmax\na,0,1\n"b,0,1\nc,0,1\n', "a.csv, line 3: a quote opens in this row and is not closed"),
        ('name,xmin,xmax\n"b,0,1\n' + "c,0,1\n" * 40_000, "a.csv, line 2: a quote opens in this row and is not closed"),
        ('name,xmin,xmax\n"b,0,1\nc,0,1\n"d",0,1\n', "a.csv, line 2: it has a quote in the wrong place"),
        ("xmin,xmax\n0,1\n0,1,2\n", "a.csv, line 3: it has 3 columns, where 2 are expected"),
        ("0,2\n0,1,2\n", "a.csv, line 2: it has 3 columns, where 2 are expected"),
        ("xmin,xmax,Xmin\n0,1,0\n", "a.csv: the columns xmin and Xmin are both the same coordinate"),
        ("xmin,xmax,xmin\n0,1,0\n", "a.csv: the columns xmin and xmin are both the same coordinate"),
    ],
)
def test_text_that_could_be_misread_is_refused(
    text: str, message: str, in_a_folder: None, capsys: pytest.CaptureFixture[str]
) -> None:
    Path("a.csv").write_text(text, encoding="utf-8")
    assert refused(capsys, "a.csv").startswith(f"sap: {message}")


def test_text_that_cannot_be_misread_is_taken(in_a_folder: None, capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text('name,xmin,xmax\n"a\nb, c",0,1,\n5" pipe, 1 ,+2, \n')
    assert counted(capsys, "a.csv") == 1
    Path("a.txt").write_text("0 2\n1 2 \n")
    assert counted(capsys, "a.txt") == 1
    Path("a.csv").write_text("xmin,xmax,kind,kind\n0,1,a,b\n0,1,a,a\n")
    assert counted(capsys, "a.csv") == 1
    for option in ("--by", "--columns"):
        assert "a.csv has 2 columns 'kind': rename all but one" in refused(capsys, "a.csv", option, "kind")


def test_bed_has_no_quotes(in_a_folder: None, capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.bed").write_text("".join(f"c\t{row}\t9\t{name}\n" for row, name in enumerate(['"a', "b", "c", 'd"', '"'])))
    assert counted(capsys, "a.bed") == 10
    assert main(["pairs", "a.bed", "--id", "name"]) == 0
    assert '"""a",b\n' in capsys.readouterr().out


def test_groups_of_files_are_those_of_tables(in_a_folder: None, capsys: pytest.CaptureFixture[str]) -> None:
    Path("a.csv").write_text("start,end,kind,side\n0,1,1,+\n0,1,,+\n0,1,,+\n0,1,1.0,+\n")
    assert counted(capsys, "a.csv", "--by", "kind") == 1, "numbers are numbers, and what is empty is no group"
    assert counted(capsys, "a.csv", "--by", "kind,side") == 1
    assert counted(capsys, "a.csv", "--by", "side") == 6
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    table = arrow.table({"start": [0, 0], "end": [1, 1], "kind": [1, 2**53 + 1], "side": ["+", None]})
    parquet.write_table(table, "b.parquet")
    assert counted(capsys, "a.csv", "b.parquet", "--by", "kind") == 2, "numbers are compared as numbers"
    assert counted(capsys, "b.parquet", "a.csv", "--by", "kind,side") == 2
    Path("d.csv").write_text("start,end,kind\n0,1,01\n0,1,1\n0,1,1e0\n0,1,x\n")
    assert counted(capsys, "d.csv", "--by", "kind") == 0, "what may be a name is text"
    said = refused(capsys, "a.csv", "d.csv", "--by", "kind")
    assert said == "sap: a.csv has '1.0' in column kind, and d.csv has '1e0' there: write the values alike\n"
    Path("c.csv").write_text(f"start,end,kind,side\n0,1,{2**53},+\n0,1,{2**53 + 1},+\n")
    assert counted(capsys, "b.parquet", "c.csv", "--by", "kind") == 1
    Path("a.csv").write_text("start,end,kind,side\n0,1,1,+\n0,1,x,+\n")
    assert "a.csv, line 3, column kind: 'x' is not a number" in refused(capsys, "a.csv", "b.parquet", "--by", "kind")
    parquet.write_table(table.set_column(2, "kind", arrow.array(["1", "2"])), "d.parquet")
    said = refused(capsys, "b.parquet", "d.parquet", "--by", "kind")
    assert "column kind has numbers in a, but text in b, which are never equal" in said


def test_numbers_of_geojson_are_exact(in_a_folder: None, capsys: pytest.CaptureFixture[str]) -> None:
    def write(*points: Any) -> None:
        features = [{"type": "Feature", "geometry": {"type": "Point", "coordinates": point}} for point in points]
        Path("a.geojson").write_text(json.dumps({"type": "FeatureCollection", "features": features}))

    write([LARGE, 0], [LARGE + 1, 0], [10**400, 0])
    assert counted(capsys, "a.geojson") == 0
    assert counted(capsys, "a.geojson", "--margin", "1") == 1
    for wrong in ([True, 0], [float("nan"), 0]):
        write([0, 0], wrong)
        assert "a.geojson, feature 1 (the first is 0) is not valid GeoJSON" in refused(capsys, "a.geojson")


def test_ids_of_files_are_not_rounded_because_others_are_missing(
    in_a_folder: None, capsys: pytest.CaptureFixture[str]
) -> None:
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    table = arrow.table({"start": [0, 0, 5], "end": [1, 1, 5], "n": [LARGE + 1, None, 3]})
    parquet.write_table(table, "a.parquet")
    assert main(["pairs", "a.parquet", "--id", "n"]) == 0
    assert capsys.readouterr().out == f"a,b\n{LARGE + 1},\n"


def test_large_files_are_read_as_small_ones_are(in_a_folder: None, capsys: pytest.CaptureFixture[str]) -> None:
    """Out of core: what is exact in memory is exact there, or refused."""
    pytest.importorskip("distributed")
    arrow, parquet = pytest.importorskip("pyarrow"), pytest.importorskip("pyarrow.parquet")
    limited = ["--memory-limit", "1GB", "--workers", "0", "--quiet"]
    uint = arrow.array([2**63, 2**63 + 1], arrow.uint64())
    for table, message in (
        (arrow.table({"start": arrow.array([0, 1]), "end": uint}), "coordinates beyond 2^53 are not exact"),
        (arrow.table({"start": uint, "end": uint}), "coordinates beyond 2^53 are not exact"),
        (arrow.table({"start": [1, None], "end": [LARGE + 1, 2]}), "coordinates beyond 2^53 are not exact"),
        (arrow.table({"start": [Decimal("0.1")], "end": [Decimal(1)]}), "coordinates are decimals that float64 does"),
        (arrow.table({"minx": [0], "maxx": [1], "Min_X": [0]}), "columns minx and Min_X are both the same coordinate"),
        (arrow.Table.from_arrays([arrow.array([0])] * 3, ["start", "end", "end"]), "both the same coordinate"),
        (arrow.table({"start": [True], "end": [2]}), "column start must have numbers, not truth values"),
    ):
        parquet.write_table(table, "a.parquet")
        assert message in refused(capsys, "a.parquet", *limited)
        if "beyond" in message or "decimals" in message:
            grouped = table.append_column("n", arrow.array([0] * len(table)))
            parquet.write_table(grouped, "a.parquet")
            assert message in refused(capsys, "a.parquet", "--by", "n", "--missing", "skip", *limited)
    twice = arrow.Table.from_arrays([arrow.array([0, 1])] * 3, ["a", "b", "b"])
    parquet.write_table(twice, "a.parquet")
    for options in ([], limited):
        assert "2 columns 'b': rename all but one" in refused(capsys, "a.parquet", "--columns", "a,b", *options)
    for dtype in ("int8", "uint64", "float16", "float32", "decimal128(9, 2)"):
        kind = arrow.decimal128(9, 2) if dtype.startswith("dec") else getattr(arrow, dtype)()
        columns = [
            arrow.array(values, arrow.int64()).cast(arrow.float64()) for values in ([0, 1, 5, None], [1, 3, 9, 4])
        ]
        table = arrow.table([column.cast(kind) for column in columns], names=["start", "end"])
        parquet.write_table(table, "a.parquet")
        for options in ([], limited):
            assert counted(capsys, "a.parquet", "--missing", "skip", *options) == 1, (dtype, options)
    text, cents = ["a", None, "b", "a"], [Decimal("0.1"), None, Decimal("0.2"), Decimal("0.1")]
    groups = {"string_view": text, "binary_view": text, "decimal32": cents, "decimal64": cents}
    for dtype, values in groups.items():
        if hasattr(arrow, dtype):
            kind = getattr(arrow, dtype)(*([5, 2] if values is cents else []))
            table = arrow.table({"start": [0.0] * 4, "end": [1.0] * 4, "n": arrow.array(values, kind)})
            parquet.write_table(table, "a.parquet")
            for options in ([], limited):
                assert counted(capsys, "a.parquet", "--by", "n", *options) == 1, (dtype, options)


def test_groups_of_objects_may_be_any_numbers() -> None:
    pandas = pytest.importorskip("pandas")
    values = [-(2**63), -(2**63) - 1, 2**70, -(2**63), None]
    found = sap.find_pairs([[0, 1]] * 5, by=pandas.Series(values, dtype=object))
    assert found.tolist() == [[0, 3]]
