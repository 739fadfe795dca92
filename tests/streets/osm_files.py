"""Extracts of OpenStreetMap written by hand: ways of metres on the plane of a survey."""

from pyproj import Transformer


def osm_text(*ways, crs="EPSG:25832"):
    """The XML of ways, each of (places in metres, tags)."""
    back, nodes, text = Transformer.from_crs(crs, "EPSG:4326", always_xy=True), [], []
    for number, (places, tags) in enumerate(ways, start=1):
        references = []
        for x, y in places:
            lon, lat = back.transform(x, y)
            nodes.append(f'<node id="{len(nodes) + 1}" lat="{lat:.9f}" lon="{lon:.9f}"/>')
            references.append(f'<nd ref="{len(nodes)}"/>')
        said = "".join(f'<tag k="{key}" v="{value}"/>' for key, value in ({"highway": "residential"} | tags).items())
        text.append(f'<way id="{number}">{"".join(references)}{said}</way>')
    return f'<?xml version="1.0"?><osm version="0.6">{"".join(nodes + text)}</osm>'
