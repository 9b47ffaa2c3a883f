"""What is wrong with a file, for people who use the command line."""

from __future__ import annotations

import sys
from typing import IO, Any

import click

_MOST_SAID = 500


class FileError(click.ClickException):
    """What is wrong with a file, for people."""

    def show(self, file: IO[Any] | None = None) -> None:
        """Prints it, on one line that is not too long to read."""
        said = " ".join(self.message.split("\n"))
        if len(said) > _MOST_SAID:  # a name may be long; what is wrong is at the end
            said = f"{said[: _MOST_SAID // 2]} ... {said[-_MOST_SAID // 2 :]}"
        click.echo(f"sap: {said}", file or sys.stderr)


def printable(path: str) -> str:
    """A path as a message shows it, on one line."""
    return path if path.isprintable() else repr(path)
