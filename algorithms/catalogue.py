"""Every algorithm, in the order of the work."""

from importlib import import_module

from .algorithm import GROUPS, Algorithm

# Folder -> its files with an algorithm each
FILES = {
    "survey": ("import_trajectory", "estimate_trajectory", "inspect_survey", "sample_survey"),
    "road": ("normalized_scanlines", "boundaries_from_scanlines", "detect_curbs", "fit_road_edges", "detect_boundaries", "extract_road_surface"),
    "markings": ("correct_intensity", "intensity_image", "extract_markings", "remove_outliers", "cluster_markings", "fit_marking_lines"),
    "driving": ("driving_lines", "road_map"),
    "export": ("export_opendrive", "export_lanelet2", "export_cad", "print_sheets", "import_opendrive", "import_lanelet2", "check_map"),
    "inventory": ("cross_sections", "roadside"),
    "assess": ("assess_boundaries", "assess_markings", "assess_driving_lines"),
    "overlay": ("propose_control_points", "georeference_image"),
}


def _declared_in(name):
    """The algorithm that a file declares."""
    module = import_module(name, __package__)
    declared = (value for value in vars(module).values() if isinstance(value, type) and issubclass(value, Algorithm))
    return next(value for value in declared if value.__module__ == module.__name__)


ALGORITHMS = tuple(_declared_in(f".{folder}.{file}") for folder, files in FILES.items() for file in files)


def toolbox_number(ID):
    """"2.3" for the third algorithm of the second group: the toolbox sorts by name, and the number keeps the order of the work."""
    declared = next(algorithm for algorithm in ALGORITHMS if algorithm.ID == ID)
    group = [algorithm.ID for algorithm in ALGORITHMS if algorithm.GROUP == declared.GROUP]
    return f"{GROUPS.index(declared.GROUP) + 1}.{group.index(ID) + 1}"
