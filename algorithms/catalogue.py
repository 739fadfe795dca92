"""Every algorithm, in the order of the work."""

from .algorithm import GROUPS
from .assess.assess_boundaries import AssessBoundaries
from .assess.assess_driving_lines import AssessDrivingLines
from .assess.assess_markings import AssessMarkings
from .driving.driving_lines import DrivingLines
from .driving.road_map import RoadMap
from .export.check_map import CheckMap
from .export.export_cad import ExportCad
from .export.export_lanelet2 import ExportLanelet2
from .export.export_opendrive import ExportOpenDrive
from .export.import_lanelet2 import ImportLanelet2
from .export.import_opendrive import ImportOpenDrive
from .inventory.cross_sections import CrossSections
from .inventory.roadside import Roadside
from .markings.cluster_markings import ClusterMarkings
from .markings.correct_intensity import CorrectIntensity
from .markings.extract_markings import ExtractMarkings
from .markings.fit_marking_lines import FitMarkingLines
from .markings.intensity_image import IntensityImage
from .markings.remove_outliers import RemoveOutliers
from .overlay.georeference_image import GeoreferenceImage
from .overlay.propose_control_points import ProposeControlPoints
from .road.boundaries_from_scanlines import BoundariesFromScanlines
from .road.detect_boundaries import DetectBoundaries
from .road.detect_curbs import DetectCurbs
from .road.extract_road_surface import ExtractRoadSurface
from .road.fit_road_edges import FitRoadEdges
from .road.normalized_scanlines import NormalizedScanlines
from .survey.estimate_trajectory import EstimateTrajectory
from .survey.import_trajectory import ImportTrajectory
from .survey.inspect_survey import InspectSurvey
from .survey.sample_survey import SampleSurvey

ALGORITHMS = (
    ImportTrajectory,
    EstimateTrajectory,
    InspectSurvey,
    SampleSurvey,
    NormalizedScanlines,
    BoundariesFromScanlines,
    DetectCurbs,
    FitRoadEdges,
    DetectBoundaries,
    ExtractRoadSurface,
    CorrectIntensity,
    IntensityImage,
    ExtractMarkings,
    RemoveOutliers,
    ClusterMarkings,
    FitMarkingLines,
    DrivingLines,
    RoadMap,
    ExportOpenDrive,
    ExportLanelet2,
    ExportCad,
    ImportOpenDrive,
    ImportLanelet2,
    CheckMap,
    CrossSections,
    Roadside,
    AssessBoundaries,
    AssessMarkings,
    AssessDrivingLines,
    ProposeControlPoints,
    GeoreferenceImage,
)


def toolbox_number(ID):
    """"2.3" for the third algorithm of the second group: the toolbox sorts by name, and the number keeps the order of the work."""
    declared = next(one for one in ALGORITHMS if one.ID == ID)
    group = [one.ID for one in ALGORITHMS if one.GROUP == declared.GROUP]
    return f"{GROUPS.index(declared.GROUP) + 1}.{group.index(ID) + 1}"
