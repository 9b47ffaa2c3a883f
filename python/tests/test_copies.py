"""Finders and worlds can be copied and pickled, subclasses and attributes included."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import numpy as np
import pytest
from oracle import random_boxes

import sweep_and_prune as sap


class NamedFinder(sap.PairFinder):
    name = "none"


class NamedWorld(sap.BroadPhase):
    def __init__(self, name: str) -> None:
        super().__init__(2, np.float32, report="fat", margin=0.5)
        self.name = name
        self.tags = {"a": [1]}


class SlottedFinder(sap.PairFinder):
    __slots__ = ("__mine", "empty", "name")

    def put(self, mine: object) -> None:
        self.__mine = mine

    def get(self) -> object:
        return self.__mine


class SlottedWorld(sap.BroadPhase):
    __slots__ = ("name",)

    @property
    def double(self) -> object:
        return vars(self)["double"]


COPIES: list[Any] = [copy.copy, copy.deepcopy, lambda value: pickle.loads(pickle.dumps(value))]


@pytest.mark.parametrize("duplicate", COPIES)
def test_a_copied_finder_has_its_own_buffers(duplicate: Any) -> None:
    finder = NamedFinder(1, np.float32, threads=2, index_dtype=np.uint32)
    finder.name = "mine"
    again = duplicate(finder)
    assert type(again) is NamedFinder and again.name == "mine" and repr(again) == repr(finder)

    def use_the_other(chunk: Any) -> None:
        assert again.find([[0, 1], [1, 2]]).dtype == np.uint32

    assert finder.for_each_chunk([[0, 1], [1, 2]], use_the_other)


@pytest.mark.parametrize("duplicate", COPIES)
def test_a_copied_world_keeps_its_class_its_attributes_and_its_state(duplicate: Any) -> None:
    world = NamedWorld("mine")
    world.insert_many(random_boxes(50, 2, np.float32))
    world.update()
    again = duplicate(world)
    assert type(again) is NamedWorld and (again.name, again.tags) == ("mine", {"a": [1]})
    assert again.state_hash() == world.state_hash() and repr(again) == repr(world)
    again.insert([0, 0, 1, 1])
    assert len(again) == len(world) + 1


@pytest.mark.parametrize("duplicate", COPIES)
def test_copies_have_what_is_in_slots(duplicate: Any) -> None:
    finder = SlottedFinder(1)
    finder.name = "mine"  # type: ignore[attr-defined]
    finder.put([1])
    vars(finder)["other"] = 2
    again = duplicate(finder)
    assert (again.name, again.get(), again.other) == ("mine", [1], 2) and not hasattr(again, "empty")
    assert len(again.find([[0, 1], [1, 2]])) == 1
    world = SlottedWorld(1)
    world.name = "mine"  # type: ignore[attr-defined]
    vars(world)["double"] = 3
    again = duplicate(world)
    assert (again.name, again.double) == ("mine", 3) and "name" not in vars(again)


def test_a_deep_copy_shares_no_attributes() -> None:
    world = NamedWorld("mine")
    again = copy.deepcopy(world)
    again.tags["a"].append(2)
    assert world.tags == {"a": [1]}
