"""Writes the API reference of the package to a folder: `python python/docs.py FOLDER`, in the environment of
`python/requirements.txt`. Static pages that load nothing from elsewhere."""

import sys
from pathlib import Path
from types import ModuleType
from typing import ForwardRef

import pdoc
import pdoc.doc
import pdoc.render


class AsWritten:
    """An annotation as it stands in the code: `ArrayLike`, not the ten types that this is short for."""

    def __init__(self, annotation: object) -> None:
        self.text = annotation.__forward_arg__ if isinstance(annotation, ForwardRef) else str(annotation)

    def __repr__(self) -> str:
        return self.text


def as_written(annotation: object, *_: object) -> object:
    return AsWritten(annotation) if isinstance(annotation, (str, ForwardRef)) else annotation


package = Path(__file__).parent / "sweep_and_prune"
sys.path.insert(0, str(package.parent))
if not list(package.glob("_native*.so")) + list(package.glob("_native*.pyd")):
    # All that is public is written in Python: to describe it, the compiled part need not be there.
    stand_in = ModuleType("sweep_and_prune._native")
    stand_in.Finder = stand_in.World = object  # type: ignore[attr-defined]
    sys.modules[stand_in.__name__] = stand_in

pdoc.doc.safe_eval_type = as_written  # type: ignore[assignment, attr-defined]
pdoc.render.configure(docformat="google", search=False, show_source=False, footer_text="sweep-and-prune for Python")
pdoc.pdoc("sweep_and_prune", output_directory=Path(sys.argv[1]))
