"""The attributes of objects that are copied and pickled, those of subclasses included."""

from __future__ import annotations

from types import MemberDescriptorType
from typing import Any


def attributes(one: object, left_out: tuple[str, ...]) -> dict[str, Any]:
    """The attributes of an object by name, those in `__slots__` included, without those that are left out."""
    found = vars(one) | {name: getattr(one, name) for name in _slots(one) if hasattr(one, name)}
    return {name: value for name, value in found.items() if name not in left_out}


def set_attributes(one: object, values: dict[str, Any]) -> None:
    """Restores what `attributes` returned, and calls no setter of a subclass."""
    slots = _slots(one)
    for name, value in values.items():
        if name in slots:
            object.__setattr__(one, name, value)
        else:
            vars(one)[name] = value


def _slots(one: object) -> list[str]:
    """The names of `__slots__`. Python changes those that begin with two underscores, so it is asked for them."""
    return [
        name
        for kind in type(one).__mro__
        for name, member in vars(kind).items()
        if isinstance(member, MemberDescriptorType)
    ]
