"""python -m accuracy [--surveys FOLDER] [--page FILE] [--quick] [--only NAME,NAME]: see the package."""

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
from .results import results
from .surveys import make_samples, surveys_in

BUILD = ROOT / "build" / "accuracy"


def main():
    parser = argparse.ArgumentParser(prog="make accuracy", description="Accuracy of every method over surveys with truth.")
    parser.add_argument("--surveys", type=Path, help="a folder of surveys with truth (default: the sample scenes, made anew)")
    parser.add_argument("--page", type=Path, help="where the page is written, its figures beside it as CSV (default: "
                                                  "docs/accuracy.md for the sample scenes, accuracy.md in the folder of surveys otherwise)")
    parser.add_argument("--quick", action="store_true", help="without the ablation, the image resolutions and the streets surveyed otherwise")
    parser.add_argument("--only", default="", metavar="NAME,NAME", help="measure these surveys alone; the page has the last figures of the others")
    parser.add_argument("--one", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--into", type=Path, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.one:
        # a process of its own: memory is given back, and times do not depend on what ran before
        arguments.into.write_text(json.dumps(figures_of(arguments.one, arguments.quick)))
        return
    began = time.monotonic()
    only = [name for name in arguments.only.split(",") if name]
    folder, saved = arguments.surveys, BUILD / "figures.json"
    if folder is None:
        folder = BUILD / "surveys"
        print("Making sample surveys …", flush=True)
        make_samples(folder, only)
    else:
        saved = folder / "figures.json"
    found = surveys_in(folder)
    if not found:
        sys.exit(f"{folder} holds no survey: a folder with cloud.laz, trajectory.csv and truth.gpkg (or truth/truth.gpkg).")
    unknown = sorted(set(only) - {survey.name for survey in found})
    if unknown:
        sys.exit(f"There is no survey {', '.join(unknown)}; there are {', '.join(survey.name for survey in found)}.")
    figures = {one["name"]: one for one in json.loads(saved.read_text())} if only and saved.exists() else {}
    saved.parent.mkdir(parents=True, exist_ok=True)
    for survey in found:
        if only and survey.name not in only:
            continue
        print(f"{survey.name}: {time.monotonic() - began:.0f} s", flush=True)
        with tempfile.TemporaryDirectory() as scratch:
            into = Path(scratch) / "figures.json"
            command = [sys.executable, "-m", "accuracy", "--one", str(survey), "--into", str(into)]
            subprocess.run(command + ["--quick"] * arguments.quick, check=True)
            figures[survey.name] = json.loads(into.read_text())
        saved.write_text(json.dumps(list(figures.values()), indent=1))
    where = arguments.page or (ROOT / "docs" / "accuracy.md" if arguments.surveys is None else folder / "accuracy.md")
    table = results([figures[survey.name] for survey in found if survey.name in figures])
    beside = where.with_suffix(".csv")
    table.write(beside)
    where.write_text(page(table, arguments.surveys is None, beside.name), encoding="utf-8")
    print(f"{where} and {beside.name} written after {time.monotonic() - began:.0f} s.")


if __name__ == "__main__":
    main()
