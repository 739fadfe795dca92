"""The figures of a run as one table of results."""

from statistics import median

from results_table import Results

from .rows import ROWS

PROGRAMS = dict(image_gdal=("intensity image", "gdal_grid"), sor_pcl=("outliers", "PCL"), sor_open3d=("outliers", "Open3D"),
                clusters_pcl=("clusters", "PCL"), clusters_open3d=("clusters", "Open3D"))
RUNS = dict(profiles="profiles, LAZ", las="profiles, LAS", both="both, LAZ", tiles="2 km in tiles, profiles", short="200 m, profiles")


def results(run):
    """The table of a run: {"size", "machine", "rounds", "meaning", "took"}, as `make bench` saves it."""
    rounds, table = run["rounds"], Results()
    table.put("run", "", "", {"size": run["size"], **run["machine"], "rounds": len(rounds), "minutes": run["took"] / 60, "busy cores": _busy(rounds)})
    for row in ROWS:
        values = row.values(rounds)
        table.put("goals", row.text, row.unit, {"goal": row.goal, "least wanted": "yes" if row.least else "no",
                                                **(_spread(values) if values else {}), "reached": row.reached(rounds)})
    for name, title in RUNS.items():
        found = _measured(rounds, name)
        if not found:
            continue
        for stage in [*dict.fromkeys(stage for f in found for stage in f["seconds"]), "densities, roughness", "whole"]:
            table.put("stages, × reading", title, stage, _spread([_seconds_of(stage, r[name]) / r["read"]["wall"] for r in rounds if name in r]))
        for text, key, scale in (("CPU s", "cpu", 1), ("peak MiB", "peak", 1), ("million points", "points", 1e-6), ("m", "length", 1),
                                 ("bar off, %", "bar_off", 100)):
            table.put("runs", title, text, _spread([f[key] * scale for f in found]))
        longest, line = max((f["silence"] for f in found), key=lambda silence: silence[0])
        table.put("runs", title, "longest s without asking for Cancel", {"most": longest, "after the line": line})
    for key in ("wall", "cpu"):
        table.put("runs", "laspy's read", f"{key} s", _spread([f[key] for f in _measured(rounds, "read")]))
    _peers(table, run)
    cancelled = _measured(rounds, "cancel")
    waits = [wait for f in cancelled for wait in f["waits"]]
    if waits:
        longest = max(waits, key=lambda wait: wait[1])
        table.put("cancel", "", "", {"moments": len(waits), "median s": median(wait[1] for wait in waits), "most s": longest[1],
                                     "after the line": longest[2], "files left": ", ".join(name for f in cancelled for name in f["left"]) or "none"})
    return table


def _spread(values):
    return {"median": float(median(values)), "least": float(min(values)), "most": float(max(values))}


def _measured(rounds, name):
    return [r[name] for r in rounds if name in r and "missing" not in r[name]]


def _busy(rounds):
    """Cores busy with other work, averaged over the time of all measurements."""
    figures = [r[name] for r in rounds for name in r if "others" in r[name]]
    took = sum(f["took"] for f in figures)
    return sum(f["others"] * f["took"] for f in figures) / took if took else 0.0


def _seconds_of(stage, figures):
    """Wall seconds of a stage, of the whole, or of what no stage counts: figures for the report."""
    seconds = figures["seconds"]
    return {"whole": figures["wall"], "densities, roughness": figures["wall"] - sum(seconds.values())}.get(stage, seconds.get(stage, 0.0))


def _peers(table, run):
    rounds = run["rounds"]
    for name, (task, program) in PROGRAMS.items():
        absent = [r[name]["missing"] for r in rounds if name in r and "missing" in r[name]]
        theirs, ours = _measured(rounds, name), _measured(rounds, name.split("_")[0] + "_ours")
        if absent:
            table.put("peers", task, program, {"missing": absent[0]})
        elif theirs and ours:
            agreed = run["meaning"].get(name)
            seconds = {f"{who}, {key} s": median(f[key] for f in figures) for who, figures in (("ours", ours), ("theirs", theirs))
                       for key in ("wall", "cpu") if all(key in f for f in figures)}
            table.put("peers", task, program, {**seconds, "alike, %": 100 * agreed["same"], "ours, found": agreed["ours"],
                                               "theirs, found": agreed["theirs"]})
