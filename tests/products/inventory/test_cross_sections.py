"""Cross-sections of roads whose width, crossfall, ruts, curbs and clearance are known."""

import re

import numpy as np
import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.core.countries.catalogue import COUNTRIES
from lanewright.products.cad import landxml_text, section_alignments, section_drawing, section_table, write_dxf
from lanewright.products.export.xml_tree import read_xml
from lanewright.products.inventory.borders import BorderLayers, CrossSectionSettings
from lanewright.products.inventory.cross_sections import measure_cross_sections, sections_to_features
from lanewright.products.report.inventory import cross_section_report
from map_files import written
from measured_streets import GROUND, HALF, Drive, edges_of, lanes_of, markings_of, measured_road

BOTH_WAYS = (Drive(1, -1.75), Drive(-1, 1.75))


def rows_of(survey, part="lane", layers=None, **settings):
    layers = BorderLayers(edges_of(), markings_of()) if layers is None else layers
    table = sections_to_features(measure_cross_sections(survey, layers, CrossSectionSettings(**settings)))[1]
    return [row for row in table.rows if row["part"] == part]


def column(rows, *names):
    return np.array([[np.nan if row[name] is None else row[name] for name in names] for row in rows], float)


@pytest.mark.parametrize("crossfall", [0.0, 0.06])
def test_the_crossfall_of_both_sides_of_a_crown_is_measured(crossfall):
    rows = rows_of(measured_road(crossfall=crossfall, density=700.0))
    true = [100 * crossfall if row["lane"] == 1 else -100 * crossfall for row in rows]
    assert len(rows) == 2 * 6
    np.testing.assert_allclose(column(rows, "crossf_pct")[:, 0], true, atol=0.05)


def test_passes_in_opposite_directions_tell_roll_from_crossfall():
    """The same vehicle with two scanners, all of them tilted, and a centimetre between them: 0.005 are 0.3 degrees."""
    survey = measured_road(drives=(Drive(1, -1.75, -0.005), Drive(-1, 1.75, -0.005, 0.008)), scanners=((0.005, 0.003), (-0.005, -0.001)), rut=0.01)
    rows = rows_of(survey)
    true = np.array([2.5 if row["lane"] == 1 else -2.5 for row in rows])
    assert np.abs(column(rows, "crossf_pct")[:, 0] - true).max() < 0.2
    assert (column(rows, "crossf_sig") < 0.15).all()


def test_one_pass_says_that_it_cannot_tell_roll_from_crossfall():
    one = measure_cross_sections(measured_road(drives=(Drive(1, -1.75, 0.004),)), BorderLayers(edges_of(), markings_of()))
    both = measure_cross_sections(measured_road(drives=BOTH_WAYS), BorderLayers(edges_of(), markings_of()))
    assert any("cannot be told from crossfall" in note for note in one.notes) and not both.notes
    assert min(section.parts[1].crossfall_sigma for section in one.sections) > max(section.parts[1].crossfall_sigma for section in both.sections)
    # what it is wrong by is the roll
    assert np.median([section.parts[0].crossfall for section in one.sections]) == pytest.approx(0.004, abs=0.0005)


@pytest.mark.parametrize("rut, density", [(0.0, 150.0), (0.005, 150.0), (0.025, 150.0), (0.012, 2500.0)])
def test_rut_depths_are_right_within_three_millimetres(rut, density):
    """A scanner of 5 mm noise, another 8 mm above it and tilted, and a vehicle that rolls."""
    survey = measured_road(drives=(Drive(1, -1.75, 0.003),), scanners=((0.004, 0.002), (-0.004, -0.002)), rut=rut, density=density, noise=0.005)
    found = column(rows_of(survey), "rut_l_mm", "rut_r_mm")
    assert np.isfinite(found).mean() > 0.9
    assert np.sqrt(np.nanmean((found - 1000 * rut) ** 2)) < 3.0


def test_a_step_between_two_scanners_is_no_rut():
    rows = rows_of(measured_road(scanners=((0.010, 0.0), (-0.010, 0.0)), noise=0.003))
    assert np.nanmax(column(rows, "rut_l_mm", "rut_r_mm")) < 3.0


def test_a_crown_is_no_rut_however_steeply_the_road_falls_from_it():
    found = column(rows_of(measured_road(drives=BOTH_WAYS, crossfall=0.08)), "rut_l_mm", "rut_r_mm")
    assert np.sqrt(np.mean(found**2)) < 1.5 and found.max() < 3.0


def test_too_much_noise_gives_no_rut_depths_and_says_so():
    sections = measure_cross_sections(measured_road(noise=0.03, density=60.0), BorderLayers(edges_of(), markings_of()))
    assert any("too few or too noisy" in note for note in sections.notes)
    assert not np.isfinite([part.ruts for section in sections.sections for part in section.parts]).any()


def test_limits_that_no_lane_can_keep_are_refused_with_both_numbers():
    with pytest.raises(RoadExtractionError, match="least crossfall is 6 %, the greatest 2 %"):
        CrossSectionSettings(min_crossfall=6.0, max_crossfall=2.0)
    with pytest.raises(RoadExtractionError, match="in the rules of germany"):
        CrossSectionSettings(max_crossfall=1.0, country="germany")
    assert CrossSectionSettings(max_crossfall=1.0).limits().max_crossfall == 1.0


def test_widths_grades_and_curbs_of_a_road_that_runs_north():
    layers = BorderLayers(edges_of(north=True), markings_of(north=True))
    survey = measured_road(grade=0.045, curb=0.14, north=True)
    whole = rows_of(survey, "carriageway", layers)
    off = np.abs(column(whole, "width_m", "grade_pct", "curb_l_m", "curb_r_m") - [2 * HALF, 4.5, 0.14, 0.14])
    assert (off < [0.02, 0.05, 0.01, 0.01]).all()
    np.testing.assert_allclose(column(rows_of(survey, "lane", layers), "width_m"), 3.25, atol=0.02)


def test_the_grade_of_a_bend_is_that_of_each_lane_along_its_own_middle():
    """10 % along the middle of the road: the inner lane climbs as much on a shorter way."""
    radius = 15.0
    survey = measured_road(drives=(Drive(1, -1.75), Drive(-1, 1.75)), grade=0.10, radius=radius)
    layers = BorderLayers(edges_of(radius=radius), markings_of(radius=radius))
    whole, rows = ([row for row in rows_of(survey, part, layers) if 5.0 < row["station_m"] < 55.0] for part in ("carriageway", "lane"))
    assert np.abs(column(whole, "grade_pct") - 10.0).max() < 0.1
    inner = np.array([[row["lane"] == 2] for row in rows])
    true = np.where(inner, 10.0 / (1.0 - 1.625 / radius), 10.0 / (1.0 + 1.625 / radius))
    assert np.abs(column(rows, "grade_pct") - true).max() < 0.1


@pytest.mark.parametrize("grade", [0.08, -0.08])
def test_a_vehicle_that_changes_lanes_on_a_hill_measures_crossfall_across_the_road(grade):
    rows = rows_of(measured_road(drives=(Drive(1, -1.75, shift=3.5),), grade=grade, crown=False, crossfall=0.03))
    assert np.abs(column(rows, "crossf_pct", "grade_pct") - [3.0, 100 * grade]).max() < 0.1
    assert np.abs(column(rows, "width_m") - 3.25).max() < 0.02


def test_curbs_are_measured_at_road_edges_that_may_be_curbs_alone():
    survey, edges = measured_road(curb=0.14), edges_of()
    for row in edges.rows:
        row["edge"] = "pavement" if row["side"] == "left" else "curb"
    measured = column(rows_of(survey, "carriageway", BorderLayers(edges, markings_of())), "curb_l_m", "curb_r_m")
    assert np.isnan(measured[:, 0]).all() and np.allclose(measured[:, 1], 0.14, atol=0.01)
    assert np.isnan(column(rows_of(survey, "carriageway", BorderLayers(marking_lines=markings_of())), "curb_l_m", "curb_r_m")).all()


def test_a_lane_beside_the_road_that_was_driven_is_no_carriageway_of_it():
    beside = lanes_of(strips=((3.0, 5.6, "driving", 1),))
    with pytest.raises(RoadExtractionError, match="lie on none of the driven roads"):
        rows_of(measured_road(), layers=BorderLayers(lanes=beside))


def test_lanes_of_the_layer_are_measured_with_their_types_and_directions():
    rows = rows_of(measured_road(rut=0.01, lanes=(-1.5, 1.7)), layers=BorderLayers(edges_of(), lanes=lanes_of()))
    first = [row for row in rows if row["section"] == 2]
    assert [(row["type"], row["direction"], row["borders"]) for row in first] == [("shoulder", 0, "lanes"), ("driving", 1, "lanes"),
                                                                                ("driving", -1, "lanes")]
    np.testing.assert_allclose([row["width_m"] for row in first], [0.5, 3.0, 3.4], atol=0.02)
    driven = column([row for row in rows if row["type"] == "driving"], "rut_l_mm", "rut_r_mm")
    assert np.sqrt(np.mean((driven - 10.0) ** 2)) < 3.0


def test_a_bridge_is_the_clearance_and_a_lorry_is_not():
    def above(rng):
        deck = rng.uniform(28, 33, 4000), rng.uniform(-5, 5, 4000), np.full(4000, 4.35)
        # flank and upper edge of a lorry 4 m high, in the left lane
        lorry = rng.uniform(8, 18, 3000), np.full(3000, 0.6), rng.uniform(0.4, 4.0, 3000)
        return tuple(np.r_[a, b] for a, b in zip(deck, lorry))

    rows = rows_of(measured_road(above=above), "carriageway", min_clearance=4.5)
    clear = {row["station_m"]: row["clear_m"] for row in rows}
    assert clear[30.0] == pytest.approx(4.35, abs=0.05) and clear[10.0] is None and clear[50.0] is None
    assert {row["station_m"] for row in rows if row["exceeds"] == "clearance"} == {30.0}


def test_a_lorry_that_drives_along_is_no_clearance_where_only_the_upper_part_of_its_flank_was_seen():
    def above(rng):
        # drawn out over 30 m; the scan plane leans, so that its rear is seen from a height on that rises by 10 % along the road
        x, z = rng.uniform(10, 40, 20000), rng.uniform(0.4, 3.6, 20000)
        flank = z > 0.4 + 0.1 * (x - 10)
        roof = rng.uniform(10, 40, 3000), rng.uniform(0.6, 2.9, 3000), np.full(3000, 3.6)
        deck = rng.uniform(48, 53, 4000), rng.uniform(-5, 5, 4000), np.full(4000, 4.2)
        pier = rng.uniform(50, 51, 2000), rng.uniform(-0.3, 0.3, 2000), rng.uniform(0, 4.2, 2000)
        return tuple(np.concatenate(v) for v in zip((x[flank], np.full(flank.sum(), 0.6), z[flank]), roof, deck, pier))

    clear = {row["station_m"]: row["clear_m"] for row in rows_of(measured_road(above=above), "carriageway")}
    assert clear[20.0] is None and clear[30.0] is None and clear[40.0] is None
    assert clear[50.0] == pytest.approx(4.2, abs=0.05)


def test_what_exceeds_the_users_limits_is_named():
    rows = rows_of(measured_road(rut=0.015, crossfall=0.04), max_rut=10.0, max_crossfall=3.0, min_width=3.5)
    assert {row["exceeds"] for row in rows} == {"rut, crossfall, width"}
    assert {row["exceeds"] for row in rows_of(measured_road(rut=0.015), max_rut=20.0)} == {None}


def test_each_limit_that_is_not_kept_says_its_value_and_whose_rule_it_is():
    steep = rows_of(measured_road(crossfall=0.05), country="germany", max_crossfall=3.0, min_width=3.5)
    assert all(re.fullmatch(r"crossfall [45]\.\d\d > 3 % \[limit set by the user\]; width 3\.\d\d < 3.5 m \[limit set by the user\]", row["why"])
               for row in steep)
    rows = rows_of(measured_road(rut=0.015, crossfall=0.04), country="germany")
    assert {row["exceeds"] for row in rows} == {"rut"}
    assert all(re.fullmatch(r"rut 1\d\.\d > 10 mm \[ZTV ZEB-StB, warning value\]", row["why"]) for row in rows)


def test_where_no_country_is_chosen_and_no_limit_set_nothing_is_judged_and_the_report_says_so():
    sections = measure_cross_sections(measured_road(rut=0.05, crossfall=0.2), BorderLayers(edges_of(), markings_of()))
    table = sections_to_features(sections)[1]
    assert not any(row["exceeds"] or row["why"] for row in table.rows)
    page = cross_section_report(sections, table)
    assert "Nothing is judged" in page and "No section exceeds" not in page


def test_a_crossfall_whose_error_explains_it_is_not_marked():
    level = {"country": "germany", "min_crossfall": 2.55}   # of 2.5 %, which one pass knows to 0.09 %
    assert not any("crossfall" in (row["exceeds"] or "") for row in rows_of(measured_road(), **level))
    assert all("crossfall" in row["exceeds"] for row in rows_of(measured_road(), **{**level, "min_crossfall": 3.0}))


def test_the_drawing_of_the_sections_has_the_ground_true_to_scale_with_its_limits_in_words(tmp_path):
    ogr = pytest.importorskip("osgeo.ogr")
    sections = measure_cross_sections(measured_road(rut=0.015), BorderLayers(edges_of(), markings_of()), CrossSectionSettings(country="germany"))
    write_dxf(section_drawing(sections), str(tmp_path / "sections.dxf"))
    source = ogr.Open(str(tmp_path / "sections.dxf"))
    rows = [(feature["Layer"], feature["Text"], feature.GetGeometryRef().Clone()) for feature in source.GetLayer(0)]
    ground = [line for layer, _, line in rows if layer == "SECTION_GROUND"]
    assert len(ground) == len(sections.sections)
    assert ground[0].Length() == pytest.approx(np.ptp(sections.sections[0].d), abs=0.5)
    texts = {layer: [text for kind, text, _ in rows if text and kind == layer] for layer, _, _ in rows}
    assert any("10 mm [ZTV ZEB-StB, warning value]" in text for text in texts["SECTION_EXCEEDED"])
    assert any(text.startswith(f"0: {sections.sections[0].station:.2f} m") for text in texts["SECTION_TEXT"])


@pytest.mark.parametrize("name", COUNTRIES)
def test_every_limit_of_a_country_names_its_rule(name):
    limits = CrossSectionSettings(country=name).limits()
    assert set(limits.rules) == {limit for limit in limits.NAMES if getattr(limits, limit) is not None}


def test_a_limit_left_at_0_is_the_countrys():
    assert CrossSectionSettings(country="germany").limits().max_rut == 10.0
    assert CrossSectionSettings(country="germany", max_rut=25.0).limits().max_rut == 25.0


def test_without_layers_a_lane_about_the_track_is_measured_and_its_width_is_not_judged():
    sections = measure_cross_sections(measured_road(), BorderLayers(), CrossSectionSettings(min_width=4.0))
    rows = sections_to_features(sections)[1].rows
    assert {row["borders"] for row in rows} == {"track"} and any("width is no measurement" in note for note in sections.notes)
    assert not any("width" in (row["exceeds"] or "") for row in rows)
    assert np.median([row["crossf_pct"] for row in rows if row["lane"]]) == pytest.approx(2.5, abs=0.1)


def test_a_car_on_the_lane_does_not_change_the_section():
    def above(rng):
        return rng.uniform(25, 35, 30000), rng.uniform(-2.6, -0.9, 30000), np.full(30000, 0.9)

    rows = rows_of(measured_road(above=above, rut=0.01))
    right = column([row for row in rows if row["lane"] == 1 and row["station_m"] == 30.0], "crossf_pct", "grade_pct")
    np.testing.assert_allclose(right, [[2.5, 3.0]], atol=0.2)


def test_an_island_in_a_lane_is_no_rut():
    def above(rng):
        return rng.uniform(0, 60, 40000), rng.uniform(0.6, 1.6, 40000), np.full(40000, 0.12)

    found = column(rows_of(measured_road(above=above)), "rut_l_mm", "rut_r_mm")
    assert np.nanmax(found) < 3.0


def test_lines_of_the_layer_lie_on_the_road():
    lines, _ = sections_to_features(measure_cross_sections(measured_road(grade=0.0, crossfall=0.02), BorderLayers(edges_of(), markings_of())))
    whole = next(g for g, row in lines if row["part"] == "carriageway" and row["station_m"] == 20.0)
    z = np.array(whole.coords)[:, 2] - GROUND
    assert z.max() == pytest.approx(0.0, abs=0.01) and z.min() == pytest.approx(-0.02 * HALF, abs=0.01)


def test_results_depend_neither_on_the_interval_nor_on_the_order_of_the_passes():
    survey = measured_road(drives=BOTH_WAYS, rut=0.01)
    often = {(row["station_m"], row["lane"]): row["crossf_pct"] for row in rows_of(survey, interval=10.0)}
    seldom = {(row["station_m"], row["lane"]): row["crossf_pct"] for row in rows_of(survey, interval=20.0)}
    assert set(seldom) < set(often)
    assert max(abs(often[key] - value) for key, value in seldom.items()) < 0.05


def test_an_interval_longer_than_the_road_is_refused():
    """Where points begin after the first section, which lies at station 0."""
    survey = measured_road(length=30.0, density=300.0, hides=lambda offset, x, y, z: x < 1.0)
    with pytest.raises(RoadExtractionError, match="smaller interval"):
        measure_cross_sections(survey, BorderLayers(markings_of(offsets=(20.0, 24.0))), CrossSectionSettings(interval=1000.0))


def test_layers_of_another_place_are_refused():
    with pytest.raises(RoadExtractionError, match="Choose those of this survey"):
        measure_cross_sections(measured_road(density=300.0), BorderLayers(edges_of(half=90.0)))


def test_the_report_is_as_high_for_a_road_to_the_north_and_names_what_exceeds():
    pages = []
    for north in (False, True):
        sections = measure_cross_sections(measured_road(rut=0.02, north=north), BorderLayers(edges_of(north=north), markings_of(north=north)),
                                          CrossSectionSettings(max_rut=10.0))
        pages.append(cross_section_report(sections, sections_to_features(sections)[1]))
    assert pages[0].count("<svg") == pages[1].count("<svg") >= 6
    assert all(int(height) < 300 for page in pages for height in re.findall(r'<svg [^>]*height="(\d+)"', page))
    assert "rut" in pages[0] and "cannot be told from crossfall" in pages[0]


def test_landxml_and_the_table_have_the_ground_of_every_section(tmp_path):
    """Offsets are positive to the right in LandXML and to the left in the table; the road falls by 4 % to the right and climbs by 3 %."""
    sections = measure_cross_sections(measured_road(crossfall=0.04, crown=False, density=700.0), BorderLayers(edges_of(), markings_of()))
    root = read_xml(written(tmp_path, landxml_text(section_alignments(sections)), "sections.xml"), "LandXML", "a LandXML file")
    alignment = root.find("Alignments", "Alignment")
    assert [child.tag for child in alignment.children] == ["CoordGeom", "CrossSects"]
    crossed = list(alignment.find("CrossSects").all("CrossSect"))
    assert [section.number("sta") for section in crossed] == [0.0, 10.0, 20.0, 30.0, 40.0, 50.0]
    rows = np.array([line.split(",") for line in section_table(sections).splitlines()[1:]], float)
    for section in crossed:
        ground = np.array(section.find("CrossSectSurf", "PntList2D").text.split(), float).reshape(-1, 2)
        station = section.number("sta")
        level = GROUND + 0.03 * station
        road = np.abs(ground[:, 0] + 1.75) < HALF - 0.2   # the stations run along the track, 1.75 m right of the middle
        assert np.polyfit(ground[road, 0], ground[road, 1] - level, 1) == pytest.approx([-0.04, -0.07], abs=0.004)
        np.testing.assert_allclose(rows[rows[:, 1] == station][:, 2:], ground * [-1, 1], atol=1e-9)
