"""Phases run by worker processes of this computer: subprocesses that share points and results with the caller in a folder."""

from __future__ import annotations

import json
import queue
import subprocess  # nosec B404
import tempfile
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from .folder_executor import FolderExecutor, KilledWorker
from .tasks import command_of, environment, import_folders, no_window
from .weights import EXECUTION


class WorkerProcesses(FolderExecutor):
    """Executor that uses worker processes, which are started when they are first needed and kept until `close`.

    interpreter : path of a Python interpreter that `find_interpreter` tried
    workers : number of processes
    work : as of FolderExecutor
    """

    worker = "A worker process"

    def __init__(self, interpreter: str, workers: int, work: Path | None = None):
        super().__init__(work, workers, 1)
        self.interpreter = interpreter
        self._idle: queue.SimpleQueue[_Worker] = queue.SimpleQueue()
        self._all: set[_Worker] = set()

    def new_pool(self) -> ThreadPoolExecutor:
        """Threads, each of which has one worker at work."""
        return ThreadPoolExecutor(self.workers)

    def task(self) -> Callable[..., Any]:
        return self._ask

    def _ask(self, phase, *task):
        """What a free worker answers to a task of a phase; KilledWorker where several ended instead, or the phase has ended."""
        last = ""
        for _ in range(EXECUTION.trials):
            try:
                worker = self._idle.get_nowait()
            except queue.Empty:
                worker = _Worker(self.interpreter, self.folder)
                self._all.add(worker)
            worker.phase = phase
            # who ends a phase removes its file, then kills its workers
            answer = worker.answer_to([phase, *task]) if Path(phase).exists() else None
            if answer is not None:
                worker.phase = ""
                self._idle.put(worker)
                return answer
            self._all.discard(worker)
            last = worker.kill()
            if not Path(phase).exists():
                break
        raise KilledWorker(last)

    def end_pool(self, pool: ThreadPoolExecutor, phase: Path) -> None:
        pool.shutdown(wait=False, cancel_futures=True)
        for worker in list(self._all):
            if worker.phase == str(phase):
                worker.process.kill()
        pool.shutdown()

    def ended(self, place: str, last_words: str) -> RoadExtractionError:
        return RoadExtractionError(f"Worker processes ended or ran out of memory while they worked on {place}; usually the computer is out of "
                                   f"memory. Try fewer workers, or 0 for the automatic choice. {last_words}".rstrip())

    def disk_error(self, error: OSError) -> RoadExtractionError:
        return RoadExtractionError(f"Worker processes cannot use the disk: {error}. Free some space there, or run without worker processes; "
                                   "the variable TMPDIR (Windows: TEMP) names the folder for temporary files.")

    def forget(self) -> None:
        # that is quicker than to start new ones
        for worker in self._all:
            worker.say("forget")

    def release(self) -> None:
        self._idle = queue.SimpleQueue()
        ending, self._all = self._all, set()
        for worker in ending:
            if worker.phase:   # whose results nobody waits for any more
                Path(worker.phase).unlink(missing_ok=True)
                worker.process.kill()
            worker.say("end")
        for worker in ending:
            worker.end()

    def close(self) -> None:
        self.release()
        super().close()


class _Worker:
    """One process; used by one thread at a time. phase : file of the phase that it works on; "" where it waits"""

    def __init__(self, interpreter, folder):
        self.phase, self._words = "", tempfile.TemporaryFile(prefix="lanewright-")
        self.process = subprocess.Popen(  # nosec B603
            command_of(interpreter, str(folder)), env=environment(), stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self._words,
            text=True, encoding="utf-8", creationflags=no_window())
        self.say(import_folders())

    def say(self, value):
        """Give it a task, or have it "forget" what it keeps open or "end", of which it says nothing."""
        try:
            self.process.stdin.write(f"{json.dumps(value)}\n")
            self.process.stdin.flush()
        except OSError:
            pass   # it has ended, which its missing answer tells

    def answer_to(self, task):
        """What the worker answers to a task; None if it ended instead."""
        self.say(task)
        line = self.process.stdout.readline()
        return json.loads(line) if line.endswith("\n") else None

    def kill(self):
        """End the process, unless it has ended; the end of what it wrote about itself, and how it ended."""
        self.process.kill()
        code = self.process.wait()
        self._words.seek(0)
        words = self._words.read().decode(errors="replace").strip()[-EXECUTION.last_words:]
        for file in (self.process.stdin, self.process.stdout, self._words):
            try:
                file.close()
            except OSError:
                pass
        return f"The last one ended with code {code}" + (f": {words}" if words else ".")

    def end(self):
        """Wait for a process that was told to end."""
        try:
            self.process.wait(EXECUTION.end_time)
        except subprocess.TimeoutExpired:
            pass
        self.kill()
