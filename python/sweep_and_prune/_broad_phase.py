"""The living world: bodies that are inserted, moved and removed, and what begins and ends."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple, SupportsIndex

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from ._arrays import Floats, Ids, box_rows, each, float_dtype, id_array, one_id, real, row, rows, whole
from ._errors import StaleProxyError
from ._filter import ALL, Filter, words
from ._native import World


class Changes(NamedTuple):
    """What an update found; see `BroadPhase.update`."""

    begun: Ids
    """`(m, 2)` ids: the pairs that overlap now and did not at the last update."""
    ended: Ids
    """`(m, 2)` ids: the pairs that overlapped at the last update and do not now; some may be stale."""


class Hit(NamedTuple):
    """A body that a ray or a moving box hits."""

    id: int
    """The body."""
    at: float
    """How many directions from the start; 0 if they overlap there."""


class Hits(NamedTuple):
    """The hits of a cast, nearest first; or the first hit of each of many casts."""

    ids: Ids
    """`(n,)` ids; of many casts 0 for one that hits nothing, which is no body's id."""
    at: NDArray[np.float64]
    """`(n,)`: how many directions from the start; infinite for a cast that hits nothing."""


class Neighbours(NamedTuple):
    """The bodies nearest to a point, nearest first; or to each of many points."""

    ids: Ids
    """`(k,)` ids; of many points `(n, k)`."""
    distances: NDArray[np.float64]
    """As many: from the point to each body's box; 0 if the point is in it."""


class Lists(NamedTuple):
    """The bodies found by each of many queries.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> ids = world.insert_many([[0, 2], [1, 3]])
    >>> found = world.containing_many([[0.5], [1.5], [9]])
    >>> [list(sap.slots_of(of_query)) for of_query in found.each()]
    [[np.uint32(0)], [np.uint32(0), np.uint32(1)], []]
    >>> found.queries()  # which query found each of found.ids
    array([0, 1, 1])
    """

    ids: Ids
    """`(m,)` ids, query by query, those of each sorted."""
    ends: NDArray[np.int64]
    """`(n,)`: where those of each query end in `ids`; they begin where those before end."""

    def each(self) -> Iterator[Ids]:
        """The ids of each query in turn."""
        return iter(np.split(self.ids, self.ends[:-1]) if len(self.ends) else [])

    def queries(self) -> NDArray[np.int64]:
        """`(m,)`: the position of the query that found each of `ids`."""
        counts = np.diff(self.ends, prepend=0)
        return np.repeat(np.arange(len(self.ends)), counts)


def slots_of(ids: ArrayLike) -> NDArray[np.uint32]:
    """The slots of bodies: small whole numbers, indices into tables of your own.

    A slot is less than the greatest number of bodies there ever were at once (those counted in that were removed
    since the last update). It is used again after its body was removed; an id is not.

    Args:
        ids: ids of any shape.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> sap.slots_of(world.insert_many([[0, 2], [1, 3]]))
    array([0, 1], dtype=uint32)
    """
    array = np.asarray(ids)
    if array.dtype.kind not in "iu" and array.size:
        raise TypeError(f"ids must be whole numbers, not of dtype {array.dtype}")
    return (array.astype(np.uint64) & np.uint64(0xFFFF_FFFF)).astype(np.uint32)


class BroadPhase:
    """A world of boxes that tells which overlaps began and which ended.

    Bodies are inserted, set and removed as often as one likes; `update` then reports the pairs that began and those
    that ended since the last update. Touching boxes overlap; which bodies may pair at all is their `Filter`'s to
    say. What a body that rests costs is its memory.

    An id is a whole number, slot and generation in one (`uint64` in arrays), never 0, and never comes to mean
    another body: an id of a body that was removed is refused.

    Same calls, same results, on every machine. A refused call changes nothing. One call at a time: a second thread
    that calls meanwhile gets a `RuntimeError`. A world can be copied and pickled.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=2)
    >>> hero = world.insert([0, 0, 1, 2])
    >>> door = world.insert([3, 0, 4, 2])
    >>> len(world.update().begun)
    0
    >>> world.set(hero, [2.5, 0, 3.5, 2])
    >>> for a, b in world.update().begun:
    ...     print(a == hero, b == door)
    True True
    >>> world.remove(door)
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
        """An empty world.

        Args:
            dimensions: 1, 2 or 3.
            dtype: `float32` or `float64`, in which coordinates are kept and compared. All that is passed is
                converted to it, which rounds `float64` to `float32`.
            margin: with `report="fat"`, what a fat box has around the body's own, in units of length.
            prediction: with `report="fat"`, how many displacements a fat box reaches ahead.
            report: `"exact"`: the pairs of the boxes as given; margin and prediction change nothing then, and are
                not needed for speed. `"fat"`: those of the fat boxes, which begin and end less often.

        Raises:
            ValueError, TypeError: for other dimensions, types or reports, or a margin or prediction that is
                negative, infinite or NaN.
        """
        self._dimensions = whole(dimensions, "dimensions", 1, 3)
        self._dtype = float_dtype(dtype)
        if not (isinstance(report, str) and report in ("exact", "fat")):
            raise ValueError(f'report must be "exact" or "fat", not {report!r}')
        margin, prediction = real(margin, "margin"), real(prediction, "prediction")
        self._world = World(self._dimensions, self._dtype.itemsize == 8, margin, prediction, report == "fat")

    @classmethod
    def from_snapshot(cls, snapshot: bytes | bytearray | memoryview) -> BroadPhase:
        """The world of a `snapshot`: for the same calls it gives the same ids, events and results.

        Dimensions, type, margins and what is reported are in the bytes. Takes the time of finding all pairs.

        Args:
            snapshot: the bytes.

        Raises:
            SnapshotError: for bytes that are truncated, changed, of another version, or no snapshot at all.
            TypeError: for what is not bytes.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> saved = world.snapshot()
        >>> len(sap.BroadPhase.from_snapshot(saved).update().begun)
        1
        """
        if not isinstance(snapshot, (bytes, bytearray, memoryview)):
            raise TypeError(f"a snapshot must be bytes, not a {type(snapshot).__name__}")
        native, dimensions, is_double = World.restore(bytes(snapshot))
        world = cls.__new__(cls)
        world._world, world._dimensions = native, dimensions
        world._dtype = np.dtype(np.float64 if is_double else np.float32)
        return world

    @property
    def dimensions(self) -> int:
        """How many dimensions the boxes have."""
        return self._dimensions

    @property
    def dtype(self) -> np.dtype[Any]:
        """In which precision coordinates are kept and compared."""
        return self._dtype

    def __len__(self) -> int:
        """How many bodies there are."""
        return len(self._world)

    def __contains__(self, id: object) -> bool:
        """Whether an id names a body that was inserted here and not removed."""
        try:
            return bool(self._world.contains(one_id(id))[0])
        except (StaleProxyError, TypeError):
            return False

    def contains_many(self, ids: ArrayLike) -> NDArray[np.bool_]:
        """Whether each of many ids names a body that was inserted here and not removed.

        Args:
            ids: `(n,)` ids.

        Returns:
            `(n,)` `bool`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> world.remove(ids[0])
        >>> world.contains_many(ids)
        array([False,  True])
        """
        return self._world.contains(id_array(ids))

    def ids(self) -> Ids:
        """`(n,)`: the ids of all bodies, sorted by slot. O(n) time."""
        return self._world.ids()

    def insert(self, box: ArrayLike, filter: Filter | None = None) -> int:
        """Adds a body and returns its id.

        Args:
            box: `2 * dimensions` numbers, the least corner and then the greatest.
            filter: which others it may pair with; `Filter()` by default.

        Raises:
            InvalidBoxError: if the box is inverted or NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> wall = world.insert([0, 0, 1, 9], sap.Filter(is_static=True))
        >>> wall in world
        True
        """
        return int(self._world.insert(self._row(box, "box"), words(filter))[0])

    def insert_many(self, boxes: ArrayLike, filter: Filter | None = None) -> Ids:
        """Adds bodies with one filter.

        Args:
            boxes: `(n, 2 * dimensions)` numbers, a row for each.
            filter: which others they may pair with; `Filter()` by default.

        Returns:
            `(n,)` `uint64`: their ids, in the order of their boxes.

        Raises:
            InvalidBoxError: for the first box that is inverted or NaN; then none was added.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import numpy as np
        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=3)
        >>> len(world.insert_many(np.zeros((1000, 6)))), len(world)
        (1000, 1000)
        """
        return self._world.insert(self._rows(boxes, "boxes"), words(filter))

    def set(self, id: SupportsIndex, box: ArrayLike) -> None:
        """Gives a body its new box.

        Args:
            id: the body.
            box: `2 * dimensions` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: then nothing has changed.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> hero = world.insert([0, 1])
        >>> world.set(hero, [5, 6])
        >>> world.box(hero)
        array([5., 6.])
        """
        self._world.set(one_id(id), self._row(box, "box"))

    def set_many(self, ids: ArrayLike, boxes: ArrayLike) -> None:
        """Gives each of many bodies its new box; of an id that comes twice the last box counts.

        Args:
            ids: `(n,)` ids.
            boxes: `(n, 2 * dimensions)` numbers.

        Raises:
            StaleProxyError, InvalidBoxError: for the first that is bad; then no box has changed.
            ValueError, TypeError: for other shapes, or what is not numbers.

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
        self._world.set(id_array(ids), self._rows(boxes, "boxes"))

    def set_swept(self, id: SupportsIndex, start: ArrayLike, end: ArrayLike) -> None:
        """Moves a fast body all the way from one box to another.

        Until the next update its box is the smallest that holds both, and from then on `end`. So it pairs with what
        it would have jumped over (and, on a diagonal way, with what lies beside it).

        Args:
            id: the body.
            start: `2 * dimensions` numbers.
            end: as many.

        Raises:
            StaleProxyError, InvalidBoxError: then nothing has changed.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall, bullet = world.insert([5, 6]), world.insert([0, 1])
        >>> world.set_swept(bullet, [0, 1], [10, 11])
        >>> len(world.update().begun)  # it went through the wall
        1
        """
        self._world.set_swept(one_id(id), self._row(start, "start"), self._row(end, "end"))

    def set_swept_many(self, ids: ArrayLike, starts: ArrayLike, ends: ArrayLike) -> None:
        """As `set_swept`, for many bodies.

        Args:
            ids: `(n,)` ids.
            starts: `(n, 2 * dimensions)` numbers.
            ends: as many.

        Raises:
            StaleProxyError, InvalidBoxError: for the first that is bad; then nothing has changed.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 1], [5, 6]])
        >>> world.set_swept_many(ids[:1], [[0, 1]], [[10, 11]])
        >>> len(world.update().begun)
        1
        """
        self._world.set_swept(id_array(ids), self._rows(starts, "starts"), self._rows(ends, "ends"))

    def remove(self, id: SupportsIndex) -> None:
        """Removes a body. Its id is stale from now on; the next update reports its ended pairs.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if it is not here.

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

    def box(self, id: SupportsIndex) -> Floats:
        """The box of a body as last given: for a swept one, until the next update, the whole way.

        Args:
            id: the body.

        Returns:
            `(2 * dimensions,)` coordinates of the world's type.

        Raises:
            StaleProxyError: if it is not here.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.box(world.insert([0, 1]))
        array([0., 1.])
        """
        return self._world.boxes(one_id(id))

    def box_many(self, ids: ArrayLike) -> Floats:
        """The boxes of many bodies as last given.

        Args:
            ids: `(n,)` ids.

        Returns:
            `(n, 2 * dimensions)` coordinates of the world's type.

        Raises:
            StaleProxyError: for the first id that is stale.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.box_many(world.insert_many([[0, 1], [5, 6]]))
        array([[0., 1.],
               [5., 6.]])
        """
        return self._world.boxes(id_array(ids)).reshape(-1, 2 * self._dimensions)

    def filter(self, id: SupportsIndex) -> Filter:
        """The filter of a body.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if it is not here.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.filter(world.insert([0, 1]))
        Filter(category=1, mask=4294967295, group=0, is_static=False)
        """
        return Filter(*self._world.filters(one_id(id))[0])

    def set_filter(self, id: SupportsIndex, filter: Filter) -> None:
        """Changes which others a body may pair with; pairs begin or end by it at the next update.

        Args:
            id: the body.
            filter: its new filter.

        Raises:
            StaleProxyError: if it is not here.
            ValueError, TypeError: for what is no filter.

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
        """Gives many bodies the same filter.

        Args:
            ids: `(n,)` ids.
            filter: their new filter.

        Raises:
            StaleProxyError: for the first id that is stale; then no filter has changed.
            ValueError, TypeError: for what is no filter.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> world.set_filter_many(ids, sap.Filter(group=-1))
        >>> len(world.update().begun)
        0
        """
        self._world.set_filter(id_array(ids), words(filter))

    def update(self) -> Changes:
        """The pairs that began and ended since the last update, each with its smaller id first, sorted by slot.

        A pair that began and ended between the two is in neither. Time in proportion to the bodies that changed and
        their neighbours, and not much more than finding all pairs takes.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> begun, ended = world.update()
        >>> begun.shape, ended.shape
        ((1, 2), (0, 2))
        """
        return Changes(*self._world.update())

    def pairs(self) -> Ids:
        """`(m, 2)` ids: the pairs that overlapped at the last update, sorted by slot. O(pairs) time.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 3]])
        >>> changes = world.update()
        >>> sap.slots_of(world.pairs())
        array([[0, 1]], dtype=uint32)
        """
        return self._world.pairs()

    def pairs_of(self, id: SupportsIndex) -> Ids:
        """`(m,)` ids: the bodies that overlapped this one at the last update, sorted by slot.

        Args:
            id: the body.

        Raises:
            StaleProxyError: if it is not here.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([1, 3])
        >>> changes = world.update()
        >>> world.pairs_of(a) == [b]
        array([ True])
        """
        return self._world.pairs_of(int(one_id(id)[0]))

    def overlapping(self, box: ArrayLike, filter: Filter | None = None) -> Ids:
        """The bodies whose boxes overlap a box.

        All queries see the boxes as last given, updated or not. The first one after bodies changed takes longer.

        Args:
            box: `2 * dimensions` numbers.
            filter: as if a body with this filter asked: what it may pair with. Without one all are found.

        Returns:
            `(m,)` ids, sorted by slot.

        Raises:
            InvalidBoxError: if the box is inverted or NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> a, b = world.insert([0, 2]), world.insert([5, 6])
        >>> world.overlapping([1, 3]) == [a]
        array([ True])
        """
        return self._world.overlapping(self._row(box, "box"), words(filter, ALL))[0]

    def overlapping_many(self, boxes: ArrayLike, filter: Filter | None = None) -> Lists:
        """As `overlapping`, for many boxes at once.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            filter: as in `overlapping`.

        Raises:
            InvalidBoxError: for the first box that is inverted or NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.overlapping_many([[1, 3], [3, 4], [0, 9]]).ends
        array([1, 1, 3])
        """
        return Lists(*self._world.overlapping(self._rows(boxes, "boxes"), words(filter, ALL)))

    def containing(self, point: ArrayLike, filter: Filter | None = None) -> Ids:
        """The bodies whose boxes hold a point.

        Args:
            point: `dimensions` numbers.
            filter: as in `overlapping`.

        Returns:
            `(m,)` ids, sorted by slot.

        Raises:
            InvalidQueryError: for a NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> a = world.insert([0, 0, 2, 2])
        >>> world.containing([2, 1]) == [a]
        array([ True])
        """
        return self._world.containing(self._point(point, "point"), words(filter, ALL))[0]

    def containing_many(self, points: ArrayLike, filter: Filter | None = None) -> Lists:
        """As `containing`, for many points at once.

        Args:
            points: `(n, dimensions)` numbers.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first point with a NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [1, 6]])
        >>> world.containing_many([[0], [1]]).ends
        array([1, 3])
        """
        return Lists(*self._world.containing(self._points(points, "points"), words(filter, ALL)))

    def within(self, centre: ArrayLike, radius: float, filter: Filter | None = None) -> Ids:
        """The bodies whose boxes are at most `radius` away from a point: those that a ball touches.

        Args:
            centre: `dimensions` numbers, finite.
            radius: not negative; may be infinite.
            filter: as in `overlapping`.

        Returns:
            `(m,)` ids, sorted by slot.

        Raises:
            InvalidQueryError: if the centre is not finite, or the radius negative or NaN.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> a = world.insert([3, 4, 9, 9])
        >>> len(world.within([0, 0], 5)), len(world.within([0, 0], 4.9))
        (1, 0)
        """
        radii = np.array([real(radius, "radius")], self._dtype)
        return self._world.within(self._point(centre, "centre"), radii, words(filter, ALL))[0]

    def within_many(self, centres: ArrayLike, radii: ArrayLike, filter: Filter | None = None) -> Lists:
        """As `within`, for many points at once.

        Args:
            centres: `(n, dimensions)` numbers.
            radii: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first that makes no sense.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.within_many([[3], [4]], 1).ends
        array([1, 2])
        """
        points = self._points(centres, "centres")
        each_radius = each(radii, "radii", self._dtype, len(points))
        return Lists(*self._world.within(points, each_radius, words(filter, ALL)))

    def nearest(self, point: ArrayLike, k: int = 1, filter: Filter | None = None) -> Neighbours:
        """The `k` bodies nearest to a point, or all if there are fewer, by distance and then by slot.

        Args:
            point: `dimensions` numbers, finite.
            k: not negative.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError: if the point is not finite.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.nearest([3]).distances
        array([1.])
        """
        return Neighbours(*(found[0] for found in self._nearest(self._point(point, "point"), k, filter)))

    def nearest_many(self, points: ArrayLike, k: int = 1, filter: Filter | None = None) -> Neighbours:
        """As `nearest`, for many points at once.

        Args:
            points: `(n, dimensions)` numbers.
            k: not negative.
            filter: as in `overlapping`.

        Returns:
            `(n, k)` ids and distances, or fewer columns if there are fewer bodies.

        Raises:
            InvalidQueryError: for the first point that is not finite.
            ValueError, TypeError: for another shape, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[0, 2], [5, 6]])
        >>> world.nearest_many([[3], [9]], k=2).distances
        array([[1., 2.],
               [3., 7.]])
        """
        return self._nearest(self._points(points, "points"), k, filter)

    def ray_cast(
        self, origin: ArrayLike, direction: ArrayLike, limit: float = np.inf, filter: Filter | None = None
    ) -> Hit | None:
        """The body that a ray hits first, `limit` directions far at most; of several at once the least slot.

        Args:
            origin: `dimensions` numbers, finite.
            direction: as many, finite, of any length.
            limit: how many directions far; not negative, may be infinite.
            filter: as in `overlapping`.

        Returns:
            The hit, or `None`.

        Raises:
            InvalidQueryError: if a part is NaN, infinite or negative where it must not be.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=2)
        >>> wall = world.insert([5, 0, 6, 9])
        >>> world.ray_cast([1, 1], [2, 0]).at
        2.0
        """
        return _first(self._cast(self._ray(origin), direction, limit, filter, False))

    def ray_cast_all(
        self, origin: ArrayLike, direction: ArrayLike, limit: float = np.inf, filter: Filter | None = None
    ) -> Hits:
        """All that a ray hits, nearest first and then by slot. Otherwise as `ray_cast`.

        Args:
            origin: `dimensions` numbers, finite.
            direction: as many, finite.
            limit: how many directions far.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `ray_cast`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[5, 6], [2, 3]])
        >>> world.ray_cast_all([0], [1]).at
        array([2., 5.])
        """
        return self._cast(self._ray(origin), direction, limit, filter, True)

    def ray_cast_many(
        self, origins: ArrayLike, directions: ArrayLike, limits: ArrayLike = np.inf, filter: Filter | None = None
    ) -> Hits:
        """The first hit of each of many rays.

        Args:
            origins: `(n, dimensions)` numbers.
            directions: as many.
            limits: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.

        Returns:
            `(n,)` ids and places; id 0 and an infinite place for a ray that hits nothing.

        Raises:
            InvalidQueryError: for the first that makes no sense.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.ray_cast_many([[0], [0]], [[1], [-1]]).at
        array([ 5., inf])
        """
        points = self._points(origins, "origins")
        return self._cast_many(np.concatenate([points, points], axis=1), directions, limits, filter)

    def box_cast(
        self, box: ArrayLike, direction: ArrayLike, limit: float = np.inf, filter: Filter | None = None
    ) -> Hit | None:
        """The body that a moving box hits first. Otherwise as `ray_cast`.

        Args:
            box: `2 * dimensions` numbers, finite: the box at its start.
            direction: `dimensions` numbers, finite.
            limit: how many directions far.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `ray_cast`, also if the box is inverted.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.box_cast([0, 1], [1])
        Hit(id=4294967296, at=4.0)
        """
        return _first(self._cast(self._row(box, "box"), direction, limit, filter, False))

    def box_cast_all(
        self, box: ArrayLike, direction: ArrayLike, limit: float = np.inf, filter: Filter | None = None
    ) -> Hits:
        """All that a moving box hits, nearest first and then by slot. Otherwise as `box_cast`.

        Args:
            box: `2 * dimensions` numbers, finite.
            direction: `dimensions` numbers, finite.
            limit: how many directions far.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError, ValueError, TypeError: as `box_cast`.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> ids = world.insert_many([[5, 6], [2, 3]])
        >>> world.box_cast_all([0, 1], [1], limit=3).at
        array([1.])
        """
        return self._cast(self._row(box, "box"), direction, limit, filter, True)

    def box_cast_many(
        self, boxes: ArrayLike, directions: ArrayLike, limits: ArrayLike = np.inf, filter: Filter | None = None
    ) -> Hits:
        """The first hit of each of many moving boxes. Otherwise as `ray_cast_many`.

        Args:
            boxes: `(n, 2 * dimensions)` numbers.
            directions: `(n, dimensions)` numbers.
            limits: `(n,)` numbers, or one for all.
            filter: as in `overlapping`.

        Raises:
            InvalidQueryError: for the first that makes no sense.
            ValueError, TypeError: for other shapes, or what is not numbers.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> wall = world.insert([5, 6])
        >>> world.box_cast_many([[0, 1], [9, 10]], [[1], [-2]]).at
        array([4. , 1.5])
        """
        return self._cast_many(self._rows(boxes, "boxes"), directions, limits, filter)

    def snapshot(self) -> bytes:
        """The whole state as bytes, for rollback, replay and saved games. Equal states give equal bytes.

        O(n) time; about as many bytes as the boxes take, and two for each body at rest.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.snapshot() == sap.BroadPhase(dimensions=1).snapshot()
        True
        """
        return self._world.snapshot()

    def state_hash(self) -> int:
        """A 64-bit hash of the whole state, equal for equal states on every machine. O(n) time.

        To notice when two machines that should run the same simulation do not. Not for defence against forgery.

        >>> import sweep_and_prune as sap
        >>> world = sap.BroadPhase(dimensions=1)
        >>> world.state_hash() == sap.BroadPhase(dimensions=1).state_hash()
        True
        """
        return self._world.state_hash()

    def __reduce__(self) -> tuple[Any, tuple[bytes]]:
        """Copies and pickles by way of a snapshot."""
        return type(self).from_snapshot, (self.snapshot(),)

    def __repr__(self) -> str:
        """What it was made with, and how many bodies it has."""
        return f"<BroadPhase of {len(self)} bodies, dimensions={self._dimensions}, dtype={self._dtype}>"

    def _row(self, box: ArrayLike, name: str) -> Floats:
        return row(box, name, self._dtype, 2 * self._dimensions)

    def _rows(self, boxes: ArrayLike, name: str) -> Floats:
        return box_rows(boxes, name, self._dtype, self._dimensions)

    def _point(self, point: ArrayLike, name: str) -> Floats:
        return row(point, name, self._dtype, self._dimensions)

    def _points(self, points: ArrayLike, name: str) -> Floats:
        return rows(points, name, self._dtype, self._dimensions)

    def _ray(self, origin: ArrayLike) -> Floats:
        point = self._point(origin, "origin")
        return np.concatenate([point, point], axis=1)

    def _nearest(self, points: Floats, k: int, filter: Filter | None) -> Neighbours:
        count = min(whole(k, "k", 0, 2**63 - 1), len(self))
        ids, squares = self._world.nearest(points, count, words(filter, ALL))
        # Each point has as many neighbours, since all see the same bodies.
        shape = (len(points), len(ids) // len(points) if len(points) else 0)
        return Neighbours(ids.reshape(shape), np.sqrt(squares).reshape(shape))

    def _cast(self, box: Floats, direction: ArrayLike, limit: float, filter: Filter | None, all: bool) -> Hits:
        way, far = self._point(direction, "direction"), np.array([real(limit, "limit")], self._dtype)
        return Hits(*self._world.cast(box, way, far, words(filter, ALL), all))

    def _cast_many(self, boxes: Floats, directions: ArrayLike, limits: ArrayLike, filter: Filter | None) -> Hits:
        ways = self._points(directions, "directions")
        if len(ways) != len(boxes):
            raise ValueError(f"{len(boxes)} starts do not go with {len(ways)} directions")
        far = each(limits, "limits", self._dtype, len(boxes))
        return Hits(*self._world.cast(boxes, ways, far, words(filter, ALL), False))


def _first(hits: Hits) -> Hit | None:
    return Hit(int(hits.ids[0]), float(hits.at[0])) if hits.ids[0] else None
