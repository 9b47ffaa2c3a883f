"""Pairs through files and through Dask are those of the finder, whatever the partitions, interruptions and faults."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from disk import BOXES, PAIRS, Interrupted, children_of, dataset, found, interrupt, table, write
from oracle import in_order, pairs_between, random_boxes

import sweep_and_prune as core

pytest.importorskip("distributed")
import dask.array
import dask.dataframe
import pandas
import pyarrow
import pyarrow.parquet

import sweep_and_prune.dask as sap
from sweep_and_prune._partitioned import boxes as boxes_module
from sweep_and_prune._partitioned import graph, tasks, workers
from sweep_and_prune._partitioned import run as run_module
from sweep_and_prune._partitioned.cells import choose_cells
from sweep_and_prune._partitioned.dataset import hash_pairs

# Dask calls pandas in a way that a newer pandas warns of.
pytestmark = pytest.mark.filterwarnings("ignore:The inplace keyword:DeprecationWarning")


@pytest.fixture(autouse=True)
def in_a_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.fixture
def small_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cells of more than 500 boxes are split, and the in-memory shortcut is never taken."""
    monkeypatch.setattr(run_module, "_LEAST_ROWS", 500)
    monkeypatch.setattr(workers, "_for_boxes", lambda memory, limit: 500)


@pytest.mark.parametrize("cells", [None, 1, 2, 23, 200])
def test_files_give_the_pairs_of_the_finder(cells: int | None) -> None:
    write("a.parquet")
    assert np.array_equal(found(sap.find_pairs("a.parquet", out="out", workers=0, cells=cells)), PAIRS)
    assert np.array_equal(dataset(), PAIRS)
    assert sap.count_pairs("a.parquet", workers=0, cells=cells) == len(PAIRS)


def test_the_hash_depends_on_the_pairs_alone() -> None:
    write("a.parquet")
    hashes = set()
    for cells, group in ((1, 400), (7, 3000), (100, 37)):
        write("a.parquet", group=group)
        sap.find_pairs("a.parquet", out="out", workers=0, cells=cells, overwrite=True)
        hashes.add(sap.read_manifest("out").hash)
    assert len(hashes) == 1
    write("a.parquet", BOXES[::-1])
    sap.find_pairs("a.parquet", out="out", ids="number", workers=0, cells=5, overwrite=True)
    hashes.add(sap.read_manifest("out").hash)
    assert len(hashes) == 2, "other ids are other pairs"


@pytest.mark.parametrize("dimensions", [1, 2, 3])
@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_all_dimensions_and_precisions_one_set_and_two(dimensions: int, dtype: Any) -> None:
    a, b = random_boxes(700, dimensions, dtype), random_boxes(300, dimensions, dtype, 2)
    write("a.parquet", a), write("b.parquet", b)
    assert np.array_equal(found(sap.find_pairs("a.parquet", out="o", workers=0, cells=9)), in_order(core.find_pairs(a)))
    wanted = pairs_between(a, b)
    assert np.array_equal(
        found(sap.find_pairs_between("a.parquet", "b.parquet", out="out", workers=0, cells=9)), wanted
    )
    assert np.array_equal(dataset(), wanted)
    assert sap.count_pairs_between("a.parquet", "b.parquet", workers=0, cells=9) == len(wanted)
    frames = [dask.dataframe.from_pandas(table(boxes).to_pandas(), npartitions=3) for boxes in (a, b)]
    assert np.array_equal(found(sap.find_pairs_between(*frames, cells=9)), wanted)
    assert sap.count_pairs_between(*frames, cells=9) == len(wanted)


def test_few_rows_of_memory_split_cells_again_and_join_wide_and_coincident_boxes(
    small_memory: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("_SAMPLE", "SAMPLE_PER_CELL"):
        monkeypatch.setattr(run_module, name, 1)
    boxes = random_boxes(4000, 2, np.float64)
    boxes[500:515] = [-100, -100, 1000, 1000]
    boxes[515:530] = [-100, -100, 30, 1000]  # these touch half of the cells
    boxes[530:2000] = [5, 5, 5, 5]  # no split separates these
    boxes[2100:2900] = boxes[3100:3900] / 200  # the sample does not know that they are crowded
    write("a.parquet", boxes, group=1000), write("b.parquet", boxes[::2], group=500)
    sap.find_pairs("a.parquet", out="out", workers=0, cells=20)
    assert np.array_equal(dataset(), in_order(core.find_pairs(boxes)))
    names = {path.name for path in Path("out").iterdir()}
    assert any(name.count(".") > 1 for name in names), "some cell was split again"
    sap.find_pairs_between("a.parquet", "b.parquet", out="between", workers=0, cells=20)
    assert np.array_equal(dataset("between"), in_order(core.find_pairs_between(boxes, boxes[::2])))


def test_wide_boxes_of_a_cell_that_is_split_again_meet_those_of_the_whole(
    small_memory: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("_SAMPLE", "SAMPLE_PER_CELL"):
        monkeypatch.setattr(run_module, name, 1)
    random = np.random.default_rng(3)
    low = random.random((5000, 2)) * 100
    low[1000:] /= 50
    boxes = np.hstack([low, low + np.where(np.arange(5000)[:, None] < 1000, 1, 0.01)])
    boxes[500:520] = [-1, -1, 101, 101]
    boxes[2000:2020] = [0.5, 0.5, 1.8, 1.8]
    write("a.parquet", boxes, group=5000)
    sap.find_pairs("a.parquet", out="out", workers=0, cells=30)
    assert np.array_equal(dataset(), in_order(core.find_pairs(boxes)))
    names = [path.name for path in Path("out").glob("cell-*wide.parquet")]
    assert len(names) > 1, "there are wide boxes at both levels"


def with_a_pattern(number: int, period: int) -> Any:
    """Boxes whose first one in each `period` is near 0, and all others near 1000."""
    low = np.random.default_rng(1).random((number, 2)) + np.where(np.arange(number)[:, None] % period, 1000, 0)
    return np.hstack([low, low])


def test_a_pattern_of_any_period_cannot_hide_boxes_from_a_sample(
    small_memory: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    for period in (2, 7):  # the steps between the rows of the samples
        rows = period * 20_000
        for boxes in (with_a_pattern(rows, period), with_a_pattern(rows, period).astype(np.float32)):
            collections = [dask.array.from_array(boxes, chunks=rows)]
            collections += [dask.dataframe.from_pandas(table(boxes).to_pandas(), npartitions=1)]
            for collection in collections:
                options = {"format": "xyxy", "closed": None, "missing": "raise", "margin": 0}
                sample = graph.source_of_collection(collection, None, None, "boxes", options).sample
                assert sample is not None and len(sample) == 20_000
                assert abs((sample[:, 0] > 500).mean() - (period - 1) / period) < 0.01
    # A cell that is split into 80: one box in 10 is in the sample.
    samples: list[Any] = []

    def noted(sample: Any, count: int) -> Any:
        samples.append(sample)
        return choose_cells(sample, count)

    monkeypatch.setattr(tasks, "choose_cells", noted)
    monkeypatch.setattr(tasks, "_SAMPLE_PER_CELL", 25)
    write("a.parquet", with_a_pattern(20_000, 10), group=20_000)
    sap.find_pairs("a.parquet", out="out", workers=0, cells=1)
    assert len(samples[0]) == 2000
    assert abs((samples[0][:, 0] > 500).mean() - 0.9) < 0.03


def test_the_hash_of_pairs_sees_which_ids_pair_and_not_their_order() -> None:
    ids = np.arange(100_000)
    whole = hash_pairs(ids, ids[::-1])
    order = np.random.default_rng(1).permutation(len(ids))
    assert hash_pairs(ids[order], ids[::-1][order]) == whole
    assert (hash_pairs(ids[:7], ids[::-1][:7]) + hash_pairs(ids[7:], ids[::-1][7:])) % 2**64 == whole
    assert hash_pairs(ids[::-1], ids) == whole, "here the same pairs"
    for other in (np.roll(ids[::-1], 1), np.where(ids == 5, 5, ids[::-1])):
        assert hash_pairs(ids, other) != whole
    assert hash_pairs(ids[:2], ids[2:4]) != hash_pairs(ids[:2], ids[[3, 2]])
    assert hash_pairs(ids[2:4], ids[:2]) != hash_pairs(ids[:2], ids[2:4])
    text = np.array(["a", "b", "c"], object)
    assert hash_pairs(text[:2], text[1:]) == hash_pairs(text[[1, 0]], text[[2, 1]]) != hash_pairs(text[:2], text[:2])


def test_ids_are_numbers_or_text_of_the_user_and_the_smaller_one_is_first() -> None:
    write("a.parquet")
    wanted = in_order(np.sort(10_000 - PAIRS, axis=1))
    for cells in (1, 11):
        result = sap.find_pairs("a.parquet", ids="number", out="out", workers=0, cells=cells, overwrite=True)
        assert np.array_equal(found(result), wanted)
        result = sap.find_pairs("a.parquet", ids="name", out="out", workers=0, cells=cells, overwrite=True)
        texts = result.compute().astype(object)
        assert (texts["a"] < texts["b"]).all()
        assert sorted(map(sorted, texts.to_numpy().tolist())) == sorted(
            sorted([f"n{a}", f"n{b}"]) for a, b in wanted.tolist()
        )
    frame = dask.dataframe.read_parquet("a.parquet", split_row_groups=True)
    assert np.array_equal(found(sap.find_pairs(frame, ids="number", cells=11)), wanted)
    texts = sap.find_pairs(frame, ids="name", cells=11).compute()
    assert sorted(map(sorted, texts.to_numpy().tolist())) == sorted(
        sorted([f"n{a}", f"n{b}"]) for a, b in wanted.tolist()
    )
    between = sap.find_pairs_between(frame, frame, ids=("number", "name"), cells=11).compute()
    assert (between["b"] == "n" + between["a"].astype(str)).sum() == len(BOXES)


def test_several_files_are_one_set_with_row_numbers_of_64_bits(monkeypatch: pytest.MonkeyPatch) -> None:
    Path("boxes").mkdir()
    for number, start in enumerate(range(0, 3000, 1000)):
        write(f"boxes/{number}.parquet", BOXES[start : start + 1000])
    write("boxes/_ignored.parquet", BOXES[:10])
    for paths in ("boxes", "boxes/[0-9].parquet", [f"boxes/{number}.parquet" for number in range(3)]):
        assert np.array_equal(found(sap.find_pairs(paths, cells=9)), PAIRS)
    # Row numbers beyond 2^32: as if many more rows came first.
    chunks = boxes_module.chunks_of_files
    far = 2**33

    def later(*arguments: Any) -> Any:
        return [chunk._replace(first=chunk.first + far) for chunk in chunks(*arguments)]

    monkeypatch.setattr(run_module, "chunks_of_files", later)
    assert np.array_equal(found(sap.find_pairs("boxes", out="out", workers=0, cells=9)), PAIRS + far)


def test_empty_inputs_and_partitions_without_rows() -> None:
    write("empty.parquet", BOXES[:0]), write("a.parquet")
    for cells in (None, 5):
        result = sap.find_pairs("empty.parquet", out="out", workers=0, cells=cells, overwrite=True)
        assert len(result.compute()) == 0 and sap.read_manifest("out").pairs == 0
        result = sap.find_pairs_between("a.parquet", "empty.parquet", out="out", workers=0, cells=cells, overwrite=True)
        assert len(result.compute()) == 0
        assert len(sap.find_pairs_between("empty.parquet", "a.parquet", cells=cells).compute()) == 0
        assert np.array_equal(found(sap.find_pairs(["empty.parquet", "a.parquet"], cells=cells)), PAIRS)
    frame = dask.dataframe.from_pandas(table(BOXES).to_pandas(), npartitions=4)
    frame = dask.dataframe.concat([frame, frame.partitions[0].query("minx < -1")])
    for cells in (None, 5):
        assert np.array_equal(found(sap.find_pairs(frame, cells=cells)), PAIRS)
    assert len(sap.find_pairs(frame.query("minx < -1"), cells=3).compute()) == 0


def test_arrays_frames_and_partitions_through_files() -> None:
    array = dask.array.from_array(BOXES, chunks=(700, 3))
    frame = dask.dataframe.from_pandas(table(BOXES).to_pandas(), npartitions=5)
    for boxes in (array, frame):
        assert np.array_equal(found(sap.find_pairs(boxes, cells=8)), PAIRS)
        assert sap.count_pairs(boxes, cells=8) == len(PAIRS)
        sap.find_pairs(boxes, out="out", workers=0, cells=8, overwrite=True)
        assert np.array_equal(dataset(), PAIRS)
    chosen = sap.find_pairs(frame, columns=["minx", "maxx"], cells=8)
    assert np.array_equal(found(chosen), in_order(core.find_pairs(BOXES[:, [0, 2]])))


def test_geoparquet_has_a_column_of_boxes_or_geometries() -> None:
    geopandas, shapely = pytest.importorskip("geopandas"), pytest.importorskip("shapely")
    frame = geopandas.GeoDataFrame({"n": np.arange(len(BOXES))}, geometry=shapely.box(*BOXES.T))
    frame.to_parquet("geometries.parquet")
    nested = pyarrow.table({"n": np.arange(len(BOXES)), "bbox": table(BOXES).select(range(4)).to_struct_array()})
    pyarrow.parquet.write_table(nested, "nested.parquet")
    assert np.array_equal(found(sap.find_pairs("geometries.parquet", out="g", workers=0, cells=5)), PAIRS)
    names = ["xmin", "ymin", "xmax", "ymax"]
    boxes = pyarrow.StructArray.from_arrays([pyarrow.array(column) for column in BOXES.T], names)
    pyarrow.parquet.write_table(pyarrow.table({"n": np.arange(len(BOXES)), "bbox": boxes}), "nested.parquet")
    assert np.array_equal(found(sap.find_pairs("nested.parquet", out="n", workers=0, cells=5)), PAIRS)
    # Geometries count before columns that are known as boxes, as in memory.
    others = frame.assign(start=0, end=pandas.Timestamp("2026-01-01"), minx=0, maxx=1, xmin=0)
    for options in ({}, {"geometry_encoding": "geoarrow"}):
        others.to_parquet("others.parquet", **options)
        assert np.array_equal(found(sap.find_pairs("others.parquet", cells=5)), PAIRS)
        assert np.array_equal(in_order(core.find_pairs(pyarrow.parquet.read_table("others.parquet"))), PAIRS)
        with pytest.raises(ValueError, match=r'others\.parquet has geometries, .*: leave out format="xywh"'):
            sap.find_pairs("others.parquet", format="xywh")
    assert sap.count_pairs("others.parquet", columns=["minx", "maxx"]) == len(BOXES) * (len(BOXES) - 1) // 2
    others.iloc[:0].to_parquet("none.parquet")
    assert sap.count_pairs("none.parquet") == 0


def test_precision_is_that_of_the_same_table_in_memory() -> None:
    single = np.array([[0, 0, 0.1, 0.1], [0.3, 0.3, 0.4, 0.4]], np.float32)
    margin = 0.2  # finds the pair in single precision only
    assert core.count_pairs(single, margin=margin) == 1 and core.count_pairs(single.astype(float), margin=margin) == 0
    names = ["xmin", "ymin", "xmax", "ymax"]
    columns = [pyarrow.array(column) for column in single.T]
    lists = pyarrow.FixedSizeListArray.from_arrays(pyarrow.array(single.ravel()), 4)
    halves = pyarrow.table([pyarrow.array(column.astype(np.float16)) for column in single.T], names=names)
    tables = [
        pyarrow.table(columns, names=names),
        pyarrow.table({"bbox": pyarrow.StructArray.from_arrays(columns, names)}),
        pyarrow.table({"bbox": lists}),
        pyarrow.table({"bbox": pyarrow.array(lists.to_pylist(), pyarrow.list_(pyarrow.float32()))}),
        halves,
    ]
    for one in tables:
        pyarrow.parquet.write_table(one.append_column("n", [[1, 1]]), "a.parquet")
        gaps = [margin] if one is not halves else [float(np.float16(0.3)) - float(np.float16(0.1)) - 1e-9]
        for gap in gaps:
            wanted = core.count_pairs(one, margin=gap)
            assert wanted == (one is not halves)
            for by in (None, "n"):
                assert sap.count_pairs("a.parquet", margin=gap, by=by, workers=0) == wanted, (one.schema, by)
    for dtype in ("float32", "Float32", "float[pyarrow]", "float64"):
        frame = pandas.DataFrame(single, columns=names).astype(dtype)
        wanted = core.count_pairs(frame, margin=margin)
        assert wanted == (dtype != "float64")
        assert sap.count_pairs(dask.dataframe.from_pandas(frame, npartitions=2), margin=margin) == wanted, dtype


def test_a_column_may_be_chosen_twice() -> None:
    points = pandas.DataFrame({"lon": [0.0, 1.0, 0.0], "lat": [0.0, 1.0, 0.0]})
    points.to_parquet("a.parquet")
    for boxes in (dask.dataframe.from_pandas(points, npartitions=2), "a.parquet"):
        assert found(sap.find_pairs(boxes, columns=["lon", "lat"] * 2)).tolist() == [[0, 2]]


def test_options_are_those_of_the_finder() -> None:
    boxes = BOXES[:800].copy()
    sizes = np.hstack([boxes[:, :2], boxes[:, 2:] - boxes[:, :2]])
    write("a.parquet", boxes)
    pyarrow.parquet.write_table(pyarrow.table(dict(zip("xywh", sizes.T))), "s.parquet")
    missing = boxes.copy()
    missing[::7, 1] = np.nan
    write("m.parquet", missing)
    for path, values, options in (
        ("a.parquet", boxes, {"closed": "neither"}),
        ("a.parquet", boxes, {"margin": 0.5}),
        ("a.parquet", boxes, {"margin": [0.5, 1]}),
        ("s.parquet", sizes, {"format": "xywh"}),
        ("m.parquet", missing, {"missing": "skip"}),
    ):
        wanted = in_order(core.find_pairs(values, **options))
        result = sap.find_pairs(path, out="out", workers=0, cells=6, overwrite=True, **options)
        assert np.array_equal(found(result), wanted), options
    assert sap.read_manifest("out").boxes == [800 - len(missing[::7])]


def test_whole_numbers_are_exact_up_to_2_to_the_53() -> None:
    boxes = np.array([[0, 2**52], [2**52, 2**52 + 1], [2**52 + 1, 2**53]])
    write("a.parquet", boxes)
    assert found(sap.find_pairs("a.parquet", cells=2)).tolist() == [[0, 1], [1, 2]]
    write("a.parquet", boxes * 3)
    with pytest.raises(sap.DatasetError, match=r"a\.parquet: coordinates beyond 2\^53 are not exact"):
        sap.find_pairs("a.parquet", out="out", workers=0)


@pytest.mark.parametrize("cells", [1, 7])
def test_an_invalid_box_is_named_by_its_file_and_row(cells: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(run_module, "_CHUNK_ROWS", 300)
    monkeypatch.setattr(run_module, "_SLAB_ROWS", 70)
    for number in range(3):
        boxes = BOXES[1000 * number : 1000 * (number + 1)].copy()
        if number == 2:
            boxes[555, 1] = np.nan
            boxes[777] = [3, 3, 2, 4]
        write(f"{number}.parquet", boxes, group=100)
    with pytest.raises(sap.InvalidRowError) as caught:
        sap.find_pairs("*.parquet", out="out", workers=0, cells=cells)
    assert str(caught.value) == (
        f"2.parquet, row 555 (the first is 0): the box has a NaN on axis 1 (min nan, max {int(BOXES[2555, 3])}): "
        'remove it or replace it, or pass missing="skip"'
    )
    assert (caught.value.index, caught.value.row, caught.value.place) == (2555, 555, "2.parquet")
    with pytest.raises(sap.InvalidRowError, match=r"2\.parquet, row (555|777) "):
        sap.find_pairs("*.parquet", cells=cells).compute()
    assert not Path("out").exists()


def test_missing_and_damaged_files_and_wrong_columns_are_named() -> None:
    def refused(*arguments: Any, **options: Any) -> str:
        with pytest.raises(sap.DatasetError) as caught:
            sap.find_pairs(*arguments, out="out", workers=0, overwrite=True, **options)
        assert not Path("out").exists()
        return str(caught.value)

    assert refused("a.parquet") == "a.parquet names no Parquet file: is the path right?"
    Path("a.parquet").write_bytes(b"PAR1 but not really")
    assert "a.parquet cannot be read" in refused("a.parquet")
    write("b.parquet")
    content = bytearray(Path("b.parquet").read_bytes())
    content[2000:9000] = b"\xff" * 7000
    Path("b.parquet").write_bytes(content)
    assert "b.parquet is damaged after row 0" in refused("b.parquet", cells=5)
    pyarrow.parquet.write_table(pyarrow.table({"p": [1.0], "q": [2.0]}), "c.parquet")
    assert "c.parquet has no columns that are known as boxes" in refused("c.parquet")
    assert "its columns are p, q" in refused("c.parquet", columns=["p", "r"])
    pyarrow.parquet.write_table(table(BOXES).select([0, 1, 2, 3]).rename_columns([*"xywh"]), "g.parquet")
    assert 'known as boxes: pass format="xywh"; its columns are x, y, w, h' in refused("g.parquet")
    write("d.parquet"), pyarrow.parquet.write_table(table(BOXES).drop_columns(["maxy"]), "e.parquet")
    assert "e.parquet has no column 'maxy'" in refused(["d.parquet", "e.parquet"])
    missing = table(BOXES).set_column(4, "number", pyarrow.array([None, *range(len(BOXES) - 1)], pyarrow.int64()))
    pyarrow.parquet.write_table(missing, "f.parquet")
    assert "f.parquet, row 0 (the first is 0): column number has no id" in refused("f.parquet", ids="number")
    write("g.parquet", random_boxes(10, 3, np.float64))
    with pytest.raises(sap.DatasetError, match="they must be the same"):
        sap.find_pairs_between("d.parquet", "g.parquet", cells=2)


def test_a_collection_of_other_boxes_is_not_taken_for_the_same() -> None:
    def collection(x: float, name: str = "a") -> Any:
        boxes = {"minx": [0, x], "miny": [0, 0], "maxx": [1, x + 1], "maxy": [1, 1]}
        frame = pandas.DataFrame({**boxes, "name": ["b", name]})
        return dask.dataframe.from_pandas(frame, npartitions=1)

    rows = [dask.array.from_array(np.array([[0, 0, 1, 1], [x, 0, x + 1, 1]]), chunks=(1, 4)) for x in (0.5, 50)]
    for number, (same, other, options) in enumerate(
        [(*rows, {}), (collection(0.5), collection(50.0), {}), (collection(0.5), collection(0.5, "c"), {"ids": "name"})]
    ):
        given: dict[str, Any] = {"out": f"out-{number}", "workers": 0, **options}
        found = sap.find_pairs(same, **given).compute()
        assert len(found) == 1 and sap.find_pairs(same, **given).compute().equals(found)
        with pytest.raises(sap.DatasetError, match="other boxes or other options"):
            sap.find_pairs(other, **given)


@pytest.mark.parametrize("dtype", ["Int64", "string", "object"])
def test_a_missing_id_of_a_collection_is_named(dtype: str) -> None:
    ids = pandas.array([3, None] if dtype == "Int64" else ["a", float("nan") if dtype == "object" else None], dtype)
    frame = dask.dataframe.from_pandas(pandas.DataFrame({"start": [0, 1], "end": [5, 6], "name": ids}), npartitions=1)
    for lazy in (sap.find_pairs(frame, ids="name"), sap.find_pairs_between(frame, frame, ids="name")):
        with pytest.raises(sap.DatasetError, match=r"row 1 \(the first is 0\): column name has no id"):
            lazy.compute()


def test_wrong_arguments_are_refused() -> None:
    write("a.parquet")
    with pytest.raises(TypeError, match=r"sweep_and_prune.find_pairs takes arrays"):
        sap.find_pairs(BOXES)
    with pytest.raises(ValueError, match="pass out, a folder"):
        sap.find_pairs("a.parquet", memory_limit="4GB")
    with pytest.raises(ValueError, match="memory_limit is 100MB"):
        sap.find_pairs("a.parquet", out="out", memory_limit="100MB", workers=2)
    with pytest.raises(ValueError, match="cells must be"):
        sap.find_pairs("a.parquet", cells=0)
    with pytest.raises(ValueError, match="missing must be"):
        sap.find_pairs("a.parquet", missing="maybe")


def test_an_interrupted_run_continues_wherever_it_was(monkeypatch: pytest.MonkeyPatch, small_memory: None) -> None:
    monkeypatch.setattr(run_module, "_CHUNK_ROWS", 700)
    boxes = BOXES.copy()
    boxes[:900] /= 10  # so that some cell is split again
    write("a.parquet", boxes)
    sap.find_pairs("a.parquet", out="whole", workers=0, cells=6)
    wanted = sap.read_manifest("whole")
    assert any(one["name"].count(".") > 1 for one in wanted.files)
    interrupted = {"as it was": 0, "with more memory": 0, "without the boxes": 0}
    for number, after in enumerate(range(0, 32)):
        with monkeypatch.context() as patch:
            interrupt(patch, after)
            try:
                sap.find_pairs("a.parquet", out="out", workers=0, cells=6)
            except Interrupted:
                assert not Path("out").exists() and Path("out.unfinished").exists()
                with pytest.raises(sap.DatasetError, match="no finished dataset"):
                    sap.read_manifest("out")
            else:
                break
        done = {path: path.stat().st_mtime_ns for path in Path("out.unfinished").glob("*.parquet")}
        Path(f"out.unfinished/cell-00000.parquet.{'0' * 32}.part").write_bytes(b"half of a file")
        way = list(interrupted)[number % 3]
        interrupted[way] += 1
        with monkeypatch.context() as patch:
            # A cell that was split stays split in the same way.
            if way == "with more memory":
                patch.setattr(workers, "_for_boxes", lambda memory, limit: 10**9)
            elif way == "without the boxes":
                patch.setattr(run_module, "_LEAST_ROWS", 250)
                shutil.rmtree("out.unfinished/spill", ignore_errors=True)
            sap.find_pairs("a.parquet", out="out", workers=0, cells=6, spill="." if number % 2 else None)
        manifest = sap.read_manifest("out")
        assert (manifest.pairs, manifest.hash) == (wanted.pairs, wanted.hash), (after, way)
        assert np.array_equal(dataset(), dataset("whole"))
        assert {path.suffix for path in Path("out").iterdir()} == {".parquet", ".json"}
        assert not list(Path().glob("sweep-and-prune-*"))
        for path, changed in done.items():
            assert (Path("out") / path.name).stat().st_mtime_ns == changed, "it was not written again"
        shutil.rmtree("out")
    assert min(interrupted.values()) > 5


def test_a_run_continues_only_with_the_same_boxes_and_options(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    with monkeypatch.context() as patch:
        interrupt(patch, 3)
        with pytest.raises(Interrupted):
            sap.find_pairs("a.parquet", out="out", workers=0, cells=6)
    with pytest.raises(sap.DatasetError, match="interrupted run of other boxes or other options"):
        sap.find_pairs("a.parquet", out="out", workers=0, cells=6, margin=1)
    write("a.parquet", BOXES[::-1])
    with pytest.raises(sap.DatasetError, match="interrupted run of other boxes or other options"):
        sap.find_pairs("a.parquet", out="out", workers=0, cells=6)
    sap.find_pairs("a.parquet", out="out", workers=0, cells=6, overwrite=True)
    assert np.array_equal(dataset(), in_order(core.find_pairs(BOXES[::-1])))
    changed = Path("out/_manifest.json").stat().st_mtime_ns
    sap.find_pairs("a.parquet", out="out", workers=0, cells=6)
    assert Path("out/_manifest.json").stat().st_mtime_ns == changed, "it was finished"
    with pytest.raises(sap.DatasetError, match="pairs of other boxes or other options"):
        sap.find_pairs("a.parquet", out="out", workers=0, cells=7)
    Path("mine").mkdir()
    Path("mine/thesis.txt").write_text("all that I have")
    with pytest.raises(sap.DatasetError, match="exists and is no dataset of pairs"):
        sap.find_pairs("a.parquet", out="mine", workers=0, overwrite=True)
    assert Path("mine/thesis.txt").exists()


def test_a_damaged_file_of_pairs_is_written_again(monkeypatch: pytest.MonkeyPatch) -> None:
    write("a.parquet")
    with monkeypatch.context() as patch:
        interrupt(patch, 6)
        with pytest.raises(Interrupted):
            sap.find_pairs("a.parquet", out="out", workers=0, cells=8)
    damaged = sorted(Path("out.unfinished").glob("*.parquet"))[0]
    damaged.write_bytes(damaged.read_bytes()[:-100])
    sap.find_pairs("a.parquet", out="out", workers=0, cells=8)
    assert np.array_equal(dataset(), PAIRS)


def test_a_full_disk_is_one_error_after_which_the_run_continues(monkeypatch: pytest.MonkeyPatch) -> None:
    import errno

    write("a.parquet")
    for module, name in ((tasks, "scatter"), (tasks, "pair_file")):
        real, calls = getattr(module, name), 0

        def failing(*arguments: Any) -> Any:
            nonlocal calls
            calls += 1
            if calls == (1 if name == "scatter" else 3):
                raise OSError(errno.ENOSPC, "No space left on device")
            return real(*arguments)

        with monkeypatch.context() as patch:
            patch.setattr(module, name, failing)
            with pytest.raises(sap.DatasetError, match=r"the disk is full .* the run continues where it stopped"):
                sap.find_pairs("a.parquet", out="out", workers=0, cells=8)
        assert not Path("out").exists()
    sap.find_pairs("a.parquet", out="out", workers=0, cells=8)
    assert np.array_equal(dataset(), PAIRS)
    usage = shutil.disk_usage(".")._replace(free=1000)
    monkeypatch.setattr(shutil, "disk_usage", lambda path: usage)
    with pytest.raises(sap.DatasetError, match=r"the boxes take 0.0 GB there, and 0.0 GB are free"):
        sap.find_pairs("a.parquet", out="other", workers=0, cells=8)


def test_two_runs_at_once_are_refused() -> None:
    fcntl = pytest.importorskip("fcntl")
    write("a.parquet")
    Path("out.unfinished").mkdir()
    with open("out.unfinished/lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(sap.DatasetError, match="is in use by another run"):
            sap.find_pairs("a.parquet", out="out", workers=0)


SCRIPT = """
import sys
import sweep_and_prune.dask as sap
if __name__ == "__main__":
    sap.find_pairs("a.parquet", out="out", memory_limit="3GB", workers=2, cells=60)
    print(sap.read_manifest("out").hash)
"""


@pytest.fixture(scope="module")
def large(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, str]]:
    """A file of boxes and the hash of their pairs."""
    folder = tmp_path_factory.mktemp("large")
    path, boxes = str(folder / "a.parquet"), random_boxes(200_000, 2, np.float64)
    pyarrow.parquet.write_table(table(boxes).select(range(4)), path, row_group_size=10_000)
    out = str(folder / "whole")
    sap.find_pairs(path, out=out)
    assert sap.read_manifest(out).pairs == core.count_pairs(boxes)
    yield path, sap.read_manifest(out).hash


def started(path: str) -> Any:
    """A run that has begun to write the boxes."""
    shutil.copy(path, "a.parquet")
    Path("script.py").write_text(SCRIPT)
    program = subprocess.Popen(
        [sys.executable, "script.py"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while program.poll() is None and not list(Path().glob("out.unfinished/spill/*.json")):
        time.sleep(0.01)
    return program


@pytest.mark.skipif(sys.platform != "linux", reason="processes are found in the way of Linux")
def test_workers_that_are_killed_change_nothing(large: tuple[str, str]) -> None:
    path, wanted = large
    program = started(path)
    kills = 0
    while program.poll() is None and kills < 5:
        for child in children_of(program.pid):
            os.kill(child, signal.SIGKILL)
            kills += 1
        time.sleep(0.5)
    out, err = program.communicate(timeout=300)
    assert (program.returncode, out.strip()) == (0, wanted), err
    assert kills > 1


@pytest.mark.skipif(sys.platform != "linux", reason="processes are found in the way of Linux")
def test_workers_that_die_while_they_start_are_replaced() -> None:
    killed: set[int] = set()

    def kill() -> None:
        while len(killed) < 3:  # as soon as they are there
            for child in set(children_of(os.getpid())) - killed:
                os.kill(child, signal.SIGKILL)
                killed.add(child)

    killer = threading.Thread(target=kill, daemon=True)
    killer.start()
    with workers.started("2GB", 1) as of_this_machine:
        killer.join()
        found: list[int] = []
        of_this_machine.run(abs, [(-3,), (4,)], found.append)
        assert sorted(found) == [3, 4]


def test_a_client_that_is_closed_is_an_error() -> None:
    from distributed import Client, LocalCluster

    options: dict[str, Any] = {"n_workers": 1, "threads_per_worker": 1, "processes": False, "dashboard_address": ":0"}
    with LocalCluster(**options) as cluster, Client(cluster, set_as_default=False) as client:
        threading.Timer(0.5, client.close).start()
        with pytest.raises(sap.DatasetError, match="the workers of Dask were closed"):
            workers.Workers(client, 1, 0).run(time.sleep, [(2,)] * 3, print)


@pytest.mark.skipif(sys.platform != "linux", reason="processes are found in the way of Linux")
def test_a_run_that_is_killed_continues(large: tuple[str, str]) -> None:
    path, wanted = large
    program = started(path)
    os.killpg(program.pid, signal.SIGKILL)
    program.communicate(timeout=600)
    assert not Path("out").exists()
    sap.find_pairs("a.parquet", out="out", memory_limit="3GB", workers=0, cells=60)
    assert sap.read_manifest("out").hash == wanted


def test_the_workers_of_an_active_client_are_used(large: tuple[str, str]) -> None:
    from distributed import Client

    path, wanted = large
    with Client(n_workers=1, threads_per_worker=2, processes=False, dashboard_address=":0"):
        sap.find_pairs(path, out="out", cells=5)
        assert sap.read_manifest("out").hash == wanted
        frame = dask.dataframe.read_parquet(path)
        count = sap.read_manifest("out").pairs
        assert sap.count_pairs(frame, cells=5) == count == len(sap.find_pairs(path, cells=5))
        Path("bad.parquet").write_bytes(Path(path).read_bytes()[:-20])
        with pytest.raises(sap.DatasetError, match=r"bad.parquet cannot be read"):
            sap.find_pairs("bad.parquet", out="bad")


def test_the_workers_of_a_client_are_found_while_its_own_thread_asks_for_them() -> None:
    from dask import config
    from distributed import Client

    with config.set({"distributed.client.scheduler-info-interval": "1ms"}):
        with Client(n_workers=1, threads_per_worker=1, processes=False, dashboard_address=":0"):
            for _ in range(100):
                with workers.started(None, None) as of_client:
                    assert of_client.number == 1


def test_the_manifest_says_what_is_there() -> None:
    write("a.parquet")
    sap.find_pairs("a.parquet", out="out", workers=0, cells=4)
    said = json.loads(Path("out/_manifest.json").read_text())
    assert (said["pairs"], said["boxes"]) == (len(PAIRS), [3000]) and 1 < said["copies"] < 1.5
    Path("out/_manifest.json").write_text("{}")
    with pytest.raises(sap.DatasetError, match=r"_manifest\.json is damaged"):
        sap.read_manifest("out")


def test_progress_goes_from_0_to_1() -> None:
    write("a.parquet")
    seen: list[float] = []
    sap.find_pairs("a.parquet", out="out", workers=0, cells=9, progress=seen.append)
    assert seen == sorted(seen) and len(seen) > 8 and seen[-1] == 1
    assert pandas.Series(seen).between(0, 1).all()
