"""Tables that are not in memory yet, and geometries in Arrow: they work, or one clear error says what to pass."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import sweep_and_prune as sap


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_relations_of_duckdb_are_tables() -> None:
    duckdb = pytest.importorskip("duckdb")
    pytest.importorskip("pyarrow")
    rows = "select * from (values (0, 1, 'a'), (1, 2, 'a'), (1, 6, 'b')) rows(\"start\", \"end\", kind)"
    relation = duckdb.sql(rows)
    assert sap.find_pairs(relation).tolist() == [[0, 1], [0, 2], [1, 2]]
    assert sap.find_pairs(relation, by="kind", closed="both").tolist() == [[0, 1]]
    assert sap.find_pairs([[0, 9]] * 3, by=relation["kind"]).tolist() == [[0, 1]]
    assert sap.count_pairs_between(relation, relation, by="kind") == 5
    times = duckdb.sql(
        'select timestamp \'2026-01-01\' + interval (n) hour as "start", "start" as "end" from range(3) t(n)'
    )
    assert sap.count_pairs(times) == 0
    large = duckdb.sql('select 9007199254740992 + n as "start", "start" as "end" from range(2) t(n)')
    assert sap.count_pairs(large) == 0
    with pytest.raises(TypeError, match=r"left is a DuckDBPyRelation, .*: pass what its df\(\) returns"):
        sap.join(relation, relation)
    assert sap.find_pairs([[0, 9]] * 3, by=relation).tolist() == []
    assert sap.find_pairs([[0, 9]] * 2, by=duckdb.sql("select 1 as a, 'x' as b from range(2)")).tolist() == [[0, 1]]


def test_what_can_be_looked_at_once_is_looked_at_once() -> None:
    duckdb, pyarrow = pytest.importorskip("duckdb"), pytest.importorskip("pyarrow")
    a = pyarrow.table({"start": [0, 1, 10, 30, 50], "end": [2, 3, 12, 31, 50], "kind": [*"aabbb"]})
    b = pyarrow.table({"start": [4, 20, 2], "end": [5, 21, 11], "kind": [*"abb"]})
    calls: list[Any] = [
        lambda a, b: sap.find_pairs(a, by="kind"),
        lambda a, b: sap.find_pairs([[0, 9]] * 5, by=a),
        lambda a, b: sap.cluster(a, closed="left"),
        lambda a, b: sap.merge(a).intervals,
        lambda a, b: sap.merge(a, by="kind").intervals,
        sap.coverage,
        lambda a, b: sap.nearest(a, b).distances,
        lambda a, b: sap.nearest(a, b, by="kind", max_distance=9).distances,
    ]
    for call in calls:
        streams = (pyarrow.RecordBatchReader.from_batches(one.schema, one.to_batches()) for one in (a, b))
        assert call(*streams).tolist() == call(a, b).tolist()
    # The query returns its rows in another order each time.
    rows = duckdb.sql('select 10 * n as "start", 10 * n + 5 as "end" from range(99) t(n) order by random()')
    every = [[0, 1000]]
    assert (sap.coverage(rows, every) == 5).all() and sap.coverage(every, rows).tolist() == [99 * 5]
    found = sap.merge(rows).intervals
    assert sorted(found[:, 0]) == [*range(0, 990, 10)] and (found[:, 1] - found[:, 0] == 5).all()
    assert sorted(sap.nearest(rows, [[0, 0]]).distances) == [*range(0, 990, 10)]


def test_lazy_frames_are_refused_with_what_to_pass() -> None:
    polars = pytest.importorskip("polars")
    frame = polars.DataFrame({"start": [0], "end": [1]})
    for left, right, name in ((frame.lazy(), frame, "left"), (frame, frame.lazy(), "right")):
        with pytest.raises(TypeError, match=rf"{name} is a LazyFrame, .*: pass what its collect\(\) returns"):
            sap.join(left, right)


def shapes() -> Any:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    geometry = [shapely.box(0, 0, 2, 2), None, shapely.Point(2, 2), shapely.box(3, 3, 4, 4)]
    return geopandas.GeoDataFrame({"n": [1, 1, 1, 1]}, geometry=geometry, crs="EPSG:25832")


@pytest.mark.parametrize("encoding", ["WKB", "geoarrow"])
def test_geometries_of_arrow_are_their_bounds(encoding: str) -> None:
    pyarrow = pytest.importorskip("pyarrow")
    frame = shapes()
    if encoding == "geoarrow":
        frame = frame.iloc[[0, 3]]
    table = pyarrow.table(frame.to_arrow(geometry_encoding=encoding))
    wanted = sap.find_pairs(frame, missing="skip", margin=1).tolist()
    assert wanted
    for one in (table, *table.to_batches()):
        assert sap.find_pairs(one, missing="skip", margin=1).tolist() == wanted
        assert sap.find_pairs(one, missing="skip", margin=1, by="n").tolist() == wanted
    other = pyarrow.table(frame.to_crs("EPSG:4326").to_arrow(geometry_encoding=encoding))
    for a, b in ((table, other), (frame, other), (other, frame)):
        with pytest.raises(ValueError, match="a and b have different coordinate reference systems, EPSG:"):
            sap.find_pairs_between(a, b)
    assert sap.count_pairs_between(table, frame, missing="skip") == sap.count_pairs_between(
        frame, frame, missing="skip"
    )


def test_geometries_count_before_columns_that_are_known_as_boxes() -> None:
    parquet, shapely = pytest.importorskip("pyarrow.parquet"), pytest.importorskip("shapely")
    frame = shapes().iloc[[0, 3]].assign(start=0, end=1)
    for options in ({}, {"geometry_encoding": "geoarrow"}):
        frame.to_parquet("a.parquet", **options)
        table = parquet.read_table("a.parquet")
        for one in (frame, table, *table.to_batches()):
            assert sap.count_pairs(one) == 0 and sap.count_pairs(one, margin=1) == 1
        for one in (frame, table, frame.geometry, frame.geometry.values, list(frame.geometry)):
            with pytest.raises(ValueError, match=r'boxes has geometries, .*: leave out format="xywh"'):
                sap.find_pairs(one, format="xywh")
        assert sap.count_pairs(table.select(["start", "end"])) == 1
    other = frame.to_crs("EPSG:4326")
    other.to_parquet("b.parquet")
    with pytest.raises(ValueError, match="a and b have different coordinate reference systems, EPSG:"):
        sap.find_pairs_between(table, parquet.read_table("b.parquet"))
    plain = table.drop_columns(["geometry"]).append_column("geometry", [shapely.to_wkb(frame.geometry.array)])
    plain = plain.replace_schema_metadata(table.schema.metadata)
    assert sap.count_pairs(plain) == 0 and sap.count_pairs(plain, margin=1) == 1
    with pytest.raises(ValueError, match='the metadata "geo" are not those of GeoParquet'):
        sap.find_pairs(plain.replace_schema_metadata({"geo": "[]"}))


def test_points_of_geoarrow_are_no_intervals() -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    pyarrow = pytest.importorskip("pyarrow")
    frame = geopandas.GeoDataFrame(geometry=shapely.points([[0, 5], [1, 9], [1, 9]]))
    column = pyarrow.table(frame.to_arrow(geometry_encoding="geoarrow"))["geometry"]
    assert sap.find_pairs(column).tolist() == [[1, 2]]
    assert sap.find_pairs(frame).tolist() == [[1, 2]]


def test_bytes_are_refused_with_what_to_pass() -> None:
    pyarrow, shapely = pytest.importorskip("pyarrow"), pytest.importorskip("shapely")
    table = pyarrow.table({"shape": shapely.to_wkb(shapely.points([[0, 0], [1, 1]]))})
    with pytest.raises(ValueError, match=r"if column shape is .*\(WKB\), pass shapely\.from_wkb\(table\['shape'\]\)"):
        sap.find_pairs(table)
    with pytest.raises(TypeError, match=r"boxes is bytes, not numbers: .* pass shapely\.from_wkb\(boxes\)"):
        sap.find_pairs(table["shape"])
    assert len(sap.find_pairs(shapely.from_wkb(table["shape"]))) == 0


def test_distances_are_0_or_more() -> None:
    frame = shapes()
    for distance, said in ((-1, "distance is -1.0"), ([0, 1, float("nan"), 1], r"distance\[2\] is nan")):
        with pytest.raises(ValueError, match=f"{said}; it must be 0 or more"):
            sap.join(frame, frame, predicate="dwithin", distance=distance)


def test_frames_with_columns_of_several_levels_join_as_in_geopandas() -> None:
    geopandas, pandas = pytest.importorskip("geopandas"), pytest.importorskip("pandas")
    plain = shapes()
    levels = plain.copy()
    levels.columns = pandas.MultiIndex.from_tuples([("n", ""), ("geometry", "")])
    levels = levels.set_geometry(("geometry", ""))
    for left, right in ((levels, plain), (plain, levels), (levels, levels)):
        for how in ("inner", "left", "right"):
            wanted = geopandas.sjoin(left, right, how=how)
            found = sap.join(left, right, how)
            assert [*found.columns] == [*wanted.columns] and found.index.tolist() == wanted.index.tolist()


def test_messages_do_not_list_all_columns_of_a_wide_table() -> None:
    columns: Any = {f"column{number}": [0] for number in range(10_000)}
    for by, said in ((None, "boxes has no columns that are known as boxes"), ("q", "by is 'q'")):
        with pytest.raises(ValueError, match=said) as error:
            table: Any = columns if by is None else {**columns, "start": [0], "end": [1]}
            sap.find_pairs(table, by=by)
        assert len(str(error.value)) < 700 and " more" in str(error.value)


def test_a_right_join_keeps_the_keys_of_rows_without_a_match() -> None:
    pandas, polars = pytest.importorskip("pandas"), pytest.importorskip("polars")
    left = pandas.DataFrame({"k": ["x", "y"], "start": [0, 5], "end": [1, 6]})
    right = pandas.DataFrame({"k": ["x", "z"], "start": [0, 5], "end": [1, 6]})
    assert sap.join(left, right, "right", by="k")["k"].tolist() == ["x", "z"]
    assert sap.join(left, right, "left", by="k")["k"].tolist() == ["x", "y"]
    frames = polars.from_pandas(left), polars.from_pandas(right)
    assert sap.join(*frames, "right", by="k")["k"].to_list() == ["x", "z"]
