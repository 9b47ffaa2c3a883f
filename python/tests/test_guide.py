"""The guide's notebooks run, print what they say, and draw their pictures."""

from __future__ import annotations

import importlib.util
import re
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

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
    expected = GUIDE.said(page)
    assert expected or page.stem == "README"
    assert GUIDE.run(page, tmp_path) == expected
    for name in GUIDE.pictures(page):
        drawn, kept = (folder / name for folder in (tmp_path, GUIDE.GUIDE))
        # The bytes depend on the version of matplotlib; texts and sizes do not.
        texts = [re.findall(r"<text.*?>(.*?)</text>", path.read_text(encoding="utf-8")) for path in (drawn, kept)]
        assert texts[0] == texts[1], f"{name} is not what the page draws: run python python/notebooks.py"


def test_the_suppression_works_in_half_precision() -> None:
    page = (GUIDE.GUIDE / "detections.md").read_text(encoding="utf-8")
    blocks = [block for block in re.findall(r"```python\n(.*?)```", page, re.DOTALL) if "matplotlib" not in block]
    # Ten times as large: 800 by 800 are more than half precision has.
    blocks.insert(1, "boxes = (boxes * 10).astype(np.float16)\n")
    names: dict[str, Any] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        exec("\n".join(blocks), names)
    assert names["boxes"].dtype == "float16" and not (names["iou"] != names["iou"]).any()
    assert 2000 < names["kept"].sum() < 2100
