"""Writes a file of the command line: it appears when it is complete, and replaces nothing else."""

from __future__ import annotations

import errno
import os
import re
import shutil
import stat
import time
import uuid
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import IO

from ._signals import remove_at_end, remove_unfinished

_MOST_LINKS = 40
_PART = re.compile(r"\.sap-[0-9a-f]{32}\.part")
_SECONDS_UNTIL_LOCKED = 60
"""A file that is younger may have been made by a program that has not locked it yet."""


@contextmanager
def output_file(path: str) -> Iterator[tuple[IO[bytes], bool]]:
    """Opens what `path` names for writing. Also tells whether it is a stream, whose beginning may not be its own.

    A regular file is written under a name that no other file has, in the same folder. At the end it replaces the file
    that `path` names, whose mode it keeps, or it is removed after an error. Symbolic links are followed. Everything
    else that can be written to (a device, a named pipe, a descriptor such as `/dev/stdout`) is written directly.

    Raises:
        OSError: if it cannot be written.
    """
    if "\0" in path:
        raise OSError(errno.EINVAL, "a name cannot contain a zero byte", path)
    target = _target(path)
    if isinstance(target, int):
        with open(target, "wb", closefd=False) as file:
            yield file, True
        return
    before = _status(target)
    if before is not None and not stat.S_ISREG(before.st_mode):
        with open(target, "wb") as file:  # for a folder, this is the error
            yield file, True
        return
    if before is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), target)
    part = os.path.join(os.path.dirname(target), f".sap-{uuid.uuid4().hex}.part")
    mode = 0o666 if before is None else stat.S_IMODE(before.st_mode) & 0o777
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
    _remove_abandoned(os.path.dirname(target))
    remove_at_end(part)
    try:
        with open(part, "wb", opener=lambda name, _: os.open(name, flags, mode)) as file:
            _lock(file)
            yield file, False
        if before is None or _takes_the_place(part, before):
            os.replace(part, target)
        else:
            shutil.copyfile(part, target)
    finally:
        remove_unfinished()


def _lock(file: IO[bytes]) -> bool:
    """Whether no other process has a file of this package, which this one has from now on until it is closed."""
    try:
        import fcntl

        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (ImportError, OSError):  # Windows has no such locks, and some network drives have none
        return False
    return True


def _remove_abandoned(folder: str) -> None:
    """Removes the unfinished files of programs that were killed: files of this user that no process has locked."""
    try:
        entries = [entry for entry in os.scandir(folder or ".") if _PART.fullmatch(entry.name)]
    except OSError:
        return
    for entry in entries:
        with suppress(OSError, AttributeError):
            status = entry.stat(follow_symlinks=False)
            is_old = time.time() - status.st_mtime > _SECONDS_UNTIL_LOCKED
            if stat.S_ISREG(status.st_mode) and status.st_uid == os.getuid() and is_old:
                with open(entry.path, "rb") as file:
                    if _lock(file):
                        os.remove(entry.path)


def _target(path: str) -> str | int:
    """What `path` names, without symbolic links; a descriptor of this process as its number."""
    for _ in range(_MOST_LINKS):
        folder, name = os.path.realpath(os.path.dirname(path)), os.path.basename(path)
        if name.isdigit() and folder in ("/dev/fd", f"/proc/{os.getpid()}/fd"):
            return int(name)
        path = os.path.join(folder, name)
        if not os.path.islink(path):
            return path
        path = os.path.join(folder, os.readlink(path))
    raise OSError(errno.ELOOP, os.strerror(errno.ELOOP), path)


def _status(path: str) -> os.stat_result | None:
    try:
        return os.stat(path)
    except FileNotFoundError:
        return None


def _takes_the_place(part: str, before: os.stat_result) -> bool:
    """Gives a new file the owner and the mode of the one that it replaces.

    Returns:
        False if this is impossible, or if the old file has other names, which would keep the old content. Then the new
        content is copied into the old file.
    """
    if before.st_nlink > 1:
        return False
    own = os.stat(part)
    if (own.st_uid, own.st_gid) != (before.st_uid, before.st_gid):
        try:
            os.chown(part, before.st_uid, before.st_gid)
        except (OSError, AttributeError):
            return False
    os.chmod(part, stat.S_IMODE(before.st_mode))
    return True
