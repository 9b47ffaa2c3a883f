"""What the package raises."""

from __future__ import annotations


class SweepAndPruneError(Exception):
    """What all errors of this package have in common.

    Misuse of a call (a wrong shape or type) is a built-in `TypeError` or `ValueError`; what depends on the
    data is one of these, and a `ValueError` or a `LookupError` too. After an error nothing has changed.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.find_pairs([[0, 0, 1, 1], [3, 0, 2, 1]])
    ... except sap.SweepAndPruneError as error:
    ...     print(error)
    box 1 of boxes is inverted or NaN on axis 0: min <= max must hold
    """


class InvalidBoxError(SweepAndPruneError, ValueError):
    """A box is not `min <= max` on some axis: it is inverted, or holds a NaN.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.find_pairs([[0, 0, 1, 1], [0, float("nan"), 2, 1]])
    ... except sap.InvalidBoxError as error:
    ...     print(error.index, error.axis, error.argument)
    1 1 boxes
    """

    index: int
    """The position of the box in the argument that it was passed in: the first one that is invalid."""
    axis: int
    """Its first invalid axis: 0 for x, 1 for y, 2 for z."""
    argument: str
    """The name of the argument: `boxes`, or `a` or `b` where there are two sets, or `start` or `end`."""

    def __init__(self, index: int, axis: int, argument: str = "boxes") -> None:
        """An error for the box at `index`."""
        super().__init__(index, axis, argument)
        self.index, self.axis, self.argument = index, axis, argument

    def __str__(self) -> str:
        """Which box, and what is wrong with it."""
        return f"box {self.index} of {self.argument} is inverted or NaN on axis {self.axis}: min <= max must hold"


class StaleProxyError(SweepAndPruneError, LookupError):
    """An id is of a body that was removed, or was never given out by this world.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> hero = world.insert([0, 1])
    >>> world.remove(hero)
    >>> try:
    ...     world.box(hero)
    ... except sap.StaleProxyError as error:
    ...     print(error.id == hero, error.index)
    True 0
    """

    id: int
    """The id at fault."""
    index: int
    """Its position among those that were passed, 0 for a single one."""

    def __init__(self, id: int, index: int = 0) -> None:
        """An error for the id at `index`."""
        super().__init__(id, index)
        self.id, self.index = id, index

    def __str__(self) -> str:
        """Which id."""
        return f"id {self.id}, at {self.index}, is stale: its body was removed, or it never had one here"


class InvalidQueryError(SweepAndPruneError, ValueError):
    """A query has a part that is NaN, infinite where it has to be finite, or negative where that means nothing.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=2)
    >>> try:
    ...     world.within_many([[0, 0], [1, 1]], [1, -1])
    ... except sap.InvalidQueryError as error:
    ...     print(error.index)
    1
    """

    index: int
    """The position of the query among those that were passed, 0 for a single one."""

    def __init__(self, index: int = 0) -> None:
        """An error for the query at `index`."""
        super().__init__(index)
        self.index = index

    def __str__(self) -> str:
        """Which query."""
        return f"query {self.index} has a part that is NaN, infinite or negative"


class SnapshotError(SweepAndPruneError, ValueError):
    """Bytes that are no snapshot of a world.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.BroadPhase.from_snapshot(b"a game saved by another program")
    ... except sap.SnapshotError as error:
    ...     print(error)
    these bytes are not a snapshot
    """
