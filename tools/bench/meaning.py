"""Whether ours and theirs say the same, before their speeds are set side by side."""

import numpy as np

from .prepare import prepared

ALIKE = 0.02   # of the raster's range of values: cells closer than that are alike


def same_outliers(size, peer):
    """Share of points that both keep or both leave out."""
    ours, theirs = (np.load(prepared(f"sor_{name}.npy", size)) for name in ("ours", peer))
    return dict(same=float(np.mean(ours == theirs)), ours=int(ours.sum()), theirs=int(theirs.sum()))


def same_clusters(size, peer):
    """Share of points whose cluster holds the same points in both, by the best partner of each cluster of ours.

    A cluster of n points that shares m with its best partner of k counts m / (n + k - m) for each of its points.
    """
    ours, theirs = (np.unique(np.load(prepared(f"clusters_{name}.npy", size)), return_inverse=True)[1] for name in ("ours", peer))
    pairs, shared = np.unique(ours * (theirs.max() + 1) + theirs, return_counts=True)
    a, b = pairs // (theirs.max() + 1), pairs % (theirs.max() + 1)
    sizes = np.bincount(ours)
    alike = shared / (sizes[a] + np.bincount(theirs)[b] - shared)
    best = np.zeros(len(sizes))
    np.maximum.at(best, a, alike)
    return dict(same=float(np.sum(best * sizes) / len(ours)), ours=len(sizes), theirs=int(theirs.max()) + 1)


def same_image(size):
    """Share of cells filled by either that both fill alike, within a hundredth of the range of values."""
    from osgeo import gdal

    gdal.UseExceptions()
    datasets = [gdal.Open(str(prepared(f"{name}.tif", size))) for name in ("ours", "gdal")]
    a, b = (_values(dataset) for dataset in datasets)
    either, both = ~(np.isnan(a) & np.isnan(b)), ~(np.isnan(a) | np.isnan(b))
    low, high = np.percentile(b[both], [1, 99])
    alike = np.abs(a[both] - b[both]) <= ALIKE * (high - low)
    return dict(same=float(alike.sum() / either.sum()), ours=int((~np.isnan(a)).sum()), theirs=int((~np.isnan(b)).sum()))


def _values(dataset):
    """(height, width) float32 of a raster, NaN where there is none."""
    from osgeo import gdal

    band = dataset.GetRasterBand(1)
    values = np.frombuffer(band.ReadRaster(buf_type=gdal.GDT_Float32), np.float32).reshape(dataset.RasterYSize, dataset.RasterXSize)
    return np.where(values == np.float32(band.GetNoDataValue()), np.nan, values)
