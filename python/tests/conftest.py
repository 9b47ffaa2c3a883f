"""Settings of the property tests: no deadline, because the machine may be loaded, and no files left behind. And the
boxes of the shared scenes."""

import subprocess
from pathlib import Path

import pytest
from hypothesis import settings

settings.register_profile("project", deadline=None, database=None, print_blob=True)
settings.load_profile("project")

ROOT = Path(__file__).parents[2]


def write_scenes(folder: Path, *count: str) -> Path:
    """Writes the boxes of all scenes to a folder: 150 of each, or `count`."""
    manifest = str(ROOT / "Cargo.toml")
    package = ["--manifest-path", manifest, "--package", "sweep-and-prune-golden-boxes", "--profile", "checked"]
    subprocess.run(["cargo", "run", "--quiet", *package, "--", str(folder), *count], check=True)
    return folder


@pytest.fixture(scope="session")
def scenes(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_scenes(tmp_path_factory.mktemp("scenes"))
