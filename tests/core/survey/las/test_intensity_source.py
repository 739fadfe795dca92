"""Intensities as exporters write them: with a sign, in decibels, in an extra field."""

from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest
from lanewright.core.survey.las.parallel_reader import ParallelCloudReader
from lanewright.core.survey.las.point_fields import in_one_scale, intensity_source_of
from lanewright.core.survey.las.reader import read_blocks, read_headers
from lanewright.core.survey.las.samples import coarse_coordinates, sample_files

COUNT = 60_000
RNG = np.random.default_rng(6)
# what asphalt, worn and new paint send back, as a share of what white paper would
REFLECTANCE = np.r_[RNG.lognormal(np.log(0.08), 0.35, COUNT - 4000), RNG.lognormal(np.log(0.7), 0.3, 4000)]
RNG.shuffle(REFLECTANCE)
DECIBELS = 10 * np.log10(REFLECTANCE)


def cloud(path, intensity=0, x=None, y=None, z=None, scale=0.001, **fields):
    header = laspy.LasHeader(version="1.4", point_format=6)
    header.scales, header.offsets = [scale] * 3, [500_000.0, 5_800_000.0, 0.0]
    header.add_extra_dims([laspy.ExtraBytesParams(name, values.dtype.str[1:]) for name, values in fields.items()])
    las = laspy.LasData(header)
    las.x = 500_000 + RNG.uniform(0, 200, COUNT) if x is None else x
    las.y = 5_800_000 + RNG.uniform(0, 20, COUNT) if y is None else y
    las.z = 60 + RNG.uniform(0, 3, COUNT) if z is None else z
    las.intensity = np.broadcast_to(intensity, COUNT)
    for name, values in fields.items():
        las[name] = values
    las.write(str(path))
    return path


def read(path, wanted="intensity"):
    """(N,) intensities as a survey reads them, and what is said of them."""
    source, note = intensity_source_of(sample_files(read_headers([path])), wanted)
    return np.concatenate([source.of(block) for block in read_blocks(path)]), note


def wrapped(values):
    return (np.rint(values).astype(np.int64) % 65536).astype(np.uint16)


def check_linear(found):
    """Intensities are in proportion to what came back, as far as whole numbers can be."""
    bright = REFLECTANCE > 0.02
    share = found[bright] / REFLECTANCE[bright]
    np.testing.assert_allclose(share / np.median(share), 1.0, atol=0.15)


@pytest.mark.parametrize("per_decibel, white", [(100, 0.0), (100, 3.0), (100, -12.0), (10, 0.0)],
                         ids=["hundredths", "brighter", "all negative", "tenths"])
def test_reflectance_in_decibels_that_lost_its_sign_is_what_it_was(tmp_path, per_decibel, white):
    found, note = read(cloud(tmp_path / "cloud.laz", wrapped(per_decibel * (DECIBELS + white))))
    if per_decibel == 100:
        check_linear(found)
    assert np.corrcoef(np.log(found + 1.0), DECIBELS)[0, 1] > 0.97
    assert f"{per_decibel} a dB" in note and "without one" in note


def test_linear_values_that_lost_their_sign_keep_their_order_and_distances(tmp_path):
    values = np.clip(20_000 * REFLECTANCE - 8000, -16_000, 16_000)
    found, note = read(cloud(tmp_path / "cloud.laz", wrapped(values)))
    assert np.corrcoef(found, values)[0, 1] > 0.999 and "linear values" in note


SOUND = {
    "16 bits": 20_000 * REFLECTANCE,
    "12 bits": 2000 * REFLECTANCE,
    "8 bits": 120 * REFLECTANCE,
    "8 bits in 16": np.rint(120 * REFLECTANCE) * 257,
    "saturated": np.where(REFLECTANCE > 0.4, 65535, 20_000 * REFLECTANCE),
    "signs brighter than all else": np.where(REFLECTANCE > 0.7, 65535 - RNG.uniform(0, 20_000, COUNT), 20_000 * REFLECTANCE),
    "decibels with an offset": 100 * (DECIBELS + 40),
    "up to the brim": RNG.uniform(0, 65535, COUNT),
}


@pytest.mark.parametrize("values", SOUND.values(), ids=SOUND)
def test_other_intensities_are_read_as_they_are_without_a_word(tmp_path, values):
    stored = np.clip(np.rint(values), 0, 65535).astype(np.uint16)
    found, note = read(cloud(tmp_path / "cloud.laz", stored))
    assert note == ""
    np.testing.assert_array_equal(found, stored)


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("per_decibel", [1, 10, 100])
def test_values_that_no_file_has_overflow_nothing(tmp_path, per_decibel):
    read(cloud(tmp_path / "cloud.laz", wrapped(per_decibel * DECIBELS)))


@pytest.mark.parametrize("name, values", [("Reflectance", DECIBELS.astype("f4")), ("reflectivity", DECIBELS.astype("f4")),
                                          ("Amplitude", (DECIBELS + 30).astype("f4")),
                                          ("reflectance [0.01 dB]", np.rint(100 * DECIBELS).astype("i2")), ("Reflectance", REFLECTANCE.astype("f8"))],
                         ids=["dB", "reflectivity", "positive dB", "hundredths of dB", "linear"])
def test_a_field_of_the_usual_name_stands_in_for_an_intensity_that_is_empty(tmp_path, name, values):
    found, note = read(cloud(tmp_path / "cloud.laz", 0, **{name: values}))
    check_linear(found)
    assert f"the extra field {name} is read" in note


def test_a_field_beside_a_good_intensity_is_not_looked_at(tmp_path):
    found, note = read(cloud(tmp_path / "cloud.laz", np.rint(2000 * REFLECTANCE), Reflectance=DECIBELS.astype("f4")))
    assert note == "" and np.array_equal(found, np.rint(2000 * REFLECTANCE))


def coarse(path):
    return coarse_coordinates(sample_files(read_headers([path])))[0]


def test_coordinates_through_numbers_of_32_bits_are_told_with_their_step(tmp_path):
    x = 500_000 + RNG.uniform(0, 200, COUNT)
    assert coarse(cloud(tmp_path / "fine.laz", x=x)) == ""
    told = coarse(cloud(tmp_path / "coarse.laz", x=x.astype(np.float32).astype(float)))
    assert "0.031 m in x" in told and "32-bit numbers" in told and "coarse.laz" in told


def test_points_on_a_raster_are_not_taken_for_numbers_of_32_bits(tmp_path):
    """Steps of 0.5 m in y are those of 32-bit numbers there, steps of 0.2 m in x are not: the points were thinned to a raster."""
    x, y = 500_000 + 0.2 * RNG.integers(0, 1000, COUNT), 5_800_000 + 0.5 * RNG.integers(0, 400, COUNT)
    assert coarse(cloud(tmp_path / "raster.laz", x=x, y=y)) == ""


@pytest.mark.parametrize("x, told", [(None, "0.1 m in z: they were rounded"),
                                     (500_000 + 0.05 * RNG.integers(0, 4000, COUNT), "0.05 m in x, 0.1 m in z: they were rounded")])
def test_heights_that_were_rounded_to_decimetres_are_told(tmp_path, x, told):
    assert told in coarse(cloud(tmp_path / "rounded.laz", x=x, z=np.round(60 + RNG.uniform(0, 30, COUNT), 1)))


def test_few_points_in_a_wide_field_lie_in_no_steps(tmp_path):
    """Neighbouring values of 5,000 points looked at over 200 km lie metres apart, by chance."""
    assert coarse(cloud(tmp_path / "wide.laz", x=400_000 + RNG.uniform(0, 200_000, COUNT), y=5_700_000 + RNG.uniform(0, 200_000, COUNT))) == ""


@pytest.mark.parametrize("scale, says", [(0.1, "0.1 m in x, 0.1 m in y, 0.1 m in z"), (0.01, "")])
def test_a_scale_of_decimetres_is_told(tmp_path, scale, says):
    told = coarse(cloud(tmp_path / "cloud.laz", scale=scale))
    assert says in told and bool(told) == bool(says)


def scales(tmp_path, drive=None, aside=None, **intensities):
    """({name: factor} of files with these intensities, and what is said of them); `aside`: m that points lie beside x = 500 km, by their file."""
    files = read_headers([cloud(tmp_path / f"{name}.laz", np.clip(np.rint(values), 0, 65535), **({"x": 500_000.0 + aside[name]} if aside else {}))
                          for name, values in intensities.items()])
    scaled, note = in_one_scale(files, sample_files(files), "intensity", drive)
    return {Path(file.path).stem: file.brightness for file in scaled}, note


@pytest.mark.parametrize("bits", [8, 10, 12])
def test_a_file_with_fewer_bits_than_the_others_is_brought_to_their_scale(tmp_path, bits):
    whole = np.clip(20_000 * REFLECTANCE, 0, 65535)
    factors, note = scales(tmp_path, whole=whole, few=np.floor(whole / 2 ** (16 - bits)))
    assert factors == {"whole": 1, "few": 2 ** (16 - bits)}
    assert "1 of 2 files have fewer bits" in note and "few.laz" in note and f"by {2 ** (16 - bits)}" in note


def test_files_over_darker_ground_have_the_same_scale(tmp_path):
    factors, note = scales(tmp_path, road=20_000 * REFLECTANCE, dark=6000 * REFLECTANCE, bright=30_000 * REFLECTANCE)
    assert set(factors.values()) == {1} and note == ""


DRIVE = np.c_[np.full(1000, 500_000.0), 5_800_000 + np.arange(1000.0)]


@pytest.mark.parametrize("weaker", [10, 20])
def test_a_tile_that_the_scanners_saw_from_afar_keeps_its_scale(tmp_path, weaker):
    """Ground at 15 m returns a tenth of what it returns at 3 m, and at a flatter angle less."""
    near, far = RNG.uniform(-5, 5, COUNT), RNG.uniform(15, 25, COUNT)
    factors, note = scales(tmp_path, DRIVE, dict(near=near, far=far), near=20_000 * REFLECTANCE, far=20_000 / weaker * REFLECTANCE)
    assert set(factors.values()) == {1} and note == ""


def test_a_tile_of_which_only_a_dark_corner_reaches_the_drive_keeps_its_scale(tmp_path):
    places = dict(whole=RNG.uniform(-5, 5, COUNT), corner=np.where(np.arange(COUNT) < 70, 5.0, 20.0))
    factors, note = scales(tmp_path, DRIVE, places, whole=20_000 * REFLECTANCE, corner=1000 * REFLECTANCE)
    assert set(factors.values()) == {1} and note == ""


def test_of_a_tile_with_fewer_bits_points_near_the_drive_show_it(tmp_path):
    near, mixed = RNG.uniform(-5, 5, COUNT), np.where(np.arange(COUNT) % 2 == 0, 20.0, 3.0)
    factors, _ = scales(tmp_path, DRIVE, dict(whole=near, few=mixed), whole=20_000 * REFLECTANCE,
                        few=np.floor(np.where(mixed > 10, 2000, 20_000) * REFLECTANCE / 16))
    assert factors == {"whole": 1, "few": 16}


def test_another_scale_that_no_number_of_bits_explains_is_told(tmp_path):
    factors, note = scales(tmp_path, whole=20_000 * REFLECTANCE, other=1000 * REFLECTANCE + 3500 * (REFLECTANCE > 1.2))
    assert factors == {"whole": 1, "other": 1} and "other.laz are about 20 times weaker" in note


@pytest.mark.parametrize("size", [700, 400_000])
def test_points_of_a_file_with_fewer_bits_are_read_in_the_scale_of_the_others(tmp_path, size):
    values = np.clip(np.rint(120 * REFLECTANCE), 0, 255)
    file, = read_headers([cloud(tmp_path / "few.laz", values)])
    reader = ParallelCloudReader()
    found = [points["intensity"].copy() for part in reader.ranges([file], size)
             for points in reader.points(replace(file, brightness=256), *part[1:], size)]
    np.testing.assert_array_equal(np.concatenate(found), 256 * values)
