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


CROWD = """
import resource
import numpy as np
import sweep_and_prune as sap
resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
world = sap.BroadPhase(1)
world.insert_many([[90, 91], [90, 92]])
world.update()
ids = world.insert_many(np.zeros((30_000, 2)))  # 450 million pairs: 3.6 GB
before = world.state_hash()
for _ in range(2):
    try:
        world.update()
    except MemoryError as error:
        print("memory" in str(error), world.state_hash() == before, world.pairs().tolist())
world.remove_many(ids[3:])
print(world.update().begun.tolist())
world.shrink_to_fit()
print(world.pairs().tolist())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited in the way of Linux")
def test_a_crowd_whose_pairs_do_not_fit_leaves_the_world_as_it_was() -> None:
    done = subprocess.run([sys.executable, "-c", CROWD], capture_output=True, text=True)
    crowd = [[2, 3], [2, 4], [3, 4]]
    wanted = ["True True [[0, 1]]"] * 2 + [str(crowd), str([[0, 1], *crowd])]
    assert done.stdout.splitlines() == wanted, done.stderr


QUERIES = """
import resource
import numpy as np
import sweep_and_prune as sap
resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))
world = sap.BroadPhase(2)
ids = world.insert_many(np.tile([0, 0, 1, 1], (30_000, 1)))
points = np.zeros((20_000, 2))  # 600 million answers: 4.8 GB
for ask in (
    lambda: world.overlapping_many(np.tile(points, 2)),
    lambda: world.containing_many(points),
    lambda: world.within_many(points, np.ones(20_000)),
    lambda: world.nearest_many(points, 30_000),
):
    try:
        ask()
    except MemoryError as error:
        print("memory" in str(error))
    found = world.overlapping([0, 0, 0, 0])
    print((found == ids).all())
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited in the way of Linux")
def test_answers_to_queries_that_do_not_fit_are_an_error_after_which_one_can_ask_again() -> None:
    done = subprocess.run([sys.executable, "-c", QUERIES], capture_output=True, text=True)
    assert done.stdout.splitlines() == ["True", "True"] * 4, done.stderr


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


PEAK = """
import sys
import numpy as np
import sweep_and_prune as sap

def peak(name):
    with open("/proc/self/status") as status:
        return next(int(line.split()[1]) * 1024 for line in status if line.startswith(name))

boxes = np.zeros((4400, 4))  # 10 million pairs
with_gap, with_point, in_space, group = boxes.copy(), boxes + [0, 0, 1, 1], np.zeros((4400, 6)), np.zeros(4400)
with_gap[0], with_point[0], group[0] = np.nan, 0, 1
sap.count_pairs(np.zeros((5000, 4)), threads=2)  # starts the threads
finder, threads = sap.PairFinder(2, threads=int(sys.argv[2])), int(sys.argv[2])
with open("/proc/self/clear_refs", "w") as file:
    file.write("5")  # the peak is what there is now
before = peak("VmRSS")
calls = {
    "find": lambda: sap.find_pairs(boxes, threads=threads),
    "finder": lambda: finder.find(boxes),
    "between": lambda: sap.find_pairs_between(boxes[:2200], boxes, threads=threads),
    "skip": lambda: sap.find_pairs(with_gap, threads=threads, missing="skip"),
    "open": lambda: sap.find_pairs(with_point, threads=threads, closed="left"),
    "by": lambda: sap.find_pairs(in_space, threads=threads, by=group),
}
found = calls[sys.argv[1]]()
print((peak("VmHWM") - before) / found.nbytes)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read in the way of Linux")
@pytest.mark.parametrize("threads", ["1", "2"])
@pytest.mark.parametrize("call", ["find", "finder", "between", "skip", "open", "by"])
def test_a_large_result_takes_little_more_memory_than_its_own(call: str, threads: str) -> None:
    done = subprocess.run([sys.executable, "-c", PEAK, call, threads], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert float(done.stdout) < 1.2


@pytest.mark.skipif(sys.platform != "linux", reason="memory is read in the way of Linux")
def test_inserting_and_removing_without_an_update_takes_no_more_memory() -> None:
    def resident() -> int:
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * 4096

    world = sap.BroadPhase(2)

    def churn(count: int) -> None:
        for _ in range(count):
            world.remove(world.insert([0, 0, 1, 1]))

    churn(2000)
    before = resident()
    churn(30_000)  # used to take 4.5 MB
    assert resident() - before < 1_000_000
