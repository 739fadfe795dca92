"""Where more workers stop gaining: task times of a run, and how so many workers would have shared them out.

    tools/scale.py measure TIMES.json FOLDER       runs the road map of a survey, a folder of clouds and trajectory.csv, and writes task times
    tools/scale.py model TIMES.json [--copies 10]  replays them for 1 to 256 workers

Times are seconds of the processor's (not of the clock), so that a busy computer changes them little.

The model is list scheduling: within a phase the next task goes to the worker that is free first, phases follow each other, and between them
the caller works alone. `copies` repeats the tasks of each phase for a longer road, and as often what the caller does after the first phase.
"""

import argparse
import heapq
import json
import tempfile
import time
from pathlib import Path

from plugin_package import load

load()

from lanewright.core.execution.folder_executor import items_together  # noqa: E402
from lanewright.core.execution.phase import Executor, name_of, read_plain, write_plain  # noqa: E402
from lanewright.core.pipeline.road_map import RoadMapSettings, make_road_map  # noqa: E402
from lanewright.core.survey import open_survey  # noqa: E402
from lanewright.core.survey.trajectory.reader import read_trajectory  # noqa: E402

WORKERS = (1, 2, 4, 8, 15, 16, 32, 64, 256)
SHARED_BY = 15   # workers for which items are put together into files


class Recorder(Executor):
    """Executor that does one task after the other in this thread, all through files as for workers, and notes seconds and bytes."""

    def __init__(self, folder):
        self.folder, self.phases, self.open, self.began = Path(folder), [], {}, time.process_time()

    def run(self, phase, items, progress=None, keep=()):
        recipe, path = phase.source.recipe(self.folder), self.folder / "value.plain"
        names = list(getattr(phase.source, "phases", [name_of(phase.function)]))
        noted = dict(name=" and ".join(name.partition(":")[2] for name in names), seconds=[], caller=time.process_time() - self.began,
                     sent=self._size((recipe, tuple(phase.arguments))), results=[])
        self.phases.append(noted)
        source = recipe.open(self.open)
        together = items_together(phase, len(items), SHARED_BY)
        for first in range(0, len(items), together):
            # a worker is given a file of some items, and writes a file for each of their results
            write_plain(path, [items[number] for number in range(first, min(first + together, len(items)))])
            noted["caller"] += time.process_time() - self.began if first else 0.0
            self.began, results = time.process_time(), []
            task = read_plain(path)
            path.unlink()   # to write over a file takes longer than to write one
            for item in task:
                results.append(self.folder / f"result{len(results)}.plain")
                write_plain(results[-1], phase.function(source, item, *phase.arguments))
                began, self.began = self.began, time.process_time()
                noted["seconds"].append(self.began - began)
                noted["results"].append(results[-1].stat().st_size)
            for result in results:
                yield read_plain(result)
                result.unlink()

    def _size(self, value):
        """Bytes of a value in a file."""
        write_plain(self.folder / "value.plain", value)
        return (self.folder / "value.plain").stat().st_size

    def forget(self):
        self.open.clear()


def measure(arguments):
    """Run the road map with a Recorder and write what it noted."""
    with tempfile.TemporaryDirectory() as folder:
        recorder = Recorder(folder)
        open_survey.executor_for = lambda *_: recorder
        clouds = sorted(path for path in arguments.survey.iterdir() if path.suffix.lower() in (".las", ".laz"))
        result = make_road_map(clouds, read_trajectory(arguments.survey / "trajectory.csv"), None, RoadMapSettings())
        after = time.process_time() - recorder.began
        result.road_points.close()
    noted = dict(length=sum(road.length for road in result.frame.roads), points=result.survey_facts["read"], after=after, phases=recorder.phases)
    arguments.times.write_text(json.dumps(noted))
    print("| phase | tasks | s: all | longest | the caller alone (s) | sent once (kB) | results (kB) |\n|---|---:|---:|---:|---:|---:|---:|")
    for phase in recorder.phases:
        seconds, sent, results = phase["seconds"], phase["sent"] / 1e3, sum(phase["results"]) / 1e3
        print(f"| {phase['name']} | {len(seconds)} | {sum(seconds):.2f} | {max(seconds, default=0.0):.2f} | {phase['caller']:.2f} | {sent:.0f} "
              f"| {results:.0f} |")


def span_of(seconds, workers, overhead, serial):
    """s that a phase takes whose tasks take so many `seconds`; each costs its worker the `overhead` beside, and the one caller `serial` s."""
    free, sent = [0.0] * min(workers, len(seconds)), 0.0
    for one in seconds:
        sent += serial
        heapq.heappush(free, max(heapq.heappop(free), sent) + overhead + one)
    return max(free, default=0.0)


def model(arguments):
    """Print a table of run times by number of workers."""
    noted, copies = json.loads(arguments.times.read_text()), arguments.copies
    first, *others = (phase["caller"] for phase in noted["phases"])
    alone = first + copies * (sum(others) + noted["after"])
    print(f"{noted['points'] * copies / 1e6:.0f} million points on {noted['length'] * copies / 1e3:.1f} km, the caller alone {alone:.1f} s\n")
    print("| workers | phases (s) | gain | whole run (s) | gain |\n|---:|---:|---:|---:|---:|")
    spans = [sum(span_of(phase["seconds"] * copies, workers, arguments.overhead, arguments.serial) for phase in noted["phases"])
             for workers in WORKERS]
    for workers, span in zip(WORKERS, spans):
        print(f"| {workers} | {span:.1f} | {spans[0] / span:.1f} | {span + alone:.1f} | {(spans[0] + alone) / (span + alone):.2f} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    measuring, modelling = commands.add_parser("measure"), commands.add_parser("model")
    for command, function in ((measuring, measure), (modelling, model)):
        command.add_argument("times", type=Path)
        command.set_defaults(function=function)
    measuring.add_argument("survey", type=Path)
    modelling.add_argument("--copies", type=int, default=1, help="how often the road is repeated")
    modelling.add_argument("--overhead", type=float, default=0.002, help="s that a task costs its worker beside its own time")
    modelling.add_argument("--serial", type=float, default=0.001, help="s that a task costs the caller")
    arguments = parser.parse_args()
    arguments.function(arguments)


if __name__ == "__main__":
    main()
