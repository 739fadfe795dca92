"""Where a layer comes from, in the metadata that QGIS shows in its properties."""

from __future__ import annotations

from qgis.core import QgsMapLayer

from ...algorithms.provenance import Provenance


def describe_origin(layer: QgsMapLayer, provenance: Provenance) -> None:
    """Set title, abstract and history of a layer; the history of an image that carried one is not repeated."""
    metadata = layer.metadata()
    metadata.setTitle(layer.name())
    metadata.setAbstract(f"{provenance.program}, {provenance.algorithm}")
    metadata.setLanguage("")
    if provenance.sentence() not in metadata.history():
        metadata.addHistoryItem(provenance.sentence())
    layer.setMetadata(metadata)
