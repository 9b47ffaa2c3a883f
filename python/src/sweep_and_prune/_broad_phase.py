"""The persistent broad phase: bodies that are inserted, moved and removed, and the overlaps that begin and end."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._arrays import (
    Boxes,
    Floats,
    Ids,
    Points,
    box_rows,
    each,
    float_dtype,
    id_array,
    one_id,
    real,
    row,
    rows,
    truth,
    two_ids,
    whole,
)
from ._columns import as_array
from ._errors import InvalidQueryError
from ._filter import Filter, words
from ._inputs import is_named
from ._native import World
from ._state import attributes, set_attributes


class Changes(NamedTuple):
    """The overlaps that began and ended; see `BroadPhase.update`."""

    begun: Ids
    """`(m, 2)` ids: the pairs that overlap now and did not overlap at the last update."""
    ended: Ids
    """`(m, 2)` ids: the pairs that overlapped at the last update and do not now; removed bodies may be among them."""


class Hit(NamedTuple):
    """A body that a ray or a moving box hits."""

    id: int
    """The body."""
    t: float
    """The ray hits at `origin + t * direction`; 0 if they overlap at the start."""
    normal: tuple[float, ...]
    """Which way the face that is hit looks: of length 1 along an axis, away from the body. All 0 if the cast starts
    inside the body. At an edge or a corner, the face of the first axis."""
    starts_inside: bool
    """Whether the cast starts inside the body. A box that only touches it at the start does not."""


class Hits(NamedTuple):
    """All hits of one cast, nearest first, or the first hit of each of many casts."""

    ids: Ids
    """`(n,)` ids; of many casts, -1 for a cast that hits nothing."""
    t: NDArray[np.float64]
    """`(n,)`: each hit is at `origin + t * direction`; of many casts, infinite for a cast that hits nothing."""
    normals: NDArray[np.float64]
    """`(n, dimensions)`: the normal of each hit, as in `Hit`; of many casts, 0 for a cast that hits nothing."""
    starts_inside: NDArray[np.bool_]
    """`(n,)`: whether each cast starts inside what it hits."""


class Neighbors(NamedTuple):
    """The bodies nearest to a point, nearest first, or to each of many points."""

    ids: Ids
    """`(k,)` ids; of many points `(n, k)`."""
    distances: NDArray[np.float64]
    """The distance from the point to each body's box, in the same shape; 0 if the box contains the point."""


class Found(NamedTuple):
    """What the compiled part finds."""

    ids: Ids
    values: NDArray[np.float64]
    faces: NDArray[np.int64]
    ends: NDArray[np.int64]


class Lists(NamedTuple):
    """The bodies that each of many queries found, or that pair with each body.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> ids = world.insert_many([[0, 2], [1, 3]])
    >>> found = world.containing_many([[0.5], [1.5], [9]])
    >>> [ids_of_query.tolist() for ids_of_query in found.each()]
    [[0], [0, 1], []]
    >>> found.queries()  # which query found each of found.ids
    array([0, 1, 1])
    """

    ids: Ids
    """`(m,)` ids, list by list, those of each list sorted by slot."""
    ends: NDArray[np.int64]
    """`(n,)`: where each list ends in `ids`. It begins where the one before ends."""

    def each(self) -> Iterator[Ids]:
        """Iterates over the lists."""
        return iter(np.split(self.ids, self.ends[:-1]) if len(self.ends) else [])

    def queries(self) -> NDArray[np.int64]:
        """`(m,)`: the position of the list that each of `ids` is in."""
        counts = np.diff(self.ends, prepend=0)
        return np.repeat(np.arange(len(self.ends)), counts)


def slots_of(ids: ArrayLike) -> NDArray[np.int64]:
    """Returns the slots of bodies: small integers, to be used as rows of your own tables.

    Two bodies never share a slot at the same time, and slots are less than the largest number of bodies there ever
    were at once (bodies that were removed since the last update count too). A slot is used again after its body was
    removed; an id is not. While nothing was removed, the slot of a body is its id.

    Args:
        ids: ids of any shape.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> a, b = world.insert([0, 2]), world.insert([1, 3])
    >>> world.remove(a)
    >>> changes = world.update()
    >>> c = world.insert([5, 6])
    >>> c, sap.slots_of([b, c]).tolist()  # a new id in the slot of a
    (4294967296, [1, 0])
    """
    array = as_array(ids, "ids")
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError(f"ids must be whole numbers, not of dtype {array.dtype}")
    return array.astype(np.int64) & 0xFFFF_FFFF


class BroadPhase:
    """A world of boxes that reports which overlaps began and which ended.

    Insert, set and remove bodies as often as you like; `update` then reports the pairs that began and ended since the
    last update. Touching boxes overlap. A `Filter` decides which bodies may pair. A resting body costs only memory.

    Ids are `int64`, slot and generation in one. Until a body is removed, the ids of a world are 0, 1, 2 and so on: the
    rows of the boxes that you inserted. After that, new bodies in used slots have larger ids, so that the id of a
    removed body never means another body: it is rejected (`StaleProxyError`). `slots_of` then gives rows. -1 is never
    an id. An id of another world is not recognized as such.

    The same calls give the same results on every machine. A call that raises an error changes nothing. Only one call
    runs at a time: a second thread that calls meanwhile gets a `RuntimeError`. A world can be copied and pickled, with
    its attributes and its subclass.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=2)
    >>> hero = world.insert([0, 0, 1, 2])
    >>> gate = world.insert([3, 0, 4, 2])
    >>> len(world.update().begun)
    0
    >>> world.set(hero, [2.5, 0, 3.5, 2])
    >>> for a, b in world.update().begun:
    ...     print(a == hero, b == gate)
    True True
    >>> world.remove(gate)
    >>> len(world.update().ended)
    1
    """

    def __init__(
        self,
        dimensions: int = 3,
        dtype: DTypeLike = np.float64,
        *,
        margin: float = 0.0,
        prediction: float = 0.0,
        report: str = "exact",
    ) -> None:
        """Creates an empty world.

        Args:
            dimensions: 1, 2 or 3.
            dtype: `float32` or `float64`, in which coordinates are stored and compared. Everything that is passed
                is converted to it, which rounds `float64` to `float32`.
            margin: only with `report="fat"`: how far a fattened AABB extends around the body's box, in units of
                length.
            prediction: only with `report="fat"`: how many displacements ahead a fattened AABB reaches.
            report: `"exact"` reports the pairs of the boxes as given. `"fat"` reports the pairs of fattened AABBs,
                which begin and end less often. Fattening is not needed for speed.

        Raises:
            ValueError, TypeError: for other dimensions, types or reports, for a margin or prediction that is
                negative, infinite or NaN, or for one that has no effect because of `report`.
        """
        self._dimensions = whole(dimensions, "dimensions", 1, 3)
        self._dtype = float_dtype(dtype)
        if not (isinstance(report, str) and report in ("exact", "fat")):
            raise ValueError(f'report must be "exact" or "fat", not {report!r}')
        margin, prediction = real(margin, "margin"), real(prediction, "prediction")
        for name, value in (("margin", margin), ("prediction", prediction)):
            if not (0 <= value < np.inf):
                raise ValueError(f"{name} is {value}; it must be finite and 0 or more")
            if value and report == "exact":
                raise ValueError(f'{name} is {value}, which has no effect with report="exact": pass report="fat" too')
        self._world = World(self._dimensions, self._dtype.itemsize == 8, margin, prediction, report == "fat")

    @classmethod
    def from_snapshot(cls, snapshot: bytes | bytearray | memoryview) -> BroadPhase:
        """Restores a world from a `snapshot`: for the same calls it gives the same ids, events and results.

        Dimensions, dtype, margins and report are in the bytes. Takes the time of finding all pairs.

        Args:
            snapshot: the bytes.

        Raises:
            SnapshotError: for bytes that are truncated, changed, of another version, or not a snapshot.
            TypeError: for anything but bytes.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> saved = world.snapshot()
        >>> len(sap.BroadPhase.from_snapshot(saved).update().begun)
        1
        """
        if not isinstance(snapshot, (bytes, bytearray, memoryview)):
            raise TypeError(f"a snapshot must be bytes, not a {type(snapshot).__name__}")
        world = cls.__new__(cls)
        world._restore(bytes(snapshot))
        return world

    def _restore(self, snapshot: bytes) -> None:
        self._world, self._dimensions, is_double = World.restore(snapshot)
        self._dtype = np.dtype(np.float64 if is_double else np.float32)

    @property
    def dimensions(self) -> int:
        """The number of dimensions of the boxes."""
        return self._dimensions

    @property
    def dtype(self) -> np.dtype[Any]:
        """The precision in which coordinates are stored and compared."""
        return self._dtype

    def __len__(self) -> int:
        """The number of bodies."""
        return len(self._world)

    def __contains__(self, id: object) -> bool:
        """Tells whether an id names a body of this world."""
        try:
            return bool(self._world.contains(one_id(id, or_none=True))[0])
        except TypeError:
            return False

    def contains(self, id: object) -> bool:
        """Tells whether an id names a body of this world, as `id in world` does.

        Args:
            id: anything; what cannot be an id is not contained.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.contains(world.insert([0, 1]))
        True
        """
        return id in self

    def contains_many(self, ids: ArrayLike) -> NDArray[np.bool_]:
        """Tells whether each of many ids names a body of this world.

        Args:
            ids: `(n,)` whole numbers.

        Returns:
            `(n,)` `bool`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> world.remove(ids[0])
        >>> world.contains_many(ids)
        array([False,  True])
        """
        return self._world.contains(id_array(ids, or_none=True))

    def ids(self) -> Ids:
        """Returns the ids of all bodies, `(n,)`, sorted by slot. O(n) time."""
        return self._world.ids()

    def insert(self, box: ArrayLike, filter: Filter | None = None) -> int:
        """Adds a body and returns its id.

        Args:
            box: `2 * dimensions` numbers, the min corner and then the max corner.
            filter: which bodies it may pair with; `Filter()` by default.

        Raises:
            InvalidBoxError: if the box is inverted or has a NaN.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> wall = world.insert([0, 0, 1, 9], sap.Filter(is_static=True))
        >>> wall in world
        True
        """
        return int(self._world.insert(self._row(box, "box"), _given(filter), "box")[0])

    def insert_many(self, boxes: Boxes, filter: Filter | None = None) -> Ids:
        """Adds many bodies that share a filter.

        Args:
            boxes: `(n, 2 * dimensions)` numbers, a row for each.
            filter: which bodies they may pair with; `Filter()` by default.

        Returns:
            `(n,)` ids, in the order of their boxes.

        Raises:
            InvalidBoxError: for the first box that is inverted or has a NaN; then none was added.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import numpy as np
        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=3)
        >>> len(world.insert_many(np.zeros((1000, 6)))), len(world)
        (1000, 1000)
        """
        return self._world.insert(self._rows(boxes, "boxes"), _given(filter), "boxes")

    def set(self, id: SupportsIndex, box: ArrayLike) -> None:
        """Sets the box of a body.

        Args:
            id: the body.
            box: `2 * dimensions` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: then nothing has changed.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> hero = world.insert([0, 1])
        >>> world.set(hero, [5, 6])
        >>> world.box(hero)
        array([5., 6.])
        """
        self._world.set(one_id(id), self._row(box, "box"), "box")

    def set_many(self, ids: ArrayLike, boxes: Boxes) -> None:
        """Sets the boxes of many bodies.

        If an id occurs twice, the last box counts.

        Args:
            ids: `(n,)` ids.
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: for the first id or box that is invalid; then no box has changed.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import numpy as np
        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> boxes = np.array([[0.0, 1.0], [5.0, 6.0]])
        >>> ids = world.insert_many(boxes)
        >>> world.set_many(ids, boxes + 1)
        >>> world.box_many(ids)
        array([[1., 2.],
               [6., 7.]])
        """
        array, rows = id_array(ids), self._rows(boxes, "boxes")
        _same_length(len(array), boxes=len(rows))
        self._world.set(array, rows, "boxes")

    def set_swept(self, id: SupportsIndex, start: ArrayLike, end: ArrayLike) -> None:
        """Moves a fast body from one box to another without passing through other bodies.

        Until the next update its box is the union of both, and from then on `end`. So it pairs with the bodies that
        it would have jumped over (and, on a diagonal path, with bodies beside the path).

        Args:
            id: the body.
            start: `2 * dimensions` numbers.
            end: `2 * dimensions` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: then nothing has changed.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall, bullet = world.insert([5, 6]), world.insert([0, 1])
        >>> world.set_swept(bullet, [0, 1], [10, 11])
        >>> len(world.update().begun)  # it went through the wall
        1
        """
        from_box, to_box = self._row(start, "start"), self._row(end, "end")
        self._world.set_swept(one_id(id), _double(from_box), _double(to_box), ("start", "end"))

    def set_swept_many(self, ids: ArrayLike, starts: Boxes, ends: Boxes) -> None:
        """Moves many fast bodies, each as `set_swept` does.

        Args:
            ids: `(n,)` ids.
            starts: `(n, 2 * dimensions)` numbers.
            ends: `(n, 2 * dimensions)` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: for the first id or box that is invalid; then nothing has changed.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 1], [5, 6]])
        >>> world.set_swept_many(ids[:1], [[0, 1]], [[10, 11]])
        >>> len(world.update().begun)
        1
        """
        array, first, last = id_array(ids), self._rows(starts, "starts"), self._rows(ends, "ends")
        _same_length(len(array), starts=len(first), ends=len(last))
        self._world.set_swept(array, _double(first), _double(last), ("starts", "ends"))

    def teleport(self, id: SupportsIndex, box: ArrayLike) -> None:
        """Gives a body a new box to which it did not move: it was respawned, or went through a portal.

        With `report="fat"` its fattened AABB does not reach ahead, and displacements count from here; otherwise the
        same as `set`.

        Args:
            id: the body.
            box: `2 * dimensions` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: then nothing has changed.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1, report="fat", margin=0.5, prediction=2)
        >>> hero = world.insert([0, 1])
        >>> changes = world.update()
        >>> world.teleport(hero, [3, 4])
        >>> world.reported_box(hero)
        array([2.5, 4.5])
        """
        self._world.teleport(one_id(id), _double(self._row(box, "box")), "box")

    def teleport_many(self, ids: ArrayLike, boxes: Boxes) -> None:
        """Gives many bodies new boxes, each as `teleport` does.

        Args:
            ids: `(n,)` ids.
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: for the first id or box that is invalid; then no box has changed.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 1], [5, 6]])
        >>> world.teleport_many(ids, [[2, 3], [3, 4]])
        >>> len(world.update().begun)
        1
        """
        array, rows = id_array(ids), self._rows(boxes, "boxes")
        _same_length(len(array), boxes=len(rows))
        self._world.teleport(array, _double(rows), "boxes")

    def shift(self, offset: ArrayLike) -> None:
        """Adds an offset to the boxes of all bodies: for worlds whose origin follows the player.

        The next update reports no event because of it, except where rounding makes boxes touch, and takes the time of
        finding all pairs.

        Args:
            offset: `dimensions` finite numbers.

        Raises:
            ValueError, TypeError: for another number of them, or anything but finite numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> hero = world.insert([8, 9])
        >>> world.shift([-8])
        >>> world.box(hero)
        array([0., 1.])
        """
        self._world.shift(row(offset, "offset", self._dtype, self._dimensions)[0].tolist())

    def remove(self, id: SupportsIndex) -> None:
        """Removes a body. Its id is stale from now on; the next update reports its ended pairs.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.remove(world.insert([0, 1]))
        >>> len(world)
        0
        """
        self._world.remove(one_id(id))

    def remove_many(self, ids: ArrayLike) -> None:
        """Removes many bodies.

        Args:
            ids: `(n,)` ids.

        Raises:
            StaleProxyError: for the first id that is stale or came before; then none was removed.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.remove_many(world.insert_many([[0, 1], [5, 6]]))
        >>> len(world)
        0
        """
        self._world.remove(id_array(ids))

    def clear(self) -> None:
        """Removes all bodies. Their ids are stale from now on; the next update reports that their pairs ended.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> changes = world.update()
        >>> world.clear()
        >>> len(world), len(world.update().ended)
        (0, 1)
        """
        self._world.remove(self._world.ids())

    def shrink_to_fit(self) -> None:
        """Gives back memory that is not needed now, and changes no result.

        Updates give back the memory of a crowd by themselves, at most 128 updates after it is gone. Takes O(n + pairs)
        time, and meanwhile as much memory again as the world needs.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> changes = world.update()
        >>> world.shrink_to_fit()
        >>> world.pairs()
        array([[0, 1]])
        """
        self._world.shrink_to_fit()

    def box(self, id: SupportsIndex) -> Floats:
        """Returns the box of a body as last set; for a swept body, until the next update, the union of both boxes.

        Args:
            id: the body.

        Returns:
            `(2 * dimensions,)` coordinates in the world's dtype.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.box(world.insert([0, 1]))
        array([0., 1.])
        """
        return self._boxes(one_id(id))

    def reported_box(self, id: SupportsIndex) -> Floats:
        """Returns the box of a body whose overlaps are reported: with `report="fat"` its fattened AABB.

        Args:
            id: the body.

        Returns:
            `(2 * dimensions,)` coordinates in the world's dtype.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1, report="fat", margin=0.5)
        >>> world.reported_box(world.insert([0, 1]))
        array([-0.5,  1.5])
        """
        return self._boxes(one_id(id), reported=True)

    def box_many(self, ids: ArrayLike) -> Floats:
        """Returns the boxes of many bodies as last set.

        Args:
            ids: `(n,)` ids.

        Returns:
            `(n, 2 * dimensions)` coordinates in the world's dtype.

        Raises:
            StaleProxyError: for the first id that is stale.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.box_many(world.insert_many([[0, 1], [5, 6]]))
        array([[0., 1.],
               [5., 6.]])
        """
        return self._boxes(id_array(ids)).reshape(-1, 2 * self._dimensions)

    def filter(self, id: SupportsIndex) -> Filter:
        """Returns the filter of a body.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.filter(world.insert([0, 1]))
        Filter(category=1, mask=4294967295, group=0, is_static=False)
        """
        return Filter(*self._world.filters(one_id(id))[0])

    def filter_many(self, ids: ArrayLike) -> list[Filter]:
        """Returns the filters of many bodies.

        Args:
            ids: `(n,)` ids.

        Raises:
            StaleProxyError: for the first id that is stale.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> [filter.group for filter in world.filter_many(world.insert_many([[0, 1], [2, 3]]))]
        [0, 0]
        """
        return [Filter(*one) for one in self._world.filters(id_array(ids))]

    def set_filter(self, id: SupportsIndex, filter: Filter) -> None:
        """Changes which bodies a body may pair with; the next update reports the pairs that begin or end.

        Args:
            id: the body.
            filter: its new filter.

        Raises:
            StaleProxyError: if the id names no body of this world.
            ValueError, TypeError: for anything but a filter.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> len(world.update().begun)
        1
        >>> world.set_filter(a, sap.Filter(mask=0))
        >>> len(world.update().ended)
        1
        """
        self._world.set_filter(one_id(id), words(filter))

    def set_filter_many(self, ids: ArrayLike, filter: Filter) -> None:
        """Changes the filter of many bodies.

        Args:
            ids: `(n,)` ids.
            filter: their new filter.

        Raises:
            StaleProxyError: for the first id that is stale; then no filter has changed.
            ValueError, TypeError: for anything but a filter.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> world.set_filter_many(ids, sap.Filter(group=-1))
        >>> len(world.update().begun)
        0
        """
        self._world.set_filter(id_array(ids), words(filter))

    def set_enabled(self, id: SupportsIndex, enabled: bool) -> None:
        """Disables a body, or enables it again.

        While it is disabled it pairs with no other, and queries do not find it; its box and its filter can be set. Its
        pairs end or begin at the next update.

        Args:
            id: the body.
            enabled: whether it is enabled from now on.

        Raises:
            StaleProxyError: if the id names no body of this world.
            TypeError: if `enabled` is not a bool.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> len(world.update().begun)
        1
        >>> world.set_enabled(a, False)
        >>> len(world.update().ended)
        1
        """
        self._world.set_enabled(one_id(id), truth(enabled, "enabled"))

    def set_enabled_many(self, ids: ArrayLike, enabled: bool) -> None:
        """Disables many bodies, or enables them again.

        Args:
            ids: `(n,)` ids.
            enabled: whether they are enabled from now on.

        Raises:
            StaleProxyError: for the first id that is stale; then nothing has changed.
            TypeError: if `enabled` is not a bool.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> world.set_enabled_many(ids, False)
        >>> len(world.update().begun)
        0
        """
        self._world.set_enabled(id_array(ids), truth(enabled, "enabled"))

    def is_enabled(self, id: SupportsIndex) -> bool:
        """Returns whether a body is enabled, as it is until `set_enabled` says otherwise.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.is_enabled(world.insert([0, 2]))
        True
        """
        return self._world.are_enabled(one_id(id))[0]

    def exclude_pair(self, first: SupportsIndex, second: SupportsIndex) -> None:
        """Excludes a pair, whatever the filters of its bodies allow: those of a joint, say.

        It ends at the next update if it was there, and does not begin until it is included again. A body that is
        removed is forgotten, and a pair of a body with itself is never there.

        Args:
            first: a body.
            second: another.

        Raises:
            StaleProxyError: if an id names no body of this world; its index is 0 for `first` and 1 for `second`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> world.exclude_pair(a, b)
        >>> len(world.update().begun)
        0
        """
        self._world.set_excluded(two_ids(first, second), True)

    def include_pair(self, first: SupportsIndex, second: SupportsIndex) -> None:
        """Includes a pair that was excluded.

        Args:
            first: a body.
            second: another.

        Raises:
            StaleProxyError: as `exclude_pair`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> world.exclude_pair(a, b)
        >>> world.include_pair(a, b)
        >>> len(world.update().begun)
        1
        """
        self._world.set_excluded(two_ids(first, second), False)

    def is_excluded(self, first: SupportsIndex, second: SupportsIndex) -> bool:
        """Returns whether a pair is excluded.

        Args:
            first: a body.
            second: another.

        Raises:
            StaleProxyError: as `exclude_pair`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.is_excluded(world.insert([0, 2]), world.insert([1, 3]))
        False
        """
        return self._world.is_excluded(two_ids(first, second))

    def update(self) -> Changes:
        """Reports the pairs that began and ended since the last update.

        In each pair the smaller slot is first; the pairs are sorted by slot. A pair that began and ended between two
        updates is not reported. The time depends on the number of bodies that changed and on their neighbors. If most
        bodies move far, it can exceed the time of finding all pairs (see the benchmark).

        Raises:
            MemoryError: if the pairs of a crowd do not fit into memory. The world and its bodies are as before. Once
                the crowd is apart, removed or filtered, the next call reports what changed.

        If Ctrl-C came meanwhile, or there was no memory for the arrays, the next call reports what changed since the
        last one that returned. (A copy or a snapshot made between has lost what was found.)

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> begun, ended = world.update()
        >>> begun.shape, ended.shape
        ((1, 2), (0, 2))
        """
        return Changes(*self._world.update())

    def pairs(self) -> Ids:
        """Returns the pairs that overlapped at the last update, `(m, 2)` ids sorted by slot. O(pairs) time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> changes = world.update()
        >>> world.pairs()
        array([[0, 1]])
        """
        return self._world.pairs()

    def pairs_of(self, id: SupportsIndex) -> Ids:
        """Returns the bodies that overlapped this one at the last update, `(m,)` ids sorted by slot.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if the id names no body of this world.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> changes = world.update()
        >>> world.pairs_of(a).tolist() == [b]
        True
        """
        return self._world.pairs_of(int(one_id(id)[0]))

    def pairs_by_body(self) -> Lists:
        """Returns the pairs of `pairs` by body: for each slot (`slots_of`), the bodies that pair with the body there.

        Takes the time of sorting the pairs, where `pairs_of` for each body takes much more.

        Returns:
            a list of ids for each slot, sorted by slot. The pairs are those of the last update, so a body that was
            removed since then still has its list. Other slots without a body have empty lists.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3], [2, 4]])
        >>> changes = world.update()
        >>> [others.tolist() for others in world.pairs_by_body().each()]
        [[1, 2], [0, 2], [0, 1]]
        """
        pairs = self.pairs()
        both = np.concatenate([pairs, pairs[:, ::-1]])
        slots = slots_of(both)
        counts = np.bincount(slots[:, 0], minlength=slots_of(self.ids()).max(initial=-1) + 1)
        return Lists(both[np.lexsort((slots[:, 1], slots[:, 0])), 1], np.cumsum(counts))

    def overlapping(
        self, box: ArrayLike, filter: Filter | None = None, *, sorted: bool = True, exclude: ArrayLike | None = None
    ) -> Ids:
        """Finds the bodies whose boxes overlap a box.

        All queries see the boxes as last set, whether updated or not. The first query after a change takes longer.

        Args:
            box: `2 * dimensions` numbers.
            filter: finds only bodies with which a body with this filter may pair; by default, all bodies.
            sorted: False for ids in no particular order: sorting takes a quarter of the time for 100, half for 10,000.
            exclude: an id, or ids, that it does not find: what asks, and what it carries. Each body that is found is
                compared with all of them, so keep the list short. Ids of bodies that are gone do no harm.

        Returns:
            `(m,)` ids, sorted by slot unless `sorted` is False.

        Raises:
            InvalidBoxError: if the box is inverted or has a NaN.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([5, 6])
        >>> world.overlapping([1, 3]) == [a]
        array([ True])
        """
        return self._ask("overlapping", filter, Part("box", self._row(box, "box")), sorted=sorted, exclude=exclude).ids

    def overlapping_many(
        self, boxes: Boxes, filter: Filter | None = None, *, sorted: bool = True, exclude: ArrayLike | None = None
    ) -> Lists:
        """Finds the bodies that overlap each of many boxes.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            filter: as in `overlapping`.
            sorted: as in `overlapping`.
            exclude: as in `overlapping`.

        Raises:
            InvalidBoxError: for the first box that is inverted or has a NaN.
            ValueError, TypeError: for another shape, or anything but numbers.
            MemoryError: if the answers do not fit into memory: ask fewer at a time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.overlapping_many([[1, 3], [3, 4], [0, 9]]).ends
        array([1, 1, 3])
        """
        found = self._ask(
            "overlapping", filter, Part("boxes", self._rows(boxes, "boxes")), sorted=sorted, exclude=exclude
        )
        return Lists(found.ids, found.ends)

    def containing(
        self, point: ArrayLike, filter: Filter | None = None, *, sorted: bool = True, exclude: ArrayLike | None = None
    ) -> Ids:
        """Finds the bodies whose boxes contain a point.

        Args:
            point: `dimensions` numbers.
            filter: as in `overlapping`.
            sorted: as in `overlapping`.
            exclude: as in `overlapping`.

        Returns:
            `(m,)` ids, sorted by slot.

        Raises:
            InvalidQueryError: for a NaN.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> a = world.insert([0, 0, 2, 2])
        >>> world.containing([2, 1]) == [a]
        array([ True])
        """
        return self._ask(
            "containing", filter, Part("point", self._point(point, "point"), "not NaN"), sorted=sorted, exclude=exclude
        ).ids

    def containing_many(
        self, points: Points, filter: Filter | None = None, *, sorted: bool = True, exclude: ArrayLike | None = None
    ) -> Lists:
        """Finds the bodies whose boxes contain each of many points.

        Args:
            points: `(n, dimensions)` numbers, or a table with columns `x`, `y` and `z`.
            filter: as in `overlapping`.
            sorted: as in `overlapping`.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first point with a NaN.
            ValueError, TypeError: for another shape, or anything but numbers.
            MemoryError: if the answers do not fit into memory: ask fewer at a time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 6]])
        >>> world.containing_many([[0], [1]]).ends
        array([1, 3])
        """
        found = self._ask(
            "containing",
            filter,
            Part("points", self._points(points, "points"), "not NaN"),
            sorted=sorted,
            exclude=exclude,
        )
        return Lists(found.ids, found.ends)

    def within(
        self,
        center: ArrayLike,
        radius: float,
        filter: Filter | None = None,
        *,
        sorted: bool = True,
        exclude: ArrayLike | None = None,
    ) -> Ids:
        """Finds the bodies whose boxes are at most `radius` away from a point.

        Args:
            center: `dimensions` numbers, finite.
            radius: not negative; may be infinite.
            filter: as in `overlapping`.
            sorted: as in `overlapping`.
            exclude: as in `overlapping`.

        Returns:
            `(m,)` ids, sorted by slot.

        Raises:
            InvalidQueryError: if the center is not finite, or the radius negative or NaN.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> a = world.insert([3, 4, 9, 9])
        >>> len(world.within([0, 0], 5)), len(world.within([0, 0], 4.9))
        (1, 0)
        """
        point, length = Part("center", self._point(center, "center"), "finite"), self._number(radius, "radius")
        return self._ask("within", filter, point, length, sorted=sorted, exclude=exclude).ids

    def within_many(
        self,
        centers: Points,
        radii: ArrayLike,
        filter: Filter | None = None,
        *,
        sorted: bool = True,
        exclude: ArrayLike | None = None,
    ) -> Lists:
        """Finds the bodies near each of many points.

        Args:
            centers: `(n, dimensions)` numbers, or a table with columns `x`, `y` and `z`.
            radii: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.
            sorted: as in `overlapping`.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first that is invalid, as for a single one.
            ValueError, TypeError: for other shapes, or anything but numbers.
            MemoryError: if the answers do not fit into memory: ask fewer at a time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.within_many([[3], [4]], 1).ends
        array([1, 2])
        """
        points = self._points(centers, "centers")
        lengths = Part("radii", each(radii, "radii", self._dtype, len(points))[:, None], "0 or more")
        found = self._ask("within", filter, Part("centers", points, "finite"), lengths, sorted=sorted, exclude=exclude)
        return Lists(found.ids, found.ends)

    def nearest(
        self,
        point: ArrayLike,
        k: int = 1,
        filter: Filter | None = None,
        *,
        max_distance: float = np.inf,
        exclude: ArrayLike | None = None,
    ) -> Neighbors:
        """Finds the `k` bodies nearest to a point, or all if there are fewer, sorted by distance and then by slot.

        Distances are compared as squares in `float64`: beyond 1e154 they are infinite, and below 1e-162 they are 0.

        Args:
            point: `dimensions` numbers, finite.
            k: how many; 0 or more.
            filter: as in `overlapping`.
            max_distance: bodies farther away are not found, nor searched: a small one saves time.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError: if the point is not finite, or the distance negative or NaN.
            ValueError, TypeError: for another shape, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.nearest([3]).distances
        array([1.])
        >>> world.nearest([3], k=9, max_distance=1.5).ids.tolist() == [ids[0]]
        True
        """
        found = self._nearest("point", self._point(point, "point"), k, filter, max_distance, exclude)
        return Neighbors(found.ids[0], found.distances[0])

    def nearest_many(
        self,
        points: Points,
        k: int = 1,
        filter: Filter | None = None,
        *,
        max_distance: float = np.inf,
        exclude: ArrayLike | None = None,
    ) -> Neighbors:
        """Finds the `k` bodies nearest to each of many points.

        Distances are compared as squares in `float64`: beyond 1e154 they are infinite, and below 1e-162 they are 0.

        Args:
            points: `(n, dimensions)` numbers, or a table with columns `x`, `y` and `z`.
            k: how many; 0 or more.
            filter: as in `overlapping`.
            max_distance: as in `nearest`.
            exclude: as in `overlapping`.

        Returns:
            `(n, k)` ids and distances, or fewer columns if no point has `k`. Points that have fewer than others
            have the id -1 and an infinite distance for those that they lack.

        Raises:
            InvalidQueryError: for the first point that is not finite, or if the distance is negative or NaN.
            ValueError, TypeError: for another shape, or anything but numbers.
            MemoryError: if the answers do not fit into memory: ask fewer at a time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.nearest_many([[3], [9]], k=2).distances
        array([[1., 2.],
               [3., 7.]])
        """
        return self._nearest("points", self._points(points, "points"), k, filter, max_distance, exclude)

    def ray_cast(
        self,
        origin: ArrayLike,
        direction: ArrayLike,
        limit: float = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hit | None:
        """Finds the first body that a ray hits; if it hits several at once, the one with the smallest slot.

        Args:
            origin: `dimensions` numbers, finite.
            direction: `dimensions` numbers, finite, of any length.
            limit: the largest t, in lengths of `direction`: 0 or more, may be infinite.
            filter: as in `overlapping`.
            ignore_touching: as in `box_cast`.
            exclude: as in `overlapping`.

        Returns:
            The hit, at `origin + t * direction`, or `None`.

        Raises:
            InvalidQueryError: if the origin or the direction is not finite, or the limit is negative or NaN.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> wall = world.insert([5, 0, 6, 9])
        >>> world.ray_cast([1, 1], [2, 0]).t
        2.0
        """
        return _first(self._cast(self._ray(origin), direction, limit, filter, False, ignore_touching, exclude))

    def ray_cast_all(
        self,
        origin: ArrayLike,
        direction: ArrayLike,
        limit: float = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """Finds all bodies that a ray hits, sorted by t and then by slot.

        Args:
            origin: `dimensions` numbers, finite.
            direction: `dimensions` numbers, finite.
            limit: the largest t, in lengths of `direction`.
            filter: as in `overlapping`.
            ignore_touching: as in `box_cast`.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `ray_cast`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[5, 6], [2, 3]])
        >>> world.ray_cast_all([0], [1]).t
        array([2., 5.])
        """
        return self._cast(self._ray(origin), direction, limit, filter, True, ignore_touching, exclude)

    def ray_cast_many(
        self,
        origins: Points,
        directions: Points,
        limits: ArrayLike = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """Finds the first hit of each of many rays.

        Args:
            origins: `(n, dimensions)` numbers, or a table with columns `x`, `y` and `z`.
            directions: `(n, dimensions)` numbers, or such a table.
            limits: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.
            ignore_touching: as in `box_cast`.
            exclude: as in `overlapping`.

        Returns:
            `(n,)` ids and t; id -1 and an infinite t for a ray that hits nothing.

        Raises:
            InvalidQueryError: for the first that is invalid, as for a single one.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.ray_cast_many([[0], [0]], [[1], [-1]]).t
        array([ 5., inf])
        """
        points = self._points(origins, "origins")
        starts = Part("origins", np.concatenate([points, points], axis=1), "finite")
        return self._cast_many(starts, directions, limits, filter, ignore_touching, exclude)

    def box_cast(
        self,
        box: ArrayLike,
        direction: ArrayLike,
        limit: float = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hit | None:
        """Finds the first body that a moving box hits.

        Args:
            box: `2 * dimensions` numbers, finite: the box at its start.
            direction: `dimensions` numbers, finite.
            limit: the largest t, in lengths of `direction`.
            filter: as in `overlapping`.
            ignore_touching: whether it passes what it only touches: the floor that a character stands on, the wall
                along which it slides. It hits what it enters.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `ray_cast`, also if the box is inverted.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.box_cast([0, 1], [1])
        Hit(id=0, t=4.0, normal=(-1.0,), starts_inside=False)
        >>> world.box_cast([4, 5], [1]).t, world.box_cast([4, 5], [-1], ignore_touching=True)
        (0.0, None)
        """
        return _first(
            self._cast(
                Part("box", self._row(box, "box"), "finite"), direction, limit, filter, False, ignore_touching, exclude
            )
        )

    def box_cast_all(
        self,
        box: ArrayLike,
        direction: ArrayLike,
        limit: float = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """Finds all bodies that a moving box hits, sorted by t and then by slot.

        Args:
            box: `2 * dimensions` numbers, finite.
            direction: `dimensions` numbers, finite.
            limit: the largest t, in lengths of `direction`.
            filter: as in `overlapping`.
            ignore_touching: as in `box_cast`.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `box_cast`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[5, 6], [2, 3]])
        >>> world.box_cast_all([0, 1], [1], limit=3).t
        array([1.])
        """
        return self._cast(
            Part("box", self._row(box, "box"), "finite"), direction, limit, filter, True, ignore_touching, exclude
        )

    def box_cast_many(
        self,
        boxes: Boxes,
        directions: Points,
        limits: ArrayLike = np.inf,
        filter: Filter | None = None,
        *,
        ignore_touching: bool = False,
        exclude: ArrayLike | None = None,
    ) -> Hits:
        """Finds the first hit of each of many moving boxes.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            directions: `(n, dimensions)` numbers, or a table with columns `x`, `y` and `z`.
            limits: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.
            ignore_touching: as in `box_cast`.
            exclude: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first that is invalid, as for a single one.
            ValueError, TypeError: for other shapes, or anything but numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.box_cast_many([[0, 1], [9, 10]], [[1], [-2]]).t
        array([4. , 1.5])
        """
        return self._cast_many(
            Part("boxes", self._rows(boxes, "boxes"), "finite"), directions, limits, filter, ignore_touching, exclude
        )

    def snapshot(self) -> bytes:
        """Returns the whole state as bytes, for rollback, replay and saved games.

        Equal states give equal bytes. O(n) time; about as many bytes as the boxes take, and two for each resting
        body.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.snapshot() == sap.BroadPhase(dimensions=1).snapshot()
        True
        """
        return self._world.snapshot()

    def state_hash(self) -> int:
        """Returns a 64-bit hash of the whole state, the same for equal states on every machine. O(n) time.

        Use it to detect that two machines which should run the same simulation differ. It does not protect against
        forgery.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.state_hash() == sap.BroadPhase(dimensions=1).state_hash()
        True
        """
        return self._world.state_hash()

    def __getstate__(self) -> dict[str, Any]:
        """The attributes, those of subclasses included, and a snapshot in place of the compiled part."""
        own = ("_world", "_dimensions", "_dtype")
        return {"snapshot": self.snapshot(), "attributes": attributes(self, own)}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Restores a copy."""
        self._restore(state["snapshot"])
        set_attributes(self, state["attributes"])

    def __repr__(self) -> str:
        """Shows the number of bodies and the arguments with which the world was created."""
        return f"<BroadPhase of {len(self)} bodies, dimensions={self._dimensions}, dtype={self._dtype}>"

    def _row(self, box: ArrayLike, name: str) -> Floats:
        if is_named(box):
            named: Any = [box]
            return box_rows(named, name, self._dtype, self._dimensions)
        return row(box, name, self._dtype, 2 * self._dimensions)

    def _rows(self, boxes: Boxes, name: str) -> Floats:
        return box_rows(boxes, name, self._dtype, self._dimensions)

    def _point(self, point: ArrayLike, name: str) -> Floats:
        return row(point, name, self._dtype, self._dimensions)

    def _points(self, points: Points, name: str) -> Floats:
        return rows(points, name, self._dtype, self._dimensions)

    def _number(self, value: object, name: str) -> Part:
        with np.errstate(all="ignore"):
            return Part(name, np.array([[real(value, name)]]).astype(self._dtype), "0 or more")

    def _ray(self, origin: ArrayLike) -> Part:
        point = self._point(origin, "origin")
        return Part("origin", np.concatenate([point, point], axis=1), "finite")

    def _boxes(self, ids: Ids, reported: bool = False) -> Floats:
        return self._world.boxes(ids, reported).astype(self._dtype, copy=False)

    def _ask(
        self,
        kind: str,
        filter: Filter | None,
        *parts: Part,
        k: int = 0,
        max_distance: float = 0.0,
        sorted: bool = True,
        exclude: ArrayLike | None = None,
    ) -> Found:
        """Answers queries whose numbers are in the rows of the parts, side by side."""
        rows = parts[0].rows if len(parts) == 1 else np.concatenate([part.rows for part in parts], axis=1)
        sorted = truth(sorted, "sorted")
        checked, excluded = None if filter is None else words(filter), _excluded(exclude)
        try:
            found = self._world.query(
                kind, _double(rows), checked, excluded, parts[0].name, k, max_distance, bool(sorted)
            )
            return Found(*found)
        except InvalidQueryError as error:
            raise _explained(error.index, parts) from None

    def _nearest(
        self, name: str, points: Floats, k: int, filter: Filter | None, max_distance: float, exclude: ArrayLike | None
    ) -> Neighbors:
        count, far = min(whole(k, "k", 0, 2**63 - 1), len(self)), real(max_distance, "max_distance")
        if not far >= 0:
            raise InvalidQueryError(0, "max_distance", far, "0 or more")
        with np.errstate(all="ignore"):
            far = float(self._dtype.type(far))
        part = Part(name, points, "finite")
        ids, squares, _, ends = self._ask("nearest", filter, part, k=count, max_distance=far, exclude=exclude)
        distances = np.sqrt(squares)
        near = distances <= far  # the search compares squares, and finds a little more
        counts = np.bincount(np.repeat(np.arange(len(ends)), np.diff(ends, prepend=0))[near], minlength=len(ends))
        # Which places of the result have a neighbor: in each row the first.
        has = np.arange(counts.max(initial=0)) < counts[:, None]
        found = Neighbors(np.full(has.shape, -1, np.int64), np.full(has.shape, np.inf))
        found.ids[has], found.distances[has] = ids[near], distances[near]
        return found

    def _cast(
        self,
        start: Part,
        direction: ArrayLike,
        limit: float,
        filter: Filter | None,
        all: bool,
        ignore_touching: bool,
        exclude: ArrayLike | None,
    ) -> Hits:
        way = Part("direction", self._point(direction, "direction"), "finite")
        kind = _cast_kind(all, ignore_touching)
        ids, t, faces, _ = self._ask(kind, filter, start, way, self._number(limit, "limit"), exclude=exclude)
        return Hits(ids, t, _normals(faces, self._dimensions), faces == 0)

    def _cast_many(
        self,
        starts: Part,
        directions: Points,
        limits: ArrayLike,
        filter: Filter | None,
        ignore_touching: bool,
        exclude: ArrayLike | None,
    ) -> Hits:
        ways, count = self._points(directions, "directions"), len(starts.rows)
        if len(ways) != count:
            raise ValueError(
                f"{starts.name} and directions must have the same length: they have {count} and {len(ways)} rows"
            )
        far = Part("limits", each(limits, "limits", self._dtype, count)[:, None], "0 or more")
        way, kind = Part("directions", ways, "finite"), _cast_kind(False, ignore_touching)
        found = self._ask(kind, filter, starts, way, far, exclude=exclude)
        hits = np.diff(found.ends, prepend=0) > 0
        ids, t, faces = np.full(count, -1, np.int64), np.full(count, np.inf), np.zeros(count, np.int64)
        ids[hits], t[hits], faces[hits] = found.ids, found.values, found.faces
        return Hits(ids, t, _normals(faces, self._dimensions), hits & (faces == 0))


class Part(NamedTuple):
    """An argument of a query: a row for each query, and the rule that the core has for its numbers."""

    name: str
    rows: Floats
    rule: str = "valid"


def _double(rows: Floats) -> NDArray[np.float64]:
    return rows.astype(np.float64, copy=False)


def _same_length(ids: int, **others: int) -> None:
    for name, count in others.items():
        if count != ids:
            raise ValueError(f"there are {ids} ids but {count} {name}: pass one for each id")


def _explained(index: int, parts: tuple[Part, ...]) -> InvalidQueryError:
    """The error for an invalid query, with the argument that is at fault."""
    for name, numbers, rule in parts:
        values = numbers[index]
        broken = {
            "finite": ~np.isfinite(values),
            "not NaN": np.isnan(values),
            "0 or more": ~(values >= 0),
        }.get(rule, np.zeros(len(values), bool))
        if broken.any():
            shown = values.tolist() if len(values) > 1 else float(values[0])
            if name.startswith("origin"):
                shown = values[: len(values) // 2].tolist()
            return InvalidQueryError(index, name, shown, rule)
    return InvalidQueryError(index, parts[0].name, parts[0].rows[index].tolist(), "min <= max on every axis")


def _given(filter: Filter | None) -> tuple[int, int, int, bool]:
    """The filter of a new body."""
    return words(Filter() if filter is None else filter)


def _excluded(exclude: ArrayLike | None) -> Ids:
    """The ids that a query does not find."""
    if exclude is None:
        return np.empty(0, np.int64)
    return (
        one_id(exclude, or_none=True)
        if isinstance(exclude, SupportsIndex) and np.ndim(exclude) == 0
        else id_array(exclude, "exclude", or_none=True)
    )


def _cast_kind(all: bool, ignore_touching: bool) -> str:
    """The name of the query."""
    return ("cast_all" if all else "cast") + ("_entering" if truth(ignore_touching, "ignore_touching") else "")


def _normals(faces: NDArray[np.int64], dimensions: int) -> NDArray[np.float64]:
    """The normals of faces: 1 and 2 are those at the min and the max of the first axis, and so on; 0 is none."""
    normals = np.zeros((len(faces), dimensions))
    hits = np.flatnonzero(faces)
    axes, at_max = np.divmod(faces[hits] - 1, 2)
    normals[hits, axes] = np.where(at_max, 1.0, -1.0)
    return normals


def _first(hits: Hits) -> Hit | None:
    if not len(hits.ids):
        return None
    normal = tuple(hits.normals[0].tolist())
    return Hit(int(hits.ids[0]), float(hits.t[0]), normal, bool(hits.starts_inside[0]))
