"""A worker process: reads tasks from its input, one JSON object a line, and writes each result to a file.

Run as a file by an interpreter that knows nothing of Lanewright:

    python -I worker.py --try NAME …   prints the versions that it can import, if it can import these packages, too
    python -I worker.py FOLDER         works until its input ends

The first line of the input lists the folders to import from. A task is the arguments of `items_done`, whose answer is one line. Between tasks
it may be told to forget what it keeps open. FOLDER is removed where the caller is gone without saying so.
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import shutil
import sys
from pathlib import Path
from typing import Any

PACKAGE = "lanewright"
ROOT = Path(__file__).resolve().parents[2]


def _import_package(folders: list[str]) -> None:
    """Import the checkout that this file lies in, whatever its folder is called; folders that are new go to the end of the search path."""
    sys.path += [folder for folder in folders if folder not in sys.path]
    spec: Any = importlib.util.spec_from_file_location(PACKAGE, ROOT / "__init__.py", submodule_search_locations=[str(ROOT)])
    package = importlib.util.module_from_spec(spec)
    sys.modules[PACKAGE] = package
    spec.loader.exec_module(package)


def main() -> None:
    # what a library prints must not come between the answers
    answers = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    _import_package(json.loads(sys.stdin.readline()))
    if sys.argv[1] == "--try":
        from lanewright.core.execution.tasks import NEEDED, versions

        for name in (*NEEDED, *sys.argv[2:]):
            importlib.import_module(name)
        answers.write(json.dumps(versions()))
        answers.close()
        return
    from lanewright.core.execution.tasks import forget, items_done

    for line in sys.stdin:
        task = json.loads(line)
        if task == "end":
            return
        if task == "forget":
            forget()
            continue
        try:
            answers.write(json.dumps(items_done(*task)) + "\n")
            answers.flush()
        except BrokenPipeError:
            break
    shutil.rmtree(sys.argv[1], ignore_errors=True)


if __name__ == "__main__":
    main()
