"""What is finished, kept in a folder of the user's, so that a run that ended early goes on where it was.

Everything in the folder is named by a digest of what it was made from: files, trajectory, settings and the code itself. What was made
from anything else has another name and is never used.
"""

from __future__ import annotations

import hashlib
import json
import os
import shutil
from collections.abc import Iterator, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any
from uuid import uuid4

from ..common.errors import RoadExtractionError
from ..common.progress import Progress
from .phase import Executor, Phase, checksum, digest, is_whole, name_of, read_plain, write_plain
from .weights import EXECUTION


class WorkFolder:
    """A folder for finished work, which is made where it is missing.

    Raises RoadExtractionError if nothing can be written there.
    """

    def __init__(self, path: str):
        self.path = Path(path).absolute()
        try:
            self.path.mkdir(exist_ok=True)
            trial = self.path / f"{uuid4().hex}.part"
            trial.touch()
            trial.unlink()
        except OSError as error:
            raise self.error(error) from error

    def error(self, error: OSError) -> RoadExtractionError:
        """One sentence about a folder that cannot be used."""
        return RoadExtractionError(f"The work folder {self.path} cannot be used: {error.strerror or error}. Choose a folder that can be "
                                   "written to, with room for about 40 bytes for every point near the road, or none; a folder that a power "
                                   "failure has damaged is to be deleted.")

    def begin(self, name: str) -> Path:
        """A new folder, not made yet, for something that will be known as `name` when it is finished."""
        return self.path / f"{name}-{uuid4().hex[:8]}"

    def finish(self, name: str, folder: Path, messages: Sequence[tuple[str, str]]) -> None:
        """Keep a folder of `begin`, and what was said while it was made: ("info" or "warn", text)."""
        unfinished = self.path / f"{name}.{uuid4().hex}.part"
        unfinished.write_text(json.dumps(dict(folder=folder.name, messages=list(messages), files=_checksums(folder))), encoding="utf-8")
        os.replace(unfinished, self.path / f"{name}.json")

    def discard(self) -> None:
        """Remove this folder, at once for others, and what is in it."""
        renamed = self.path.with_name(f"{self.path.name}.{uuid4().hex}.part")
        try:
            os.replace(self.path, renamed)
        except OSError:
            return   # Windows, while somebody reads in it: it stays
        shutil.rmtree(renamed, ignore_errors=True)

    def finished(self, name: str) -> tuple[Path, list[tuple[str, str]]] | None:
        """The folder and the messages that were kept under a name; None where there are none, or not all as they were written."""
        note = self.path / f"{name}.json"
        try:
            if note.stat().st_size > EXECUTION.longest_note:
                return None
            content = json.loads(note.read_bytes())
            folder, messages = content["folder"], [(str(kind), str(text)) for kind, text in content["messages"]]
            whole = Path(folder).name == folder and _checksums(self.path / folder) == content["files"]
        except (OSError, ValueError, LookupError, TypeError, AttributeError, RecursionError):
            return None   # a damaged note may hold any JSON or none
        return (self.path / folder, messages) if whole else None


def _checksums(folder):
    """{name of each file in a folder: [bytes, CRC-32]}."""
    sums = {}
    for path in sorted(folder.iterdir()):
        with open(path, "rb", buffering=0) as file:
            sums[path.name] = [os.fstat(file.fileno()).st_size, checksum(file)]
    return sums


class KeptResults(Executor):
    """Executor that keeps every result in a work folder and has another one do only what is not there."""

    def __init__(self, executor: Executor, work: WorkFolder):
        self.executor, self.work, self.folder = executor, work, executor.folder
        # all but the work itself is that of the executor
        self.sees, self.passing, self.forget, self.release, self.close = (  # type: ignore[method-assign]
            executor.sees, executor.passing, executor.forget, executor.release, executor.close)

    def run(self, phase: Phase, items: Sequence[Any], progress: Progress = Progress(), keep: Sequence[Path] = ()) -> Iterator[Any]:
        items = list(items)
        # a recipe names the folder, which may be moved
        key = digest((code_digest(), name_of(phase.function), phase.source.recipe(self.work.path), phase.arguments), str(self.work.path))
        folder = self.work.path / f"phase-{key}"
        files = [folder / f"{digest(item)}.plain" for item in items]
        missing = {file: item for file, item in zip(files, items) if not is_whole(file)}
        if len(missing) < len(items):
            progress.info(f"{len(items) - len(missing)} of {len(items)} parts of the work were finished by an earlier run.")
        try:
            folder.mkdir(exist_ok=True)
            for file in missing:   # what the failing power left of a file
                file.unlink(missing_ok=True)
            results = self.executor.run(phase, list(missing.values()), progress, list(missing))
            for file in files:
                if file in missing:
                    del missing[file]   # a later item may be the same
                    result = next(results)
                    if not file.exists():
                        write_plain(file, result)
                else:
                    result = read_plain(file)
                yield result
        except OSError as error:
            raise self.work.error(error) from error
        progress.report(1.0)

    def disk_error(self, error: OSError) -> RoadExtractionError:
        return self.work.error(error)


@lru_cache(maxsize=1)
def code_digest() -> str:
    """A digest of the code that phases run, with its tables: other code may give other results."""
    package = Path(__file__).resolve().parents[2]
    sha = hashlib.sha256()
    files = (path for folder in ("core", "products") for path in (package / folder).rglob("*") if path.suffix in (".py", ".json", ".txt"))
    for path in sorted(files):
        sha.update(path.relative_to(package).as_posix().encode() + path.read_bytes())
    return sha.hexdigest()
