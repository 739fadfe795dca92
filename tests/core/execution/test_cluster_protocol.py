"""How phases are given to a Dask cluster, with a stand-in for the cluster: its tasks run in threads of this process.

The real one, with a scheduler and workers, is that of `make test-cluster`.
"""

import builtins
import socket
import threading
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import pytest
from curbed_streets import street, survey_of
from executed_boundaries import boundaries, numbers_of
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.parallel import check_cancelled
from lanewright.core.common.progress import Progress
from lanewright.core.execution import cluster, folder_executor, tasks
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.cluster import Cluster, check_address, client_of, is_loopback
from lanewright.core.execution.keep import Keep, work_folder
from lanewright.core.execution.phase import Phase, Threads, read_plain, write_plain
from lanewright.core.execution.tasks import code_digest
from lanewright.core.survey.frame.road_frame import build_frame


class KilledWorker(Exception):
    """What Dask raises where workers end at a task."""


def is_section(item):
    """Whether an item ends with the first and last profile or plane of a section, alone or behind its method and road."""
    return len(item) == 2 and isinstance(item[1], int) or len(item) == 4 and isinstance(item[0], str)


def is_half(section, items):
    """Whether a section is half of an item that was sent."""
    return any(item[:-2] == section[:-2] and (item[-2] == section[-2]) != (item[-1] == section[-1]) for item in items)


class StandIn(ThreadPoolExecutor):
    """Does in threads what a distributed.Client and its executor have done; `deadly(section)` says at which items a worker would end.

    tasks : the items of each task that was sent, in this order
    """

    status = "running"

    def __init__(self, deadly=lambda section: False):
        super().__init__(2)
        self.deadly, self.tasks = deadly, []

    @property
    def items(self):
        return [item for some in self.tasks for item in some if is_section(item)]

    def get_executor(self, pure, retries):
        return Shared(self)

    def submit(self, function, phase, items, results):
        self.tasks.append([tuple(item) for item in read_plain(Path(items))])
        return super().submit(self._do, function, phase, items, results)

    def _do(self, function, phase, items, results):
        some = read_plain(Path(items))
        for k, section in enumerate(some):
            if is_section(section) and self.deadly(tuple(section)):
                before = Path(items).with_suffix(".before")
                write_plain(before, some[:k])
                function(phase, str(before), results[:k])
                before.unlink()
                raise KilledWorker
        return function(phase, items, results)

    def close(self):
        self.shutdown()


class Shared:
    """The executor of a phase, of a client that goes on."""

    def __init__(self, client):
        self.submit = client.submit

    def shutdown(self, wait):
        pass


@pytest.fixture(scope="module")
def by_threads():
    return numbers_of(boundaries(Threads(1)))


def test_what_is_sent_as_files_gives_what_threads_give_and_leaves_nothing(by_threads):
    executor = Cluster(StandIn())
    assert numbers_of(boundaries(executor)) == by_threads
    assert not executor.folder.exists()


def test_a_section_at_which_workers_end_is_halved_once_and_gives_the_same(by_threads):
    halves = []

    def deadly(section):
        half = is_half(section, client.items)
        halves.extend([section] * half)
        return section[-2] <= 100 < section[-1] and not half

    client = StandIn(deadly)
    executor = Cluster(client)
    assert numbers_of(boundaries(executor)) == by_threads
    assert len(halves) >= 4 and not executor.folder.exists()


def test_where_workers_end_at_a_half_the_road_is_named():
    executor = Cluster(StandIn(deadly=lambda section: section[-2] <= 100 < section[-1]))
    with pytest.raises(RoadExtractionError, match=r"Workers of the cluster ended.*road 0, -?\d+ to -?\d+ m.*memory-limit"):
        boundaries(executor)
    assert not executor.folder.exists()


def test_a_phase_that_cannot_be_halved_is_named_at_once():
    client = StandIn(deadly=lambda section: True)
    executor = Cluster(client)
    with pytest.raises(RoadExtractionError, match="Workers of the cluster ended"):
        list(executor.run(Phase(lengths_of, survey_of(street())), [(0, 8)]))
    assert len(client.items) == 1
    executor.close()


lengths_of = build_frame   # any function of core: it is never called


def test_workers_that_all_pause_for_ever_are_not_waited_for(monkeypatch):
    monkeypatch.setattr(cluster, "EXECUTION", replace(cluster.EXECUTION, paused_time=0.3))
    client = StandIn()
    client.submit = lambda *_: Future()
    client.scheduler_info = lambda n_workers: dict(workers=dict(one=dict(status="paused"), other=dict(status="paused")))
    executor = Cluster(client)
    with pytest.raises(RoadExtractionError, match="All workers of the cluster pause.*memory-limit"):
        list(executor.run(Phase(lengths_of, survey_of(street())), [(0, 8)]))
    executor.close()


@pytest.fixture
def few_rounds(monkeypatch):
    """Tasks of several sections on a short street."""
    monkeypatch.setattr(folder_executor, "EXECUTION", replace(folder_executor.EXECUTION, work_rounds=1))


def test_successive_sections_go_to_a_worker_together_and_every_worker_has_rounds_of_work(by_threads, few_rounds):
    client = StandIn()
    assert numbers_of(boundaries(Cluster(client))) == by_threads
    together = [some for some in client.tasks if is_section(some[0])]
    assert {len(some) for some in together} == {6}, "all sections of a street of 51 m, by both methods"
    assert all(a[-1] == b[-2] for some in together for a, b in zip(some, some[1:]) if a[:-2] == b[:-2])
    shared = StandIn()
    assert numbers_of(boundaries(Cluster(shared, threads=100))) == by_threads
    assert max(map(len, shared.tasks)) == 1 and sorted(set(shared.items)) == sorted(set(client.items))


def test_where_workers_end_only_the_section_that_they_end_at_is_computed_again(by_threads, few_rounds, monkeypatch):
    computed, write = [], tasks.write_results

    def counted(path, *others):
        computed.append(path)
        write(path, *others)

    monkeypatch.setattr(tasks, "write_results", counted)
    client = StandIn(lambda section: section[-2] <= 100 < section[-1] and not is_half(section, client.items))
    assert numbers_of(boundaries(Cluster(client))) == by_threads
    assert len(computed) == len(set(computed)), "what was finished before a worker ended stays"


SECTIONS = [(0, 9), (9, 18), (18, 27), (27, 36)]


def lengths_by(monkeypatch, client, length, **phase):
    """What a phase of SECTIONS gives whose function is `length(first, last)`."""
    monkeypatch.setattr(tasks, "_phase", lambda path: (lambda source, item: length(*item), None, ()))
    executor = Cluster(client)
    try:
        return list(executor.run(Phase(lengths_of, survey_of(street()), **phase), SECTIONS))
    finally:
        executor.close()


def test_memory_that_one_section_lacks_does_not_divide_the_others(few_rounds, monkeypatch):
    def scarce(first, last):
        if first <= 20 < last and last - first > 5:
            raise MemoryError
        return last - first

    client = StandIn()
    assert lengths_by(monkeypatch, client, scarce, join=sum) == [9, 9, 9, 9]
    assert client.tasks == [SECTIONS, *([item] for item in SECTIONS), [(18, 22)], [(22, 27)]]


def test_what_goes_wrong_names_the_section_where_it_did(few_rounds, monkeypatch):
    def fails(first, last):
        return 1 // (first - 18)

    with pytest.raises(RuntimeError, match=r"A worker of the cluster failed at section 18 to 27:\n(?s:.*)ZeroDivisionError"):
        lengths_by(monkeypatch, StandIn(), fails, place=lambda item: "section {} to {}".format(*item))


def test_cancel_leaves_no_folder():
    class Impatient(Progress):
        def report(self, fraction):
            raise Cancelled

    executor = Cluster(StandIn())
    with pytest.raises(Cancelled):
        boundaries(executor, progress=Impatient())
    assert not executor.folder.exists()


def test_a_task_stops_when_its_phase_is_no_longer_wanted(tmp_path, monkeypatch):
    monkeypatch.setattr(tasks, "EXECUTION", replace(tasks.EXECUTION, look_time=0.0))
    phase = tmp_path / "phase.plain"
    phase.touch()
    wanted = tasks._WhileWanted(phase)
    wanted.check_cancelled()
    phase.unlink()
    with pytest.raises(Cancelled):
        wanted.check_cancelled()
    check_cancelled()


def test_a_result_that_is_there_is_not_computed_again(tmp_path):
    files = items, result = tmp_path / "items.plain", tmp_path / "result.plain"
    for path in files:
        write_plain(path, [7])
    assert tasks.items_done_here(code_digest(), str(tmp_path / "no phase"), str(items), [str(result)]) == {}
    assert read_plain(result) == [7]


def test_a_worker_with_other_code_computes_nothing(tmp_path):
    answer = tasks.items_done_here("another", str(tmp_path / "phase"), str(tmp_path / "items"), [str(tmp_path / "result")])
    assert "another Lanewright" in answer["refused"] and not list(tmp_path.iterdir())


def test_the_folder_of_a_caller_that_is_gone_is_removed_and_that_of_another_stays(tmp_path, monkeypatch):
    monkeypatch.setattr(tasks, "EXECUTION", replace(tasks.EXECUTION, watch_time=0.05))
    for name, patience in (("gone", "0.2"), ("alive", "60")):
        (tmp_path / name).mkdir()
        (tmp_path / name / tasks.BEAT).write_text(patience)
    tasks._remove_after(tmp_path / "gone")
    threading.Thread(target=tasks._remove_after, args=(tmp_path / "alive",), daemon=True).start()
    assert not (tmp_path / "gone").exists() and (tmp_path / "alive").exists()
    (tmp_path / "alive" / tasks.BEAT).unlink()


def test_results_go_straight_to_the_work_folder(by_threads, tmp_path):
    work = work_folder(str(tmp_path / "work"))
    executor = Keep(Cluster(StandIn(), work), work)
    assert numbers_of(boundaries(executor)) == by_threads
    assert list(work.glob("kept-*.plain")) and not list(work.glob("run-*")) and not list(work.rglob("*.part*"))


@pytest.mark.parametrize("address, own", [
    ("tcp://127.0.0.1:8786", True), ("tcp://[::1]:8786", True), ("localhost:8786", True), ("tls://10.1.2.3:8786", False),
    ("tcp://10.1.2.3:8786", False), ("tcp://localhost.example:8786", False), ("tcp://127.example.org:1", False), ("10.1.2.3", False),
    ("evil.example:1://127.0.0.1:8786", False), ("tcp://127.0.0.1@evil.example:8786", False), ("tcp://evil.example/127.0.0.1:8786", False)])
def test_this_computer_is_known_by_its_address(address, own):
    assert is_loopback(address) is own


def test_another_computer_is_not_talked_to_without_encryption_unless_that_is_wanted():
    with pytest.raises(RoadExtractionError, match="not be encrypted.*tls://.*INSECURE"):
        ExecutionSettings(scheduler="tcp://10.1.2.3:8786")
    assert ExecutionSettings(scheduler="tls://10.1.2.3:8786").scheduler and ExecutionSettings(scheduler="tcp://10.1.2.3:1", insecure=True).insecure
    check_address("tcp://127.0.0.1:8786", insecure=False)


@pytest.mark.parametrize("address", ["scheduler", "10.1.2.3", "tcp://127.0.0.1", "tls://scheduler.example:",
                                     "evil.example:1://127.0.0.1:8786", "tcp://127.0.0.1@evil.example:8786"])
def test_an_address_without_a_port_is_no_address(address):
    with pytest.raises(RoadExtractionError, match="needs a port"):
        ExecutionSettings(scheduler=address)


def test_a_server_that_is_no_scheduler_is_not_waited_for_without_end(monkeypatch):
    monkeypatch.setattr(cluster, "EXECUTION", replace(cluster.EXECUTION, connect_time=0.3))
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(TimeoutError, match="does not speak as a scheduler"):
            cluster._check_greeting(address, None)
    cluster._check_greeting(address, None)   # nobody is there: a scheduler may still start


def test_a_worker_that_ends_while_it_is_asked_is_left_out_and_one_that_stays_silent_is_named(monkeypatch):
    """It has no other Python for that, and nothing is to be installed there."""
    class Client:
        def __init__(self, silences):
            self.silences = silences

        def run(self, function, *arguments, on_error):
            self.silences -= 1
            lost = {"tcp://gone:1": OSError("the connection was closed")} if self.silences >= 0 else {}
            return {**lost, "tcp://here:2": function(*arguments)}

    monkeypatch.setattr(cluster, "EQUAL", ("numpy",))
    cluster._check_versions(Client(1))
    monkeypatch.setattr(cluster, "EXECUTION", replace(cluster.EXECUTION, scheduler_lost=0.0))
    with pytest.raises(RoadExtractionError, match="tcp://gone:1 does not answer: the connection was closed. Look"):
        cluster._check_versions(Client(99))


def test_where_dask_is_missing_one_sentence_says_how_to_get_it(monkeypatch):
    imported = builtins.__import__

    def without(name, *others):
        if name.startswith("distributed"):
            raise ImportError(f"No module named {name!r}")
        return imported(name, *others)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(RoadExtractionError, match=r"needs dask.distributed.*pip install .lanewright\[cluster\]"):
        client_of("tcp://127.0.0.1:8786")
