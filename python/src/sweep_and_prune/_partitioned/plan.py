"""What a run does, as it is noted in its folder, so that the run can be continued and workers can read it."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from .boxes import Chunk, File, Form
from .cells import Cells
from .files import read_sealed, write_sealed

ARGUMENTS = ("boxes",), ("a", "b")
"""The names of one set and of two."""

PLAN = "_plan.json"


class Plan(NamedTuple):
    """What a run does; the same when it continues after an interruption."""

    files: list[list[File]]
    """The files of each set; none for partitions of a collection."""
    forms: list[Form]
    chunks: list[Chunk]
    cells: Cells
    request: dict[str, Any]
    """What the user asked for: a run that asks for something else cannot continue this one."""
    run: str
    """A name that no other run has."""

    @property
    def sets(self) -> int:
        """1, or 2 for pairs of a box of one set and a box of another."""
        return len(self.forms)

    @property
    def id_types(self) -> tuple[str, str]:
        """The types of the ids in a pair."""
        return self.forms[0].id_type, self.forms[-1].id_type

    def name(self, argument: int) -> str:
        """The name of a set."""
        return ARGUMENTS[self.sets - 1][argument]

    def write(self, folder: Path) -> None:
        """Writes the plan to the folder of the run, with a checksum."""
        write_sealed(folder / PLAN, self._asdict())

    @staticmethod
    def read(folder: Path) -> Plan:
        """Reads the plan of a run.

        Raises:
            OSError: if there is none.
            ValueError: if it is damaged.
        """
        content = read_sealed(folder / PLAN)
        try:
            return Plan(
                [[File(*file) for file in of_set] for of_set in content["files"]],
                [Form(*form) for form in content["forms"]],
                [Chunk(*chunk) for chunk in content["chunks"]],
                Cells(*content["cells"]),
                content["request"],
                content["run"],
            )
        except (TypeError, KeyError) as error:
            raise ValueError(f"another version of this package wrote it ({error})") from None
