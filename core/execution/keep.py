"""Results that a later run may want, kept under the hash of what they depend on: in memory, or as files of a folder.

A result depends on a function, plain settings, its item, and what it reads. Resuming, another setting of a late stage and a correction are one case:
what is not kept is made, and so is a changed tile of a survey with what reads its points. Other code or versions of packages give other hashes.
"""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import RoadExtractionError
from ..common.progress import Progress, RememberedMessages
from .phase import THREADS, Executor, Items, NoSource, Phase, digest, is_sealed, name_of, read_plain, write_plain
from .tasks import code_digest, versions
from .weights import EXECUTION

POINTS = re.compile(r"points-[0-9a-f]{32}\.bin")   # sealed files that results name, in the same folder
OURS = re.compile(r"(kept|points|store)-[0-9a-f]{32}[.0-9a-z]*")   # files of a work folder, which may hold those of others


def work_folder(path: str) -> Path:
    """A folder of the user's for what is kept, which is made where it is missing. Raises RoadExtractionError if nothing can be written there."""
    folder = Path(path).absolute()
    try:
        folder.mkdir(exist_ok=True)
        trial = folder / f"{uuid4().hex}.part"
        trial.touch()
        trial.unlink()
    except OSError as error:
        raise work_folder_error(folder, error) from error
    return folder


def work_folder_error(folder: Path, error: OSError) -> RoadExtractionError:
    """One sentence about a folder that cannot be used."""
    return RoadExtractionError(f"The work folder {folder} cannot be used: {error.strerror or error}. Choose a folder that can be written to, with "
                               "room for about 150 bytes for every point near the road, or none; a folder that a power failure has damaged is to "
                               "be deleted.")


class Keep(Executor):
    """Executor that keeps the results of phases, and has another one do what is not kept.

    A few that are missing are computed by threads where no user named the folder: workers would have to be started again.

    work : folder of the user's; None for the folder of the executor, which goes with it, or for memory where it has none. There phases are kept
        whose items hold all that they need, or that say in which state they read the rest
    """

    def __init__(self, executor: Executor, work: Path | None = None):
        self.executor, self.work, self.folder = executor, work, work or executor.folder
        self._base: tuple[Any, ...] = code_digest(), versions(), ""   # what all hashes depend on: the last are the facts of the survey
        self._survey: Any = None   # what tells surveys apart, whatever their points
        self._results: dict[str, Any] = {}   # in memory
        self._whole: set[str] = set()   # files of points that were seen to be whole
        self._first = 0   # how many results there were after the first run
        # all but the work itself is that of the executor
        self.sees, self.forget, self.release, self.close = (  # type: ignore[method-assign]
            executor.sees, executor.forget, executor.release, executor.close)

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        return self.run_together(replace(phase, listed=0), items, progress)

    def run_together(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Any] = ()) -> Iterator[Any]:
        """As of `Executor`; each item is kept by itself, whatever others it comes with."""
        if self.folder is None and phase.state is None and not isinstance(phase.source, NoSource):
            yield from self.executor.run_together(phase, items, progress)
            return
        try:
            names = self._names(phase, items)
            kept = set(names) & self._results.keys() if self.folder is None else {name for name in names if self._path(name).exists()}
            missing = {name: k for k, name in enumerate(names) if name not in kept}
            made = self._made(phase, items, missing, len(names), progress)
            for k, name in enumerate(names):
                if name not in missing:
                    yield self._kept(name, phase, items[k])
                    continue
                del missing[name]   # a later item may be the same
                result = next(made)
                if self.folder is None:
                    self._results[name] = result
                yield result
        except OSError as error:
            raise self.disk_error(error) from error
        progress.report(1.0)

    def _made(self, phase, items, missing, count, progress):
        """The results of the items of a phase that are missing of `count`: {name: number of the item}."""
        rows = list(missing.values())
        if self.work is not None and len(rows) < count:
            progress.info(f"{count - len(rows)} of {count} parts of the work were finished by an earlier run.")
        files = [self._path(name) for name in missing] if self.folder else ()
        few = self.work is None and (2 * len(rows) < count or self._first and len(rows) <= EXECUTION.few_items)
        return (THREADS if few else self.executor).run_together(phase, Items(len(rows), lambda k: items[rows[k]]), progress, files)

    def _names(self, phase, items):
        """The hash of what each item depends on."""
        state = phase.state or (lambda item: None)
        source = phase.source.recipe(self.folder) if self.folder and phase.state is None else None   # names the folder, which may be moved
        shared = self._hash((name_of(phase.function), source, phase.arguments))
        return [digest((shared, item, state([item] if phase.listed else item))) for item in items]

    def _hash(self, value):
        return digest((self._base, value), str(self.work or ""))

    def _path(self, name):
        return self.folder / f"kept-{name}.plain"

    def _kept(self, name, phase, item):
        """A result that is kept; what cannot be read is made again."""
        if self.folder is None:
            return self._results[name]
        try:
            return self._read(name)
        except OSError:
            result, = THREADS.run_together(phase, [item], keep=[self._path(name)])
            return result

    def _read(self, name):
        """A result in a file, which has been used now, as have the files that it names; OSError where one is gone or not as it was written."""
        path, texts = self._path(name), []
        value = read_plain(path, texts.append)
        named = set(POINTS.findall(texts[0]))
        # only a folder that outlives the program may have seen the power fail
        self._whole.update(file for file in named - self._whole if (is_sealed if self.work else Path.exists)(self.folder / file))
        if not named <= self._whole:
            raise OSError("points are gone or damaged")
        for used in (path, *(self.folder / file for file in named)):
            with suppress(OSError):   # of another user
                os.utime(used)
        return value

    def stand_on(self, what: str, facts: dict[str, Any], progress: Progress) -> None:
        """As of `Executor`; where an earlier run of the survey had others, it is said which."""
        self._base = *self._base[:2], ""
        path, now = self._path(self._hash((what, self._survey))), {name: digest(value, str(self.work)) for name, value in facts.items()}
        before = {}
        with suppress(OSError):
            before = read_plain(path)
        if changed := [name for name in now if before.get(name) != now[name]]:
            write_plain(path, now)
        if before and changed:
            progress.info(f"This survey has changed since an earlier run, and with it {', '.join(changed)}. What depends on that is made anew.")
        self._base = *self._base[:2], digest(now)

    def made(self, files: Any, survey: Any, make: Callable[[Progress], Any], progress: Progress) -> Path:
        """The file of (a plain value that `make` gives, what was said while it was made), by the states of files and what else they depend on."""
        self._survey = survey
        path = self._path(name := self._hash((files, survey)))
        try:
            _, messages = self._read(name)
        except OSError:
            heard = RememberedMessages(progress)
            write_plain(path, (make(heard), heard.messages))
        else:
            progress.info("The points were read by an earlier run and are taken from the work folder. It said:")
            for kind, text in messages:
                (progress.warn if kind == "warn" else progress.info)(text)
            progress.report(1.0)
        self._trim()
        return path

    def _trim(self):
        """Remove what no run has used for a day, the oldest first, while the folder holds more than is free on its disk."""
        files = []
        for path in self.work.iterdir():
            with suppress(OSError):   # another run may have removed it
                files += [(path.stat().st_mtime, path.stat().st_size, path)] if OURS.fullmatch(path.name) else []
        excess = sum(size for _, size, _ in files) - shutil.disk_usage(self.work).free
        for used, size, path in sorted(files):
            if excess <= 0 or time.time() - used < EXECUTION.unused_time:
                return
            with suppress(OSError):   # of another user, or, on Windows, open in another program
                path.unlink(missing_ok=True)
                excess -= 2 * size

    @property
    def full(self) -> bool:
        """Whether so much is kept that the next run had better begin anew; asked after each run of a window."""
        count = len(self._results) if self.folder is None else sum(1 for _ in self.folder.glob("kept-*"))
        self._first = self._first or count
        return count > EXECUTION.runs_kept * self._first

    def disk_error(self, error: OSError) -> RoadExtractionError:
        return self.executor.disk_error(error) if self.work is None else work_folder_error(self.work, error)
