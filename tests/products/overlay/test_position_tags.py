"""Position tags of images."""

import pytest
from lanewright.products.overlay.control_points import open_image
from lanewright.products.overlay.rough_place import read_position_tags


@pytest.mark.parametrize("damaged, found", [("EXIF_Make", (48.5, 9.25)), ("EXIF_GPSLongitude", (48.5, 9.25))])
def test_tags_that_are_no_unicode_are_read_as_far_as_they_can_be(tmp_path, damaged, found):
    gdal = pytest.importorskip("osgeo.gdal")
    tags = {"EXIF_Make": "Kamera?", "EXIF_GPSLatitude": "(48) (30) (0)?", "EXIF_GPSLatitudeRef": "N",
            "EXIF_GPSLongitude": "(9) (15) (0)?", "EXIF_GPSLongitudeRef": "E"}
    image = gdal.GetDriverByName("GTiff").Create(str(tmp_path / "image.tif"), 8, 6)
    image.SetMetadata({name: value.replace("?", "~" if name == damaged else "") for name, value in tags.items()})
    del image
    content = (tmp_path / "image.tif").read_bytes()
    assert content.count(b"~") == 1
    (tmp_path / "image.tif").write_bytes(content.replace(b"~", b"\xfc"))
    tags = read_position_tags(open_image(tmp_path / "image.tif"))
    assert (tags.latitude, tags.longitude) == found
