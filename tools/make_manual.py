"""Writes the manual's page of every algorithm, and its contents, in English and in every language it is translated to: make_manual.py [FOLDER].

The text is that of the toolbox: a parameter's label and help, an output's fields. What people write
by hand (the walk-through, models, headless use, troubleshooting) lies beside it and is only linked. A language has a
folder of its own, as `de`, whose generated pages come from the translations of the toolbox; see manual_translations.py for the others.
"""

import os
import subprocess
import sys
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from plugin_package import ROOT, load

PAGES = ROOT / "docs" / "manual"
LANGUAGES = {"de": "Deutsch"}  # beside English: folder and own name
WRITTEN_BY_HAND = ("first_survey", "corrections", "models", "hd_maps", "hd_map_opendrive", "hd_map_lanelet2", "hd_map_cad", "headless",
                   "large_surveys", "troubleshooting")
# The commands run as they are printed, in one folder, from the sample survey to its assessment: each reads what another wrote.
FILES = {
    "POINT_CLOUDS": "survey.laz", "POINT_CLOUD": "survey.laz", "TRAJECTORY": "trajectory.gpkg", "ROAD_EDGES": "road_edges.gpkg",
    "ROAD_POINTS": "road_points.laz", "INTENSITY_IMAGE": "intensity_image.tif",
    "estimatetrajectory.TRAJECTORY": "estimated_trajectory.gpkg",
    "importtrajectory.INPUT": "trajectory.csv", "importtrajectory.OUTPUT": "trajectory.gpkg",
    "correctintensity.OUTPUT": "road_points_corrected.laz", "intensityimage.ROAD_POINTS": "road_points_corrected.laz",
    "extractmarkings.ROAD_POINTS": "road_points_corrected.laz", "removeoutliers.INPUT": "marking_points.laz",
    "removeoutliers.OUTPUT": "marking_points_clean.laz", "clustermarkings.MARKING_POINTS": "marking_points_clean.laz",
    "paintcolours.IMAGE": "orthoimage.tif", "COLOURED_MARKINGS": "coloured_markings.gpkg", "COLOURED_LINES": "coloured_lines.gpkg",
    "proposecontrolpoints.IMAGE": "uav_image.tif", "CONTROL_POINTS": "control_points.gpkg",
    "georeferenceimage.IMAGE": "uav_image.tif", "georeferenceimage.GCPS": "control_points.gpkg",
    "georeferenceimage.OUTPUT": "orthoimage.tif",
    "printsheets.OUTPUT": "sheets.pdf", "exportlanelet2.OUTPUT": "map.osm", "exportopendrive.OUTPUT": "map.xodr", "exportcad.OUTPUT": "map.dxf",
    "exporttemplate.TEMPLATE": "template.csv", "exporttemplate.OUTPUT": "client.gpkg",
    "classifycloud.OUTPUT": "classified", "classifycloud.UNROLLED": "unrolled",
    "checkhdmap.INPUT": "map.xodr", "checkhdmap.OUTPUT": "map_findings.gpkg",
    "importopendrive.INPUT": "map.xodr", "importlanelet2.INPUT": "map.osm",
    "converthdmap.INPUT": "map.xodr", "converthdmap.OUTPUT": "converted.osm", "roadattributes.OUTPUT": "lanes_with_names.gpkg",
    "roadattributes.OSM_FILE": "streets.osm",
    **{f"{name}.{layer}": f"{name.removeprefix('import')}_{layer.lower()}.gpkg" for name in ("importopendrive", "importlanelet2")
       for layer in ("LANES", "DRIVING_LINES", "MARKING_LINES", "ROAD_EDGES", "MARKINGS", "SIGNALS")},
    "roadside.OUTPUT": "roadside.gpkg", "roadside.OBJECTS": "roadside_objects.gpkg",
    "crosssections.OUTPUT": "cross_sections.gpkg", "crosssections.DRAWING": "sections.dxf",
    "crosssections.TABLE": "cross_sections_table.gpkg", "crosssections.LANDXML": "sections.xml", "crosssections.HEIGHTS": "sections.csv",
    "surfacemodel.BREAKLINES": "breaklines.gpkg", "surfacemodel.TIN": "triangles.gpkg", "surfacemodel.SURFACE_FILE": "surface.xml",
    "surfacemodel.DEM": "heights.tif",
    "assessboundaries.INPUT": "road_edges.gpkg", "assessboundaries.REFERENCE": "truth_boundaries.gpkg",
    "assessboundaries.OUTPUT": "boundaries_by_outcome.gpkg",
    "assessmarkings.INPUT": "markings.gpkg", "assessmarkings.REFERENCE": "truth_markings.gpkg",
    "assessmarkings.OUTPUT": "markings_by_outcome.gpkg",
    "assessdrivinglines.INPUT": "driving_lines.gpkg", "assessdrivinglines.REFERENCE": "truth_driving_lines.gpkg",
    "assessdrivinglines.OUTPUT": "driving_lines_by_outcome.gpkg",
}
# Optional inputs that one would not do without.
NAMED = {
    "importtrajectory": ("POINT_CLOUDS",), "inspectsurvey": ("TRAJECTORY",), "extractroadsurface": ("ROAD_EDGES",),
    "drivinglines": ("MARKINGS", "ROAD_EDGES", "ROAD_POINTS"), "printsheets": ("ROAD_EDGES", "DRIVING_LINES"), "georeferenceimage": ("GCPS",),
    "crosssections": ("ROAD_EDGES", "MARKING_LINES", "DRIVING_LINES"),
    "roadmap": ("TRAJECTORY",), "roadattributes": ("OSM_FILE",),
    "roadside": ("ROAD_EDGES",),
    "exporttemplate": ("ROAD_EDGES", "MARKINGS", "MARKING_LINES"),
    "classifycloud": ("ROAD_SURFACE", "ROAD_EDGES", "MARKINGS"), "paintcolours": ("MARKING_LINES", "IMAGE"),
}


def pages(algorithms, language=""):
    """File name -> text of every generated page, in the language that the algorithms were declared in ("" is English)."""
    from lanewright.processing_provider.algorithm import LanewrightAlgorithm

    shown = [LanewrightAlgorithm(algorithm()).create() for algorithm in algorithms]
    return {**{f"{algorithm.name()}.md": page(algorithm, language) for algorithm in shown}, "index.md": contents(shown, language)}


def contents(algorithms, language):
    folder = PAGES / language
    others = [f"[{name}]({other}/index.md)" for other, name in LANGUAGES.items()] if not language else ["[English](../index.md)"]
    lines = [f"# {tr('Lanewright manual')}", "", " · ".join(others), "", tr("Road maps from mobile laser scanning, in QGIS."), ""]
    lines += [f"- [{heading(folder / f'{name}.md')}]({name}.md)" for name in WRITTEN_BY_HAND if (folder / f"{name}.md").exists()]
    lines += ["", f"## {tr('The algorithms, in the order of the work')}"]
    group = None
    for algorithm in algorithms:
        if algorithm.group() != group:
            group = algorithm.group()
            lines += ["", f"### {group}", ""]
        said = algorithm.shortDescription()
        lines.append(f"- [{algorithm.declaration.title()}]({algorithm.name()}.md): {said if language else lower_first(said)}")
    return "\n".join(lines) + "\n"


def page(algorithm, language):
    lines = [f"# {algorithm.declaration.title()}", "", algorithm.shortDescription(), ""]
    lines += [part + "\n" for part in algorithm.declaration.help_paragraphs()]
    if (PAGES / "img" / f"{algorithm.name()}.png").exists():
        lines += [f"![{algorithm.declaration.title()}]({'../' if language else ''}img/{algorithm.name()}.png)", ""]
    definitions = [definition for definition in algorithm.parameterDefinitions() if definition.name() not in algorithm.declaration.RETIRED]
    inputs = [d for d in definitions if not d.isDestination()]
    plain = [d for d in inputs if not advanced(d)]
    folded = [d for d in inputs if advanced(d)]
    lines += [f"## {tr('Inputs')}", ""] + table(plain)
    if folded:
        lines += ["", f"## {tr('Advanced parameters')}", ""] + table(folded)
    lines += ["", f"## {tr('Results')}", ""]
    for d in definitions:
        if d.isDestination():
            lines += [result(d)]
    numbers = [o for o in algorithm.outputDefinitions() if o.type() == "outputNumber"]
    if numbers:
        lines += ["", tr("Numbers, for models and scripts:"), ""]
        lines += [f"- `{o.name()}`: {o.description()}" for o in numbers]
    lines += ["", f"## {tr('On the command line')}", "", "```", command(algorithm, definitions), "```"]
    return "\n".join(lines) + "\n"


def table(definitions):
    lines = [f"| {tr('parameter')} | {tr('what it is')} | {tr('default')} |", "|---|---|---|"]
    for d in definitions:
        lines.append(f"| `{d.name()}` | {cell(f'**{d.description()}** ({kind(d)}). {d.help()}')}{choices(d)} | {cell(default(d))} |")
    return lines


def kind(d):
    """What a parameter takes, and whether it may be left out."""
    kinds = {
        "multilayer": tr("files"), "file": tr("file"), "source": tr("vector layer"), "raster": tr("raster"), "crs": tr("CRS"),
        "number": tr("number"), "enum": tr("choice"), "boolean": tr("yes or no"), "string": tr("text"), "sink": tr("vector layer"),
        "fileDestination": tr("file"), "rasterDestination": tr("raster"), "pointcloud": tr("point cloud"), "vector": tr("vector layer"),
        "matrix": tr("numbers"), "folderDestination": tr("folder"), "providerconnection": tr("text"), "databaseschema": tr("text"),
    }
    return ", ".join([kinds.get(d.type(), d.type()), *([tr("optional")] if optional(d) else [])])


def choices(d):
    if d.type() != "enum":
        return ""
    words = [f"`{option}`" + (f" ({tr(option)})" if tr(option) != option else "") for option in d.options()]
    return " " + tr("One of: {choices}.").format(choices=", ".join(words))


def default(d):
    value = d.defaultValue()
    return "" if value is None or value == "" else f"{value:g}" if isinstance(value, float) else str(value)


def result(d):
    said = f"- `{d.name()}`: **{d.description()}** ({kind(d)})."
    title = tr("Fields: {fields}.").split("{")[0].strip()
    text, _, fields = d.help().partition(title)
    lines = [" ".join(part for part in (said, text.strip()) if part)]
    if fields:
        lines += [f"  {title}"] + [f"    - {entry.strip()}" for entry in fields.strip().rstrip(".").split(";")]
    return "\n".join(lines)


def command(algorithm, definitions):
    """The call that makes every result from the files that the other pages' calls write."""
    ID = algorithm.name()
    words = [f"tools/qgis_process run lanewright:{ID}"]
    for d in definitions:
        needed = not optional(d) and d.defaultValue() is None
        if d.isDestination() or needed or d.name() in NAMED.get(ID, ()):
            words.append(f"--{d.name()}={file_name(ID, d)}")
    return " \\\n    ".join(words)


def file_name(ID, d):
    if d.name() == "REPORT" and ID != "roadmap":
        return f"{ID}.html"
    return FILES.get(f"{ID}.{d.name()}") or FILES.get(d.name()) or d.name().lower() + suffix(d)


def suffix(d):
    if d.type() in SUFFIXES:
        return SUFFIXES[d.type()]
    return ".html" if d.isDestination() and "html" in d.fileFilter() else ".laz"


SUFFIXES = {"sink": ".gpkg", "source": ".gpkg", "rasterDestination": ".tif", "raster": ".tif"}


def advanced(d):
    from qgis.core import Qgis

    return bool(d.flags() & Qgis.ProcessingParameterFlag.Advanced)


def optional(d):
    from qgis.core import Qgis

    return bool(d.flags() & Qgis.ProcessingParameterFlag.Optional)


def cell(text):
    return text.replace("|", "\\|").replace("\n", " ")


def tr(text):
    """What the toolbox would say for a text."""
    from lanewright.algorithms.texts import tr as told

    return told(text)


def heading(path):
    """The first heading of a page written by hand."""
    with open(path, encoding="utf-8") as page:
        return page.readline().lstrip("# ").strip()


def lower_first(text):
    return text if text[:2].isupper() else text[:1].lower() + text[1:]


def main():
    """Write the English pages, and those of each language by a program of its own: texts are translated when they are imported."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else PAGES
    write(folder, sys.argv[2] if len(sys.argv) > 2 else "")
    if len(sys.argv) < 3:
        for language in LANGUAGES:
            subprocess.run([sys.executable, __file__, str(folder / language), language], check=True)


def write(folder, language):
    from qgis.core import QgsApplication

    load()
    application = QgsApplication([], False)
    application.initQgis()
    try:
        if language:
            from lanewright.processing_provider.texts import speak

            assert speak(language), f"there is no translation to {language}: run make translations"
        from lanewright.algorithms.catalogue import ALGORITHMS

        folder.mkdir(parents=True, exist_ok=True)
        made = pages(ALGORITHMS, language)
        for name, text in made.items():
            (folder / name).write_text(text, encoding="utf-8")
        print(f"{len(made)} pages written to {folder}")
    finally:
        application.exitQgis()


if __name__ == "__main__":
    main()
