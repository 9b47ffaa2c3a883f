"""Draws tables of every library and dtype, with the values that they hold as Python's own numbers and times.

A coordinate is a `Fraction`, a time or a duration a number of nanoseconds, infinity stays a `float`, and None is
missing. Comparing these is exact, so the oracle has no rule of its own.
"""

from __future__ import annotations

import datetime as dt
import math
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction
from importlib.util import find_spec
from random import Random
from typing import Any, NamedTuple

import numpy as np

Value = Any
NANOSECONDS = {"ns": 1, "us": 10**3, "ms": 10**6, "s": 10**9, "D": 86_400 * 10**9}
MIN, MAX = -(2**63) + 1, 2**63 - 1
ZONE = dt.timezone(dt.timedelta(hours=2))
HAS_SHAPES = all(map(find_spec, ("geopandas", "pandas", "shapely")))
LIBRARIES = ["numpy", "lists", *(name for name in ("pandas", "polars", "pyarrow") if find_spec(name))]


class Kind(NamedTuple):
    """A way to store a column."""

    name: str
    hold: Any
    """The nearest value that it holds, or None if there is none."""
    make: Any
    """The column. None is missing."""
    has_missing: bool = True
    is_single: bool = False
    """Whether it is floating point of single precision."""
    is_float: bool = False


class Column(NamedTuple):
    kind: Kind
    values: list[Value]
    given: Any


# What a column holds.


def integer(low: int, high: int) -> Callable[[Value], Value]:
    return lambda value: value if abs(value) != math.inf and value.denominator == 1 and low <= value <= high else None


def floating(dtype: Any) -> Callable[[Value], Value]:
    def hold(value: Value) -> Value:
        with np.errstate(over="ignore"):
            number = float(dtype(float(value)))
        return number if abs(number) == math.inf else Fraction(number)

    return hold


def decimal(value: Value) -> Value:
    return value if abs(value) < 10**30 and (value * 100).denominator == 1 else None


def ticks(unit: str) -> Callable[[Value], Value]:
    def hold(value: Value) -> Value:
        count = value // NANOSECONDS[unit]
        return count * NANOSECONDS[unit] if MIN <= count <= MAX else None

    return hold


def of_python(value: Value) -> Value:
    """What `datetime` holds."""
    held = value // 1000 * 1000
    return held if abs(held) < 8000 * 365 * NANOSECONDS["D"] and held > -1900 * 365 * NANOSECONDS["D"] else None


# How it is written.


def number(value: Value) -> Any:
    if value is None or abs(value) == math.inf:
        return value
    return int(value) if value.denominator == 1 else float(value)


def counts(values: list[Value], unit: str) -> list[Any]:
    return [None if value is None else value // NANOSECONDS[unit] for value in values]


def array(values: list[Value], dtype: Any) -> Any:
    return np.array([math.nan if value is None else number(value) for value in values], dtype)


def masked(values: list[Value], dtype: str) -> Any:
    """Nullable integers of pandas, whose own constructor rounds some."""
    import pandas

    filled = np.array([0 if value is None else int(value) for value in values], dtype)
    return pandas.arrays.IntegerArray(filled, np.array([value is None for value in values], bool))


def times(values: list[Value], unit: str, letter: str) -> Any:
    filled = [np.iinfo(np.int64).min if count is None else count for count in counts(values, unit)]
    return np.array(filled, np.int64).view(f"{letter}8[{unit}]")


def date_time(value: Value, zone: Any = None) -> Any:
    if value is None:
        return None
    since = dt.timedelta(microseconds=value // 1000)
    return (
        dt.datetime(1970, 1, 1) + since
        if zone is None
        else (dt.datetime(1970, 1, 1, tzinfo=dt.timezone.utc) + since).astimezone(zone)
    )


def duration(value: Value) -> Any:
    return None if value is None else dt.timedelta(microseconds=value // 1000)


def dec(value: Value) -> Any:
    return None if value is None else Decimal(int(value * 100)).scaleb(-2)


def integers() -> list[tuple[str, int, int]]:
    signed = [(f"int{bits}", -(2 ** (bits - 1)), 2 ** (bits - 1) - 1) for bits in (8, 16, 32, 64)]
    return signed + [(f"uint{bits}", 0, 2**bits - 1) for bits in (8, 16, 32, 64)]


def numbers_of(library: str) -> list[Kind]:
    """The kinds of columns of numbers."""
    plain = [Kind(name, integer(*ends), lambda v, n=name: array(v, n), False) for name, *ends in integers()]
    plain += [
        Kind(name, floating(getattr(np, name)), lambda v, n=name: array(v, n), True, name == "float32", True)
        for name in ("float16", "float32", "float64")
    ]
    lists = Kind(
        "list",
        lambda value: floating(float)(value) if abs(value) == math.inf or value.denominator > 1 else value,
        lambda v: [number(one) for one in v],
    )
    if library == "numpy":
        return plain
    if library == "lists":
        return [lists, Kind("Fraction", lambda value: value, list), Kind("Decimal", decimal, lambda v: [*map(dec, v)])]
    if library == "pandas":
        import pandas

        series = pandas.Series
        found = [kind._replace(make=lambda v, k=kind: series(k.make(v))) for kind in plain if kind.name != "float16"]
        for name, *ends in integers():
            found.append(Kind(f"masked {name}", integer(*ends), lambda v, n=name: series(masked(v, n))))
            dtype = f"{name}[pyarrow]"
            found.append(Kind(dtype, integer(*ends), lambda v, d=dtype: series([*map(number, v)], dtype=d)))
        for dtype, of, single in (
            ("Float32", np.float32, True),
            ("Float64", np.float64, False),
            ("float[pyarrow]", np.float32, True),
            ("double[pyarrow]", np.float64, False),
        ):
            found.append(
                Kind(
                    dtype,
                    floating(of),
                    lambda v, d=dtype: series([None if one is None else float(one) for one in v], dtype=d),
                    True,
                    single,
                    True,
                )
            )
        found.append(Kind("object", lists.hold, lambda v: series(lists.make(v), dtype=object)))
        found.append(
            Kind("category", integer(-(2**63), 2**63 - 1), lambda v: series(pandas.Categorical([*map(number, v)])))
        )
        return found
    if library == "polars":
        import polars

        found = [
            Kind(name, integer(*ends), lambda v, n=name: polars.Series([*map(number, v)], dtype=getattr(polars, n)))
            for name, *ends in [
                (name.replace("uint", "UInt").replace("int", "Int"), low, high) for name, low, high in integers()
            ]
        ]
        found += [
            Kind(
                name,
                floating(of),
                lambda v, n=name: polars.Series(
                    [None if one is None else float(one) for one in v], dtype=getattr(polars, n)
                ),
                True,
                name == "Float32",
                True,
            )
            for name, of in (("Float32", np.float32), ("Float64", np.float64))
        ]
        found.append(Kind("Decimal", decimal, lambda v: polars.Series([*map(dec, v)], dtype=polars.Decimal(38, 2))))
        found.append(
            Kind("Int128", integer(-(2**100), 2**100), lambda v: polars.Series([*map(number, v)], dtype=polars.Int128))
        )
        return found
    import pyarrow

    found = [
        Kind(name, integer(*ends), lambda v, n=name: pyarrow.array([*map(number, v)], getattr(pyarrow, n)()))
        for name, *ends in integers()
    ]
    found += [
        Kind(
            name,
            floating(getattr(np, name)),
            lambda v, n=name: pyarrow.array([None if one is None else float(one) for one in v], getattr(pyarrow, n)()),
            True,
            name == "float32",
            True,
        )
        for name in ("float32", "float64")
    ]
    found.append(Kind("decimal", decimal, lambda v: pyarrow.array([*map(dec, v)], pyarrow.decimal128(38, 2))))
    found.append(
        Kind(
            "dictionary",
            integer(-(2**63), 2**63 - 1),
            lambda v: pyarrow.array([*map(number, v)], pyarrow.int64()).dictionary_encode(),
        )
    )
    found.append(
        Kind(
            "chunked",
            integer(0, 2**64 - 1),
            lambda v: pyarrow.chunked_array([[*map(number, v[:1])], [*map(number, v[1:])]], pyarrow.uint64()),
        )
    )
    return found


def times_of(library: str, is_zoned: bool) -> list[Kind]:
    """The kinds of columns of times, with or without a time zone."""
    if library == "numpy":
        return [] if is_zoned else [Kind(f"M8[{u}]", ticks(u), lambda v, u=u: times(v, u, "M")) for u in NANOSECONDS]
    if library == "lists":
        zone = ZONE if is_zoned else None
        found = [Kind("datetime", of_python, lambda v: [date_time(one, zone) for one in v])]
        if not is_zoned:
            found.append(Kind("datetime64", ticks("ns"), lambda v: list(times(v, "ns", "M"))))
        return found
    units = ("s", "ms", "us", "ns")
    if library == "pandas":
        import pandas

        found = []
        for unit in units:

            def make(v: list[Value], unit: str = unit) -> Any:
                naive = pandas.Series(times(v, unit, "M"))
                return naive.dt.tz_localize("UTC").dt.tz_convert("Asia/Tokyo") if is_zoned else naive

            # pandas has years up to 9999 only where it converts zones.
            found.append(
                Kind(
                    f"datetime64[{unit}]",
                    lambda value, u=unit: ticks(u)(value) if of_python(value) is not None else None,
                    make,
                )
            )
            if find_spec("pyarrow") and unit == "ms" and not is_zoned:
                dates = lambda v: pandas.Series(pandas.arrays.ArrowExtensionArray(date64(v)))  # noqa: E731
                found.append(Kind("date64[pyarrow]", day_of_milliseconds, dates))
            if find_spec("pyarrow"):
                name = f"timestamp[{unit}{', tz=UTC' if is_zoned else ''}][pyarrow]"
                found.append(
                    Kind(
                        name,
                        ticks(unit),
                        lambda v, u=unit: pandas.Series(pandas.arrays.ArrowExtensionArray(arrow_times(v, u, is_zoned))),
                    )
                )
        return found
    if library == "polars":
        import polars

        name_of_zone = "Europe/Berlin" if is_zoned else None
        found = [
            Kind(
                f"Datetime({u})",
                ticks(u),
                lambda v, u=u: polars.Series(counts(v, u), dtype=polars.Int64).cast(polars.Datetime(u, name_of_zone)),
            )
            for u in units[1:]
        ]
        if not is_zoned:
            found.append(
                Kind(
                    "Date",
                    lambda value: ticks("D")(value) if abs(value) < 2**31 * NANOSECONDS["D"] else None,
                    lambda v: polars.Series(counts(v, "D"), dtype=polars.Int32).cast(polars.Date),
                )
            )
        return found
    import pyarrow

    found = [Kind(f"timestamp({u})", ticks(u), lambda v, u=u: arrow_times(v, u, is_zoned)) for u in units]
    if not is_zoned:
        found.append(
            Kind(
                "date32",
                lambda value: ticks("D")(value) if abs(value) < 2**31 * NANOSECONDS["D"] else None,
                lambda v: pyarrow.array(counts(v, "D"), pyarrow.int32()).cast(pyarrow.date32()),
            )
        )
        found.append(Kind("date64", day_of_milliseconds, date64))
    return found


def day_of_milliseconds(value: Value) -> Value:
    held = ticks("D")(value)
    return held if held is not None and ticks("ms")(held) is not None else None


def date64(values: list[Value]) -> Any:
    import pyarrow

    return pyarrow.array(counts(values, "ms"), pyarrow.int64()).cast(pyarrow.date64())


def arrow_times(values: list[Value], unit: str, is_zoned: bool) -> Any:
    import pyarrow

    return pyarrow.array(counts(values, unit), pyarrow.int64()).cast(
        pyarrow.timestamp(unit, "UTC" if is_zoned else None)
    )


def durations_of(library: str) -> list[Kind]:
    """The kinds of columns of durations."""
    if library == "lists":
        return [Kind("timedelta", of_python, lambda v: [*map(duration, v)])]
    if library == "polars":
        import polars

        return [
            Kind(
                f"Duration({u})",
                ticks(u),
                lambda v, u=u: polars.Series(counts(v, u), dtype=polars.Int64).cast(polars.Duration(u)),
            )
            for u in ("ms", "us", "ns")
        ]
    if library == "pyarrow":
        import pyarrow

        return [
            Kind(
                f"duration({u})",
                ticks(u),
                lambda v, u=u: pyarrow.array(counts(v, u), pyarrow.int64()).cast(pyarrow.duration(u)),
            )
            for u in ("s", "ms", "us", "ns")
        ]
    found = [Kind(f"m8[{u}]", ticks(u), lambda v, u=u: times(v, u, "m")) for u in ("s", "ms", "us", "ns")]
    if library == "pandas":
        import pandas

        return [kind._replace(make=lambda v, k=kind: pandas.Series(k.make(v))) for kind in found]
    return found


def words_of(library: str) -> list[Kind]:
    """The kinds of columns of text."""
    same = lambda value: value  # noqa: E731
    if library == "numpy":
        return [
            Kind("O", same, lambda v: np.array(v, object)),
            Kind("U", lambda value: None if value.endswith("\0") else value, lambda v: np.array(v, str), False),
        ]
    if library == "lists":
        return [Kind("list", same, list)]
    if library == "pandas":
        import pandas

        found = [
            Kind(dtype, same, lambda v, d=dtype: pandas.Series(v, dtype=d))
            for dtype in ("object", "string", "category", "string[pyarrow]")
        ]
        return found if find_spec("pyarrow") else found[:3]
    if library == "polars":
        import polars

        def enum(v: list[Value]) -> Any:
            names = sorted({one for one in v if one is not None}, reverse=len(v) % 2 == 0)
            return polars.Series(v, dtype=polars.Enum([*names, "other"]))

        return [
            Kind("String", same, lambda v: polars.Series(v, dtype=polars.String)),
            Kind("Categorical", same, lambda v: polars.Series(v, dtype=polars.Categorical)),
            Kind("Enum", same, enum),
        ]
    import pyarrow

    return [
        Kind(name, same, lambda v, n=name: pyarrow.array(v, getattr(pyarrow, n)()))
        for name in ("string", "large_string", "string_view")
    ] + [Kind("dictionary", same, lambda v: pyarrow.array(v, pyarrow.string()).dictionary_encode())]


def truths_of(library: str) -> list[Kind]:
    same = lambda value: value  # noqa: E731
    if library == "numpy":
        return [Kind("bool", same, lambda v: np.array(v, bool), False)]
    if library == "pandas":
        import pandas

        return [Kind("boolean", same, lambda v: pandas.Series(v, dtype="boolean"))]
    if library == "polars":
        import polars

        return [Kind("Boolean", same, lambda v: polars.Series(v, dtype=polars.Boolean))]
    if library == "pyarrow":
        import pyarrow

        return [Kind("bool", same, lambda v: pyarrow.array(v, pyarrow.bool_()))]
    return [Kind("list", same, list)]


KINDS: dict[tuple[str, str], list[Kind]] = {}


def kinds_of(library: str, what: str) -> list[Kind]:
    """All kinds of columns of a library for values of one sort."""
    if (library, what) not in KINDS:
        make: Any = {
            "numbers": numbers_of,
            "times": lambda one: times_of(one, False),
            "zoned": lambda one: times_of(one, True),
            "durations": durations_of,
            "text": words_of,
            "truth": truths_of,
            "mixed": words_of,
        }[what]
        KINDS[library, what] = make(library)
    return KINDS[library, what]


# What values there are.

CENTERS = [0, 0, 100, 2**24, 2**53, 2**53, -(2**53), 2**63, 2**63, -(2**63), 2**64, 2**70]
YEARS = [0, 0, 18262, 106_751, 213_503, 213_504, 253_000, -60_000]
"""In days since 1970; 213,503.98 days are 2^64 nanoseconds."""


def some_value(random: Random, what: str, center: Any) -> Value:
    if what == "numbers":
        if random.random() < 0.04:
            return random.choice([-math.inf, math.inf])
        return center + Fraction(random.randint(-6, 6), random.choice([1, 1, 1, 2, 4]))
    unit = random.choice(["ns", "us", "ms", "s", "D"])
    return center + random.randint(-3, 3) * NANOSECONDS[unit]


def some_center(random: Random, what: str) -> Any:
    if what == "numbers":
        return Fraction(random.choice(CENTERS))
    if what == "durations":
        return random.choice([0, 2**64, 86_400 * 10**13])
    return random.choice([*(days * NANOSECONDS["D"] for days in YEARS), 2**64, 2**63])


def a_column(random: Random, library: str, what: str, wanted: list[Value], single: bool = False) -> Column | None:
    """A column of a drawn kind (perhaps only of single precision) that holds these values, or the nearest ones."""
    fitting = []
    for kind in kinds_of(library, what):
        if single and not kind.is_single:
            continue
        held = [None if one is None else kind.hold(one) for one in wanted]
        if [one is None for one in held] == [one is None for one in wanted] and (
            kind.has_missing or None not in wanted
        ):
            fitting.append((kind, held))
    if not fitting:
        return None
    kind, held = random.choice(fitting)
    return Column(kind, held, kind.make(held))


def a_table_of_shapes(boxes: dict[str, Column], columns: dict[str, Any]) -> Any:
    """The boxes as rectangles of a `GeoDataFrame`, without one where a number is missing, and other columns."""
    import geopandas
    import pandas
    import shapely

    rows = list(zip(*(column.values for column in boxes.values())))
    shapes = [None if None in row else shapely.box(*map(float, row)) for row in rows]
    return geopandas.GeoDataFrame(pandas.DataFrame(columns, index=range(len(rows))), geometry=shapes)


def a_table(library: str, columns: dict[str, Column]) -> Any:
    """The columns as a table of a library."""
    given = {name: column.given for name, column in columns.items()}
    if library == "pandas":
        import pandas

        return pandas.DataFrame(given)
    if library == "polars":
        import polars

        return polars.DataFrame(given)
    if library == "pyarrow":
        import pyarrow

        return pyarrow.table(given)
    return given
