"""The figures of a run as docs/benchmarks.md."""

from statistics import median

from .rows import READ, ROWS, reached

QUIET = 0.15   # processor cores busy with other work, on average, beyond which figures are not to be trusted
PROGRAMS = dict(image_gdal=("intensity image", "gdal_grid"), sor_pcl=("outliers", "PCL"), sor_open3d=("outliers", "Open3D"),
                clusters_pcl=("clusters", "PCL"), clusters_open3d=("clusters", "Open3D"))
RUNS = dict(profiles="profiles, LAZ", las="profiles, LAS", both="both, LAZ", tiles="2 km in tiles, profiles")


def page(results):
    rounds = results["rounds"]
    sections = (_intro(results), _goals(rounds), _stages(rounds), _peers(results), _memory(rounds), _time(rounds), _how(results))
    return "\n\n".join(section for section in sections if section) + "\n"


def table(head, rows, words=1):
    lines = [head, ["---"] * words + ["---:"] * (len(head) - words), *rows]
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def _spread(values, digits=2):
    """median (least–most)"""
    middle, least, most = (f"{value:.{digits}f}" for value in (median(values), min(values), max(values)))
    return middle if least == most else f"{middle} ({least}–{most})"


def _measured(rounds, name):
    return [r[name] for r in rounds if name in r and "missing" not in r[name]]


def _intro(results):
    m, rounds = results["machine"], results["rounds"]
    busy = _busy(rounds)
    lines = ["# Benchmarks"]
    if results["size"] != "full":
        lines.append("**A short form, on small surveys, to see whether all works: these figures are not to be quoted.**")
    lines.append(
        f"`make bench` wrote this page. It makes its surveys once (**simulated** streets: two scanners, curbs, paint, parked cars, trees), "
        f"then runs every stage, the whole chain and the programs beside it in turns, {_rounds(rounds)}, each in a process of its own. "
        "Seconds of one machine say little about another, so figures are ratios within one round: *× reading* is the time over that of "
        "laspy reading the same LAZ in blocks of 100,000 points with all cores (lazrs-parallel), which nothing that uses laspy can beat. "
        "Given are the median and, in brackets, the least and the most.")
    lines.append(
        f"{m['processor']}, {m['cores']} of {m['of']} cores for ours and theirs alike, {m['memory_gib']:.0f} GiB, {m['system']}; "
        f"Python {m['python']}, numpy {m['numpy']}, scipy {m['scipy']}, laspy {m['laspy']} with lazrs {m['lazrs']}. "
        f"The run took {results['took'] / 60:.0f} minutes. Other work kept {busy:.2f} cores busy on average.")
    if busy > QUIET:
        lines.append(f"**The machine was not quiet: {busy:.1f} cores were busy with other work. Take the wall times, and the ratios of "
                     "them, for no more than a sign that all runs.**")
    return "\n\n".join(lines)


def _busy(rounds):
    """Cores busy with other work, averaged over the time of all measurements."""
    figures = [r[name] for r in rounds for name in r if "others" in r[name]]
    took = sum(f["took"] for f in figures)
    return sum(f["others"] * f["took"] for f in figures) / took if took else 0.0


def _rounds(rounds):
    return {1: "once", 2: "twice", 3: "three times"}.get(len(rounds), f"{len(rounds)} times")


def _goals(rounds):
    rows = []
    for row in ROWS:
        found = reached(row, rounds)
        if found is None:
            rows.append([row.text, row.unit, _goal(row), "not measured", ""])
            continue
        rows.append([row.text, row.unit, _goal(row), _spread(row.values(rounds)), found[3]])
    return "## What is asked, and what is reached\n\n" + table(["what", "given in", "must be", "is", "reached"], rows, words=2)


def _goal(row):
    return "" if row.goal is None else f"{'≥' if row.least else '≤'} {row.goal:g}"


def _stages(rounds):
    runs = {name: title for name, title in RUNS.items() if _measured(rounds, name)}
    if not runs:
        return ""
    stages = list(dict.fromkeys(stage for name in runs for figures in _measured(rounds, name) for stage in figures["seconds"]))
    rows = []
    for stage in [*stages, "densities, roughness", "whole"]:
        cells = [_spread([_seconds_of(stage, r[name]) / r["read"]["wall"] for r in rounds if name in r]) for name in runs]
        rows.append([stage, *cells])
    for text, key, scale, digits in (("CPU seconds", "cpu", 1, 1), ("peak memory (MiB)", "peak", 1, 0), ("points (million)", "points", 1e-6, 1)):
        rows.append([text, *(_spread([f[key] * scale for f in _measured(rounds, name)], digits) for name in runs)])
    read = _measured(rounds, "read")
    return (f"## Every stage ({READ} the dense LAZ)\n\n" + table(["stage", *runs.values()], rows)
            + f"\n\nlaspy's read itself: {_spread([r['wall'] for r in read])} s, {_spread([r['cpu'] for r in read])} CPU seconds. "
              "*survey* decodes, places and stores the points; *edges* are the lines through curb points; *lines* and *driving* are the fits; "
              "*densities, roughness* are taken for the report. What the time is made of, and what would shorten it: [speed.md](speed.md).")


def _seconds_of(stage, figures):
    """Wall seconds of a stage, of the whole, or of what no stage counts: figures for the report."""
    seconds = figures["seconds"]
    return {"whole": figures["wall"], "densities, roughness": figures["wall"] - sum(seconds.values())}.get(stage, seconds.get(stage, 0.0))


def _peers(results):
    rounds, rows, missing = results["rounds"], [], []
    for name, (task, program) in PROGRAMS.items():
        absent = [r[name]["missing"] for r in rounds if name in r and "missing" in r[name]]
        if absent:
            missing.append(f"{program} ({task}): {absent[0]}")
            continue
        found, ours = _measured(rounds, name), _measured(rounds, name.split("_")[0] + "_ours")
        if not found or not ours:
            continue
        agreed = results["meaning"].get(name)
        rows.append([task, program, *(_seconds(figures, key) for key in ("wall", "cpu") for figures in (ours, found)),
                     f"{100 * agreed['same']:.2f} %", f"{agreed['ours']:,} / {agreed['theirs']:,}"])
    if not rows and not missing:
        return ""
    text = ("## Beside other programs\n\nThe same points, the same rule, as many threads; the results are compared first. *Alike*: outliers, "
            "points that both keep or both leave out; clusters, points whose cluster holds the same points; image, cells of equal value within "
            "a fiftieth of the range. *Found*: points kept, clusters, cells filled, ours / theirs. Outliers and clusters run on one core, "
            "reading and writing left out; the image is plain inverse distance, from points in memory to a GeoTIFF: of gdal_grid's time that of "
            "filling a single cell, which is starting and reading the points, is taken off. Our "
            "clusters join points by cells of 4 cm, which a marking never tells and dense paint is quicker by; theirs link every pair of "
            "points. Where six points and more crowd in a cell an even share of them weighs on cells farther than the next in our image, in "
            "theirs all of them. In the chain, "
            "outliers are judged by windows and the image lets bright points count more.")
    if rows:
        text += "\n\n" + table(["task", "beside", "s, ours", "theirs", "CPU s, ours", "theirs", "alike", "found"], rows, words=2)
    return text + "".join(f"\n\nLeft out: {line}" for line in missing)


def _seconds(figures, key):
    return _spread([f[key] for f in figures]) if all(key in f for f in figures) else "–"


def _memory(rounds):
    rows = []
    for name, title in (("short", "200 m"), ("tiles", "2 km in tiles"), ("profiles", "200 m, dense")):
        found = _measured(rounds, name)
        if found:
            rows.append([title, f"{found[0]['points'] / 1e6:.1f}", f"{found[0]['length']:.0f}", _spread([f["peak"] for f in found], 0)])
    return rows and ("## Memory\n\nThe highest resident memory of the process, Python and its libraries included. Each store of points keeps up to "
                     "64 MiB in memory and puts the rest into a temporary file, so that a short street does not fill what a long one fills. "
                     "Of worker processes and their caller it is what all of them hold at one moment; pages of libraries, which they share, "
                     "count once.\n\n" + table(["street", "points (million)", "m", "peak (MiB)"], rows))


def _time(rounds):
    rows = []
    for name, title in RUNS.items():
        found = _measured(rounds, name)
        if found:
            longest = max((f["silence"] for f in found), key=lambda silence: silence[0])
            rows.append([title, _spread([100 * f["bar_off"] for f in found], 1), f"{longest[0]:.2f}", longest[1]])
    cancelled = [wait for figures in _measured(rounds, "cancel") for wait in figures["waits"]]
    told = ""
    if cancelled:
        longest = max(cancelled, key=lambda wait: wait[1])
        left = [name for figures in _measured(rounds, "cancel") for name in figures["left"]]
        told = (f"\n\nCancel was pressed in QGIS's *Road map* at {len(cancelled)} random moments of the dense survey, all outputs wanted: it was "
                f"over after {median(wait[1] for wait in cancelled):.2f} s (median), {longest[1]:.2f} s at most (“{longest[2]}”); files left "
                f"behind: {', '.join(left) or 'none'}.")
    if not rows:
        return told.strip() and "## What the user sees of the time" + told
    return ("## What the user sees of the time\n\nHow far the progress bar lies from the share of the time that has passed, at worst, in "
                     "per cent of the whole; and the longest time between two moments at which Cancel is asked for.\n\n"
                     + table(["road map", "bar off (%)", "longest (s)", "after the line"], rows, words=1) + told)


def _how(results):
    return ("## To run it\n\n`make bench` for everything (the surveys take some minutes the first time, about 1.5 GB in `build/bench`); "
            "`tools/bench.sh --quick` for a short form; `tools/bench.sh --parts outliers clusters --rounds 5` for some of it; "
            "`tools/bench.sh --help` names the rest. Open3D comes from PyPI into a virtual environment of its own, PCL from Debian's packages, "
            "unpacked and not installed, dask.distributed from PyPI into the environment of `make test-cluster`; what cannot be had is left out and "
            "said so.")
