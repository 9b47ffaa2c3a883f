"""Names of tests, after the values that they are run with."""

from __future__ import annotations

import re


def name_of(value: object) -> str:
    """What Python prints, without addresses: all processes that run the tests have to name them alike."""
    return re.sub(r" at 0x[0-9a-fA-F]+", "", repr(value))[:40]
