"""Boxes on a circle, such as longitude: against fractions, which have no end at which to wrap."""

from __future__ import annotations

import math
import os
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from oracle import in_order

import sweep_and_prune as sap
from sweep_and_prune._command import main

CALLS = int(os.environ.get("CALLS", 30_000 if "TEST_LONG" in os.environ else 600))
SEED = int(os.environ.get("SEED", 1))
WRAPS = [360, 24, 1, 5386, 0.1, 2 * math.pi]
AXES = {1: [0, 1], 2: [0, 2, 1, 3], 3: [0, 2, 4, 1, 3, 5]}


Ends = tuple[float, float]


def arc(low: float, high: float, wrap: float) -> tuple[Fraction, Fraction, bool]:
    """Where a box begins on the circle, its length, and whether it is the whole circle."""
    if (low, high) == (-math.inf, math.inf):
        return Fraction(0), Fraction(wrap), True
    length = Fraction(high) - Fraction(low)
    if length < 0:
        length %= Fraction(wrap)
    return Fraction(low) % Fraction(wrap), length, length >= Fraction(wrap)


def meet_on_circle(a: Ends, b: Ends, wrap: float, is_closed: bool, margin: Fraction) -> bool:
    (start_a, length_a, whole_a), (start_b, length_b, whole_b) = arc(*a, wrap), arc(*b, wrap)
    if not is_closed and not (length_a > 0 and length_b > 0):
        return False
    length_a, length_b = length_a + margin, length_b + margin
    if whole_a or whole_b or max(length_a, length_b) >= Fraction(wrap):
        return True
    apart = (start_b - start_a) % Fraction(wrap), (start_a - start_b) % Fraction(wrap)
    if is_closed:
        return apart[0] <= length_a or apart[1] <= length_b
    return apart[0] < length_a or apart[1] < length_b


def meet(a: Ends, b: Ends, is_closed: bool, margin: Fraction) -> bool:
    if is_closed:
        return a[0] <= b[1] + margin and b[0] <= a[1] + margin
    return a[0] < b[1] + margin and b[0] < a[1] + margin and a[0] < a[1] and b[0] < b[1]


def some_ends(random: Random, wrap: float, dtype: Any) -> list[float]:
    """Near to each other, to the end of the circle in both conventions, and to what is one turn or some away."""
    places = [Fraction(number, 8) * Fraction(wrap) for number in (-8, -4, -3, -1, 0, 1, 3, 4, 5, 8, 20)]
    if random.random() < 0.05:
        return [-math.inf, math.inf]
    ends = [float(dtype(float(random.choice(places)))) for _ in "lh"]
    if random.random() < 0.2:
        with np.errstate(under="ignore"):
            ends[1] = float(np.nextafter(dtype(ends[1]), dtype(random.choice([-math.inf, math.inf]))))
    return sorted(ends) if random.random() < 0.4 else ends


def call(random: Random) -> None:
    dimensions = random.choice([1, 1, 2, 3])
    dtype = random.choice([np.float32, np.float64, np.float64])
    wrap = random.choice(WRAPS)
    closed = random.choice(["both", "both", "left", "right", "neither"])
    # Sums of these are exact.
    margin = random.choice([0, 0, 0, wrap / 8, wrap, 2 * wrap]) if wrap in (360, 24, 1) and dtype == np.float64 else 0
    is_single = random.random() < 0.5
    sets, groups = [], []
    for _ in range(1 if is_single else 2):
        rows = []
        for _ in range(random.choice([0, 1, 2, 5, 9])):
            others = [sorted(random.choice([0.0, 1.0, 2.0]) for _ in "lh") for _ in range(dimensions - 1)]
            ends = some_ends(random, wrap, dtype)
            while margin and any(Fraction(end) * 8 / wrap % 1 for end in ends if abs(end) < math.inf):
                ends = some_ends(random, wrap, dtype)
            flat = [end for pair in [ends, *others] for end in pair]
            rows.append([flat[at] for at in AXES[dimensions]])
        sets.append(np.array(rows, dtype).reshape(-1, 2 * dimensions))
        groups.append([random.choice("ab") for _ in rows])
    options: dict[str, Any] = {"closed": closed, "margin": margin, "wrap": wrap}
    if random.random() < 0.4:
        options["by"] = groups[0] if is_single else tuple(groups)
    wanted = []
    for i, a in enumerate(sets[0].tolist()):
        for j, b in enumerate(sets[-1].tolist()):
            if (is_single and j <= i) or ("by" in options and groups[0][i] != groups[-1][j]):
                continue
            of_axes = [((a[k], a[k + dimensions]), (b[k], b[k + dimensions])) for k in range(dimensions)]
            exact = Fraction(margin)
            if meet_on_circle(*of_axes[0], wrap, closed == "both", exact) and all(
                meet(*pair, closed == "both", exact) for pair in of_axes[1:]
            ):
                wanted.append([i, j])
    names = ["find_pairs", "count_pairs", "iter_chunks"]
    find, count, iterate = (getattr(sap, name + ("" if is_single else "_between")) for name in names)
    found = find(*sets, **options)
    assert in_order(found).tolist() == wanted, f"{sets} {options}: {found.tolist()}, not {wanted}"
    assert len({*map(tuple, found.tolist())}) == len(found)
    assert count(*sets, **options) == len(wanted)
    chunks = [chunk.copy() for chunk in iterate(*sets, size=2, **options)]
    assert np.concatenate([found[:0], *chunks]).tolist() == found.tolist()
    counts = [0] * len(sets[0])
    for i, j in wanted:
        counts[i] += 1
        if is_single:
            counts[j] += 1
    assert sap.count_overlaps(*sets, **options).tolist() == counts
    if margin == 0 and wrap in (360, 24, 1):
        check_measures(sets, wanted, wrap, dimensions)


def check_measures(sets: list[Any], wanted: list[list[int]], wrap: float, dimensions: int) -> None:
    wanted = [
        pair for pair in wanted if all(abs(boxes[row]).max() < 1e9 for boxes, row in zip((sets[0], sets[-1]), pair))
    ]
    measured = sap.measure_overlaps(sets[0], sets[-1], np.array(wanted, int).reshape(-1, 2), wrap=wrap)
    for at, (i, j) in enumerate(wanted):
        a, b = sets[0][i].tolist(), sets[-1][j].tolist()
        (start_a, length_a, _), (start_b, length_b, _) = (arc(one[0], one[dimensions], wrap) for one in (a, b))
        turn = Fraction(wrap)
        length_a, length_b = min(length_a, turn), min(length_b, turn)
        shared: Any = sum(
            max(min(start_a + length_a, start_b + length_b + k * turn) - max(start_a, start_b + k * turn), Fraction(0))
            for k in (-1, 0, 1)
        )
        for axis in range(1, dimensions):
            shared *= max(
                Fraction(min(a[axis + dimensions], b[axis + dimensions])) - Fraction(max(a[axis], b[axis])), 0
            )
        assert measured.size[at] == pytest.approx(float(shared), abs=1e-12 * wrap)


def test_random_boxes_on_a_circle_pair_as_fractions_do() -> None:
    for seed in range(SEED, SEED + CALLS):
        try:
            call(Random(seed))
        except AssertionError as error:
            raise AssertionError(f"SEED={seed} CALLS=1: {error}") from error


def test_both_conventions_of_longitude_are_one_circle() -> None:
    fiji: Any = [[177, -20, -178, -12]]  # as in GeoJSON: west is greater than east
    same: Any = [[177, -20, 182, -12]]  # from 0 to 360
    islands: Any = [
        [-179, -15, -178.5, -14],
        [181, -15, 181.5, -14],
        [-180, -13, -180, -13],
        [-178, -12, 0, 0],
        [0, -15, 1, 0],
    ]
    for boxes in (fiji, same):
        assert sap.find_pairs_between(boxes, islands, wrap=360)[:, 1].tolist() == [0, 1, 2, 3]
    assert sap.count_pairs([*fiji, *same, *islands], wrap=360) == 1 + 2 * 4 + 2
    assert sap.find_pairs([[170, 0, 180, 1], [-180, 0, -170, 1]], wrap=360).tolist() == [[0, 1]]
    assert len(sap.find_pairs([[170, 0, 180, 1], [-180, 0, -170, 1]], wrap=360, closed="left")) == 0
    assert sap.find_pairs([[170, 0, 179, 1], [-179, 0, -170, 1]], wrap=360, margin=2).tolist() == [[0, 1]]
    # A ring of bacterial genes.
    assert sap.find_pairs([[5000, 100], [0, 50], [200, 300]], wrap=5386, closed="left").tolist() == [[0, 1]]


def test_what_cannot_wrap_is_refused() -> None:
    with pytest.raises(ValueError, match=r"wrap is 0; it must be finite and greater than 0"):
        sap.find_pairs([[0, 1]], wrap=0)
    for wrong in (-1, math.nan, math.inf):
        with pytest.raises(ValueError, match="finite and greater"):
            sap.count_pairs([[0, 1]], wrap=wrong)
    with pytest.raises(TypeError, match="wrap must be a number"):
        sap.count_pairs([[0, 1]], wrap="360")  # type: ignore[arg-type]
    with pytest.raises(sap.InvalidBoxError, match=r"boxes\[1\] is inverted on axis 1"):
        sap.find_pairs([[0, 0, 1, 1], [5, 2, 1, 1]], wrap=360)
    with pytest.raises(sap.InvalidBoxError, match=r"b\[0\] has a NaN on axis 0"):
        sap.find_pairs_between([[0, 0, 1, 1]], [[math.nan, 2, 1, 1]], wrap=360)
    assert len(sap.find_pairs_between([[0, 0, 1, 1]], [[math.nan, 2, 1, 1]], wrap=360, missing="skip")) == 0
    with pytest.raises(ValueError, match=r"boxes\[1\] has an infinite end on axis 0"):
        sap.find_pairs(np.array([[0, 1], [5, math.inf]]), wrap=360)
    with pytest.raises(TypeError, match="not for times"):
        sap.find_pairs(np.array([["2020-01-01", "2020-01-02"]], "M8[D]"), wrap=360)
    with pytest.raises(TypeError, match="integers beyond 2"):
        sap.find_pairs([[0, 2**60 + 1]], wrap=360)


def test_frames_and_files_wrap(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    pandas = pytest.importorskip("pandas")
    names = ["west", "south", "east", "north"]
    zones = pandas.DataFrame([[170, -20, -170, 20], [-10, 0, 10, 10], [190, 0, 200, 5]], columns=names)
    ships = pandas.DataFrame([[-175, 0, -174, 1], [185, 2, 195, 3], [359, 1, 361, 2]], columns=names)
    joined = sap.join(zones, ships, wrap=360, measures=["size", "fraction_right"])
    wanted = [(0, 0, 1, 1), (0, 1, 5, 0.5), (1, 2, 2, 1), (2, 1, 5, 0.5)]
    assert list(zip(joined.index, *(joined[name] for name in ["index_right", "size", "fraction_right"]))) == wanted
    assert len(sap.join(zones, ships, wrap=360, fraction=(0, 0.6))) == 2
    for name, frame in (("zones", zones), ("ships", ships)):
        frame.to_csv(tmp_path / f"{name}.csv", index=False)
    files = [str(tmp_path / "zones.csv"), str(tmp_path / "ships.csv")]
    assert main(["join", *files, "--wrap", "360", "--measure", "size"]) == 0
    assert sorted(capsys.readouterr().out.split()[1:]) == [f"{a},{b},{size}.0" for a, b, size, _ in wanted]
    assert main(["count", *files, "--wrap", "360"]) == 0
    assert capsys.readouterr().out == "4\n"
    assert main(["count", files[0], "--wrap", "360", "--each"]) == 0
    assert capsys.readouterr().out.split() == ["a,count", "0,1", "1,0", "2,1"]  # two touch
    assert main(["pairs", files[0]]) == 1
    assert "line 2, columns west and east: the box is inverted on axis 0" in capsys.readouterr().err
    assert main(["pairs", files[0], "--wrap", "0"]) == 1
    assert "wrap is 0.0; it must be finite and greater than 0" in capsys.readouterr().err


def test_geometries_wrap() -> None:
    geopandas = pytest.importorskip("geopandas")
    import shapely

    left = geopandas.GeoDataFrame(
        geometry=[
            shapely.box(170, 0, 180, 10),
            shapely.MultiPolygon([shapely.box(178, 0, 180, 10), shapely.box(-180, 0, -178, 10)]),
            shapely.Point(-179, 5),
            shapely.LineString([(355, 0), (365, 10)]),
        ]
    )
    right = geopandas.GeoDataFrame(
        geometry=[
            shapely.Point(181, 5),
            shapely.box(-180, 0, -170, 10),
            shapely.box(179, 0, 183, 10),
            shapely.Point(0, 5),
            None,
        ]
    )
    joined = sap.join(left, right, wrap=360)
    assert list(zip(joined.index, joined["index_right"])) == [
        (0, 1),
        (0, 2),
        (1, 0),
        (1, 1),
        (1, 2),
        (2, 0),
        (2, 1),
        (2, 2),
        (3, 3),
    ]
    assert list(sap.join(left, right, predicate="within", wrap=360)["index_right"]) == [0, 1, 2]
    near = sap.join(left, right, predicate="dwithin", distance=1, wrap=360)
    assert (0, 0) in {*zip(near.index, near["index_right"])} and len(near) == len(joined) + 1
    measured = sap.join(left, right, wrap=360, measures=["size"])["size"].tolist()
    assert measured == [0, 10, 0, 20, 30, 0, 0, 0, 0]
    with pytest.raises(ValueError, match=r"times around a circle of 0\.1: is wrap in their units"):
        sap.join(left, right, wrap=0.1)
    assert len(sap.join(left, right[4:], wrap=360)) == 0
