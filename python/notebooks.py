"""Runs the guide of the Python package and draws its pictures: `python python/notebooks.py` writes them to docs/guide.

Each page is also a notebook, which runs in an empty folder. What it prints has to be what its comments say. A picture
is a file that the code saves, or that this script draws.
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import jupytext
import nbclient
import numpy as np

GUIDE = Path(__file__).parents[1] / "docs/guide"
STYLE = """
figure.figsize: 7, 3.5
figure.constrained_layout.use: True
axes.spines.top: False
axes.spines.right: False
axes.edgecolor: 888888
axes.labelcolor: 888888
axes.titlecolor: 888888
axes.titlesize: medium
text.color: 888888
xtick.color: 888888
ytick.color: 888888
legend.frameon: False
savefig.transparent: True
svg.fonttype: none
svg.hashsalt: sweep-and-prune
font.family: sans-serif
"""
"""Gray text on nothing: legible on light and on dark pages."""


def pages() -> list[Path]:
    return sorted(GUIDE.glob("*.md"))


def notebook(page: Path) -> Any:
    """A page as a notebook, without the pictures that its code draws."""
    text = re.sub(r"^!\[[^\]]*\]\([\w-]+\.svg\)\n", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    made = jupytext.reads(text, fmt="md")
    made.metadata["kernelspec"] = {"name": "python3", "display_name": "Python 3", "language": "python"}
    return made


def codes(page: Path) -> list[str]:
    """The code of each cell of a page. That of commands begins with `%%bash`."""
    return [cell.source for cell in notebook(page).cells if cell.cell_type == "code"]


def said(page: Path) -> list[str]:
    """What the comments say that the code prints. Those of commands stand below them."""
    found = []
    for code in codes(page):
        pattern = r"^# (.*)$" if code.startswith("%%bash\n") else r"^\s*print\(.*\)\s+# (.*)$"
        found += re.findall(pattern, code, re.MULTILINE)
    return found


def pictures(page: Path) -> list[str]:
    return re.findall(r"!\[[^\]]*\]\(([\w-]+\.svg)\)", page.read_text(encoding="utf-8"))


def run(page: Path, folder: Path) -> list[str]:
    """Runs a page in a folder, where its pictures appear, and returns the lines that it prints."""
    (folder / "matplotlibrc").write_text(STYLE, encoding="utf-8")
    executed = notebook(page)
    client = nbclient.NotebookClient(executed, timeout=600, resources={"metadata": {"path": str(folder)}})
    # The command line is that of the package which Python imports.
    programs = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    client.execute(env={**os.environ, "PATH": programs})
    outputs = [output for cell in executed.cells for output in cell.get("outputs", [])]
    printed = "".join(output.text for output in outputs if output.output_type == "stream" and output.name == "stdout")
    if page.stem == "from-array-to-cluster":
        draw_cells(folder)
    return printed.splitlines()


def draw_cells(folder: Path) -> None:
    """Draws how space is split into cells, and which cell reports a pair."""
    import matplotlib
    import matplotlib.pyplot as plt
    from matplotlib.patches import Rectangle

    from sweep_and_prune._partitioned.cells import choose_cells

    matplotlib.rc_file(folder / "matplotlibrc")
    random = np.random.default_rng(6)
    centers = np.concatenate(
        [random.normal([0.3, 0.35], 0.1, (900, 2)), random.normal([0.75, 0.7], 0.06, (500, 2)), random.random((500, 2))]
    )
    centers = centers[((centers > 0.01) & (centers < 0.99)).all(axis=1)]
    boxes = np.hstack([centers - 0.004, centers + 0.004])

    def frame(axes: Any, title: str, low: float = 0, high: float = 1) -> None:
        axes.set(xlim=(low, high), ylim=(low, high), aspect="equal", title=title, xticks=[], yticks=[])
        for spine in axes.spines.values():
            spine.set_visible(True)

    def lines(axes: Any, count: int, width: float, color: str) -> Any:
        cells = choose_cells(boxes, count)
        lows, highs = cells.regions()
        for low, high in zip(np.maximum(lows, 0), np.minimum(highs, 1)):
            axes.add_patch(Rectangle(low, *(high - low), fill=False, edgecolor=color, linewidth=width))
        return cells

    figure, (few, many, near) = plt.subplots(1, 3, figsize=(9, 3.3))
    frame(few, "1. Split a sample in halves, and again")
    few.scatter(*centers.T, s=1, color="#888888", alpha=0.6, linewidths=0, rasterized=True)
    lines(few, 4, 1, "#2a78d6")
    lines(few, 2, 2.5, "#e8590c")
    frame(many, "2. Each cell has about equally many boxes")
    many.scatter(*centers.T, s=1, color="#888888", alpha=0.6, linewidths=0, rasterized=True)
    cells = lines(many, 16, 1, "#2a78d6")
    sizes = np.diff(cells.assign(boxes)[1])[:-1]
    for low, high, size in zip(*(np.clip(border, 0, 1) for border in cells.regions()), sizes):
        many.text(*(low + high) / 2, str(size), ha="center", va="center", fontsize=7, color="#2a78d6")
    frame(near, "3. Boxes on a border go to both cells")
    near.plot([0.55, 0.55], [0, 1], color="#2a78d6", linewidth=1)
    near.text(0.04, 0.94, "cell A", color="#2a78d6", va="top")
    near.text(0.6, 0.94, "cell B", color="#2a78d6", va="top")
    near.add_patch(Rectangle((0.2, 0.25), 0.5, 0.35, facecolor="#88888833", edgecolor="#888888"))
    near.add_patch(Rectangle((0.42, 0.4), 0.45, 0.35, facecolor="#88888833", edgecolor="#888888"))
    near.add_patch(Rectangle((0.42, 0.4), 0.28, 0.2, facecolor="#e8590c44", edgecolor="none"))
    near.plot(0.42, 0.4, "o", color="#e8590c", markersize=6)
    near.annotate(
        "lower corner in A:\nA reports the pair",
        (0.42, 0.4),
        (0.06, 0.04),
        fontsize=8,
        arrowprops={"arrowstyle": "-", "color": "#888888"},
    )
    figure.savefig(folder / "cells.svg", metadata={"Date": None})


def main() -> None:
    for page in pages():
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            printed = run(page, folder)
            if printed != said(page):
                raise SystemExit(f"{page.name} says {said(page)}, but its code prints {printed}")
            for picture in pictures(page):
                shutil.copy(folder / picture, GUIDE / picture)
        print(f"{page.name}: {len(printed)} lines, {len(pictures(page))} pictures")


if __name__ == "__main__":
    main()
