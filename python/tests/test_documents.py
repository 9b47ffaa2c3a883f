"""The documents tell the truth: what the README and the examples print, that everything public is described and has
an example that runs, and that the types are what they say."""

from __future__ import annotations

import doctest
import importlib.util
import inspect
import json
import pkgutil
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import sweep_and_prune as sap
from sweep_and_prune._command import sap as command_line

PYTHON = Path(__file__).parents[1]
README = (PYTHON / "README.md").read_text()
BLOCKS = re.findall(r"```python\n(.*?)```", README + (PYTHON.parent / "README.md").read_text(), re.DOTALL)
EXAMPLES = {
    "detections.py": ["116362 pairs overlap, of 199990000", "detections are kept, of 2000 objects"],
    "genes.py": ["115002 overlaps; 23.0 reads on a gene", "3049 pairs of genes are less than 1,000 bases apart"],
    "mesh.py": ["80000 and 80000 triangles: 17", "36969 of triangles without a common corner"],
    "tracks.py": ["9800 links, 99.7 % of them right", "objects are tracked through all 50 frames"],
    "spatial_join.py": ["20000 parcels, 2000 photographs: ", "parcels on a photograph", "owner "],
    "particles.py": ["step 0: ", "step 99: "],
    "game_loop.py": ["frame 2: hero meets coin 0", "hero meets monster 1", "3 coins; behind the hero: monster 0"],
}


def run(*arguments: str | Path, folder: Path = PYTHON / "tests") -> str:
    """What Python prints; in a folder without the package, so that the package is the one that is installed."""
    done = subprocess.run([sys.executable, *arguments], capture_output=True, text=True, cwd=folder)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


@pytest.mark.parametrize("block", BLOCKS)
def test_the_readme_prints_what_it_says(block: str) -> None:
    said = re.findall(r"^\s*print\(.*\)\s+# (.*)$", block, re.MULTILINE)
    assert said, "nothing in it could be checked"
    if "pandas" in block:
        pytest.importorskip("pandas")
    assert run("-c", block).splitlines() == said


def test_the_readme_has_examples() -> None:
    assert len(re.findall("```python", README)) == 4


def test_the_readme_names_no_path_that_the_wheel_lacks() -> None:
    assert re.findall(r"`[\w./]*/[\w./]+`", README.replace("`./test python`", "")) == []
    assert re.findall(r"`(\w+\.py)`", README) == []


def test_the_readme_shows_commands_that_there_are() -> None:
    commands = re.findall(r"^sap (.*)$", README, re.MULTILINE)
    assert len(commands) == 8
    for command in commands:
        name, *arguments = command.split(" > ")[0].split()
        command_line.commands[name].make_context(name, arguments)  # refuses what it does not know
    project = (PYTHON / "pyproject.toml").read_text()
    assert 'sap = "sweep_and_prune_command:program"' in project


def test_importing_the_library_loads_little_besides() -> None:
    program = "import sys, numpy; before = {*sys.modules}; import sweep_and_prune; print(*{*sys.modules} - before)"
    loaded = {name.split(".")[0] for name in run("-c", program).split()}
    # They take longer than the rest of the import.
    assert "sweep_and_prune" in loaded and not loaded & {
        "click",
        "rich",
        "logging",
        "concurrent",
        "importlib",
        "pandas",
    }


@pytest.mark.parametrize("name", sorted(path.name for path in (PYTHON / "examples").glob("*.py")))
def test_examples_run(name: str) -> None:
    printed = run(PYTHON / "examples" / name)
    for said in EXAMPLES[name]:
        assert said in printed
    assert len((PYTHON / "examples" / name).read_text().splitlines()) <= 45


def public() -> dict[str, Any]:
    """Everything public by name, methods and properties among it."""
    found: dict[str, Any] = {}
    for name in sap.__all__:
        item = getattr(sap, name)
        found[name] = item
        if inspect.isclass(item):
            for key, member in vars(item).items():
                if not key.startswith("_") and (callable(member) or isinstance(member, (property, classmethod))):
                    found[f"{name}.{key}"] = member.__func__ if isinstance(member, classmethod) else member
    return found


@pytest.mark.parametrize("name", public())
def test_everything_public_is_described_with_its_arguments(name: str) -> None:
    item = public()[name]
    assert item.__doc__ and item.__doc__.strip()
    if inspect.isfunction(item):
        parameters = [key for key in inspect.signature(item).parameters if key not in ("self", "cls")]
        missing = [key for key in parameters if f"{key}:" not in item.__doc__]
        assert not missing or name == "Filter.allows"


def test_every_call_has_an_example_that_runs() -> None:
    finder = doctest.DocTestFinder()
    examples = 0
    for info in pkgutil.iter_modules(sap.__path__):
        module = importlib.import_module(f"sweep_and_prune.{info.name}")
        for test in finder.find(module):
            needed = [name for name in ("pandas", "dask.array") if name in (test.docstring or "")]
            if any(importlib.util.find_spec(name.split(".")[0]) is None for name in needed):
                continue
            result = doctest.DocTestRunner().run(test)
            assert result.failed == 0, test.name
            examples += result.attempted
    assert examples > 100
    exempt = {"Filter.allows", "Lists.each", "Lists.queries", "BroadPhase.ids"}
    short = {"Changes", "Hit", "Hits", "Merged", "Nearest", "Neighbors", "Overlaps"}
    without = [
        name
        for name, item in public().items()
        if ">>>" not in item.__doc__ and not isinstance(item, property) and name not in exempt | short
    ]
    assert without == []


def test_the_version_is_that_of_the_project() -> None:
    tomllib = pytest.importorskip("tomllib")  # from Python 3.11 on
    workspace = tomllib.loads((PYTHON.parent / "Cargo.toml").read_text())["workspace"]["package"]
    crate = tomllib.loads((PYTHON / "Cargo.toml").read_text())["package"]
    assert sap.__version__ == workspace["version"] == crate["version"]
    assert crate["license"] == workspace["license"]


def test_types_are_strict_and_so_are_those_of_the_compiled_part() -> None:
    pytest.importorskip("mypy")
    run("-m", "mypy", folder=PYTHON)
    run("-m", "mypy.stubtest", "sweep_and_prune._native", folder=PYTHON)


def test_the_types_of_results_are_known_to_a_checker(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    program = tmp_path / "typed.py"
    program.write_text(
        """
import numpy as np
import sweep_and_prune as sap
world = sap.BroadPhase(2)
reveal_type(sap.find_pairs([[0, 1]]))
reveal_type(world.insert([0, 0, 1, 1]))
reveal_type(world.update().begun)
reveal_type(world.ray_cast([0, 0], [1, 0]))
world.remove(world.ids()[0])
points = {"x": [0.5], "y": [0.5]}
boxes = {"minx": [0], "miny": [0], "maxx": [1], "maxy": [1]}
world.nearest_many(points)
world.containing_many(points)
world.within_many(points, 1)
world.ray_cast_many(points, points)
world.box_cast_many(boxes, points)
world.set_swept_many([0], boxes, boxes)
world.insert([0, 0, 1, 1], filter=5)
"""
    )
    done = subprocess.run(
        [sys.executable, "-m", "mypy", "--strict", program], capture_output=True, text=True, cwd=tmp_path
    )
    notes = re.findall(r'Revealed type is "(.*)"', done.stdout)
    assert "ndarray" in notes[0], notes
    assert notes[1] in ("int", "builtins.int")
    assert "int64" in notes[2] or "64Bit" in notes[2]
    assert "Hit" in notes[3] and "None" in notes[3]
    assert "arg-type" in done.stdout and done.stdout.count("error") == 2


@pytest.mark.parametrize(
    "path", sorted((PYTHON.parent / "site/test/snippets").glob("*.py")), ids=lambda path: path.name
)
def test_what_the_playground_writes_runs_and_finds_what_it_says(path: Path) -> None:
    said = re.findall(r"^print\(.*\)\s+# (.*)$", path.read_text(), re.MULTILINE)
    assert said and run(path).splitlines() == said


def test_the_reference_names_everything_and_loads_nothing_from_elsewhere(tmp_path: Path) -> None:
    pytest.importorskip("pdoc")
    run(PYTHON / "docs.py", tmp_path)
    page = (tmp_path / "sweep_and_prune.html").read_text()
    assert [name for name in public() if f'id="{name}"' not in page] == []
    assert 'href="sweep_and_prune/dask.html"' in page and (tmp_path / "sweep_and_prune/dask.html").exists()
    loaded = re.findall(r"""(?:src=|<link[^>]*href=|url\(|@import )["']?([^"')>\s]+)""", page)
    assert [address for address in loaded if not address.startswith(("data:", "#", "./"))] == []
    assert re.search(r"prefers-color-scheme: ?dark", page)
    assert 'href="guide.html"' in page
    first, tracks = ((tmp_path / name).read_text() for name in ("guide.html", "guide/tracks.html"))
    links = [link for link in re.findall(r'href="([^"#:]+)"', first) if not link.endswith(".css")]
    assert "guide/from_array_to_cluster.html" in links
    assert [link for link in links if not (tmp_path / link).exists()] == []
    assert 'href="tracks.ipynb"' in tracks
    assert json.loads((tmp_path / "guide/tracks.ipynb").read_text())["cells"][1]["cell_type"] == "code"
    assert 'src="data:image/svg+xml' in tracks and 'href="game_loop.html"' not in tracks
    assert "boxes: Boxes" in re.sub(r"<[^>]*>", "", page).replace("\xa0", " ")
