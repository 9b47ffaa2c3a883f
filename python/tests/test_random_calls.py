"""Random calls of every part of the API against NumPy: 1,000, or 100,000 with TEST_LONG. `CALLS` and `SEED` choose
others. Boxes have few distinct coordinates, all exact in both precisions, so that ties are common."""

from __future__ import annotations

import io
import os
from contextlib import redirect_stdout
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from oracle import Array, in_order

import sweep_and_prune as sap
from sweep_and_prune._command import main

CALLS = int(os.environ.get("CALLS", 100_000 if "TEST_LONG" in os.environ else 1000))
SEED = int(os.environ.get("SEED", 1))
PARTS = 8
COLUMNS = {
    1: ["start", "end"],
    2: ["minx", "miny", "maxx", "maxy"],
    3: [f"{axis}{end}" for end in "12" for axis in "xyz"],
}
Random = np.random.Generator


def one_of(random: Random, options: list[Any]) -> Any:
    return options[int(random.integers(len(options)))]


def some_boxes(random: Random, dimensions: int, dtype: Any) -> Array:
    count = int(random.choice([0, 1, 2, 9, 25, 60]))
    low = random.integers(-2, 9, (count, dimensions)) / 2
    boxes = np.hstack([low, low + random.integers(0, 5, low.shape) / 2])
    if random.random() < 0.1 and count:
        boxes[random.integers(count), random.integers(dimensions)] = -np.inf
    return boxes.astype(dtype)


def near(a: Array, b: Array, closed: str, margin: Any) -> Array:
    """`(n, k)`: whether two boxes pair, by definition."""
    half = a.shape[1] // 2
    low_a, high_a, low_b, high_b = a[:, None, :half], a[:, None, half:], b[None, :, :half], b[None, :, half:]
    if closed == "both":
        return np.asarray(((low_a <= high_b + margin) & (low_b <= high_a + margin)).all(axis=2))
    inside = ((low_a < high_b + margin) & (low_b < high_a + margin)).all(axis=2)
    return np.asarray(inside & (low_a < high_a).all(axis=2) & (low_b < high_b).all(axis=2))


def written(random: Random, boxes: Array, format: str) -> Any:
    """The boxes in one of the forms in which users have them."""
    half = boxes.shape[1] // 2
    if format != "xyxy":
        size = boxes[:, half:] - boxes[:, :half]
        return np.hstack([boxes[:, :half] + (size / 2 if format == "cxcywh" else 0), size])
    forms = [boxes, np.asfortranarray(boxes), np.repeat(boxes, 2, axis=0)[::2]]
    if half > 1 or len(boxes):
        forms += [boxes.reshape(len(boxes), 2, half)]
    if boxes.dtype == np.float64 and len(boxes):
        forms += [boxes.tolist()]
    return one_of(random, forms)


def invalid(random: Random, boxes: Array) -> tuple[Array, int]:
    """The boxes with one that is inverted, or has a NaN, and its index."""
    index, axis = int(random.integers(len(boxes))), int(random.integers(boxes.shape[1] // 2))
    boxes = boxes.copy()
    boxes[index, axis] = np.nan if random.random() < 0.5 else boxes[index, axis + boxes.shape[1] // 2] + 1
    return boxes, index


def search(random: Random) -> None:
    """One call that finds pairs."""
    dimensions = int(random.integers(1, 4))
    dtype = one_of(random, [np.float32, np.float64])
    is_between = bool(random.integers(2))
    names = ["a", "b"] if is_between else ["boxes"]
    sets = [some_boxes(random, dimensions, dtype) for _ in names]
    if random.random() < 0.1:
        at = int(random.integers(len(sets)))
        if len(sets[at]):
            sets[at], index = invalid(random, sets[at])
            calls = [sap.find_pairs_between, sap.count_pairs_between] if is_between else [sap.find_pairs]
            call = one_of(random, calls)
            with pytest.raises(sap.InvalidBoxError) as caught:
                call(*sets, margin=int(random.integers(2)))
            assert (caught.value.argument, caught.value.index) == (names[at], index)
        return
    options: dict[str, Any] = {}
    closed, margin, format = "both", 0, "xyxy"
    if random.random() < 0.3:
        options["closed"] = closed = str(random.choice(["both", "left", "right", "neither"]))
    if random.random() < 0.3:
        options["margin"] = margin = random.choice([0.5, 1.0, 2.5])
    if random.random() < 0.3 and all(np.isfinite(boxes).all() for boxes in sets):
        options["format"] = format = str(random.choice(["xyxy", "xywh", "cxcywh"]))
    groups = None
    if random.random() < 0.3:
        groups = [random.integers(0, 3, len(boxes)) for boxes in sets]
        options["by"] = tuple(groups) if is_between else groups[0]
    wanted = near(sets[0], sets[-1], closed, margin)
    if groups is not None:
        wanted &= groups[0][:, None] == groups[-1][None]
    pairs = np.argwhere(wanted if is_between else np.triu(wanted, 1))
    given = [written(random, boxes, format) for boxes in sets]
    if random.random() < 0.2 and format == "xyxy" and groups is None:
        options["missing"] = "skip"
        given = [np.vstack([np.full((1, 2 * dimensions), np.nan, dtype), boxes]) for boxes in sets]
        pairs = pairs + 1
    way = random.integers(5)
    suffix = "_between" if is_between else ""
    if way == 0:
        index_type = one_of(random, [np.int64, np.int32, np.uint32, np.uint64])
        threads = int(random.choice([1, 2, -1]))
        found = getattr(sap, "find_pairs" + suffix)(*given, dtype=index_type, threads=threads, **options)
        assert found.dtype == index_type
    elif way == 1:
        assert getattr(sap, "count_pairs" + suffix)(*given, **options) == len(pairs)
        return
    elif way == 2:
        found = np.concatenate(
            [np.empty((0, 2), int), *getattr(sap, "iter_chunks" + suffix)(*given, size=7, **options)]
        )
    elif way == 3:
        chunks = [np.empty((0, 2), int)]
        getattr(sap, "for_each_chunk" + suffix)(*given, chunks.append, size=5, **options)
        found = np.concatenate(chunks)
    else:
        finder = sap.PairFinder(dimensions, dtype, threads=int(random.integers(1, 3)))
        plain = near(sets[0], sets[-1], "both", margin)
        pairs = np.argwhere(plain if is_between else np.triu(plain, 1))
        for _ in range(2):
            assert getattr(finder, "count" + suffix)(*sets, margin=margin) == len(pairs)
        found = getattr(finder, "find" + suffix)(*sets, margin=margin)
    assert np.array_equal(in_order(found.astype(np.int64)), pairs), (options, way)


def hits(boxes: Array, start: Array, way: Array, limit: float) -> tuple[Array, Array]:
    """The rows that a moving box hits, by time and then by row, and the times. Exact for ways of powers of two."""
    half = len(way)
    low, high = boxes[:, :half] - start[half:], boxes[:, half:] - start[:half]
    enter, leave = np.zeros(len(boxes)), np.full(len(boxes), float(limit))
    for axis in range(half):
        if way[axis] == 0:
            leave[(low[:, axis] > 0) | (high[:, axis] < 0)] = -1
        else:
            first, last = np.sort(np.stack([low[:, axis], high[:, axis]]) / way[axis], axis=0)
            enter, leave = np.maximum(enter, first), np.minimum(leave, last)
    rows = np.flatnonzero(enter <= leave)
    rows = rows[np.lexsort((rows, enter[rows]))]
    return rows, enter[rows]


def squares(boxes: Array, point: Array) -> Array:
    """The squared distances of boxes from a point."""
    half = len(point)
    gaps = np.maximum(np.maximum(boxes[:, :half] - point, point - boxes[:, half:]), 0).astype(float)
    return np.asarray((gaps**2).sum(axis=1))


def two_sets(random: Random, dimensions: int) -> list[Array]:
    return [some_boxes(random, dimensions, one_of(random, [np.float32, np.float64])) for _ in "ab"]


def join(random: Random) -> None:
    """A join of two data frames with boxes."""
    if find_spec("pandas") is None:
        return search(random)
    import pandas

    dimensions = int(random.integers(1, 4))
    sets = two_sets(random, dimensions)
    frames = []
    for boxes in sets:
        if len(boxes) and random.random() < 0.2:
            boxes[random.integers(len(boxes)), random.integers(dimensions)] = np.nan
        frame = pandas.DataFrame(boxes, columns=COLUMNS[dimensions])
        frame["kind"] = random.integers(0, 3, len(frame))
        frame.index = pandas.Index(random.permutation(len(frame)) + 100)
        frames.append(frame)
    options: dict[str, Any] = {"how": one_of(random, ["inner", "left", "right"])}
    closed, margin = "both", 0.0
    if random.random() < 0.5:
        options["closed"] = closed = one_of(random, ["both", "left", "right", "neither"])
    if random.random() < 0.3:
        options["distance"] = margin = float(random.choice([0.5, 1.0]))
    wanted = near(sets[0], sets[1], closed, margin)
    if random.random() < 0.5:
        options["by"] = "kind"
        wanted &= frames[0]["kind"].to_numpy()[:, None] == frames[1]["kind"].to_numpy()[None]
    joined = sap.join(*frames, **options)
    labels = [frame.index.to_numpy() for frame in frames]
    kept, other = (1, 0) if options["how"] == "right" else (0, 1)
    rows = [(a, b) for a, b in np.argwhere(wanted.T if kept else wanted).tolist()]
    if options["how"] != "inner":
        rows += [(row, -1) for row in np.flatnonzero(~wanted.any(axis=1 - kept)).tolist()]
    rows.sort()
    assert joined.index.tolist() == [labels[kept][row] for row, _ in rows], options
    found = joined[f"index_{('left', 'right')[other]}"]
    assert found.fillna(-1).tolist() == [labels[other][row] if row >= 0 else -1 for _, row in rows], options


def join_of_geometries(random: Random) -> None:
    """A join of points, boxes, lines, triangles and disks, which shapely tests."""
    if find_spec("geopandas") is None:
        return search(random)
    import geopandas
    import shapely

    frames = []
    for boxes in two_sets(random, 2):
        boxes = boxes[np.isfinite(boxes).all(axis=1)].astype(float)
        low, high = boxes[:, :2], boxes[:, 2:]
        is_thin = (low == high).any(axis=1)
        made = np.where(is_thin, shapely.points(low), shapely.box(*boxes.T))
        kinds = random.integers(0, 4, len(boxes))
        lines = shapely.linestrings(np.stack([low, high + 1], axis=1))
        third = np.stack([high[:, 0] + 1, low[:, 1]], axis=1)
        triangles = shapely.polygons(np.stack([low, high + 1, third], axis=1))
        disks = shapely.buffer(shapely.points(low), 1.25, quad_segs=int(random.integers(1, 9)))
        for kind, of_kind in ((1, lines), (2, triangles), (3, disks)):
            made = np.where(kinds == kind, of_kind, made)
        if len(made):
            made[random.integers(len(made))] = one_of(random, [None, shapely.Point(), made[0]])
        frames.append(geopandas.GeoDataFrame({"n": np.arange(len(made))}, geometry=made))
    names = ["intersects", "contains", "within", "covers", "covered_by", "contains_properly", "crosses", "overlaps"]
    predicate = one_of(random, [*names, "touches"])
    left, right = (frame.geometry.array for frame in frames)
    a, b = np.indices((len(left), len(right))).reshape(2, -1)
    is_found = np.asarray(getattr(shapely, predicate)(np.asarray(left)[a], np.asarray(right)[b]), bool)
    joined = sap.join(frames[0], frames[1], predicate=predicate, threads=int(random.integers(1, 4)))
    found = [joined.index.tolist(), joined["index_right"].tolist()]
    assert found == [a[is_found].tolist(), b[is_found].tolist()], predicate


def command(random: Random, folder: Path) -> None:
    """A call of the command line."""
    dimensions = int(random.integers(1, 4))
    sets = two_sets(random, dimensions)[: int(random.integers(1, 3))]
    files = [str(folder / f"{number}.npy") for number in range(len(sets))]
    for file, boxes in zip(files, sets):
        np.save(file, boxes)
    closed, margin = str(random.choice(["both", "left", "right", "neither"])), float(random.choice([0.0, 0.5]))
    wanted = near(sets[0], sets[-1], closed, margin)
    pairs = np.argwhere(np.triu(wanted, 1) if len(sets) == 1 else wanted)
    options = ["--closed", closed, "--margin", str(margin), "--quiet"]
    out = str(folder / "out.npy")
    assert main(["pairs" if len(sets) == 1 else "join", *files, "-o", out, *options]) == 0
    assert np.array_equal(in_order(np.load(out)), pairs)
    with redirect_stdout(io.StringIO()) as said:
        assert main(["count", *files, *options]) == 0
    assert said.getvalue() == f"{len(pairs)}\n"


def dask(random: Random, folder: Path) -> None:
    """Pairs of more boxes than fit in memory, as it were."""
    if find_spec("distributed") is None:
        return search(random)
    import dask.array
    import pyarrow
    import pyarrow.parquet

    import sweep_and_prune.dask as large

    dimensions = int(random.integers(1, 4))
    sets = two_sets(random, dimensions)[: int(random.integers(1, 3))]
    options: dict[str, Any] = {"cells": int(random.integers(1, 9))}
    closed, margin = "both", 0.0
    if random.random() < 0.5:
        options["closed"] = closed = str(random.choice(["both", "left", "right", "neither"]))
    if random.random() < 0.3:
        options["margin"] = margin = 0.5
    if random.random() < 0.5:
        options |= {"out": folder / "out", "workers": 0, "overwrite": True}
    given: list[Any] = []
    for number, boxes in enumerate(sets):
        if random.random() < 0.5:
            given.append(dask.array.from_array(boxes, chunks=(int(random.integers(1, 30)), 2 * dimensions)))
        else:
            given.append(str(folder / f"{number}.parquet"))
            table = pyarrow.table(dict(zip(COLUMNS[dimensions], boxes.T)))
            pyarrow.parquet.write_table(table, given[-1], row_group_size=int(random.integers(1, 30)))
    wanted = near(sets[0], sets[-1], closed, margin)
    pairs = np.argwhere(np.triu(wanted, 1) if len(sets) == 1 else wanted)
    found = (large.find_pairs if len(sets) == 1 else large.find_pairs_between)(*given, **options)
    with dask.config.set(scheduler="sync"):
        assert np.array_equal(in_order(found.compute().to_numpy().reshape(-1, 2).astype(np.int64)), pairs), options


class World:
    """A persistent broad phase, and what it should contain."""

    def __init__(self, random: Random) -> None:
        self.random, self.dimensions = random, int(random.integers(1, 4))
        self.dtype = one_of(random, [np.float32, np.float64])
        self.world = sap.BroadPhase(self.dimensions, self.dtype)
        self.boxes: dict[int, Array] = {}
        self.before: set[tuple[int, int]] = set()

    def box(self) -> Array:
        low = self.random.integers(-2, 9, self.dimensions) / 2
        return np.hstack([low, low + self.random.integers(0, 5, self.dimensions) / 2]).astype(self.dtype)

    def some_ids(self) -> list[int]:
        ids = list(self.boxes)
        return [ids[at] for at in self.random.permutation(len(ids))[: int(self.random.integers(0, 4))]]

    def pairs(self) -> set[tuple[int, int]]:
        ids = np.array(sorted(self.boxes), np.int64)
        boxes = np.array([self.boxes[id] for id in ids.tolist()]).reshape(-1, 2 * self.dimensions)
        found = np.argwhere(np.triu(near(boxes, boxes, "both", 0), 1))
        return {(a, b) for a, b in ids[found].tolist()}

    def hit(self, box: Array) -> list[int]:
        return sorted(id for id, own in self.boxes.items() if near(own[None], box[None], "both", 0)[0, 0])

    def look(self) -> None:
        """Asks what a ray and a moving box hit, and what is nearest."""
        random, world = self.random, self.world
        ids = np.array(sorted(self.boxes, key=lambda id: id % 2**32), np.int64)
        boxes = np.array([self.boxes[id] for id in ids.tolist()]).reshape(-1, 2 * self.dimensions)
        box, limit = self.box(), float(random.choice([0, 0.5, 3, np.inf]))
        point, way = box[: self.dimensions], random.choice([-2.0, -1.0, 0.0, 1.0, 2.0], self.dimensions)
        for start, cast, first, many in (
            (point, world.ray_cast_all, world.ray_cast, world.ray_cast_many),
            (box, world.box_cast_all, world.box_cast, world.box_cast_many),
        ):
            rows, times = hits(boxes, box if start is box else np.hstack([point, point]), way, limit)
            found = cast(start, way, limit)
            assert (found.ids.tolist(), found.t.tolist()) == (ids[rows].tolist(), times.tolist())
            wanted = (int(ids[rows[0]]), times[0]) if len(rows) else None
            hit = first(start, way, limit)
            assert (hit and hit[:2]) == wanted
            found = many(start[None], way[None], [limit])
            assert (found.ids[0], found.t[0]) == (wanted or (-1, np.inf))
        distances = squares(boxes, point)
        order = np.lexsort((np.arange(len(ids)), distances))[: int(random.integers(0, 5))]
        near = world.nearest(point, len(order))
        assert near.ids.tolist() == ids[order].tolist()
        assert np.array_equal(near.distances, np.sqrt(distances[order]))

    def step(self) -> None:
        """One random call."""
        random, world = self.random, self.world
        way = int(random.integers(14))
        if way == 0:
            box = self.box()
            self.boxes[world.insert(box)] = box
        elif way == 1:
            boxes = np.array([self.box() for _ in range(int(random.integers(0, 6)))]).reshape(-1, 2 * self.dimensions)
            self.boxes.update(zip(world.insert_many(boxes.astype(self.dtype)).tolist(), boxes))
        elif way in (2, 3):
            ids = self.some_ids()
            boxes = np.array([self.box() for _ in ids]).reshape(-1, 2 * self.dimensions)
            world.set_many(ids, boxes)
            self.boxes.update(zip(ids, boxes))
        elif way == 4:
            ids = self.some_ids()
            world.remove_many(ids)
            for id in ids:
                del self.boxes[id]
                with pytest.raises(sap.StaleProxyError):
                    world.box(id)
        elif way in (5, 6):
            changes, now = world.update(), self.pairs()
            begun, ended = ({tuple(sorted(pair)) for pair in part.tolist()} for part in changes)
            assert begun == now - self.before and ended == self.before - now
            assert {tuple(sorted(pair)) for pair in world.pairs().tolist()} == now
            self.before = now
        elif way == 7:
            box = self.box()
            assert sorted(world.overlapping(box).tolist()) == self.hit(box)
        elif way == 8:
            point = self.box()[: self.dimensions]
            assert sorted(world.containing(point).tolist()) == self.hit(np.hstack([point, point]))
        elif way == 9:
            center, radius = self.box()[: self.dimensions], float(random.integers(0, 5) / 2)
            half = self.dimensions
            gaps = {
                id: np.maximum(np.maximum(box[:half] - center, center - box[half:]), 0)
                for id, box in self.boxes.items()
            }
            wanted = sorted(id for id, gap in gaps.items() if float((gap.astype(float) ** 2).sum()) <= radius**2)
            assert sorted(world.within(center, radius).tolist()) == wanted
        elif way == 10:
            restored = sap.BroadPhase.from_snapshot(world.snapshot())
            assert restored.state_hash() == world.state_hash()
            self.world = restored
        elif way in (11, 12):
            self.look()
        else:
            assert len(world) == len(self.boxes) and sorted(world.ids().tolist()) == sorted(self.boxes)
            if self.boxes:
                wrong = self.box()
                wrong[0] = np.nan
                with pytest.raises(sap.InvalidBoxError):
                    world.set(next(iter(self.boxes)), wrong)
                for id, box in list(self.boxes.items())[:3]:
                    assert np.array_equal(world.box(id), box)


@pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")  # Dask calls a newer pandas so
@pytest.mark.parametrize("part", range(PARTS))
def test_random_calls_are_right(part: int, tmp_path: Path) -> None:
    random = np.random.default_rng([SEED, part])
    world, age = World(random), 0
    for call in range(CALLS // PARTS):
        state = random.bit_generator.state
        try:
            kind = random.random()
            if kind < 0.5:
                search(random)
            elif kind < 0.58:
                join(random)
            elif kind < 0.6:
                join_of_geometries(random)
            elif kind < 0.64:
                command(random, tmp_path)
            elif kind < 0.65:
                dask(random, tmp_path)
            else:
                if age == 300:
                    world, age = World(random), 0
                world.step()
                age += 1
        except Exception as error:
            raise AssertionError(f"call {call} of part {part}, SEED={SEED}, random state {state}") from error
