"""The table of what must be reached: each row is a ratio within one round, or a figure of a process."""

from collections.abc import Callable
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Row:
    """One line: what it is, what it is given in, its goal (None: shown only), its value in a round, and whether the goal is the least it must be."""

    text: str
    unit: str
    goal: float
    value: Callable
    needs: tuple
    least: bool = False

    def values(self, rounds):
        """Its values, one a round in which all it needs was measured."""
        return [self.value(r) for r in rounds if all(name in r and "missing" not in r[name] for name in self.needs)]

    def reached(self, rounds):
        """yes or no by the median; None where there is no goal or it was not measured."""
        values = self.values(rounds)
        if not values or self.goal is None:
            return None
        return "yes" if (median(values) >= self.goal if self.least else median(values) <= self.goal) else "no"


def _against_reading(name, part=None, read="read"):
    """Wall seconds of a measurement, or of some of its stages, over those of laspy's read."""
    def value(r):
        seconds = r[name]["wall"] if part is None else sum(r[name]["seconds"].get(stage, 0.0) for stage in part)
        return seconds / r[read]["wall"]
    return value


def _efficiency(alone, together):
    """Share of the time of one core that its half would be with two, and so on: 1 where every further core counts in full."""
    return lambda r: r[alone]["wall"] / (r[together]["cores"] * r[together]["wall"])


def _over(one, other, kind):
    return lambda r: r[one][kind] / r[other][kind]


def _points_per_second(one, other):
    return lambda r: r[one]["points"] / r[one]["wall"] / (r[other]["points"] / r[other]["wall"])


READ = "× reading"
ROWS = (
    Row("placing decoded points in the road frame", READ, 0.35, _against_reading("placing"), ("read", "placing")),
    Row("the same points chosen, packed and stored by section", READ, None, _against_reading("storing"), ("read", "storing")),
    Row("profiles and curbs", READ, 0.4, _against_reading("profiles", ("curbs", "edges")), ("read", "profiles")),
    Row("normalized scanlines and boundaries on them, in memory", READ, 4.0, _against_reading("scanlines"), ("read", "scanlines")),
    Row("intensity image of 4 cm, 50 m of road", "× gdal_grid (invdistnn)", 0.25, _over("image_ours", "image_gdal", "wall"),
        ("image_ours", "image_gdal")),
    Row("outliers, a million points", "× PCL, CPU seconds", 1.4, _over("sor_ours", "sor_pcl", "cpu"), ("sor_ours", "sor_pcl")),
    Row("outliers, a million points", "× Open3D, CPU seconds", None, _over("sor_ours", "sor_open3d", "cpu"), ("sor_ours", "sor_open3d")),
    Row("clusters, a million points", "× PCL (conditional), CPU seconds", 1.0, _over("clusters_ours", "clusters_pcl", "cpu"),
        ("clusters_ours", "clusters_pcl")),
    Row("clusters, a million points", "× Open3D (DBSCAN), CPU seconds", None, _over("clusters_ours", "clusters_open3d", "cpu"),
        ("clusters_ours", "clusters_open3d")),
    Row("marking lines and driving lines", READ, 0.1, _against_reading("profiles", ("lines", "driving")), ("read", "profiles")),
    Row("**whole road map**, boundaries by profiles, LAZ", READ, 2.8, _against_reading("profiles"), ("read", "profiles")),
    Row("**whole road map**, boundaries by profiles, LAS", READ + " the LAZ", 1.5, _against_reading("las"), ("read", "las")),
    Row("**whole road map**, boundaries by both methods (the default), LAZ", READ, 3.5, _against_reading("both"), ("read", "both")),
    Row("whole road map by both methods and worker processes, one a core", READ, None, _against_reading("workers"), ("read", "workers")),
    Row("2 km in tiles, as many points, boundaries by profiles", READ + " these tiles", 5.0, _against_reading("tiles", read="read_long"),
        ("read_long", "tiles")),
    Row("2 km in tiles by worker processes, one a core", READ + " these tiles", None, _against_reading("tiles_workers", read="read_long"),
        ("read_long", "tiles_workers")),
    Row("parallel efficiency of the default, threads", "T₁ / n Tₙ", 0.9, _efficiency("alone_both", "both"), ("alone_both", "both"), least=True),
    Row("parallel efficiency of the default, worker processes", "T₁ / n Tₙ", 0.9, _efficiency("alone_workers", "workers"),
        ("alone_workers", "workers"), least=True),
    Row("ceiling of efficiency: independent runs on one core each, side by side on all cores", "T₁ / T₁ side by side", None,
        _over("alone_both", "side_by_side", "wall"), ("alone_both", "side_by_side")),
    Row("2 km in tiles by a Dask cluster on this computer, one worker a core", READ + " these tiles", None,
        _against_reading("dask_all", read="read_long"), ("read_long", "dask_all")),
    Row("parallel efficiency of the Dask cluster", "T₁ / n Tₙ", 0.85, _efficiency("dask_one", "dask_all"), ("dask_one", "dask_all"), least=True),
    Row("points per second by worker processes, 40 km in tiles", "× 2 km", 0.9, _points_per_second("far", "tiles_workers"),
        ("far", "tiles_workers"), least=True),
    Row("peak memory, dense 200 m", "GiB", 1.2, lambda r: r["profiles"]["peak"] / 1024, ("profiles",)),
    Row("peak memory, 2 km in tiles", "GiB", 1.2, lambda r: r["tiles"]["peak"] / 1024, ("tiles",)),
    Row("peak memory, dense 200 m, both methods, worker processes and their caller together", "GiB", 1.2,
        lambda r: r["workers"]["peak"] / 1024, ("workers",)),
    Row("peak memory of ten times the length at as many points", "× dense", 1.15, _over("tiles", "profiles", "peak"), ("tiles", "profiles")),
    Row("peak memory of ten times the length and the points", "× 200 m", None, _over("tiles", "short", "peak"), ("tiles", "short")),
    Row("peak memory of worker processes and their caller, 40 km in tiles", "GiB", None, lambda r: r["far"]["peak"] / 1024, ("far",)),
    Row("progress bar, farthest from the time passed (profiles)", "% of the whole", None, lambda r: 100 * r["profiles"]["bar_off"], ("profiles",)),
    Row("progress bar, farthest from the time passed (both)", "% of the whole", None, lambda r: 100 * r["both"]["bar_off"], ("both",)),
    Row("longest time in which Cancel is not asked for (both)", "s", 2.0, lambda r: r["both"]["silence"][0], ("both",)),
)
