"""Hits of rays and moving boxes against brute force: where, which face, from inside or not, and what is left out.

Coordinates are small whole numbers, so that boxes touch all the time, and speeds are powers of two, so that t is exact.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest

import sweep_and_prune as sap


class Path(NamedTuple):
    """A box, which may be a point, that moves."""

    box: list[float]
    direction: list[float]
    limit: float


class Expected(NamedTuple):
    """What a cast says of a body that it hits."""

    t: float
    normal: tuple[float, ...]
    starts_inside: bool


def gaps(path: Path, body: list[float]) -> list[tuple[float, float, float]]:
    """For each axis the speed, and how far the box has to move up until it touches the body, and until it is past."""
    count = len(path.direction)
    return [
        (speed, body[axis] - path.box[axis + count], body[axis + count] - path.box[axis])
        for axis, speed in enumerate(path.direction)
    ]


def overlaps(path: Path, body: list[float], t: float, inside: bool = False) -> bool:
    """Whether they overlap at a time: with their edges, or within them."""
    return all(
        before < speed * t < behind if inside else before <= speed * t <= behind
        for speed, before, behind in gaps(path, body)
    )


def expected_hit(path: Path, body: list[float], ignore_touching: bool) -> Expected | None:
    """The hit of one body, from the times at which something may change and those between."""
    edges = [edge / speed for speed, *both in gaps(path, body) if speed for edge in both]
    changes = sorted({0.0, path.limit, *(t for t in edges if 0 < t < path.limit)})
    times = sorted({*changes, *((a + b) / 2 for a, b in zip(changes, changes[1:]))})
    t = next((t for t in times if overlaps(path, body, t)), None)
    if t is None or (ignore_touching and not any(overlaps(path, body, t, inside=True) for t in times)):
        return None
    normal = [0.0] * len(path.direction)
    if overlaps(path, body, 0, inside=True):
        return Expected(t, tuple(normal), True)
    # The faces that touch at t; one that it moves towards comes first.
    faces = [
        (speed * side >= 0, axis, side)
        for axis, (speed, before, behind) in enumerate(gaps(path, body))
        for edge, side in ((before, -1.0), (behind, 1.0))
        if edge == speed * t
    ]
    _, axis, side = min(faces, key=lambda face: face[0])
    normal[axis] = side
    return Expected(t, tuple(normal), False)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("dimensions", [1, 2, 3])
def test_hits_equal_brute_force(dimensions: int, dtype: Any) -> None:
    random = np.random.default_rng(70 + dimensions)
    touching, inside, ignored, faces = 0, 0, 0, set()

    def box() -> list[float]:
        """Of some size: no inside of a flat box can be entered."""
        corners = np.sort(random.integers(-3, 4, (2, dimensions)), axis=0).astype(float)
        return [*corners[0].tolist(), *(corners[1] + 1).tolist()]

    for _ in range(200):
        bodies = [box() for _ in range(6)]
        world = sap.BroadPhase(dimensions=dimensions, dtype=dtype)
        ids = world.insert_many(bodies).tolist()
        start, is_ray = box(), random.random() < 0.3
        point = start[:dimensions]
        path = Path(
            point + point if is_ray else start,
            random.integers(-2, 3, dimensions).astype(float).tolist(),
            float(random.choice([0, 0.5, 1, 4, 100])),
        )
        first: Callable[..., Any] = world.ray_cast if is_ray else world.box_cast
        every: Callable[..., Any] = world.ray_cast_all if is_ray else world.box_cast_all
        many: Callable[..., Any] = world.ray_cast_many if is_ray else world.box_cast_many
        arguments = (point if is_ray else start, path.direction, path.limit)
        for ignore_touching in (False, True):
            excluded = [id for id in ids if random.random() < 0.2]
            options = {"ignore_touching": ignore_touching, "exclude": excluded}
            wanted = sorted(
                (hit.t, id, hit)
                for id, body in zip(ids, bodies)
                if id not in excluded and (hit := expected_hit(path, body, ignore_touching)) is not None
            )
            found = every(*arguments, **options)
            assert found.ids.tolist() == [id for _, id, _ in wanted]
            rows = zip(found.t.tolist(), map(tuple, found.normals.tolist()), found.starts_inside.tolist())
            hits = [Expected(*row) for row in rows]
            assert hits == [hit for *_, hit in wanted]
            nearest = first(*arguments, **options)
            firsts = many([arguments[0]] * 2, [path.direction] * 2, path.limit, **options)
            if wanted:
                assert nearest == (wanted[0][1], *wanted[0][2])
                assert firsts.ids.tolist() == [nearest.id] * 2 and firsts.t.tolist() == [nearest.t] * 2
                assert firsts.normals.tolist() == [list(nearest.normal)] * 2
                assert firsts.starts_inside.tolist() == [nearest.starts_inside] * 2
            else:
                assert nearest is None and firsts.ids.tolist() == [-1, -1]
                assert not firsts.normals.any() and not firsts.starts_inside.any()
            faces |= {hit.normal for hit in hits}
            inside += sum(hit.starts_inside for hit in hits)
            touching += sum(hit.t == 0 and not hit.starts_inside for hit in hits)
            if ignore_touching:
                ignored += len(every(*arguments, exclude=excluded).ids) - len(hits)
    assert touching > 20 and inside > 20 and ignored > 10
    assert len(faces) == 2 * dimensions + 1


def test_queries_leave_out_what_is_excluded() -> None:
    world = sap.BroadPhase(dimensions=2)
    a, b, c = world.insert_many([[0, 0, 2, 2], [1, 1, 3, 3], [1, 1, 4, 4]]).tolist()
    gone = world.insert([1, 1, 2, 2])
    world.remove(gone)
    area, point = [1, 1, 2, 2], [1.5, 1.5]
    assert world.overlapping(area, exclude=a).tolist() == [b, c]
    assert world.overlapping(area, exclude=np.int64(a)).tolist() == [b, c]
    assert world.overlapping(area, exclude=[c, a, gone, -1]).tolist() == [b]
    for large in (2**63 + a, 2**70 + a, np.uint64(2**63 + a), np.array([2**63 + a], np.uint64), [2**70 + a]):
        assert world.overlapping(area, exclude=large).tolist() == [a, b, c]
    assert world.overlapping_many([area, area], exclude=np.array([b])).ids.tolist() == [a, c, a, c]
    assert world.containing(point, exclude=a).tolist() == [b, c]
    assert world.containing_many([point], exclude=(a, b)).ids.tolist() == [c]
    assert world.within(point, 1, exclude=b).tolist() == [a, c]
    assert world.within_many([point], 1, exclude=b).ids.tolist() == [a, c]
    assert world.nearest(point, 2, exclude=[a]).ids.tolist() == [b, c]
    assert world.nearest_many([point], 3, exclude=[a]).ids.tolist() == [[b, c]]
    assert world.overlapping(area, exclude=[]).tolist() == [a, b, c]


def test_wrong_exclusions_and_flags_are_refused() -> None:
    world = sap.BroadPhase(dimensions=1)
    world.insert([0, 1])
    wrong: Any
    for wrong in ([0.5], ["a"], [[0]], 0.5, True, "0", {0: 1}):
        with pytest.raises((TypeError, ValueError)):
            world.overlapping([0, 1], exclude=wrong)
    for wrong in (1, "yes", None):
        with pytest.raises(TypeError, match="ignore_touching must be True or False"):
            world.ray_cast([0], [1], ignore_touching=wrong)
