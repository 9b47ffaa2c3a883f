"""Settings of the property tests: no deadline, because the machine may be loaded, and no files left behind. Those of
NumPy. And the boxes of the shared scenes."""

import subprocess
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

settings.register_profile("project", deadline=None, database=None, print_blob=True)
settings.load_profile("project")

ROOT = Path(__file__).parents[2]


@pytest.fixture(autouse=True)
def numpy_raises() -> Iterator[None]:
    """All tests run as in a program whose NumPy raises: no arithmetic of this package shows."""
    with np.errstate(all="raise"):
        yield


def write_scenes(folder: Path, *count: str) -> Path:
    """Writes the boxes of all scenes to a folder: 150 of each, or `count`."""
    manifest = str(ROOT / "Cargo.toml")
    package = ["--manifest-path", manifest, "--package", "sweep-and-prune-golden-boxes", "--profile", "checked"]
    subprocess.run(["cargo", "run", "--quiet", *package, "--", str(folder), *count], check=True)
    return folder


@pytest.fixture(scope="session")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scenes(tmp_path_factory.mktemp("scenes"))
