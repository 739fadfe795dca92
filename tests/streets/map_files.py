"""Map files written by hand: one road of OpenDRIVE with any geometry, and a street of lanelets."""

from pathlib import Path


def opendrive(roads, junctions="", version=(1, 7), reference="EPSG:25832", offset=(0, 0)):
    """The text of a file of roads as `road` makes them."""
    return (f'<?xml version="1.0"?>\n<OpenDRIVE><header revMajor="{version[0]}" revMinor="{version[1]}">'
            f'<geoReference><![CDATA[{reference}]]></geoReference><offset x="{offset[0]}" y="{offset[1]}" z="0" hdg="0"/></header>'
            f'{"".join(roads)}{junctions}</OpenDRIVE>\n')


def road(geometry, length, id="1", profile='<elevation s="0" a="0" b="0" c="0" d="0"/>', lateral="", lanes=None, link="", rule="RHT", junction="-1"):
    """A road; `geometry`: the records inside planView. Its lanes: 3.5 m each side of a dashed line, solid edges, a curb on the right."""
    return (f'<road name="" length="{length}" id="{id}" junction="{junction}" rule="{rule}"><link>{link}</link><planView>{geometry}</planView>'
            f'<elevationProfile>{profile}</elevationProfile><lateralProfile>{lateral}</lateralProfile>'
            f'<lanes>{lanes or street_section()}</lanes></road>')


def geometry(s, x, y, heading, length, shape="<line/>"):
    return f'<geometry s="{s}" x="{x}" y="{y}" hdg="{heading}" length="{length}">{shape}</geometry>'


def lane(id, kind="driving", width=3.5, mark="solid", link="", widths="", more=""):
    width = "" if id == 0 else widths or f'<width sOffset="0" a="{width}" b="0" c="0" d="0"/>'
    return (f'<lane id="{id}" type="{kind}" level="false"><link>{link}</link>{width}<roadMark sOffset="0" type="{mark}" color="white" '
            f'width="0.12"/>{more}</lane>')


def street_section(s=0, links=("", "")):
    """Two lanes of 3.5 m and a curb of 12 cm on the right."""
    curb = '<height sOffset="0" inner="0" outer="0.12"/>'
    return (f'<laneSection s="{s}"><left>{lane(1, link=links[0])}</left><center>{lane(0, "none", mark="broken")}</center>'
            f'<right>{lane(-1, link=links[1])}{lane(-2, "curb", 0.15, "none", more=curb)}</right></laneSection>')


def lanelet_street(lines=(), lengths=(20.0, 20.0), more="", width=3.5):
    """A straight street to the east near 10.5 E, 52.27 N: lanelets 101.. to the east beside 201.. to the west, joined end to end."""
    from pyproj import Transformer

    back = Transformer.from_crs("EPSG:25832", "EPSG:4326", always_xy=True)
    text, x = [], [0.0]
    for length in lengths:
        x.append(x[-1] + length)
    for row, y in enumerate((-width, 0.0, width)):
        for k, at in enumerate(x):
            lon, lat = back.transform(602000.0 + at, 5792000.0 + y)
            text.append(f'<node id="{row * 100 + k + 1000}" lat="{lat:.11f}" lon="{lon:.11f}"><tag k="ele" v="{70 + 0.02 * at:.3f}"/></node>')
    kinds = (("curbstone", "high"), ("line_thin", "dashed"), ("line_thin", "solid"))
    for row, (kind, subtype) in enumerate(kinds):
        for k in range(len(lengths)):
            first, last = row * 100 + k + 1000, row * 100 + k + 1001
            nodes = (last, first) if row == 2 else (first, last)
            text.append(f'<way id="{10 * row + k + 1}"><nd ref="{nodes[0]}"/><nd ref="{nodes[1]}"/><tag k="type" v="{kind}"/>'
                        f'<tag k="subtype" v="{subtype}"/></way>')
    for k in range(len(lengths)):
        for id, left, right in ((101 + k, 11 + k, 1 + k), (201 + k, 11 + k, 21 + k)):
            text.append(f'<relation id="{id}"><member type="way" role="left" ref="{left}"/><member type="way" role="right" ref="{right}"/>'
                        '<tag k="type" v="lanelet"/><tag k="subtype" v="road"/><tag k="location" v="urban"/><tag k="one_way" v="yes"/>'
                        '<tag k="participant:vehicle" v="yes"/></relation>')
    return f'<?xml version="1.0"?>\n<osm version="0.6">\n{chr(10).join((*text, *lines))}{more}</osm>\n'


def written(folder, text, name="map.xodr"):
    path = Path(folder) / name
    path.write_text(text, encoding="utf-8")
    return str(path)
