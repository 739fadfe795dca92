"""What `fuzz.py` feeds with broken files: every reader of files of others, with whole files to begin with."""

from __future__ import annotations

import struct
import sys
from collections.abc import Callable
from functools import reduce
from operator import xor
from pathlib import Path
from typing import NamedTuple

import numpy as np

TITLES = ("LAS", "LAZ", "COPC", "VPC", "trajectory text", "receiver log", "GPX", "SBET", "smrmsg", "control points", "image tags", "OpenDRIVE",
          "Lanelet2", "GeoPackage", "GeoJSON")

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "streets"))


class Kind(NamedTuple):
    """Files of one kind.

    Attributes
    ----------
    name : of a file, by whose ending it may be known
    seeds : contents of whole files
    read : called with the path of a file that may be broken
    """

    name: str
    seeds: list[bytes]
    read: Callable[[Path], object]


def kinds(folder: Path) -> dict[str, Kind]:
    """Every kind by its title; whole files are made in `folder`."""
    return {**_clouds(folder), **_trajectories(folder), **_images(folder), **_maps(), **_layers(folder)}


def _clouds(folder):
    import laspy
    from copc_files import write_copc, write_vpc
    from lanewright.algorithms.survey_input import cloud_files
    from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
    from lanewright.core.survey.las.reader import read_blocks, read_header
    from pyproj import CRS

    def cloud(path):
        header = read_header(path)
        for block in read_blocks(path, 1000):
            np.asarray(block.array["X"])
        readers = ParallelCloudReader()  # as a survey is read
        for part in readers.ranges([header], 100):
            for points in readers.points(header, *part[1:], 100):
                np.asarray(points.array["X"])
        for times in readers.times(header) if header.has_time and header.count else ():
            np.asarray(times)

    rng = np.random.default_rng(0)
    made = {"las": [], "laz": []}
    for version, point_format in (("1.2", 1), ("1.4", 6), ("1.2", 3)):
        header = laspy.LasHeader(version=version, point_format=point_format)
        header.scales, header.offsets = [0.001] * 3, [500000.0, 5000000.0, 0.0]
        header.add_crs(CRS.from_epsg(32632))
        las = laspy.LasData(header)
        las.x, las.y, las.z = (rng.uniform(0, 50, 400) + offset for offset in header.offsets)
        las.gps_time = np.linspace(0, 4, 400)
        las.intensity = rng.integers(0, 65535, 400)
        for suffix, contents in made.items():
            path = folder / f"seed_{version}_{point_format}.{suffix}"
            las.write(str(path))
            contents.append(path.read_bytes())
    copc = Path(write_copc(folder / "seed_1.4_6.laz", folder / "seed.copc.laz", in_a_node=80)).read_bytes()
    named = Path(write_vpc(folder / "all.vpc", ["./a.laz", "b.laz"])).read_bytes()
    return {"LAS": Kind("cloud.las", made["las"], cloud), "LAZ": Kind("cloud.laz", made["laz"], cloud),
            "COPC": Kind("cloud.copc.laz", [copc], cloud),
            "VPC": Kind("all.vpc", [named], lambda path: cloud_files([str(path)], ""))}


def _trajectories(folder):
    from lanewright.core.survey.trajectory.reader import read_trajectory

    time, angle = np.linspace(100.0, 200.0, 60), np.linspace(0, 1.5, 60)
    x, y = 500000 + 300 * np.sin(angle), 5000000 + 300 * np.cos(angle)
    rows = np.c_[time, x, y, 100 + 0 * x, 0.1 + 0 * x, 0.2 + 0 * x, 90 + np.degrees(angle)]
    texts = ["\n".join([head] * bool(head) + [delimiter.join(f"{value:.4f}" for value in row) for row in rows]) for delimiter, head in (
        (",", "time,x,y,z,roll,pitch,heading"), (";", ""), ("\t", "GPSTime\tEasting\tNorthing\tHeight\tRoll\tPitch\tYaw"))]
    degrees = "\n".join(["Date,UTCTime,Latitude,Longitude,H-Ell", *(
        f"2024-05-17,10:{k // 60:02d}:{k % 60:02d}.50,48.2{k:04d},9.17{k:04d},312.5" for k in range(40))])
    log = "\n".join(f"$GPGGA,1010{k:02d}.00,4812.{1000 + k}0,N,00910.{2000 + 3 * k}0,E,4,12,0.7,312.{k:02d},M,48.1,M,1.0,0000*\n"
                    f"$GPRMC,1010{k:02d}.00,A,4812.{1000 + k}0,N,00910.{2000 + 3 * k}0,E,30.0,45.0,170524,,,A*" for k in range(40))
    log = "\n".join(line + f"{reduce(xor, line[1:-1].encode()):02X}" for line in log.splitlines())
    track = '<gpx xmlns="http://www.topografix.com/GPX/1/1"><trk><trkseg>' + "".join(
        f'<trkpt lat="48.{k:04d}" lon="9.{k:04d}"><ele>3{k}</ele><time>2024-05-17T10:00:{k:02d}Z</time></trkpt>' for k in range(40))
    track += "</trkseg></trk></gpx>"
    records = b"".join(struct.pack("<17d", t, 0.85, 0.15 + 1e-7 * t, 100.0, *([0.0] * 13)) for t in time)
    accuracy = b"".join(struct.pack("<10d", t, 0.02, 0.03, 0.04, *([0.01] * 3), 1.0, 1.0, 2.0) for t in time)
    beside = folder / "pair"
    beside.mkdir(exist_ok=True)
    (beside / "sbet_drive.out").write_bytes(records)

    def pair(path):
        (beside / "smrmsg_drive.out").write_bytes(path.read_bytes())
        read_trajectory(beside / "sbet_drive.out")

    return {"trajectory text": Kind("drive.csv", [text.encode() for text in (*texts, degrees)], read_trajectory),
            "receiver log": Kind("drive.nmea", [log.encode()], read_trajectory),
            "GPX": Kind("drive.gpx", [track.encode()], read_trajectory),
            "SBET": Kind("sbet_drive.out", [records], read_trajectory), "smrmsg": Kind("smrmsg_drive.out", [accuracy], pair)}


def _images(folder):
    from lanewright.products.overlay.control_points import SourceImage, open_image, read_control_points
    from lanewright.products.overlay.rough_place import read_position_tags
    from osgeo import gdal

    def points(path):
        read_control_points(path, SourceImage("image.jpg", 1000, 600))

    pixels = [(20 + 400 * (k % 3) + 7 * k, 15 + 250 * (k // 3) + 3 * k) for k in range(9)]
    places = [(500000 + 0.1 * p, 5000000 - 0.1 * r, p, r) for p, r in pixels]
    new = "#CRS: EPSG:32632\nmapX,mapY,sourceX,sourceY,enable,dX,dY,residual\n" + "\n".join(f"{x},{y},{p},{-r},1,0,0,0" for x, y, p, r in places)
    old = "mapX\tmapY\tpixelX\tpixelY\tenable\n" + "\n".join(f"{x}\t{y}\t{p}\t{-r}\t1" for x, y, p, r in places)
    named = "name;pixel;line;easting;northing;height;role\n" + "\n".join(
        f"P{k};{p},5;{r},5;{x};{y};10,0;{'check' if k % 4 == 0 else 'control'}" for k, (x, y, p, r) in enumerate(places))
    bare = "\n".join(f"{p} {r} {x} {y}" for x, y, p, r in places)
    of_images = "EPSG:32632\n" + "\n".join(f"{x} {y} 10.5 {p} {r} image.jpg P{k}" for k, (x, y, p, r) in enumerate(places))
    exif = {"EXIF_GPSLatitude": "(48) (12) (30.5)", "EXIF_GPSLatitudeRef": "N", "EXIF_GPSLongitude": "(9) (10) (11.2)",
            "EXIF_GPSLongitudeRef": "E", "EXIF_GPSAltitude": "(312.5)", "EXIF_FocalLengthIn35mmFilm": "24"}
    packet = ('<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#"><rdf:Description '
              'drone-dji:GpsLatitude="48.2085" drone-dji:GpsLongitude="+9.1698" drone-dji:RelativeAltitude="+60.00" '
              'drone-dji:GimbalYawDegree="12.5" drone-dji:GimbalPitchDegree="-90.0"/></rdf:RDF></x:xmpmeta>')
    path = folder / "image.tif"
    image = gdal.GetDriverByName("GTiff").Create(str(path), 8, 6, 3)
    image.SetMetadata(exif)
    image.SetMetadata([packet], "xml:XMP")
    del image
    return {"control points": Kind("points.csv", [text.encode() for text in (new, old, named, bare, of_images)], points),
            "image tags": Kind("image.tif", [path.read_bytes()], lambda path: read_position_tags(open_image(path)))}


def _maps():
    from lanewright.products.export.lanelet_map import read_lanelet2
    from lanewright.products.export.opendrive.xodr import read_opendrive
    from map_files import geometry, lanelet_street, opendrive, road

    shapes = ["<line/>", '<arc curvature="0.01"/>', '<spiral curvStart="0" curvEnd="0.02"/>',
              '<paramPoly3 aU="0" bU="1" cU="0" dU="0" aV="0" bV="0" cV="0.01" dV="0" pRange="arcLength"/>']
    roads = [opendrive([road(geometry(0, 500000, 5500000, 0.3, 40, shape), 40)]) for shape in shapes]
    return {"OpenDRIVE": Kind("map.xodr", [text.encode() for text in roads], lambda path: read_opendrive(str(path))),
            "Lanelet2": Kind("map.osm", [lanelet_street().encode()], lambda path: read_lanelet2(str(path)))}


def _layers(folder):
    import shapely
    from lanewright.algorithms.vector_source import read_features
    from lanewright.core.common.features import ROAD_EDGES, Features
    from lanewright.library.layer_files import LayerFile, write_layer

    def layer(path):
        read_features(LayerFile(str(path), "Road edges"), ROAD_EDGES, "LineStringZ")

    lines = [shapely.linestrings([(500000.1 + k, 5500000.7, 24.1), (500010.0, 5500010.0, 25.0), (500030.0, 5500012.0, 25.0)]) for k in range(3)]
    row = {field.name: field.type(1) for field in ROAD_EDGES}
    made = {}
    for title, suffix in (("GeoPackage", "gpkg"), ("GeoJSON", "geojson")):
        path = folder / f"edges.{suffix}"
        write_layer(str(path), "", Features("LineStringZ", ROAD_EDGES, lines, [row] * 3, "EPSG:25832"), lambda: None)
        made[title] = Kind(path.name, [path.read_bytes()], layer)
    return made
