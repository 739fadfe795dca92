"""Many long lines on their way into a layer: written down as they come, read back one by one."""

import tempfile

import numpy as np

IN_MEMORY = 32 * 2**20  # bytes before a temporary file is used
WKB_TYPE = 3002         # ISO: LineString with Z and M
HEADER = np.dtype([("order", "u1"), ("type", "<u4"), ("count", "<u4")])


class LineSpool:
    """Lines with Z and M, kept as WKB; to a layer's writer the same as Features.

    Attributes: geometry_type, schema, crs as in Features. Iterating gives (WKB, row) pairs.
    """

    def __init__(self, geometry_type, schema, crs=""):
        self.geometry_type, self.schema, self.crs = geometry_type, list(schema), crs
        self._file = tempfile.SpooledTemporaryFile(IN_MEMORY, prefix="lanewright-")
        self._chunks = []

    def add(self, coordinates, first, **columns):
        """Append L lines.

        Parameters
        ----------
        coordinates : (V, 4) map x, y, z and m
        first : (L + 1,) vertices first[i]:first[i + 1] are those of line i
        columns : by field name, (L,) values or one for all
        """
        if len(first) > 1:
            self._file.write(lines_as_wkb(coordinates, first).tobytes())
            rows = {name: np.broadcast_to(values, len(first) - 1) for name, values in columns.items()}
            self._chunks.append((np.diff(first), rows))

    def __del__(self):
        self._file.close()

    def __len__(self):
        return sum(len(counts) for counts, _ in self._chunks)

    def __iter__(self):
        self._file.seek(0)
        for counts, columns in self._chunks:
            sizes = HEADER.itemsize + 32 * counts
            data = memoryview(self._file.read(int(sizes.sum())))
            ends = np.cumsum(sizes).tolist()
            names = list(columns)
            for first, end, values in zip([0, *ends], ends, zip(*(columns[name].tolist() for name in names))):
                yield bytes(data[first:end]), dict(zip(names, values))


def lines_as_wkb(coordinates, first):
    """(bytes,) uint8: the WKB of lines, one after the other."""
    counts = np.diff(first)
    headers = np.empty(len(counts), HEADER)
    headers["order"], headers["type"], headers["count"] = 1, WKB_TYPE, counts
    size = HEADER.itemsize
    out = np.empty(size * len(counts) + 32 * len(coordinates), np.uint8)
    in_header = np.zeros(len(out), bool)
    begins = 32 * np.asarray(first[:-1]) + size * np.arange(len(counts))
    in_header[(begins[:, None] + np.arange(size)).ravel()] = True
    out[in_header] = headers.view(np.uint8)
    out[~in_header] = np.ascontiguousarray(coordinates, "<f8").view(np.uint8).ravel()
    return out


def coordinates_of(wkb):
    """(V, 4) x, y, z, m of a line's WKB (little endian, ISO), as QGIS and LineSpool write it."""
    header = np.frombuffer(wkb, HEADER, 1)[0]
    if header["order"] != 1 or header["type"] != WKB_TYPE:
        raise ValueError(f"not a LineString with Z and M: WKB type {header['type']}")
    return np.frombuffer(wkb, "<f8", 4 * int(header["count"]), HEADER.itemsize).reshape(-1, 4)
