"""Kills runs of qgis_process while they write layers: after each, every layer must be the one of before or the new one, whole.

    tools/kill_runs.py [--kills 20]    so many while layers get their names, and as many at any other time
"""

import argparse
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from contextlib import closing
from pathlib import Path

QGIS_PROCESS = Path(__file__).resolve().parent / "qgis_process"
TRAJECTORIES = {"short": 2000, "long": 3000}  # positions: how the layers of the two are distinguished
STEP = 0.0005                                 # s between looks at the folder
OTHERS = "another"                            # a table of the user's in the GeoPackage that a table is added to


def run(folder, trajectory, output):
    """The process of a run that writes a trajectory as a layer."""
    return subprocess.Popen([QGIS_PROCESS, "run", "lanewright:importtrajectory", f"--INPUT={folder / trajectory}.csv", "--INPUT_CRS=EPSG:32650",
                             f"--OUTPUT={output}"], cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                            start_new_session=True)


def is_writing(folder):
    return any(".unfinished" in name or name.endswith(("-journal", "-wal")) for name in os.listdir(folder))


def times(folder, output):
    """(seconds until an undisturbed run begins to write, seconds that it writes)."""
    process, began, first = run(folder, "short", output), time.monotonic(), None
    while process.poll() is None:
        if first is None and is_writing(folder):
            first = time.monotonic()
        time.sleep(STEP)
    if process.returncode or first is None:
        raise SystemExit(f"The run that nobody disturbs ended with {process.returncode}.")
    return first - began, time.monotonic() - first


def kill(process, folder, wait, writing):
    """Kill a run so many seconds after it began, or after it began to write."""
    while writing and process.poll() is None and not is_writing(folder):
        time.sleep(STEP)
    try:
        process.wait(wait)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def rows_of(path, table):
    """Rows of a table; raises sqlite3.Error where the database or the table is none."""
    with closing(sqlite3.connect(path)) as database:
        if database.execute("PRAGMA integrity_check").fetchone() != ("ok",):
            raise sqlite3.DatabaseError("not whole")
        (count,), = database.execute(f'SELECT count(*) FROM "{table}"')
        described = database.execute("SELECT count(*) FROM gpkg_geometry_columns WHERE table_name = ?", (table,)).fetchone()[0]
        if not described:
            raise sqlite3.DatabaseError(f"{table} is no layer")
    return count


def check(written, otherwise, folder, seed=1):
    """What was lost in so many kills while a file, and while a table of a GeoPackage, is written, and in so many before: sentences."""
    chance, lost = random.Random(seed), []
    for name, count in TRAJECTORIES.items():
        (folder / f"{name}.csv").write_text("time,x,y,z\n" + "".join(f"{k * 0.1:.1f},{500000 + k},4000000,10\n" for k in range(count)))
    outputs = {folder / "lines.gpkg": ("lines", f"{folder}/lines.gpkg"),
               folder / "map.gpkg": ("lines", f"ogr:dbname='{folder}/map.gpkg' table=\"lines\" (geom)")}
    before, writes = times(folder, f"{folder}/lines.gpkg")
    shutil.copy(folder / "lines.gpkg", folder / "map.gpkg")
    if run(folder, "long", f"ogr:dbname='{folder}/map.gpkg' table=\"{OTHERS}\" (geom)").wait():
        raise SystemExit("The table of the user's could not be made.")
    for path, (table, output) in outputs.items():
        for writing, kills in ((True, written), (False, otherwise)):
            for number in range((kills + 1) // 2):
                process = run(folder, ("long", "short")[number % 2], output)
                kill(process, folder, chance.uniform(0.0, writes if writing else before), writing)
                moment = f"{path.name}, kill {number + 1} {'while it is written' if writing else 'before'}"
                try:
                    if rows_of(path, table) not in TRAJECTORIES.values():
                        lost.append(f"{moment}: {rows_of(path, table)} rows")
                    if path.name == "map.gpkg" and rows_of(path, OTHERS) != TRAJECTORIES["long"]:
                        lost.append(f"{moment}: the table of the user's")
                except sqlite3.Error as error:
                    lost.append(f"{moment}: {error}")
    return lost


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kills", type=int, default=20)
    with tempfile.TemporaryDirectory() as scratch:
        kills = parser.parse_args().kills
        found = check(kills, kills, Path(scratch))
    print("\n".join(found) or "Nothing was lost.")
    sys.exit(bool(found))
