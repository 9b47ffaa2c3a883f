"""Writes the API reference of the package to a folder: `python python/docs.py FOLDER`, in the environment of
`python/requirements.txt`. The pages are static and load nothing from other sites. The guide has a notebook beside each
page."""

import re
import shutil
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from types import ModuleType
from typing import ForwardRef

import jupytext
import pdoc
import pdoc.doc
import pdoc.render
from notebooks import GUIDE, notebook, pages
from pygments.formatters import HtmlFormatter  # type: ignore[import-untyped]

DARK = """
:root { --pdoc-background: #191817; color-scheme: dark; }
.pdoc {
  --text: #e6e3dd; --muted: #a09a90; --link: #8ab4f8; --link-hover: #aecbfa; --code: #252422; --active: #5a4a00;
  --accent: #2b2a28; --accent2: #55524d; --nav-hover: rgba(255, 255, 255, 0.08);
  --name: #79c0ff; --def: #7ee787; --annotation: #7ee787;
}
"""


class AsWritten:
    """An annotation as it is written in the code: `ArrayLike`, not the ten types that it stands for."""

    def __init__(self, annotation: object) -> None:
        self.text = annotation.__forward_arg__ if isinstance(annotation, ForwardRef) else str(annotation)

    def __repr__(self) -> str:
        return self.text


def as_written(annotation: object, *_: object) -> object:
    return AsWritten(annotation) if isinstance(annotation, (str, ForwardRef)) else annotation


def guide(folder: Path) -> Path:
    """The pages of docs/guide as a package in this folder, whose docstrings they are: pdoc describes packages."""
    package = folder / "guide"
    package.mkdir()
    for page in pages():
        is_first = page.stem == "README"
        text = page.read_text(encoding="utf-8")
        if not is_first:
            title, rest = text.split("\n", 1)
            text = f"{title}\n\n[As a notebook]({page.stem}.ipynb)\n{rest}"
        text = text.replace("../../python/README.md", f"{'' if is_first else '../'}sweep_and_prune.html")
        text = re.sub(r"\]\(README\.md\)", "](../guide.html)", text)
        text = re.sub(
            r"\]\(([\w-]+)\.md\)",
            lambda link: f"]({'guide/' if is_first else ''}{link[1].replace('-', '_')}.html)",
            text,
        )
        name = "__init__" if is_first else page.stem.replace("-", "_")
        code = f'{text!r}\n__docformat__ = "markdown"\n'
        (package / f"{name}.py").write_text(code, encoding="utf-8")
    for picture in GUIDE.glob("*.svg"):
        shutil.copy(picture, package)
    return package


def write_notebooks(folder: Path) -> None:
    """Each page of the guide as a notebook, beside the page."""
    for page in pages():
        if page.stem != "README":
            jupytext.write(notebook(page), folder / f"{page.stem}.ipynb")


package = Path(__file__).parent / "src/sweep_and_prune"
sys.path.insert(0, str(package.parent))
if not list(package.glob("_native*.so")) + list(package.glob("_native*.pyd")):
    # Everything public is written in Python, so the compiled part is not needed to describe it.
    stand_in = ModuleType("sweep_and_prune._native")
    stand_in.__getattr__ = lambda name: object  # type: ignore[method-assign]
    sys.modules[stand_in.__name__] = stand_in

pdoc.doc.safe_eval_type = as_written  # type: ignore[assignment, attr-defined]
with TemporaryDirectory() as template, TemporaryDirectory() as folder:
    highlighting = HtmlFormatter(style="github-dark").get_style_defs(".pdoc-code")
    css = f".pdoc img {{ max-width: 100% }} @media (prefers-color-scheme: dark) {{ {DARK} {highlighting} }}"
    (Path(template) / "custom.css").write_text(css, encoding="utf-8")
    footer = "sweep-and-prune for Python"
    pdoc.render.configure(
        docformat="google", search=False, show_source=False, footer_text=footer, template_directory=Path(template)
    )
    import sweep_and_prune

    assert sweep_and_prune.__doc__
    sweep_and_prune.__doc__ += (
        "\n\nThe [guide](guide.html) begins with your problem: detections, tracks, joins, meshes, clusters ...\n"
    )
    modules = "sweep_and_prune", "sweep_and_prune.dask", guide(Path(folder))
    pdoc.pdoc(*modules, output_directory=Path(sys.argv[1]))
    write_notebooks(Path(sys.argv[1]) / "guide")
