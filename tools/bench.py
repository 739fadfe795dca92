"""Seconds per stage and peak memory of the whole chain, on sample surveys of two sizes.

Prints, for each size, what `make bench` promises: seconds of every stage, points per
second, peak memory, and the same run's ratio to reading the file with laspy in blocks of
100,000 points (the mean of one before and one after). Each size runs in a process of its
own, so that peaks do not mix.
"""

import argparse
import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

SIZES = (5_000_000, 20_000_000)
POINTS_PER_METRE = 21_200  # of the default sample survey; the figures printed use the true count


def read_with_laspy(path):
    """(seconds, points) of laspy's own read in blocks of 100,000."""
    import laspy

    began, count = time.perf_counter(), 0
    with laspy.open(path) as reader:
        for points in reader.chunk_iterator(100_000):
            count += len(points.x)
    return time.perf_counter() - began, count


def measure(folder):
    """Run the chain on the survey in a folder; a dict of figures."""
    from plugin_package import load

    load()
    from lanewright.core.road_map import make_road_map
    from lanewright.core.survey.trajectory_file import read_trajectory

    cloud = folder / "survey.laz"
    read_seconds, count = read_with_laspy(cloud)
    began, cpu = time.perf_counter(), time.process_time()
    road_map = make_road_map([cloud], read_trajectory(folder / "trajectory.csv"), folder / "intensity.tif")
    wall, cpu = time.perf_counter() - began, time.process_time() - cpu
    read_seconds = (read_seconds + read_with_laspy(cloud)[0]) / 2
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10
    return dict(points=count, read=read_seconds, seconds=road_map.seconds, wall=wall,
                cpu=cpu, peak_mib=peak, load=os.getloadavg()[0],
                length_m=road_map.frame.roads[0].length, driving_lines=len(road_map.driving_lines or ()))


def measure_scanlines(folder):
    """Normalized scanlines and boundaries on them, in memory; the layer apart: a dict of figures."""
    from plugin_package import load

    load()
    from lanewright.core.road.boundaries import BoundarySettings, find_curb_points
    from lanewright.core.road.scanline_layer import ScanlineLayerSettings, write_scanlines
    from lanewright.core.survey.survey import open_survey
    from lanewright.core.survey.trajectory_file import read_trajectory

    cloud, seconds = folder / "survey.laz", {}
    read_seconds, count = read_with_laspy(cloud)
    survey = open_survey([cloud], read_trajectory(folder / "trajectory.csv"))
    for section in survey.store.sections(0):  # sections are put in order when they are first read
        survey.section(0, section)
    for stage, work in (("scanlines", lambda: write_scanlines(survey)[1]),
                        ("with boundaries", lambda: len(find_curb_points(survey, BoundarySettings(method="scanlines"))["scanlines"])),
                        ("with layer", lambda: len(write_scanlines(survey, layer=ScanlineLayerSettings())[0]))):
        began = time.perf_counter(), time.process_time()
        made = work()
        seconds[stage] = time.perf_counter() - began[0], time.process_time() - began[1], made
    read_seconds = (read_seconds + read_with_laspy(cloud)[0]) / 2
    return dict(points=count, read=read_seconds, seconds=seconds)


def show_scanlines(figures):
    print(f"  normalized scanlines, each line a run of its own; one laspy read {figures['read']:.1f} s")
    for stage, (seconds, cpu, made) in figures["seconds"].items():
        print(f"  {stage:<16} {seconds:5.1f} s  {seconds / figures['read']:6.2f} x reading   ({cpu:.1f} CPU s, {made:,} made)")


def make(folder, points):
    """A sample survey of about `points` points: the same street, as long as it takes."""
    from plugin_package import load

    load()
    import numpy as np
    from lanewright.core.sample.survey import SampleSettings, make_sample_survey

    folder.mkdir(parents=True, exist_ok=True)
    sample = make_sample_survey(SampleSettings(length=points / POINTS_PER_METRE))
    sample.write_cloud(folder / "survey.laz")
    drive = sample.trajectory
    np.savetxt(folder / "trajectory.csv", np.c_[drive.time, drive.x, drive.y, drive.z], "%.4f", ",",
               header="time,x,y,z", comments="")


def show(figures, floor):
    print(f"\n{figures['points']:,} points, {figures['length_m']:.0f} m of road; one laspy read {floor:.1f} s; "
          f"load {figures['load']:.1f} at the end")
    for stage, seconds in figures["seconds"].items():
        print(f"  {stage:<10} {seconds:7.1f} s  {figures['points'] / max(seconds, 1e-9) / 1e6:8.2f} M points/s"
              f"  {seconds / floor:6.2f} x reading")
    print(f"  {'whole':<10} {figures['wall']:7.1f} s  {figures['points'] / figures['wall'] / 1e6:8.2f} M points/s"
          f"  {figures['wall'] / floor:6.2f} x reading   ({figures['cpu']:.1f} CPU s, peak {figures['peak_mib']:.0f} MiB)")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--folder", type=Path, default=Path(__file__).resolve().parents[1] / "build" / "bench")
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="points")
    parser.add_argument("--child", choices=("make", "measure", "scanlines"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child == "make":
        make(arguments.folder, arguments.sizes[0])
        return
    if arguments.child == "measure":
        print(json.dumps(measure(arguments.folder)))
        return
    if arguments.child == "scanlines":
        print(json.dumps(measure_scanlines(arguments.folder)))
        return
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    runs = []
    for size in arguments.sizes:
        folder = arguments.folder / f"{size}"
        child = [sys.executable, __file__, "--folder", str(folder), "--sizes", str(size), "--child"]
        if not (folder / "trajectory.csv").exists():
            subprocess.run([*child, "make"], check=True)
        found = subprocess.run([*child, "measure"], check=True, stdout=subprocess.PIPE, text=True).stdout
        figures = json.loads(found.strip().splitlines()[-1])
        show(figures, figures["read"])
        runs.append(figures)
        found = subprocess.run([*child, "scanlines"], check=True, stdout=subprocess.PIPE, text=True).stdout
        show_scanlines(json.loads(found.strip().splitlines()[-1]))
    if len(runs) == 2:
        points, wall, cpu, peak = (runs[1][name] / runs[0][name] for name in ("points", "wall", "cpu", "peak_mib"))
        print(f"\n{points:.1f} x the points take {wall:.1f} x the time, {cpu:.1f} x the CPU seconds and {peak:.2f} x the memory")


if __name__ == "__main__":
    main()
