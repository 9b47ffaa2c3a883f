"""Joins equal the joins of geopandas, and brute force where there are no geometries."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from oracle import random_boxes

import sweep_and_prune as sap
from sweep_and_prune import _join
from sweep_and_prune._native import in_order

pandas = pytest.importorskip("pandas")


def intervals(count: int, seed: int) -> Any:
    start, end = random_boxes(count, 1, np.float64, seed).T
    frame = pandas.DataFrame({"start": start, "end": end, "chrom": np.array(["1", "2", "X"])[np.arange(count) % 3]})
    frame["name"] = [f"{seed}-{index}" for index in range(count)]
    return frame.set_index(np.arange(count)[::-1] + 100)


def brute_force(left: Any, right: Any, closed: bool, margin: float, by: bool) -> list[tuple[int, int]]:
    def near(a: Any, b: Any) -> bool:
        if by and a.chrom != b.chrom:
            return False
        if closed:
            return bool(a.start <= b.end + margin and b.start <= a.end + margin)
        overlaps = a.start < b.end + margin and b.start < a.end + margin
        return bool(overlaps and a.start < a.end and b.start < b.end)

    return [(i, j) for i, a in enumerate(left.itertuples()) for j, b in enumerate(right.itertuples()) if near(a, b)]


@pytest.mark.parametrize("how", ["inner", "left", "right"])
@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("margin", [0, 0.5])
@pytest.mark.parametrize("by", [True, False])
def test_tables_of_intervals(how: str, closed: bool, margin: float, by: bool) -> None:
    left, right = intervals(60, 1), intervals(50, 2)
    right.loc[right.index[7], "start"] = np.nan
    pairs: list[Any] = brute_force(left, right, closed, margin, by)
    if how == "left":
        alone = set(range(60)) - {i for i, _ in pairs}
        pairs = sorted([*pairs, *((i, -1) for i in alone)])
    elif how == "right":
        alone = set(range(50)) - {j for _, j in pairs}
        pairs = sorted([*pairs, *((-1, j) for j in alone)], key=lambda pair: pair[::-1])
    joined = sap.join(
        left,
        right,
        how,
        distance=margin or None,
        closed=None if closed else "left",
        by="chrom" if by else None,
    )
    kept, other = (1, 0) if how == "right" else (0, 1)
    frames, suffixes = (left, right), ("left", "right")
    rows = np.array(pairs)
    assert len(pairs) > 5 and (rows >= 0).all(axis=1).any()
    assert list(joined.index) == list(frames[kept].index[rows[:, kept]])
    for side in (0, 1):
        names = frames[side]["name"].to_numpy(object)[rows[:, side]]
        names[rows[:, side] < 0] = None
        found = joined[f"name_{suffixes[side]}"]
        assert [None if value != value or value is None else value for value in found] == names.tolist()
    index = joined[f"index_{suffixes[other]}"].fillna(-1).to_numpy(int)
    wanted = np.where(rows[:, other] < 0, -1, frames[other].index.to_numpy()[rows[:, other]])
    assert np.array_equal(index, wanted)
    assert ("chrom" in joined.columns) == by and ("chrom_left" in joined.columns) != by


@pytest.mark.parametrize("how", ["inner", "left", "right"])
@pytest.mark.parametrize(
    "options", [{}, {"by": "chrom"}, {"by": ["chrom", "even"], "closed": "left"}, {"distance": 0.5}]
)
def test_frames_of_polars_are_joined_as_those_of_pandas(how: str, options: dict[str, Any]) -> None:
    polars = pytest.importorskip("polars")
    left, right = (intervals(count, count).assign(even=lambda frame: frame.index % 2) for count in (60, 50))
    right.loc[right.index[7], "start"] = np.nan
    wanted = sap.join(left, right, how, **options)
    wanted = wanted.drop(columns=[name for name in wanted.columns if name.startswith("index_")])
    joined = sap.join(polars.from_pandas(left), polars.from_pandas(right), how, **options)
    assert isinstance(joined, polars.DataFrame) and joined.columns == list(wanted.columns)
    assert joined.height == len(wanted) > 1
    for name in joined.columns:
        found = [None if value is None or value != value else value for value in joined[name].to_list()]
        assert found == [None if pandas.isna(value) else value for value in wanted[name].tolist()], name
    with pytest.raises(TypeError, match="left is a LazyFrame, which has no rows yet: pass what its collect"):
        sap.join(polars.from_pandas(left).lazy(), polars.from_pandas(right), how)
    with pytest.raises(TypeError, match="two DataFrames of pandas or polars"):
        sap.join(polars.from_pandas(left), right)
    with pytest.raises(ValueError, match="lsuffix and rsuffix are empty"):
        sap.join(polars.from_pandas(left), polars.from_pandas(right), lsuffix="", rsuffix="")
    assert sap.join(polars.from_pandas(left[:0]), polars.from_pandas(right), how).height == (
        50 if how == "right" else 0
    )


def test_frames_without_matches_and_without_rows() -> None:
    left, right = intervals(5, 1), intervals(4, 2)
    right[["start", "end"]] += 1e6
    assert len(sap.join(left, right)) == 0
    assert len(sap.join(left, right, "left")) == 5 and sap.join(left, right, "left")["name_right"].isna().all()
    assert list(sap.join(left, right).columns) == list(sap.join(left, right, "left").columns)
    assert len(sap.join(left[:0], right)) == 0 and len(sap.join(left[:0], right, "right")) == 4


def test_misuse_is_refused() -> None:
    left, right = intervals(5, 1), intervals(4, 2)
    for arguments, options, error, message in (
        ((left, np.zeros((2, 2))), {}, TypeError, "left and right must be two DataFrames"),
        ((left, right, "outer"), {}, ValueError, "how must be"),
        ((left, right, "inner", "near"), {}, ValueError, "predicate must be one of"),
        ((left, right, "inner", "within"), {}, ValueError, "needs geometries"),
        ((left, right), {"by": "gene"}, ValueError, "by is 'gene', but the columns of left are"),
        ((left, right), {"by": ("name", "name")}, ValueError, "left_by and right_by"),
        ((left, right), {"by": (left["name"], right["name"])}, ValueError, "left_by and right_by"),
        ((left, right), {"distance": -1}, ValueError, "margin"),
        ((left, right), {"lsuffix": "", "rsuffix": ""}, ValueError, "lsuffix and rsuffix are empty"),
        ((left.assign(index_right=1), right), {}, ValueError, "'index_right' cannot be a column"),
        ((left.drop(columns="end"), right), {}, ValueError, "no columns that are known"),
    ):
        with pytest.raises(error, match=message):
            sap.join(*arguments, **options)


def test_two_columns_of_one_name_are_refused() -> None:
    polars = pytest.importorskip("polars")
    left, right = intervals(5, 1), intervals(4, 2)
    for kind in (lambda frame: frame, polars.from_pandas):
        sides: Any
        suffixes: Any
        for sides, suffixes in (
            ((left.assign(start_left=1), right), {}),
            ((left, right.assign(start_left=1)), {}),
            ((left, right), {"lsuffix": "left", "rsuffix": "left"}),
        ):
            with pytest.raises(
                ValueError, match=r"two columns .(start|index_left)_left., one of which is .(start|index_left). of left"
            ):
                sap.join(*map(kind, sides), **suffixes)
        assert "start_left" in sap.join(kind(left.assign(start_left=1)), kind(right), lsuffix="of_left").columns


def test_the_libraries_of_two_frames_are_named() -> None:
    polars = pytest.importorskip("polars")
    left = intervals(5, 1)
    with pytest.raises(TypeError, match="not a DataFrame of pandas and a DataFrame of polars"):
        sap.join(left, polars.from_pandas(left))


def test_names_of_columns_may_be_numbers() -> None:
    left, right = (intervals(9, seed).assign(name=["a", "b", "b"] * 3) for seed in (1, 2))
    wanted = sap.join(left, right, by="name")
    names = list(left.columns)
    numbered = [frame.set_axis(range(len(names)), axis=1) for frame in (left, right)]
    at = [names.index("start"), names.index("end")]
    for by in (names.index("name"), [names.index("name")], np.int64(names.index("name"))):
        found = sap.join(*numbered, by=by, left_columns=at, right_columns=at)
        assert found.to_numpy().tolist() == wanted.to_numpy().tolist()
    boxes = left[["start", "end"]]
    known = pandas.concat([boxes, pandas.Series(1, boxes.index, name=7)], axis=1)
    assert sap.find_pairs(known, by=7).tolist() == sap.find_pairs(boxes).tolist()
    assert sap.count_pairs_between(known, known, by=7) == sap.count_pairs_between(boxes, boxes)
    call: Any
    for call in (lambda: sap.find_pairs(known, by=8), lambda: sap.find_pairs(known, by="7")):
        with pytest.raises(ValueError, match="but the columns of boxes are start, end, 7"):
            call()


def shapes(count: int, seed: int) -> Any:
    """Points, lines and polygons with many points, some of them empty or None."""
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    random = np.random.default_rng(seed)
    x, y = random.integers(0, 20, (2, count)) / 2
    made = shapely.points(x, y)
    made[count // 4 :] = shapely.box(x, y, x + random.integers(1, 4, count) / 2, y + 1)[count // 4 :]
    made[count // 2 :] = shapely.buffer(shapely.points(x, y)[count // 2 :], 0.8)
    line = shapely.linestrings(np.stack([x, y, x + 2, y + random.integers(0, 3, count)], 1).reshape(-1, 2, 2))
    made[-count // 5 :] = line[-count // 5 :]
    made[3], made[5] = None, shapely.Point()
    return geopandas.GeoDataFrame(
        {"value": random.integers(0, 5, count), f"only_{seed}": x, "kind": np.arange(count) % 3},
        geometry=geopandas.GeoSeries(made, crs="EPSG:3857"),
        index=np.arange(count)[::-1] * 2,
    )


def check_same(left: Any, right: Any, *arguments: Any, **options: Any) -> int:
    geopandas = pytest.importorskip("geopandas")
    joined = sap.join(left, right, *arguments, **options)
    if "by" in options:
        options["on_attribute"] = options.pop("by")
    wanted = geopandas.sjoin(left, right, *arguments, **options)

    def arranged(frame: Any) -> Any:
        """Rows in an order of their own: that of geopandas is not defined where several rows match one."""
        named = pandas.DataFrame(frame)
        named.index = named.index.set_names([f"level {level}" for level in range(named.index.nlevels)])
        named = named.reset_index()
        return named.sort_values(list(named.select_dtypes("number").columns)).reset_index(drop=True)

    pandas.testing.assert_frame_equal(arranged(joined), arranged(wanted))
    assert type(joined) is type(wanted) and joined.crs == wanted.crs
    assert joined.geometry.name == wanted.geometry.name and list(joined.columns) == list(wanted.columns)
    assert joined.index.names == wanted.index.names
    return len(joined)


@pytest.mark.parametrize("how", ["inner", "left", "right"])
@pytest.mark.parametrize(
    "predicate",
    ["intersects", "contains", "within", "covers", "covered_by", "contains_properly", "crosses", "overlaps", "touches"],
)
def test_geometries_are_joined_as_by_geopandas(how: str, predicate: str) -> None:
    left, right = shapes(150, 1), shapes(120, 2)
    assert check_same(left, right, how, predicate) > 5
    check_same(left, left, how, predicate)
    # Either side may have the geometries with more points.
    check_same(left[left.geometry.geom_type == "Point"], right, how, predicate)
    check_same(left, right[right.geometry.geom_type == "Point"], how, predicate)


def test_rectangles_and_points_and_what_looks_like_them() -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    random = np.random.default_rng(5)
    rectangles = shapely.get_coordinates(shapely.box(*random_boxes(200, 2, np.float64, 3).T + 0.0)).reshape(-1, 5, 2)[
        :, :4
    ]
    rectangles = rectangles[(rectangles[:, 0] != rectangles[:, 2]).all(axis=1)]
    rolled = [np.roll(ring, turn % 4, axis=0)[:: 1 - 2 * (turn % 2)] for turn, ring in enumerate(rectangles)]
    quads = random.integers(0, 12, (300, 4, 2)).astype(float)
    near = rectangles[:60].copy()
    near[np.arange(60), np.arange(60) % 4, np.arange(60) // 4 % 2] += 1  # one corner is elsewhere
    rings = [ring for ring in [*rolled, *quads, *near] if len(np.unique(ring, axis=0)) > 2]
    polygons = shapely.polygons(np.stack(rings))
    polygons = polygons[shapely.is_valid(polygons)]
    points = shapely.points(random.integers(0, 12, (100, 2)) / 1.0)
    made = np.concatenate([polygons, points, shapely.boundary(polygons[:50])])
    left, right = (geopandas.GeoDataFrame({"id": np.arange(len(of))}, geometry=of) for of in (made, made[::-1]))
    assert check_same(left, right) > 10_000
    for predicate in ("contains", "within"):
        assert check_same(left, right, "inner", predicate) > 300


def test_distances_names_indices_and_groups_are_those_of_geopandas() -> None:
    left, right = shapes(80, 1), shapes(60, 2)
    for how in ("inner", "left", "right"):
        for distance in (0, 0.5, np.linspace(0, 1, 80)):
            check_same(left, right, how, "dwithin", distance=distance)
        check_same(left, right, how, by="kind")
        check_same(left, right, how, by=["kind", "value"])
        check_same(left, right, how, lsuffix="a", rsuffix="b")
        check_same(left.rename_axis("id"), right.rename_axis("number"), how)
        check_same(left.set_index(["kind", "value"]), right.set_index([right.index, "value"]), how)
        check_same(left.rename_geometry("shape"), right.rename_geometry("geom"), how)
        check_same(left.rename_geometry("shape"), right, how)
        check_same(left[:0], right, how)
        check_same(left, right[:0], how)


def check_distances(points: Any, distance: Any) -> int:
    """Compares the pairs of points that are so near with shapely's, and counts them."""
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    ids = np.arange(points.shape[1])
    left, right = (geopandas.GeoDataFrame({"id": ids}, geometry=geopandas.points_from_xy(*of.T)) for of in points)
    with np.errstate(under="ignore"):
        is_within = shapely.dwithin(left.geometry.array, right.geometry.array, distance)
    found = sap.join(left, right, "inner", "dwithin", distance=distance, by="id")
    assert found.id.tolist() == ids[is_within].tolist()
    return int(is_within.sum())


def test_distances_are_rounded_as_by_shapely() -> None:
    geopandas = pytest.importorskip("geopandas")
    # On an axis only subtractions round; elsewhere the square of the distance and its root do, too.
    for scale in ([10, 0], [10, 10]):
        points = np.random.default_rng(1).random((2, 1000, 2)) * scale
        distance = np.sqrt(((points[0] - points[1]) ** 2).sum(axis=1))
        assert check_distances(points, distance) > 900
    left = geopandas.GeoDataFrame({"id": np.arange(1000)}, geometry=geopandas.points_from_xy(*points[0].T))
    for distance, number in ((0, 1000), (1e-200, 1000), (1e200, 10**6)):
        assert len(sap.join(left, left, "inner", "dwithin", distance=distance)) == number, distance


def test_distances_near_0_whose_squares_are_rounded_by_far_are_those_of_shapely() -> None:
    points = np.random.default_rng(1).random((2, 1000, 2)) * 3e-162
    with np.errstate(under="ignore"):
        distance = np.hypot(*(points[0] - points[1]).T)
    assert 700 < check_distances(points, distance) < 1000


def test_blocks_and_threads_change_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    left, right = shapes(150, 1), shapes(120, 2)
    twice = left.take([*range(150), *range(150)])  # the same geometries again
    every: list[dict[str, Any]] = [{"predicate": name} for name in ("intersects", "covers", "within")]
    for options in [*every, {"predicate": "dwithin", "distance": 0.5}]:
        wanted = [sap.join(frame, right, **options) for frame in (left, twice)]
        for block in (1, 7):
            with monkeypatch.context() as patch:
                patch.setattr(_join, "_BLOCK", block)
                for frame, of_frame in zip((left, twice), wanted):
                    for threads in (1, 3):
                        pandas.testing.assert_frame_equal(sap.join(frame, right, threads=threads, **options), of_frame)


def test_disks_intersect_where_no_vertex_is_within_the_other() -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    random = np.random.default_rng(3)
    disks = shapely.buffer(shapely.points(random.random((400, 2)) * 20), random.random(400) + 0.1, quad_segs=8)
    bars = shapely.box(*np.sort(random.random((2, 60, 2)) * [20, 0.2], axis=0).transpose(1, 0, 2).reshape(60, 4).T)
    bars = shapely.segmentize(shapely.transform(bars, lambda at: at + [[0, 9]]), 2.0)
    rings = shapely.difference(disks[:50], shapely.buffer(shapely.centroid(disks[:50]), 0.3))
    made = np.concatenate([disks, bars, rings, shapely.boundary(disks[:50])])
    frame = geopandas.GeoDataFrame({"id": np.arange(len(made))}, geometry=made)
    assert check_same(frame, frame) > 3000


ORDERS = [(0, 3, 3), (1, 1, 1), (500, 7, 2**32), (500, 400, 3), (20, 20, 20)]
ORDERS += [(9000, 5000, 9), (3000, 2**20, 2**20), (3000, 2**26 - 1, 4)]  # with several rows in a bucket


@pytest.mark.parametrize(("pairs", "rows", "others"), ORDERS)
def test_pairs_are_put_in_order(pairs: int, rows: int, others: int) -> None:
    random = np.random.default_rng(pairs)
    first, second = random.integers(0, rows, pairs), random.integers(0, others, pairs)
    wanted = np.lexsort((second, first))
    both = np.column_stack([first, second])  # its columns are not contiguous
    for given in ((first, second), (both[:, 0], both[:, 1]), (first[wanted], second[wanted])):
        found = in_order(*given, rows)
        assert [column.dtype for column in found] == [np.int64, np.int64]
        assert np.array_equal(found, [first[wanted], second[wanted]])
    if pairs > 1:
        for bad in ((first, second, int(first.max())), (first - rows, second, rows), (first, second - others, rows)):
            with pytest.raises(IndexError):
                in_order(bad[0][::-1], bad[1][::-1], bad[2])


def test_rows_are_sorted() -> None:
    left, right = intervals(3000, 1), intervals(2000, 2)
    for how in ("inner", "left", "right"):
        joined = sap.join(left, right, how)
        rows = [-joined.index.to_numpy(), -joined[f"index_{'left' if how == 'right' else 'right'}"].to_numpy()]
        assert np.array_equal(np.lexsort(rows[::-1]), np.arange(len(joined))) and len(joined) > 1000


def test_prepared_geometries_are_left_as_they_were() -> None:
    shapely = pytest.importorskip("shapely")
    left, right = shapes(80, 1), shapes(60, 2)
    shapely.prepare(left.geometry.array[50:55])
    before = [shapely.is_prepared(np.asarray(frame.geometry.array)).tolist() for frame in (left, right)]
    sap.join(left, right)
    assert [shapely.is_prepared(np.asarray(frame.geometry.array)).tolist() for frame in (left, right)] == before


def test_the_geometries_that_are_prepared_are_copies(monkeypatch: pytest.MonkeyPatch) -> None:
    shapely = pytest.importorskip("shapely")
    frame = shapes(80, 1)
    users = set(map(id, frame.geometry.array))
    shapely.prepare(frame.geometry.array[50:55])
    prepared: list[Any] = []
    tested: list[Any] = []
    prepare, within = shapely.prepare, shapely.within

    def noted_prepare(given: Any) -> None:
        prepared.extend(given)
        prepare(given)

    def noted_within(a: Any, b: Any) -> Any:
        tested.extend(a[shapely.is_prepared(a)])
        return within(a, b)

    monkeypatch.setattr(shapely, "prepare", noted_prepare)
    monkeypatch.setattr(shapely, "within", noted_within)
    sap.join(frame, shapes(60, 2), predicate="contains")
    sap.join(frame, frame, predicate="within")
    assert prepared and tested, "some are"
    assert users.isdisjoint(map(id, [*prepared, *tested])), "other threads may test the user's own"


def test_geometries_are_checked() -> None:
    left, right = shapes(10, 1), shapes(10, 2)
    with pytest.raises(ValueError, match=r"EPSG:3857 and EPSG:4326: pass right\.to_crs"):
        sap.join(left, right.to_crs(4326))
    for options, message in (
        ({"distance": 1}, "distance must be passed with"),
        ({"predicate": "dwithin"}, "distance must be passed with"),
        ({"predicate": "dwithin", "distance": [1, 2]}, "one for each left row"),
        ({"closed": "left"}, "closed and format are for boxes"),
    ):
        with pytest.raises(ValueError, match=message):
            sap.join(left, right, **options)
    with pytest.raises(TypeError, match="a GeoDataFrame of geopandas and a DataFrame of pandas"):
        sap.join(left, pandas.DataFrame(right))


def test_shares_and_measures_of_geometries_are_those_of_their_areas() -> None:
    geopandas = pytest.importorskip("geopandas")
    import shapely

    random = np.random.default_rng(3)
    frames = []
    for count in (60, 80):
        centers = shapely.points(random.random((count, 2)) * 5)
        shapes = shapely.buffer(centers, random.random(count), quad_segs=3)
        shapes[::7] = centers[::7]
        shapes[3] = shapely.LineString([(0, 0), (5, 5)])
        frames.append(geopandas.GeoDataFrame({"n": np.arange(count)}, geometry=shapes))
    left, right = frames
    plain = left.sjoin(right).sort_values(["n_left", "n_right"])
    a, b = left.geometry[plain["n_left"]].array, right.geometry[plain["n_right"]].array
    shared = a.intersection(b).area
    with np.errstate(all="ignore"):
        wanted = {
            "size": shared,
            "fraction_left": shared / a.area,
            "fraction_right": shared / b.area,
            "iou": shared / a.union(b).area,
        }
    joined = sap.join(left, right, measures=list(wanted))
    assert joined["n_right"].tolist() == plain["n_right"].tolist()
    for name, values in wanted.items():
        assert np.allclose(joined[name], values, equal_nan=True), name
    for fraction in (0.2, (0.5, 0), (0, 0.5)):
        least = fraction if isinstance(fraction, tuple) else (fraction, fraction)
        kept = (wanted["fraction_left"] >= least[0]) & (wanted["fraction_right"] >= least[1])
        few = sap.join(left, right, fraction=fraction)
        assert 0 < len(few) < len(plain) and few["n_right"].tolist() == plain["n_right"][kept].tolist()
    every = sap.join(left, right, how="left", fraction=0.5, measures=["iou"])
    assert every["iou"].isna().sum() == every["n_right"].isna().sum() > 0
    bow_tie = geopandas.GeoDataFrame({"n": [0]}, geometry=[shapely.Polygon([(0, 0), (2, 2), (2, 0), (0, 2)])])
    square = geopandas.GeoDataFrame({"n": [0]}, geometry=[shapely.Polygon([(0, 0), (2, 0), (1, 1), (2, 2), (0, 2)])])
    with pytest.raises(ValueError, match=r"left row 0 .*is not a valid geometry.*make_valid"):
        sap.join(bow_tie, square, measures=["size"])
