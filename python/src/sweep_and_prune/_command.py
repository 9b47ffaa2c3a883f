"""The command line, `sap`: finds, counts and shows overlapping boxes in files."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._errors import InvalidBoxError, SweepAndPruneError
from ._pairs import count_pairs, count_pairs_between, find_pairs, iter_chunks, iter_chunks_between
from ._progress import ProgressLine
from ._tables import READABLE, WRITABLE, FileError, Source, kind_of, read, writer

_EPILOG = f"""files: {READABLE} (and .csv.gz, .tsv.gz, .bed.gz); "-" is CSV from standard input

Boxes are rows of numbers, min corner and then max corner, or columns with names such as minx, miny, maxx, maxy;
xmin ..; x1 ..; left, top, right, bottom; start, end. Rows are numbered from 0.

examples:
  sap pairs boxes.csv > pairs.csv
  sap pairs detections.csv --format xywh --by frame -o pairs.parquet
  sap join reads.bed genes.bed --id name
  sap count parcels.parquet --margin 10
  sap pairs boxes.parquet --memory-limit 4GB -o pairs
  sap stats boxes.npy
  sap plot boxes.csv --pairs -o picture.svg

exit status: 0 if all went well, 1 for an error in the data or a file, 2 for wrong arguments, 130 after Ctrl-C, 141 if
the program that reads the output ended."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit status."""
    options = _parser().parse_args(arguments)
    try:
        if getattr(options, "memory_limit", None) is not None:
            _from_disk(options)
        else:
            sources = [read(path) for path in options.files]
            with _explained(sources):
                options.run(options, sources)
        sys.stdout.flush()
        return 0
    except FileError as error:
        return _fail(str(error))
    except MemoryError:
        return _fail("the pairs do not fit in memory: sap count counts them, sap pairs -o FILE writes them in chunks")
    except KeyboardInterrupt:
        is_kept = getattr(options, "memory_limit", None) is not None and options.run is _pairs
        print("\nsap: cancelled" + ("; the same command continues" if is_kept else ""), file=sys.stderr)
        return 130
    except BrokenPipeError:
        # What is left to write must not raise the same error when Python exits.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 141


def _fail(message: str) -> int:
    print(f"sap: {message}", file=sys.stderr)
    return 1


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="sap",
        description="Finds overlapping boxes in files.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="show the version and exit")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    boxes = argparse.ArgumentParser(add_help=False)
    group = boxes.add_argument_group("boxes")
    group.add_argument("--columns", type=_names, default=[], metavar="A,B,..", help="the columns of the boxes")
    group.add_argument(
        "--format", choices=("xyxy", "xywh", "cxcywh"), default="xyxy", help="corners, or a corner or center and a size"
    )
    group.add_argument("--missing", choices=("raise", "skip"), default="raise", help="what to do with missing numbers")
    group.add_argument(
        "--closed", choices=("both", "left", "right", "neither"), help="which ends belong to a box (.bed: left)"
    )
    group.add_argument("--by", metavar="COLUMN", help="only boxes with equal values pair (.bed: chrom)")
    group.add_argument(
        "--margin", "--distance", type=float, default=0, metavar="D", help="boxes within this distance pair, too"
    )
    group.add_argument("--threads", type=int, default=1, metavar="N", help="-1 for one on each processor")
    group.add_argument("--quiet", action="store_true", help="show no progress")

    disk = argparse.ArgumentParser(add_help=False)
    group = disk.add_argument_group("more boxes than fit in memory (needs dask)")
    group.add_argument(
        "--memory-limit",
        metavar="SIZE",
        help="take no more memory than this, such as 4GB: the boxes go through files. Inputs are Parquet files or "
        "folders of them; -o names a folder of Parquet files. A command that was interrupted continues when it is "
        "repeated",
    )
    group.add_argument("--workers", type=int, metavar="N", help="processes; by default, one for each processor")
    group.add_argument("--spill", metavar="FOLDER", help="where the boxes go meanwhile; by default, beside the pairs")
    group.add_argument("--overwrite", action="store_true", help="replace the pairs of other boxes in this folder")

    output = argparse.ArgumentParser(add_help=False)
    group = output.add_argument_group("output")
    group.add_argument("-o", "--output", metavar="FILE", help="where to write; standard output by default")
    group.add_argument("--to", choices=WRITABLE, help="the format; by default the file's name tells it, or csv")
    group.add_argument("--id", metavar="COLUMN", help="write these values instead of the numbers of rows")

    def add(name: str, run: Any, help: str, files: str | int, parents: list[argparse.ArgumentParser]) -> Any:
        command = commands.add_parser(name, help=help, description=help + ".", parents=parents)
        command.add_argument("files", nargs=files, metavar="FILE", help=f"{READABLE}, or - for standard input")
        command.set_defaults(run=run)
        return command

    add("pairs", _pairs, "writes all pairs of overlapping boxes of a file", 1, [boxes, output, disk])
    add("join", _pairs, "writes all pairs of a box of one file and a box of another", 2, [boxes, output, disk])
    count = add("count", _count, "counts the pairs of a file, or of two", "+", [boxes, disk])
    count.set_defaults(most=2)
    add("stats", _stats, "describes boxes: extents, sizes, and pairs of each box", 1, [boxes])
    plot = add("plot", _plot, "draws boxes (needs matplotlib)", 1, [boxes])
    plot.add_argument("-o", "--output", required=True, metavar="FILE", help=".svg, .png or .pdf")
    plot.add_argument("--pairs", action="store_true", help="connects the centers of overlapping boxes")
    return parser


class _Version(argparse.Action):
    """Looks up the version only if it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> None:
        from . import __version__

        print(f"sap {__version__}")
        parser.exit()


def _names(text: str) -> list[str]:
    return [name.strip() for name in text.split(",")]


@contextmanager
def _explained(sources: list[Source]) -> Iterator[None]:
    """Errors of the search, with the place in the file."""
    try:
        yield
    except InvalidBoxError as error:
        source = sources[1] if error.argument == "b" else sources[0]
        raise FileError(f"{source.place(error.index)}: the box {str(error).split(' ', 1)[1]}") from None
    except (ValueError, TypeError) as error:
        names = " and ".join(source.name for source in sources)
        raise FileError(f"{names}: {error}") from None


def _progress(what: str, options: argparse.Namespace) -> ProgressLine:
    """A line on standard error, if a person may see it."""
    return ProgressLine(what, None, not options.quiet and sys.stderr.isatty())


def _search(options: argparse.Namespace, sources: list[Source]) -> tuple[list[Any], dict[str, Any]]:
    """The sets of boxes and the options of the search."""
    sets = [source.boxes(options.columns, options.format) for source in sources]
    by = [options.by or source.by for source in sources]
    groups = [source.label(name) for source, name in zip(sources, by) if name is not None]
    if groups and len(groups) != len(sources):
        raise FileError(f"{sources[by.index(None)].name} has no groups, but the other file has: pass --by")
    closed = {options.closed or source.closed for source in sources}
    if len(closed) > 1:
        raise FileError("the formats of the files differ in whether ends belong to boxes: pass --closed")
    search: dict[str, Any] = {"format": options.format, "missing": options.missing, "closed": closed.pop()}
    search["margin"] = options.margin
    if groups:
        search["by"] = groups[0] if len(groups) == 1 else tuple(groups)
    return sets, search


def _counted(options: argparse.Namespace, sets: list[Any], search: dict[str, Any]) -> int:
    count: Any = count_pairs if len(sets) == 1 else count_pairs_between
    number: int = count(*sets, threads=options.threads, progress=_progress("counting", options), **search)
    return number


def _chunks(
    options: argparse.Namespace, sets: list[Any], search: dict[str, Any], count: int, what: str
) -> Iterator[NDArray[Any]]:
    """So many pairs, with progress: each chunk counts as done when the next one is asked for."""
    progress, done = _progress(what, options), 0
    # Large, since there is work for each chunk; it takes 16 MB.
    chunks: Any = iter_chunks if len(sets) == 1 else iter_chunks_between
    for chunk in chunks(*sets, size=2**20, **search):
        yield chunk
        done += len(chunk)
        progress(done / count)


def _pairs(options: argparse.Namespace, sources: list[Source]) -> None:
    kind = kind_of(options.output, options.to)
    labels = [source.label(options.id) for source in sources] if options.id else None
    sets, search = _search(options, sources)
    count = _counted(options, sets, search)
    with writer(options.output, kind, count, ("a", "b")) as file:
        for chunk in _chunks(options, sets, search, count, "writing"):
            columns = [chunk[:, 0], chunk[:, 1]]
            if labels:
                columns = [labels[0][columns[0]], labels[-1][columns[1]]]
            file.write(columns)


def _count(options: argparse.Namespace, sources: list[Source]) -> None:
    if len(sources) > options.most:
        raise FileError("count takes one file or two")
    print(_counted(options, *_search(options, sources)))


def _from_disk(options: argparse.Namespace) -> None:
    """Finds or counts pairs of boxes that need not fit in memory."""
    try:
        import distributed  # noqa: F401

        from . import dask
    except ImportError:
        raise FileError("--memory-limit needs Dask: pip install 'sweep-and-prune[dask]'") from None
    is_counted = options.run is _count
    if is_counted and len(options.files) > options.most:
        raise FileError("count takes one file or two")
    refused = {"--by": options.by, "--threads": options.threads != 1, "--to": getattr(options, "to", None)}
    for name in (name for name, value in refused.items() if value):
        raise FileError(f"--memory-limit and {name} cannot be combined: leave {name} out")
    search: dict[str, Any] = {
        "columns": options.columns or None,
        "format": options.format,
        "missing": options.missing,
        "closed": options.closed,
        "margin": options.margin,
        "memory_limit": options.memory_limit,
        "workers": options.workers,
        "spill": options.spill,
        "progress": not options.quiet,
    }
    files, is_between = options.files, len(options.files) == 2
    try:
        if is_counted:
            print((dask.count_pairs_between if is_between else dask.count_pairs)(*files, **search))
            return
        if options.output is None:
            raise FileError("--memory-limit needs -o FOLDER: the pairs are a folder of Parquet files")
        find: Any = dask.find_pairs_between if is_between else dask.find_pairs
        find(*files, ids=options.id, out=options.output, overwrite=options.overwrite, **search)
    except (SweepAndPruneError, ValueError) as error:
        raise FileError(str(error)) from None


def _stats(options: argparse.Namespace, sources: list[Source]) -> None:
    sets, search = _search(options, sources)
    boxes = _corners(sets[0], options)
    of_each = np.zeros(len(boxes), np.int64)
    count = _counted(options, sets, search)
    for chunk in _chunks(options, sets, search, count, "describing"):
        of_each += np.bincount(chunk.ravel(), minlength=len(boxes))
    half = boxes.shape[1] // 2
    print(f"{len(boxes)} boxes in {half}D, {count} pairs")
    known = boxes[~np.isnan(boxes).any(axis=1)]
    if len(known) < len(boxes):
        print(f"{len(boxes) - len(known)} boxes with missing numbers")
    if len(known) == 0:
        return
    sizes = known[:, half:] - known[:, :half]
    for axis in range(half):
        least, middle, most = sizes[:, axis].min(), np.median(sizes[:, axis]), sizes[:, axis].max()
        print(
            f"{'xyz'[axis]}: from {known[:, axis].min():g} to {known[:, axis + half].max():g}; "
            f"sizes {least:g} to {most:g}, median {middle:g}"
        )
    print(f"pairs of each box: {of_each.mean():.2f} on average, {of_each.max()} at most")
    for line in _histogram(of_each):
        print(line)


def _corners(boxes: Any, options: argparse.Namespace) -> NDArray[np.float64]:
    from ._arrays import box_array

    return box_array(boxes, "boxes", 0, options.format).astype(np.float64)


def _histogram(numbers: NDArray[np.int64], rows: int = 10, width: int = 40) -> Iterator[str]:
    """Lines that show how many boxes have how many pairs."""
    step = max(1, -(-(int(numbers.max()) + 1) // rows))
    counts = np.bincount(numbers // step)
    names = [f"{low}" if step == 1 else f"{low} to {low + step - 1}" for low in range(0, step * len(counts), step)]
    for name, count in zip(names, counts.tolist()):
        bar = "#" * max(round(width * count / int(counts.max())), 1 if count else 0)
        yield f"{name:>{max(map(len, names))}} | {bar} {count}"


def _plot(options: argparse.Namespace, sources: list[Source]) -> None:
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.collections import LineCollection, PolyCollection
        from matplotlib.figure import Figure
    except ImportError:
        raise FileError("plot needs matplotlib: pip install 'sweep-and-prune[plot]'") from None
    sets, search = _search(options, sources)
    boxes = _corners(sets[0], options)
    pairs = find_pairs(sets[0], threads=options.threads, **search) if options.pairs else np.empty((0, 2), np.int64)
    half = boxes.shape[1] // 2
    if half == 1:  # each on a line of its own
        place = np.arange(len(boxes))
        boxes = np.column_stack([boxes[:, 0], place - 0.4, boxes[:, 1], place + 0.4])
    elif half == 3:
        boxes = boxes[:, [0, 1, 3, 4]]
    x0, y0, x1, y1 = boxes.T
    figure = Figure(figsize=(8, 8))
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    shapes = np.stack([np.column_stack(point) for point in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))], axis=1)
    axes.add_collection(PolyCollection(list(shapes), facecolors="#4c78a833", edgecolors="#4c78a8", linewidths=0.5))
    centers = np.column_stack([(x0 + x1) / 2, (y0 + y1) / 2])
    if len(pairs):
        axes.add_collection(LineCollection(list(centers[pairs]), colors="#e45756", linewidths=0.7))
    axes.autoscale_view()
    if half > 1:
        axes.set_aspect("equal")
    axes.set_title(f"{len(boxes)} boxes" + (f", {len(pairs)} pairs" if options.pairs else ""))
    try:
        figure.savefig(options.output)
    except (OSError, ValueError) as error:
        raise FileError(f"{options.output} cannot be written: {error}") from None
