"""python -m accuracy [--surveys FOLDER] [--page FILE] [--quick]: see the package."""

import argparse
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from . import ROOT
from .figures import figures_of
from .page import page
from .surveys import OTHERS, SAMPLES, make_samples, surveys_in

BUILD = ROOT / "build" / "accuracy"


def main():
    parser = argparse.ArgumentParser(prog="make accuracy", description="Accuracy of every method over surveys with truth.")
    parser.add_argument("--surveys", type=Path, help="a folder of surveys with truth (default: the sample scenes, made anew)")
    parser.add_argument("--page", type=Path, help="where the page is written (default: docs/accuracy.md for the sample scenes, "
                                                  "accuracy.md in the folder of surveys otherwise)")
    parser.add_argument("--quick", action="store_true", help="without the ablation, the image resolutions and the streets surveyed otherwise")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--into", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        # a process of its own: memory is given back, and times do not depend on what ran before
        arguments.into.write_text(json.dumps(figures_of(arguments.one, arguments.quick)))
        return
    began = time.monotonic()
    folder = arguments.surveys
    if folder is None:
        folder = BUILD / "surveys"
        print(f"Making {len(SAMPLES) + len(OTHERS)} sample surveys …", flush=True)
        make_samples(folder)
    found = surveys_in(folder)
    if not found:
        sys.exit(f"{folder} holds no survey: a folder with cloud.laz, trajectory.csv and truth.gpkg (or truth/truth.gpkg).")
    figures = []
    for survey in found:
        print(f"{survey.name}: {time.monotonic() - began:.0f} s", flush=True)
        with tempfile.TemporaryDirectory() as scratch:
            into = Path(scratch) / "figures.json"
            command = [sys.executable, "-m", "accuracy", "--one", str(survey), "--into", str(into)]
            subprocess.run(command + ["--quick"] * arguments.quick, check=True)
            figures.append(json.loads(into.read_text()))
    BUILD.mkdir(parents=True, exist_ok=True)
    (BUILD / "figures.json").write_text(json.dumps(figures, indent=1))
    where = arguments.page or (ROOT / "docs" / "accuracy.md" if arguments.surveys is None else folder / "accuracy.md")
    where.write_text(page(figures, arguments.surveys is None), encoding="utf-8")
    print(f"{where} written after {time.monotonic() - began:.0f} s.")


if __name__ == "__main__":
    main()
