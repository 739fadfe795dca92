"""Reading a trajectory: text tables in any format, logs of receivers, tracks, Applanix SBET, or the columns of a layer."""

from __future__ import annotations

import os
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from ...common.errors import RoadExtractionError
from ...io.crs import horizontal_part, parse_crs
from ...io.text_table import finite_or_nan, read_number_table
from ...io.weights import IO
from ..weights import TRAJECTORY
from .columns import angle_between, driven_course, geographic_unit, listed, rough_metres, stated_angle_unit
from .meaning import SAY_WHICH, meaning_of, meaning_of_table, values_by_role
from .table_columns import columns_of_record, columns_of_rows, is_record, titled_columns
from .trajectory import Trajectory, lengths_in_metres

SBET_DOUBLES = 17  # source: Applanix POSPac; time, lat, lon, height, 3 velocities, roll, pitch, heading, wander angle, 6 more
WGS84 = "EPSG:4326"


def read_trajectory(path: str | os.PathLike[str], crs: str = "", columns: str = "") -> Trajectory:
    """A trajectory from a CSV or text file, with or without header, a log of a receiver, a GPX or KML track, or an Applanix SBET file.

    crs : WKT or "EPSG:n" of its coordinates; by default the one that the file states, and WGS 84 for longitude and latitude
    columns : of a text table, as `assigned_columns` takes them; "" recognises them

    Returns Trajectory, not yet cleaned: rows in file order, angles in degrees; `notes` state what was recognised. Longitude and latitude stay in
    degrees (x is the longitude).

    Raises RoadExtractionError if the file cannot be read or its columns are not recognised.
    """
    path = Path(path)
    if not path.is_file():
        raise RoadExtractionError(f"There is no file {path}. Check the path of the trajectory.")
    if not path.stat().st_size:
        raise RoadExtractionError(f"{path} is empty. Export the trajectory again.")
    sbet = _is_sbet(path)
    if sbet and columns.strip():
        raise RoadExtractionError(f"{path} is an Applanix SBET file, whose columns are always the same. Leave Columns empty.")
    return _read_sbet(path, crs) if sbet else _read_text(path, crs, columns)


def trajectory_from_columns(columns: Mapping[str, Any], crs: str = "", angle_unit: str = "", label: str = "The trajectory",
                            notes: Sequence[str] = (), stated_units: Sequence[tuple[str, str]] = ()) -> Trajectory:
    """A trajectory, not yet cleaned, from columns of numbers.

    columns : {role: (N,) array}; roles are time, x, y, z, roll, pitch, heading, and lon, lat instead of x, y. Without `time` the positions are in
        driving order
    crs : WKT or "EPSG:n" of x, y, in its units; "" where unknown
    angle_unit : "degrees" or "radians"; "" recognises it
    label, notes : of the source for messages, and of the Trajectory so far
    stated_units : (role, "metres" or "feet") of x, y and z where their columns state a unit

    Raises RoadExtractionError if x, y or z is missing, or coordinates and CRS contradict each other.
    """
    columns = {role: finite_or_nan(np.asarray(values, float)) for role, values in columns.items()}
    remarks = list(notes)
    time = columns.get("time")
    has_time = time is not None and bool(np.isfinite(time).any())
    x, y, crs = _plane_coordinates(columns, time if has_time else None, crs, label, remarks)
    if "z" not in columns or not np.isfinite(columns["z"]).any():
        raise RoadExtractionError(f"{label} has no heights. Each position needs a z (the height of the vehicle): name the column z or height, or use "
                                  "a layer whose points have Z.")
    if time is None or not has_time:
        time = np.arange(len(x), dtype=float)
        remarks.append(f"{label} has no time; its positions are used in file order.")
    crs, (x, y, z), stated_units = lengths_in_metres(crs, (x, y, columns["z"]), stated_units, label)
    doubts: list[str] = []
    roll, pitch, heading = _angles(columns, x, y, crs, angle_unit, remarks, doubts)
    return Trajectory(time, x, y, z, roll, pitch, heading, crs=crs, has_time=has_time, notes=tuple(remarks), stated_units=tuple(stated_units),
                      doubts=tuple(doubts))


def trajectory_from_rows(titles: Sequence[str], rows: Sequence[Sequence[object]], given: Mapping[str, Any], crs: str = "",
                         label: str = "The trajectory", heights_needed: bool = True) -> Trajectory:
    """A trajectory, not yet cleaned, from the rows of a layer, by the same names and units as those of a file.

    titles, rows : names of the fields, and a list of their values for each position, None where one is missing
    given : {role: (N,) array} of what the fields need not tell, such as x and y from the points of the layer
    crs : WKT or "EPSG:n" of x, y; "" where unknown
    heights_needed : without them 0 is taken where no height is known

    Raises RoadExtractionError if x, y or z is missing, times cannot be read, or coordinates and CRS contradict each other.
    """
    columns = columns_of_rows(titles, rows)
    # positions from the geometry are not mixed with those in fields
    elsewhere = (*given, *(("lon", "lat", "ecef_x", "ecef_y", "ecef_z") if "x" in given else ()))
    meaning = meaning_of(columns, label, elsewhere)
    defaults: dict[str, Any] = {} if heights_needed else {"z": np.zeros(len(rows))}
    if not given:
        _check_complete(label, columns, meaning.place, heights_needed)
    return _from_table(columns, meaning, given, defaults, crs, "", label, list(meaning.notes))


def _read_text(path, crs, columns_given):
    """The trajectory in a text; columns are those assigned, or recognised by the names above the table, otherwise by the numbers."""
    if is_record(path):
        if columns_given.strip():
            raise RoadExtractionError(f"{path} is a log or a track, whose columns are known. Leave Columns empty.")
        records = columns_of_record(path)
        return _from_table(records, meaning_of(records, path.name), {}, {}, crs, "degrees", path.name, [])
    table = read_number_table(path)
    columns, unmatched = titled_columns(table)
    meaning = meaning_of_table(columns, unmatched, path, columns_given)
    notes = list(meaning.notes)
    _check_complete(path, columns, meaning.place)
    stated = [columns[meaning.place[role]].unit.name for role in ("heading", "roll", "pitch") if role in meaning.place]
    unit = next((name for name in stated if name in ("degrees", "radians")), "") or stated_angle_unit(table.preamble)
    if table.dropped:
        notes.append(f"{table.dropped} lines of {path.name} had another number of columns than {table.values.shape[1]} and were left out.")
    crs = crs or _stated_crs(path, table.preamble, "x" in meaning.place, notes)
    return _from_table(columns, meaning, {}, {}, crs, unit, path.name, notes, table.preamble)


def _from_table(columns, meaning, given, defaults, crs, angle_unit, label, notes, preamble=()):
    """The trajectory of columns whose meaning is known."""
    doubts: list[str] = []
    values = {**given, **values_by_role(columns, meaning, label, notes, doubts)}
    if "z" not in values or not np.isfinite(values["z"]).any():
        values.update(defaults)
    trajectory = trajectory_from_columns(values, crs, angle_unit, label, notes, _stated_lengths(columns, meaning.place, preamble))
    trajectory = replace(trajectory, doubts=(*doubts, *trajectory.doubts))
    if "time" in meaning.place and not columns[meaning.place["time"]].unit.name and not columns[meaning.place["time"]].is_text:
        trajectory = _in_seconds(trajectory, label)
    return trajectory


def _in_seconds(trajectory, label):
    """The trajectory with its times in seconds, where the speed shows that they count thousandths or less."""
    x, y = rough_metres(trajectory.x, trajectory.y, trajectory.crs)
    step, seconds = np.hypot(np.diff(x), np.diff(y)), np.diff(trajectory.time)
    speed = step[seconds > 0] / seconds[seconds > 0]
    speed = speed[np.isfinite(speed)]
    fastest = np.percentile(speed, 98) if len(speed) else 0.0
    factor = next((10.0**-power for power in (3, 6, 9) if TRAJECTORY.slowest_drive < fastest * 10.0**power < TRAJECTORY.max_vehicle_speed), 1.0)
    if not trajectory.has_time or not 0.0 < fastest < TRAJECTORY.slowest_drive or factor == 1.0:
        return trajectory
    note = f"The times of {label} are taken as counts of {factor:g} s: in seconds the drive would be at most {fastest:.2g} m/s fast."
    return replace(trajectory, time=trajectory.time * factor, doubts=(*trajectory.doubts, note))


def _stated_crs(path, preamble, projected, notes):
    """WKT of the CRS that the lines above a table state by its EPSG number, if it fits the columns; otherwise ""."""
    stated = re.search(r"EPSG\s*[:=]?\s*(\d{4,6})", " ".join(preamble), re.IGNORECASE)
    crs = parse_crs(f"EPSG:{stated.group(1)}") if stated else None
    if crs is None or horizontal_part(crs).is_projected != projected:
        return ""
    notes.append(f"{path.name} states the CRS {crs.name} (EPSG:{stated.group(1)}).")
    return crs.to_wkt()


def _check_complete(source, columns, place, heights_needed=True):
    """Refuse a table without coordinates."""
    ways = {"x": {"x", "lon", "ecef_x"}, "y": {"y", "lat", "ecef_y"}, **({"z": {"z", "ecef_z"}} if heights_needed else {})}
    missing = [role for role, roles in ways.items() if not roles & set(place)]
    if missing:
        titles = [column.title or f"column {k + 1}" for k, column in enumerate(columns)]
        raise RoadExtractionError(f"{source} has the columns {listed(titles)}; {' and '.join(missing)} cannot be found among them. Its first row "
                                  f"reads {listed([column.first for column in columns])}. {SAY_WHICH}")


def _stated_lengths(columns, place, preamble):
    """(role, "feet" or "metres") of the coordinates whose columns, or the lines above the table, state a unit."""
    in_feet = re.search(r"(position|height|distance|coordinates?)s? in (us )?(survey )?(feet|foot|ft)\b", " ".join(preamble).lower())
    stated = {role: columns[place[role]].unit.name or ("feet" if in_feet else "") for role in ("x", "y", "z") if role in place}
    return [(role, unit) for role, unit in stated.items() if unit in ("feet", "metres")]


def _farthest(values):
    return np.abs(values).max(initial=0.0, where=np.isfinite(values))


def _plane_coordinates(columns, time, crs, label, notes):
    """x, y and their CRS; longitude and latitude in degrees where they are geographic."""
    parsed = parse_crs(crs)
    geographic = parsed is not None and horizontal_part(parsed).is_geographic
    projected = parsed is not None and not geographic
    if {"x", "y"} <= set(columns) and (projected or "lon" not in columns):
        x, y = columns["x"], columns["y"]
        unit = geographic_unit(x, y, time)
        _check_map(x, y, unit, time, parsed, label)
        if not geographic and not unit:
            return x, y, parsed.to_wkt() if projected else ""
    elif {"lon", "lat"} <= set(columns):
        x, y = columns["lon"], columns["lat"]
        unit = geographic_unit(x, y, time)
        _check_degrees(x, y, unit, label)
    else:
        raise RoadExtractionError(f"{label} has no x and y, nor longitude and latitude. Name its columns time, x, y, z.")
    if unit == "radians":
        x, y = np.degrees(x), np.degrees(y)
        notes.append(f"{label} gives longitude and latitude in radians.")
    if not geographic:
        parsed = parse_crs(WGS84)
        notes.append(f"{label} gives longitude and latitude; taken as WGS 84.")
    return x, y, parsed.to_wkt()


def _check_map(x, y, unit, time, known, label):
    """Refuse x and y that contradict their CRS, `known`, or are latitude and longitude; `unit` is that of angles, "" of what is none."""
    if known is not None and horizontal_part(known).is_geographic:
        if not unit and max(_farthest(x), _farthest(y)) > 360:
            raise RoadExtractionError(f"{label} has the CRS {horizontal_part(known).name} (degrees), but its coordinates reach {_farthest(x):.0f}, "
                                      f"{_farthest(y):.0f}. Give the CRS that its x and y are in.")
        return
    if known is not None and unit:
        raise RoadExtractionError(f"{label} has the CRS {horizontal_part(known).name}, but its coordinates look like longitude and latitude (about "
                                  f"{np.nanmedian(x):.4f}, {np.nanmedian(y):.4f}). Set its CRS to EPSG:4326.")
    if not unit and geographic_unit(y, x, time) == "degrees" and _farthest(y) > 90.0:
        raise RoadExtractionError(f"{label} has x and y that look like latitude and longitude (about {np.nanmedian(x):.4f}, "
                                  f"{np.nanmedian(y):.4f}), in this order. Name the columns latitude and longitude.")


def _check_degrees(lon, lat, unit, label):
    """Refuse longitudes and latitudes that are no angles, or exchanged."""
    if not unit and max(_farthest(lon), _farthest(lat)) > 360:
        raise RoadExtractionError(
            f"{label} has longitude and latitude up to {_farthest(lon):.0f}, {_farthest(lat):.0f}; these are not degrees. Write their unit behind "
            "their names, such as latitude (ddmm.mmmm).")
    if _farthest(lat) > 90.0 >= _farthest(lon):
        raise RoadExtractionError(f"{label} has latitudes up to {_farthest(lat):.4f}°, and there are none beyond 90°, while its longitudes reach "
                                  f"{_farthest(lon):.4f}°: the two are exchanged. Name the columns the other way round.")


def _angles(columns, x, y, crs, unit, notes, doubts):
    """roll, pitch, heading in degrees, heading clockwise from north, NaN where it is not that of the drive; None where a column is missing."""
    angles = {role: columns[role] for role in ("roll", "pitch", "heading") if role in columns}
    heading = angles.get("heading", np.full(len(x), np.nan))
    x, y = rough_metres(x, y, crs)
    good = np.flatnonzero(np.isfinite(x + y + heading))
    rows, course = driven_course(x[good], y[good]) if len(good) > 2 else (good[:0], heading[:0])
    driven = heading[good][rows]
    unit = _angle_unit(angles, heading[good], driven, course, unit)
    if len(rows):
        angles["heading"] = _from_north(heading, np.degrees(driven) if unit == "radians" else driven, course, unit, notes, doubts)
    if angles and unit == "radians":
        notes.append("Roll, pitch and heading are in radians; they were converted to degrees.")
        angles = {role: np.degrees(values) for role, values in angles.items()}
    if "heading" in angles:
        angles["heading"] = angles["heading"] % 360.0
    return [angles.get(role) for role in ("roll", "pitch", "heading")]


def _angle_unit(angles, headings, driven, course, unit):
    """The unit of {role: (N,) angles}: `unit` where it is stated, unless the headings, of which (K,) have a course (degrees), exceed radians."""
    if len(headings) > 2:
        return "degrees" if np.abs(headings).max() > 2 * np.pi + 0.1 else unit or _likelier_unit(driven, course)
    if unit or not angles:
        return unit
    largest = np.nanmax(np.abs(np.concatenate([*angles.values()])), initial=-1.0)
    return "radians" if 0.0 <= largest < TRAJECTORY.max_roll_radians else "degrees"


def _likelier_unit(heading, course):
    """The unit in which (N,) headings differ less from the course, degrees; "" of none."""
    units = {"degrees": heading, "radians": np.degrees(heading)}
    return min(units, key=lambda unit: np.median(angle_between(units[unit], course))) if len(heading) else ""


def _from_north(heading, in_degrees, course, unit, notes, doubts):
    """The heading clockwise from north, also where it was counted from east; NaN where it contradicts the course."""
    difference = float(np.median(angle_between(in_degrees, course)))
    if difference < 3 * TRAJECTORY.heading_tolerance:
        return heading
    if np.median(angle_between(90.0 - in_degrees, course)) < TRAJECTORY.heading_tolerance:
        notes.append("The heading is counted counter-clockwise from east; it was converted to clockwise from north.")
        return (np.pi / 2 if unit == "radians" else 90.0) - heading
    doubts.append(f"The heading differs from the course driven by {difference:.0f}° in the median; the course is used, not the heading. Export the "
                  "heading clockwise from grid north.")
    return np.full(len(heading), np.nan)


def _is_sbet(path):
    """Whether a file consists of binary records of 17 doubles with valid latitude, longitude and increasing time."""
    size = path.stat().st_size
    with open(path, "rb") as file:
        head = file.read(IO.sample_bytes)
    if b"\0" not in head or head[:2] in (b"\xff\xfe", b"\xfe\xff") or size < 2 * SBET_DOUBLES * 8:
        return False
    usable = len(head) // (SBET_DOUBLES * 8) * SBET_DOUBLES
    rows = np.frombuffer(head, "<f8", usable).reshape(-1, SBET_DOUBLES)
    return bool(np.isfinite(rows[:, :4]).all() and (np.abs(rows[:, 1]) <= np.pi / 2).all()
                and (np.abs(rows[:, 2]) <= 2 * np.pi).all() and (rows[:, 0] >= 0).all()
                and (np.diff(rows[:, 0]) > 0).mean() > 0.9)


def _read_sbet(path, crs):
    """SBET: little-endian records of 17 doubles, angles in radians, heading in the wander frame."""
    rows = _records(path, SBET_DOUBLES)
    notes = [f"{path.name} ends within a record; the last, incomplete one was left out."] if path.stat().st_size % (SBET_DOUBLES * 8) else []
    parsed = parse_crs(crs)
    if parsed is not None and not horizontal_part(parsed).is_geographic:
        raise RoadExtractionError(f"{path} is an Applanix SBET file, which is geographic, but {horizontal_part(parsed).name} was given as its CRS. "
                                  "Leave the CRS of the input empty.")
    true_heading = rows[:, 9] - rows[:, 10]
    columns = dict(time=rows[:, 0], x=np.degrees(rows[:, 2]), y=np.degrees(rows[:, 1]), z=rows[:, 3],
                   roll=rows[:, 7], pitch=rows[:, 8], heading=true_heading)
    trajectory = trajectory_from_columns(columns, crs or WGS84, "radians", path.name, notes)
    sigma, remark = _accuracy_across(path, rows[:, 0], columns["x"], columns["y"])
    remarks = tuple(note for note in (*trajectory.notes, remark) if note and "radians" not in note)
    return replace(trajectory, notes=remarks, sigma_across=sigma)


# The accuracy of a trajectory as Applanix POSPac writes it beside an SBET: smrmsg_MISSION.out for sbet_MISSION.out.

SMRMSG_DOUBLES = 10   # source: Applanix POSPac; time, RMS north, east, down (m), of three velocities (m/s), roll, pitch, heading (arc minutes)


def _accuracy_across(sbet: Path, time: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[float, str]:
    """One sigma of a trajectory across its way in metres, from the file beside its SBET, and a sentence on it; 0 and "" without one.

    It is the root of the mean square over the way driven, so that waiting does not count. time, x, y : (N,) s, and longitude and latitude in
    degrees, as they stand in the SBET.
    """
    try:
        path = _beside(sbet)
        rows = _records(path, SMRMSG_DOUBLES) if path else np.empty((0, SMRMSG_DOUBLES))
    except OSError:   # what may not be read was not given
        path = None
    if path is None:
        return 0.0, ""
    unused = 0.0, f"{path.name} is no accuracy file of {sbet.name} and is not used."
    if path.stat().st_size // 8 != rows.size or not _tell_accuracy(rows, time):
        return unused
    east, north = np.diff(x) * np.cos(np.radians(y[:-1])), np.diff(y)
    step, middle = np.hypot(east, north), (time[1:] + time[:-1]) / 2
    driven = (step > 0) & (middle >= rows[0, 0]) & (middle <= rows[-1, 0])
    if not driven.any():
        return unused
    step, east, north, middle = (values[driven] for values in (step, east, north, middle))
    rms_north, rms_east = (np.interp(middle, rows[:, 0], rows[:, k]) for k in (1, 2))
    # across the way; how the errors in both directions hang together is not in the file
    square = (rms_north * east / step)**2 + (rms_east * north / step)**2
    sigma = float(np.sqrt(np.average(square, weights=step)))
    return sigma, f"{path.name} gives the accuracy of the trajectory: {sigma:.3f} m across, over the way driven."


def _beside(sbet):
    """The accuracy file beside an SBET, by its name; None where there is none."""
    named = re.fullmatch(r"sbet(.*)", sbet.name, re.IGNORECASE)
    target = f"smrmsg{named[1]}".lower() if named else ""
    return next((path for path in sorted(sbet.parent.iterdir()) if path.name.lower() == target and path.is_file()), None) if target else None


def _tell_accuracy(rows, time):
    """Whether (N, 10) numbers are those of an accuracy file for some of the times."""
    return len(rows) > 1 and np.isfinite(rows).all() and (np.diff(rows[:, 0]) > 0).all() and rows[0, 0] < time[-1] and time[0] < rows[-1, 0] \
        and ((rows[:, 1:4] >= 0) & (rows[:, 1:4] < TRAJECTORY.worst_accuracy)).all()


def _records(path, doubles):
    """(N, doubles) float64, the whole records of a file."""
    data = np.fromfile(path, "<f8")
    return data[:len(data) // doubles * doubles].reshape(-1, doubles)
