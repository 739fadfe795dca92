"""Phases run by the workers of a Dask cluster, who share points and results with the caller in a folder that all of them see."""

from __future__ import annotations

import importlib.metadata
import ipaddress
import math
import os
import platform
import re
import socket
import tempfile
import threading
import time
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from ..common.parallel import POLL_INTERVAL, check_cancelled
from ..common.progress import Progress
from .folder_executor import FolderExecutor, Work
from .keep import work_folder_error
from .tasks import BEAT, NEEDED, code_digest, items_done_here, look_around, sees_files, versions
from .weights import EXECUTION


def cluster_of(address: str, insecure: bool, work: Path | None, progress: Progress = Progress()) -> Cluster:
    """The cluster of a running scheduler, checked and ready for work; close it at the end.

    address, insecure : as of `client_of`
    work : folder of the user's that all machines see; None takes one for temporary files, which all workers on this computer see

    Raises RoadExtractionError if the cluster cannot be used: see `client_of`, `_check_versions` and `_check_workers`.
    """
    client = client_of(address, insecure)
    cluster = None
    try:
        workers = wait_for_workers(client, progress)
        _check_versions(client)
        try:
            cluster = Cluster(client, work, sum(workers.values()))
        except OSError as error:
            raise (work_folder_error(work, error) if work else _disk_error(tempfile.gettempdir(), error)) from error
        _check_workers(client, cluster.folder, BEAT, work is not None, progress)
    except BaseException:
        (cluster or client).close()
        raise
    progress.info(f"The work is shared among {len(workers)} worker(s) of the Dask cluster {address}. They can be watched at {client.dashboard_link}.")
    return cluster


class Cluster(FolderExecutor):
    """Executor that uses the workers of a Dask cluster, whose memory is theirs.

    client : distributed.Client, closed at the end
    work : folder that all workers see; None takes one for temporary files
    threads : of all workers together, as far as they are there already
    """

    worker = "A worker of the cluster"

    def __init__(self, client: Any, work: Path | None = None, threads: int = 1):
        super().__init__(work, threads, EXECUTION.items_per_task)
        self.client, self.named = client, work is not None
        (self.folder / BEAT).write_text(str(EXECUTION.caller_lost), encoding="utf-8")
        self._closed = threading.Event()
        self._lost_since = math.inf   # when the connection to the scheduler was lost
        threading.Thread(target=_beat, args=(self.folder / BEAT, self._closed), daemon=True).start()

    def new_pool(self) -> Any:
        return self.client.get_executor(pure=False, retries=0)

    def task(self) -> Callable[..., Any]:
        return partial(items_done_here, code_digest())

    def end_pool(self, pool: Any, phase: Path) -> None:
        if self.client.status == "running":
            pool.shutdown(wait=False)

    def check(self, work: Work) -> None:
        """Refuse to wait for a scheduler that is lost, and for workers that all pause, and go on doing so."""
        now = time.monotonic()
        self._lost_since = math.inf if self.client.status == "running" else min(self._lost_since, now)
        if self.client.status == "closed" or now - self._lost_since > EXECUTION.scheduler_lost:
            raise self.lost(work)
        if now - work.heard > EXECUTION.paused_time:
            if not _all_paused(self.client):
                work.heard = now
            elif now - work.heard > 2 * EXECUTION.paused_time:
                raise RoadExtractionError(f"All workers of the cluster pause during {work.name}, since their memory is nearly full. "
                                          "Start them with a higher --memory-limit.")

    def lost(self, work: Work) -> RoadExtractionError:
        if self.named:
            return RoadExtractionError(f"The connection to the Dask scheduler was lost while {work.name} was at work. Run again with the same "
                                       "WORK_FOLDER: what is finished is kept there.")
        return RoadExtractionError(f"The connection to the Dask scheduler was lost while {work.name} was at work. Run again, or without SCHEDULER.")

    def ended(self, place: str, last_words: str) -> RoadExtractionError:
        return RoadExtractionError(f"Workers of the cluster ended or ran out of memory while they worked on {place}; usually their memory is too "
                                   "small. Start fewer of them on each machine, or with a higher --memory-limit.")

    def disk_error(self, error: OSError) -> RoadExtractionError:
        return _disk_error(self.folder, error)

    def sees(self, paths: Sequence[Path]) -> bool:
        sizes = {str(path): path.stat().st_size for path in paths}
        return all(visible is True for visible in self.client.run(sees_files, sizes, on_error="return").values())

    def close(self) -> None:
        self._closed.set()
        self.client.close()
        super().close()


def _beat(file, closed):
    while not closed.wait(EXECUTION.beat_time):
        try:
            os.utime(file)
        except OSError:
            return   # the folder is gone


def _disk_error(folder, error):
    return RoadExtractionError(f"The folder {folder}, which the workers of the cluster share, cannot be used: {error}. Free some space there, or "
                               "choose another.")


# The connection to a Dask cluster that somebody has started: its address, its workers and their packages are checked before the work.
#
# Dask sends pickled functions, and whoever can talk to a scheduler can run programs as its workers. So a connection that leaves this computer is
# encrypted, with certificates that Dask's own configuration names, unless the user says otherwise.

ADDRESS = re.compile(r"([a-z]+://)?(?P<host>\[[0-9a-fA-F:.%]+\]|[^\s:/@?#\[\]]+):[0-9]+/?")
PACKAGE = "lanewright"
INSTALL = 'pip install "lanewright[cluster]"'
EQUAL = (PACKAGE, "distributed", *NEEDED)   # packages whose versions must be equal, or results and messages could differ


def is_loopback(address: str) -> bool:
    """Whether an address, such as tcp://127.0.0.1:8786, never leaves this computer."""
    whole = ADDRESS.fullmatch(address)
    host = whole["host"] if whole else ""
    try:
        return ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        return host == "localhost"


def check_address(address: str, insecure: bool) -> None:
    """Refuse an address to which the connection would not be encrypted.

    Raises RoadExtractionError if it is none, or does not begin with tls://, leaves this computer, and `insecure` is not set.
    """
    if not ADDRESS.fullmatch(address):
        raise RoadExtractionError(f"{address} is no address of a scheduler: it needs a port. Give the address that its log shows, such as "
                                  "tls://name:8786, or tcp://127.0.0.1:8786 on this computer.")
    if not address.startswith("tls://") and not is_loopback(address) and not insecure:
        raise RoadExtractionError(f"The scheduler {address} lies outside this computer, and the connection to it would not be encrypted: anybody in "
                                  "the network could run programs on the workers. Start scheduler and workers with certificates and give its tls:// "
                                  "address, or set INSECURE where the network is yours alone.")


def client_of(address: str, insecure: bool = False) -> Any:
    """A distributed.Client of a running scheduler at tls://host:port, or tcp:// on this computer; elsewhere only where `insecure` is set.

    Raises RoadExtractionError if dask.distributed is missing, the address is not safe, certificates are missing, or nothing answers there.
    """
    check_address(address, insecure)
    try:
        from distributed import Client
        from distributed.security import Security
    except ImportError as error:
        raise RoadExtractionError(f"SCHEDULER needs dask.distributed, which cannot be imported ({error}). Install it with: {INSTALL}.") from error
    encrypted = address.startswith("tls://")
    security = Security(require_encryption=encrypted)
    if encrypted and not (security.tls_ca_file and security.tls_client_cert):
        raise RoadExtractionError(
            f"The scheduler {address} wants certificates, and Dask's configuration names none. Set distributed.comm.tls.ca-file, "
            "client.cert and client.key there, or the variables DASK_DISTRIBUTED__COMM__TLS__CA_FILE, …__CLIENT__CERT and …__CLIENT__KEY.")
    try:
        _check_greeting(address, security)
        return Client(address, timeout=EXECUTION.connect_time, security=security, set_as_default=False, name=PACKAGE)
    # of wrong certificates, names and ports, each library has errors of its own
    except Exception as error:
        raise RoadExtractionError(
            f"No Dask scheduler answers at {address}: {_words(error)}. Start one (dask scheduler), or look up its address in its log.") from error


def _check_greeting(address, security):
    """Refuse a server that accepts a connection and then says nothing, as a web server does: a Client waits for it without end.

    A scheduler greets whoever connects. One that cannot be reached is left to Client, which waits until it has started.
    """
    scheme, _, location = address.rpartition("://")
    host, _, port = location.rstrip("/").rpartition(":")
    if scheme not in ("", "tcp", "tls"):
        return
    try:
        connection = socket.create_connection((host.strip("[]"), int(port)), EXECUTION.connect_time)
    except OSError:
        return
    with connection:
        try:
            if scheme == "tls":
                connection = security.get_connection_args("client")["ssl_context"].wrap_socket(connection, server_hostname=host.strip("[]"))
            greeted = connection.recv(1)
        except TimeoutError as error:
            raise TimeoutError("something listens there, but does not speak as a scheduler") from error
        finally:
            connection.close()
    if not greeted:
        raise ConnectionError("something listens there, but ends the connection")


def wait_for_workers(client: Any, progress: Progress) -> dict[str, int]:
    """{address: threads} of the workers, as soon as there is one; refused if none came within `workers_time`."""
    until = time.monotonic() + EXECUTION.workers_time
    while not (workers := client.nthreads()):
        if time.monotonic() > until:
            raise RoadExtractionError(f"The scheduler {client.scheduler.address} has no workers. Start some: dask worker {client.scheduler.address}.")
        progress.check_cancelled()
        time.sleep(POLL_INTERVAL)
    return dict(workers)


def _answers(client: Any, function: Callable[..., Any], *arguments: Any) -> dict[str, Any]:
    """{worker: what a function gives there, or the exception}, asked again where a worker was lost that the scheduler still lists."""
    until = time.monotonic() + EXECUTION.scheduler_lost
    while True:
        answers = client.run(function, *arguments, on_error="return")
        lost = {worker: error for worker, error in answers.items() if isinstance(error, OSError)}
        if not lost:
            return answers
        if time.monotonic() > until:
            worker, error = lost.popitem()
            raise RoadExtractionError(f"The worker {worker} does not answer: {_words(error)}. Look whether it still runs, or start it anew.")
        check_cancelled()
        time.sleep(POLL_INTERVAL)


def _check_versions(client: Any) -> None:
    """Refuse workers whose Python or packages are others than ours; the message names the worker, the package and both versions."""
    local = versions(EQUAL)
    # functions of the standard library, which every worker has
    minor = {worker: installed if isinstance(installed, BaseException) else ".".join(installed.split(".")[:2])
             for worker, installed in _answers(client, platform.python_version).items()}
    _compare("Python", minor, local["python"])
    for name in EQUAL:
        # the plugin is no installed package; what it consists of is compared by `_check_workers`
        _compare(name, _answers(client, importlib.metadata.version, name), local[name])


def _compare(name, versions, here):
    for worker, installed in versions.items():
        if isinstance(installed, BaseException):
            raise RoadExtractionError(f"The worker {worker} has no {name}. Install it for its Python: {INSTALL} (QGIS is not needed there).")
        if here and installed != here:
            raise RoadExtractionError(f"The worker {worker} has {name} {installed}, this computer has {here}; results could differ. Install the same "
                                      "version for both.")


def _check_workers(client: Any, folder: Path, word: str, named: bool, progress: Progress) -> None:
    """See that every worker has our code and sees the file `word` in our folder, and warn of what slows the work down.

    `named` tells whether the user chose the folder.
    """
    for worker, report in _answers(client, look_around, str(folder), word).items():
        if isinstance(report, BaseException) or report["code"] != code_digest():
            raise RoadExtractionError(f"The worker {worker} has another {PACKAGE} than this computer, although maybe of the same version. Install "
                                      f"this one there: {INSTALL}, or pip install . in its folder.")
        if report["problem"]:
            problem = report["problem"]
            if named:
                raise RoadExtractionError(f"The worker {worker} cannot use the folder {folder}: {problem}. Choose a WORK_FOLDER that all machines "
                                          "see under the same path and may write to.")
            raise RoadExtractionError(f"The worker {worker} cannot use the folder {folder}: {problem}. Where workers are on other computers, or "
                                      "belong to another user, WORK_FOLDER must name a folder that all of them see.")
        if 0 < report["memory"] < EXECUTION.least_memory:
            progress.warn(f"The worker {worker} may take {report['memory'] / 2**20:.0f} MiB of memory; a dense survey needs about "
                          f"{EXECUTION.least_memory / 2**20:.0f}. Start it with a higher --memory-limit if workers end.")
    threads = max(client.nthreads().values())
    if threads > 1:
        progress.warn(f"Workers have up to {threads} threads, which wait for each other in Python. Workers of one thread are faster: start more of "
                      "them with --nthreads 1.")
    failures = _allowed_failures(client)
    if failures is not None and failures > 1:
        progress.warn(f"The scheduler lets {failures + 1} workers end at one stretch of road before it says so. Start it with the variable "
                      "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES=1.")


def _all_paused(client: Any) -> bool:
    """Whether every worker pauses because its memory is nearly full."""
    try:
        scheduler = client.scheduler_info(n_workers=-1)
    # of versions that tell of all anyway
    except TypeError:
        scheduler = client.scheduler_info()
    return all(worker.get("status") == "paused" for worker in scheduler["workers"].values())


def _allowed_failures(client):
    """`allowed-failures` of the scheduler; None where it does not tell."""
    import dask

    try:
        return int(client.run_on_scheduler(dask.config.get, "distributed.scheduler.allowed-failures"))
    # a gateway may refuse to run anything on the scheduler
    except Exception:
        return None


def _words(error):
    """An error in one line."""
    return (str(error) or type(error).__name__).splitlines()[0].rstrip(".")
