"""Random tables of every library and dtype, different ones on the two sides, against an oracle that compares Python's
own numbers and times: 400 calls, or 20,000 with TEST_LONG. `TABLES` and `SEED` choose others."""

from __future__ import annotations

import csv
import io
import math
import os
from contextlib import redirect_stderr, redirect_stdout
from fractions import Fraction
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np
from tables import (
    HAS_SHAPES,
    LIBRARIES,
    NANOSECONDS,
    Column,
    Kind,
    a_column,
    a_table,
    a_table_of_shapes,
    some_center,
    some_value,
    ticks,
)

import sweep_and_prune as sap
from sweep_and_prune._command import main

TABLES = int(os.environ.get("TABLES", 20_000 if "TEST_LONG" in os.environ else 400))
SEED = int(os.environ.get("SEED", 1))
TABLES_DRAWN = 4
CALLS_OF_TABLES = 20
"""With tables that were drawn together, each call with other ones and with other options."""
NAMES = {
    1: ["start", "end"],
    2: ["minx", "miny", "maxx", "maxy"],
    3: ["minx", "miny", "minz", "maxx", "maxy", "maxz"],
}
WORDS = ["a", "a\0", "b", "1", "1.0", "nan", ""]
POOLS: dict[str, list[Any]] = {
    "text": WORDS,
    "truth": [True, False],
    "mixed": [1, "1", b"1", "1\0", Fraction(1, 2), "0.5", (1, "1"), (1, 1)],
}
"""Values of groups; of the other kinds they depend on a center."""


class Table:
    """A table of a library, and what it holds."""

    def __init__(
        self,
        random: Random,
        what: str,
        center: Any,
        dimensions: int,
        groups: list[str],
        single: bool,
        like: Table | None = None,
        has_shapes: bool = False,
    ) -> None:
        """Half of the tables are of the library of the first one, so that the two can be joined."""
        # NumPy has no times with a zone.
        of_zones = [name for name in LIBRARIES if name != "numpy"]
        self.library = random.choice(of_zones if "zoned" in (what, *groups) else LIBRARIES)
        if like is not None and random.random() < 0.5:
            self.library = like.library
        if (single and self.library == "lists") or groups == ["mixed"]:
            self.library = "numpy" if single else "lists"
        self.what = what
        self.has_shapes = has_shapes
        if has_shapes:
            self.library = "pandas"
        count = random.choice([0, 1, 2, 4, 7])
        self.boxes: dict[str, Column] = {}
        names, half = NAMES[dimensions], dimensions
        for axis in range(half):
            ends = [[some_value(random, what, center) for _ in "lh"] for _ in range(count)]
            if random.random() < 0.95 or self.has_shapes:
                ends = [sorted(pair) for pair in ends]
            if what == "numbers" and random.random() < 0.1 and not self.has_shapes:
                ends = [random.choice([pair, [-math.inf] * 2, [math.inf] * 2]) for pair in ends]
            for end in (0, 1):
                wanted = [None if random.random() < 0.05 else pair[end] for pair in ends]
                if self.has_shapes:  # whose coordinates are double precision, and finite
                    held = [one if one is None or abs(one) < math.inf else Fraction(0) for one in wanted]
                    held = [None if one is None else Fraction(float(one)) for one in held]
                    self.boxes[names[axis + end * half]] = Column(OF_SHAPES, held, None)
                    continue
                while (column := a_column(random, self.library, what, wanted, single)) is None:
                    wanted = [some_value(random, what, 0) for _ in wanted]
                self.boxes[names[axis + end * half]] = column
        self.boxes = {name: self.boxes[name] for name in names}
        self.groups: dict[str, Column] = {}
        for number, sort in enumerate(groups):
            pool = POOLS[sort] if sort in POOLS else near(sort, some_center(random, sort))
            while (
                column := a_column(
                    random,
                    self.library,
                    sort,
                    [None if random.random() < 0.1 else random.choice(pool) for _ in range(count)],
                )
            ) is None:
                pool = near(sort, 0) if sort not in POOLS else pool
            self.groups[f"group{number}"] = column
        self.count = count
        if self.has_shapes:
            self._sort_corners()
            self.given = a_table_of_shapes(self.boxes, {name: one.given for name, one in self.groups.items()})
        else:
            self.given = a_table(self.library, {**self.boxes, **self.groups})

    def _sort_corners(self) -> None:
        """A rectangle has no inverted sides. (A number that was infinite became 0.)"""
        for low, high in (("minx", "maxx"), ("miny", "maxy")):
            for row, pair in enumerate(zip(self.boxes[low].values, self.boxes[high].values)):
                if None not in pair:
                    self.boxes[low].values[row], self.boxes[high].values[row] = sorted(pair)

    def with_rows(self) -> Any:
        """The table with a column of the numbers of rows."""
        if self.library == "polars":
            return self.given.with_row_index("row")
        given = self.given.copy()
        given["row"] = range(self.count)
        return given

    def box(self, row: int) -> list[Any]:
        return [column.values[row] for column in self.boxes.values()]

    def group(self, row: int) -> list[Any]:
        return [column.values[row] for column in self.groups.values()]

    def __repr__(self) -> str:
        columns = {**self.boxes, **self.groups}.items()
        return f"{self.library}: " + "; ".join(f"{name} {column.kind.name} {column.values}" for name, column in columns)

    @property
    def is_exact(self) -> bool:
        """Whether all coordinates are integers."""
        return not any(one.kind.is_float for one in self.boxes.values()) and not any(
            isinstance(value, float) or getattr(value, "denominator", 1) > 1
            for one in self.boxes.values()
            for value in one.values
        )


OF_SHAPES = Kind("shapes", None, None, True, False, True)


def near(sort: str, base: Any) -> list[Any]:
    """Values that are nearly equal."""
    if sort == "numbers":
        return [base, base + 1, base - 1, base + Fraction(1, 2)]
    return [base, base + 2**64, base + 1, base + NANOSECONDS["s"], base % NANOSECONDS["D"]]


def is_inverted(box: list[Any]) -> bool:
    half = len(box) // 2
    return any(low > high for low, high in zip(box[:half], box[half:]))


def pair_up(a: list[Any], b: list[Any], closed: str, margin: Any, rounded: Any) -> bool:
    """Whether two boxes pair, by definition. `rounded` is what a sum becomes."""
    half = len(a) // 2
    for one in (a, b):
        if closed != "both" and any(low == high for low, high in zip(one[:half], one[half:])):
            return False
    for axis in range(half):
        for first, second in ((a, b), (b, a)):
            low, high = first[axis], second[axis + half]
            if margin != 0:
                high = rounded(high, margin)
            if low > high or (low == high and closed != "both"):
                return False
    return True


def exact_sum(end: Any, margin: Any) -> Any:
    return end if isinstance(end, float) else end + margin


def sum_of(dtype: Any) -> Any:
    def add(end: Any, margin: Any) -> Any:
        if isinstance(end, float):
            return end
        with np.errstate(over="ignore"):
            number = float(dtype(float(end + margin)))
        return number if abs(number) == math.inf else Fraction(number)

    return add


def a_margin(random: Random, what: str, exact: bool) -> tuple[Any, Any]:
    """A margin as it is passed, and what it is."""
    if random.random() < 0.5:
        return 0, 0
    if what == "numbers":
        given = random.choice([1, 2, 2**53 + 1, 2**70]) if exact else random.choice([1, 0.5, 2, 3.0, 1e39, 1e300])
        return given, Fraction(given)
    unit: Any = random.choice(["ns", "us", "s", "D"])
    count = random.choice([1, 2, 5])
    return np.timedelta64(count, unit), count * NANOSECONDS[unit]


def wanted_of(a: Table, b: Table, closed: str, margin: Any, is_single: bool, rounded: Any) -> Any:
    """The pairs, or the error."""
    present = [[row for row in range(one.count) if None not in one.box(row)] for one in (a, b)]
    if any(is_inverted(one.box(row)) for one, rows in zip((a, b), present) for row in rows):
        return sap.InvalidBoxError
    found = set()
    for i in present[0]:
        for j in present[1]:
            if is_single and j <= i:
                continue
            left, right = a.group(i), b.group(j)
            if None not in left and None not in right and left == right:
                if pair_up(a.box(i), b.box(j), closed, margin, rounded):
                    found.add((i, j))
    return found


def counts_of(pairs: set[tuple[int, int]], rows: int, is_single: bool) -> list[int]:
    """How many pairs each row of the first set has."""
    return [sum(i == row or (is_single and j == row) for i, j in pairs) for row in range(rows)]


def clusters_of(pairs: set[tuple[int, int]], has_box: list[bool]) -> list[int]:
    """The cluster of each row, numbered in the order of their first rows; -1 for a row without a box."""
    labels = [row if has else -1 for row, has in enumerate(has_box)]
    for _ in labels:
        for i, j in pairs:
            labels[i] = labels[j] = min(labels[i], labels[j])
    numbers = {label: number for number, label in enumerate(sorted({one for one in labels if one >= 0}))}
    return [numbers.get(label, -1) for label in labels]


class Drawn(NamedTuple):
    """Tables that can be searched together."""

    what: str
    """What their coordinates are."""
    groups: list[str]
    """What each column of groups has."""
    tables: list[Table]


def drawn_tables(random: Random) -> Drawn:
    """Tables of one sort of coordinates and groups, near each other, each of a library and of dtypes of its own."""
    what = random.choice(["numbers", "numbers", "numbers", "times", "zoned", "durations"])
    dimensions = random.choice([1, 1, 2, 2, 3])
    groups = random.choice(
        [[], [], ["numbers"], ["text"], ["times"], ["zoned"], ["truth"], ["numbers", "text"], ["numbers", "numbers"]]
    )
    center = some_center(random, what)
    single = what == "numbers" and "zoned" not in groups and random.random() < 0.15
    if not single and random.random() < 0.04:
        groups = ["mixed"]
    of_shapes = HAS_SHAPES and random.random() < 0.15
    if of_shapes:
        what, dimensions, center, single = "numbers", 2, some_center(random, "numbers"), False
        groups = [] if groups == ["mixed"] else groups
    tables: list[Table] = []
    for _ in range(TABLES_DRAWN):
        has_shapes = of_shapes and (not tables or random.random() < 0.8)
        like = tables[0] if tables else None
        tables.append(Table(random, what, center, dimensions, groups, single, like, has_shapes))
    return Drawn(what, groups, tables)


def table_call(random: Random, drawn: Drawn) -> None:
    """One call with one or two of these tables."""
    what, groups = drawn.what, drawn.groups
    is_single = groups == ["mixed"] or random.random() < 0.4
    a, b = [random.choice(drawn.tables)] * 2 if is_single else random.sample(drawn.tables, 2)
    exact = what != "numbers" or (a.is_exact and b.is_exact)
    margin, amount = a_margin(random, what, exact)
    closed = random.choice(["both", "both", "left", "right", "neither"])
    options: dict[str, Any] = {"closed": closed, "missing": "skip", "margin": margin}
    if groups:
        options["by"] = [*a.groups] if len(groups) > 1 or random.random() < 0.5 else "group0"
    columns = [column.kind for one in (a, b) for column in one.boxes.values()]
    sums = (
        [exact_sum]
        if exact
        else [sum_of(np.float32)]
        if all(one.is_single for one in columns)
        else [exact_sum, sum_of(float), sum_of(np.float32)]
    )
    allowed = [wanted_of(a, b, closed, amount, is_single, rounded) for rounded in sums]
    sets = (a.given,) if is_single else (a.given, b.given)
    ask = random.choice(["pairs", "pairs", "pairs", "count", "counts", "cluster" if is_single else "counts"])

    class Said:
        """What was called, which takes long to write."""

        def __str__(self) -> str:
            return f"\na: {a!r}\nb: {b!r}\n{options} {ask} wanted {allowed}"

    said = Said()
    try:
        if ask == "count":
            count = sap.count_pairs(*sets, **options) if is_single else sap.count_pairs_between(*sets, **options)
        elif ask == "counts":
            counts = sap.count_overlaps(*sets, **options)
        elif ask == "cluster":
            labels = sap.cluster(*sets, **options)
        else:
            pairs = sap.find_pairs(*sets, **options) if is_single else sap.find_pairs_between(*sets, **options)
    except sap.InvalidBoxError:
        assert sap.InvalidBoxError in allowed, said
        return
    except ValueError as error:
        if "which none" in str(error) or "none of them holds" in str(error):
            # The columns of a table become one array.
            assert any(no_unit_holds(one) for one in (a, b)), said
            return
        if "it must be a whole number for integers beyond 2^53" in str(error):
            assert margin == 0.5 and any(one.count == 0 or one.is_exact for one in (a, b)), said
            return
        raise AssertionError(f"{error}{said}") from error
    except Exception as error:
        raise AssertionError(f"{type(error)} {error}{said}") from error
    if ask == "count":
        assert any(wanted != sap.InvalidBoxError and count == len(wanted) for wanted in allowed), f"{count}{said}"
        return
    if ask == "counts":
        of_rows = [counts_of(wanted, a.count, is_single) for wanted in allowed if wanted != sap.InvalidBoxError]
        assert counts.tolist() in of_rows, f"{counts}{said}"
        return
    if ask == "cluster":
        has_box = [None not in a.box(row) for row in range(a.count)]
        of_rows = [clusters_of(wanted, has_box) for wanted in allowed if wanted != sap.InvalidBoxError]
        assert labels.tolist() in of_rows, f"{labels}{said}"
        return
    found = {(i, j) for i, j in pairs.tolist()}
    assert len(found) == len(pairs) and found in allowed, f"{sorted(found)}{said}"
    joinable = a.library == b.library and a.library in ("pandas", "polars") and not is_single
    joinable = joinable and a.has_shapes == b.has_shapes
    if joinable and allowed[0] is not sap.InvalidBoxError:
        distance = None if margin == 0 else margin
        of_boxes: dict[str, Any] = {"closed": closed, "distance": distance}
        if a.has_shapes:  # shapely's distance is not that of boxes
            of_boxes = {}
            found = {(i, j) for i, j in wanted_of(a, b, "both", 0, False, exact_sum)}
        how = random.choice(["inner", "inner", "left", "right"])
        joined = sap.join(a.with_rows(), b.with_rows(), how, by=options.get("by"), **of_boxes)
        columns_of_rows = [joined[name] for name in ("row_left", "row_right")]
        rows = [[None if one != one else one for one in column.to_list()] for column in columns_of_rows]
        wanted = list(found)
        if how == "left":
            wanted += [(i, None) for i in range(a.count) if i not in {left for left, _ in found}]
        elif how == "right":
            wanted += [(None, j) for j in range(b.count) if j not in {right for _, right in found}]
        kept = how == "right"
        in_order = sorted(wanted, key=lambda pair: (pair[kept], -1 if pair[not kept] is None else pair[not kept]))
        assert list(zip(*rows)) == in_order, f"join {how}: {list(zip(*rows))}, not {in_order}{said}"


def text_call(random: Random, path: Path) -> None:
    """One file of text, which is read exactly, or refused if it could be misread."""
    center = some_center(random, "numbers")
    rows: list[list[str]] = []
    boxes = []
    for _ in range(random.choice([1, 2, 5])):
        ends = sorted(some_value(random, "numbers", center) for _ in "lh")
        if random.random() < 0.5:
            ends = [one if isinstance(one, float) else Fraction(round(one)) for one in ends]
        cells = [str(one) if isinstance(one, float) or one.denominator == 1 else repr(float(one)) for one in ends]
        boxes.append(
            [
                float(one) if "inf" in one else Fraction(int(one) if one.lstrip("-").isdigit() else float(one))
                for one in cells
            ]
        )
        rows.append([*cells, random.choice(["a", "5,5", "two\nlines", 'say "x"', ""])])
    is_wrong = any(low > high for low, high in boxes)
    names = ["minx", "maxx", "name"]
    quoting: Any = random.choice([csv.QUOTE_MINIMAL, csv.QUOTE_ALL])
    damage = random.choice(["none", "none", "quote", "cells", "digits", "names"])
    row = random.choice(rows)
    if damage == "cells":
        row += ["more"]
    elif damage == "digits":
        row[0] = random.choice(["1_0", "\u0661", "0x10", "1e999"])
    elif damage == "names":
        names[2] = random.choice(["Min_X", "minx", "MAXX"])
        for one in rows:
            one[2] = one[names[2] == "MAXX"]  # what would be a coordinate, too
    text = io.StringIO()
    writer = csv.writer(text, quoting=quoting, lineterminator=random.choice(["\n", "\r\n"]))
    writer.writerows([names, *rows])
    written = text.getvalue()
    if damage == "quote":
        at = written.index("\n") + 1
        written = written[:at] + '0,1,"' + written[at:].replace('"', "")
    path.write_bytes(written.encode())
    wanted = sum(pair_up(a, b, "both", 0, None) for i, a in enumerate(boxes) for b in boxes[:i])
    with redirect_stdout(io.StringIO()) as output, redirect_stderr(io.StringIO()) as errors:
        status = main(["count", str(path)])
    found = (status, output.getvalue(), errors.getvalue().count("\n"))
    said = f"{found} {errors.getvalue()[:300]}, wanted {wanted} ({damage}):\n{written[:500]}"
    assert found == ((0, f"{wanted}\n", 0) if damage == "none" and not is_wrong else (1, "", 1)), said


def no_unit_holds(table: Table) -> bool:
    """Whether the finest unit of a table's columns does not have all of its times."""
    values = [value for column in table.boxes.values() for value in column.values if value is not None]
    return any(ticks("ns")(value) is None for value in values)


def test_tables_of_every_library_pair_as_their_values_do() -> None:
    # To draw a table takes as long as several calls.
    for seed in range(SEED, SEED + math.ceil(TABLES / CALLS_OF_TABLES)):
        random = Random(seed)
        try:
            drawn = drawn_tables(random)
            for _ in range(CALLS_OF_TABLES):
                table_call(random, drawn)
        except AssertionError as error:
            raise AssertionError(f"SEED={seed} TABLES=1: {error}") from error


def test_files_of_text_pair_as_their_values_do(tmp_path: Path) -> None:
    for seed in range(SEED, SEED + TABLES):
        try:
            text_call(Random(seed), tmp_path / "a.csv")
        except AssertionError as error:
            raise AssertionError(f"SEED={seed} TABLES=1: {error}") from error
