"""Feeds the readers broken files for a while: fuzz.py [--seconds 60] [--seed 0] [--keep FOLDER]

Bytes of whole files are changed, cut, doubled and filled up. A reader may accept what is left or refuse it with
one sentence (RoadExtractionError); anything else, a run of more than ten seconds and memory beyond reason
included, is printed with the file that caused it, and kept.
"""

import argparse
import resource
import struct
import sys
import tempfile
import time
import traceback
import warnings
from pathlib import Path

import numpy as np
from plugin_package import load

SLOW = 10.0            # s
MEMORY = 6 * 1024**3   # bytes


def seeds(folder):
    """Whole files of every kind, by the reader they are for."""
    import laspy
    from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
    from lanewright.core.survey.las.reader import read_blocks, read_header
    from lanewright.core.survey.trajectory.reader import read_trajectory
    from pyproj import CRS

    def cloud(path):
        header = read_header(path)
        for block in read_blocks(path, 1000):
            np.asarray(block.array["X"])
        with ParallelCloudReader() as readers:  # as a survey is read
            for load in readers.blocks([header], 100):
                np.asarray(load().array["X"])
            for times in readers.times(header) if header.has_time and header.count else ():
                np.asarray(times)

    rng = np.random.default_rng(0)
    made = []
    for version, point_format in (("1.2", 1), ("1.4", 6), ("1.2", 3)):
        header = laspy.LasHeader(version=version, point_format=point_format)
        header.scales, header.offsets = [0.001] * 3, [500000.0, 5000000.0, 0.0]
        header.add_crs(CRS.from_epsg(32632))
        las = laspy.LasData(header)
        las.x, las.y, las.z = (rng.uniform(0, 50, 400) + offset for offset in header.offsets)
        las.gps_time = np.linspace(0, 4, 400)
        las.intensity = rng.integers(0, 65535, 400)
        for suffix in ("las", "laz"):
            path = folder / f"seed_{version}_{point_format}.{suffix}"
            las.write(str(path))
            made.append((path.read_bytes(), f".{suffix}", cloud))
        if point_format == 6:
            made.append((copc_file(folder, path), ".copc.laz", cloud))
    time_, angle = np.linspace(100.0, 200.0, 60), np.linspace(0, 1.5, 60)
    x, y = 500000 + 300 * np.sin(angle), 5000000 + 300 * np.cos(angle)
    rows = np.c_[time_, x, y, 100 + 0 * x, 0.1 + 0 * x, 0.2 + 0 * x, 90 + np.degrees(angle)]
    for delimiter, header in ((",", "time,x,y,z,roll,pitch,heading"), (";", ""), ("\t", "GPSTime\tEasting\tNorthing\tHeight\tRoll\tPitch\tYaw")):
        text = "\n".join([header] * bool(header) + [delimiter.join(f"{v:.4f}" for v in row) for row in rows])
        made.append((text.encode(), ".csv", read_trajectory))
    records = b"".join(struct.pack("<17d", t, 0.85, 0.15 + 1e-7 * t, 100.0, *([0.0] * 13)) for t in time_)
    made.append((records, ".out", read_trajectory))
    made += points_files()
    return made


def copc_file(folder, las):
    """The tests can write COPC, with many chunks of different sizes."""
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "core" / "survey"))
    from copc_files import write_copc

    return Path(write_copc(las, folder / "seed.copc.laz", in_a_node=20)).read_bytes()


def points_files():
    """Control points as the georeferencer saves them, with and without a header, and as tables."""
    from lanewright.core.overlay.control_point_file import read_control_points
    from lanewright.core.overlay.source_image import SourceImage

    def points(path):
        read_control_points(path, SourceImage(str(path), 1000, 600))

    new = ('#CRS: EPSG:32632\nmapX,mapY,sourceX,sourceY,enable,dX,dY,residual\n'
           + "\n".join(f"{500000 + 10 * k},{5000000 + k * k},{100 * k},{-50 * k},1,0,0,0" for k in range(8)))
    old = "mapX\tmapY\tpixelX\tpixelY\tenable\n" + "\n".join(f"{500000 + 10 * k}\t{5000000 + k * k}\t{100 * k}\t{-50 * k}\t1" for k in range(8))
    named = "name;pixel;line;easting;northing;height;role\n" + "\n".join(
        f"P{k};{100 * k},5;{50 * k},5;{500000 + 10 * k};{5000000 + k * k};10,0;check" for k in range(8))
    bare = "\n".join(f"{100 * k} {50 * k} {500000 + 10 * k} {5000000 + k * k}" for k in range(8))
    return [(text.encode(), suffix, points) for text, suffix in ((new, ".points"), (old, ".points"), (named, ".csv"), (bare, ".txt"))]


def broken(content, rng):
    """One of the ways a file is damaged, or several."""
    data = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        way = rng.integers(0, 9)
        if not data:
            break
        at = int(rng.integers(0, len(data)))
        if way == 0:
            for place in rng.integers(0, len(data), rng.integers(1, 20)):
                data[place] = int(rng.integers(0, 256))
        elif way == 1:  # in the header, where numbers say how long things are
            data[int(rng.integers(0, min(len(data), 400)))] = int(rng.choice([0, 1, 127, 128, 255]))
        elif way == 7:  # in the table of chunks and the records that come after the points
            data[len(data) - 1 - int(rng.integers(0, min(len(data), 300)))] = int(rng.choice([0, 1, 127, 128, 255]))
        elif way == 8:  # a length of four or eight bytes, beyond all measure or just beyond
            size = int(rng.choice([4, 8]))
            value = (0, 1, len(data), len(data) + 1, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1)[rng.integers(0, 9)]
            at = int(rng.integers(0, min(len(data), 700)))
            data[at:at + size] = (value % 2**(8 * size)).to_bytes(size, "little")
        elif way == 2:
            del data[at:]
        elif way == 3:
            del data[at:at + int(rng.integers(1, 200))]
        elif way == 4:
            data[at:at] = data[at:at + int(rng.integers(1, 300))]
        elif way == 5:
            data[at:at] = bytes(rng.integers(0, 256, int(rng.integers(1, 100)), dtype=np.uint8))
        else:
            words = [b"nan", b"1e999", b"-", b"\0", b"inf", b",", b";", b"\n\n", b"'", b'"', b"9" * 400, "é".encode("latin-1")]
            data[at:at] = words[int(rng.integers(0, len(words)))]
    return bytes(data)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("build/fuzz"))
    options = parser.parse_args()
    load()
    from lanewright.core.common.errors import RoadExtractionError

    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    options.keep.mkdir(parents=True, exist_ok=True)
    rng, tried, refused, found = np.random.default_rng(options.seed), 0, 0, 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        whole = seeds(folder)
        end = time.process_time() + options.seconds
        while time.process_time() < end:
            content, suffix, reader = whole[int(rng.integers(0, len(whole)))]
            path = folder / f"broken{suffix}"
            path.write_bytes(broken(content, rng))
            began = time.process_time()
            problem = ""
            try:
                with warnings.catch_warnings():
                    warnings.simplefilter("error")  # what numpy says of NaN is no sentence for a user
                    reader(path)
            except RoadExtractionError as error:
                refused += 1
                problem = "" if 20 < len(str(error)) < 1500 else f"message of {len(str(error))} characters: {str(error)[:200]}"
            except BaseException:
                problem = traceback.format_exc()
            if time.process_time() - began > SLOW:
                problem += f"\n{time.process_time() - began:.0f} s of CPU"
            tried += 1
            if problem:
                found += 1
                kept = options.keep / f"{options.seed}_{tried}{suffix}"
                kept.write_bytes(path.read_bytes())
                print(f"{kept}\n{problem}", flush=True)
                if isinstance(sys.exc_info()[1], KeyboardInterrupt):
                    break
    print(f"{tried} files tried, {refused} refused, {found} problems")
    sys.exit(bool(found))


if __name__ == "__main__":
    main()
