"""Driven lanes that go on nowhere in the survey are said in the file; without that word they are a fault."""

import re
from dataclasses import fields, replace

import numpy as np
from lanewright.products.export.check.roads import check_opendrive
from lanewright.products.export.opendrive.exporter import draft_opendrive
from lanewright.products.export.opendrive.xodr import opendrive_text, read_opendrive
from lanewright.products.export.sources import RoadMapSource, checked
from made_lanes import crossing
from map_files import written


def taken(lanes, keep):
    """The pieces of lanes for which `keep` is True."""
    rows = np.repeat(keep, np.diff(lanes.start))
    columns = {field.name: getattr(lanes, field.name)[keep] for field in fields(lanes)
               if field.name not in ("successors", "left", "right", "start", "crs")}
    return replace(lanes, **columns, successors=[names for names, kept in zip(lanes.successors, keep) if kept], left=lanes.left[rows],
                   right=lanes.right[rows], start=np.append(0, np.cumsum(np.diff(lanes.start)[keep])))


def test_a_lane_that_no_way_leads_on_from_is_said_and_no_fault(tmp_path):
    lanes = crossing()
    ways = set(next(names for names in lanes.successors if len(names) > 1))
    draft = draft_opendrive(checked(RoadMapSource(taken(lanes, np.array([name not in ways for name in lanes.lane_id])))))
    text = opendrive_text(draft.map)
    assert not check_opendrive(read_opendrive(written(tmp_path, text))).found
    assert any(note.startswith("1 ends of driven lanes are linked to no lane") for note in draft.notes), draft.notes
    silent = re.sub(r'<userData code="lanewright:open_end"[^>]*/>', "", text)
    assert silent != text
    assert set(check_opendrive(read_opendrive(written(tmp_path, silent, "silent.xodr"))).counts()) == {"dead end"}


def test_a_whole_crossing_has_no_open_ends():
    draft = draft_opendrive(checked(RoadMapSource(crossing())))
    assert not any("linked to no lane" in note for note in draft.notes) and "open_end" not in opendrive_text(draft.map)
