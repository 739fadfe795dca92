"""The connection to a Dask cluster that somebody has started: its address, its workers and their packages are checked before the work.

Dask sends pickled functions, and whoever can talk to a scheduler can run programs as its workers. So a connection that leaves this computer
is encrypted, with certificates that Dask's own configuration names, unless the user says otherwise.
"""

from __future__ import annotations

import importlib.metadata
import ipaddress
import platform
import re
import socket
import time
from pathlib import Path
from typing import Any

from ..common.errors import RoadExtractionError
from ..common.parallel import POLL_INTERVAL
from ..common.progress import Progress
from . import cluster_task
from .interpreter import NEEDED
from .work_folder import code_digest

CONNECT_TIME = 20.0      # s for a scheduler to answer
WORKERS_TIME = 60.0      # s for the first worker to come
LEAST_MEMORY = 1 << 30   # bytes: a section of a dense survey, its surroundings and what is imported (about 0.5 GB, measured) twice
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

    Raises
    ------
    RoadExtractionError
        If it is none, or does not begin with tls://, leaves this computer, and `insecure` is not set.
    """
    if not ADDRESS.fullmatch(address):
        raise RoadExtractionError(
            f"{address} is no address of a scheduler: it needs a port. Give the address that its log shows, such as tls://name:8786, or "
            "tcp://127.0.0.1:8786 on this computer.")
    if not address.startswith("tls://") and not is_loopback(address) and not insecure:
        raise RoadExtractionError(
            f"The scheduler {address} lies outside this computer, and the connection to it would not be encrypted: anybody in the network "
            "could run programs on the workers. Start scheduler and workers with certificates and give its tls:// address, or set INSECURE "
            "where the network is yours alone.")


def client_of(address: str, insecure: bool = False) -> Any:
    """A distributed.Client of a running scheduler.

    Parameters
    ----------
    address : tls://host:port, or tcp:// on this computer
    insecure : is an unencrypted connection to another computer wanted?

    Raises
    ------
    RoadExtractionError
        If dask.distributed is missing, the address is not safe, certificates are missing, or nothing answers there.
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
        return Client(address, timeout=CONNECT_TIME, security=security, set_as_default=False, name=PACKAGE)
    # of wrong certificates, names and ports, each library has errors of its own
    except Exception as error:
        raise RoadExtractionError(
            f"No Dask scheduler answers at {address}: {_words(error)}. Start one (dask scheduler), or look up its address in its log.") from error


def _check_greeting(address, security):
    """Refuse a server that accepts a connection and then says nothing, as a web server does: a Client waits for it without end.

    A scheduler greets whoever connects. One that cannot be reached is left to Client, which waits until it has started.
    """
    scheme, _, place = address.rpartition("://")
    host, _, port = place.rstrip("/").rpartition(":")
    if scheme not in ("", "tcp", "tls"):
        return
    try:
        connection = socket.create_connection((host.strip("[]"), int(port)), CONNECT_TIME)
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
    """{address: threads} of the workers, as soon as there is one.

    Raises
    ------
    RoadExtractionError
        If none came within WORKERS_TIME.
    """
    until = time.monotonic() + WORKERS_TIME
    while not (workers := client.nthreads()):
        if time.monotonic() > until:
            raise RoadExtractionError(f"The scheduler {client.scheduler.address} has no workers. Start some: dask worker {client.scheduler.address}.")
        progress.check_cancelled()
        time.sleep(POLL_INTERVAL)
    return dict(workers)


def own_versions() -> dict[str, str]:
    """Versions of Python and of the packages EQUAL on this computer; "" for a package that was not installed by pip."""
    found = {"python": platform.python_version()}
    for name in EQUAL:
        try:
            found[name] = importlib.metadata.version(name)
        except importlib.metadata.PackageNotFoundError:
            found[name] = ""
    return found


def check_versions(client: Any) -> None:
    """Refuse workers whose Python or packages are others than ours.

    Raises
    ------
    RoadExtractionError
        Naming the worker, the package and both versions.
    """
    own = own_versions()
    # functions of the standard library, which every worker has
    _compare("Python", client.run(platform.python_version, on_error="return"), own["python"], _minor)
    for name in EQUAL:
        # the plugin is no installed package; what it consists of is compared by `check_workers`
        _compare(name, client.run(importlib.metadata.version, name, on_error="return"), own[name])


def _compare(name, found, own, essential=str):
    for worker, version in found.items():
        if isinstance(version, BaseException):
            raise RoadExtractionError(f"The worker {worker} has no {name}. Install it for its Python: {INSTALL} (QGIS is not needed there).")
        if own and essential(version) != essential(own):
            raise RoadExtractionError(f"The worker {worker} has {name} {version}, this computer has {own}; results could differ. Install the same "
                                      "version for both.")


def _minor(version):
    return version.split(".")[:2]


def check_workers(client: Any, folder: Path, word: str, named: bool, progress: Progress) -> None:
    """See that every worker has our code and sees our folder, and warn of what slows the work down.

    Parameters
    ----------
    client : distributed.Client
    folder : that workers and caller share
    word : name of a file in it
    named : whether the user chose the folder
    progress : is told what does not suit

    Raises
    ------
    RoadExtractionError
        Naming the worker.
    """
    for worker, found in client.run(cluster_task.look, str(folder), word, on_error="return").items():
        if isinstance(found, BaseException) or found["code"] != code_digest():
            raise RoadExtractionError(f"The worker {worker} has another {PACKAGE} than this computer, although maybe of the same version. Install "
                                      f"this one there: {INSTALL}, or pip install . in its folder.")
        if found["problem"]:
            problem = found["problem"]
            if named:
                raise RoadExtractionError(f"The worker {worker} cannot use the folder {folder}: {problem}. Choose a WORK_FOLDER that all machines "
                                          "see under the same path and may write to.")
            raise RoadExtractionError(f"The worker {worker} cannot use the folder {folder}: {problem}. Where workers are on other computers, or "
                                      "belong to another user, WORK_FOLDER must name a folder that all of them see.")
        if 0 < found["memory"] < LEAST_MEMORY:
            progress.warn(f"The worker {worker} may take {found['memory'] / 2**20:.0f} MiB of memory; a dense survey needs about "
                          f"{LEAST_MEMORY / 2**20:.0f}. Start it with a higher --memory-limit if workers end.")
    threads = max(client.nthreads().values())
    if threads > 1:
        progress.warn(f"Workers have up to {threads} threads, which wait for each other in Python. Workers of one thread are faster: start more of "
                      "them with --nthreads 1.")
    failures = _allowed_failures(client)
    if failures is not None and failures > 1:
        progress.warn(f"The scheduler lets {failures + 1} workers end at one stretch of road before it says so. Start it with the variable "
                      "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES=1.")


def all_paused(client: Any) -> bool:
    """Whether every worker pauses because its memory is nearly full."""
    try:
        found = client.scheduler_info(n_workers=-1)
    # of versions that tell of all anyway
    except TypeError:
        found = client.scheduler_info()
    return all(worker.get("status") == "paused" for worker in found["workers"].values())


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
