"""The exceptions of the package."""

from __future__ import annotations

import math


class SweepAndPruneError(Exception):
    """Base class of the errors that depend on the data.

    Misuse of a call (a wrong shape or type) raises a built-in `TypeError` or `ValueError`. The errors of this package
    are `ValueError`s or `LookupError`s too. After an error nothing has changed.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.find_pairs([[0, 0, 1, 1], [3, 0, 2, 1]])
    ... except sap.SweepAndPruneError as error:
    ...     print(error)
    boxes[1] is inverted on axis 0: min 3 is greater than max 2; pass the min corner first, then the max corner
    """


class InvalidBoxError(SweepAndPruneError, ValueError):
    """A box does not have `min <= max` on some axis: it is inverted, or it has a NaN.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.find_pairs([[0, 0, 1, 1], [0, float("nan"), 2, 1]])
    ... except sap.InvalidBoxError as error:
    ...     print(error.index, error.axis, error.argument)
    1 1 boxes
    """

    index: int
    """The position of the first invalid box in the argument."""
    axis: int
    """Its first invalid axis: 0 for x, 1 for y, 2 for z."""
    argument: str
    """The name of the argument, such as `boxes`, `box`, `a` or `b`."""
    minimum: float
    """The min of the box on this axis, in the precision in which boxes are compared."""
    maximum: float
    """The max of the box on this axis."""
    is_size: bool
    """Whether the box was passed with a size, which is negative, and not with a max corner."""

    def __init__(
        self,
        index: int,
        axis: int,
        argument: str = "boxes",
        minimum: float = math.nan,
        maximum: float = math.nan,
        is_size: bool = False,
    ) -> None:
        """Creates the error for the box at `index`."""
        super().__init__(index, axis, argument, minimum, maximum, is_size)
        self.index, self.axis, self.argument = index, axis, argument
        self.minimum, self.maximum, self.is_size = minimum, maximum, is_size

    def __str__(self) -> str:
        """Names the box, its values and what to do."""
        box = _place(self.argument, self.index)
        if self.minimum != self.minimum or self.maximum != self.maximum:  # NaN, or NaT
            values = f"min {_shown(self.minimum)}, max {_shown(self.maximum)}"
            return f"{box} has a NaN on axis {self.axis} ({values}): remove it or replace it"
        if self.is_size:
            size = _shown(self.maximum - self.minimum)
            said = f"{size:g}" if isinstance(size, float) else size  # a rounded difference
            return f"{box} has the size {said} on axis {self.axis}; it must be 0 or more"
        low, high = _shown(self.minimum), _shown(self.maximum)
        return (
            f"{box} is inverted on axis {self.axis}: min {low} is greater than max {high}; "
            "pass the min corner first, then the max corner"
        )


class StaleProxyError(SweepAndPruneError, LookupError):
    """An id names no body of this world: its body was removed, or there never was one.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=1)
    >>> hero = world.insert([0, 1])
    >>> world.remove(hero)
    >>> try:
    ...     world.box(hero)
    ... except sap.StaleProxyError as error:
    ...     print(error)
    the id at index 0 (0) is stale: its body was removed, or this world never had it
    """

    id: int
    """The stale id."""
    index: int
    """Its position in the argument, 0 for a single id."""

    def __init__(self, id: int, index: int = 0) -> None:
        """Creates the error for the id at `index`."""
        super().__init__(id, index)
        self.id, self.index = id, index

    def __str__(self) -> str:
        """Names the id and its position."""
        return f"the id at index {self.index} ({self.id}) is stale: its body was removed, or this world never had it"


class InvalidQueryError(SweepAndPruneError, ValueError):
    """A query has a value that is NaN, infinite, negative or inverted where that is not allowed.

    >>> import sweep_and_prune as sap
    >>> world = sap.BroadPhase(dimensions=2)
    >>> try:
    ...     world.within_many([[0, 0], [1, 1]], [1, -1])
    ... except sap.InvalidQueryError as error:
    ...     print(error)
    radii[1] is -1.0; it must be 0 or more
    """

    index: int
    """The position of the query among those that were passed, 0 for a single one."""
    argument: str
    """The name of the argument."""
    value: object
    """The value that is not allowed."""
    rule: str
    """What the value must be."""

    def __init__(self, index: int = 0, argument: str = "query", value: object = None, rule: str = "valid") -> None:
        """Creates the error for the query at `index`."""
        super().__init__(index, argument, value, rule)
        self.index, self.argument, self.value, self.rule = index, argument, value, rule

    def __str__(self) -> str:
        """Names the argument, its value and what it must be."""
        return f"{_place(self.argument, self.index)} is {self.value}; it must be {self.rule}"


class SnapshotError(SweepAndPruneError, ValueError):
    """Bytes that are not a snapshot of a world.

    >>> import sweep_and_prune as sap
    >>> try:
    ...     sap.BroadPhase.from_snapshot(b"a game saved by another program")
    ... except sap.SnapshotError as error:
    ...     print(error)
    these bytes are not a snapshot
    """


def _shown(value: float) -> float:
    """A whole number as people write it, without a point: positions on a genome are whole."""
    # (NumPy's durations are whole numbers to it, and do not compare with numbers.)
    is_number = hasattr(value, "is_integer") and getattr(getattr(value, "dtype", None), "kind", "f") in "fiu"
    return int(value) if is_number and value.is_integer() and abs(value) < 2**53 else value


def _place(argument: str, index: int) -> str:
    """An argument for one thing is named by itself, one for many by its element."""
    is_many = argument in ("a", "b", "radii") or (argument.endswith("s") and argument != "radius")
    return f"{argument}[{index}]" if is_many else argument
