"""Where the results of an algorithm go when they all go to one place."""

from __future__ import annotations

from pathlib import Path

from qgis.core import QgsProcessingAlgorithm, QgsProcessingParameterDefinition

LAST_OUTPUT = "/Processing/LastOutputPath"  # QGIS's own setting


def outputs_by_default(algorithm: QgsProcessingAlgorithm) -> list[QgsProcessingParameterDefinition]:
    """The results that are made unless one is left out."""
    return [definition for definition in algorithm.destinationParameterDefinitions() if definition.createByDefault()]


def table_name(definition: QgsProcessingParameterDefinition) -> str:
    """What a result is called in a database, and as a file."""
    return definition.name().split(":")[-1].lower()


def destinations(algorithm: QgsProcessingAlgorithm, folder: str) -> dict[str, str]:
    """Where each result goes: layers into one GeoPackage called like the algorithm, other files under their own names."""
    found = {}
    for definition in outputs_by_default(algorithm):
        table = table_name(definition)
        if definition.type() == "sink":
            found[definition.name()] = f"ogr:dbname='{Path(folder) / algorithm.name()}.gpkg' table=\"{table}\" (geom)"
        else:
            found[definition.name()] = str(Path(folder) / f"{table}.{definition.defaultFileExtension()}")
    return found


def survey_destinations(algorithm: QgsProcessingAlgorithm, folder: str, survey: str) -> dict[str, str]:
    """The same for one survey of several that share a folder: names of files begin with that of the survey."""
    found = {}
    for definition in outputs_by_default(algorithm):
        table = table_name(definition)
        if definition.type() == "sink":
            found[definition.name()] = f"ogr:dbname='{Path(folder) / survey}.gpkg' table=\"{table}\" (geom)"
        else:
            found[definition.name()] = str(Path(folder) / f"{survey}_{table}.{definition.defaultFileExtension()}")
    return found
