"""Copies of point cloud files in which points have classes and the fields of the road; all else stays as it is."""

from __future__ import annotations

from collections import Counter
from contextlib import ExitStack
from copy import deepcopy

import numpy as np

from ...core.common.errors import RoadExtractionError
from ...core.common.progress import Progress
from ...core.io.crs import as_in_file, parse_crs
from ...core.lazy import laspy
from ...core.survey.las.point_fields import valid_points
from ...core.survey.las.reader import CloudHeader, open_cloud, read_blocks
from ...core.survey.road_points_las import new_laz
from .classify import PointClass, PointClassifier

COPC, CRS_RECORDS = "copc", "LASF_Projection"   # user ids of records
METRES = {"station": "Station along the road (m)", "offset": "Offset, left positive (m)", "height_above_road": "Height above the road (m)"}


def classified_copy(file: CloudHeader, classifier: PointClassifier, path: str, unrolled: str = "", progress: Progress = Progress()) -> Counter[int]:
    """Copy a point cloud, point by point in its order, with new classes and the extra fields road, station, offset and height_above_road.

    Scale, offset, times, colours, returns, further extra fields and records stay. Point formats 0 to 5, whose classes end at 31, become the
    formats 6, 7, 9 and 10 that hold the same. Noise (classes 7 and 18) and withheld points keep their class, as do points of which nothing is
    known, but for classes of `PointClass`, which an earlier run may have given.

    file : header of a file of the survey
    path : of the copy, LAS, LAZ or COPC by its ending
    unrolled : path of a second copy with the points of the road laid out straight, "" for none: x is the station, y the offset less 100 m for
        each road before, z the height above the road

    Returns the number of points by class

    Raises RoadExtractionError if the file cannot be read, the copy cannot be written, or a field of that name is of another kind.
    """
    header = _header_of(file, classifier.survey.crs)
    straight = _straightened(header) if unrolled else None
    counts: Counter[int] = Counter()
    with ExitStack() as stack:
        writer, second = stack.enter_context(new_laz(path, header)), straight and stack.enter_context(new_laz(unrolled, straight))
        for points in read_blocks(file.path, units=file.units):
            places = classifier.places(points, file.brightness)
            record = _described(points, places, header, counts)
            writer.write_points(record)
            if second is not None:
                second.write_points(_laid_out(record, places, straight))
            progress.report(sum(counts.values()) / file.count)
        if header.evlrs:
            writer.write_evlrs(header.evlrs)
    return counts


def _header_of(file, crs):
    with open_cloud(file.path, known=file) as reader:
        header = deepcopy(reader.header)
    # those of the file itself, which the reader gives in metres
    header.scales, header.offsets = np.fromfile(file.path, "<f8", 6, offset=131).reshape(2, 3)
    if header.point_format.id < 6:
        newer = laspy.PointFormat({0: 6, 1: 6, 2: 7, 3: 7, 4: 9, 5: 10}[header.point_format.id])
        newer.dimensions.extend(header.point_format.extra_dimensions)
        header.set_version_and_point_format(laspy.header.Version(1, 4), newer)
        header.global_encoding.wkt = True
    header.vlrs, header.evlrs = (_without(records or [], COPC) for records in (header.vlrs, header.evlrs))
    present = {dimension.name: dimension for dimension in header.point_format.extra_dimensions}
    added, nowhere = [], [np.iinfo(np.int32).min]
    for field in (laspy.ExtraBytesParams("road", "uint16", "Road", no_data=[np.iinfo(np.uint16).max]),
                  *(laspy.ExtraBytesParams(name, "int32", text, scales=[1e-3], offsets=[0.0], no_data=nowhere) for name, text in METRES.items())):
        known = present.get(field.name)
        if known is None:
            added.append(field)
        elif known.dtype != np.dtype(field.type) or (field.scales is not None and (known.scales is None or known.scales[0] != field.scales[0])):
            raise RoadExtractionError(f"{file.path} has an extra field {field.name} of its own kind already. Rename or remove it, and run again.")
    header.add_extra_dims(added)
    if crs and (not file.crs or file.point_format < 6):
        header.add_crs(parse_crs(as_in_file(crs)[0]))
    _name_classes(header)
    return header


def _without(records, user):
    return laspy.vlrs.vlrlist.VLRList([record for record in records if record.user_id.strip("\0 ") != user])


def _name_classes(header):
    """Let the record of the file that names classes name those of Lanewright."""
    lookup = laspy.vlrs.known.ClassificationLookupVlr
    if not header.vlrs.get(lookup.__name__):
        header.vlrs.append(lookup())
    names = header.vlrs.get(lookup.__name__)[0]
    for number in PointClass:
        if number > PointClass.HIGH_NOISE:
            names[int(number)] = number.name.lower().replace("_", " ")


def _described(points, places, header, counts):
    record = laspy.ScaleAwarePointRecord.zeros(len(points), header=header)
    before = np.asarray(points["classification"])
    if points.point_format.id == header.point_format.id:
        for name in points.array.dtype.names:
            record.array[name] = points.array[name]
    else:
        record.copy_fields_from(points)
        # of 0.006 degrees each (LAS 1.4 R15, table 17); before, whole degrees
        record.array["scan_angle"] = np.rint(points["scan_angle_rank"].astype(float) / 0.006)
        for flag, number in (("key_point", 8), ("overlap", 12)):   # what were classes are flags since
            record[flag] = np.asarray(record[flag]) | (before == number)
        before = np.where(np.isin(before, [8, 12]), np.uint8(PointClass.UNCLASSIFIED), before)
    kept = np.where(np.isin(before, [0, *map(int, PointClass)]), np.uint8(PointClass.UNCLASSIFIED), before)
    classes = np.where(places.classes > 0, places.classes, kept)
    valid = valid_points(points)
    if valid is not None:
        classes = np.where(valid, classes, before)
    record["classification"] = classes
    counts.update(dict(zip(*(values.tolist() for values in np.unique(classes, return_counts=True)))))
    inside = places.road >= 0
    record.array["road"] = np.where(inside, places.road, np.iinfo(np.uint16).max)
    for name, metres in zip(METRES, (places.s, places.d, places.h)):
        record.array[name] = np.where(inside, np.rint(np.nan_to_num(metres) * 1e3), np.iinfo(np.int32).min)
    return record


def _straightened(header):
    """The header of a copy whose coordinates are stations, offsets and heights: it has no place on earth."""
    straight = deepcopy(header)
    straight.vlrs, straight.evlrs = _without(straight.vlrs, CRS_RECORDS), laspy.vlrs.vlrlist.VLRList()
    straight.global_encoding.wkt = True   # as the point format demands; without a record the CRS is unknown
    straight.scales, straight.offsets = np.full(3, 1e-3), np.zeros(3)
    return straight


def _laid_out(record, places, header):
    """The points on the road of a record, for the copy with straight roads."""
    rows = np.flatnonzero(places.road >= 0)
    laid = laspy.ScaleAwarePointRecord(record.array[rows], header.point_format, header.scales, header.offsets)
    beside = 100.0 * places.road[rows]
    for name, metres in (("X", places.s[rows]), ("Y", places.d[rows] - beside), ("Z", places.h[rows])):
        laid.array[name] = np.rint(metres * 1e3)
    return laid
