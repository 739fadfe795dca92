"""python -m ablation [--scenes NAME,NAME] [--surveys FOLDER] [--variants NAME,NAME] [--rules NAME,NAME] [--results FOLDER]: see the package."""

import argparse
import ast
import hashlib
import json
import subprocess
import sys
import time
from pathlib import Path

from accuracy.surveys import OTHERS, SAMPLES, make_samples, surveys_in

from . import ROOT
from .measure import ALL_VARIANTS, measure
from .page import changes, page, write_csv
from .switches import SWITCHES
from .weight import CORE

SILENT = "all that no survey felt"


def main():
    parser = argparse.ArgumentParser(prog="make ablation", description="What each rule brings: switched off in turn, over surveys with truth.")
    parser.add_argument("--scenes", default=",".join((*SAMPLES, *OTHERS)), metavar="NAME,NAME", help="sample scenes, “none” for none (default: all)")
    parser.add_argument("--surveys", type=Path, action="append", default=[], help="a survey or a folder of surveys, with truth")
    parser.add_argument("--variants", default=",".join(ALL_VARIANTS), metavar="NAME,NAME", help="how they are surveyed (default: all ways)")
    parser.add_argument("--rules", default="", metavar="NAME,NAME", help="names or groups of rules, or what they begin with (default: all)")
    parser.add_argument("--together", action="append", default=[], metavar="NAME,NAME",
                        help=f"rules that are switched off at once, or “unfelt”: {SILENT}")
    parser.add_argument("--results", type=Path, default=ROOT / "build" / "ablation", help="where results are kept (default: build/ablation)")
    parser.add_argument("--list", action="store_true", help="list scenes, variants and rules")
    parser.add_argument("--one", nargs=4, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.list:
        print("scenes: " + ", ".join((*SAMPLES, *OTHERS)), "variants: " + ", ".join(ALL_VARIANTS), "rules:", sep="\n")
        return print(*(f"  {switch.group}: {name}" for name, switch in SWITCHES.items()), sep="\n")
    if arguments.one:
        # a process of its own: memory is given back
        folder, variant, into, what = arguments.one
        wanted = json.loads(Path(what).read_text())
        return measure(folder, variant, {name: SWITCHES[name] for name in wanted["rules"]}, wanted["groups"], Path(into), wanted["code"])
    variants = _chosen(arguments.variants, ALL_VARIANTS, "variant")
    rules = [name for name, switch in SWITCHES.items()
             if not arguments.rules or any(one.startswith(part) for part in arguments.rules.split(",") for one in (name, switch.group))]
    if not rules:
        sys.exit(f"No rule is called {arguments.rules}; --list names them.")
    groups = {f"together: {names}": _chosen(names, SWITCHES, "rule") for names in arguments.together if names != "unfelt"}
    results = _measured(arguments.results, _surveys(arguments), variants, rules, groups)
    if "unfelt" in arguments.together:
        unfelt = [name for name in rules if not any(changes(known, name) for known in results.values())]
        groups[SILENT] = unfelt
        results = _measured(arguments.results, _surveys(arguments), variants, rules, groups)
    switches = {name: SWITCHES[name] for name in rules}
    write_csv(arguments.results / "ablation.csv", switches, groups, results)
    (arguments.results / "ablation.md").write_text(page(switches, groups, results), encoding="utf-8")
    print(f"{arguments.results / 'ablation.md'} and ablation.csv are written.")


def _chosen(names, known, what):
    found = [name for name in names.split(",") if name]
    unknown = sorted(set(found) - set(known))
    if unknown:
        sys.exit(f"There is no {what} {', '.join(unknown)}; --list names all.")
    return found


def _surveys(arguments):
    """Folders of the surveys, one after the other; a sample scene is made where it is not there yet."""
    scenes = [] if arguments.scenes == "none" else _chosen(arguments.scenes, {**SAMPLES, **OTHERS}, "scene")
    made, code = arguments.results / "surveys", _code(CORE.parent / "simulator")
    for name in scenes:
        made_by = made / name / "made_by.txt"
        if not made_by.exists() or made_by.read_text() != code:
            print(f"Making {name} …", flush=True)
            make_samples(made, [name])
            made_by.write_text(code)
        yield made / name
    for folder in arguments.surveys:
        yield from surveys_in(folder)


def _measured(folder, surveys, variants, rules, groups):
    """{(survey, variant): results}, of which what is missing is measured first."""
    began, code, found = time.monotonic(), _code(), {}
    what = folder / "wanted.json"
    folder.mkdir(parents=True, exist_ok=True)
    what.write_text(json.dumps(dict(rules=rules, groups=groups, code=code)))
    for survey in surveys:
        for variant in variants:
            into = folder / survey.name / f"{variant}.json"
            subprocess.run([sys.executable, "-m", "ablation", "--one", survey, variant, into, what], check=True)
            found[survey.name, variant] = json.loads(into.read_text())
            print(f"{time.monotonic() - began:6.0f} s  {survey.name}, {variant}", flush=True)
    return found


def _code(folder=CORE):
    """A digest of the core, or a part of it, that comments do not change: what another core gave is made anew."""
    digest = hashlib.sha256()
    for path in sorted(folder.rglob("*.py")):
        digest.update(ast.dump(ast.parse(path.read_text(encoding="utf-8"))).encode())
    return digest.hexdigest()[:16]


if __name__ == "__main__":
    main()
