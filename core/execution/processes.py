"""Phases run by worker processes of this computer: subprocesses that share points and results with the caller in a folder."""

from __future__ import annotations

import json
import queue
import shutil
import subprocess  # nosec B404
import tempfile
import threading
import weakref
from collections.abc import Iterator, Sequence
from itertools import count
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from ..common.parallel import POLL_INTERVAL, check_cancelled, ordered_map
from ..common.progress import Progress
from .phase import Executor, Phase, name_of, read_plain, write_plain
from .tasks import ShippedPhase, command_of, environment, import_folders, items_together, no_window, raise_answer
from .weights import EXECUTION


class WorkerProcesses(Executor):
    """Executor that uses worker processes.

    Workers are started when they are first needed and kept until `close`. What a phase reads from is put into a folder, once;
    each result is written there by its worker under a temporary name, renamed, and read and removed by the caller.

    interpreter : path of a Python interpreter that `find_interpreter` tried
    workers : number of processes
    """

    def __init__(self, interpreter: str, workers: int):
        self.interpreter, self.workers = interpreter, workers
        self.folder: Path = Path(tempfile.mkdtemp(prefix="lanewright-"))
        # where nobody closes it; workers end by themselves when their input does
        self._left = weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        self._idle: queue.SimpleQueue[_Worker] = queue.SimpleQueue()
        self._all: set[_Worker] = set()
        self._lock = threading.Lock()
        self._numbers = count()

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        """Yield the results of all items in their order; see `Executor`. Nothing is kept by it.

        Raises RoadExtractionError of the phase; or if a worker process ended `trials` times at one item, ran out of memory, or the folder is full.
        """
        items = list(items)
        shipped = f"phase{next(self._numbers)}.plain"
        try:
            write_plain(self.folder / shipped, ShippedPhase(name_of(phase.function), phase.source.recipe(self.folder), tuple(phase.arguments)))
        except OSError as error:
            raise self.disk_error(error) from error
        count = items_together(phase, len(items), self.workers)
        batches = [items[k:k + count] for k in range(0, len(items), count)]
        for results in ordered_map(lambda few: [self._result(phase, shipped, item) for item in few], batches, progress, self.workers):
            yield from results
        (self.folder / shipped).unlink(missing_ok=True)

    def _result(self, phase, shipped, item):
        """The result of one item, from whichever worker is free."""
        number = next(self._numbers)
        task = dict(phase=shipped, item=f"item{number}.plain", result=f"result{number}.plain")
        try:
            write_plain(self.folder / task["item"], item)
            self._ask(phase, item, task)
            return read_plain(self.folder / task["result"])
        except OSError as error:
            raise self.disk_error(error) from error
        finally:
            for name in ("item", "result"):
                (self.folder / task[name]).unlink(missing_ok=True)

    def _ask(self, phase, item, task):
        """Have a task done; raises what went wrong."""
        last = ""
        for _ in range(EXECUTION.trials):
            worker = self._take()
            try:
                answer = worker.answer_to(task)
            except BaseException:
                # of no use any more: it works on what nobody waits for
                self._drop(worker)
                raise
            if answer is None:
                last = worker.last_words()
                self._drop(worker)
                continue
            self._idle.put(worker)
            raise_answer(answer, phase, item, "A worker process")
            return
        raise RoadExtractionError(
            f"Worker processes ended {EXECUTION.trials} times while they worked on {phase.place(item)}; usually the computer is out of memory. "
            f"Try fewer workers, or 0 for the automatic choice. {last}".rstrip())

    def disk_error(self, error: OSError) -> RoadExtractionError:
        return RoadExtractionError(f"Worker processes cannot use the disk: {error}. Free some space there, or run without worker processes; "
                                   "the variable TMPDIR (Windows: TEMP) names the folder for temporary files.")

    def _take(self):
        """A worker without a task."""
        try:
            return self._idle.get_nowait()
        except queue.Empty:
            worker = _Worker(self.interpreter, self.folder)
            with self._lock:
                self._all.add(worker)
            return worker

    def _drop(self, worker):
        worker.kill()
        with self._lock:
            self._all.discard(worker)

    def forget(self) -> None:
        # that is quicker than to start new ones
        for worker in self._all:
            worker.forget()

    def release(self) -> None:
        self._idle = queue.SimpleQueue()
        ending, self._all = self._all, set()
        for worker in ending:
            worker.leave()
        for worker in ending:
            worker.end()

    def close(self) -> None:
        self.release()
        self._left.detach()
        shutil.rmtree(self.folder, ignore_errors=True)


class _Worker:
    """One process; used by one thread at a time."""

    def __init__(self, interpreter, folder):
        self._words = tempfile.TemporaryFile(prefix="lanewright-")
        self._process = subprocess.Popen(  # nosec B603
            command_of(interpreter, str(folder)), env=environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._words,
            text=True, encoding="utf-8", creationflags=no_window())
        self._answers: queue.SimpleQueue[str] = queue.SimpleQueue()
        threading.Thread(target=self._listen, daemon=True).start()
        self._say(json.dumps(import_folders()))

    def _listen(self):
        """Hand on the answers; "" after the last one."""
        for line in self._process.stdout:
            self._answers.put(line)
        self._answers.put("")

    def _say(self, line):
        try:
            self._process.stdin.write(f"{line}\n")
            self._process.stdin.flush()
        except OSError:
            pass   # it has ended, which its missing answer tells

    def answer_to(self, task):
        """What the worker answers to a task; None if it ended instead. Asks meanwhile whether the user cancelled."""
        self._say(json.dumps(task))
        while True:
            check_cancelled()
            try:
                line = self._answers.get(timeout=POLL_INTERVAL)
            except queue.Empty:
                continue
            return json.loads(line) if line.endswith("\n") else None

    def forget(self):
        """Have it free what it keeps open, before its next task; it gives no answer."""
        self._say(json.dumps(dict(forget=True)))

    def last_words(self):
        """The end of what the worker wrote about itself, and how it ended."""
        code = self._process.wait(EXECUTION.end_time)
        self._words.seek(0)
        words = self._words.read().decode(errors="replace").strip()[-EXECUTION.last_words:]
        return f"The last one ended with code {code}" + (f": {words}" if words else ".")

    def kill(self):
        self._process.kill()
        self._finish()

    def leave(self):
        """Have the process end by itself; nobody waits for it yet."""
        self._say(json.dumps(dict(end=True)))

    def end(self):
        """Wait for a process that was told to end."""
        try:
            self._process.wait(EXECUTION.end_time)
        except subprocess.TimeoutExpired:
            self._process.kill()
        self._finish()

    def _finish(self):
        self._process.wait()
        for file in (self._process.stdin, self._process.stdout, self._words):
            try:
                file.close()
            except OSError:
                pass
