"""Too little memory is a `MemoryError`, after which one can go on; and memory comes back."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from oracle import random_boxes

import sweep_and_prune as sap

LIMITED = """
import resource
import numpy as np
import sweep_and_prune as sap
resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
boxes = np.zeros((30_000, 4))  # 450 million pairs: 3.6 GB
boxes[:, 2] = 1 + np.arange(30_000)
finder = sap.PairFinder(2)
for find in (sap.find_pairs, finder.find, lambda boxes: sap.find_pairs_between(boxes, boxes)):
    try:
        find(boxes)
    except MemoryError as error:
        print("memory" in str(error))
print(finder.find(boxes[:3]).tolist(), finder.count(boxes), sap.count_pairs(boxes))
seen = 0
def each(pairs):
    global seen
    seen += len(pairs)
    return seen < 10_000_000
print(sap.for_each_chunk(boxes, each), seen)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited in the way of Linux")
def test_too_little_memory_is_an_error_after_which_one_can_go_on() -> None:
    done = subprocess.run([sys.executable, "-c", LIMITED], capture_output=True, text=True)
    pairs = 30_000 * 29_999 // 2
    chunks = -(-10_000_000 // 65_536) * 65_536
    wanted = ["True"] * 3 + [f"[[0, 1], [0, 2], [1, 2]] {pairs} {pairs}", f"False {chunks}"]
    assert done.stdout.splitlines() == wanted, done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read in the way of Linux")
def test_memory_comes_back() -> None:
    def resident() -> int:
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * 4096

    boxes = random_boxes(5000, 3, np.float32)

    def use() -> None:
        finder, world = sap.PairFinder(3, np.float32), sap.BroadPhase(3, np.float32)
        ids = world.insert_many(boxes)
        world.update()
        world.overlapping_many(boxes)
        finder.find(boxes)
        sap.BroadPhase.from_snapshot(world.snapshot()).set_many(ids, boxes)
        for wrong in (boxes * np.float32(np.nan), boxes[:, ::-1]):
            for call in (finder.find, world.insert_many):
                with pytest.raises(sap.InvalidBoxError):
                    call(wrong)

    for _ in range(5):
        use()
    before = resident()
    for _ in range(60):
        use()
    # Each round takes megabytes: of 60 that were kept there would be hundreds.
    assert resident() - before < 40_000_000


def test_more_boxes_than_indices_can_tell_apart_are_refused_before_they_are_copied() -> None:
    many = np.broadcast_to(np.zeros((1, 2)), (2**32, 2))
    world = sap.BroadPhase(1)
    for call in (
        lambda: sap.find_pairs(many),
        lambda: sap.find_pairs_between([[0, 1]], many),
        lambda: world.insert_many(many),
    ):
        with pytest.raises(ValueError, match="4294967296 boxes, more than the limit"):
            call()
