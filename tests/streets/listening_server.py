"""A web server of this computer that remembers what it is asked for, and files that make GDAL ask it."""

import threading
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer

VECTORS = {
    "vrt": ("lanes.gpkg", '<OGRVRTDataSource><OGRVRTLayer name="lanes"><SrcDataSource>/vsicurl/{url}/lanes.geojson</SrcDataSource></OGRVRTLayer>'
                          '</OGRVRTDataSource>'),
    "vrt named so": ("lanes.vrt", '<OGRVRTDataSource><OGRVRTLayer name="lanes"><SrcDataSource>/vsicurl/{url}/lanes.geojson</SrcDataSource>'
                                  '</OGRVRTLayer></OGRVRTDataSource>'),
    "linked CRS": (
        "lanes.geojson", '{{"type": "FeatureCollection", "crs": {{"type": "link", "properties": {{"href": "{url}/crs", "type": "ogcwkt"}}}}, '
        '"features": [{{"type": "Feature", "properties": {{}}, "geometry": {{"type": "LineString", "coordinates": '
        '[[500000.0, 4000000.0, 1.0], [500030.0, 4000000.0, 1.0]]}}}}]}}'),
}
_VRT = ('<VRTDataset rasterXSize="10" rasterYSize="10"><SRS>EPSG:32650</SRS><GeoTransform>500000, 1, 0, 4000000, 0, -1</GeoTransform>'
        '<VRTRasterBand dataType="Byte" band="1"><SimpleSource><SourceFilename>{name}</SourceFilename><SourceBand>1</SourceBand></SimpleSource>'
        '</VRTRasterBand></VRTDataset>')
RASTERS = {
    "vrt": ("image.tif", _VRT.replace("{name}", "/vsicurl/{url}/image.tif")),
    "vrt named so": ("image.vrt", _VRT.replace("{name}", "/vsicurl/{url}/image.tif")),
    "streamed": ("image.vrt", _VRT.replace("{name}", "/vsicurl_streaming/{url}/image.tif")),
    "wms": ("image.tif", '<GDAL_WMS><Service name="TMS"><ServerUrl>{url}/${{z}}/${{x}}/${{y}}.png</ServerUrl></Service><DataWindow>'
                         '<UpperLeftX>500000</UpperLeftX><UpperLeftY>4000000</UpperLeftY><LowerRightX>500100</LowerRightX>'
                         '<LowerRightY>3999900</LowerRightY><SizeX>100</SizeX><SizeY>100</SizeY><TileLevel>1</TileLevel></DataWindow>'
                         '<Projection>EPSG:32650</Projection><BandsCount>1</BandsCount></GDAL_WMS>'),
}


@contextmanager
def listening():
    """(address, what it was asked for: a list that grows)."""
    asked = []

    class Handler(BaseHTTPRequestHandler):
        def answer(self):
            asked.append(f"{self.command} {self.path}")
            self.send_error(404)

        do_GET = do_HEAD = do_POST = answer

        def log_message(self, *arguments):
            pass

    with ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_address[1]}", asked
        server.shutdown()


def written(folder, kind, url):
    """The file of `VECTORS` or `RASTERS` that makes GDAL ask an address."""
    name, text = kind
    (folder / name).write_text(text.format(url=url))
    return folder / name
