"""docs/benchmarks.md: one page that quotes the table of results beside it."""

from pathlib import Path
from string import Template

from results_table import markdown, number

QUIET = 0.15   # processor cores busy with other work, on average, beyond which figures are not to be trusted
PAGE = Template((Path(__file__).parent / "page.md").read_text(encoding="utf-8"))


def page(results, csv="benchmarks.csv"):
    """The page of a table of results; `csv` names the file beside it that holds the table."""
    about = {figure: results.get("run", "", "", figure) for figure in results.names("run", "figure")}
    return PAGE.substitute(
        warnings="".join(f"**{text}**\n\n" for text in _warnings(about)), missed=_goals(results, lambda reached: reached == "no"),
        others=_goals(results, lambda reached: reached != "no"), csv=f"[{csv}]({csv})", machine=_machine(about), peers=_peers(results),
        rounds={1: "once", 2: "twice"}.get(int(about["rounds"]), f"{about['rounds']:.0f} times"),
        user="\n".join(f"- {line}" for line in _user(results)))


def _warnings(about):
    if about["size"] != "full":
        yield "A short form, on small surveys, to see whether all works: these figures are not to be quoted."
    if about["busy cores"] > QUIET:
        yield f"The machine was not quiet: {about['busy cores']:.1f} cores were busy with other work. Times are no more than a sign that all runs."


def _machine(about):
    return (f"{about['processor']}, {about['cores']:.0f} of {about['of']:.0f} cores for ours and theirs alike, {about['memory_gib']:.0f} GiB, "
            f"{about['system']}; Python {about['python']}, numpy {about['numpy']}, scipy {about['scipy']}, laspy {about['laspy']} with lazrs "
            f"{about['lazrs']}. The run took {about['minutes']:.0f} minutes; other work kept {about['busy cores']:.2f} cores busy.")


def _goals(results, chosen):
    """The rows of the goals whose word about being reached is wanted."""
    rows = []
    for _, text, unit in dict.fromkeys(key[:3] for key in results.values if key[0] == "goals"):
        goal, least, middle, reached = (results.get("goals", text, unit, figure) for figure in ("goal", "least wanted", "median", "reached"))
        if chosen(reached):
            must = "" if goal is None else f"{'≥' if least == 'yes' else '≤'} {goal:g}"
            rows.append([text, unit, must, "not measured" if middle is None else _spread(results, "goals", text, unit)])
    return markdown(["what", "given in", "goal", "is"], rows, words=2) if rows else "Nothing."


def _spread(results, *key, digits=2):
    """median (least–most)"""
    middle, least, most = (number(results.get(*key, figure), digits) for figure in ("median", "least", "most"))
    return middle if least == most else f"{middle} ({least}–{most})"


def _peers(results):
    rows, missing = [], []
    for _, task, program in dict.fromkeys(key[:3] for key in results.values if key[0] == "peers"):
        found = {figure: results.get("peers", task, program, figure) for figure in results.names("peers", "figure")}
        if found.get("missing"):
            missing.append(f"\n\nLeft out: {program} ({task}): {found['missing']}")
            continue
        seconds = [number(found.get(f"{who}, {key} s"), 2) for key in ("wall", "cpu") for who in ("ours", "theirs")]
        rows.append([task, program, *seconds, f"{found['alike, %']:.2f} %", f"{found['ours, found']:,.0f} / {found['theirs, found']:,.0f}"])
    head = ["task", "beside", "s, ours", "theirs", "CPU s, ours", "theirs", "alike", "found, ours / theirs"]
    return (markdown(head, rows, words=2) if rows else "Not measured.") + "".join(missing)


def _user(results):
    for run in results.names("runs")[:-1]:
        peak, points, metres, off = (_spread(results, "runs", run, text, digits=digits) for text, digits in (
            ("peak MiB", 0), ("million points", 1), ("m", 0), ("bar off, %", 0)))
        longest, line = (results.get("runs", run, "longest s without asking for Cancel", figure) for figure in ("most", "after the line"))
        asked = ("" if longest is None else
                 f"; the bar is {off} % off at most, and Cancel is heard within {longest:.2f} s (the longest is “{line}”)")
        yield f"*{run}*: {points} million points on {metres} m take {peak} MiB{asked}."
    if results.names("cancel"):
        moments, middle, most, line, left = (results.get("cancel", "", "", figure) for figure in (
            "moments", "median s", "most s", "after the line", "files left"))
        yield (f"Cancel was pressed at {moments:.0f} random moments of the dense survey: it was over after {middle:.2f} s (median), "
               f"{most:.2f} s at most (“{line}”); files left behind: {left}.")
