"""A world whose bodies are inserted, moved and removed stays right, and its memory flat. So does one that is only
edited and queried, never updated. SOAK_MINUTES says for how long, counted in updates: no machine is too slow or too
fast."""

from __future__ import annotations

import gc
import os
import sys

import numpy as np
from oracle import Array, overlaps, pairs

import sweep_and_prune as sap

COUNT = 2000
# The world moves in one way for this many updates: every body, one in 50, one in 7, or none.
PHASE = 100
MOVING = (1, 50, 7, COUNT + 1)
# Updates in which the world moves in each way once.
CYCLE = PHASE * len(MOVING)
# How many updates a minute has, on an average machine.
UPDATES_PER_MINUTE = 40 * CYCLE
MINUTES = float(os.environ.get("SOAK_MINUTES", 1 if "TEST_LONG" in os.environ else 1 / 20))
# Memory is compared after half of the updates, which is whole cycles, and after all.
HALF = CYCLE * max(1, round(MINUTES * UPDATES_PER_MINUTE / (2 * CYCLE)))
# Updates between two comparisons with brute force.
CHECK = 200


def as_set(found: Array) -> set[tuple[int, int]]:
    return set(map(tuple, found.tolist()))


class Soak:
    def __init__(self) -> None:
        self.random = np.random.default_rng(1)
        self.world = sap.BroadPhase(2)
        self.boxes = self.draw(COUNT)
        self.velocities = 0.004 * (self.random.random((COUNT, 2)) - 0.5)
        self.ids = self.world.insert_many(self.boxes).copy()
        # The pairs by the events so far.
        self.live: set[tuple[int, int]] = set()
        # Is never updated.
        self.edited = sap.BroadPhase(2)
        self.edited_boxes = self.draw(COUNT // 10)
        self.edited_ids = self.edited.insert_many(self.edited_boxes).copy()

    def draw(self, count: int) -> Array:
        """Boxes in the unit square, few of them large."""
        side = 0.03 * self.random.random((count, 1))
        side[self.random.random(count) < 0.01] = 0.3
        least = self.random.random((count, 2))
        return np.hstack([least, least + side])

    def update(self) -> None:
        begun, ended = (as_set(found) for found in self.world.update())
        assert ended <= self.live and not begun & self.live
        self.live = self.live - ended | begun

    def step(self, number: int) -> None:
        """One update, with all that a game does between two of them."""
        every = MOVING[number // PHASE % len(MOVING)]
        movers = np.arange(every - 1, COUNT, every)
        # They turn around where they leave the unit square.
        after = self.boxes[movers, :2] + self.velocities[movers]
        self.velocities[movers] *= np.where((after < 0) | (after > 1), -1, 1)
        self.boxes[movers] += np.tile(self.velocities[movers], 2)
        self.world.set_many(self.ids[movers], self.boxes[movers])
        for body, box in zip(self.random.integers(0, COUNT, COUNT // 200), self.draw(COUNT // 200)):
            kind = self.random.integers(3)
            if kind == 0:
                self.world.set(self.ids[body], box)
            elif kind == 1:
                self.world.set_swept(self.ids[body], self.boxes[body], box)
            else:
                self.world.remove(self.ids[body])
                self.ids[body] = self.world.insert(box)
            self.boxes[body] = box
        area = self.draw(1)[0]
        self.world.overlapping(area)
        self.world.nearest(area[:2], 5)
        self.world.ray_cast(area[:2], [0.3, 0.2], 1.0)
        self.update()
        self.edit()

    def edit(self) -> None:
        """What happens to the world that is never updated."""
        for body, box in zip(self.random.integers(0, len(self.edited_ids), 20), self.draw(20)):
            kind = self.random.integers(3)
            if kind == 0:
                self.edited.set(self.edited_ids[body], box)
            elif kind == 1:
                self.edited.set_swept(self.edited_ids[body], box, box)
            else:
                self.edited.remove(self.edited_ids[body])
                self.edited_ids[body] = self.edited.insert(box)
            self.edited_boxes[body] = box
        area = self.draw(1)
        found = self.edited_ids[overlaps(self.edited_boxes, area)[:, 0]]
        assert sorted(self.edited.overlapping(area[0])) == sorted(found)

    def compare(self) -> None:
        """Compares pairs, events and queries with brute force, and goes on with a restored world."""
        # A swept body is at its end after one update, so that the boxes are those of the second.
        self.update()
        self.update()
        order = np.argsort(sap.slots_of(self.ids))
        ids, boxes = self.ids[order], self.boxes[order]
        expected = as_set(ids[pairs(boxes)])
        assert as_set(self.world.pairs()) == expected
        assert self.live == expected
        area = self.draw(1)
        assert sorted(self.world.overlapping(area[0])) == sorted(ids[overlaps(boxes, area)[:, 0]])
        restored = sap.BroadPhase.from_snapshot(self.world.snapshot())
        assert restored.state_hash() == self.world.state_hash()
        self.world = restored


def memory() -> float:
    """The memory of the process in MiB; 0 where it cannot be read in the way of Linux."""
    if sys.platform != "linux":
        return 0.0
    with open("/proc/self/statm") as statm:
        return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE") / 2**20


def test_a_world_stays_right_and_its_memory_flat() -> None:
    soak = Soak()
    used = []
    for number in range(2 * HALF):
        soak.step(number)
        if number % CHECK == CHECK - 1:
            soak.compare()
        if (number + 1) % HALF == 0:
            gc.collect()
            used.append(memory())
            print(f"after {number + 1} updates: {used[-1]:.1f} MiB", flush=True)
    # By the first half buffers have grown to their sizes.
    assert used[1] <= 1.1 * used[0] + 16, f"memory grew from {used[0]:.1f} to {used[1]:.1f} MiB"
