"""The command line, `sap`: finds, counts and shows overlapping boxes in files."""

from __future__ import annotations

import errno
import io
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from types import SimpleNamespace
from typing import Any, TypeVar

import click
import numpy as np
from numpy.typing import NDArray

from . import _crs
from ._columns import Column
from ._errors import InvalidBoxError, SweepAndPruneError
from ._file_error import FileError, printable
from ._intervals import cluster as find_clusters
from ._intervals import coverage as find_coverage
from ._intervals import merge as find_merged
from ._intervals import nearest as find_nearest
from ._join import with_missing
from ._output import output_file
from ._overlaps import Overlaps, count_overlaps, measure_overlaps, plain_corners, share_of
from ._pairs import (
    count_pairs,
    count_pairs_between,
    find_pairs,
    iter_chunks,
    iter_chunks_between,
    release_buffers,
)
from ._prepare import is_missing, refuse_inverted
from ._progress import ProgressBar
from ._signals import end_at_once, end_by_signals, held_back, remove_unfinished, signal_status
from ._tables import FORMATS, READABLE, Source, Zoned, columns_of_groups, header_of, is_text, kind_of_file, read
from ._text import Cells
from ._writers import WRITABLE, kind_of, writer

_EPILOG = f"""\b
Files: {READABLE}
(and text with .gz or .bgz); "-" is standard input: CSV, or what --from names.

Boxes are rows of numbers, min corner and then max corner, or columns with names such as minx, miny, maxx, maxy;
xmin ..; x1 ..; left, top, right, bottom; start, end. Rows are numbered from 0.

\b
Examples:
  sap pairs boxes.csv > pairs.csv
  sap pairs detections.csv --format xywh --by frame -o pairs.parquet
  sap join reads.bed genes.bed --id name
  sap join reads.bed genes.bed --how anti --rows
  sap coverage genes.gtf reads.bed --id gene_id
  sap nearest peaks.narrowPeak genes.bed -k 3
  sap count parcels.parquet --margin 10
  sap pairs boxes.parquet --memory-limit 4GB -o pairs
  sap stats boxes.npy
  sap plot boxes.csv --pairs -o picture.svg

Exit status: 0 if all went well, 1 for an error in the data or a file, 2 for wrong arguments, 130 after Ctrl-C, 143
after SIGTERM, 129 after SIGHUP, 141 if the program that reads the output ended."""

_SIDES = ("left", "right")
_CHROMOSOMES = ("chrom", "chr", "chromosome", "seqname", "seqnames", "seqid", "contig")
_COMMANDS_ELSEWHERE = {"intersect": "join", "overlap": "join", "window": "join --distance", "closest": "nearest"}
"""What bedtools and its kind call a command, and what it is here."""
_PAIRS_AT_ONCE = 2**20
"""Many, since there is work for each chunk; they take 16 MB."""
_LABELLED_AT_ONCE = 2**15
Options = SimpleNamespace
"""The options and arguments of a command."""
_Function = TypeVar("_Function", bound=Callable[..., None])
_Result = TypeVar("_Result")


def program() -> int:
    """Runs the command line as a program, which signals end."""
    try:
        try:
            end_by_signals()
            ended = main()
        finally:
            end_at_once()
            remove_unfinished()
    except KeyboardInterrupt:
        remove_unfinished()
        ended = 130  # also where the signal came before `end_by_signals`
    return signal_status() or ended


def main(arguments: Sequence[str] | None = None) -> int:
    """Runs the command line and returns the exit status."""
    try:
        sap.main(arguments, prog_name="sap")
    except SystemExit as ended:
        return ended.code if isinstance(ended.code, int) else 0
    return 0


class _Sap(click.Group):
    """Ends with the exit status that the documentation names, where click has another one."""

    def parse_args(self, context: click.Context, args: list[str]) -> list[str]:
        """Reads the arguments before the command, and shows the help."""
        return _guarded(context, lambda: super(_Sap, self).parse_args(context, args))

    def resolve_command(self, context: click.Context, args: list[str]) -> Any:
        """Finds a command by its name, or says what it is called here."""
        if args and args[0] in _COMMANDS_ELSEWHERE:
            context.fail(f"No such command {args[0]!r}: here it is sap {_COMMANDS_ELSEWHERE[args[0]]}.")
        return super().resolve_command(context, args)

    def invoke(self, context: click.Context) -> None:
        """Runs a command."""
        _guarded(context, lambda: super(_Sap, self).invoke(context))


class _Closed(io.RawIOBase):
    """Standard output that was closed before the program began: only what is written to it is an error, once."""

    _is_said = False

    def writable(self) -> bool:
        """Says so, since a text file asks."""
        return True

    def write(self, data: Any) -> int:
        """Fails. What is left is forgotten: Python writes it when the file goes, and reports errors of that."""
        if self._is_said:
            return len(data)
        self._is_said = True
        raise OSError(errno.EBADF, "it is closed")


def _forget_output() -> None:
    """What is left to write must not raise the same error when Python exits."""
    with suppress(OSError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    sys.stdout = open(os.devnull, "w")


def _guarded(context: click.Context, act: Callable[[], _Result]) -> _Result:
    try:
        if sys.stdout is None:
            sys.stdout = io.TextIOWrapper(io.BufferedWriter(_Closed()))
        result = act()
        sys.stdout.flush()
        return result
    except MemoryError:
        raise FileError(
            "the pairs do not fit in memory: sap count counts them, sap pairs -o FILE writes them in chunks"
        ) from None
    except BrokenPipeError:
        _forget_output()
        context.exit(141)
    except OSError as error:
        _forget_output()
        name = "standard output" if error.filename is None else printable(str(error.filename))
        raise FileError(f"{name} cannot be written: {error.strerror or error}") from None
    except KeyboardInterrupt as interrupt:
        click.echo(f"\nsap: {str(interrupt) or 'cancelled'}", err=True)
        context.exit(130)


@click.group(
    cls=_Sap,
    epilog=_EPILOG,
    no_args_is_help=False,  # versions of click differ in what that is
    context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 120},
)
@click.version_option(package_name="sweep-and-prune", message="sap %(version)s")
def sap() -> None:
    """Finds overlapping boxes in files."""


def _together(*options: Callable[[_Function], _Function]) -> Callable[[_Function], _Function]:
    """Several options that commands share."""

    def add(function: _Function) -> _Function:
        for option in reversed(options):
            function = option(function)
        return function

    return add


def _names(context: click.Context, parameter: click.Parameter, text: str | None) -> list[str]:
    names = [] if text is None else [name.strip() for name in text.split(",")]
    if not all(names):
        raise click.BadParameter("a name is empty")
    return names


_FORMATS = click.Choice(["xyxy", "xywh", "cxcywh"])
_CLOSED = click.Choice(["both", "left", "right", "neither"])
_boxes = _together(
    click.option(
        "--columns", metavar="A,B,..", callback=_names, help="The columns of the boxes, by name, or by number from 1."
    ),
    click.option("--from", "from_", type=click.Choice(FORMATS), help="What standard input is."),
    click.option(
        "--header/--no-header", default=None, help="Whether the first row of text names its columns; else numbers do."
    ),
    click.option("--format", type=_FORMATS, default="xyxy", help="Corners, or a corner or center and a size."),
    click.option(
        "--missing", type=click.Choice(["raise", "skip"]), default="raise", help="What to do with missing numbers."
    ),
    click.option("--closed", type=_CLOSED, help="Which ends belong to a box (.bed: left)."),
    click.option(
        "--by",
        metavar="A,B,..",
        callback=_names,
        help="Only boxes with equal values in these columns pair (.bed: chrom).",
    ),
    click.option(
        "--margin", "--distance", "margin", type=float, default=0, help="Boxes within this distance pair, too."
    ),
    click.option("--quiet", is_flag=True, help="Show no progress."),
)
_threads = click.option("--threads", type=int, default=1, metavar="N", help="-1 for one on each processor.")
_destination = _together(
    click.option("-o", "--output", metavar="FILE", help="Where to write; standard output by default."),
    click.option(
        "--to",
        type=click.Choice(WRITABLE),
        help="The format; by default the file's name tells it, or csv. bed: no header, no quotes, and a point where "
        "nothing is, as other programs for .bed read it.",
    ),
)
_output = _together(
    _destination,
    click.option(
        "--id",
        metavar="A,B,..",
        callback=_names,
        help="Write these columns, as in the files, instead of row numbers.",
    ),
    click.option("--rows", is_flag=True, help="Write all columns, as in the files, instead of row numbers."),
)
_wrap = click.option(
    "--wrap", type=float, metavar="LENGTH", help="The x axis is a circle of this length, such as 360 for longitude."
)
_overlap = _together(
    click.option(
        "--fraction",
        metavar="F[,G]",
        help="Only pairs whose overlap is at least this share of both boxes; or F of the first and G of the second.",
    ),
    click.option(
        "--measure",
        metavar="A,B,..",
        callback=_names,
        help=f"Write how much boxes overlap, too: {', '.join(Overlaps._fields)}.",
    ),
)
_sides = _together(
    click.option("--left-columns", metavar="A,B,..", callback=_names, help="The columns of the boxes of file A."),
    click.option("--right-columns", metavar="A,B,..", callback=_names, help="The columns of the boxes of file B."),
    click.option("--left-by", metavar="A,B,..", callback=_names, help="The columns to group file A by."),
    click.option("--left-id", metavar="A,B,..", callback=_names, help="The columns of file A to write."),
    click.option("--right-id", metavar="A,B,..", callback=_names, help="The columns of file B to write."),
    click.option("--right-by", metavar="A,B,..", callback=_names, help="The columns to group file B by."),
)
_disk = _together(
    click.option(
        "--memory-limit",
        metavar="SIZE",
        help="Take no more memory than this, such as 4GB: the boxes go through files (needs dask). Inputs are files of "
        "text, Parquet files or folders of them; -o names a folder of Parquet files. A command that was interrupted "
        "continues when it is repeated.",
    ),
    click.option("--workers", type=int, metavar="N", help="With --memory-limit: processes; one for each processor."),
    click.option("--spill", metavar="FOLDER", help="With --memory-limit: where boxes go meanwhile; beside the pairs."),
    click.option("--overwrite", is_flag=True, help="With --memory-limit: replace the pairs of other boxes."),
)


def _file(name: str) -> Callable[[_Function], _Function]:
    return click.argument(name, type=click.Path(allow_dash=True))


@sap.command()
@_file("file")
@_together(_boxes, _threads, _wrap, _overlap, _output, _disk)
def pairs(file: str, **options: Any) -> None:
    """Writes all pairs of overlapping boxes of a file."""
    _write_pairs(Options(files=[file], **options))


@sap.command()
@_file("a")
@_file("b")
@click.option(
    "--how",
    type=click.Choice(["inner", "left", "right", "semi", "anti"]),
    default="inner",
    help="left, right: also the boxes of that file without a pair. semi, anti: the boxes of A with any pair, or none.",
)
@_together(_boxes, _threads, _wrap, _sides, _overlap, _output, _disk)
def join(a: str, b: str, **options: Any) -> None:
    """Writes all pairs of a box of one file and a box of another.

    Geometries are their bounding boxes here. In Python, sweep_and_prune.join tests the shapes themselves.
    """
    _write_pairs(Options(files=[a, b], **options))


@sap.command()
@_file("a")
@click.argument("b", type=click.Path(allow_dash=True), required=False)
@click.option("--each", is_flag=True, help="Write a count for each box of A.")
@_together(_boxes, _threads, _wrap, _sides, _output, _disk)
def count(a: str, b: str | None, **options: Any) -> None:
    """Counts the pairs of a file, or of two."""
    given = Options(files=[a] if b is None else [a, b], **options)
    if not given.each and any((given.output, given.to, given.id, given.rows, given.left_id, given.right_id)):
        raise FileError(
            "--output, --to, --id, --left-id, --right-id and --rows are for --each: without it, the count is printed"
        )
    if given.each and given.threads != 1:
        raise FileError("--each counts on one thread: leave out --threads")
    _refuse_options_of_disk(given)
    if given.each and given.memory_limit is None:
        _write_answers(given, lambda sets, search: [("count", count_overlaps(*sets, **search))])
    elif given.memory_limit is not None:
        with _from_disk(given, to=None) as (dask, search):
            counted = dask.count_pairs if b is None else dask.count_pairs_between
            click.echo(counted(*given.files, **search))
    else:
        with _opened(given) as sources:
            click.echo(_counted(given, *_search(given, sources)))


@sap.command()
@_file("a")
@_file("b")
@_together(_boxes, _sides, _output)
def coverage(a: str, b: str, **options: Any) -> None:
    """Writes how many intervals of B overlap each of A, and how much of it they cover."""
    given = Options(files=[a, b], **options)
    if given.margin:
        raise FileError("coverage is of the intervals themselves: leave out --margin")

    def answers(sets: list[Any], search: dict[str, Any]) -> list[tuple[str, NDArray[Any]]]:
        covered = find_coverage(*sets, missing=search["missing"], by=search.get("by"))
        ends = plain_corners({"a": sets[0], "b": sets[1]}, "xyxy")[0]
        with np.errstate(all="ignore"):
            share = share_of(covered, ends[:, 1] - ends[:, 0])
        return [("count", count_overlaps(*sets, **search)), ("covered", covered), ("fraction", share)]

    _write_answers(given, answers)


@sap.command()
@_file("file")
@_together(_boxes, _output)
def cluster(file: str, **options: Any) -> None:
    """Numbers the groups of connected intervals or boxes."""
    given = Options(files=[file], **options)
    _write_answers(given, lambda sets, search: [("cluster", find_clusters(*sets, **search))])


@sap.command()
@_file("file")
@_together(_boxes, _destination)
def merge(file: str, **options: Any) -> None:
    """Writes the union of connected intervals, or the bounds of connected boxes, with their group and number.

    Intervals of .bed that only touch are not connected; with --closed both they are.
    """
    given = Options(files=[file], **options)
    kind = kind_of(given.output, given.to)
    with _opened(given) as sources:
        sets, search = _search(given, sources)
        merged = find_merged(*sets, **search)
        groups = [(name, sources[0].label(name)[merged.first]) for name in given.by or sources[0].by]
        half = merged.intervals.shape[1] // 2
        names = ["start", "end"] if half == 1 else [f"{end}{axis}" for end in ("min", "max") for axis in "xyz"[:half]]
        found = [*zip(names, merged.intervals.T), ("count", merged.counts)]
        doubled = {name for name, _ in groups} & {name for name, _ in found}
        if doubled and kind != "bed":  # which has no header
            name = min(doubled)
            raise FileError(f"--by {name}: merge writes a column of its own with this name; rename the one in the file")
        # In .bed the start and the end follow the first group.
        _write_columns(given, kind, [*groups[:1], *found, *groups[1:]] if kind == "bed" else [*groups, *found])


@sap.command()
@_file("a")
@_file("b")
@click.option("-k", type=int, default=1, help="How many boxes of B to write for each of A.")
@click.option("--max-distance", type=float, help="Leave out boxes farther away.")
@click.option("--how", type=click.Choice(["inner", "left"]), default="inner", help="left: also boxes without any.")
@_together(_boxes, _sides, _output)
def nearest(a: str, b: str, **options: Any) -> None:
    """Writes the nearest boxes of B for each box of A, with their distance."""
    given = Options(files=[a, b], **options)
    if given.margin:
        raise FileError("the nearest boxes need no margin: pass --max-distance")
    kind = kind_of(given.output, given.to)
    with _opened(given) as sources:
        sets, search = _search(given, sources)
        chosen = {name: search[name] for name in ("missing", "by", "closed") if name in search}
        found = find_nearest(sets[0], sets[1], given.k, max_distance=given.max_distance, how=given.how, **chosen)
        distances = found.distances
        if distances.dtype.kind in "iuO":  # what has no distance is written as nothing
            distances = distances.astype(object)
            distances[found.pairs[:, 1] < 0] = None
        _write_columns(given, kind, [*_labelled(given, sources, [*found.pairs.T]), ("distance", distances)])


@sap.command()
@_file("file")
@_together(_boxes, _threads)
def stats(file: str, **options: Any) -> None:
    """Describes boxes: extents, sizes, and pairs of each box."""
    given = Options(files=[file], **options)
    with _opened(given) as sources:
        _describe(given, sources)


@sap.command()
@_file("file")
@_together(_boxes, _threads)
@click.option("-o", "--output", metavar="FILE", required=True, help=".svg, .png or .pdf.")
@click.option("--pairs", is_flag=True, help="Connect the centers of overlapping boxes.")
def plot(file: str, **options: Any) -> None:
    """Draws boxes (needs matplotlib)."""
    given = Options(files=[file], **options)
    with _opened(given) as sources:
        _draw(given, sources)


@contextmanager
def _opened(options: Options) -> Iterator[list[Source]]:
    """The files. Errors of the search are raised with the place in the file."""
    for path in options.files:
        if _is_same_file(path, getattr(options, "output", None)):
            raise FileError(f"{path} has the boxes, which the output would replace: choose another file by -o")
    if options.files.count("-") > 1:
        raise FileError("standard input can be read once: pass one file by its name")
    sources = []
    for path in options.files:
        with _progress("reading", options) as progress:
            header = header_of(path, options.files, options.header)
            sources.append(read(path, options.from_, header, progress))
    try:
        yield sources
    except InvalidBoxError as error:
        raise FileError(_fault(error, sources[1] if error.argument == "b" else sources[0], options)) from None
    except (ValueError, TypeError) as error:
        names = " and ".join(source.name for source in sources)
        raise FileError(f"{names}: {error}") from None


def _fault(error: InvalidBoxError, source: Source, options: Options) -> str:
    """What is wrong with which row of a file, in the terms of the file."""
    place = source.place(error.index)
    names = _of_sides(options, "columns")[error.argument == "b"]
    has_nan = error.minimum != error.minimum or error.maximum != error.maximum
    if source.has_shapes and has_nan and not names:
        return f"{place}: it has no geometry, or an empty one; remove it, or pass --missing skip"
    if options.format != "xyxy" and not has_nan and not (source.are_corners and not names):
        names = names or source.box_columns(options.format)
        column = f", column {names[len(names) // 2 + error.axis]}" if len(names) > 1 else ""
        return f"{place}{column}: the size is {float(error.maximum - error.minimum):g}; it must be 0 or more"
    genomic = source.text.format if source.text is not None and not names else None
    if genomic is not None and has_nan:
        return (
            f"{place}{_columns_at_fault(error, source, options)}: there is no number; remove it, or pass --missing skip"
        )
    if genomic is not None:
        start = int(error.minimum) + genomic.first_position  # as in the file
        return f"{place}: the end, {error.maximum:.0f}, is before the start, {start}"
    what = str(error).split(" ", 1)[1].replace("remove it or replace it", "remove it, or pass --missing skip")
    return f"{place}{_columns_at_fault(error, source, options)}: the box {what}"


def _is_same_file(read: str, written: str | None) -> bool:
    try:
        return written is not None and os.path.isfile(written) and os.path.samefile(read, written)
    except (OSError, ValueError):  # one of them is not there, or its name is not possible
        return False


def _columns_at_fault(error: InvalidBoxError, source: Source, options: Options) -> str:
    """The names of the columns that make a box invalid, if there are names."""
    names = _of_sides(options, "columns")[error.argument == "b"] or source.box_columns(options.format)
    if len(names) < 2:
        return ""
    first, second = names[error.axis], names[error.axis + len(names) // 2]
    is_nan = [end != end for end in (error.minimum, error.maximum)]  # NumPy asks no large integer of Python
    if any(is_nan):
        return f", column {first if is_nan[0] else second}"
    return f", columns {first} and {second}"


def _progress(what: str, options: Options) -> ProgressBar:
    """A bar on standard error, if a person may see it."""
    return ProgressBar(what, None, not options.quiet and sys.stderr.isatty())


def _search(options: Options, sources: list[Source]) -> tuple[list[Any], dict[str, Any]]:
    """The sets of boxes and the options of the search."""
    columns = _of_sides(options, "columns")
    if options.format != "xyxy" and all(source.are_corners for source in sources) and not any(columns):
        raise FileError(f"{sources[0].name} is of a format that says where boxes begin and end: leave out --format")
    sets = [source.boxes(of_side, options.format) for source, of_side in zip(sources, columns)]
    by = [of_side or source.by for source, of_side in zip(sources, _of_sides(options, "by"))]
    if any(by) and not all(by):
        side = by.index([])
        way = f"--{_SIDES[side]}-by" if getattr(options, f"{_SIDES[1 - side]}_by", []) else "--by"
        raise FileError(f"{sources[side].name} has no groups, but the other file has: pass {way}")
    if len({len(of_side) for of_side in by}) > 1:
        raise FileError("--left-by and --right-by must name as many columns")
    apart = _crs.difference(*(source.crs for source in sources)) if len(sources) == 2 else None
    if apart is not None:
        raise FileError(
            f"{sources[0].name} and {sources[1].name} have different coordinate reference systems, {apart[0]} and "
            f"{apart[1]}: convert one of them"
        )
    groups = columns_of_groups(sources, by)
    if len(sources) == 2:
        _note_other_names(sources, groups)
    if not any(by):
        _note_chromosomes(options, sources)
    closed = {options.closed or source.closed for source in sources}
    if len(closed) > 1:
        raise FileError("the formats of the files differ in whether ends belong to boxes: pass --closed")
    search: dict[str, Any] = {"missing": options.missing, "closed": closed.pop()}
    search["margin"] = options.margin
    if getattr(options, "wrap", None) is not None:
        search["wrap"] = options.wrap
    if any(by):
        search["by"] = groups[0] if len(groups) == 1 else tuple(groups)
    return sets, search


def _note_other_names(sources: list[Source], groups: list[list[Column]]) -> None:
    """Says so if two files have no group in common, or if groups differ by what is before them: `chr1` and `1`."""
    for columns in zip(*groups):
        present = [column.present.tolist() for column in columns if column.codes is not None]
        names = [[one for one in of_file if one == one] for of_file in present]
        if len(names) < 2 or not all(names):
            continue
        first, second = names[0][0], names[1][0]
        fault = f"{columns[0].name} has values that differ in what is before them"
        alike = next(_alike(*names), None)
        if alike is not None:
            first, second = alike
        are_apart = not {*names[0]} & {*names[1]}
        if are_apart:
            fault = f"no boxes pair: {columns[0].name} has no value that is in both files"
        if are_apart or alike:
            shown = [repr(one)[:60] for one in (first, second)]
            places = f"{shown[0]} in {sources[0].name} and {shown[1]} in {sources[1].name}"
            click.echo(f"sap: {fault}, such as {places}", err=True)
            return


def _alike(first: list[Any], second: list[Any]) -> Iterator[tuple[str, str]]:
    """Chromosomes that only one of two files has, and that the other has with, or without, `chr` before them."""
    names = [{one for one in of_file if isinstance(one, str)} for of_file in (first, second)]
    for one in first:
        if one in names[0] and one not in names[1]:
            others = (f"chr{one}", one.removeprefix("chr"))
            yield from ((one, other) for other in others if other in names[1] - names[0])


def _note_chromosomes(options: Options, sources: list[Source]) -> None:
    """Says so if intervals have chromosomes that the search does not ask for."""
    for source in sources:
        names = [name for name in source.columns if name.lower() in _CHROMOSOMES]
        if source.text is not None and names and len(source.box_columns(options.format)) == 2:
            click.echo(
                f"sap: {source.name} has a column {names[0]}, across whose values intervals pair: pass --by {names[0]}",
                err=True,
            )
            return


def _of_sides(options: Options, name: str) -> list[list[str]]:
    """What an option says for each of two files, by itself or by those for one side."""
    both = getattr(options, name)
    sides = [getattr(options, f"{side}_{name}", []) for side in _SIDES]
    if both and any(sides):
        raise FileError(f"pass --{name}, or --left-{name} and --right-{name}")
    return [side or both for side in sides]


def _counted(options: Options, sets: list[Any], search: dict[str, Any]) -> int:
    counted: Any = count_pairs if len(sets) == 1 else count_pairs_between
    with _progress("counting", options) as progress:
        number: int = counted(*sets, threads=options.threads, progress=progress, **search)
    return number


def _chunks(
    sets: list[Any], search: dict[str, Any], number: int, progress: ProgressBar, size: int = _PAIRS_AT_ONCE
) -> Iterator[NDArray[Any]]:
    """The pairs, `number` in all, with progress: each chunk counts as done when the next one is asked for."""
    chunks: Any = iter_chunks if len(sets) == 1 else iter_chunks_between
    release_buffers()  # those of the thread that counted, since another one finds the pairs
    done = 0
    for chunk in chunks(*sets, size=size, **search):
        yield chunk
        done += len(chunk)
        progress(done / number)


def _write_pairs(options: Options) -> None:
    how = getattr(options, "how", "inner")
    _refuse_options_of_disk(options)
    if options.memory_limit is not None:
        with _from_disk(options, to=options.to) as (dask, search):
            if options.output is None:
                raise FileError("--memory-limit needs -o FOLDER: the pairs are a folder of Parquet files")
            find = dask.find_pairs if len(options.files) == 1 else dask.find_pairs_between
            try:
                find(
                    *options.files,
                    ids=_id_from_disk(options),
                    out=options.output,
                    overwrite=options.overwrite,
                    **search,
                )
            except KeyboardInterrupt:
                raise KeyboardInterrupt("cancelled; the same command continues") from None
        return
    kind = kind_of(options.output, options.to)
    least = _fractions(options.fraction)
    for name in options.measure:
        if name not in Overlaps._fields:
            raise FileError(f"--measure must be of {', '.join(Overlaps._fields)}, not {name}")
    if how in ("semi", "anti") and options.measure:
        raise FileError(f"--how {how} writes boxes, not pairs: leave out --measure")
    with _opened(options) as sources:
        sets, search = _search(options, sources)
        found = _Found(options, sets, search, least)
        if how in ("semi", "anti"):
            _write_columns(options, kind, _with_any(options, how, sources, found))
        elif how != "inner":
            _write_columns(options, kind, _with_alone(options, int(how == "right"), sources, found))
        else:
            _write_found(options, kind, sources, found)


class _Found:
    """The pairs that overlap enough, a chunk at a time: there may be more than fit in memory."""

    def __init__(self, options: Options, sets: list[Any], search: dict[str, Any], least: list[float] | None) -> None:
        self._options, self._sets, self._search, self._least = options, sets, search, least
        self.count = _counted(options, sets, search)
        """How many pairs there are, those included that overlap too little."""
        if least is not None or options.measure:
            self._corners = plain_corners(dict(zip("ab", sets)), "xyxy")  # once for all chunks

    def __iter__(self) -> Iterator[NDArray[Any]]:
        with _progress("writing", self._options) as progress:
            for pairs in _chunks(self._sets, self._search, self.count, progress):
                if self._least is not None:
                    shares = self.measured(pairs)
                    pairs = pairs[(shares.fraction_a >= self._least[0]) & (shares.fraction_b >= self._least[1])]
                yield pairs

    def measured(self, pairs: NDArray[Any]) -> Overlaps:
        """How much the boxes of pairs overlap."""
        second = self._corners[1] if len(self._sets) == 2 else None
        return measure_overlaps(self._corners[0], second, pairs, wrap=self._options.wrap)

    def columns(self, pairs: NDArray[Any]) -> list[tuple[str, NDArray[Any]]]:
        """What is to be written of how much the boxes of pairs overlap."""
        measured = self.measured(pairs) if self._options.measure else None
        return [(name, getattr(measured, name)) for name in self._options.measure]


def _write_found(options: Options, kind: str, sources: list[Source], found: _Found) -> None:
    labels = _Labels(options, sources, kind)
    names, examples = zip(*labels.examples(), *found.columns(np.empty((0, 2), np.int64)))
    count = found.count
    if kind == "npy" and options.fraction:  # whose first bytes say how many rows there are
        count = sum(map(len, found))
    with writer(options.output, kind, count, names, examples) as file:
        for chunk in found:
            measured = found.columns(chunk)
            for first in range(0, len(chunk), labels.pairs_at_once):
                part = slice(first, first + labels.pairs_at_once)
                columns = [*labels.of([*chunk[part].T]), *((name, values[part]) for name, values in measured)]
                file.write([values for _, values in columns])


def _with_any(options: Options, how: str, sources: list[Source], found: _Found) -> list[tuple[str, NDArray[Any]]]:
    """The boxes of the first file with a pair, or without one."""
    matches = np.zeros(len(sources[0]), bool)
    for pairs in found:
        matches[pairs[:, 0]] = True
    return _labelled(options, sources[:1], [np.flatnonzero(matches == (how == "semi"))])


def _with_alone(options: Options, kept: int, sources: list[Source], found: _Found) -> list[tuple[str, NDArray[Any]]]:
    """All pairs, what they measure, and the boxes of one file without any; `kept` says of which."""
    pairs = np.concatenate([np.empty((0, 2), np.int64), *found])
    order = np.lexsort((pairs[:, 1 - kept], pairs[:, kept]))
    rows = with_missing([*pairs[order].T], kept, len(sources[kept]))
    columns = _labelled(options, sources, rows)
    is_pair = (rows[0] >= 0) & (rows[1] >= 0)
    for name, values in found.columns(np.stack(rows, axis=1)[is_pair]):
        if not is_pair.all():
            values = _filled(values, is_pair)
        columns.append((name, values))
    return columns


def _fractions(text: str | None) -> list[float] | None:
    if text is None:
        return None
    try:
        given = [float(part) for part in text.split(",")]
    except ValueError:
        given = []
    if len(given) not in (1, 2) or not all(0 <= one <= 1 for one in given):
        raise FileError(f"--fraction is {text}; it must be a number from 0 to 1, or two of them with a comma")
    return [given[0], given[-1]]


class _Labels:
    """What is written for rows of the files: their numbers, some of their columns, or all."""

    def __init__(self, options: Options, sources: list[Source], kind: str) -> None:
        names = _of_sides(options, "id")
        label = Source.typed_label if kind in ("parquet", "arrow") else Source.label
        if options.rows:
            if any(names):
                raise FileError("pass --id or --rows: all columns, or some")
            names = [source.columns for source in sources]
            for source, of_source in zip(sources, names):
                if not of_source:
                    raise FileError(f"{source.name} has no named columns: leave out --rows")
        self._columns: list[list[tuple[str, Any]]] = []
        for side, source, of_side in zip("ab", [sources[0], sources[-1]], [names[0], names[len(sources) - 1]]):
            is_one = len(of_side) == 1 and not options.rows
            try:
                labels = [(side if is_one else f"{side}_{name}", label(source, name)) for name in of_side]
            except FileError as error:
                way = (
                    "; pass --left-id and --right-id for columns of one file"
                    if options.id and len(sources) == 2
                    else ""
                )
                raise FileError(f"{error.message}{way}") from None
            self._columns.append([*labels] or [(side, None)])

    @property
    def pairs_at_once(self) -> int:
        """How many pairs are written at once: fewer if each has cells of text."""
        has_values = any(values is not None for columns in self._columns for _, values in columns)
        return _LABELLED_AT_ONCE if has_values else _PAIRS_AT_ONCE

    def examples(self) -> list[tuple[str, NDArray[Any]]]:
        """Values of each column that tell its type."""
        text, number = np.array(["text"], object), np.zeros(1, np.int64)
        return [
            (name, number if values is None else text if isinstance(values, Cells) else values)
            for columns in self._columns
            for name, values in columns
        ]

    def of(self, rows: list[NDArray[Any]]) -> list[tuple[str, NDArray[Any]]]:
        """The columns for rows of the first file and of the last one; a row of -1 has no values."""
        return [
            (name, _taken(values, of_side)) for of_side, columns in zip(rows, self._columns) for name, values in columns
        ]


def _taken(values: Any, rows: NDArray[Any]) -> Any:
    is_there = rows >= 0
    if isinstance(values, Zoned):
        return values[rows]
    if is_there.all():
        return rows if values is None else np.asarray(values[rows])
    return _filled(rows[is_there] if values is None else values[rows[is_there]], is_there)


def _filled(values: NDArray[Any], is_there: NDArray[np.bool_]) -> NDArray[Any]:
    """Values where there are some, and none elsewhere."""
    has_missing = values.dtype.kind in "mM"
    filled = np.full(len(is_there), *(("NaT", values.dtype) if has_missing else (None, object)))
    filled[is_there] = values
    return filled


def _labelled(options: Options, sources: list[Source], rows: list[NDArray[Any]]) -> list[tuple[str, NDArray[Any]]]:
    return _Labels(options, sources, kind_of(options.output, options.to)).of(rows)


def _write_answers(
    options: Options, answers: Callable[[list[Any], dict[str, Any]], list[tuple[str, NDArray[Any]]]]
) -> None:
    """Writes a row for each box of the first file."""
    kind = kind_of(options.output, options.to)
    with _opened(options) as sources:
        sets, search = _search(options, sources)
        if getattr(options, "right_id", []):
            raise FileError("a row is written for each box of the first file: pass --left-id")
        found = answers(sets, search)
        _write_columns(options, kind, [*_labelled(options, sources[:1], [np.arange(len(found[0][1]))]), *found])


def _write_columns(options: Options, kind: str, columns: list[tuple[str, NDArray[Any]]]) -> None:
    names = [name for name, _ in columns]
    with writer(options.output, kind, len(columns[0][1]), names) as file:
        file.write([values for _, values in columns])


def _each_from_disk(options: Options, name: str) -> Any:
    """An option for each file: a tuple if there are two."""
    sides = [of_side or None for of_side in _of_sides(options, name)[: len(options.files)]]
    return sides[0] if len(sides) == 1 else tuple(sides)


def _id_from_disk(options: Options) -> Any:
    sides = [*_of_sides(options, "id")[: len(options.files)]]
    if any(len(of_side) > 1 for of_side in sides):
        raise FileError("--memory-limit takes one column of ids: pass one by --id")
    names = [of_side[0] if of_side else None for of_side in sides]
    return names[0] if len(names) == 1 else tuple(names)


def _refuse_options_of_disk(options: Options) -> None:
    """Raises an error for options that have no meaning in memory."""
    if options.memory_limit is None:
        given = {
            "workers": options.workers is not None,
            "spill": options.spill is not None,
            "overwrite": options.overwrite,
        }
        for name, is_given in given.items():
            if is_given:
                raise FileError(f"--{name} is for --memory-limit: pass both, or leave it out")


@contextmanager
def _from_disk(options: Options, to: str | None) -> Iterator[tuple[Any, dict[str, Any]]]:
    """What finds pairs of boxes that need not fit in memory, and the options for it."""
    try:
        with held_back():
            import dask.dataframe  # noqa: F401
            import distributed  # noqa: F401
            import pyarrow.parquet  # noqa: F401

            from . import dask as on_disk
    except ImportError:
        raise FileError("--memory-limit needs Dask: pip install 'sweep-and-prune[dask]'") from None
    for path in options.files:
        kind = kind_of_file(path)
        if path == "-" or not (kind in (None, "parquet") or is_text(path) or os.path.isdir(path)):
            raise FileError(
                f"{path}: --memory-limit reads files of text, Parquet files and folders of them: convert it first"
            )
    refused = {"--threads": options.threads != 1, "--to": to}
    refused |= {f"--{name}": getattr(options, name, None) for name in ("fraction", "measure", "rows", "each", "wrap")}
    refused |= {"--from": options.from_, "--how": getattr(options, "how", "inner") != "inner"}
    for name in (name for name, value in refused.items() if value):
        raise FileError(f"--memory-limit and {name} cannot be combined: leave {name} out")
    search = {
        "columns": _each_from_disk(options, "columns"),
        "by": _each_from_disk(options, "by"),
        "progress": not options.quiet,
        **{
            name: getattr(options, name)
            for name in ("format", "missing", "closed", "margin", "header", "memory_limit", "workers", "spill")
        },
    }
    try:
        yield on_disk, search
    except (SweepAndPruneError, TypeError, ValueError) as error:
        raise FileError(str(error).replace("overwrite=True", "--overwrite")) from None


def _describe(options: Options, sources: list[Source]) -> None:
    from rich.console import Console

    sets, search = _search(options, sources)
    boxes = _corners(sets[0])
    of_each = np.zeros(len(boxes), np.int64)
    number = _counted(options, sets, search)
    with _progress("describing", options) as progress:
        for chunk in _chunks(sets, search, number, progress):
            of_each += np.bincount(chunk.ravel(), minlength=len(boxes))
    half = boxes.shape[1] // 2
    console = Console(highlight=False)
    console.print(f"{len(boxes):,} boxes in {half}D, {number:,} pairs")
    known = boxes[~np.isnan(boxes).any(axis=1)]
    if len(known) < len(boxes):
        console.print(f"{len(boxes) - len(known):,} boxes with missing numbers")
    if len(known) == 0:
        return
    rows = []
    for axis in range(half):
        low, high = known[:, axis], known[:, axis + half]
        sizes = high - low
        of_axis = [low.min(), high.max(), sizes.min(), np.median(sizes), sizes.max()]
        rows.append(["xyz"[axis], *(f"{value:g}" for value in of_axis)])
    console.print(_table(["axis", "from", "to", "smallest size", "median", "largest"], rows))
    console.print(f"pairs of each box: {of_each.mean():.2f} on average, {of_each.max():,} at most")
    console.print(_table(["pairs", "boxes", ""], _histogram(of_each)))


def _table(names: list[str], rows: Iterable[list[Any]]) -> Any:
    from rich.table import Table

    table = Table(box=None)
    for name in names:
        table.add_column(name, justify="right", no_wrap=True)
    for row in rows:
        table.add_row(*row)
    return table


def _histogram(numbers: NDArray[np.int64], most: int = 10, width: int = 40) -> Iterator[list[Any]]:
    """Rows that show how many boxes have how many pairs."""
    from rich.progress_bar import ProgressBar

    step = max(1, -(-(int(numbers.max()) + 1) // most))
    boxes_of_row = np.bincount(numbers // step).tolist()
    for row, boxes in enumerate(boxes_of_row):
        low = row * step
        name = f"{low:,}" if step == 1 else f"{low:,} to {low + step - 1:,}"
        yield [name, f"{boxes:,}", ProgressBar(total=max(boxes_of_row), completed=boxes, width=width)]


def _corners(boxes: Any) -> NDArray[np.float64]:
    from ._arrays import box_rows

    return box_rows(boxes, "boxes", np.dtype(np.float64), 0).astype(np.float64, copy=False)


def _draw(options: Options, sources: list[Source]) -> None:
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.collections import LineCollection, PolyCollection
        from matplotlib.figure import Figure
    except ImportError:
        raise FileError("plot needs matplotlib: pip install 'sweep-and-prune[plot]'") from None
    sets, search = _search(options, sources)
    boxes = _corners(sets[0])
    kept = np.flatnonzero(~is_missing(boxes)) if options.missing == "skip" else np.arange(len(boxes))
    refuse_inverted(boxes[kept], "boxes", kept)
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
    _write_figure(figure, options.output)


def _write_figure(figure: Any, path: str) -> None:
    kind = os.path.splitext(path)[1][1:].lower()
    if not kind:
        raise FileError(f"{printable(path)} has no ending: use .svg, .png or .pdf")
    drawn = io.BytesIO()  # so that nothing is written before it is known that all can be
    try:
        figure.savefig(drawn, format=kind, bbox_inches="tight")
        with output_file(path) as (file, _):
            file.write(drawn.getbuffer())
    except BrokenPipeError:
        raise
    except (OSError, ValueError) as error:
        said = error.strerror if isinstance(error, OSError) and error.strerror else error
        raise FileError(f"{printable(path)} cannot be written: {said}") from None
