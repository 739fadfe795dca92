"""A few points from several places of every file, by which it shows how coordinates and intensities were written."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from .parallel_reader import POINTS_PER_SAMPLE, SAMPLED_PLACES, ParallelCloudReader
from .reader import CloudHeader

COARSE_COORDINATES = 0.02        # m: coordinates in steps of more scatter by more than half a centimetre, which is what curbs and lines are told by
VALUES_FOR_STEP = 1000       # of a file, from which the step of its coordinates is told
GAPS_FOR_STEP = 10           # between different values of a coordinate: fewer may be chance
SHARE_OF_OTHER_GAPS = 0.01        # of the gaps between different values may be less than the step, as where other points were added


@dataclass(frozen=True)
class FileSample:
    """N points of a file.

    raw : (N, 3) int64, x, y and z as they are stored
    intensity : (N,) uint16
    fields : {name: (N,) float64} of the extra fields with one number a point
    """

    file: CloudHeader
    raw: np.ndarray
    intensity: np.ndarray
    fields: dict[str, np.ndarray]

    @property
    def steps(self) -> np.ndarray:
        """(3,) m between neighbouring values of x, y and z; 0 where they are too few to tell."""
        return np.array([_step(values) for values in self.raw.T]) * np.abs(self.file.scales)


def sample_files(files: Sequence[CloudHeader]) -> list[FileSample]:
    """Samples of the files that have points.

    Raises
    ------
    RoadExtractionError
        If a file cannot be read.
    """
    found = []
    with ParallelCloudReader(("z", "intensity", "all_extra_bytes")) as reader:
        for file in files:
            if file.count:
                places = np.linspace(0, file.count - 1, SAMPLED_PLACES).astype(int).tolist()
                starts = sorted({reader.chunk_start(file, at) for at in places})
                parts = [_sample(next(reader.following(file, start, POINTS_PER_SAMPLE))) for start in starts]
                raw, intensity = (np.concatenate([part[k] for part in parts]) for k in (0, 1))
                found.append(FileSample(file, raw, intensity, {name: np.concatenate([part[2][name] for part in parts]) for name in parts[0][2]}))
    return found


def _sample(points):
    """Stored places, intensities and extra fields of points, which the next to be read overwrite."""
    one_number = [info.name for info in points.point_format.extra_dimensions if info.num_elements == 1]
    return (np.stack([np.array(points.array[name], np.int64) for name in "XYZ"], axis=1), np.array(points.array["intensity"]),
            {name: np.array(points[name], float) for name in one_number})


def _step(values):
    """Between neighbouring ones of (N,) integers."""
    gaps = np.diff(np.unique(values))
    return float(np.quantile(gaps, SHARE_OF_OTHER_GAPS, method="lower")) if len(values) >= VALUES_FOR_STEP and len(gaps) >= GAPS_FOR_STEP else 0.0


def coarse_coordinates(samples: Sequence[FileSample]) -> tuple[str, float]:
    """What to tell of coordinates that lie in steps of centimetres and more since their numbers hold no finer ones, and what that leaves open.

    Returns
    -------
    The warning, "" where there are no such steps, and m across, one sigma. Edges lie between two points, each of which may be off by half of a step,
    as may all others of its line: the sum of two uniform errors
    """
    for sample in samples:
        steps, scales = sample.steps, np.abs(sample.file.scales)
        ends = np.array([sample.file.minimum, sample.file.maximum], np.float32)
        short = (np.abs(steps - np.abs(np.spacing(ends))) <= scales).any(axis=0)
        coarse = steps > COARSE_COORDINATES
        told = coarse & (short | np.isclose(steps, scales, rtol=0.01))
        # Coarse steps on another axis that neither explains are those of a raster on which the points lie, as after thinning by voxels
        if not told.any() or (coarse & ~told).any():
            continue
        k = int(np.argmax(np.where(told, steps, 0.0)))
        listed = ", ".join(f"{steps[axis]:.3g} m in {name}" for axis, name in enumerate("xyz") if told[axis])
        cause = f"at {abs(float(ends[0, k])):,.0f} m that is the step of 32-bit numbers, in which some program kept them" if short[k] else \
            f"that is the scale in the header of the file ({scales[k]:g} m)"
        return (f"The coordinates of {sample.file.path} lie in steps of {listed}: {cause}. Edges and markings are no better than that. Export "
                "the cloud again with coordinates of 64 bits and a scale of 0.001 m.", float(np.where(told, steps, 0.0)[:2].max() / np.sqrt(6.0)))
    return "", 0.0
