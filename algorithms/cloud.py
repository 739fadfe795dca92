"""The survey's own point clouds, given back with classes and the fields of the road."""

from collections import Counter
from dataclasses import replace
from pathlib import Path

from ..core.common.errors import RoadExtractionError
from .algorithm import Algorithm, settings_of
from .map_layers import MAP_LAYERS
from .survey_input import READING_SETTINGS, open_survey_with
from .texts import tr

CLOUD_SETTINGS = settings_of("products.cloud.classify:CloudSettings", "GROUND_THICKNESS CURB_WIDTH REACH_BESIDE",
    GROUND_THICKNESS=dict(field="ground"), CURB_WIDTH=dict(field="curb"), REACH_BESIDE=dict(field="beside"))
# parameter -> the fields that are read; in the order of CloudLayers
CLOUD_LAYERS = {"ROAD_SURFACE": "road station_m", "ROAD_EDGES": "road station_m height_m edge", "MARKINGS": "road station_m",
                "ROADSIDE": "road station_m kind height_m", "ROADSIDE_OBJECTS": "road station_m kind height_m diam_m"}


class ClassifyCloud(Algorithm):
    ID, TITLE, GROUP = "classifycloud", "Classify point cloud", "Export"
    NUMBERS = "FILES POINTS ROAD_POINTS PAINT_POINTS CURB_POINTS".split()

    def declare(self):
        self.add_survey()
        for name in CLOUD_LAYERS:
            self.add_map_layer(name, optional=True)
        self.add_settings(CLOUD_SETTINGS, advanced=True)
        self.add_settings(READING_SETTINGS)
        self.add_output("folder", "OUTPUT")
        self.add_output("folder", "UNROLLED", optional=True, by_default=False)

    def work(self, call, progress):
        from ..core.survey.las.point_fields import in_one_scale, intensity_source_of
        from ..core.survey.las.reader import read_headers
        from ..core.survey.las.samples import sample_files
        from ..products.cloud.classify import CloudLayers, PointClass, PointClassifier
        from ..products.cloud.rewrite import classified_copy

        files = read_headers(call.point_clouds(), given=call.crs())
        copies = _copies(call, files, progress)
        # what was drawn by hand has no station
        layers = {name: call.features(name, [replace(field, needed=field.needed and field.name != "station_m") for field in MAP_LAYERS[name].schema
                                             if field.name in read.split()], MAP_LAYERS[name].geometry)
                  for name, read in CLOUD_LAYERS.items()}
        survey = open_survey_with(call, layers, progress.part(0.0, 0.4))
        samples = sample_files(files)
        intensity = intensity_source_of(samples, call.value("INTENSITY_FROM"))[0]
        files, _ = in_one_scale(files, samples, call.value("INTENSITY_FROM"))
        classifier = PointClassifier(survey, CloudLayers(*layers.values()), call.settings(CLOUD_SETTINGS), call.value("CORRIDOR"), intensity)
        total, done, counts = sum(file.count for file in files), 0, Counter()
        for file, copy in zip(files, copies):
            part = progress.part(0.4 + 0.6 * done / total, 0.4 + 0.6 * (done + file.count) / total)
            counts.update(classified_copy(file, classifier, *copy, part))
            done += file.count
        for number, count in sorted(counts.items()):
            name = PointClass(number).name.lower().replace("_", " ") if number in set(PointClass) else ""
            progress.info(tr("Class {number} {name}: {count:,} points").format(number=number, name=name, count=count))
        return {"FILES": float(len(files)), "POINTS": float(done), "ROAD_POINTS": float(counts[PointClass.ROAD_SURFACE]),
                "PAINT_POINTS": float(counts[PointClass.PAINT]), "CURB_POINTS": float(counts[PointClass.CURB])}


def _copies(call, files, progress):
    """(path, path of the unrolled copy) for each of the files, whose names must differ."""
    names = [Path(file.path).name for file in files]
    plain = [f"{name[:-len('.copc.laz')]}.laz" if name.lower().endswith(".copc.laz") else name for name in names]
    twice = next((name for k, name in enumerate(plain) if name.lower() in {other.lower() for other in plain[:k]}), None)
    if twice:
        raise RoadExtractionError(
            tr("Two of the point clouds would be written to {name}. Rename one, or run once for each folder.").format(name=twice))
    if plain != names:
        progress.info(tr("COPC files are written as LAZ: their octree is not kept. QGIS makes a COPC of a LAZ by Create COPC."))
    return [(call.new_file_in("OUTPUT", name), call.new_file_in("UNROLLED", name)) for name in plain]
