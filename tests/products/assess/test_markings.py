"""Paint of known size, judged in cells of 4 cm and as objects."""

import numpy as np
import pytest
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.products.assess.layers import polygons_of_raster, widened_lines
from lanewright.products.assess.markings import FALSE, FALSE_BESIDE, HIT, MISSED, MarkingAccuracySettings, assess_markings
from osgeo import gdal
from shapely.affinity import translate
from shapely.geometry import LineString, box

CELL = 0.04
LINE = box(0.0, 0.0, 10.0, 4 * CELL)      # 250 x 4 cells
STOP = box(20.0, -1.0, 20.4, 1.0)         # 10 x 50 cells


def counts(rates):
    return rates.right, rates.false, rates.missed


def raster(path, values, origin=(0.0, 10.0), kind=gdal.GDT_Byte, nodata=None, size=CELL):
    dataset = gdal.GetDriverByName("GTiff").Create(str(path), values.shape[1], values.shape[0], 1, kind)
    dataset.SetGeoTransform((origin[0], size, 0, origin[1], 0, -size))
    if nodata is not None:
        dataset.GetRasterBand(1).SetNoDataValue(nodata)
    dataset.GetRasterBand(1).WriteArray(values)
    return str(path)


def test_paint_agrees_with_itself():
    found = assess_markings([LINE, STOP], [LINE, STOP])
    assert counts(found.strict) == counts(found.tolerant) == (1500, 0, 0)
    assert counts(found.objects) == (2, 0, 0) and found.strict.iou == 1.0


def test_a_line_one_cell_beside_is_right_within_a_cell():
    found = assess_markings([translate(LINE, 0, CELL)], [LINE])
    assert counts(found.strict) == (750, 250, 250)
    assert found.strict.iou == pytest.approx(0.6)
    assert counts(found.tolerant) == (1000, 0, 0)


def test_half_a_line_is_half_the_cells_and_a_whole_object():
    found = assess_markings([box(0, 0, 5, 4 * CELL)], [LINE])
    assert counts(found.strict) == (500, 0, 500) and found.strict.recall == 0.5
    assert counts(found.objects) == (1, 0, 0)


def test_a_line_a_metre_beside_is_false_and_the_line_is_missed():
    found = assess_markings([translate(LINE, 0, 1)], [LINE])
    assert counts(found.tolerant) == (0, 1000, 1000) and counts(found.objects) == (0, 1, 1)
    assert [list(outcome) for outcome in found.outcomes()] == [["missed"], ["false"]]


def test_no_result_misses_everything_and_no_reference_makes_everything_false():
    assert counts(assess_markings([], [LINE]).strict) == (0, 0, 1000)
    assert counts(assess_markings([LINE], []).strict) == (0, 1000, 0)
    assert np.isnan(assess_markings([], []).strict.f1)


def test_each_class_has_its_own_figures():
    found = assess_markings([LINE, STOP], [LINE, STOP], result_classes=["edge", "zebra"], reference_classes=["edge", "stop"])
    edge, stop, zebra = (found.by_class[name] for name in ("edge", "stop", "zebra"))
    assert edge.rates.f1 == 1.0 and edge.same == 1000
    assert stop.found == stop.reference == 500 and stop.same == 0 and stop.rates.f1 == 0.0
    assert zebra.right == zebra.result == 500 and zebra.reference == 0


def test_nothing_is_judged_outside_the_area():
    found = assess_markings([LINE, STOP], [LINE], area=box(-1, -1, 15, 1))
    assert counts(found.strict) == (1000, 0, 0)
    assert [list(outcome) for outcome in found.outcomes()] == [["correct"], ["correct", "excluded"]]


def test_nothing_is_judged_where_the_image_is_empty(tmp_path):
    seen = np.full((300, 600), 7.0, np.float32)
    seen[:, 125:] = -9999.0
    path = raster(tmp_path / "image.tif", seen, (0.0, 6.0), gdal.GDT_Float32, -9999.0)
    assert counts(assess_markings([LINE, STOP], [LINE], seen=path).strict) == (500, 0, 0)


def test_paint_across_the_border_of_tiles_counts_once():
    moved = [translate(shape, 2048 * CELL - 5.0, 2048 * CELL - 2 * CELL) for shape in (LINE, translate(LINE, 0, CELL))]
    found = assess_markings(moved[:1], moved[1:])
    assert counts(found.strict) == (750, 250, 250) and counts(found.tolerant) == (1000, 0, 0)
    assert counts(found.objects) == (1, 0, 0) and found.blocks[:, 2:].sum() == 1250


def test_the_survey_may_lie_anywhere():
    moved = [translate(shape, 610400.0, 2710200.0) for shape in (LINE, translate(LINE, 0, CELL))]
    assert counts(assess_markings(moved[:1], moved[1:]).strict) == (750, 250, 250)


def test_the_outcome_of_every_cell_is_told():
    number = np.zeros(6, int)
    assess_markings([translate(LINE, 0, 3 * CELL), STOP], [LINE, STOP],
                    write_tile=lambda tile, values: np.add(number, np.bincount(values.ravel(), minlength=6), out=number))
    assert (number[HIT], number[FALSE_BESIDE], number[FALSE], number[MISSED]) == (750, 250, 500, 500)


def test_a_mask_is_the_polygons_it_shows(tmp_path):
    mask = np.zeros((250, 600), np.uint8)
    mask[246:250, :250] = 1
    mask[200:250, 500:510] = 2
    polygons, values, _ = polygons_of_raster(raster(tmp_path / "mask.tif", mask))
    assert sorted(values) == [1, 2] and sum(p.area for p in polygons) == pytest.approx(1500 * CELL**2)
    found = assess_markings(polygons, [LINE, translate(STOP, 0, 1.0)])
    assert counts(found.strict) == (1500, 0, 0) and counts(found.objects) == (2, 0, 0)


@pytest.mark.parametrize("kind, paint, nothing, nodata", [
    (gdal.GDT_Float32, 0.7, 0.0, None), (gdal.GDT_Float32, 1.0, float("nan"), None), (gdal.GDT_Byte, 255, 0, None),
    (gdal.GDT_Byte, 1, 255, 255), (gdal.GDT_Int16, 1, -32768, -32768),
])
def test_masks_of_other_software_mark_paint_in_many_ways(tmp_path, kind, paint, nothing, nodata):
    mask = np.full((50, 50), nothing, float)
    mask[10:14, 5:30] = paint
    polygons, _, _ = polygons_of_raster(raster(tmp_path / "mask.tif", mask, kind=kind, nodata=nodata))
    assert len(polygons) == 1 and polygons[0].area == pytest.approx(100 * CELL**2)


def test_a_line_with_a_width_is_paint():
    assert widened_lines([LineString([(0, 0.08), (10, 0.08)])], [0.16])[0].symmetric_difference(LINE).area == pytest.approx(0.0, abs=1e-9)


def test_cells_that_cannot_be_meant_are_refused():
    with pytest.raises(RoadExtractionError, match="cell size is 4 m; it must be between"):
        MarkingAccuracySettings(cell_size=4)


def test_cancel_is_heard_while_a_mask_is_read(tmp_path):
    class Impatient(Progress):
        def report(self, fraction):
            if fraction > 0.7:
                raise Cancelled

    mask = np.zeros((400, 400), np.uint8)
    mask[::3, ::3] = 1
    with pytest.raises(Cancelled):
        polygons_of_raster(raster(tmp_path / "mask.tif", mask), Impatient())
