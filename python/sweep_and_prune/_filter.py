"""Which bodies may pair at all."""

from __future__ import annotations

from typing import NamedTuple

from ._arrays import whole


class Filter(NamedTuple):
    """Which bodies may pair. Two do if their boxes overlap and

    1. at least one of them is not static;
    2. they are of the same group, other than 0, and it is positive; or they are not of the same group (or of
       group 0), and each one's category has a bit in the other's mask.

    So a shared negative group keeps bodies apart and a shared positive one joins them, whatever their masks;
    these are box2d's rules.

    >>> import sweep_and_prune as sap
    >>> wall = sap.Filter(is_static=True)
    >>> ghost = sap.Filter(category=2, mask=2)
    >>> wall.allows(sap.Filter()), wall.allows(wall), wall.allows(ghost)
    (True, False, False)
    """

    category: int = 1
    """What the body is: 32 bits."""
    mask: int = 0xFFFF_FFFF
    """What it pairs with: the categories of others. 32 bits; `~2` is all but the second."""
    group: int = 0
    """0, or a number of 32 bits that decides over category and mask between two of the same group."""
    is_static: bool = False
    """Whether it is a static body: two of these never pair."""

    def allows(self, other: Filter) -> bool:
        """Whether two bodies with these filters may pair. Symmetric."""
        (category, mask, group, is_static), (others, wanted, gang, stands) = words(self), words(other)
        if is_static and stands:
            return False
        if group == gang != 0:
            return group > 0
        return category & wanted != 0 and others & mask != 0


ALL = Filter(category=0xFFFF_FFFF)
"""What a query sees the world with unless told otherwise."""


def words(filter: object, default: Filter = Filter()) -> tuple[int, int, int, bool]:  # noqa: B008
    """A filter, checked, as the compiled part takes it."""
    if filter is None:
        filter = default
    if not isinstance(filter, Filter):
        raise TypeError(f"filter must be a Filter, not a {type(filter).__name__}")
    category, mask, group, is_static = filter
    return (
        whole(category, "category", -(2**31), 2**32 - 1) & 0xFFFF_FFFF,
        whole(mask, "mask", -(2**31), 2**32 - 1) & 0xFFFF_FFFF,
        whole(group, "group", -(2**31), 2**31 - 1),
        bool(is_static),
    )
