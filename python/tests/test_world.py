"""The broad phase against the oracle: random sequences of operations, then what these do not cover."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, precondition, rule
from names import name_of
from oracle import COORDINATES, FLOATS, in_order, overlaps, random_boxes

import sweep_and_prune as sap

FILTERS = (sap.Filter(), sap.Filter(is_static=True), sap.Filter(2, 3), sap.Filter(4, 4), sap.Filter(group=-1))


def as_set(pairs: Any) -> set[tuple[int, int]]:
    return {(int(a), int(b)) for a, b in pairs}


class Worlds(RuleBasedStateMachine):
    """A world, and beside it a dictionary of what should be in it."""

    @initialize(dimensions=st.integers(1, 3), dtype=st.sampled_from(FLOATS))
    def begin(self, dimensions: int, dtype: Any) -> None:
        self.world = sap.BroadPhase(dimensions, dtype)
        self.boxes: dict[int, Any] = {}
        self.ends: dict[int, Any] = {}
        self.filters: dict[int, sap.Filter] = {}
        self.known: set[tuple[int, int]] = set()
        self.disabled: set[int] = set()
        self.excluded: set[frozenset[int]] = set()
        self.gone: list[int] = []

    def draw_box(self, data: st.DataObject) -> Any:
        size = 2 * self.world.dimensions
        corners = np.array(data.draw(st.lists(COORDINATES, min_size=size, max_size=size))).reshape(2, -1)
        return np.concatenate([corners.min(axis=0), corners.max(axis=0)])

    def draw_id(self, data: st.DataObject) -> int:
        return data.draw(st.sampled_from(sorted(self.boxes)))

    def some(self) -> bool:
        return bool(self.boxes)

    @rule(data=st.data(), filter=st.sampled_from(FILTERS))
    def insert(self, data: st.DataObject, filter: sap.Filter) -> None:
        box = self.draw_box(data)
        id = self.world.insert(box, filter)
        assert id not in self.boxes and id not in self.gone
        self.boxes[id], self.filters[id] = box, filter

    @rule(data=st.data(), count=st.integers(0, 8), filter=st.sampled_from(FILTERS))
    def insert_many(self, data: st.DataObject, count: int, filter: sap.Filter) -> None:
        boxes = [self.draw_box(data) for _ in range(count)]
        ids = self.world.insert_many(boxes, filter)
        assert ids.dtype == np.int64 and ids.shape == (count,)
        for id, box in zip(ids.tolist(), boxes):
            self.boxes[id], self.filters[id] = box, filter

    @precondition(some)
    @rule(data=st.data())
    def move(self, data: st.DataObject) -> None:
        id, box = self.draw_id(data), self.draw_box(data)
        self.world.set(id, box)
        self.boxes[id] = box
        self.ends.pop(id, None)

    @precondition(some)
    @rule(data=st.data())
    def move_many(self, data: st.DataObject) -> None:
        ids = data.draw(st.lists(st.sampled_from(sorted(self.boxes)), max_size=8))
        boxes = [self.draw_box(data) for _ in ids]
        self.world.set_many(ids, boxes)
        for id, box in zip(ids, boxes):
            self.boxes[id] = box
            self.ends.pop(id, None)

    @precondition(some)
    @rule(data=st.data())
    def teleport(self, data: st.DataObject) -> None:
        id, box = self.draw_id(data), self.draw_box(data)
        if data.draw(st.booleans()):
            self.world.teleport(id, box)
        else:
            self.world.teleport_many([id], [box])
        self.boxes[id] = box
        self.ends.pop(id, None)

    @precondition(some)
    @rule(data=st.data())
    def set_swept(self, data: st.DataObject) -> None:
        id, start, end = self.draw_id(data), self.draw_box(data), self.draw_box(data)
        if data.draw(st.booleans()):
            self.world.set_swept(id, start, end)
        else:
            self.world.set_swept_many([id], [start], [end])
        half = self.world.dimensions
        self.boxes[id] = np.concatenate([np.minimum(start, end)[:half], np.maximum(start, end)[half:]])
        self.ends[id] = end

    @precondition(some)
    @rule(data=st.data(), filter=st.sampled_from(FILTERS))
    def set_filter(self, data: st.DataObject, filter: sap.Filter) -> None:
        ids = data.draw(st.lists(st.sampled_from(sorted(self.boxes)), max_size=4))
        self.world.set_filter_many(ids, filter)
        self.filters.update(dict.fromkeys(ids, filter))

    @precondition(some)
    @rule(data=st.data(), enabled=st.booleans())
    def set_enabled(self, data: st.DataObject, enabled: bool) -> None:
        ids = data.draw(st.lists(st.sampled_from(sorted(self.boxes)), max_size=3))
        if len(ids) == 1:
            self.world.set_enabled(ids[0], enabled)
        else:
            self.world.set_enabled_many(ids, enabled)
        self.disabled = self.disabled - set(ids) if enabled else self.disabled | set(ids)

    @precondition(some)
    @rule(data=st.data(), excluded=st.booleans())
    def set_excluded(self, data: st.DataObject, excluded: bool) -> None:
        first, second = self.draw_id(data), self.draw_id(data)
        (self.world.exclude_pair if excluded else self.world.include_pair)(first, second)
        pair = {frozenset((first, second))} if first != second else set()
        self.excluded = self.excluded | pair if excluded else self.excluded - pair
        assert self.world.is_excluded(second, first) == (excluded and first != second)

    @precondition(some)
    @rule(data=st.data())
    def remove(self, data: st.DataObject) -> None:
        ids = data.draw(st.lists(st.sampled_from(sorted(self.boxes)), unique=True, max_size=5))
        self.world.remove_many(ids)
        for id in ids:
            del self.boxes[id], self.filters[id]
            self.disabled.discard(id)
            self.excluded = {pair for pair in self.excluded if id not in pair}
            self.ends.pop(id, None)
        self.gone += ids

    @precondition(some)
    @rule(data=st.data())
    def refuse(self, data: st.DataObject) -> None:
        before = self.world.snapshot()
        id, box = self.draw_id(data), self.draw_box(data)
        bad = box.copy()
        bad[data.draw(st.integers(0, len(bad) - 1))] = np.nan
        with pytest.raises(sap.InvalidBoxError) as caught:
            self.world.set_many([id, id], [box, bad])
        assert caught.value.index == 1
        with pytest.raises(sap.InvalidBoxError):
            self.world.insert_many([box, bad])
        with pytest.raises(sap.InvalidBoxError) as caught:
            self.world.set_swept_many([id, id], [box, box], [box, bad])
        assert (caught.value.index, caught.value.argument) == (1, "ends")
        stale = data.draw(st.sampled_from([*self.gone, -1, 2**40, 2**63 - 1]))
        for call in (
            lambda: self.world.set_many([id, stale], [box, box]),
            lambda: self.world.set_swept_many([id, stale], [box, box], [box, box]),
            lambda: self.world.set_filter_many([id, stale], FILTERS[1]),
            lambda: self.world.set_enabled_many([id, stale], False),
            lambda: self.world.exclude_pair(id, stale),
            lambda: self.world.remove_many(np.array([id, stale], np.int64)),
            lambda: self.world.box_many([id, stale]),
        ):
            with pytest.raises(sap.StaleProxyError) as stale_error:
                call()
            assert (stale_error.value.id, stale_error.value.index) == (stale, 1)
        with pytest.raises(sap.StaleProxyError):
            self.world.remove_many([id, id])
        assert self.world.snapshot() == before

    @rule()
    def update(self) -> None:
        begun, ended = self.world.update()
        now = self.allowed_pairs()
        for found, wanted in ((begun, now - self.known), (ended, self.known - now), (self.world.pairs(), now)):
            assert found.dtype == np.int64 and found.shape == (len(wanted), 2)
            assert as_set(found) == wanted
            slots = sap.slots_of(found)
            assert (slots[:, 0] < slots[:, 1]).all() and np.array_equal(in_order(slots), slots)
        self.known = now
        self.boxes.update(self.ends)
        self.ends.clear()
        by_body = list(self.world.pairs_by_body().each())
        assert sum(map(len, by_body)) == 2 * len(now)
        for id in self.boxes:
            others = {b if a == id else a for a, b in now if id in (a, b)}
            assert set(self.world.pairs_of(id).tolist()) == others
            assert by_body[sap.slots_of(id)].tolist() == self.world.pairs_of(id).tolist()

    @rule()
    def save_and_restore(self) -> None:
        again = sap.BroadPhase.from_snapshot(self.world.snapshot())
        assert again.state_hash() == self.world.state_hash()
        assert (again.dimensions, again.dtype) == (self.world.dimensions, self.world.dtype)
        self.world = again

    @rule()
    def look(self) -> None:
        assert len(self.world) == len(self.boxes)
        ids = self.world.ids()
        assert sorted(ids.tolist()) == sorted(self.boxes)
        if len(ids):
            assert np.array_equal(self.world.box_many(ids), np.array([self.boxes[id] for id in ids.tolist()]))
        for id in self.boxes:
            assert id in self.world and self.world.filter(id) == self.filters[id]
            assert self.world.is_enabled(id) == (id not in self.disabled)
        assert not self.world.contains_many(np.array(self.gone, np.int64)).any()

    @rule(data=st.data(), filter=st.sampled_from([None, *FILTERS]))
    def query(self, data: st.DataObject, filter: sap.Filter | None) -> None:
        boxes = np.array([self.draw_box(data) for _ in range(3)])
        points = np.array([self.draw_box(data)[: self.world.dimensions] for _ in range(3)])
        self.check(self.world.overlapping_many(boxes, filter), boxes, filter)
        self.check(self.world.containing_many(points, filter), np.hstack([points, points]), filter)
        one = self.world.overlapping(boxes[0], filter)
        assert np.array_equal(one, next(self.world.overlapping_many(boxes, filter).each()))

    def check(self, found: sap.Lists, boxes: Any, filter: sap.Filter | None) -> None:
        allowed = (filter or sap.Filter(0xFFFF_FFFF)).allows
        ids = [id for id in self.boxes if allowed(self.filters[id]) and id not in self.disabled]
        mine = np.array([self.boxes[id] for id in ids]).reshape(-1, boxes.shape[1])
        lists = [each.tolist() for each in found.each()]
        assert len(lists) == len(boxes)
        for row, hits in zip(overlaps(boxes, mine), lists):
            assert sorted(np.array(ids, np.int64)[row].tolist()) == sorted(hits)
            assert hits == sorted(hits, key=lambda id: id & 0xFFFF_FFFF)

    def allowed_pairs(self) -> set[tuple[int, int]]:
        ids = sorted(self.boxes, key=lambda id: id & 0xFFFF_FFFF)
        mine = np.array([self.boxes[id] for id in ids]).reshape(-1, 2 * self.world.dimensions)
        touching = np.argwhere(np.triu(overlaps(mine, mine), 1))
        named = ((ids[a], ids[b]) for a, b in touching)
        apart = self.excluded
        enabled = ((a, b) for a, b in named if not {a, b} & self.disabled and frozenset((a, b)) not in apart)
        return {(a, b) for a, b in enabled if self.filters[a].allows(self.filters[b])}


TestWorlds = Worlds.TestCase
TestWorlds.settings = settings(max_examples=150, stateful_step_count=40, deadline=None)


@pytest.mark.parametrize("dtype", FLOATS)
def test_many_bodies_in_motion(dtype: Any) -> None:
    random = np.random.default_rng(5)
    boxes = random_boxes(3000, 3, dtype)
    world = sap.BroadPhase(3, dtype)
    ids = world.insert_many(boxes)
    slots = sap.slots_of(ids)
    assert slots.tolist() == list(range(3000))
    known: set[tuple[int, int]] = set()
    for _ in range(6):
        begun, ended = world.update()
        now = as_set(sap.find_pairs(boxes))
        assert as_set(sap.slots_of(begun)) == now - known
        assert as_set(sap.slots_of(ended)) == known - now
        assert as_set(sap.slots_of(world.pairs())) == now
        known = now
        movers = random.random(3000) < random.random()
        boxes[movers] += np.tile(random.integers(-2, 3, (movers.sum(), 3)) / 2, 2).astype(dtype)
        world.set_many(ids[movers], boxes[movers])


@pytest.mark.parametrize("dtype", FLOATS)
def test_casts_and_neighbors_equal_brute_force(dtype: Any) -> None:
    random = np.random.default_rng(6)
    boxes = random_boxes(300, 2, dtype, seed=2)
    world = sap.BroadPhase(2, dtype)
    ids = world.insert_many(boxes)
    points = (random.integers(-4, 40, (50, 2)) / 2).astype(dtype)
    gaps = np.maximum(np.maximum(boxes[None, :, :2] - points[:, None], points[:, None] - boxes[None, :, 2:]), 0)
    distances = np.sqrt((gaps.astype(np.float64) ** 2).sum(axis=2))

    near = world.nearest_many(points, 7)
    assert near.ids.shape == near.distances.shape == (50, 7)
    order = np.lexsort((np.broadcast_to(np.arange(300), distances.shape), distances))[:, :7]
    assert np.array_equal(near.ids, ids[order])
    assert np.array_equal(near.distances, np.take_along_axis(distances, order, 1))
    assert np.array_equal(world.nearest(points[3], 7).ids, near.ids[3])
    assert world.nearest(points[0], 10**12).ids.shape == (300,) and world.nearest(points[0], 0).ids.shape == (0,)

    for far in (0.0, 2.5, float(near.distances[3, 4]), np.inf):
        limited = world.nearest_many(points, 7, max_distance=far)
        within = (near.distances <= far)[:, : limited.ids.shape[1]]
        assert within.sum() == (near.distances <= far).sum() and (within.any(axis=0)).all()
        columns = limited.ids.shape[1]
        assert np.array_equal(limited.ids, np.where(within, near.ids[:, :columns], -1))
        assert np.array_equal(limited.distances, np.where(within, near.distances[:, :columns], np.inf))
        assert np.array_equal(world.nearest(points[3], 7, max_distance=far).ids, near.ids[3][near.distances[3] <= far])

    areas = np.concatenate([points, points + 9], axis=1).astype(dtype)
    for unsorted, sorted_lists in (
        (world.overlapping_many(areas, sorted=False), world.overlapping_many(areas)),
        (world.containing_many(points, sorted=False), world.containing_many(points)),
        (world.within_many(points, 2.5, sorted=False), world.within_many(points, 2.5)),
    ):
        assert np.array_equal(unsorted.ends, sorted_lists.ends)
        for any_order, expected in zip(unsorted.each(), sorted_lists.each()):
            assert np.array_equal(np.sort(any_order), expected)
    area, point = areas[3], points[3]
    assert np.array_equal(np.sort(world.overlapping(area, sorted=False)), world.overlapping(area))
    assert np.array_equal(np.sort(world.containing(point, sorted=False)), world.containing(point))
    assert np.array_equal(np.sort(world.within(point, 5, sorted=False)), world.within(point, 5))
    assert not np.array_equal(world.overlapping_many(areas, sorted=False).ids, world.overlapping_many(areas).ids)

    found = world.within_many(points, 2.5)
    assert np.array_equal(np.bincount(found.queries(), minlength=50), (distances <= 2.5).sum(axis=1))
    assert np.array_equal(np.argwhere(distances <= 2.5), np.stack([found.queries(), sap.slots_of(found.ids)], 1))
    assert np.array_equal(world.within(points[1], 2.5), list(found.each())[1])

    movers = np.hstack([points, points + dtype(0.5)])
    ways = random.integers(-3, 4, (50, 2)).astype(dtype)
    hits, rays = world.box_cast_many(movers, ways, 4), world.ray_cast_many(points, ways)
    for i in range(50):
        for cast, first, one, all in (
            (movers[i], hits, world.box_cast, world.box_cast_all),
            (np.tile(points[i], 2), rays, world.ray_cast, world.ray_cast_all),
        ):
            limit = 4 if first is hits else np.inf
            start = cast if first is hits else points[i]
            times = sorted((at, slot) for slot, at in enumerate(touches(cast, ways[i], limit, boxes)) if at is not None)
            got = all(start, ways[i], limit)
            assert [(at, slot) for at, slot in zip(got.t.tolist(), sap.slots_of(got.ids).tolist())] == times
            single = one(start, ways[i], limit)
            if times:
                assert single is not None and (single.t, single.id) == (times[0][0], ids[times[0][1]])
                assert (first.t[i], first.ids[i]) == (single.t, single.id)
            else:
                assert single is None and first.ids[i] == -1 and first.t[i] == np.inf


def touches(box: Any, way: Any, limit: float, boxes: Any) -> list[float | None]:
    """When a moving box first touches each of others, by the slabs' rule."""
    times: list[float | None] = []
    for other in boxes.astype(np.float64).tolist():
        first, last = 0.0, float(limit)
        for axis, speed in enumerate(way.tolist()):
            before, behind = other[axis] - float(box[axis + 2]), other[axis + 2] - float(box[axis])
            if speed == 0:
                first = np.inf if before > 0 or behind < 0 else first
            else:
                enter, leave = sorted((before / speed, behind / speed))
                first, last = max(first, enter), min(last, leave)
        times.append(first if first <= last and first < np.inf else None)
    return times


def test_pairs_of_fat_aabbs_begin_early_and_end_late() -> None:
    world = sap.BroadPhase(1, report="fat", margin=1)
    a, b = world.insert([0, 1]), world.insert([2.5, 3])
    assert world.update().begun.tolist() == [[a, b]]  # a's reaches to 2, b's begins at 1.5
    world.set(b, [3, 3.5])
    assert len(world.update().ended) == 0
    again = pickle.loads(pickle.dumps(world))
    for each in (world, again):
        each.set(b, [9, 10])
        assert each.update().ended.tolist() == [[a, b]]


def test_a_fat_aabb_reaches_ahead_of_a_body_that_moves_not_of_one_that_teleports_or_rests() -> None:
    world = sap.BroadPhase(1, report="fat", margin=0.5, prediction=2)
    id = world.insert([0, 1])
    world.update()
    world.set(id, [2, 3])
    assert world.reported_box(id).tolist() == [1.5, 7.5]
    world.set(id, [0, 1])
    assert world.reported_box(id).tolist() == [-0.5, 1.5]  # taken back
    world.set(id, [2, 3])
    world.update()
    world.update()
    assert world.reported_box(id).tolist() == [1.5, 3.5]  # at rest
    world.teleport(id, [4, 5])
    assert world.reported_box(id).tolist() == [3.5, 5.5]
    world.teleport_many([id], [[20, 21]])
    assert world.reported_box(id).tolist() == [19.5, 21.5]


@pytest.mark.parametrize("options", [{}, {"report": "fat", "margin": 0.25, "prediction": 1}])
def test_a_shift_moves_all_boxes_and_reports_nothing(options: dict[str, Any]) -> None:
    world = sap.BroadPhase(2, **options)
    low = np.random.default_rng(7).integers(0, 60, (300, 2)).astype(float)
    ids = world.insert_many(np.hstack([low, low + 2]))
    world.update()
    pairs = world.pairs().tolist()
    world.shift([1024, -64])
    begun, ended = world.update()
    assert (len(begun), len(ended)) == (0, 0)
    assert world.pairs().tolist() == pairs
    assert world.box(ids[0]).tolist() == [low[0, 0] + 1024, low[0, 1] - 64, low[0, 0] + 1026, low[0, 1] - 62]
    for wrong in ([np.nan, 0], [0, np.inf], [1], [[1, 2]], 3, "12"):
        with pytest.raises((ValueError, TypeError), match="offset"):
            world.shift(wrong)
    with pytest.raises(ValueError, match="offset on axis 1 is inf"):
        sap.BroadPhase(2, np.float32).shift([0, 1e39])
    stale = ids[-1] + 2**32
    with pytest.raises(sap.StaleProxyError):
        world.teleport_many([ids[0], stale], [[0, 0, 1, 1], [0, 0, 1, 1]])
    with pytest.raises(sap.InvalidBoxError):
        world.teleport_many(ids[:2], [[0, 0, 1, 1], [0, 2, 1, 1]])
    assert world.box(ids[0]).tolist()[0] == low[0, 0] + 1024


def test_coordinates_are_kept_in_the_type_of_the_world() -> None:
    single, double = sap.BroadPhase(1, np.float32), sap.BroadPhase(1)
    assert single.box(single.insert([0.1, 0.2])).dtype == np.float32
    assert double.box(double.insert([0.1, 0.2])).tolist() == [0.1, 0.2]
    assert double.box(double.insert(np.array([0.1, 0.2], np.float32))).tolist() != [0.1, 0.2]
    assert np.isinf(single.box(single.insert([0, 1e300]))[1])


def test_copies_and_pickles_go_on_as_the_world_does() -> None:
    world = sap.BroadPhase(2, np.float32)
    ids = world.insert_many(random_boxes(100, 2, np.float32))
    world.update()
    world.remove_many(ids[::3])
    for again in (copy.copy(world), copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
        assert again.state_hash() == world.state_hash() and repr(again) == repr(world)
        assert again.insert([0, 0, 1, 1]) == copy.copy(world).insert([0, 0, 1, 1])
        assert np.array_equal(again.update().ended, copy.copy(world).update().ended)


def test_damaged_snapshots_are_refused() -> None:
    world = sap.BroadPhase(2)
    world.insert_many(random_boxes(5, 2, np.float64))
    saved = world.snapshot()
    assert sap.BroadPhase.from_snapshot(bytearray(saved)).state_hash() == world.state_hash()
    assert sap.BroadPhase.from_snapshot(memoryview(saved)).state_hash() == world.state_hash()
    for end in range(len(saved)):
        with pytest.raises(sap.SnapshotError):
            sap.BroadPhase.from_snapshot(saved[:end])
    for at in range(len(saved)):
        for bit in (1, 16, 128):
            damaged = bytearray(saved)
            damaged[at] ^= bit
            with pytest.raises(sap.SnapshotError):
                sap.BroadPhase.from_snapshot(bytes(damaged))
    for wrong in (None, "bytes", 5, [1, 2], np.zeros(3)):
        with pytest.raises(TypeError):
            sap.BroadPhase.from_snapshot(wrong)  # type: ignore[arg-type]


WRONG_IDS: list[Any] = [None, 1.5, "1", [1], np.zeros(2), object()]


@pytest.mark.parametrize("wrong", WRONG_IDS, ids=name_of)
def test_what_is_no_id_is_refused(wrong: Any) -> None:
    world = sap.BroadPhase(1)
    for call in (
        lambda: world.set(wrong, [0, 1]),
        lambda: world.remove(wrong),
        lambda: world.box(wrong),
        lambda: world.pairs_of(wrong),
        lambda: world.filter(wrong),
        lambda: world.set_filter(wrong, sap.Filter()),
        lambda: world.set_swept(wrong, [0, 1], [0, 1]),
    ):
        with pytest.raises(TypeError, match="id"):
            call()
    assert wrong not in world


@pytest.mark.parametrize(
    "wrong", [None, 5, "ids", [1.5], [[1]], ["a"], [None], np.zeros(2), [object()], [1, 2.5]], ids=name_of
)
def test_what_are_no_ids_is_refused(wrong: Any) -> None:
    world = sap.BroadPhase(1)
    for call in (
        lambda: world.remove_many(wrong),
        lambda: world.box_many(wrong),
        lambda: world.contains_many(wrong),
        lambda: world.set_many(wrong, [[0, 1]]),
    ):
        with pytest.raises((TypeError, ValueError)):
            call()


def test_ids_of_every_kind_of_whole_number() -> None:
    world = sap.BroadPhase(1)
    ids = world.insert_many([[0, 1], [5, 6]])
    for form in (ids.tolist(), tuple(ids.tolist()), ids.astype(np.uint64), ids[::-1][::-1], ids.astype(">u8")):
        assert world.box_many(form).tolist() == [[0, 1], [5, 6]]
    assert world.box(ids[1]).tolist() == world.box(np.int64(ids[1])).tolist() == [5, 6]
    assert ids[0] in world and int(ids[0]) in world and True not in world
    for large in (np.array([2**63 + 1, 1], np.uint64), [2**63 + 1, 1], [2**70, 1], (-(2**70), 1)):
        assert world.contains_many(large).tolist() == [False, True]
    for stale in (-1, -(2**70), 2**70, 2, 2**32):
        assert stale not in world
        with pytest.raises(sap.StaleProxyError) as caught:
            world.remove(stale)
        assert caught.value.id == stale
    with pytest.raises(sap.StaleProxyError) as caught:
        world.remove_many([int(ids[0]), -7])
    assert (caught.value.id, caught.value.index, len(world)) == (-7, 1, 2)
    with pytest.raises(sap.StaleProxyError) as caught:
        world.remove_many([int(ids[0]), 2**70])
    assert (caught.value.id, caught.value.index, len(world)) == (2**70, 1, 2)
    world.remove_many([])
    world.set_many([], [])
    assert world.contains_many([]).shape == (0,) and world.box_many([]).shape == (0, 2)
    with pytest.raises(ValueError, match="there are 2 ids but 1 boxes"):
        world.set_many(ids, [[0, 1]])
    with pytest.raises(ValueError):
        world.set_swept_many(ids, [[0, 1]], [[0, 1], [2, 3]])


@pytest.mark.parametrize(
    "wrong",
    [
        5,
        "static",
        (1, 2, 3, True),
        {"category": 1},
        sap.Filter()._replace(category=2**32),
    ],
    ids=name_of,
)
def test_what_is_no_filter_is_refused(wrong: Any) -> None:
    world = sap.BroadPhase(1)
    id = world.insert([0, 1])
    for call in (
        lambda: world.insert([0, 1], wrong),
        lambda: world.set_filter(id, wrong),
        lambda: world.overlapping([0, 1], wrong),
        lambda: world.nearest([0], 1, wrong),
        lambda: world.ray_cast([0], [1], 1, wrong),
    ):
        with pytest.raises((TypeError, ValueError)):
            call()
    assert len(world) == 1


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("category", "person"),
        ("category", 1.5),
        ("category", 2**32),
        ("mask", -(2**31) - 1),
        ("group", 2**31),
        ("group", None),
        ("is_static", "False"),
        ("is_static", float("nan")),
        ("is_static", None),
    ],
)
def test_a_filter_is_checked_when_it_is_made(field: str, value: Any) -> None:
    with pytest.raises((TypeError, ValueError), match=f"^{field} must be"):
        sap.Filter(**{field: value})
    for made in (pickle.loads(pickle.dumps(sap.Filter(2, 3))), copy.copy(sap.Filter(2, 3))):
        assert made == sap.Filter(2, 3) == (2, 3, 0, False) and type(made) is sap.Filter


def test_no_filter_is_the_default_only_of_new_bodies() -> None:
    world = sap.BroadPhase(1)
    ids = world.insert_many([[0, 1]], None)
    assert world.filter_many([*ids, world.insert([0, 1], None)]) == [sap.Filter(), sap.Filter()]
    ghost, nothing = sap.Filter(group=-1), None
    world.set_filter_many(ids, ghost)
    for call in (
        lambda: world.set_filter(ids[0], nothing),  # type: ignore[arg-type]
        lambda: world.set_filter_many(ids, nothing),  # type: ignore[arg-type]
        lambda: ghost.allows(nothing),  # type: ignore[arg-type]
    ):
        with pytest.raises(TypeError, match="filter must be a Filter, not a NoneType"):
            call()
    assert world.filter(ids[0]) == ghost


def test_integers_of_any_size_are_coordinates_alone_and_in_rows() -> None:
    large, world = 2**70, sap.BroadPhase(1)
    a, b = world.insert([-large, large]), world.insert_many([[-large, large]])[0]
    world.set(a, [0, large])
    assert world.box_many([a, b]).tolist() == [[0, large], [-large, large]]
    assert world.containing([large]).tolist() == world.containing_many([[large]]).ids.tolist() == [a, b]
    assert world.within_many([[0]], [large]).ids.tolist() == [a, b]
    calls: Any = (lambda: world.insert([0, 10**400]), lambda: world.insert_many([[0, 10**400]]))
    for call in calls:
        with pytest.raises(ValueError, match="has numbers that are too large for float64"):
            call()
    odd: Any = [object(), 1]
    with pytest.raises(TypeError, match="box must be numbers, not of dtype object"):
        world.insert(odd)


def test_bits_of_filters_may_be_written_as_signed_numbers() -> None:
    world = sap.BroadPhase(1)
    a = world.insert([0, 1], sap.Filter(category=2))
    world.insert([0, 1], sap.Filter(mask=~2))
    assert len(world.update().begun) == 0
    assert world.filter(a) == sap.Filter(2)
    assert world.filter(int(world.ids()[1])).mask == 0xFFFF_FFFD


@pytest.mark.parametrize(
    "options",
    [
        {"margin": -1},
        {"margin": np.nan},
        {"prediction": np.inf},
        {"margin": "1"},
        {"margin": None},
        {"report": "FAT"},
        {"report": None},
        {"report": []},
        {"margin": 1e300, "dtype": np.float32},
        {"prediction": [1]},
    ],
    ids=name_of,
)
def test_options_that_make_no_sense(options: Any) -> None:
    with pytest.raises((TypeError, ValueError)):
        sap.BroadPhase(2, **options)


def test_queries_that_make_no_sense() -> None:
    world = sap.BroadPhase(2)
    world.insert_many(random_boxes(20, 2, np.float64))
    nan, inf = np.nan, np.inf
    for call in (
        lambda: world.containing([nan, 0]),
        lambda: world.within([inf, 0], 1),
        lambda: world.within([0, 0], -1),
        lambda: world.within([0, 0], nan),
        lambda: world.nearest([0, inf]),
        lambda: world.nearest([0, 0], max_distance=-1),
        lambda: world.nearest([0, 0], max_distance=nan),
        lambda: world.ray_cast([0, nan], [1, 1]),
        lambda: world.ray_cast([0, 0], [inf, 1]),
        lambda: world.ray_cast([0, 0], [1, 1], -1),
        lambda: world.ray_cast_all([0, 0], [1, 1], nan),
        lambda: world.box_cast([1, 1, 0, 0], [1, 1]),
    ):
        with pytest.raises(sap.InvalidQueryError) as caught:
            call()
        assert caught.value.index == 0
    with pytest.raises(sap.InvalidQueryError) as caught:
        world.ray_cast_many(np.array([[0, 0], [0, 0], [nan, 0]]), np.ones((3, 2)))
    assert caught.value.index == 2
    with pytest.raises(sap.InvalidBoxError):
        world.overlapping([1, 1, 0, 0])
    wrong: list[Any] = [None, 5, [1], [1, 2, 3], [[1, 2]], "xy", [None, None], [1j, 2]]
    for value in wrong:
        for typed in (
            lambda: world.containing(value),
            lambda: world.within(value, 1),
            lambda: world.nearest(value),
            lambda: world.ray_cast(value, [1, 1]),
            lambda: world.ray_cast([0, 0], value),
            lambda: world.overlapping([value]),
            lambda: world.insert(value),
        ):
            with pytest.raises((TypeError, ValueError)):
                typed()
    for number in (None, "1", [1], 1j):
        with pytest.raises(TypeError):
            world.within([0, 0], number)  # type: ignore[arg-type]
        with pytest.raises(TypeError):
            world.ray_cast([0, 0], [1, 1], number)  # type: ignore[arg-type]
    for k in (-1, 1.5, None, 2**64):
        with pytest.raises((TypeError, ValueError), match="k must"):
            world.nearest([0, 0], k)  # type: ignore[arg-type]
    with pytest.raises(ValueError):
        world.ray_cast_many([[0, 0]], [[1, 1], [2, 2]])
    with pytest.raises(ValueError):
        world.within_many([[0, 0]], [1, 2])
    with pytest.raises(TypeError):
        sap.slots_of([1.5])


def test_nothing_asked_of_nothing() -> None:
    world = sap.BroadPhase(2)
    assert len(world.update().begun) == len(world.pairs()) == len(world.ids()) == len(world) == 0
    assert list(world.overlapping_many([]).each()) == [] and world.containing_many([]).queries().shape == (0,)
    assert world.nearest_many([], 3).ids.shape == (0, 0) and world.nearest([0, 0], 3).ids.shape == (0,)
    assert world.ray_cast([0, 0], [1, 0]) is None and world.ray_cast_many([], []).ids.shape == (0,)
    assert world.insert_many([]).shape == (0,)


def test_filters_allow_what_the_world_reports() -> None:
    random = np.random.default_rng(8)
    for _ in range(50):
        a, b = (
            sap.Filter(
                int(random.integers(0, 4)),
                int(random.integers(0, 4)),
                int(random.integers(-1, 2)),
                bool(random.integers(2)),
            )
            for _ in range(2)
        )
        world = sap.BroadPhase(1)
        world.insert([0, 1], a)
        world.insert([0, 1], b)
        assert len(world.update().begun) == a.allows(b) == b.allows(a)


def test_ids_are_rows_until_a_body_is_removed() -> None:
    world = sap.BroadPhase(1)
    boxes = np.array([[0, 2], [1, 3], [5, 6]])
    ids = world.insert_many(boxes)
    assert ids.dtype == np.int64 and ids.tolist() == [0, 1, 2]
    assert np.bincount(world.update().begun.ravel(), minlength=3).tolist() == [1, 1, 0]
    world.remove(0)
    world.update()
    new = world.insert([1, 2])
    assert new > 2 and sap.slots_of([new]).tolist() == [0]
    with pytest.raises(sap.StaleProxyError, match=r"the id at index 0 \(0\) is stale"):
        world.box(0)
    assert world.contains(new) and not world.contains(0) and not world.contains("hero")


def test_messages_name_the_argument_its_value_and_the_rule() -> None:
    world = sap.BroadPhase(2)
    ids = world.insert_many([[0, 0, 1, 1], [2, 2, 3, 3]])
    nan = np.nan
    cases: list[tuple[Any, str]] = [
        (lambda: world.insert([3, 0, 2, 1]), "box is inverted on axis 0: min 3 is greater than max 2"),
        (lambda: world.set(0, [0, nan, 1, 1]), "box has a NaN on axis 1 (min nan, max 1)"),
        (lambda: world.set_many(ids, [[0, 0, 1, 1], [0, 2, 1, 1]]), "boxes[1] is inverted on axis 1"),
        (lambda: world.set_swept(0, [0, 0, 1, 1], [1, 0, 0, 1]), "end is inverted on axis 0"),
        (lambda: world.set_swept_many([0], [[1, 0, 0, 1]], [[0, 0, 1, 1]]), "starts[0] is inverted on axis 0"),
        (lambda: world.overlapping([1, 1, 0, 0]), "box is inverted on axis 0: min 1 is greater than max 0"),
        (lambda: world.overlapping_many([[1, 1, 2, 2], [1, 1, 2, 0]]), "boxes[1] is inverted on axis 1"),
        (lambda: world.containing([nan, 0]), "point is [nan, 0.0]; it must be not NaN"),
        (lambda: world.within([0, 0], -1), "radius is -1.0; it must be 0 or more"),
        (lambda: world.within_many([[0.0, 0.0], [np.inf, 0.0]], 1), "centers[1] is [inf, 0.0]; it must be finite"),
        (lambda: world.ray_cast([0, 0], [1, 1], -1), "limit is -1.0; it must be 0 or more"),
        (lambda: world.ray_cast([0, nan], [1, 1]), "origin is [0.0, nan]; it must be finite"),
        (lambda: world.ray_cast_many([[0, 0]], [[nan, 1.0]]), "directions[0] is [nan, 1.0]; it must be finite"),
        (
            lambda: world.box_cast([1, 1, 0, 0], [1, 1]),
            "box is [1.0, 1.0, 0.0, 0.0]; it must be min <= max on every axis",
        ),
        (lambda: world.nearest([0, np.inf]), "point is [0.0, inf]; it must be finite"),
        (lambda: sap.find_pairs_between([[0, 1]], [[0, 1], [2, 1]]), "b[1] is inverted on axis 0"),
        (lambda: sap.BroadPhase(2, margin=1), 'margin is 1.0, which has no effect with report="exact"'),
        (lambda: sap.BroadPhase(2, prediction=2), 'prediction is 2.0, which has no effect with report="exact"'),
        (lambda: sap.BroadPhase(2, margin=-1, report="fat"), "margin is -1.0; it must be finite and 0 or more"),
    ]
    for call, message in cases:
        with pytest.raises(ValueError) as caught:
            call()
        assert str(caught.value).startswith(message), str(caught.value)


def test_every_cast_keeps_to_its_limit_and_its_filter() -> None:
    world = sap.BroadPhase(1)
    ghost = world.insert([5, 6], sap.Filter(category=2))
    wall = world.insert([8, 9])
    only_walls = sap.Filter(mask=1)
    casts: list[tuple[Any, Any]] = [
        (lambda *more: world.ray_cast_all([0], [1], *more), lambda *more: world.ray_cast([0], [1], *more)),
        (lambda *more: world.box_cast_all([-1, 0], [1], *more), lambda *more: world.box_cast([-1, 0], [1], *more)),
    ]
    for all_hits, first in casts:
        assert all_hits().ids.tolist() == [ghost, wall] and first().id == ghost
        assert all_hits(5).ids.tolist() == [ghost] and all_hits(4.9).ids.tolist() == [] and first(4.9) is None
        assert first(5).t == 5 and all_hits(8, only_walls).ids.tolist() == [wall] and first(8, only_walls).id == wall
        assert first(7.9, only_walls) is None
    many_casts: list[Any] = [
        lambda *more: world.ray_cast_many([[0], [0]], [[1], [1]], *more),
        lambda *more: world.box_cast_many([[-1, 0], [-1, 0]], [[1], [1]], *more),
    ]
    for many in many_casts:
        assert many().ids.tolist() == [ghost, ghost]
        hits = many([4.9, 5])
        assert hits.ids.tolist() == [-1, ghost] and hits.t.tolist() == [np.inf, 5]
        assert many(4.9).ids.tolist() == [-1, -1]
        assert many([7.9, 8], only_walls).ids.tolist() == [-1, wall]
        assert many([7.9, 8], only_walls).t.tolist() == [np.inf, 8]
