"""The guide's notebooks run, print what they say, and draw their pictures."""

from __future__ import annotations

import importlib.util
import os
import re
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

OF_NOTEBOOKS = ("ipykernel", "jupytext", "nbclient")
for module in (*OF_NOTEBOOKS, "distributed", "geopandas", "matplotlib", "pandas", "pyarrow", "scipy", "trimesh"):
    pytest.importorskip(module)

PYTHON = Path(__file__).parents[1]


def notebooks() -> ModuleType:
    spec = importlib.util.spec_from_file_location("notebooks", PYTHON / "notebooks.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


GUIDE = notebooks()


@pytest.mark.parametrize("page", GUIDE.pages(), ids=lambda page: page.stem)
def test_a_page_prints_what_it_says_and_draws_its_pictures(page: Path, tmp_path: Path) -> None:
    if os.name == "nt" and any(code.startswith("%%bash") for code in GUIDE.codes(page)):
        pytest.skip("its commands are for a shell that Windows lacks")
    expected = GUIDE.said(page)
    assert expected or page.stem == "README"
    assert GUIDE.run(page, tmp_path) == expected
    for name in GUIDE.pictures(page):
        drawn, kept = (folder / name for folder in (tmp_path, GUIDE.GUIDE))
        # The bytes depend on the version of matplotlib; texts and sizes do not.
        texts = [re.findall(r"<text.*?>(.*?)</text>", path.read_text(encoding="utf-8")) for path in (drawn, kept)]
        assert texts[0] == texts[1], f"{name} is not what the page draws: run python python/notebooks.py"


def blocks_of(page: str) -> list[str]:
    """The Python of a page that draws nothing."""
    text = (GUIDE.GUIDE / page).read_text(encoding="utf-8")
    return [block for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL) if "matplotlib" not in block]


def test_the_suppression_works_in_half_precision() -> None:
    blocks = blocks_of("detections.md")
    # Ten times as large: 800 by 800 are more than half precision has.
    blocks.insert(1, "boxes = (boxes * 10).astype(np.float16)\n")
    names: dict[str, Any] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exec("\n".join(blocks), names)
    assert names["boxes"].dtype == "float16" and not (names["iou"] != names["iou"]).any()
    assert 2000 < names["kept"].sum() < 2100


def test_the_suppression_ends_if_scores_are_nan() -> None:
    blocks = blocks_of("detections.md")
    blocks.insert(1, "scores[::7] = np.nan\n")
    names: dict[str, Any] = {}
    exec("\n".join(blocks).replace("while len(worse):", "for _ in range(50):"), names)
    assert len(names["worse"]) == 0 and 2000 < names["kept"].sum() < 2100
    without_score = np.isnan(names["scores"][names["kept"]])
    assert without_score.sum() < 20  # of 2,858: what else shows the object is better


@pytest.mark.parametrize("kind", ["uint16", "float16"])
def test_tracks_work_for_small_types(kind: str) -> None:
    blocks = blocks_of("tracks.md")
    # Areas beyond half precision. The last box only touches that of the first frame, or overlaps it less.
    boxes = [[200, 0, 600, 400], [600, 0, 1000, 400], [300, 0, 700, 400], [202, 0, 602, 400]]
    blocks[0] = f"import numpy as np, sweep_and_prune as sap\nboxes = np.array({boxes}, {kind!r})\n"
    blocks[0] += "frame, objects = np.array([0, 1, 1, 1]), 3\n"
    names: dict[str, Any] = {}
    exec("\n".join(blocks), names)
    assert names["following"].tolist() == [3, -1, -1, -1]
