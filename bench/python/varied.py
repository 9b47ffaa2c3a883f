"""How long interval libraries and shapely take, compared with sweep-and-prune, on many scenes of a kind, each once in a
round: `python varied.py`. Writes results/varied-...json after each case; `python report.py` makes tables of them.

A processor learns the pairs of one scene by heart if it is searched again and again. So each library
meets each scene once in a round, and all libraries meet it one after the other, in an order by chance. A ratio is that
of two times for one scene in one round; the result is the median of all ratios.

Each library gets its input as its documentation recommends, prepared before the clock starts, and answers the whole
question: an index that it needs is built within the time. Its pairs, counts or distances are compared first, on three
scenes of each case.
"""

from __future__ import annotations

import argparse
import statistics
import time
from collections.abc import Callable
from datetime import date
from itertools import chain
from typing import Any

import numpy as np
from common import machine, note, revision, versions, write_results
from numpy.typing import NDArray

import sweep_and_prune as sap

OWN = "sweep-and-prune"
TWO = "sweep-and-prune, 2 threads"
PACKAGES = (
    "numpy shapely pandas polars polars-bio superintervals gtars ncls bioframe ruranges pyranges1 sweep-and-prune"
).split()
Scene = tuple[Any, Any]
Values = NDArray[np.int64]
Prepare = Callable[[Any, Any], Callable[[], Any]]
"""Prepares a library's input for two sets; what it returns answers the question."""


def two_sets(random: np.random.Generator, count: int, is_sorted: bool) -> Scene:
    """Reads and a tenth as many genes on one chromosome: half-open intervals of integers."""
    sets = []
    for number, least, most in ((count, 50, 150), (count // 10, 500, 2000)):
        start = random.integers(0, 100 * count, number)
        if is_sorted:
            start.sort()
        sets.append(np.stack([start, start + random.integers(least, most, number)], axis=1))
    return sets[0], sets[1]


def squares(random: np.random.Generator, count: int, is_sorted: bool) -> Scene:
    """Squares in the plane of which each overlaps about four others; sorted by their left edges."""
    low = random.random((count, 2))
    if is_sorted:
        low = low[np.argsort(low[:, 0])]
    return np.hstack([low, low + count**-0.5]), None


def columns(boxes: Any) -> tuple[Any, Any]:
    """Starts and ends, each contiguous."""
    return np.ascontiguousarray(boxes[:, 0]), np.ascontiguousarray(boxes[:, 1])


def pandas_frame(boxes: Any) -> Any:
    import pandas

    return pandas.DataFrame({"chrom": "chr1", "start": boxes[:, 0], "end": boxes[:, 1]})


def polars_frame(boxes: Any) -> Any:
    import polars
    import polars_bio  # noqa: F401

    rows = {"start": boxes[:, 0], "end": boxes[:, 1], "row": np.arange(len(boxes))}
    frame = polars.DataFrame({"chrom": ["chr1"] * len(boxes), **rows})
    frame.config_meta.set(coordinate_system_zero_based=True)
    return frame


def region_set(boxes: Any) -> Any:
    from gtars.models import RegionSet

    return RegionSet.from_vectors(["chr1"] * len(boxes), *(column.tolist() for column in columns(boxes)))


def closed(boxes: Any) -> tuple[Any, Any]:
    """Starts and ends of closed intervals, as superintervals takes them."""
    starts, ends = columns(boxes)
    return starts.astype(np.int32), ends.astype(np.int32) - 1


# What several questions share: the input of a library, and the name of its function.


def superintervals(function: str) -> Prepare:
    def prepare(a: Any, b: Any) -> Any:
        from superintervals import IntervalMap

        asked, indexed, rows = closed(a), closed(b), np.arange(len(b))
        return lambda: getattr(IntervalMap.from_arrays(*indexed, rows), function)(*asked)

    return prepare


def gtars(function: str) -> Prepare:
    def prepare(a: Any, b: Any) -> Any:
        first, second = region_set(a), region_set(b)
        return lambda: getattr(first, function)(second)

    return prepare


def ruranges(function: str, **options: Any) -> Prepare:
    """The library below pyranges1. (It needs Python 3.12.)"""

    def prepare(a: Any, b: Any) -> Any:
        from ruranges import numpy as functions

        (starts, ends), (starts2, ends2) = columns(a), columns(b)
        ask = getattr(functions, function)
        return lambda: ask(starts=starts, ends=ends, starts2=starts2, ends2=ends2, **options)

    return prepare


def polars_bio(function: str) -> Prepare:
    def prepare(a: Any, b: Any) -> Any:
        import polars_bio

        frames, ask = (polars_frame(a), polars_frame(b)), getattr(polars_bio, function)
        return lambda: ask(*frames, output_type="polars.DataFrame")

    return prepare


def bioframe(function: str, **options: Any) -> Prepare:
    def prepare(a: Any, b: Any) -> Any:
        import bioframe

        frames, ask = (pandas_frame(a), pandas_frame(b)), getattr(bioframe, function)
        return lambda: ask(*frames, **options)

    return prepare


# Pairs of a read and a gene.


def pairs_ncls(a: Any, b: Any) -> Any:
    from ncls import NCLS

    (starts, ends), asked, rows = columns(b), columns(a), np.arange(len(a))
    ids = np.arange(len(b))
    return lambda: NCLS(starts, ends, ids).all_overlaps_both(*asked, rows)


def pairs_of(name: str, found: Any) -> Values:
    """The pairs in what a library returned, each as one number, in order."""
    if name in ("superintervals", "gtars"):
        rows = np.repeat(np.arange(len(found)), [len(others) for others in found])
        others = np.fromiter(chain.from_iterable(found), np.int64, len(rows))
    elif name == "bioframe":
        rows, others = found["index"].to_numpy(), found["index_"].to_numpy()
    elif name == "polars-bio":
        rows, others = found["row_1"].to_numpy(), found["row_2"].to_numpy()
    else:
        rows, others = np.asarray(found) if name in ("ncls", "ruranges", "shapely STRtree") else found.T
    if name == "shapely STRtree":
        is_once = rows < others
        rows, others = rows[is_once], others[is_once]
    return np.sort(rows.astype(np.int64) << 32 | others.astype(np.int64))


# Counts for each read.


def counts_ncls(a: Any, b: Any) -> Any:
    find = pairs_ncls(a, b)
    return lambda: np.bincount(find()[0], minlength=len(a))


def counts_of(name: str, found: Any) -> Values:
    if name == "polars-bio":
        found = found.sort("row")["count"]
    elif name == "bioframe":
        found = found["count"]
    return np.asarray(found, np.int64)


# The nearest gene of each read.


def distances_of(name: str, found: Any) -> Values:
    """How far the nearest one is. Of several that are equally near, libraries choose different ones."""
    if name == "bioframe":
        return np.asarray(found.sort_values("index")["distance"], np.int64)
    if name == "polars-bio":
        return np.asarray(found.sort("row_1")["distance"], np.int64)
    if name == "ruranges":
        rows, _, distances = found
        return np.maximum(distances[np.argsort(rows)].astype(np.int64) - 1, 0)  # 1 is that of neighbors that touch
    return np.asarray(found.distances, np.int64)


def tree(a: Any, _: Any) -> Any:
    import shapely

    shapes = shapely.box(*a.T)
    return lambda: shapely.STRtree(shapes).query(shapes)


CASES: dict[str, tuple[Any, dict[str, Prepare], Callable[[str, Any], Values]]] = {
    "pairs of intervals": (
        two_sets,
        {
            OWN: lambda a, b: lambda: sap.find_pairs_between(a, b, closed="left"),
            TWO: lambda a, b: lambda: sap.find_pairs_between(a, b, closed="left", threads=2),
            "superintervals": superintervals("search_values_batch"),
            "polars-bio": polars_bio("overlap"),
            "gtars": gtars("find_overlaps"),
            "ncls": pairs_ncls,
            "ruranges": ruranges("overlaps"),
            "bioframe": bioframe("overlap", how="inner", return_index=True, return_input=False),
        },
        pairs_of,
    ),
    "counts of intervals": (
        two_sets,
        {
            OWN: lambda a, b: lambda: sap.count_overlaps(a, b, closed="left"),
            "superintervals": superintervals("count_batch"),
            "polars-bio": polars_bio("count_overlaps"),
            "gtars": gtars("count_overlaps"),
            "ncls": counts_ncls,
            "ruranges": ruranges("count_overlaps"),
            "bioframe": bioframe("count_overlaps"),
        },
        counts_of,
    ),
    "nearest intervals": (
        two_sets,
        {
            OWN: lambda a, b: lambda: sap.nearest(a, b),
            "polars-bio": polars_bio("nearest"),
            "ruranges": ruranges("nearest", ties="first"),
            "bioframe": bioframe("closest", return_input=False, return_index=True),
        },
        distances_of,
    ),
    "pairs of squares": (
        squares,
        {
            OWN: lambda a, b: lambda: sap.find_pairs(a),
            TWO: lambda a, b: lambda: sap.find_pairs(a, threads=2),
            "shapely STRtree": tree,
        },
        pairs_of,
    ),
}


def compared(case: str, scenes: list[Scene]) -> tuple[dict[str, Prepare], dict[str, str], float]:
    """The libraries that are installed and right, what is wrong with the others, and how many results there are."""
    _, libraries, answers_of = CASES[case]
    right, wrong, sizes = {}, {}, []
    for name, prepare in libraries.items():
        try:
            for scene in scenes[:3]:
                wanted = answers_of(OWN, libraries[OWN](*scene)())
                found = answers_of(OWN if name == TWO else name, prepare(*scene)())
                if not np.array_equal(found, wanted):
                    wrong[name] = "something else"
                sizes.append(len(wanted))
        except ImportError as error:
            wrong[name] = f"nothing ({error})"
        if name not in wrong:
            right[name] = prepare
    return right, wrong, statistics.mean(sizes)


def measured(libraries: dict[str, Prepare], scenes: list[Scene], rounds: int) -> dict[str, list[float]]:
    """Seconds of each library for each scene in each round."""
    times: dict[str, list[float]] = {name: [] for name in libraries}
    order = np.random.default_rng(1)
    for _ in range(rounds):
        for scene in scenes:
            calls = [(name, prepare(*scene)) for name, prepare in libraries.items()]
            for place in order.permutation(len(calls)).tolist():
                name, call = calls[place]
                start = time.perf_counter()
                found = call()
                times[name].append(time.perf_counter() - start)
                del found
    return times


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--sizes", type=int, nargs="+", default=[100, 1000, 10_000, 100_000])
    parser.add_argument("--rounds", type=int, default=2)
    parser.add_argument("--scenes", type=int, default=100, help="how many of a kind up to 10,000 boxes; a tenth above")
    parser.add_argument("--only", default="", help="only cases whose names contain this text")
    parser.add_argument("--note", default="", help="what else to say of the machine")
    options = parser.parse_args()
    content: dict[str, Any] = {"date": date.today().isoformat(), "machine": machine(), "revision": revision()}
    content |= {"versions": versions(PACKAGES), "cases": []}
    if options.note:
        content["note"] = f"; **{options.note}**"
    for case, (make, _, _) in CASES.items():
        for order in ("random", "sorted"):
            name = f"{case}, {order}"
            if options.only not in name:
                continue
            for count in options.sizes:
                number = options.scenes if count <= 10_000 else max(options.scenes // 10, 3)
                scenes = [
                    make(np.random.default_rng([count, seed]), count, order == "sorted") for seed in range(number)
                ]
                libraries, wrong, found = compared(case, scenes)
                times = measured(libraries, scenes, options.rounds)
                results = {
                    library: {
                        "median_seconds": statistics.median(of),
                        "min_seconds": min(of),
                        "ratio": statistics.median(time / own for time, own in zip(of, times[OWN])),
                        "peak_bytes": None,
                    }
                    for library, of in times.items()
                }
                one = {"case": name, "boxes": count, "scenes": number, "found": round(found), "wrong": wrong}
                content["cases"].append({**one, "results": results})
                shown = ", ".join(f"{library} {of['ratio']:.2f}" for library, of in results.items())
                note(f"{name}, {count}, {round(found)} found: {shown}; {wrong or ''}")
                write_results("varied", content)


if __name__ == "__main__":
    main()
