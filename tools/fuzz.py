"""Feeds every reader broken files: fuzz.py [--seconds 60 | --runs 500] [--seed 0] [--keep FOLDER] [--only KIND]

Seconds are of the processor's, shared among the readers (fuzz_readers.py). Bytes of whole files are changed, cut, doubled and filled up;
where atheris is installed (`make fuzz` does that where it can be), what reaches code that no file had reached before is changed further,
and kept for the next time. A reader may accept a file or refuse it with one sentence (RoadExtractionError); anything else, a run of more
than ten seconds and memory beyond reason included, is printed once for each place in the code, with the file that caused it.
With --runs each reader is fed so many files at random, which are the same every time: no clock is looked at.
"""

import argparse
import json
import os
import random
import resource
import subprocess
import sys
import tempfile
import time
import traceback
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextlib import nullcontext
from pathlib import Path

import numpy as np
from fuzz_readers import TITLES, kinds
from plugin_package import load

try:
    import atheris
except ImportError:
    atheris = None

SLOW = 10.0            # s
MEMORY = 6 * 1024**3   # bytes
SENTENCE = (20, 1500)  # letters of a refusal
LONGEST = 1 << 17      # bytes of a file


def broken(content, rng):
    """One of the ways a file is damaged, or several."""
    data = bytearray(content)
    for _ in range(rng.integers(1, 4)):
        way = rng.integers(0, 9)
        if not data:
            break
        at = int(rng.integers(0, len(data)))
        if way == 0:
            for place in rng.integers(0, len(data), rng.integers(1, 20)):
                data[place] = int(rng.integers(0, 256))
        elif way == 1:  # in the header, where numbers say how long things are
            data[int(rng.integers(0, min(len(data), 400)))] = int(rng.choice([0, 1, 127, 128, 255]))
        elif way == 7:  # in the table of chunks and the records that come after the points
            data[len(data) - 1 - int(rng.integers(0, min(len(data), 300)))] = int(rng.choice([0, 1, 127, 128, 255]))
        elif way == 8:  # a length of four or eight bytes, beyond all measure or just beyond
            size = int(rng.choice([4, 8]))
            value = (0, 1, len(data), len(data) + 1, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1, 2**64 - 1)[rng.integers(0, 9)]
            at = int(rng.integers(0, min(len(data), 700)))
            data[at:at + size] = (value % 2**(8 * size)).to_bytes(size, "little")
        elif way == 2:
            del data[at:]
        elif way == 3:
            del data[at:at + int(rng.integers(1, 200))]
        elif way == 4:
            data[at:at] = data[at:at + int(rng.integers(1, 300))]
        elif way == 5:
            data[at:at] = bytes(rng.integers(0, 256, int(rng.integers(1, 100)), dtype=np.uint8))
        else:
            words = [b"nan", b"1e999", b"-", b"\0", b"inf", b",", b";", b"\n\n", b"'", b'"', b"9" * 400, "é".encode("latin-1")]
            data[at:at] = words[int(rng.integers(0, len(words)))]
    return bytes(data)


class Attempts:
    """Files tried with the reader of one kind, and the problems they caused.

    Parameters
    ----------
    title, kind : of `kinds`
    folder : for the file that is tried
    keep : folder for files that caused problems
    """

    def __init__(self, title, kind, folder, keep):
        from lanewright.core.common.errors import RoadExtractionError

        self.title, self.kind, self.refusal, self.keep = title, kind, RoadExtractionError, keep
        self.path = folder / kind.name
        self.tried = self.refused = 0
        self.problems = {}  # where in the code -> the file and what was said

    def one(self, content):
        """Let the reader read a file."""
        self.path.write_bytes(content)
        began, problem, place = time.process_time(), "", ""
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("error", RuntimeWarning)  # what numpy says of NaN is no sentence for a user
                self.kind.read(self.path)
        except self.refusal as error:
            self.refused += 1
            if not SENTENCE[0] < len(str(error)) < SENTENCE[1]:
                problem = place = f"message of {len(str(error))} letters: {str(error)[:200]}"
        except Exception as error:
            problem = traceback.format_exc()
            place = str([(frame.filename, frame.lineno) for frame in traceback.extract_tb(error.__traceback__)][-1:]) + type(error).__name__
        if time.process_time() - began > SLOW:
            problem, place = problem + f"\n{time.process_time() - began:.0f} s of the processor", place + " slow"
        self.tried += 1
        if problem and place not in self.problems:
            kept = self.keep / f"{self.title.replace(' ', '_')}_{len(self.problems)}_{self.kind.name}"
            kept.write_bytes(content)
            self.problems[place] = f"{kept}\n{problem}"
            print(self.problems[place], flush=True)

    def report(self):
        return {"tried": self.tried, "refused": self.refused, "problems": len(self.problems)}


def until(options):
    """A function that says of Attempts whether they are enough: by their number where that is given, or by the seconds from now on."""
    end = time.process_time() + options.seconds
    return lambda attempts: attempts.tried >= options.runs if options.runs else time.process_time() > end


def mutate_at_random(attempts, is_enough, rng):
    """Try files that are broken without looking where they get to."""
    while not is_enough(attempts):
        attempts.one(broken(attempts.kind.seeds[int(rng.integers(0, len(attempts.kind.seeds)))], rng))


def mutate_by_coverage(attempts, is_enough, rng, corpus, report):
    """Try files that libFuzzer breaks, with `broken` for one in three; does not return."""
    corpus.mkdir(parents=True, exist_ok=True)
    for number, content in enumerate(attempts.kind.seeds):
        (corpus / f"seed{number}").write_bytes(content)

    def one(content):
        attempts.one(content)
        if is_enough(attempts):
            report.write_text(json.dumps({attempts.title: attempts.report()}))
            sys.stdout.flush()
            os._exit(0)

    def changed(content, longest, seed):
        random.seed(seed)
        if random.random() < 1 / 3:
            return broken(content, np.random.default_rng(seed))[:longest]
        return atheris.Mutate(content, longest)

    atheris.Setup(["fuzz", str(corpus), f"-max_len={LONGEST}", f"-seed={int(rng.integers(1, 2**31))}", "-timeout=600", "-reload=0", "-rss_limit_mb=0",
                   "-verbosity=0", "-print_final_stats=0", f"-artifact_prefix={attempts.keep}/{attempts.title.replace(' ', '_')}_"],
                  one, custom_mutator=changed)
    atheris.Fuzz()


def fuzz(titles, options, folder):
    """Feed the readers of some kinds, in this process; their counts go into `options.report`. Led by coverage, it is one reader."""
    led, counts = atheris and not options.runs, {}
    with atheris.instrument_imports(include=["lanewright"]) if led else nullcontext():
        load()
        chosen = {title: kind for title, kind in kinds(folder).items() if title in titles}
        for kind in chosen.values():
            for content in kind.seeds:  # imports what is imported late, and proves the seeds whole
                (folder / kind.name).write_bytes(content)
                kind.read(folder / kind.name)
    quiet()
    for title, kind in chosen.items():
        attempts, rng = Attempts(title, kind, folder, options.keep), np.random.default_rng([options.seed, len(title)])
        if led:
            mutate_by_coverage(attempts, until(options), rng, options.corpus / title.replace(" ", "_"), options.report)
        mutate_at_random(attempts, until(options), rng)
        counts[title] = attempts.report()
        options.report.write_text(json.dumps(counts))


def quiet():
    """What GDAL and PROJ remark on broken files is not looked at."""
    from osgeo import gdal

    gdal.SetConfigOption("CPL_LOG", os.devnull)


def in_a_process_of_its_own(titles, options, seconds, report):
    """What `fuzz` counts by reader; a reader that takes its process with it is a problem too."""
    given = {"--only": ",".join(titles), "--seconds": seconds, "--runs": options.runs, "--seed": options.seed, "--keep": options.keep,
             "--corpus": options.corpus, "--report": report}
    code = subprocess.run([sys.executable, __file__, *(str(word) for pair in given.items() for word in pair)],
                          env={**os.environ, "PYTHONHASHSEED": "0"}, stderr=None if options.verbose else subprocess.DEVNULL).returncode
    counts = json.loads(report.read_text()) if report.exists() else {}
    if code:
        titled = next((title for title in titles if title not in counts), titles[-1])
        print(f"{titled}: the process ended with {code}; --verbose says why, and libFuzzer keeps the file in {options.keep}.")
        counts.pop(titled, None)
    return {title: counts.get(title, {"tried": 0, "refused": 0, "problems": 1}) for title in titles}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--runs", type=int, default=0, help="files for each reader, instead of seconds")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--keep", type=Path, default=Path("build/fuzz/found"))
    parser.add_argument("--corpus", type=Path, default=Path("build/fuzz/corpus"))
    parser.add_argument("--only", default=",".join(TITLES), help="some kinds of files, separated by commas")
    parser.add_argument("--report", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    options.keep.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        if options.report:
            resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
            return fuzz(options.only.split(","), options, Path(folder))
        titles, cores = [title for title in TITLES if title in options.only.split(",")], len(os.sched_getaffinity(0))
        print(f"{len(titles)} readers, {'at random' if options.runs or not atheris else 'led by coverage'}", flush=True)
        total = {"tried": 0, "refused": 0, "problems": 0}
        # a process that clocks or libFuzzer end has one reader; to start one takes longer than a hundred files
        together = [titles[k::cores] for k in range(min(cores, len(titles)))] if options.runs else [[title] for title in titles]
        with ThreadPoolExecutor(cores) as readers:
            counts = readers.map(lambda some: in_a_process_of_its_own(some, options, options.seconds / len(titles), Path(folder) / f"{some[0]}.json"),
                                 together)
            for title, done in (row for some in counts for row in some.items()):
                print(f"{title}: {done['tried']} files tried, {done['refused']} refused, {done['problems']} problems", flush=True)
                total = {name: count + done[name] for name, count in total.items()}
    print(f"{total['tried']} files tried, {total['refused']} refused, {total['problems']} problems")
    return total["problems"]


if __name__ == "__main__":
    sys.exit(bool(main()))
