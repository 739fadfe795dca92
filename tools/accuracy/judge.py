"""How right a result is: products/assess with one set of settings for everything."""

from lanewright.products.assess.layers import polygons_of_raster
from lanewright.products.assess.lines import BoundaryAccuracySettings, assess_boundaries, compare_lines
from lanewright.products.assess.markings import assess_markings

BUFFERS = (0.05, 0.10, 0.15, 0.20)   # m, half-widths
TOLERANCES = (0.05, 0.10, 0.20)      # m
SETTINGS = BoundaryAccuracySettings(tolerances=TOLERANCES)


def rates(found):
    """Recall, precision and F1 in per cent, and the counts."""
    return dict(recall=_percent(found.recall), precision=_percent(found.precision), f1=_percent(found.f1),
                right=float(found.right), false=float(found.false), missed=float(found.missed))


def _percent(share):
    return None if share != share else 100.0 * share


def boundaries(case, edges, frame):
    """By side and in total: tolerance in cm to rates; RMSE in cm at 10 cm."""
    bottoms = list(edges.on_map(frame)[edges.part == "bottom"])
    found = assess_boundaries(bottoms, case.truth.curbs, SETTINGS, frame, case.truth.aside, area=case.truth.area)
    by = {**found.by_side, "total": found.total}
    result = {side: {_cm(t): rates(a.rates) for t, a in row.items()} for side, row in by.items()}
    at = found.total[0.10]
    result["rmse_cm"] = None if at.lateral.count == 0 else 100 * at.lateral.rmse
    result["height_rmse_cm"] = None if at.height.count == 0 else 100 * at.height.rmse
    return result


def _cm(metres):
    return f"{100 * metres:.0f}"


def paint(case, polygons, names=None):
    """Rates in cells of 4 cm, strict and with a cell of tolerance, and the share found of each class.

    With the `names` of the polygons' classes the counts say, too, of how many true cells with paint (`classed`) the class is right (`named`).
    """
    known = {_plain(name): name for name in case.truth.classes}
    named = None if names is None else [known.get(_plain(name), _plain(name)) for name in names]
    found = assess_markings(polygons, case.truth.markings, result_classes=named, reference_classes=case.truth.classes, area=case.truth.area,
                            seen=case.seen)
    classes = {name: 100.0 * one.found_beside / one.reference for name, one in found.by_class.items() if one.reference}
    tolerant = found.tolerant
    counts = dict(right=tolerant.right, false=tolerant.false, missed=tolerant.missed,
                  found=tolerant.right if tolerant.found is None else tolerant.found)
    if names is not None:
        counts.update(named=sum(one.same for one in found.by_class.values()), classed=sum(one.found for one in found.by_class.values()))
    return dict(strict=rates(found.strict), tolerant=rates(tolerant), classes=classes, counts=counts)


def _plain(name):
    """Class names of other truths as ours: edge line is edge, hatching is hatch."""
    return str(name).replace("_", " ").removesuffix(" line").removesuffix(" crossing").removesuffix("ing")


def markings(case, features):
    return paint(case, [geometry for geometry, _ in features])


def mask(case, path):
    return paint(case, polygons_of_raster(path)[0])


def driving(case, features):
    """Recall and miscoding by buffer in cm, RMSE in cm."""
    found = compare_lines([geometry for geometry, _ in features], case.truth.driving, BUFFERS, case.truth.area)
    rmse = found.lateral.rmse
    return dict(recall={_cm(w): _percent(share) for w, share in found.completeness.items()},
                miscoding={_cm(w): _percent(share) for w, share in found.miscoding.items()},
                rmse_cm=None if rmse != rmse else 100 * rmse)
