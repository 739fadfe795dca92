"""python -m bench [--quick] [--parts ...] [--rounds 3]: see the package."""

import argparse
import json
import os
import time

from . import BUILD, ROOT, meaning, on_cluster, theirs
from .machine import machine
from .measures import LATER, MEASURES, PARTS, in_this_process, measure
from .page import page
from .prepare import prepared
from .results import results
from .surveys import make_far_survey, make_surveys

READS = 3   # of laspy a round, so that the floor is no matter of luck


def main():
    arguments = _arguments()
    if arguments.child:
        in_this_process(arguments.child, arguments.size, arguments.cores)
        return
    saved = BUILD / f"results-{arguments.size}.json"
    if not arguments.page_only:
        BUILD.mkdir(parents=True, exist_ok=True)
        saved.write_text(json.dumps(_run(arguments), indent=1))
    table = results(json.loads(saved.read_text()))
    whole = arguments.size == "full" and set(arguments.parts) >= set(PARTS) - set(LATER)
    where = arguments.page or (ROOT / "docs" / "benchmarks.md" if whole else BUILD / f"benchmarks-{arguments.size}.md")
    beside = where.with_suffix(".csv")
    text = page(table, beside.name)
    table.write(beside)
    where.write_text(text, encoding="utf-8")
    print(text if not whole else "", f"{where} and {beside.name} written.", sep="\n")


def _arguments():
    cores = len(os.sched_getaffinity(0))
    parser = argparse.ArgumentParser(prog="make bench", description="Seconds and memory of every stage beside those of other programs.")
    parser.add_argument("--quick", dest="size", action="store_const", const="quick", default="full",
                        help="on short surveys, once: whether all works; its figures are not to be quoted")
    parser.add_argument("--parts", nargs="+", choices=sorted(PARTS), default=[part for part in PARTS if part not in LATER],
                        help="default: all but far, 40 km of road, and cancel, which presses Cancel at many moments; each takes a quarter of an hour")
    parser.add_argument("--rounds", type=int, help="default 3, 1 with --quick")
    parser.add_argument("--cores", type=int, default=cores, help="processor cores that ours and theirs get (default %(default)s)")
    parser.add_argument("--page", type=lambda text: ROOT / text, help="where the page is written, its figures as CSV beside it "
                                                                         "(default docs/benchmarks.md, where all was run)")
    parser.add_argument("--page-only", action="store_true", help="write the page anew from the figures of the last run")
    parser.add_argument("--child", choices=sorted(MEASURES), help=argparse.SUPPRESS)
    parser.add_argument("--size", dest="size", help=argparse.SUPPRESS)
    return parser.parse_args()


def _run(arguments):
    """Every measurement of the chosen parts, in turns."""
    size, began = arguments.size, time.time()
    make_surveys(size)
    if "far" in arguments.parts:
        make_far_survey(size)
    names = list(dict.fromkeys(name for part in arguments.parts for name in PARTS[part]))
    if any(name.endswith(("_ours", "_gdal", "_pcl", "_open3d")) for name in names):
        print("Looking for the programs to compare with …", flush=True)
        theirs.install()
        if not prepared("paint.npy", size).exists():
            print("Preparing the points that they are given …", flush=True)
            measure("prepare", size, arguments.cores)
    if any(name.startswith("dask_") for name in names):
        on_cluster.install()
    names = [name for name in names if name != "read"]
    rounds, same = [], {}
    for number in range(arguments.rounds or (1 if size == "quick" else 3)):
        # each round begins elsewhere, so that nothing always runs after the same thing
        turned = names[number % len(names):] + names[:number % len(names)]
        step = -(-len(turned) // READS) if turned else 1
        figures = {"read": []}
        for k, name in enumerate(turned or ["read"]):
            if k % step == 0:
                figures["read"].append(measure("read", size, arguments.cores))
            if name != "read":
                figures[name] = measure(name, size, arguments.cores)
            last = figures[name][-1] if name == "read" else figures[name]
            print(f"round {number + 1}, {time.time() - began:4.0f} s: {name} {last.get('missing') or _told(last)}", flush=True)
        figures["read"] = _mean(figures["read"])
        rounds.append(figures)
        same = same or _meanings(size, figures)
    return dict(size=size, machine=machine(arguments.cores), rounds=rounds, meaning=same, took=time.time() - began)


def _told(figures):
    return ", ".join(f"{figures[name]:.2f} {unit}" for name, unit in (("wall", "s"), ("cpu", "CPU s"), ("peak", "MiB")) if name in figures)


def _mean(reads):
    """One read out of several: mean seconds, highest peak and load."""
    mean = {name: sum(read[name] for read in reads) / len(reads) for name in ("wall", "cpu")}
    return dict(reads[0], **mean, **{name: max(read[name] for read in reads) for name in ("peak", "load")})


def _meanings(size, figures):
    """What ours and theirs agree about, of those that were measured."""
    here = {name for name in figures if "missing" not in figures[name]}
    found = {}
    for task, compare in (("sor", meaning.same_outliers), ("clusters", meaning.same_clusters)):
        for peer in ("pcl", "open3d"):
            if {f"{task}_ours", f"{task}_{peer}"} <= here:
                found[f"{task}_{peer}"] = compare(size, peer)
    if {"image_ours", "image_gdal"} <= here:
        found["image_gdal"] = meaning.same_image(size)
    return found


if __name__ == "__main__":
    main()
