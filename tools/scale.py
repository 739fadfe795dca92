"""Where more workers stop gaining: task times of a run, and how so many workers would have shared them out.

    tools/scale.py measure TIMES.json [--length 500] [--pulse-rate 120000]    runs the road map of a simulated street and writes task times
    tools/scale.py model TIMES.json [--copies 80] [--overhead 0.01]           replays them for 1 to 256 workers

Times are seconds of the processor's (not of the clock), so that a busy computer changes them little. Each task opens its source anew, as a
worker does to which neighbouring sections were not given: what neighbours share is computed by both.

The model is list scheduling: within a phase the largest task goes to the worker that is free first, phases follow each other, and
between them the caller works alone. `copies` repeats the tasks of each phase for a longer road, and the caller's own work as often.
"""

import argparse
import heapq
import json
import os
import platform
import tempfile
import time
from pathlib import Path

from plugin_package import load

load()

from lanewright.core.execution.phase import Executor, name_of, write_plain  # noqa: E402
from lanewright.core.pipeline import road_map as pipeline  # noqa: E402
from lanewright.core.pipeline.road_map import Stages  # noqa: E402
from lanewright.core.survey import open_survey  # noqa: E402
from lanewright.simulator.survey import SampleSettings, make_sample_survey  # noqa: E402

WORKERS = (1, 2, 4, 8, 16, 32, 64, 128, 256)


class Recorder(Executor):
    """Executor that does one task after the other in this thread, and notes seconds and bytes."""

    def __init__(self, folder):
        self.folder, self.phases, self.inside = Path(folder), [], 0.0

    def run(self, phase, items, progress=None, keep=()):
        recipe = phase.source.recipe(self.folder)
        began = time.process_time()
        found = dict(name=phase.function.__name__, seconds=[], opening=0.0, results=[],
                     sent=self.size((name_of(phase.function), recipe, tuple(phase.arguments))))
        self.phases.append(found)
        self.inside += time.process_time() - began
        for item in items:
            began = time.process_time()
            source = recipe.open({})
            opened = time.process_time()
            result = phase.function(source, item, *phase.arguments)
            done = time.process_time()
            found["opening"] += (opened - began) / len(items)
            found["seconds"].append(done - opened)
            found["results"].append(self.size(result))
            if hasattr(source, "close"):
                source.close()
            self.inside += time.process_time() - began
            yield result

    def size(self, value):
        """Bytes of a value in a file."""
        path = self.folder / "value.plain"
        write_plain(path, value)
        return path.stat().st_size


def measure(arguments):
    """Run the road map with a Recorder and write what it noted."""
    seconds, folder = {}, tempfile.TemporaryDirectory()
    recorder = Recorder(folder.name)

    def run(self, name, title, function, *others, **named):
        began, before = time.process_time(), recorder.inside
        result = self.own_run(name, title, function, *others, **named)
        seconds[name] = time.process_time() - began - (recorder.inside - before)
        return result

    Stages.own_run, Stages.run = Stages.run, run
    open_survey.executor_for = lambda *_: recorder
    sample = make_sample_survey(SampleSettings(length=arguments.length, pulse_rate=arguments.pulse_rate))
    cloud = Path(folder.name) / "survey.laz"
    sample.write_cloud(cloud)
    result = pipeline.make_road_map([cloud], sample.trajectory, Path(folder.name) / "image.tif")
    points = Path(folder.name) / "survey"
    stored = sum(file.stat().st_size for file in points.iterdir())
    found = dict(machine=f"{platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}", load=os.getloadavg(),
                 length=arguments.length, points=result.survey_facts["kept"], stored=stored, caller=seconds, phases=recorder.phases)
    result.road_points.close()
    Path(arguments.times).write_text(json.dumps(found))
    for phase in recorder.phases:
        print(f"{phase['name']}: {len(phase['seconds'])} tasks, {sum(phase['seconds']):.1f} s, longest {max(phase['seconds']):.2f} s, "
              f"opening {phase['opening']:.3f} s, sent {phase['sent'] / 1e3:.0f} kB, results {sum(phase['results']) / 1e3:.0f} kB")
    print("caller:", {name: round(value, 2) for name, value in seconds.items()})


def span_of(seconds, workers, overhead, opening, serial):
    """s that a phase takes.

    seconds : of the tasks; workers : how many; overhead : s that each task costs its worker beside them
    opening : s that every worker takes once; serial : s that each task costs the one scheduler
    """
    free = [opening] * min(workers, len(seconds))
    heapq.heapify(free)
    sent = 0.0
    for one in sorted(seconds, reverse=True):
        sent += serial
        heapq.heappush(free, max(heapq.heappop(free), sent) + overhead + one)
    return max(free)


def model(arguments):
    """Print a table of run times by number of workers."""
    found = json.loads(Path(arguments.times).read_text())
    copies, rows = arguments.copies, []
    alone = sum(found["caller"].values()) * copies
    for workers in WORKERS:
        spans = [span_of(phase["seconds"] * copies, workers, arguments.overhead, phase["opening"], arguments.serial) for phase in found["phases"]]
        rows.append((workers, *spans, sum(spans), sum(spans) + alone))
    names = [phase["name"] for phase in found["phases"]]
    print(f"{found['points'] * copies / 1e6:.0f} million points on {found['length'] * copies / 1e3:.1f} km; {found['machine']}; "
          f"tasks {[len(phase['seconds']) * copies for phase in found['phases']]}; caller alone {alone:.0f} s")
    print("| workers | " + " | ".join(f"{name} (s)" for name in names) + " | phases (s) | gain | per worker | whole run (s) | gain |")
    print("| ---: " * (len(names) + 6) + "|")
    for workers, *spans, phases, whole in rows:
        gain = rows[0][-2] / phases
        print(f"| {workers} | " + " | ".join(f"{span:.1f}" for span in spans)
              + f" | {phases:.1f} | {gain:.1f} | {gain / workers:.2f} | {whole:.0f} | {rows[0][-1] / whole:.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, modelling = commands.add_parser("measure"), commands.add_parser("model")
    for command, function in ((measuring, measure), (modelling, model)):
        command.add_argument("times")
        command.set_defaults(function=function)
    measuring.add_argument("--length", type=float, default=500.0, help="m of street")
    measuring.add_argument("--pulse-rate", type=float, default=120_000.0, help="pulses per second and scanner")
    modelling.add_argument("--copies", type=int, default=80, help="how often the road is repeated")
    modelling.add_argument("--overhead", type=float, default=0.01, help="s that a task costs its worker beside its own time")
    modelling.add_argument("--serial", type=float, default=0.005, help="s that a task costs caller and scheduler, one after the other")
    arguments = parser.parse_args()
    arguments.function(arguments)


if __name__ == "__main__":
    main()
