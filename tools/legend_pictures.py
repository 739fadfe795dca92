"""Pictures of the manual that need a legend, since several layers or programs meet in them: run by make_pictures.py.

A crossing and a street with rails, walls and hedges are simulated, surveyed and mapped; the ways of OpenStreetMap and the traffic
lights are made here, so that no map data of others is shown.
"""

from pathlib import Path

import numpy as np

WIDTH = 760                   # pixels, as the other pictures
PAPER, INK = "#fafafa", "#303030"
ROW = 20                      # pixels of a line of text
SHADED_CELL = 0.05            # m of the raster that is shaded
STREETS = (("Long Street", 50, [(610335.0, 2710189.9), (610401.0, 2710200.0), (610460.0, 2710209.2)]),
           ("Mill Lane", 30, [(610413.0, 2710130.0), (610401.0, 2710200.0)]))   # name, km/h, metres of the crossing's CRS
CODES = (("class=zebra", "F1", "crossing on foot"), ("class=stop", "F2", "stop line"), ("class=arrow", "F3", "arrow"),
         ("kind=edge", "L1", "edge of carriageway"), ("kind=lane,centre", "L2", "border of lane"))   # of a client
CODE_COLOURS = ("#1b6ca8", "#c0392b", "#2e8b57", "#7d3c98", "#d68910")
CLASSES = {11: ("road surface", "#6f7680"), 64: ("paint", "#f5d90a"), 65: ("curb", "#d1495b"), 2: ("ground", "#b9a88d"),
           66: ("guard rail", "#1d3f8f"), 67: ("concrete barrier", "#e07b00"), 68: ("wall", "#7b3f2a"), 69: ("fence", "#8a2be2"),
           70: ("pole", "#000000"), 71: ("sign", "#c2185b"), 3: ("low vegetation", "#a6d96a"), 4: ("medium vegetation", "#4caf50"),
           5: ("high vegetation", "#1b6e2a"), 1: ("unclassified", "#d4d4d4")}


# Results

def survey(run, folder, scene, length):
    """Files of a simulated survey and of its map in a folder; {name of the parameter: file}."""
    def at(name):
        return str(folder / name)

    drive = dict(POINT_CLOUD=at("survey.laz"), TRAJECTORY=at("trajectory.gpkg"))
    run("samplesurvey", SCENE=scene, LENGTH=length, UAV_IMAGE=None, UAV_GCPS=None, **drive)
    given = dict(POINT_CLOUDS=[drive["POINT_CLOUD"]], TRAJECTORY=drive["TRAJECTORY"])
    layers = {name: at(f"{name.lower()}.gpkg") for name in ("ROAD_EDGES", "ROAD_SURFACE", "MARKINGS", "MARKING_LINES", "DRIVING_LINES", "LANES")}
    run("roadmap", **given, **layers)
    return {**given, **layers}


def some(files, *names):
    return {name: files[name] for name in names}


SURVEY = ("POINT_CLOUDS", "TRAJECTORY")


# Layers

def symbol_layer(geometry, crs, rows, symbols, key="kind"):
    """A layer in memory. rows : [(kind, QgsGeometry)]; symbols : {kind: (label, QgsSymbol)} in the order of drawing, the lowest first."""
    from qgis.core import QgsCategorizedSymbolRenderer, QgsFeature, QgsRendererCategory, QgsVectorLayer

    made = QgsVectorLayer(f"{geometry}?crs={crs.authid()}&field={key}:string", "rows", "memory")
    order = list(symbols)
    features = []
    for kind, shape in sorted(rows, key=lambda row: order.index(row[0])):
        feature = QgsFeature(made.fields())
        feature.setAttributes([kind])
        feature.setGeometry(shape)
        features.append(feature)
    made.dataProvider().addFeatures(features)
    made.setRenderer(QgsCategorizedSymbolRenderer(
        key, [QgsRendererCategory(kind, symbol.clone(), label) for kind, (label, symbol) in symbols.items()]))
    return made


def line(colour, width=0.5, style="solid"):
    from qgis.core import QgsLineSymbol

    return QgsLineSymbol.createSimple({"color": colour, "width": str(width), "line_style": style, "capstyle": "flat"})


def fill(colour, outline="no", outline_colour="#ffffff"):
    from qgis.core import QgsFillSymbol

    return QgsFillSymbol.createSimple({"color": colour, "outline_style": outline, "outline_color": outline_colour, "outline_width": "0.15"})


def marker(colour, shape="circle", size=2.2, outline="#202020"):
    from qgis.core import QgsMarkerSymbol

    return QgsMarkerSymbol.createSimple({"color": colour, "name": shape, "size": str(size), "outline_color": outline, "outline_width": "0.2"})


def opened(path, symbols=None, key=""):
    """A result as a layer, with symbols of its own by a field or expression: {value: (label, symbol)}."""
    from qgis.core import QgsCategorizedSymbolRenderer, QgsRendererCategory, QgsVectorLayer

    made = QgsVectorLayer(str(path), "result", "ogr")
    assert made.isValid() and made.featureCount(), path
    made.setLabelsEnabled(False)
    if symbols:
        made.setRenderer(QgsCategorizedSymbolRenderer(
            key, [QgsRendererCategory(value, symbol.clone(), label) for value, (label, symbol) in symbols.items()]))
    return made


def polyline(places):
    from qgis.core import QgsGeometry, QgsPointXY

    return QgsGeometry.fromPolylineXY([QgsPointXY(*map(float, place[:2])) for place in places])


def polygon(places):
    from qgis.core import QgsGeometry, QgsPointXY

    return QgsGeometry.fromPolygonXY([[QgsPointXY(*map(float, place[:2])) for place in places]])


# Pages

def panel(layers, crs, centre, span, size):
    """The layers about a place as an image; span : metres that its width shows."""
    from qgis.core import QgsMapRendererParallelJob, QgsMapSettings, QgsPointXY, QgsRectangle
    from qgis.PyQt.QtCore import QSize
    from qgis.PyQt.QtGui import QColor

    settings = QgsMapSettings()
    settings.setLayers(layers)
    settings.setDestinationCrs(crs)
    settings.setOutputSize(QSize(*size))
    settings.setOutputDpi(96)
    settings.setExtent(QgsRectangle.fromCenterAndSize(QgsPointXY(*centre), span, span * size[1] / size[0]))
    settings.setBackgroundColor(QColor(PAPER))
    job = QgsMapRendererParallelJob(settings)
    job.start()
    job.waitForFinished()
    return job.renderedImage()


class Page:
    """A sheet of the picture's width that panels, legend and tables are put on from above."""

    def __init__(self, height):
        from qgis.PyQt.QtGui import QColor, QFont, QImage, QPainter

        self.image = QImage(WIDTH, height, QImage.Format.Format_RGB32)
        self.image.fill(QColor(PAPER))
        self.painter = QPainter(self.image)
        self.painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self.font = QFont("DejaVu Sans")
        self.font.setPixelSize(12)
        self.painter.setFont(self.font)
        self.painter.setPen(QColor(INK))

    def write(self, x, y, text, bold=False):
        self.font.setBold(bold)
        self.painter.setFont(self.font)
        self.painter.drawText(x, y, text)

    def put(self, image, x, y):
        self.painter.drawImage(x, y, image)

    def legend(self, entries, y, columns, left=10, width=WIDTH - 20):
        """[(label, symbol or colour)], row by row; the y below."""
        from qgis.core import QgsSymbolLayerUtils
        from qgis.PyQt.QtCore import QSize
        from qgis.PyQt.QtGui import QColor

        step = width // columns
        for k, (label, shown) in enumerate(entries):
            x, top = left + k % columns * step, y + k // columns * ROW
            if isinstance(shown, str):
                self.painter.fillRect(x + 2, top + 4, 16, 12, QColor(shown))
            else:
                self.painter.drawPixmap(x, top + 2, QgsSymbolLayerUtils.symbolPreviewPixmap(shown, QSize(24, 16)))
            self.write(x + 30, top + 14, label)
        return y + -(-len(entries) // columns) * ROW

    def scale(self, x, y, metres, pixels_per_metre):
        length = int(metres * pixels_per_metre)
        self.painter.drawLine(x, y, x + length, y)
        for end in (x, x + length):
            self.painter.drawLine(end, y - 4, end, y + 4)
        self.write(x + length + 6, y + 4, f"{metres:g} m")

    def save(self, path):
        from palette import with_palette

        self.painter.end()
        with_palette(self.image).save(str(path))


# The pictures

def surface_picture(run, folder, files, path):
    """A corner of the crossing: shaded heights of the triangles, the triangles and the breaklines."""
    from lanewright.processing_provider.styling import STYLES, apply_style
    from qgis.core import QgsBilinearRasterResampler, QgsHillshadeRenderer, QgsRasterLayer

    made = run("surfacemodel", **some(files, *SURVEY, "ROAD_EDGES", "LANES"), CELL_SIZE=SHADED_CELL, BREAKLINES=str(folder / "breaklines.gpkg"),
               TIN=str(folder / "triangles.gpkg"), DEM=str(folder / "heights.tif"))
    lines, shade = opened(made["BREAKLINES"]), QgsRasterLayer(made["DEM"], "heights")
    apply_style(lines, STYLES / "breaklines.qml")
    looks = QgsHillshadeRenderer(shade.dataProvider(), 1, 315.0, 40.0)
    looks.setZFactor(5.0)
    shade.setRenderer(looks)
    shade.resampleFilter().setZoomedInResampler(QgsBilinearRasterResampler())
    thin = fill("#00ffffff", "solid", "#6b7683")
    triangles = opened(made["TIN"], {value: ("", thin) for value in ("measured", "bridged")}, "status")
    span, height = 28.0, 380
    page = Page(height + 3 * ROW + 8)
    page.put(panel([lines, triangles, shade], lines.crs(), CORNER, span, (WIDTH, height)), 0, 0)
    present = {feature["kind"] for feature in lines.getFeatures()}
    entries = [(c.label(), c.symbol().clone()) for c in lines.renderer().categories() if c.value() in present]
    below = page.legend(entries, height + 4, 3)
    page.legend([("Triangles, over heights that are shaded five times as steep", thin)], below, 1)
    page.scale(WIDTH - 130, height - 14, 2, WIDTH / span)
    page.save(path)


CORNER = (610412.0, 2710196.5)   # where two curbs of the crossing meet
ARM = (610385.0, 2710190.0)      # its arm with crossing, stop lines and arrows


def cloud_picture(run, folder, files, path, street):
    """Points by class: a road with rails and walls seen from the side, and the unrolled copy of a street with cars and trees from above.

    files, street : the survey and map of each
    """
    import laspy

    clouds = []
    for name, given in (("road", files), ("street", street)):
        beside = run("roadside", **some(given, *SURVEY, "ROAD_EDGES"), OUTPUT=str(folder / f"{name}_beside.gpkg"),
                     OBJECTS=str(folder / f"{name}_objects.gpkg"))
        made = run("classifycloud", **some(given, *SURVEY, "ROAD_SURFACE", "ROAD_EDGES", "MARKINGS"), ROADSIDE=beside["OUTPUT"],
                   ROADSIDE_OBJECTS=beside["OBJECTS"], OUTPUT=str(folder / f"{name}_classified"), UNROLLED=str(folder / f"{name}_unrolled"))
        cloud = laspy.read(Path(made["UNROLLED"]) / Path(given["POINT_CLOUDS"][0]).name)
        clouds.append((cloud.xyz, np.asarray(cloud.classification)))
    (road, road_codes), (street_places, street_codes) = clouds
    # along the road to the right; what lies farther left lies higher up, and heights stand upright
    seen = np.c_[road[:, 0] + 0.25 * road[:, 1], 0.42 * road[:, 1] + 1.1 * road[:, 2]]
    scale, above, below = WIDTH / SHOWN, 205, 195
    page = Page(above + below + 6 * ROW + 8)
    page.write(10, 15, "Seen from the side", bold=True)
    page.put(dots(seen, -road[:, 1], road_codes, (26.0, -4.5), scale, above), 0, ROW)
    page.write(10, ROW + above + 15, "An unrolled copy from above: station to the right, offset upwards", bold=True)
    page.put(dots(street_places[:, :2], street_places[:, 2], street_codes, (16.0, -9.0), scale, below), 0, 2 * ROW + above)
    page.scale(WIDTH - 130, ROW + above + 10, 5, scale)
    present = set(np.unique(np.r_[road_codes, street_codes]).tolist())
    page.legend([(f"{code} {label}", colour) for code, (label, colour) in CLASSES.items() if code in present],
                2 * ROW + above + below + 4, 4)
    page.save(path)


SHOWN = 60.0   # m of the road that is shown


def dots(places, nearness, codes, corner, scale, rows):
    """Points in the colours of their classes, the nearest last. corner : of the image, lower left; scale : pixels per metre."""
    from qgis.PyQt.QtGui import QColor, QImage

    columns = np.floor((places[:, 0] - corner[0]) * scale).astype(int)
    lines = rows - 1 - np.floor((places[:, 1] - corner[1]) * scale).astype(int)
    inside = (columns >= 0) & (columns < WIDTH - 1) & (lines >= 1) & (lines < rows)
    drawn = np.flatnonzero(inside)[np.argsort(nearness[inside], kind="stable")]
    pixels = np.full((rows, WIDTH), QColor(PAPER).rgb(), np.uint32)
    palette = np.full(256, QColor(CLASSES[1][1]).rgb(), np.uint32)
    for code, (_, colour) in CLASSES.items():
        palette[code] = QColor(colour).rgb()
    for up, right in ((1, 1), (1, 0), (0, 1), (0, 0)):   # the gaps between points first
        pixels[lines[drawn] - up, columns[drawn] + right] = palette[codes[drawn]]
    return QImage(pixels.tobytes(), WIDTH, rows, 4 * WIDTH, QImage.Format.Format_RGB32).copy()


def attributes_picture(run, folder, files, path):
    """The lanes of the crossing by their speed limit, beside the ways that it came from."""
    from qgis.core import QgsRectangle

    lanes = opened(files["LANES"])
    write_ways(folder / "streets.osm", lanes.crs())
    made = run("roadattributes", LANES=files["LANES"], OSM_FILE=str(folder / "streets.osm"), OUTPUT=str(folder / "known.gpkg"))
    colours = {"50": ("50 km/h", "#e08a3c"), "30": ("30 km/h", "#5b9bd5"), "": ("no limit known", "#c9c9c9")}
    looks = {limit: (label, fill(colour, "solid")) for limit, (label, colour) in colours.items()}
    known = opened(made["OUTPUT"], looks, "coalesce(to_string(to_int(speed_kmh)), '')")
    ways = symbol_layer("LineString", lanes.crs(), [("way", polyline(places)) for _, _, places in STREETS],
                        {"way": ("Way of OpenStreetMap", line("#101010", 0.7, "dash"))})
    box = QgsRectangle(lanes.extent())
    centre, span, height = (box.center().x(), box.center().y()), box.width() + 14, 420
    page = Page(height + ROW + 8)
    page.put(panel([ways, known], lanes.crs(), centre, span, (WIDTH, height)), 0, 0)
    for name, limit, places in STREETS:
        x, y = (np.array(places[0]) - centre) * WIDTH / span
        at = (12, 60) if name == "Long Street" else (int(WIDTH / 2 + x) + 45, height - 20)
        page.write(*at, f"name={name}, maxspeed={limit}", bold=True)
    page.legend([*looks.values(), *((c.label(), c.symbol().clone()) for c in ways.renderer().categories())], height + 4, 4)
    page.save(path)


def write_ways(path, crs):
    """An extract of OpenStreetMap with the made streets."""
    from qgis.core import QgsCoordinateReferenceSystem, QgsCoordinateTransform, QgsPointXY, QgsProject

    to_degrees = QgsCoordinateTransform(crs, QgsCoordinateReferenceSystem("EPSG:4326"), QgsProject.instance())
    nodes, ways = [], []
    for number, (name, limit, places) in enumerate(STREETS, start=1):
        first = len(nodes) + 1
        for place in places:
            degrees = to_degrees.transform(QgsPointXY(*place))
            nodes.append(f'<node id="{len(nodes) + 1}" lat="{degrees.y():.9f}" lon="{degrees.x():.9f}"/>')
        members = "".join(f'<nd ref="{id}"/>' for id in range(first, len(nodes) + 1))
        tags = f'<tag k="highway" v="residential"/><tag k="name" v="{name}"/><tag k="maxspeed" v="{limit}"/>'
        ways.append(f'<way id="{number}">{members}{tags}</way>')
    path.write_text(f'<?xml version="1.0"?><osm version="0.6">{"".join(nodes + ways)}</osm>', encoding="utf-8")


def template_picture(run, folder, files, path):
    """The rows of a template, and beneath them the client's layers in the colours of the rows."""
    from qgis.core import QgsSingleSymbolRenderer, QgsVectorLayer

    rows = [("MARKINGS" if where.startswith("class") else "MARKING_LINES", where, "MARK_AREA" if where.startswith("class") else "MARK_LINE",
             code, name, "{width_m:cm}" if code != "F3" else "") for where, code, name in CODES]
    columns = ("from", "where", "layer", "CODE:text", "NAME", "WIDTH_CM:int")
    template = folder / "template.csv"
    template.write_text("\n".join(";".join(row) for row in [columns, *rows]) + "\n", encoding="utf-8")
    made = run("exporttemplate", TEMPLATE=str(template), **some(files, "MARKINGS", "MARKING_LINES"), OUTPUT=str(folder / "client.gpkg"))
    layers = []
    for name in ("MARK_LINE", "MARK_AREA"):
        looks = {code: ("", fill(colour) if name == "MARK_AREA" else line(colour, 0.6))
                 for (_, code, _), colour in zip(CODES, CODE_COLOURS, strict=True)}
        layers.append(opened(f"{made['OUTPUT']}|layername={name}", looks, "CODE"))
    road = QgsVectorLayer(files["ROAD_SURFACE"], "road", "ogr")
    road.setRenderer(QgsSingleSymbolRenderer(fill("#e3e5e8")))
    centre, span, height = ARM, 62.0, 330
    page = Page((len(rows) + 1) * ROW + 10 + height)
    stops = (34, 160, 310, 415, 510, 650)
    for k, row in enumerate([columns, *rows]):
        for x, text in zip(stops, row, strict=True):
            page.write(x, 16 + k * ROW, text, bold=k == 0)
        if k:
            page.legend([("", CODE_COLOURS[k - 1])], k * ROW, 1)
    page.put(panel([*layers, road], road.crs(), centre, span, (WIDTH, height)), 0, (len(rows) + 1) * ROW + 10)
    page.scale(WIDTH - 130, (len(rows) + 1) * ROW + height, 5, WIDTH / span)
    page.save(path)


def conversion_picture(run, folder, files, path):
    """The crossing's map as OpenDRIVE, and as the Lanelet2 that is made of it, each drawn from its file."""
    from lanewright.products.export.lanelet_map import read_lanelet2
    from lanewright.products.export.opendrive.xodr import read_opendrive

    crs = opened(files["LANES"]).crs()
    write_lights(str(folder / "signals.gpkg"), crs)
    exported = run("exportopendrive", **some(files, "LANES", "MARKING_LINES", "ROAD_EDGES", "MARKINGS"), SIGNALS=str(folder / "signals.gpkg"),
                   OUTPUT=str(folder / "map.xodr"))
    made = run("converthdmap", INPUT=exported["OUTPUT"], OUTPUT=str(folder / "converted.osm"))
    half, height, span = WIDTH // 2 - 4, 300, 62.0
    page = Page(height + 5 * ROW + 12)
    for x, title, (layers, entries) in ((0, "map.xodr", road_layers(read_opendrive(exported["OUTPUT"]), crs)),
                                        (half + 8, "converted.osm", lanelet_layers(read_lanelet2(made["OUTPUT"]), crs))):
        page.write(x + 10, 15, title, bold=True)
        page.put(panel(layers[::-1], crs, MIDDLE, span, (half, height)), x, ROW)
        page.legend(entries, ROW + height + 4, 2, x + 10, half - 10)
    page.scale(WIDTH - 110, ROW + height - 12, 10, half / span)
    page.save(path)


MIDDLE = (610401.0, 2710194.0)   # of the crossing
# where a made light stands on the crossing, metres, and the compass heading of the traffic it is for
LIGHTS = ((610381.5, 2710189.0, 22.3, 81.0), (610379.0, 2710202.0, 22.4, 81.0), (610411.2, 2710180.8, 22.5, 351.0),
          (610418.9, 2710211.0, 22.9, 261.0))


def write_lights(path, crs):
    """A layer of the made traffic lights."""
    import shapely
    from lanewright.core.common.features import SIGNALS, Features
    from lanewright.library.layer_files import write_layer

    lights = Features("PointZ", SIGNALS, crs=crs.toWkt())
    for x, y, z, heading in LIGHTS:
        lights.add(shapely.Point(x, y, z), kind="traffic_light", code="1000001", heading=heading, height_m=0.9, width_m=0.4)
    write_layer(path, "", lights, lambda: None)


def road_layers(whole, crs):
    """(layers from the lowest, legend) of an OpenDRIVE map: lanes, crossings, stop lines, lights and the reference lines of its roads."""
    from lanewright.products.export.opendrive.xodr import layers_of_opendrive

    layers = layers_of_opendrive(whole, crs.toWkt())
    inside = {road.id for road in whole.roads if road.junction != "-1"}
    areas = {"road": ("Lane of a road", fill("#c3cad3", "solid")), "junction": ("Lane in a junction", fill("#e6d5a8", "solid"))}
    lanes = [("junction" if row["type"] == "connector" else "road", shape_of(area)) for area, row in layers.lane_areas()]
    lines = {"marking": ("Road mark", line("#303030", 0.3)), "reference": ("Reference line", line("#c0392b", 0.6))}
    shift = np.array(whole.offset[:2])
    references = [("reference", polyline(road.plan.at(np.linspace(0, road.length, 40))[0] + shift)) for road in whole.roads if road.id not in inside]
    drawn = [("marking", shape_of(one)) for one in layers.marking_lines.geometries]
    return with_furniture(symbol_layer("Polygon", crs, lanes, areas), symbol_layer("LineString", crs, drawn + references, lines), layers, crs,
                          [*areas.values(), *lines.values()])


def lanelet_layers(whole, crs):
    """(layers from the lowest, legend) of a Lanelet2 map: lanelets, ways by their type, and lights."""
    from lanewright.products.export.lanelet_map import LaneletNetwork, layers_of_lanelets, node_places

    places, _ = node_places(whole, crs.toWkt())
    network = LaneletNetwork(whole, places)
    areas = {"road": ("Lanelet", fill("#cfe3f1", "solid"))}
    lanelets = [("road", polygon(np.concatenate([places[network.left[id]], places[network.right[id]][::-1]])))
                for id in network.left if network.driven(id)]
    lines = {"virtual": ("Way without paint", line("#9aa5b1", 0.3)), "line_thin": ("Way of a painted line", line("#1b5e9a", 0.5))}
    drawn = [(way.tags["type"], polyline(places[whole.rows(way)])) for way in whole.ways.values() if way.tags.get("type") in lines]
    return with_furniture(symbol_layer("Polygon", crs, lanelets, areas), symbol_layer("LineString", crs, drawn, lines),
                          layers_of_lanelets(whole, crs.toWkt()), crs, [*areas.values(), *lines.values()])


def with_furniture(lanes, lines, layers, crs, entries):
    """(layers, legend) with the crossings, stop lines and lights of a map."""
    marks = {"crosswalk": ("Crossing", fill("#f2c14e", "solid", "#8a6d1a")), "stop_line": ("Stop line", fill("#d1495b"))}
    lights = {"traffic_light": ("Traffic light", marker("#e02020", "triangle", 3.2))}
    outlines = symbol_layer("Polygon", crs, [(row["class"], shape_of(area)) for area, row in layers.markings if row["class"] in marks], marks)
    points = symbol_layer("Point", crs, [(row["kind"], shape_of(point)) for point, row in layers.signals if row["kind"] in lights], lights)
    return [lanes, outlines, lines, points], [*entries, *marks.values(), *lights.values()]


def shape_of(shape):
    """A shapely geometry for QGIS."""
    from qgis.core import QgsGeometry

    return QgsGeometry.fromWkt(shape.wkt)


def draw_all(run, folder, pictures, street):
    """Make every picture. street : the files of the sample street, as `survey` gives them."""
    places = {name: folder / name for name in ("crossing", "outskirts")}
    for place in places.values():
        place.mkdir()
    crossing = survey(run, places["crossing"], "crossing", 0)
    surface_picture(run, places["crossing"], crossing, pictures / "surfacemodel.png")
    conversion_picture(run, places["crossing"], crossing, pictures / "converthdmap.png")
    attributes_picture(run, places["crossing"], crossing, pictures / "roadattributes.png")
    template_picture(run, places["crossing"], crossing, pictures / "exporttemplate.png")
    outskirts = survey(run, places["outskirts"], "outskirts", 90)
    cloud_picture(run, places["outskirts"], outskirts, pictures / "classifycloud.png", street)
