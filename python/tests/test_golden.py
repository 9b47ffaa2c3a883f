"""The shared scenes: the pairs that scenes/golden.txt names, which the tests of Rust and JavaScript have too."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from oracle import Array, in_order

import sweep_and_prune as sap

ROOT = Path(__file__).parents[2]
LINES = [line.split() for line in (ROOT / "scenes/golden.txt").read_text().splitlines() if not line.startswith("#")]


def test_every_line_has_its_boxes(scenes: Path) -> None:
    assert sorted(path.name for path in scenes.iterdir()) == sorted(" ".join(line[:3]) for line in LINES)
    assert len(LINES) > 50


@pytest.mark.parametrize("line", LINES, ids=lambda line: "-".join(line[:3]))
def test_the_pairs_of_every_line(scenes: Path, line: list[str]) -> None:
    scene, space, kind, boxes_hash, count, pairs_hash = line
    dtype = np.dtype(kind.replace("32", "4").replace("64", "8")).newbyteorder("<")
    dimensions = int(space[0])
    boxes = np.fromfile(scenes / f"{scene} {space} {kind}", dtype).reshape(-1, 2 * dimensions)
    assert fnv1a(boxes.astype("<f8")) == boxes_hash
    for found in (sap.find_pairs(boxes), sap.PairFinder(dimensions, dtype).find(boxes)):
        assert (str(len(found)), fnv1a(in_order(found).astype("<u4"))) == (count, pairs_hash)
    world = sap.BroadPhase(dimensions, dtype)
    world.insert_many(boxes)
    begun = sap.slots_of(world.update().begun)
    assert (str(len(begun)), fnv1a(begun.astype("<u4"))) == (count, pairs_hash)


def fnv1a(array: Array) -> str:
    """The 64-bit FNV-1a hash, in hexadecimal, as scenes/src/golden.rs has it."""
    value = 0xCBF29CE484222325
    for byte in array.tobytes():
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFF_FFFF_FFFF_FFFF
    return f"{value:016x}"
