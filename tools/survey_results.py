"""Road maps of many surveys with default parameters, by the real qgis_process: one folder of results for each.

A survey is a folder with cloud.laz (or .copc.laz, .las) and trajectory.csv (time, x, y, z in the cloud's CRS). The scenes of
the sample survey come along: made first, with their truth, in the folder `survey` of their results. Two such folders of results
are compared by tools/compare_results.sh, for example before and after a change of the code.
"""

import argparse
import json
import subprocess
import sys
import time
from pathlib import Path

from plugin_package import ROOT, load

load()

from lanewright.simulator.scenes import SCENES  # noqa: E402

CLOUDS = ("cloud.laz", "cloud.copc.laz", "cloud.las")
TRAJECTORY = "trajectory.csv"
# Output of lanewright:roadmap -> file in the folder of results
RESULTS = {
    "ROAD_EDGES": "edges.gpkg",
    "ROAD_SURFACE": "surface.gpkg",
    "MARKINGS": "markings.gpkg",
    "MARKING_LINES": "lines.gpkg",
    "DRIVING_LINES": "driving.gpkg",
    "LANES": "lanes.gpkg",
    "CURVE_ELEMENTS": "elements.gpkg",
    "CURB_POINTS": "curb_points.gpkg",
    "ROAD_POINTS": "road.laz",
    "INTENSITY_IMAGE": "intensity.tif",
    "REPORT": "report.html",
}
LOG = "log.txt"
# Output of lanewright:samplesurvey -> layer in truth.gpkg, named as tools/accuracy reads them
TRUTH = {
    "TRUTH_BOUNDARIES": "boundaries",
    "TRUTH_MARKINGS": "markings",
    "TRUTH_DRIVING_LINES": "driving_lines",
    "TRUTH_SURFACE": "surface",
    "TRUTH_LANES": "lanes",
    "TRUTH_ROADSIDE": "roadside",
}


class Failed(Exception):
    """qgis_process ended with an error; the text is what it said."""


class Survey:
    """A survey in a folder of the user's."""

    def __init__(self, folder):
        self.name, self.folder = folder.name, folder

    def files(self, checkout, into):
        return _cloud(self.folder), self.folder / TRAJECTORY


class Sample:
    """A scene of the sample survey, made anew with its default length and seed."""

    def __init__(self, scene):
        self.name, self.scene = f"sample_{scene}", scene

    def files(self, checkout, into):
        folder = into / "survey"
        folder.mkdir(exist_ok=True)
        cloud, trajectory, truth = folder / "cloud.laz", folder / "trajectory.gpkg", folder / "truth.gpkg"
        for path in (cloud, trajectory, truth):
            path.unlink(missing_ok=True)
        layers = {name: f"ogr:dbname='{truth}' table=\"{layer}\" (geom)" for name, layer in TRUTH.items()}
        qgis_process(checkout, "samplesurvey", SCENE=self.scene, POINT_CLOUD=str(cloud), TRAJECTORY=str(trajectory), **layers)
        return cloud, trajectory


def _cloud(folder):
    return next((folder / name for name in CLOUDS if (folder / name).exists()), None)


def surveys_in(folder):
    """The surveys in a folder, by name; a folder that is a survey itself counts."""
    candidates = [folder, *sorted(path for path in folder.iterdir() if path.is_dir())]
    return [Survey(path) for path in candidates if _cloud(path) and (path / TRAJECTORY).exists()]


def qgis_process(checkout, algorithm, **inputs):
    """Run an algorithm as a user would on the command line; what it said, as text.

    Raises
    ------
    Failed
        If it ended with an error.
    """
    run = subprocess.run([str(checkout / "tools" / "qgis_process"), "run", f"lanewright:{algorithm}", "-"],
                         input=json.dumps({"inputs": inputs}), capture_output=True, text=True)
    if run.returncode:
        raise Failed(f"{algorithm} ended with code {run.returncode}.\n{run.stderr.strip()}")
    log = json.loads(run.stdout).get("log", {})
    # QGIS names the kinds: errors, warning, info
    return "".join(f"{kind}: {line}\n" for kind in sorted(log, key=lambda kind: kind == "info") for line in log[kind])


def make_results(survey, into, checkout):
    """The road map of one survey in the folder `into`, with default parameters; results of an earlier run go first.

    Raises
    ------
    Failed
        If qgis_process ended with an error. The log in `into` says so too.
    """
    into.mkdir(parents=True, exist_ok=True)
    for name in (*RESULTS.values(), LOG):
        (into / name).unlink(missing_ok=True)
    try:
        cloud, trajectory = survey.files(checkout, into)
        said = qgis_process(checkout, "roadmap", POINT_CLOUDS=[str(cloud)], TRAJECTORY=str(trajectory),
                            **{output: str(into / name) for output, name in RESULTS.items()})
    except Failed as error:
        (into / LOG).write_text(f"{error}\n", encoding="utf-8")
        raise
    (into / LOG).write_text(said, encoding="utf-8")


def chosen(surveys, only):
    """The surveys named, in the order they stand in; all without names.

    Raises
    ------
    ValueError
        If no survey has one of the names.
    """
    if not only:
        return surveys
    names = [survey.name for survey in surveys]
    unknown = sorted(set(only) - set(names))
    if unknown:
        raise ValueError(f"There is no survey {', '.join(unknown)}; there are {', '.join(names)}.")
    return [survey for survey in surveys if survey.name in only]


def main():
    parser = argparse.ArgumentParser(prog="tools/survey_results.sh",
                                     description="Road maps of many surveys with default parameters, one folder of results for each.")
    parser.add_argument("results", type=Path, help="the folder for the results")
    parser.add_argument("--surveys", type=Path, help="a folder of surveys, each a folder with cloud.laz and trajectory.csv "
                                                     "(default: the sample scenes alone)")
    parser.add_argument("--only", default="", metavar="NAME,NAME", help="these surveys alone; sample scenes are "
                                                                        + ", ".join(Sample(scene).name for scene in SCENES))
    parser.add_argument("--checkout", type=Path, default=ROOT, help="another checkout of Lanewright, set up by `make setup`, whose code is "
                                                                    "run (default: this one)")
    arguments = parser.parse_args()
    surveys = []
    if arguments.surveys:
        if not arguments.surveys.is_dir():
            sys.exit(f"{arguments.surveys} is not a folder.")
        surveys = surveys_in(arguments.surveys.resolve())
        if not surveys:
            sys.exit(f"{arguments.surveys} holds no survey: a folder with {CLOUDS[0]} and {TRAJECTORY}.")
    try:
        surveys = chosen([*surveys, *map(Sample, SCENES)], [name for name in arguments.only.split(",") if name])
    except ValueError as error:
        sys.exit(str(error))
    failed = 0
    for survey in surveys:
        began = time.perf_counter()
        try:
            make_results(survey, arguments.results.resolve() / survey.name, arguments.checkout.resolve())
            how = "made"
        except Failed as error:
            failed += 1
            how = f"failed: {str(error).splitlines()[-1]}"
        print(f"{survey.name:<18} {time.perf_counter() - began:6.1f} s  {how}", flush=True)
    if failed:
        sys.exit(f"{failed} of {len(surveys)} surveys failed; {LOG} in the folder of each says why.")


if __name__ == "__main__":
    main()
