"""A run in the window goes on from where it differs from the last one, and gives what it would have given alone."""

import gc
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
import pytest
import shapely
from executed_stages import functions_of
from lanewright.core.common.errors import Cancelled
from lanewright.core.common.features import CORRECTIONS, Features
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.kept_run import KeptRun
from lanewright.core.execution.phase import Threads
from lanewright.core.io.geotiff import IntensityImage
from lanewright.core.pipeline import road_map as chain
from lanewright.core.pipeline.road_map import RoadMapSettings, make_road_map
from lanewright.core.survey.open_survey import SurveySettings
from lanewright.core.survey.store.array_file import ArrayFile
from shapely.ops import substring

pytestmark = pytest.mark.slow

LAYERS = ("edges", "surface", "markings", "marking_lines", "driving_lines", "lanes", "curve_elements")
READING = ("open_survey", "find_curb_points", "draw_boundaries")
SETTINGS = RoadMapSettings(boundary_method="profiles")   # one method makes a map sooner
SURFACE = (*READING, "extract_road_surface", "intensity_corrected", "make_intensity_image", "extract_markings", "remove_outliers", "cluster_markings")


@pytest.fixture(scope="module")
def street(made_survey):
    return made_survey(length=24.0, pulse_rate=60_000.0, rotation_rate=90.0)


@pytest.fixture
def kept():
    kept = KeptRun()
    kept.wanted = True
    yield kept
    kept.end()


def made(street, folder, kept=None, corrections=None, settings=SETTINGS):
    """(all layers, pixels of the image) of a run, and its RoadMap."""
    sample, cloud = street
    road_map = make_road_map([cloud], sample.trajectory, folder / "intensity.tif", settings, corrections=corrections, kept=kept or KeptRun())
    layers = [road_map.layer(name) for name in LAYERS]
    image = IntensityImage.open(folder / "intensity.tif")
    found = [([g and shapely.to_wkb(g) for g in layer.geometries], repr(layer.rows)) for layer in layers], \
        image.read_pixels(0, 0, image.width, image.height).tobytes(), repr([road_map.density, road_map.counts])
    road_map.free()
    return found, road_map


def without(monkeypatch, stages):
    def refused(*_, **__):
        raise AssertionError("this stage was run again")

    for stage in stages:
        monkeypatch.setattr(chain, stage, refused)


def moved_edge(road_map, length=np.inf):
    """The correction of an edge that lies 20 cm farther out, along so many metres of it."""
    layer = Features("any", CORRECTIONS, crs=road_map.crs)
    line = next(line for line, row in road_map.layer("edges") if row["side"] == "left" and row["status"] == "measured")
    farther = shapely.transform(substring(line, 0.0, length), lambda places: places + [0.0, 0.2, 0.0], include_z=True)
    layer.add(farther, action="move", target="edge", note="seen in the image")
    return layer


def without_lane(road_map):
    layer = Features("any", CORRECTIONS, crs=road_map.crs)
    layer.add(road_map.driving_lines.geometries[0], action="delete", target="lane")
    return layer


def moved_line(road_map, aside):
    """The correction of a marking line that lies some metres farther to the side."""
    layer = Features("any", CORRECTIONS, crs=road_map.crs)
    line = next(line for line, row in road_map.marking_lines if row["status"] == "measured")
    layer.add(shapely.transform(line, lambda places: places + [0.0, aside, 0.0], include_z=True), action="move", target="marking")
    return layer


@pytest.fixture(scope="module")
def alone(street, tmp_path_factory):
    """What runs give that keep nothing: as surveyed, with an edge that is moved, and with a lane that is deleted."""
    folder = tmp_path_factory.mktemp("alone")
    found, road_map = made(street, folder)
    return found, made(street, folder, corrections=moved_edge(road_map))[0], made(street, folder, corrections=without_lane(road_map))[0]


def test_a_corrected_edge_or_lane_takes_the_stages_after_it_alone_and_gives_the_same(street, alone, tmp_path, monkeypatch, kept):
    assert alone[0] != alone[1] and alone[0] != alone[2]
    found, road_map = made(street, tmp_path, kept)
    assert found == alone[0]
    with monkeypatch.context() as patch:
        without(patch, (*SURFACE, "traced_lines", "make_driving_lines"))
        assert made(street, tmp_path, kept, without_lane(road_map))[0] == alone[2]
        assert made(street, tmp_path, kept)[0] == alone[0]
    with monkeypatch.context() as patch:
        without(patch, READING)
        assert made(street, tmp_path, kept, moved_edge(road_map))[0] == alone[1]
        # taken back, nothing is made again but the image, of which there is one
        without(patch, {*SURFACE, "traced_lines", "make_driving_lines"} - {"make_intensity_image"})
        assert made(street, tmp_path, kept)[0] == alone[0]


def test_a_moved_line_takes_its_name_and_the_lanes_alone_and_is_never_that_of_another_correction(street, alone, tmp_path, monkeypatch, kept):
    _, road_map = made(street, tmp_path, kept)
    without(monkeypatch, (*SURFACE, "traced_lines"))
    moved = [moved_line(road_map, aside) for aside in (0.1, 0.2)]
    found = [made(street, tmp_path, kept, corrections)[0] for corrections in moved]
    assert found[0] != found[1]
    monkeypatch.undo()
    assert [made(street, tmp_path, corrections=corrections)[0] for corrections in moved] == found
    without(monkeypatch, (*SURFACE, "traced_lines", "estimate_lanes", "make_driving_lines"))
    assert made(street, tmp_path, kept, moved[0])[0] == found[0]


def test_another_lane_setting_leaves_the_lines_as_they_were_traced(street, alone, tmp_path, monkeypatch, kept):
    settings = replace(SETTINGS, driving=replace(SETTINGS.driving, shortest=12.0))
    assert made(street, tmp_path, kept)[0] == alone[0]
    without(monkeypatch, (*SURFACE, "traced_lines"))
    made(street, tmp_path, kept, settings=settings)


def test_a_corrected_edge_changes_the_stretches_beside_it_alone(street, tmp_path, monkeypatch, kept):
    asked, run, settings = {}, Threads.run, replace(SETTINGS, survey=SurveySettings(section_length=1.0))

    def noting(self, phase, items, *others):
        for name, count in functions_of(phase, items).items():
            asked.setdefault(name, []).append(count)
        return run(self, phase, items, *others)

    _, road_map = made(street, tmp_path, kept, settings=settings)
    corrections = moved_edge(road_map, 2.0)
    alone, _ = made(street, tmp_path, corrections=corrections, settings=settings)
    monkeypatch.setattr(Threads, "run", noting)
    assert made(street, tmp_path, kept, corrections, settings)[0] == alone
    _, again = made(street, tmp_path, kept, settings=settings)
    stretches = len(again.road_points.stretches())
    for name in ("surface_points", "corrected_of_stretch"):
        assert stretches > 10 and 1 <= sum(asked[name]) <= stretches / 2, name


@contextmanager
def cancelled_at(monkeypatch, stage):
    """What runs in here is cancelled where a stage begins."""
    def cancelled(*_, **__):
        raise Cancelled

    with monkeypatch.context() as patch, pytest.raises(Cancelled):
        patch.setattr(chain, stage, cancelled)
        yield


def test_a_run_that_was_cancelled_goes_on_where_it_was(street, alone, tmp_path, monkeypatch, kept):
    with cancelled_at(monkeypatch, "cluster_markings"):
        made(street, tmp_path, kept)
    without(monkeypatch, SURFACE[:-1])
    assert made(street, tmp_path, kept)[0] == alone[0]


def test_after_a_run_that_was_cancelled_early_the_next_whole_one_is_kept(street, tmp_path, monkeypatch, kept):
    with cancelled_at(monkeypatch, "_corrected"):
        made(street, tmp_path, kept, settings=RoadMapSettings())
    found, _ = made(street, tmp_path, kept, settings=RoadMapSettings())
    without(monkeypatch, READING)
    assert made(street, tmp_path, kept, settings=RoadMapSettings())[0] == found


def test_of_one_run_alone_points_stay_on_the_disk(street, tmp_path, kept):
    def on_the_disk():
        gc.collect()
        return [thing for thing in gc.get_objects() if isinstance(thing, ArrayFile) and thing.end]

    before = len(on_the_disk())
    made(street, tmp_path, kept)
    first = len(on_the_disk())
    made(street, tmp_path, kept, settings=replace(SETTINGS, survey=SurveySettings(section_length=7.0)))
    assert len(on_the_disk()) == first > before
    kept.end()
    assert len(on_the_disk()) == before


def test_worker_processes_leave_files_that_serve_again_until_the_window_ends(street, alone, tmp_path, monkeypatch, kept):
    settings = replace(SETTINGS, execution=ExecutionSettings(workers=2))
    found, road_map = made(street, tmp_path, kept, settings=settings)
    folder = road_map.road_points.survey.executor.folder
    files = {path.name for path in folder.glob("*.bin")}
    without(monkeypatch, READING)
    assert found == alone[0] and made(street, tmp_path, kept, moved_edge(road_map), settings)[0] == alone[1]
    corrected = {path.name for path in folder.glob("points-*.bin")}
    assert len(corrected) > len(corrected & files) > 0
    assert made(street, tmp_path, kept, settings=settings)[0] == alone[0]
    assert {path.name for path in folder.glob("points-*.bin")} == corrected
    kept.end()
    assert not folder.exists()


def test_two_runs_at_once_do_not_share_and_outside_of_a_window_nothing_is_kept(street, alone, tmp_path, kept):
    assert kept.take()
    found, road_map = made(street, tmp_path, kept)
    assert found == alone[0] and not road_map.road_points.store.roads()
    kept.give_back()
    assert np.isfinite(road_map.frame.origin).all() and not kept.known("survey", "")
