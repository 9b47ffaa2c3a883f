"""Joins data frames: rows of two tables whose boxes overlap, or whose geometries fulfill a predicate."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Hashable, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import thread_count
from ._columns import group_codes, is_rounded
from ._crs import difference
from ._inputs import Raw, chosen_boxes, listed, named_column, raw_boxes
from ._native import in_order, processors
from ._overlaps import Overlaps, measure_overlaps
from ._pairs import Progress, find_pairs_between
from ._wrap import checked_wrap

_FLIPPED = {"contains": "within", "covers": "covered_by", "within": "contains", "covered_by": "covers"}
_SYMMETRIC = ("intersects", "touches", "overlaps", "dwithin")
_PREDICATES = (*_FLIPPED, *_SYMMETRIC, "contains_properly", "crosses")

_MEASURES = ("size", "fraction_left", "fraction_right", "iou")

_OF_POINTS = {"intersects": "intersects_xy", "contains": "contains_xy"}
"""The predicates that shapely tests faster on coordinates than on points."""

_FEW_POINTS = 5
"""A geometry with so few points gains nothing by being prepared."""

_VERTICES = 8
"""How many vertices of a geometry are candidates to be looked up in a polygon."""

_ROUNDING = 1e-9
"""Squares of distances that differ by less than this share are compared by shapely, which rounds in its own way."""

_BLOCK = 20_000
"""How many candidates are tested at once: few enough for the cache, and enough for each thread."""

_MOST_TURNS = 100
"""With `wrap`, geometries are moved by at most this many turns of the circle."""

Names = Union[Hashable, Sequence[Hashable]]
"""The name of a column, or a list of names. (Those of pandas may be of any type.)"""
Indices = NDArray[np.int64]
Groups = NDArray[np.float64]


def join(
    left: Any,
    right: Any,
    how: str = "inner",
    predicate: str = "intersects",
    *,
    distance: ArrayLike | None = None,
    by: Names | None = None,
    on_attribute: Names | None = None,
    left_by: Names | None = None,
    right_by: Names | None = None,
    left_columns: Sequence[Hashable] | None = None,
    right_columns: Sequence[Hashable] | None = None,
    fraction: float | tuple[float, float] | None = None,
    measures: list[str] | None = None,
    wrap: float | None = None,
    lsuffix: str = "left",
    rsuffix: str = "right",
    format: str = "xyxy",
    closed: str | None = None,
    threads: int | None = 1,
    progress: Progress | None = None,
) -> Any:
    """Joins two data frames: a row for each pair of rows whose boxes or geometries overlap.

    For GeoDataFrames the result has the rows, columns and index of `geopandas.sjoin`. Candidates are found by
    `find_pairs_between`, and shapely tests the exact predicate on them. For data frames of pandas or polars without
    geometries, the boxes are columns such as `minx, miny, maxx, maxy` or `start, end`. Frames of polars have no index,
    so the result has the columns of both frames only.

    The rows are sorted by the position of the left row and then by that of the right row; with `how="right"` the
    other way around. Rows whose geometry is empty or `None`, or whose box has a NaN, match nothing. Time O(n log n +
    candidates), memory O(n + candidates). Needs pandas or polars, and geopandas for geometries.

    Args:
        left: a `DataFrame` of pandas or polars, or a `GeoDataFrame`.
        right: another of the same kind.
        how: `"inner"` keeps the rows that match. `"left"` and `"right"` keep all rows of that frame, with missing
            values where nothing matches. The index and the geometry are those of the left frame, with `"right"`
            those of the right one. `"semi"` returns the left rows that match any, once and without columns of the
            right frame; `"anti"` those that match none.
        predicate: `predicate(left, right)` of shapely: `"intersects"`, `"contains"`, `"within"`, `"covers"`,
            `"covered_by"`, `"contains_properly"`, `"crosses"`, `"overlaps"`, `"touches"` or `"dwithin"`. Boxes
            without geometries know only `"intersects"`.
        distance: of geometries, with `"dwithin"` and only then: the largest distance, in the units of the coordinates;
            a number, or one for each left row. Of boxes without geometries it is the `margin` of `find_pairs_between`,
            on each axis, and goes with `"intersects"`.
        by: the name of a column that both frames have, or a list of names: only rows with equal values match, and the
            result has these columns once. A missing value equals none. A tuple, which is one for each set in
            `find_pairs_between`, is refused: pass `left_by` and `right_by`.
        on_attribute: what `geopandas.sjoin` calls `by`.
        left_by: with `right_by`, the name or a list of names of columns of the left frame; the result has the columns
            of both.
        right_by: names of as many columns of the right frame, which must be equal to those.
        left_columns: of boxes without geometries: the columns of the left boxes, min corner and then max corner. By
            default, those with known names.
        right_columns: the same for the right frame.
        fraction: only pairs whose overlap is at least this share of both boxes or geometries; two numbers are for the
            left and for the right one. What has no size has no share.
        measures: columns to add for each pair, which `measure_overlaps` describes: `"size"`, `"fraction_left"`,
            `"fraction_right"` and `"iou"`. Of geometries these are areas, which shapely computes, in the units of the
            coordinates: lines and points have none.
        wrap: the length of the x axis if it is a circle, such as 360 for longitude. Boxes may cross its end, as in
            `find_pairs`. A geometry pairs with those that are one turn or several away, too; it must not cross the end
            by itself, but may have a part on each side of it, or coordinates beyond it.
        lsuffix: what is added, after `_`, to names of left columns that the right frame has too.
        rsuffix: the same for right columns, and for the column that has the index of the right frame.
        format: of boxes without geometries: `"xyxy"`, `"xywh"` or `"cxcywh"`.
        closed: of boxes without geometries: `"both"`, `"left"`, `"right"` or `"neither"`.
        threads: how many to use at most, for the search and for the tests of shapely; -1 for one on each processor.
        progress: called with the share of the search for candidates that is done, from 0 to 1.

    Returns:
        A frame of the kind that was passed.

    Raises:
        ValueError: for frames of different coordinate reference systems, unknown options, and boxes that are not
            recognized.
        InvalidBoxError: for the first box that is inverted.
        TypeError: for anything but two frames of the same kind.

    >>> import pandas
    >>> import sweep_and_prune as sap
    >>> genes = pandas.DataFrame({"start": [0, 50], "end": [10, 80], "gene": ["a", "b"]})
    >>> reads = pandas.DataFrame({"start": [5, 9, 90], "end": [7, 60, 95]})
    >>> sap.join(genes, reads)[["gene", "index_right", "start_right", "end_right"]]
      gene  index_right  start_right  end_right
    0    a            0            5          7
    0    a            1            9         60
    1    b            1            9         60
    """
    is_polars = all(_is_polars(frame) for frame in (left, right))
    has_geometries = [_has_geometries(frame) for frame in (left, right)]
    is_pandas = all(hasattr(frame, "iloc") and getattr(frame, "ndim", 0) == 2 for frame in (left, right))
    if not (is_polars or is_pandas) or has_geometries[0] != has_geometries[1]:
        for name, frame in (("left", left), ("right", right)):
            way = "collect" if hasattr(frame, "collect") else "df" if hasattr(frame, "df") else ""
            if way:
                kind = type(frame).__name__
                raise TypeError(f"{name} is a {kind}, which has no rows yet: pass what its {way}() returns")
        kinds = " and ".join(map(_kind, (left, right)))
        raise TypeError(f"left and right must be two DataFrames of pandas or polars or two GeoDataFrames, not {kinds}")
    if how not in ("inner", "left", "right", "semi", "anti"):
        raise ValueError(f'how must be "inner", "left", "right", "semi" or "anti", not {how!r}')
    if predicate not in _PREDICATES:
        raise ValueError(f"predicate must be one of {', '.join(_PREDICATES)}, not {predicate!r}")
    for name, suffix in (("lsuffix", lsuffix), ("rsuffix", rsuffix)):
        if not isinstance(suffix, str):
            raise TypeError(f"{name} must be a string, not {suffix!r}")
    if by is not None and on_attribute is not None:
        raise ValueError("by and on_attribute are the same: pass one of them")
    if isinstance(by, tuple):  # one for each set elsewhere, but a list in geopandas, and so in `on_attribute`
        raise ValueError(
            "by must be a name or a list of names of columns that both frames have, not a tuple: "
            "pass a column of each frame as left_by and right_by"
        )
    columns = _listed_names(on_attribute if by is None else by)
    of_sides = [_listed_names(left_by), _listed_names(right_by)]
    if len(of_sides[0]) != len(of_sides[1]):
        raise ValueError("left_by and right_by must name as many columns")
    groups = _groups(left, right, columns + of_sides[0], columns + of_sides[1])
    least = None if fraction is None else _two_fractions(fraction)
    added = _measure_names(measures)
    if added and how in ("semi", "anti"):
        raise ValueError(f'how="{how}" returns rows of the left frame, not pairs: leave out measures')
    if has_geometries[0]:
        _check_distance(predicate, distance)
        apart = difference(left.crs, right.crs)
        if apart is not None:
            raise ValueError(
                f"left and right have different coordinate reference systems, {apart[0]} and {apart[1]}: "
                "pass right.to_crs(left.crs)"
            )
        if closed is not None or format != "xyxy":
            raise ValueError("closed and format are for boxes; geometries have neither")
        if left_columns is not None or right_columns is not None:
            raise ValueError("left_columns and right_columns are for boxes without geometries")
        with np.errstate(all="ignore"):  # of shapely's numbers, too
            sides = [_side(np.asarray(frame.geometry.array, object)) for frame in (left, right)]
            found = _of_geometries(sides, predicate, distance, groups, threads, progress, wrap)
        shapes = [side.shapes for side in sides]

        def measured(rows: Indices) -> Overlaps:
            return _measured_geometries(shapes, rows, wrap)

    else:
        if predicate != "intersects":
            raise ValueError(f'predicate "{predicate}" needs geometries; boxes know only "intersects"')
        boxes: list[Any] = [
            frame if names is None else _chosen(frame, names, name, format)
            for name, frame, names in (("left", left, left_columns), ("right", right, right_columns))
        ]
        if left_columns is not None or right_columns is not None:
            boxes = [raw_boxes(one, name, "xyxy" if isinstance(one, Raw) else format) for one, name in zip(boxes, "ab")]
            format = "xyxy"
        pairs = find_pairs_between(
            *boxes,
            threads=threads,
            format=format,
            closed=closed,
            missing="skip",
            by=groups,
            margin=0 if distance is None else distance,
            wrap=wrap,
            progress=progress,
        )
        found = pairs[:, 0], pairs[:, 1]

        def measured(rows: Indices) -> Overlaps:
            return measure_overlaps(boxes[0], boxes[1], rows, format=format, wrap=wrap)

    if least is not None:
        shares = measured(np.stack(found, axis=1))
        is_enough = (shares.fraction_a >= least[0]) & (shares.fraction_b >= least[1])
        found = found[0][is_enough], found[1][is_enough]
    if how in ("semi", "anti"):
        matches = np.zeros(len(left), bool)
        matches[found[0]] = True
        rows_of_left = np.flatnonzero(matches == (how == "semi"))
        return left[rows_of_left] if is_polars else left.take(rows_of_left)
    rows = list(in_order(*found, len(left)))
    if how != "inner":
        rows = with_missing(rows, how == "right", len(right if how == "right" else left))
    joined = (_frame_of_polars if is_polars else _frame)(left, right, rows, how, columns, (lsuffix, rsuffix))
    return _with_measures(joined, added, rows, measured) if added else joined


def _chosen(frame: Any, names: Any, name: str, format: str) -> Raw:
    """The boxes in columns that a user names."""
    if not isinstance(names, (list, tuple)) or not names:
        raise TypeError(f"{name}_columns must be a list of names of columns, not {names!r}")
    own = list(frame.columns)
    for column in names:
        if own.count(column) != 1:
            fault = "several columns of that name" if column in own else "no such column"
            raise ValueError(f"{name}_columns has {column!r}, but {name} has {fault}; {listed(own)}")
    return chosen_boxes(frame.__getitem__, names, name, format)


def _listed_names(names: Any) -> list[Any]:
    """The names in a list, or a single one."""
    is_one = isinstance(names, str) or not hasattr(names, "__iter__")
    return [] if names is None else [names] if is_one else list(names)


def _two_fractions(fraction: Any) -> tuple[float, float]:
    both = np.atleast_1d(np.asarray(fraction, np.float64))
    if both.shape not in ((1,), (2,)) or not ((both >= 0) & (both <= 1)).all():
        raise ValueError(f"fraction is {fraction}; it must be a number from 0 to 1, or two of them")
    return float(both[0]), float(both[-1])


def _measure_names(measures: Any) -> list[str]:
    names = _listed_names(measures)
    for name in names:
        if name not in _MEASURES:
            raise ValueError(f"measures must be of {', '.join(_MEASURES)}, not {name!r}")
    return names


def _with_measures(joined: Any, names: list[str], rows: list[Indices], measured: Callable[[Indices], Overlaps]) -> Any:
    """The joined frame with columns that measure its pairs; they are missing where a row has no match."""
    is_pair = (rows[0] >= 0) & (rows[1] >= 0)
    found = measured(np.stack(rows, axis=1)[is_pair])
    for name in names:
        if name in joined.columns:
            raise ValueError(f"{name!r} cannot be a column of left or right: measures adds it")
        values = found[_MEASURES.index(name)]
        if not is_pair.all():
            if values.dtype.kind in "iu":
                values = values.astype(object if is_rounded(values) else np.float64)
            filled = np.full(len(is_pair), np.timedelta64("NaT") if values.dtype.kind == "m" else np.nan, values.dtype)
            filled[is_pair] = values
            values = filled
        if _is_polars(joined):
            import polars

            series = polars.Series(name, values.tolist() if values.dtype.kind == "O" else values, nan_to_null=True)
            joined = joined.with_columns(series)
        else:
            joined[name] = values
    return joined


def _kind(frame: Any) -> str:
    """What a frame is, in words: data frames of several libraries have the same name."""
    kind = type(frame)
    return (
        f"a {kind.__name__} of {kind.__module__.split('.')[0]}" if hasattr(frame, "columns") else f"a {kind.__name__}"
    )


def _is_polars(frame: Any) -> bool:
    """Whether it is a `DataFrame` of polars, and not a lazy one."""
    return type(frame).__module__.split(".")[0] == "polars" and hasattr(frame, "height")


def _has_geometries(frame: Any) -> bool:
    """Whether it is a `GeoDataFrame`. (Its class is asked, since the frame would compute its bounds.)"""
    return hasattr(type(frame), "total_bounds") and hasattr(type(frame), "geometry")


def _check_distance(predicate: str, distance: ArrayLike | None) -> None:
    if (predicate == "dwithin") != (distance is not None):
        raise ValueError('distance must be passed with predicate="dwithin", and only with it')


def _groups(left: Any, right: Any, of_left: list[Any], of_right: list[Any]) -> tuple[Groups, Groups] | None:
    """A number for the values of each row in some columns."""
    if not of_left:
        return None
    named = ("left", left, of_left), ("right", right, of_right)
    sides = [[named_column(frame, column, name) for column in columns] for name, frame, columns in named]
    left_codes, right_codes = group_codes(sides, ["left", "right"])
    # A row whose value is missing matches none.
    return np.where(left_codes < 0, np.nan, left_codes), np.where(right_codes < 0, np.nan, right_codes)


def _of_geometries(
    sides: list[_Side],
    predicate: str,
    distance: ArrayLike | None,
    groups: tuple[Groups, Groups] | None,
    threads: int | None,
    progress: Progress | None,
    wrap: float | None,
) -> tuple[Indices, Indices]:
    distances = None
    if distance is not None:
        rows = len(sides[0].shapes)
        try:
            distances = np.broadcast_to(np.asarray(distance, np.float64), rows)
        except ValueError:
            raise ValueError(f"distance must be a number or {rows} of them, one for each left row") from None
        wrong = np.flatnonzero(~(distances >= 0))
        if len(wrong):
            place = "distance" if np.ndim(distance) == 0 else f"distance[{wrong[0]}]"
            raise ValueError(f"{place} is {distances[wrong[0]]}; it must be 0 or more")
    if wrap is None:
        return _of_turn(sides, predicate, distances, groups, threads, progress)
    found = [
        _of_turn([sides[0], _moved(sides[1], turn)], predicate, distances, groups, threads, progress)
        for turn in _turns(sides, distances, checked_wrap(wrap))
    ]
    pairs = np.unique(np.concatenate([np.empty((0, 2), np.int64), *(np.stack(one, axis=1) for one in found)]), axis=0)
    return pairs[:, 0], pairs[:, 1]


def _turns(sides: list[_Side], distances: NDArray[np.float64] | None, wrap: float) -> list[float]:
    """How far the right geometries are moved, so that they may meet left ones that are some turns away."""
    x = [side.bounds[:, [0, 2]] for side in sides]
    x = [ends[np.isfinite(ends).all(axis=1)] for ends in x]
    if not all(map(len, x)):
        return []
    most = 0.0 if distances is None else float(distances.max(initial=0))
    first = math.ceil((float(x[0].min()) - most - float(x[1].max())) / wrap)
    last = math.floor((float(x[0].max()) + most - float(x[1].min())) / wrap)
    if last - first >= _MOST_TURNS:
        raise ValueError(f"the coordinates go {last - first} times around a circle of {wrap}: is wrap in their units?")
    return [turn * wrap for turn in range(first, last + 1)]


def _moved(side: _Side, by: float) -> _Side:
    """The geometries moved along the x axis."""
    import shapely

    if by == 0:
        return side
    shapes = shapely.transform(side.shapes, lambda points: points + [by, 0])
    return side._replace(shapes=shapes, bounds=side.bounds + [by, 0, by, 0])


def _measured_geometries(shapes: list[NDArray[Any]], rows: Indices, wrap: float | None) -> Overlaps:
    """The areas that pairs of geometries share."""
    import shapely

    first, second = (of_side[at] for of_side, at in zip(shapes, rows.T))
    with np.errstate(all="ignore"):
        areas = [np.asarray(shapely.area(of_side), np.float64) for of_side in shapes]
        of_a, of_b = areas[0][rows[:, 0]], areas[1][rows[:, 1]]
        turns = [0.0] if wrap is None else _turns([_side(first), _side(second)], None, checked_wrap(wrap))
        shared = np.zeros(len(rows))
        try:
            for turn in turns:
                moved = shapely.transform(second, lambda points, turn=turn: points + [turn, 0]) if turn else second
                shared += shapely.area(shapely.intersection(first, moved))
        except shapely.errors.GEOSException as error:
            message = f"{_first_invalid(shapes, rows)} ({error}): pass frames with geometry.make_valid()"
            raise ValueError(message) from None
        return Overlaps(shared, shared / of_a, shared / of_b, shared / (of_a + of_b - shared))


def _first_invalid(shapes: list[NDArray[Any]], rows: Indices) -> str:
    import shapely

    for name, of_side, of_pairs in zip(("left", "right"), shapes, rows.T):
        used = np.unique(of_pairs)
        wrong = used[~shapely.is_valid(of_side[used])]
        if len(wrong):
            return f"{name} row {wrong[0]} (the first is 0) is not a valid geometry, whose overlaps have no area"
    return "geometries cannot be intersected"


def _of_turn(
    sides: list[_Side],
    predicate: str,
    distances: NDArray[np.float64] | None,
    groups: tuple[Groups, Groups] | None,
    threads: int | None,
    progress: Progress | None,
) -> tuple[Indices, Indices]:
    """The pairs of geometries as they are."""
    bounds = [side.bounds for side in sides]
    if distances is not None:
        bounds[0] = _extended(bounds[0], distances)
    pairs = find_pairs_between(*bounds, threads=threads, missing="skip", by=groups, progress=progress)
    first, second = pairs[:, 0], pairs[:, 1]
    if len(pairs) == 0:
        return first, second
    certain = first[:0], second[:0]
    if predicate == "intersects":
        # Two that fill their bounds intersect if their bounds do: no test is needed.
        full = [_fill_their_bounds(side) for side in sides]
        is_certain = full[0][first] & full[1][second]
        certain = first[is_certain], second[is_certain]
        first, second = first[~is_certain], second[~is_certain]
    if len(first):
        first, second = _tested(sides, predicate, distances, (first, second), threads)
    return np.concatenate([certain[0], first]), np.concatenate([certain[1], second])


class _Side(NamedTuple):
    """The geometries of one frame."""

    shapes: NDArray[Any]
    bounds: NDArray[np.float64]
    sizes: NDArray[Any]
    """The number of vertices of each."""
    are_points: bool
    """Whether all of them are points."""


def _side(shapes: NDArray[Any]) -> _Side:
    import shapely

    bounds = np.asarray(shapely.bounds(shapes), np.float64).reshape(-1, 4)
    are_points = bool((shapely.get_type_id(shapes) == shapely.GeometryType.POINT).all())
    sizes = np.ones(len(shapes), np.intp) if are_points else shapely.get_num_coordinates(shapes)
    return _Side(shapes, bounds, sizes, are_points)


def _fill_their_bounds(side: _Side) -> NDArray[np.bool_]:
    """Whether geometries are points, or rectangles along the axes."""
    import shapely

    if side.are_points:
        return np.ones(len(side.shapes), bool)
    types = shapely.get_type_id(side.shapes)
    full = np.asarray(types == shapely.GeometryType.POINT)
    rows = np.flatnonzero((types == shapely.GeometryType.POLYGON) & (side.sizes == 5))
    coordinates = shapely.get_coordinates(side.shapes[rows] if len(rows) < len(full) else side.shapes)
    x0, y0, x1, y1, x2, y2, x3, y3, _, _ = np.ascontiguousarray(coordinates.reshape(-1, 10).T)
    begins_upright = (x0 == x1) & (x2 == x3) & (y1 == y2) & (y3 == y0)
    begins_flat = (y0 == y1) & (y2 == y3) & (x1 == x2) & (x3 == x0)
    full[rows] = (begins_upright | begins_flat) & (x0 != x2) & (y0 != y2)
    return full


def _tested(
    sides: list[_Side],
    predicate: str,
    distances: NDArray[np.float64] | None,
    candidates: tuple[Indices, Indices],
    threads: int | None,
) -> tuple[Indices, Indices]:
    """The candidates that fulfill a predicate."""
    import shapely

    # A prepared geometry is tested faster. Those that have more points are prepared, if they may come first.
    is_flipped = (predicate in _FLIPPED or predicate in _SYMMETRIC) and bool(
        sides[1].sizes[candidates[1]].mean() > sides[0].sizes[candidates[0]].mean()
    )
    name = _FLIPPED.get(predicate, predicate) if is_flipped else predicate
    side_a, side_b = reversed(sides) if is_flipped else sides
    a, b = side_a.shapes, side_b.shapes
    # All tests of a geometry follow each other, while it is in the cache.
    of_a, of_b = in_order(candidates[is_flipped], candidates[not is_flipped], len(a))
    is_used = np.zeros(len(a), bool)
    is_used[of_a] = True
    # Copies, since another thread may test the user's own, and those that are prepared are not for several threads.
    own = is_used & ((side_a.sizes > _FEW_POINTS) | shapely.is_prepared(a))
    a = a.copy()
    a[own] = shapely.set_srid(a[own], 0)  # a clone
    used = np.flatnonzero(own & (side_a.sizes > _FEW_POINTS))
    if distances is not None:
        limits = distances[of_b if is_flipped else of_a]
        are_points = side_a.are_points and side_b.are_points
        # Complex numbers, since NumPy gathers them several times as fast as rows of two numbers.
        of_points = (side_a, side_b) if are_points else ()
        points = [side.bounds[:, :2].copy().view(np.complex128)[:, 0] for side in of_points]

        def test(rows: slice) -> NDArray[np.bool_]:
            first, second, limit = of_a[rows], of_b[rows], limits[rows]
            kept, rest = _near(points[0][first], points[1][second], limit) if are_points else _none_of(first)
            kept[rest] = shapely.dwithin(a[first[rest]], b[second[rest]], limit[rest])
            return kept

    elif name in _OF_POINTS and side_b.are_points:
        x, y = side_b.bounds[:, 0], side_b.bounds[:, 1]

        def test(rows: slice) -> NDArray[np.bool_]:
            return np.asarray(getattr(shapely, _OF_POINTS[name])(a[of_a[rows]], x[of_b[rows]], y[of_b[rows]]))

    elif name == "intersects" and (shapely.get_dimensions(a[used]) == 2).any():
        vertices = _some_vertices(side_b)
        centers = side_a.bounds.reshape(-1, 2, 2).mean(axis=1)

        def test(rows: slice) -> NDArray[np.bool_]:
            # Most that intersect have a vertex within the other one, which takes much less time to find out.
            first, second = of_a[rows], of_b[rows]
            near = ((vertices[second] - centers[first][:, None]) ** 2).sum(axis=2).argmin(axis=1)
            kept = np.asarray(shapely.intersects_xy(a[first], *vertices[second, near].T))
            rest = np.flatnonzero(~kept)
            kept[rest] = shapely.intersects(a[first[rest]], b[second[rest]])
            return kept

    else:

        def test(rows: slice) -> NDArray[np.bool_]:
            return np.asarray(getattr(shapely, name)(a[of_a[rows]], b[of_b[rows]]))

    shapely.prepare(a[used])
    kept = _on_threads(test, of_a, threads)
    found = of_a[kept], of_b[kept]
    return (found[1], found[0]) if is_flipped else found


def _near(
    a: NDArray[np.complex128], b: NDArray[np.complex128], limits: NDArray[np.float64]
) -> tuple[NDArray[np.bool_], Indices]:
    """Which points are certainly within a distance, and the rows of those for which rounding may decide."""
    apart = a - b
    squares = apart.real**2 + apart.imag**2
    within = limits**2
    kept = (squares < within * (1 - _ROUNDING)) & (limits > 0)
    return kept, np.flatnonzero(~kept & ~(squares > within * (1 + _ROUNDING)))


def _none_of(first: Indices) -> tuple[NDArray[np.bool_], Indices]:
    """As `_near`, if nothing is certain."""
    return np.zeros(len(first), bool), np.arange(len(first))


def _some_vertices(side: _Side) -> NDArray[np.float64]:
    """Some vertices of each geometry, `(n, k, 2)`; NaN for one that has none."""
    import shapely

    coordinates = np.vstack([shapely.get_coordinates(side.shapes), [[np.nan, np.nan]]])
    sizes = side.sizes[:, None]
    rows = np.cumsum(sizes)[:, None] - sizes + sizes * np.arange(_VERTICES) // _VERTICES
    rows[side.sizes == 0] = -1
    return np.asarray(coordinates[rows])


def _on_threads(test: Callable[[slice], NDArray[np.bool_]], of_a: Indices, threads: int | None) -> NDArray[np.bool_]:
    """The results of a test of all candidates, block by block. Shapely releases the GIL, so that threads pay."""
    # A block has all tests of its geometries: one that is prepared builds an index at its first test, and two threads
    # must not do that at once.
    ends = np.append(np.flatnonzero(of_a[1:] != of_a[:-1]) + 1, len(of_a))
    blocks = np.unique(ends[np.searchsorted(ends, np.append(np.arange(_BLOCK, len(of_a), _BLOCK), len(of_a)))])
    rows = [slice(start, end) for start, end in zip([0, *blocks[:-1].tolist()], blocks.tolist())]
    number = min(thread_count(threads), processors(), len(rows))
    if number == 1:
        return np.concatenate([test(block) for block in rows])
    from concurrent.futures import ThreadPoolExecutor  # here, since it takes half of the import of this package

    def quiet(block: slice) -> NDArray[np.bool_]:
        with np.errstate(all="ignore"):  # which each thread has for itself
            return test(block)

    with ThreadPoolExecutor(number) as pool:
        return np.concatenate(list(pool.map(quiet, rows)))


def _extended(bounds: NDArray[np.float64], distances: NDArray[np.float64]) -> NDArray[np.float64]:
    """Bounds that reach so far, and a little farther: the exact test follows."""
    more = (distances + 4 * np.finfo(float).eps * (np.abs(bounds).max(axis=1, initial=0) + distances))[:, None]
    return np.hstack([bounds[:, :2] - more, bounds[:, 2:] + more])


def _frame(left: Any, right: Any, rows: list[Indices], how: str, columns: list[str], suffixes: tuple[str, str]) -> Any:
    """The joined frame."""
    import pandas

    kept, other = (1, 0) if how == "right" else (0, 1)
    frames = [left, right]
    geometry = frames[kept].geometry.name if _has_geometries(frames[kept]) else None
    # The keys of a row that nothing matches are there, too. (In geopandas they are always those of the left frame.)
    of_keys = 0 if geometry is not None else kept
    if columns:
        frames[1 - of_keys] = frames[1 - of_keys].drop(columns=columns)
    if geometry is not None:
        frames[other] = pandas.DataFrame(frames[other]).drop(columns=frames[other].geometry.name)
    # The index of the other frame becomes columns. That of this one has names, too, which must differ from columns.
    indices = [_index_columns(frame.index, suffix) for frame, suffix in zip(frames, suffixes)]
    for name in (name for side in (0, 1) for name in indices[side] if name not in frames[side].index.names):
        if any(name in frame.columns for frame in frames):
            raise ValueError(f"{name!r} cannot be a column of left or right: the result has it for an index")
    labels = [[*names, *frame.columns] for names, frame in zip(indices, frames)]
    common = set(labels[0]) & set(labels[1])
    if common and not any(suffixes):
        raise ValueError(f"lsuffix and rsuffix are empty, but both frames have columns {sorted(map(str, common))}")

    def renamed(side: int) -> list[Any]:
        return [
            f"{label}_{suffixes[side]}"
            if label in common and suffixes[side] and not (side == kept and label == geometry)
            else label
            for label in labels[side]
        ]

    _refuse_doubled(labels, [renamed(0), renamed(1)])
    index, depth = frames[kept].index, len(indices[kept])
    frames[other] = frames[other].reset_index(names=indices[other])
    taken = []
    for side, frame in enumerate(frames):
        frame = frame.reset_index(drop=True)
        frame.columns = renamed(side) if side == other else renamed(side)[depth:]
        of_frame = rows[side]
        frame = frame.reindex(of_frame) if (of_frame < 0).any() else frame.take(of_frame)
        frame.index = pandas.RangeIndex(len(of_frame))
        taken.append(frame)
    joined = pandas.concat(taken, axis=1)
    if geometry is not None:
        import geopandas

        joined = geopandas.GeoDataFrame(joined, geometry=geometry)
    names = [None if old is None else new for old, new in zip(index.names, renamed(kept))]
    joined.index = index.take(rows[kept]).set_names(names)
    return joined


def _frame_of_polars(
    left: Any, right: Any, rows: list[Indices], how: str, columns: list[str], suffixes: tuple[str, str]
) -> Any:
    """The joined frame; a row that is missing has nulls."""
    import polars

    kept = 1 if how == "right" else 0
    frames = [left, right]
    frames[1 - kept] = frames[1 - kept].drop(columns)
    common = set(frames[0].columns) & set(frames[1].columns)
    if common and not any(suffixes):
        raise ValueError(f"lsuffix and rsuffix are empty, but both frames have columns {sorted(common)}")
    renamed = [
        {name: f"{name}_{suffix}" if suffix and name in common else name for name in frame.columns}
        for frame, suffix in zip(frames, suffixes)
    ]
    _refuse_doubled([frame.columns for frame in frames], [list(names.values()) for names in renamed])
    taken = []
    for frame, of_frame, names in zip(frames, rows, renamed):
        at = polars.Series(of_frame).set(polars.Series(of_frame < 0), None)
        taken.append(frame.select(polars.all().gather(at)).rename(names))
    return polars.DataFrame([column for frame in taken for column in frame.get_columns()])


def _refuse_doubled(names: list[list[Any]], renamed: list[list[Any]]) -> None:
    """Refuses a name with a suffix that another column of the result has."""
    counts = Counter([*renamed[0], *renamed[1]])
    for side, suffix, old_names, new_names in zip(("left", "right"), ("lsuffix", "rsuffix"), names, renamed):
        for old, new in zip(old_names, new_names):
            if old != new and counts[new] > 1:
                raise ValueError(
                    f"the result would have two columns {new!r}, one of which is {old!r} of {side} with its suffix: "
                    f"rename one, or pass another {suffix}"
                )


def with_missing(rows: list[Indices], kept: int | bool, count: int) -> list[Indices]:
    """Pairs sorted by the rows of the frame that is kept, with a pair of -1 for each of its rows that has none."""
    of_kept, of_other = rows[kept], rows[1 - kept]
    missing = np.setdiff1d(np.arange(count), of_kept)
    of_kept = np.concatenate([of_kept, missing])
    of_other = np.concatenate([of_other, np.full(len(missing), -1)])
    order = np.argsort(of_kept, kind="stable")
    rows[kept], rows[1 - kept] = of_kept[order], of_other[order]
    return rows


def _index_columns(index: Any, suffix: str) -> list[str]:
    """The names of the columns that hold the index of the frame whose index is not kept."""
    number = index.nlevels
    return [
        name if name is not None else f"index_{suffix}" if number == 1 else f"index_{suffix}{level}"
        for level, name in enumerate(index.names)
    ]
