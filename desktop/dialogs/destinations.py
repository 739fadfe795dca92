"""Where the results of an algorithm go when they all go to one place."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProcessingAlgorithm, QgsProcessingParameterDefinition

from ...algorithms.destinations import table_of


def outputs_by_default(algorithm: QgsProcessingAlgorithm) -> list[QgsProcessingParameterDefinition]:
    """The results that are made unless one is left out."""
    return [definition for definition in algorithm.destinationParameterDefinitions() if definition.createByDefault()]


def table_name(definition: QgsProcessingParameterDefinition) -> str:
    """What a result is called in a database, and as a file."""
    return definition.name().split(":")[-1].lower()


def destinations(algorithm: QgsProcessingAlgorithm, folder: str, survey: str = "") -> dict[str, str]:
    """Where each result goes: layers into one GeoPackage called like the algorithm, other files under their own names.

    Where several surveys share the folder, the GeoPackage is called like the survey, and names of other files begin with that.
    """
    result = {}
    for definition in outputs_by_default(algorithm):
        table = table_name(definition)
        if definition.type() == "sink":
            result[definition.name()] = table_of(Path(folder) / f"{survey or algorithm.name()}.gpkg", table)
        else:
            name = f"{survey}_{table}" if survey else table
            result[definition.name()] = str(Path(folder) / f"{name}.{definition.defaultFileExtension()}")
    return result
