"""Files that are there as a whole or not at all, and that show whether they are damaged."""

from __future__ import annotations

import hashlib
import json
import os
import uuid
import zlib
from pathlib import Path
from typing import Any

_BLOCK = 2**20
_CHECKSUM = "checksum"


def checked_path(path: str | os.PathLike[str], argument: str) -> Path:
    """A path whose name is possible.

    Raises:
        ValueError: if it is empty or has a zero byte.
    """
    name = os.fspath(path)
    if "\0" in name:
        raise ValueError(f"{argument} is {name!r}: a name cannot contain a zero byte")
    if not name:
        raise ValueError(f"{argument} is an empty text: it must be a path")
    return Path(name)


def part_of(path: Path) -> Path:
    """A name that no other file has, for a file that is written and then renamed to `path`."""
    return path.with_name(f"{path.name}.{uuid.uuid4().hex}.part")


PART = r"\.[0-9a-f]{32}\.part"
"""What these names end in, as a pattern."""


def write_sealed(path: Path, content: dict[str, Any], indent: int | None = None) -> None:
    """Writes JSON with a checksum of its content."""
    write_text(path, json.dumps({**content, _CHECKSUM: _checksum(content)}, indent=indent))


def read_sealed(path: Path) -> dict[str, Any]:
    """Reads what `write_sealed` wrote.

    Raises:
        OSError: if the file cannot be read.
        ValueError: if it is damaged, or something else.
    """
    content = json.loads(path.read_text(encoding="utf-8"))
    if not isinstance(content, dict):
        raise ValueError("it is something else")
    if content.pop(_CHECKSUM, None) != _checksum(content):
        raise ValueError("its checksum does not match its content")
    return content


def _checksum(content: dict[str, Any]) -> str:
    return hashlib.sha256(json.dumps(content).encode()).hexdigest()


def digest_of(path: Path) -> str:
    """A checksum of the bytes of a file, which every flipped bit changes."""
    digest = 0
    with open(path, "rb") as file:
        while block := file.read(_BLOCK):
            digest = zlib.crc32(block, digest)
    return f"{digest:08x}"


def write_text(path: Path, text: str) -> None:
    """Writes a file so that it is there as a whole or not at all, even after a loss of power."""
    part = part_of(path)
    try:
        with open(part, "x", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    except BaseException:
        part.unlink(missing_ok=True)
        raise


def sync(path: Path) -> None:
    """Waits until a file is on the disk."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
