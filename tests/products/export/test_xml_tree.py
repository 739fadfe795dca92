"""Files that are no maps are refused before they cost time or memory."""

import resource
import subprocess
import sys
from pathlib import Path

import pytest
from lanewright.core.common.errors import RoadExtractionError
from lanewright.products.export.opendrive.model import OpenDriveMap
from lanewright.products.export.opendrive.xodr import opendrive_text
from lanewright.products.export.xml_tree import read_xml

ROOT = Path(__file__).resolve().parents[3]
LAUGHS = "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 10))
HOSTILE = {
    "a billion laughs": (f'<!DOCTYPE a [<!ENTITY l0 "ha">{LAUGHS}]><OpenDRIVE>&l9;</OpenDRIVE>', "document type or entities"),
    "an entity that is a file": ('<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><OpenDRIVE>&x;</OpenDRIVE>', "document type or entities"),
    "elements a thousand deep": (f'<OpenDRIVE>{"<a>" * 1000}{"</a>" * 1000}</OpenDRIVE>', "elements within elements"),
    "a file of another kind": ("<gpx></gpx>", "begins with <gpx>"),
    "no XML": ("PK\x03\x04 no map", "not well-formed"),
    "a file cut short": ("<OpenDRIVE><road>", "not well-formed"),
    "an empty file": ("", "not well-formed"),
    "two maps in one": ("<OpenDRIVE/><OpenDRIVE/>", "not well-formed"),
}


@pytest.mark.parametrize("what", HOSTILE)
def test_a_hostile_file_is_refused_in_one_sentence(tmp_path, what):
    text, said = HOSTILE[what]
    path = tmp_path / "map.xodr"
    path.write_text(text)
    with pytest.raises(RoadExtractionError, match=said):
        read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file")


STREET = '<OpenDRIVE><road name="{}"/></OpenDRIVE>'


@pytest.mark.parametrize("encoding, name", [
    ("gbk", "中山路"), ("shift_jis", "桜通り"), ("utf-7", "Straße"), ("utf-32", "Straße"), ("utf-32-le", "Straße"), ("windows-1252", "Straße"),
    ("utf-16", "Straße"), ("utf-8-sig", "Straße"), ("cp437", "Straße"), ("big5", "中山路")])
def test_the_name_of_a_street_is_read_in_any_encoding_of_text(tmp_path, encoding, name):
    path = tmp_path / "map.xodr"
    path.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>{STREET.format(name)}'.encode(encoding))
    assert read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file").find("road").get("name") == name


def test_a_file_that_says_utf_16_and_is_utf_8_is_read(tmp_path):
    path = tmp_path / "map.xodr"
    path.write_text(f'<?xml version="1.0" encoding="utf-16"?>{STREET.format("Straße")}', encoding="utf-8")
    assert read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file").find("road").get("name") == "Straße"


@pytest.mark.parametrize("encoding, said", [("klingon", "'klingon', which is not known"), ("hex", "'hex', which is not known"),
                                            ("gbk", "not written in the encoding gbk"), ("undefined", "not written in the encoding undefined")])
def test_an_encoding_that_is_none_or_another_is_named(tmp_path, encoding, said):
    path = tmp_path / "map.xodr"
    path.write_bytes(f'<?xml version="1.0" encoding="{encoding}"?>'.encode() + STREET.format("").encode().replace(b'""', b'"\xff\xff"'))
    with pytest.raises(RoadExtractionError, match=said):
        read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file")


def test_a_file_in_an_encoding_that_it_does_not_name_is_told_so(tmp_path):
    path = tmp_path / "map.xodr"
    path.write_bytes(STREET.format("Straße").encode("latin-1"))
    with pytest.raises(RoadExtractionError, match="is not written in UTF-8, though it names no other encoding"):
        read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file")


def test_entities_are_refused_in_every_encoding(tmp_path):
    path = tmp_path / "map.xodr"
    path.write_bytes(('<?xml version="1.0" encoding="utf-32"?>' + HOSTILE["a billion laughs"][0]).encode("utf-32"))
    with pytest.raises(RoadExtractionError, match="document type or entities"):
        read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file")


READ = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("lanewright", sys.argv[1] + "/__init__.py", submodule_search_locations=[sys.argv[1]])
package = importlib.util.module_from_spec(spec); sys.modules["lanewright"] = package; spec.loader.exec_module(package)
from lanewright.products.export.xml_tree import read_xml
try:
    read_xml(sys.argv[2], "OpenDRIVE", "an OpenDRIVE file")
except Exception as problem:
    print(type(problem).__name__, problem)
print(next(int(line.split()[1]) // 1024 for line in open("/proc/self/status") if line.startswith("VmHWM")))
"""
LARGE = {"blanks": (b"<OpenDRIVE>", b" ", 250), "blanks in a tag": (b"<OpenDRIVE ", b"\n", 250), "an endless number": (b'<OpenDRIVE a="', b"9", 250),
         "small tags": (b"<OpenDRIVE>", b"<road/>", 100), "text": (b"<OpenDRIVE>", b"la", 200)}


@pytest.mark.slow
@pytest.mark.parametrize("what", LARGE)
def test_a_huge_file_is_refused_in_seconds_within_200_mb(tmp_path, what):
    head, filling, megabytes = LARGE[what]
    path, block = tmp_path / "huge.xodr", filling * ((1 << 20) // len(filling))
    with open(path, "wb") as file:
        file.write(head)
        for _ in range(megabytes):
            file.write(block)
    start = resource.getrusage(resource.RUSAGE_CHILDREN)   # not by the clock: others may have the cores
    run = subprocess.run([sys.executable, "-c", READ, str(ROOT), str(path)], capture_output=True, text=True, timeout=300)
    said, memory = run.stdout.strip().rsplit("\n", 1)
    assert said.startswith("RoadExtractionError") and int(memory) < 200, (said, memory, run.stderr)
    end = resource.getrusage(resource.RUSAGE_CHILDREN)
    assert end.ru_utime + end.ru_stime - start.ru_utime - start.ru_stime < 20


@pytest.mark.parametrize("value", ["1e400", "nan", "9" * 100_000, "0x10", "", "1,5"])
def test_a_number_that_is_none_is_named_with_its_line(tmp_path, value):
    path = tmp_path / "map.xodr"
    path.write_text(f'<OpenDRIVE>\n<road length="{value}"/></OpenDRIVE>')
    element = read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file").find("road")
    with pytest.raises(RoadExtractionError, match="Line 2: length of <road>"):
        element.number("length")


def test_what_was_written_is_read_back(tmp_path):
    written = OpenDriveMap(name="a&b", reference='+proj=utm "quoted" <&>', offset=(0.1, 0.0, -2.5, 0.0))
    path = tmp_path / "map.xodr"
    path.write_text(opendrive_text(written), encoding="utf-8")
    header = read_xml(str(path), "OpenDRIVE", "an OpenDRIVE file").find("header")
    assert header.get("name") == "a&b" and header.find("geoReference").text == '+proj=utm "quoted" <&>'
    assert header.find("offset").attributes == {"x": "0.1", "y": "0", "z": "-2.5", "hdg": "0"}
