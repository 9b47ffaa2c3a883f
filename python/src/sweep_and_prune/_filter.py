"""Filters: which bodies may pair."""

from __future__ import annotations

from typing import NamedTuple

from ._arrays import truth, whole


class _Fields(NamedTuple):
    category: int = 1
    """What the body is: 32 bits."""
    mask: int = 0xFFFF_FFFF
    """The categories that it pairs with: 32 bits. `~2` is all but the second."""
    group: int = 0
    """0, or a 32-bit number. Between two bodies of the same group it overrides category and mask."""
    is_static: bool = False
    """Whether it is a static body: two static bodies never pair."""


class Filter(_Fields):
    """Decides which bodies may pair.

    Two bodies pair if their boxes overlap and

    1. at least one of them is not static;
    2. they have the same group, which is positive; or they have different groups or group 0, and the category of
       each has a bit in common with the mask of the other.

    So a shared negative group keeps bodies apart and a shared positive group joins them, whatever their masks. These
    are the rules of box2d.

    >>> import sweep_and_prune as sap
    >>> wall = sap.Filter(is_static=True)
    >>> ghost = sap.Filter(category=2, mask=2)
    >>> wall.allows(sap.Filter()), wall.allows(wall), wall.allows(ghost)
    (True, False, False)
    """

    __slots__ = ()

    def __new__(cls, category: int = 1, mask: int = 0xFFFF_FFFF, group: int = 0, is_static: bool = False) -> Filter:
        """Creates a filter. What its fields cannot be is refused here, not where it is used."""
        filter = super().__new__(cls, category, mask, group, is_static)
        words(filter)
        return filter

    def allows(self, other: Filter) -> bool:
        """Tells whether two bodies with these filters may pair. Symmetric."""
        category, mask, group, is_static = words(self)
        other_category, other_mask, other_group, other_is_static = words(other)
        if is_static and other_is_static:
            return False
        if group == other_group != 0:
            return group > 0
        return category & other_mask != 0 and other_category & mask != 0


def words(filter: object) -> tuple[int, int, int, bool]:
    """Checks a filter and converts it to what the compiled part takes."""
    if not isinstance(filter, Filter):
        raise TypeError(f"filter must be a Filter, not a {type(filter).__name__}")
    category, mask, group, is_static = filter
    return (
        whole(category, "category", -(2**31), 2**32 - 1) & 0xFFFF_FFFF,
        whole(mask, "mask", -(2**31), 2**32 - 1) & 0xFFFF_FFFF,
        whole(group, "group", -(2**31), 2**31 - 1),
        truth(is_static, "is_static"),
    )
