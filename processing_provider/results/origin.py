"""Where a layer comes from, in the metadata that QGIS shows in its properties and keeps in the file."""

from __future__ import annotations

from dataclasses import dataclass, replace

from qgis.core import Qgis, QgsMapLayer, QgsProviderRegistry

from ...algorithms.provenance import Provenance, signed_by

OUTPUT = "lanewright/output"  # custom property of our layers: the result that they are, such as ROAD_EDGES
KNOWN = ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES", "CURVE_ELEMENTS", "PASSES", "CURB_POINTS",
         "BOUNDARIES", "CORNERS", "INTENSITY_IMAGE")  # results by whose names tables and files are usually called

IMAGES = {"roadmap": "INTENSITY_IMAGE", "intensityimage": "INTENSITY_IMAGE"}  # the image that an algorithm makes; its file says no more


@dataclass(frozen=True)
class Origin:
    """The run that a layer comes from, and which of its results it is; "" where that is not known."""

    provenance: Provenance
    output: str


def describe_origin(layer: QgsMapLayer, provenance: Provenance, output: str = "") -> None:
    """Set title, abstract and history of a layer; the history of an image that carried one is not repeated."""
    metadata = layer.metadata()
    metadata.setTitle(layer.name())
    metadata.setAbstract(f"{provenance.program}, {provenance.algorithm}")
    metadata.setLanguage("")
    for line in provenance.history(output):
        if line not in metadata.history():
            metadata.addHistoryItem(line)
    layer.setMetadata(metadata)


def origin_of(layer: QgsMapLayer) -> Origin | None:
    """The last run of this program that a layer's metadata tell of; None of a layer that is not ours."""
    metadata = layer.metadata()
    lines = [*metadata.history(), *metadata.abstract().splitlines()]
    runs = [run for text in lines if (run := Provenance.of_sentence(text)) is not None]
    if not runs and layer.type() == Qgis.LayerType.Raster and layer.providerType() == "gdal":
        signed = signed_by(layer.source())
        runs = [] if signed is None else [(signed, IMAGES.get(signed.algorithm, ""))]
    if not runs:
        return None
    provenance, output = max(runs, key=lambda one: one[0].ended)
    provenance = replace(provenance, warnings=tuple(provenance.warnings_among(lines)))
    return Origin(provenance, str(layer.customProperty(OUTPUT) or "") or output or _called(layer))


def output_of(layer: QgsMapLayer) -> str:
    """The result that a layer is, such as ROAD_EDGES; "" of a layer that is not ours."""
    noted = layer.customProperty(OUTPUT)
    origin = None if noted else origin_of(layer)
    return str(noted) if noted else "" if origin is None else origin.output


def _called(layer):
    """The result by whose name the table or file of a layer is called: an earlier version did not write it down."""
    parts = QgsProviderRegistry.instance().decodeUri(layer.providerType(), layer.source())
    names = [str(parts.get(part) or "").upper() for part in ("layerName", "table")] + [layer.source().rsplit("/", 1)[-1].split(".")[0].upper()]
    return next((output for name in names for output in sorted(KNOWN, key=len, reverse=True) if name.endswith(output)), "")
