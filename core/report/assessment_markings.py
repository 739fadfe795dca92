"""The report on markings set against a reference."""

from .assessment import outcome_map, outcomes_along_road, percent
from .background import grey_background
from .page import Page


def marking_report(accuracy, layer, names, station, along, image=None, notes=()):
    """HTML of a MarkingAccuracy.

    Parameters
    ----------
    layer : Features of `marking_layer`
    station : (N,) metres along the road of `accuracy.blocks`
    along : what that is measured along
    image : path of a raster to draw the map over, or None
    """
    settings = accuracy.settings
    page = Page("Accuracy of markings", f"{names[0]} against {names[1]}.")
    for note in notes:
        page.warning(note)
    page.text(
        f"Judged in cells of {100 * settings.cell_size:g} cm; a cell is painted when its centre is. With a tolerance of one cell the other side is "
        f"widened by one cell all round before it is asked. An object is found, or right, when at least {100 * settings.found_share:g} % of its "
        f"cells are, with a tolerance of {settings.tolerance} cell{'s' * (settings.tolerance != 1)}.")
    rows = [(f"Cells, {'strict' if t == 0 else f'{t} cell' + 's' * (t > 1) + ' tolerance'}", rates) for t, rates in accuracy.rates.items()]
    page.table(("", "Right", "False", "Missed", "Precision (%)", "Recall (%)", "F1 (%)", "IoU (%)"),
               [(name, int(r.right), int(r.false), int(r.missed), percent(r.precision), percent(r.recall), percent(r.f1), percent(r.iou))
                for name, r in (*rows, ("Objects", accuracy.objects))], (None,) * 4 + (2,) * 4)
    page.note("With a tolerance and for objects, IoU is F1 / (2 − F1): right cells of the result and found ones of the reference differ in number.")
    _classes(page, accuracy)
    page.heading("Map")
    background = grey_background(image) if image else None
    outcome_map(page, layer, "Objects of the reference that were found and missed, and false objects of the result; north is up.",
                background, filled=True)
    page.heading("Along the road")
    blocks, size = accuracy.blocks, settings.cell_size**2
    names = ("correct", "missed", "false")
    outcomes_along_road(page, dict.fromkeys(names, station), {name: blocks[:, 2 + k] * size for k, name in enumerate(names)}, along, "m²")
    page.note(f"With a tolerance of {settings.tolerance} cell{'s' * (settings.tolerance != 1)}.")
    return page.html()


def _classes(page, accuracy):
    if not accuracy.by_class:
        return
    page.heading("By class")
    tolerance = accuracy.settings.tolerance
    rows = []
    for name, found in accuracy.by_class.items():
        own = found.rates if found.result and found.reference else None
        rows.append((name, found.reference, _share(found.found, found.reference), _share(found.found_beside, found.reference),
                     found.result, _share(found.right, found.result), _share(found.right_beside, found.result),
                     percent(own.f1) if own else None, percent(own.iou) if own else None))
    page.table(("Class", "Reference cells", "Recall (%)", f"within {tolerance} cell (%)", "Result cells", "Precision (%)",
                f"within {tolerance} cell (%)", "F1 of the class (%)", "IoU of the class (%)"), rows,
               (None, None, 2, 2, None, 2, 2, 2, 2))
    page.note("Recall and precision ask for paint of any class; F1 and IoU of the class ask for the same class in both, where both name it.")


def _share(part, whole):
    return 100.0 * part / whole if whole else None
