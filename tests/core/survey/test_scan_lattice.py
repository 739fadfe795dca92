"""The scan lattice on streets whose every line is known."""

import numpy as np
import pytest
from scanned_streets import TUNNEL, driven, scanned, survey_of

from lanewright.core.survey.scan_lattice import find_lattice


def lines_found(cloud, lattice, key=(0, 0)):
    """Share of a cloud's points whose line is right but for a constant."""
    line, _ = lattice.clocks[key].lines_and_phase(cloud.time, cloud.angle)
    apart = line - cloud.line
    return np.mean(apart == np.median(apart))


CASES = {
    "slow": dict(rotation=20.0), "usual": dict(rotation=100.0), "fast": dict(rotation=200.0, pulses=200_000.0),
    "the other way round": dict(rotation=-100.0), "straight across": dict(yaw=0.0), "turned the other way": dict(yaw=-45.0),
    "wandering": dict(wander=0.01), "rounded times": dict(rounded=1e-6, pulses=400_000.0), "lost points": dict(lost=0.10),
    "tunnel": dict(section=TUNNEL), "narrow": dict(clipped=4.0),
    "all at once": dict(wander=0.01, rounded=1e-6, lost=0.10, clipped=4.0, noise=0.01),
    "all at once in a tunnel": dict(wander=0.01, rounded=1e-6, lost=0.10, section=TUNNEL, noise=0.01),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_every_point_gets_its_line(case):
    cloud = scanned(**case)
    lattice = find_lattice(survey_of(cloud))
    assert lattice.clocks[0, 0].frequency == pytest.approx(case.get("rotation", 100.0), rel=0.005)
    assert lines_found(cloud, lattice) >= 0.9999
