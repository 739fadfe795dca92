"""Control points proposed from paint: the same corners in both images, and none where the paint does not tell the place."""

import numpy as np
import pytest
import shapely
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.overlay.control_points import control_points, open_image
from lanewright.products.overlay.georeference import georeference
from lanewright.products.overlay.matching.propose import AMBIGUOUS, ProposalSettings, propose_control_points
from lanewright.products.overlay.rough_place import pair_cutouts, rough_place
from lanewright.products.report.overlay import proposed_points_report
from lanewright.simulator.orthophoto import uav_control_points, write_uav_image
from lanewright.simulator.survey import SampleSettings, make_sample_survey
from paint_from_above import EAST, NORTH, Ground, Overhead, about, arrow, bar, dashes, errors, near, street, zebra

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def surveyed(tmp_path_factory):
    """The intensity image of the street."""
    return Ground(street()).intensity_image(tmp_path_factory.mktemp("surveyed") / "intensity.tif")


def proposal(tmp_path, intensity, camera, ground=None, rough=None, settings=None, **seen):
    photo = (ground or Ground(street())).photo(tmp_path / "photo.png", camera, **seen)
    return propose_control_points(photo, intensity, rough or near(camera), settings)


UPSIDE_DOWN = Overhead(turn=2.2, size=0.03, width=2400, height=800)


@pytest.fixture(scope="module")
def found_upside_down(tmp_path_factory, surveyed):
    return proposal(tmp_path_factory.mktemp("upside_down"), surveyed, UPSIDE_DOWN, rough=about(UPSIDE_DOWN))


@pytest.mark.parametrize("camera", [Overhead(), UPSIDE_DOWN, Overhead(turn=-0.4, tilt=0.03)],
                         ids=["along the road", "upside down and finer", "tilted"])
def test_pairs_lie_where_the_camera_saw_them(tmp_path, surveyed, found_upside_down, camera):
    found = found_upside_down if camera is UPSIDE_DOWN else proposal(tmp_path, surveyed, camera, rough=near(camera) if camera.tilt else about(camera))
    off = errors(found, camera)[found.accepted]
    assert found.accepted.sum() >= 25
    assert off.max() < 0.05 and np.sqrt(np.mean(off**2)) < 0.02
    assert found.rmse < 0.03
    assert np.hypot(found.rival.dx, found.rival.dy) > 0.5 and found.rival.margin >= 1.0
    assert np.exp(1j * found.turn) == pytest.approx(np.exp(1j * camera.turn), abs=0.02)


def test_shadows_across_the_road_cost_pairs_but_make_none_false(tmp_path, surveyed):
    found = proposal(tmp_path, surveyed, Overhead(), light=lambda x, y: np.where((x + y) % 14 < 6, 0.45, 1.0))
    assert found.accepted.sum() >= 12
    assert errors(found, Overhead())[found.accepted].max() < 0.06


def test_paint_darker_than_the_road_is_found_too(tmp_path, surveyed):
    camera = Overhead(turn=0.3)
    found = proposal(tmp_path, surveyed, camera, dark_paint=True)
    assert found.accepted.sum() >= 20
    assert errors(found, camera)[found.accepted].max() < 0.05


def test_an_image_without_position_is_found_by_its_pixel_size(tmp_path, surveyed):
    camera = Overhead(turn=3.3, width=1500, height=500)
    photo = Ground(street()).photo(tmp_path / "photo.png", camera)
    found = propose_control_points(photo, surveyed, rough_place(photo, surveyed.crs, 15.0, 0.042))
    assert found.accepted.sum() >= 12 and errors(found, camera)[found.accepted].max() < 0.05


@pytest.mark.parametrize("paint", [
    [bar(40, -11, 80, 0.15), bar(40, -19, 80, 0.15), *dashes(-15, 0, 80)],
    [b for y in (-13, -17) for b in dashes(y, 0, 80)],
    zebra(40, -19.5, 10),
], ids=["a dashed line between edge lines", "two dashed lines", "a zebra crossing"])
def test_paint_that_repeats_gives_no_accepted_pair_that_is_false(tmp_path, paint):
    """The photo shows less than the survey: a period farther on it would look the same."""
    ground, camera = Ground(paint), Overhead(width=700, height=400)
    try:
        found = proposal(tmp_path, ground.intensity_image(tmp_path / "intensity.tif"), camera, ground, about(camera))
    except RoadExtractionError as refused:
        assert "do not fit each other" in str(refused)
    else:
        assert (errors(found, camera)[found.accepted] < 0.1).all()


def test_a_long_zebra_crossing_is_said_to_repeat(tmp_path):
    ground = Ground([bar(20 + 1.0 * k, -15, 4.0, 0.5, 90) for k in range(40)])
    camera = Overhead(width=600, height=300)
    found = proposal(tmp_path, ground.intensity_image(tmp_path / "intensity.tif"), camera, ground, about(camera))
    assert not found.accepted.any() and AMBIGUOUS in found.why
    assert "The paint repeats" in found.notes[0]


def test_other_paint_of_another_year_gives_no_pair(tmp_path, surveyed):
    anew = [bar(40, -11, 78, 0.15), bar(40, -19, 78, 0.15), *dashes(-13.5, 5, 78, 6, 12), *dashes(-16.5, 8, 78, 6, 12), *arrow(20, -12)]
    with pytest.raises(RoadExtractionError, match="painted anew"):
        proposal(tmp_path, surveyed, Overhead(width=1200, height=500), Ground(anew))


def test_a_wrong_scale_and_a_bare_road_are_told(tmp_path, surveyed):
    camera = Overhead(width=800, height=400)
    with pytest.raises(RoadExtractionError, match="another scale"):
        proposal(tmp_path, surveyed, camera, rough=near(camera, size=1.6))
    with pytest.raises(RoadExtractionError, match="do not fit each other"):
        proposal(tmp_path, surveyed, camera, Ground([]))


def test_an_image_of_another_place_is_told_how_far_away_it_lies(tmp_path, surveyed):
    with pytest.raises(RoadExtractionError, match=r"do not overlap: .* 40\.0 km from"):
        proposal(tmp_path, surveyed, Overhead(), rough=about(Overhead(), dx=40_000.0))


def test_a_mosaic_of_a_whole_town_is_refused(tmp_path, surveyed):
    with pytest.raises(RoadExtractionError, match="covers 950 m"):
        proposal(tmp_path, surveyed, Overhead(), rough=about(Overhead(), size=12.5))


def test_refused_pairs_are_switched_off_in_the_layer_that_is_georeferenced(tmp_path, surveyed):
    camera = Overhead(tilt=0.03)
    found = proposal(tmp_path, surveyed, camera, settings=ProposalSettings(min_score=0.85))
    assert 0 < found.accepted.sum() < len(found)
    layer = found.features()
    names = [field.name for field in layer.schema]
    rows = [[row[name] for name in names] + [*shapely.get_coordinates(place)[0]] for place, row in layer]
    placed = georeference(found.image, control_points([*names, "mapX", "mapY"], rows, found.image, "The pairs", layer.crs))
    assert (placed.points.roles == "control").sum() == found.accepted.sum()
    assert (placed.points.roles == "disabled").sum() == (~found.accepted).sum()
    assert placed.rmse() < 0.03


def test_both_cut_outs_of_a_pair_show_the_same_paint(surveyed, found_upside_down):
    found = found_upside_down
    likeness = [np.corrcoef(*(cut[..., 0].ravel().astype(float) for cut in pair))[0, 1] for pair in pair_cutouts(
        found.image, surveyed, found.pixel, found.line, found.easting, found.northing, half=0.8)]
    assert np.median(np.array(likeness)[found.accepted]) > 0.8
    report = proposed_points_report(found)
    assert "data:image/png" in report and f"of which {found.accepted.sum()} accepted" in report


def test_the_sample_image_finds_its_place_by_its_tags_to_three_centimetres(tmp_path):
    """Cars, trees, their shadows, a tilted camera and its lens; check points that a surveyor measured judge the result."""
    survey = make_sample_survey(SampleSettings(length=70.0))
    write_uav_image(survey, tmp_path / "uav.tif")
    image = open_image(tmp_path / "uav.tif")
    edges = shapely.union_all(survey.truth_surface.geometries).bounds
    west, north = edges[0] - EAST, edges[3] - NORTH
    ground = Ground([shapely.get_coordinates(part.exterior) - [EAST + west, NORTH + north] for marking in survey.truth_markings.geometries
                     for part in shapely.get_parts(marking)], road=(0.0, edges[1] - edges[3], edges[2] - edges[0], 0.0),
                    size=(edges[2] - edges[0], edges[3] - edges[1]))
    intensity = ground.intensity_image(tmp_path / "intensity.tif", corner=(edges[0], edges[3]), crs=survey.crs)
    found = propose_control_points(image, intensity, rough_place(image, intensity.crs, 15.0))
    assert found.rough.source == "position tags" and found.accepted.sum() >= 20
    truth = survey.camera.to_map(found.pixel, found.line) + np.array(survey.settings.origin[:2])[:, None]
    assert np.hypot(*(truth - [found.easting, found.northing]))[found.accepted].max() < 0.06
    layer = found.features()
    rows = [[row["pixel"], row["line"], *shapely.get_coordinates(place)[0], "control"] for place, row in layer if row["accepted"]]
    measured = uav_control_points(survey)
    rows += [[row["pixel"], row["line"], *shapely.get_coordinates(place)[0], "check"] for place, row in measured if row["role"] == "check"]
    placed = georeference(image, control_points(["pixel", "line", "easting", "northing", "role"], rows, image, "The points", layer.crs))
    assert placed.rmse("check") < 0.03
