"""Searches of one thread share buffers, and nothing else."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from oracle import in_order, pairs, random_boxes

import sweep_and_prune as sap
from sweep_and_prune import _pairs


def test_searches_of_all_kinds_in_turn_find_what_each_finds_alone() -> None:
    random = np.random.default_rng(1)
    for seed in range(200):
        dimensions, dtype = int(random.integers(1, 4)), random.choice(["float32", "float64"])
        boxes = random_boxes(int(random.integers(0, 300)), dimensions, dtype, seed=seed)
        found = sap.find_pairs(boxes, threads=int(random.integers(1, 3)))
        np.testing.assert_array_equal(in_order(found), pairs(boxes))
        if seed % 3 == 0 and len(boxes):
            boxes[-1, 0] = np.nan
            with pytest.raises(sap.InvalidBoxError, match=rf"boxes\[{len(boxes) - 1}\]"):
                sap.find_pairs(boxes)


def test_a_search_within_a_search() -> None:
    outer, inner = random_boxes(3_000, 2, np.float64, seed=1), random_boxes(500, 2, np.float64, seed=2)
    chunks = []
    sap.find_pairs(outer)

    def look(chunk: NDArray[np.int64]) -> None:
        chunks.append(chunk)
        np.testing.assert_array_equal(in_order(sap.find_pairs(inner)), pairs(inner))

    assert sap.for_each_chunk(outer, look, size=500)
    assert len(chunks) > 3
    np.testing.assert_array_equal(in_order(np.concatenate(chunks)), pairs(outer))


def test_buffers_of_large_searches_are_not_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    boxes = random_boxes(100, 2, np.float64)
    sap.find_pairs(boxes)
    kept = _pairs._idle.last
    sap.find_pairs(boxes)
    assert _pairs._idle.last[1] is kept[1]
    monkeypatch.setattr(_pairs, "_KEPT_BYTES", boxes.nbytes - 1)
    sap.find_pairs(boxes)
    assert not vars(_pairs._idle)
