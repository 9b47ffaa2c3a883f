"""The result on disk: Parquet files of pairs, and a manifest that says that they are complete."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .._errors import SweepAndPruneError
from .files import checked_path, part_of, read_sealed, write_sealed

MANIFEST = "_manifest.json"
"""Readers of Parquet datasets pass over names that begin with an underscore."""

_BUFFER = 2**20
_HASH_BLOCK = 2**15
_WORD = 2**64 - 1


class DatasetError(SweepAndPruneError):
    """A file cannot be read or written, or is not what it should be. The message names it and says what to do."""


class Manifest(NamedTuple):
    """What a finished dataset of pairs contains."""

    pairs: int
    """The number of pairs."""
    hash: str
    """64 bits in hexadecimal: a hash of the pairs as a set. It does not depend on their order, the cells, the number
    of workers or failures."""
    boxes: list[int]
    """The number of boxes of each set, without those that `missing="skip"` left out."""
    copies: float
    """How many cells a box went to, on average."""
    files: list[dict[str, Any]]
    """For each file its `name`, the number of its `pairs` and their `hash`."""


def read_manifest(path: str | os.PathLike[str]) -> Manifest:
    """Reads the manifest of a dataset of pairs, and so makes sure that it is finished.

    Args:
        path: the folder of the dataset.

    Raises:
        DatasetError: if there is no finished dataset.
    """
    file = checked_path(path, "path") / MANIFEST
    try:
        return Manifest(**read_sealed(file))
    except OSError:
        raise DatasetError(
            f"{os.fspath(path)} is no finished dataset of pairs: it has no {MANIFEST}; call find_pairs with this out"
        ) from None
    except (ValueError, TypeError) as error:
        raise DatasetError(f"{file} is damaged: {error}; remove the dataset and start again") from None


def write_manifest(folder: Path, manifest: Manifest) -> None:
    """Writes the manifest of a dataset of pairs, whose files are complete."""
    write_sealed(folder / MANIFEST, manifest._asdict(), indent=1)


def hash_pairs(first: NDArray[Any], second: NDArray[Any]) -> int:
    """The sum of the hashes of all pairs, modulo 2^64: the order does not matter, and sums of chunks add up."""
    a, b = (_words(ids) for ids in (first, second))
    total = 0
    for start in range(0, len(a), _HASH_BLOCK):  # a block fits in the cache
        mixed = _mixed(a[start : start + _HASH_BLOCK] * np.uint64(0x9E3779B97F4A7C15))
        mixed += b[start : start + _HASH_BLOCK]
        total += int(_mixed(mixed * np.uint64(0xD6E8FEB86659FD93)).sum(dtype=np.uint64))
    return total & _WORD


def _mixed(words: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Each bit depends on all bits: the finalizer of MurmurHash3, one round less."""
    words ^= words >> np.uint64(32)
    words *= np.uint64(0xFF51AFD7ED558CCD)
    words ^= words >> np.uint64(29)
    return words


def _words(ids: NDArray[Any]) -> NDArray[np.uint64]:
    if ids.dtype.kind in "iu":
        return ids.astype(np.uint64)
    from pandas.util import hash_array

    return np.asarray(hash_array(ids.astype(object), categorize=False), np.uint64)


class PairFile:
    """Takes the pairs of one cell, and writes them to a Parquet file if it has a path; counts and hashes them."""

    def __init__(self, path: Path | None, id_types: tuple[str, str], one_set: bool) -> None:
        self.pairs = self.hash = 0
        self._path, self._one_set, self._buffered = path, one_set, 0
        self._writer: Any = None
        if path is None:
            return
        import pyarrow
        import pyarrow.parquet

        self._arrow = pyarrow
        self._types = [getattr(pyarrow, name)() for name in id_types]
        self._part = part_of(path)
        schema = pyarrow.schema([("a", self._types[0]), ("b", self._types[1])])
        self._writer = pyarrow.parquet.ParquetWriter(
            self._part,
            schema,
            compression="lz4",
            use_dictionary=False,
            write_statistics=False,
            write_page_checksum=True,
        )
        self._buffers: list[list[NDArray[Any]]] = [[], []]

    def write(self, first: NDArray[Any], second: NDArray[Any]) -> None:
        """Adds pairs."""
        if self._one_set:
            from .search import in_order

            first, second = in_order(first, second)
        self.pairs += len(first)
        if self._writer is None:
            return
        self.hash = (self.hash + hash_pairs(first, second)) & _WORD
        self._buffers[0].append(first)
        self._buffers[1].append(second)
        self._buffered += len(first)
        if self._buffered >= _BUFFER:
            self._flush()

    def _flush(self) -> None:
        columns = [
            self._arrow.chunked_array([self._arrow.array(chunk, kind) for chunk in chunks], kind)
            for chunks, kind in zip(self._buffers, self._types)
        ]
        self._buffers, self._buffered = [[], []], 0
        table = self._arrow.table(columns, names=["a", "b"])
        self._writer.write_table(table, row_group_size=max(len(table), 1))

    def close(self) -> None:
        """Completes the file and gives it its name."""
        if self._writer is None or self._path is None:
            return
        if self._buffered:
            self._flush()
        summary = {"pairs": str(self.pairs), "hash": f"{self.hash:016x}"}
        self._writer.add_key_value_metadata(summary)
        self._writer.close()
        os.replace(self._part, self._path)

    def abandon(self) -> None:
        """Removes what could not be completed."""
        if self._writer is not None:
            try:
                self._writer.close()
            except Exception:
                pass  # the disk may be full
            self._part.unlink(missing_ok=True)


@contextmanager
def pair_file(path: Path | None, id_types: tuple[str, str], one_set: bool) -> Iterator[PairFile]:
    """A file that is completed at the end, or removed after an error."""
    file = PairFile(path, id_types, one_set)
    try:
        yield file
        file.close()
    except BaseException:
        file.abandon()
        raise


def summary_of(path: Path) -> tuple[int, int] | None:
    """The number and the hash of the pairs of a complete file; None if it is not complete."""
    import pyarrow
    import pyarrow.parquet

    try:
        metadata = pyarrow.parquet.read_metadata(path).metadata or {}
        return int(metadata[b"pairs"]), int(metadata[b"hash"], 16)
    except (OSError, pyarrow.ArrowException, KeyError, ValueError):
        return None


def has_its_pairs(path: Path, id_types: tuple[str, str]) -> bool:
    """Whether a file of pairs is complete and not damaged: it is read as a whole."""
    import pyarrow
    import pyarrow.parquet

    schema = pyarrow.schema([(name, getattr(pyarrow, kind)()) for name, kind in zip("ab", id_types)])
    pairs = total = 0
    try:
        with pyarrow.parquet.ParquetFile(path, page_checksum_verification=True) as file:
            if not file.schema_arrow.equals(schema, check_metadata=False):
                return False
            for batch in file.iter_batches(batch_size=_BUFFER, use_threads=False):
                pairs += len(batch)
                total += hash_pairs(*(column.to_numpy(zero_copy_only=False) for column in batch.columns))
    except Exception:  # whatever a damaged file leads to
        return False
    return summary_of(path) == (pairs, total & _WORD)
