"""Boundaries found on a real Dask cluster: those that threads find; and what happens when workers, scheduler, folder or caller go."""

import contextlib
import os
import resource
import signal
import subprocess
import sys
import threading
import time
from dataclasses import replace
from functools import partial
from pathlib import Path

import fiona
import numpy as np
import pytest
from curbed_streets import street, survey_of
from executed_boundaries import boundaries as boundaries_by
from executed_boundaries import numbers_of
from executed_stages import PHASES as STAGE_PHASES
from executed_stages import found_by, functions_of
from heard import Heard
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.progress import Progress
from lanewright.core.execution import cluster as executing
from lanewright.core.execution.choice import ExecutionSettings
from lanewright.core.execution.cluster import EQUAL, client_of, cluster_of
from lanewright.core.execution.keep import Keep, work_folder
from lanewright.core.execution.phase import Executor, Phase, Threads
from lanewright.core.execution.tasks import versions
from lanewright.core.road.detect_boundaries import BoundarySettings, draw_boundaries, find_curb_points
from lanewright.core.road.scanlines.section_planes import all_scanlines
from lanewright.core.survey import blocks
from lanewright.core.survey.blocks import sensor_height_of
from lanewright.core.survey.open_survey import open_survey
from lanewright.core.survey.survey import SurveySettings
from lanewright.library import run
from lanewright.simulator.survey import SampleSettings, make_sample_survey

ROOT = Path(__file__).resolve().parents[2]
PHASES = ["_steps_of_methods", "plan_steps_of_section"]
boundaries = partial(boundaries_by, length=60.0)   # three sections of 20 m


@pytest.fixture(scope="module")
def by_threads():
    return numbers_of(boundaries(Threads(1)))


class AtPhase:
    """An executor that does something when the first result of a phase has come."""

    def __init__(self, executor, name, act):
        self.executor, self.name, self.act = executor, name, act

    def run(self, phase, items, *others, **named):
        for k, result in enumerate(self.executor.run(phase, items, *others, **named)):
            if k == 0 and self.name in functions_of(phase, items):
                self.act()
            yield result

    run_together = Executor.run_together

    def __getattr__(self, name):
        return getattr(self.executor, name)


def test_two_workers_find_what_threads_find_and_leave_nothing(cluster, by_threads, sections_together):
    heard = Heard()
    executor = cluster_of(cluster.address, False, None, heard)
    assert numbers_of(boundaries(executor)) == by_threads
    assert not executor.folder.exists()
    assert heard.says("worker(s) of the Dask cluster") and heard.says("watched at")


def test_scanlines_made_by_workers_are_those_that_threads_make(cluster):
    found = []
    for executor in (Threads(1), cluster_of(cluster.address, False, None)):
        survey = survey_of(street())
        survey.executor = executor
        found.append([(part.station.tobytes(), part.d.tobytes(), part.z.tobytes()) for part in all_scanlines(survey, 0)])
        executor.close()
    assert found[0] == found[1] and len(found[0]) > 2


@pytest.mark.parametrize("phase", PHASES)
def test_a_worker_that_is_killed_costs_nothing_that_was_finished(cluster, by_threads, tmp_path, sections_together, phase):
    work, finished = work_folder(str(tmp_path / "work")), {}

    def kill():
        finished.update({path: path.stat().st_ino for path in work.glob("kept-*.plain")})
        cluster.kill_a_worker()

    executor = AtPhase(Keep(cluster_of(cluster.address, False, work), work), phase, kill)
    assert numbers_of(boundaries(executor)) == by_threads
    assert finished and all(path.stat().st_ino == number for path, number in finished.items())
    assert not list(work.glob("run-*")) and not list(work.rglob("*.part*"))


def ends_soon_when_cancelled(cluster, phase, work):
    at = []

    def cancel():
        at.append(time.monotonic())
        raise Cancelled

    executor = cluster_of(cluster.address, False, None)
    with pytest.raises(Cancelled):
        work(AtPhase(executor, phase, cancel))
    assert time.monotonic() - at[0] < 2.0
    assert not executor.folder.exists()


@pytest.mark.parametrize("phase", PHASES)
def test_cancel_ends_within_two_seconds_and_leaves_the_workers_idle(cluster, sections_together, phase):
    ends_soon_when_cancelled(cluster, phase, boundaries)
    with contextlib.closing(client_of(cluster.address)) as client:
        until = time.monotonic() + 10.0
        while any(client.processing().values()) and time.monotonic() < until:
            time.sleep(0.1)
        assert not any(client.processing().values())


def test_where_the_scheduler_is_killed_one_sentence_says_so_and_the_next_run_goes_on(new_cluster, by_threads, tmp_path):
    first, work = new_cluster(), work_folder(str(tmp_path / "work"))
    executor = AtPhase(Keep(cluster_of(first.address, False, work), work), "_steps_of_methods", lambda: first.scheduler.kill())
    with pytest.raises(RoadExtractionError, match="connection to the Dask scheduler was lost.*same WORK_FOLDER"):
        boundaries(executor)
    assert not list(work.glob("run-*"))
    done = len(list(work.glob("kept-*.plain")))
    heard = Heard()
    work = work_folder(str(tmp_path / "work"))
    assert numbers_of(boundaries(Keep(Threads(1), work), progress=heard)) == by_threads
    assert done >= 1


def test_what_a_worker_cannot_write_is_named(new_cluster):
    def few_bytes():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    executor = cluster_of(new_cluster(workers=1, before=few_bytes).address, False, None)
    with pytest.raises(RoadExtractionError, match="folder .* which the workers of the cluster share, cannot be used.*too large"):
        boundaries(executor)
    assert not executor.folder.exists()


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can start workers of another user")
def test_a_folder_that_a_worker_may_not_use_is_named_before_the_work(new_cluster):
    def nobody():
        os.umask(0)
        os.setuid(65534)

    running = new_cluster(workers=0)
    running.folder.chmod(0o777)
    for folder in running.folder.parents:
        if str(folder).startswith("/tmp/"):
            folder.chmod(0o755)
    running.before = nobody
    running.start("dask_worker", running.address, "--nthreads", "2", "--no-nanny", "--no-dashboard", "--local-directory", str(running.folder))
    with pytest.raises(RoadExtractionError, match="The worker tcp://.* cannot use the folder .*WORK_FOLDER"):
        cluster_of(running.address, False, None)


def test_where_memory_is_too_small_one_sentence_says_so(new_cluster):
    running = new_cluster(workers=1, memory="260MB")
    heard = Heard()
    executor = cluster_of(running.address, False, None, heard)
    assert heard.says("MiB of memory")
    named = r"Workers of the cluster ended.*road 0, -?\d+ to -?\d+ m.*memory-limit|All workers of the cluster pause.*memory-limit"
    with pytest.raises(RoadExtractionError, match=named):
        boundaries(executor, lines=0.01)
    assert not executor.folder.exists()


def test_a_bug_on_a_worker_keeps_its_traceback(cluster):
    executor = cluster_of(cluster.address, False, None)
    with pytest.raises(RuntimeError, match="TypeError.*sensor_height_of"):
        list(executor.run(Phase(sensor_height_of, survey_of(street()), ("more", "arguments", "than it takes")), [(0, 1)]))
    executor.close()


def test_two_runs_at_once_in_one_work_folder_find_the_same(cluster, tmp_path):
    made, path = make_sample_survey(SampleSettings(length=40.0, pulse_rate=40_000.0)), tmp_path / "survey.laz"
    made.write_cloud(path)
    found, failed = {}, []

    def one(key, settings):
        try:
            survey = open_survey([path], made.trajectory, SurveySettings(), Progress(), settings)
            with contextlib.closing(survey.store):
                found[key] = numbers_of(draw_boundaries(find_curb_points(survey, BoundarySettings("both")), survey.frame))
        except BaseException as error:
            failed.append(error)

    both = [threading.Thread(target=one, args=(k, ExecutionSettings(work_folder=str(tmp_path / "work"), scheduler=cluster.address)))
            for k in range(2)]
    for thread in both:
        thread.start()
    for thread in both:
        thread.join()
    one("alone", ExecutionSettings())
    assert not failed and found[0] == found[1] == found["alone"]
    assert not list(tmp_path.glob("work/run-*")) and not list(tmp_path.rglob("*.part*"))


def test_other_packages_and_other_code_are_refused_by_name(cluster, monkeypatch):
    here = versions(EQUAL)
    for name, version in dict(python="3.8", numpy="0.9", distributed="1.0").items():
        with monkeypatch.context() as patch:
            patch.setattr(executing, "versions", lambda names: {**here, name: version})
            with pytest.raises(RoadExtractionError, match=f"(?i)worker tcp.* has {name} .*{version}"):
                cluster_of(cluster.address, False, None)
    monkeypatch.setattr(executing, "code_digest", lambda: "another")
    with pytest.raises(RoadExtractionError, match="another lanewright"):
        cluster_of(cluster.address, False, None)


def test_threads_and_allowed_failures_that_do_not_suit_are_said(new_cluster):
    running = new_cluster(workers=0, failures=3)
    running.start("dask_worker", running.address, "--nthreads", "3", "--no-nanny", "--no-dashboard", "--local-directory", str(running.folder))
    heard = Heard()
    cluster_of(running.address, False, None, heard).close()
    assert heard.says("up to 3 threads") and heard.says("lets 4 workers end")


def test_a_scheduler_without_workers_and_none_at_all_are_named(new_cluster, monkeypatch):
    monkeypatch.setattr(executing, "EXECUTION", replace(executing.EXECUTION, workers_time=0.5))
    monkeypatch.setattr(executing, "EXECUTION", replace(executing.EXECUTION, connect_time=1.0))
    with pytest.raises(RoadExtractionError, match="has no workers.*dask worker tcp"):
        cluster_of(new_cluster(workers=0).address, False, None)
    with pytest.raises(RoadExtractionError, match="No Dask scheduler answers at tcp://127.0.0.1:1"):
        cluster_of("tcp://127.0.0.1:1", False, None)


def certificates(folder):
    """Paths of a certificate authority and of a certificate and key that it signed."""
    def openssl(*arguments):
        subprocess.run(["openssl", *arguments], cwd=folder, check=True, capture_output=True)

    openssl("req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=authority", "-keyout", "ca.key", "-out", "ca.pem")
    openssl("req", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=road", "-keyout", "own.key", "-out", "own.csr")
    openssl("x509", "-req", "-in", "own.csr", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial", "-days", "2", "-out", "own.pem")
    return folder / "ca.pem", folder / "own.pem", folder / "own.key"


def configured(authority, certificate, key):
    tls = "distributed.comm.tls."
    return {tls + "ca-file": authority, tls + "client.cert": certificate, tls + "client.key": key}


def test_over_tls_the_same_is_found_and_without_certificates_nothing_is_begun(new_cluster, by_threads, tmp_path):
    import dask

    authority, certificate, key = map(str, certificates(tmp_path))
    running = new_cluster(scheme="tls", security=["--tls-ca-file", authority, "--tls-cert", certificate, "--tls-key", key])
    assert running.address.startswith("tls://")
    with pytest.raises(RoadExtractionError, match="wants certificates"):
        cluster_of(running.address, False, None)
    with dask.config.set(configured(authority, certificate, key)):
        assert numbers_of(boundaries(cluster_of(running.address, False, None))) == by_threads
    stranger = tmp_path / "stranger"
    stranger.mkdir()
    authority, certificate, key = map(str, certificates(stranger))
    with dask.config.set(configured(authority, certificate, key)):
        with pytest.raises(RoadExtractionError, match="No Dask scheduler answers"):
            cluster_of(running.address, False, None)


PROGRAM = """
import sys
sys.path.insert(0, {tests!r})
import conftest
from dataclasses import replace
from lanewright.core.execution import cluster
cluster.EXECUTION = replace(cluster.EXECUTION, caller_lost=4.0)
from lanewright.library.command_line import main
sys.exit(main())
"""


def edges(path):
    with fiona.open(path) as layer:
        return [(feature.geometry.coordinates, dict(feature.properties)) for feature in layer]


@pytest.mark.parametrize("work_folder", [True, False])
def test_a_caller_that_is_killed_leaves_nothing_and_its_work_is_gone_on_with(cluster, tmp_path, work_folder):
    survey = run("samplesurvey", LENGTH=40, PULSE_RATE=60000, POINT_CLOUD=tmp_path / "s.laz", TRAJECTORY=tmp_path / "drive.gpkg")
    inputs = dict(POINT_CLOUDS=[survey["POINT_CLOUD"]], TRAJECTORY=survey["TRAJECTORY"])
    work, result, temporary = tmp_path / "work", tmp_path / "edges.gpkg", tmp_path / "temporary"
    temporary.mkdir()
    command = [sys.executable, "-W", "ignore", "-c", PROGRAM.format(tests=str(ROOT / "tests")), "detectboundaries", "--POINT_CLOUDS",
               survey["POINT_CLOUD"], "--TRAJECTORY", survey["TRAJECTORY"], "--SCHEDULER", cluster.address, "--ROAD_EDGES", str(result)]
    program = subprocess.Popen(command + (["--WORK_FOLDER", str(work)] if work_folder else []), stderr=subprocess.DEVNULL,
                               env={**os.environ, "TMPDIR": str(temporary)})
    begun = (lambda: list(work.glob("kept-*.plain"))) if work_folder else (lambda: list(temporary.glob("lanewright-*/phase*.plain")))
    while program.poll() is None and not begun():
        time.sleep(0.02)
    assert program.poll() is None, "it was still at work"
    os.kill(program.pid, signal.SIGKILL)
    program.wait()
    assert not result.exists()
    until = time.monotonic() + 20.0
    while (list(work.glob("run-*")) or list(temporary.glob("lanewright-*/*"))) and time.monotonic() < until:
        time.sleep(0.2)
    # the workers remove what the run shared with them
    assert not list(work.glob("run-*")) and not list(temporary.glob("lanewright-*/*"))
    if not work_folder:
        return
    finished = {path: path.stat().st_ino for path in work.glob("kept-*.plain")}
    run("detectboundaries", **inputs, WORK_FOLDER=work, SCHEDULER=cluster.address, ROAD_EDGES=result)
    assert finished and all(path.stat().st_ino == number for path, number in finished.items())
    run("detectboundaries", **inputs, ROAD_EDGES=tmp_path / "undisturbed.gpkg")
    assert edges(result) == edges(tmp_path / "undisturbed.gpkg") and edges(result)


def test_seconds_without_a_sign_of_life_are_many_in_real_runs():
    assert executing.EXECUTION.caller_lost >= 60.0


@pytest.fixture(scope="module")
def sample(tmp_path_factory):
    """A sample survey and its cloud."""
    made, path = make_sample_survey(SampleSettings(length=40.0, pulse_rate=40_000.0)), tmp_path_factory.mktemp("sample") / "survey.laz"
    made.write_cloud(path)
    return made, path


def points_read(sample, monkeypatch, progress=Progress(), **execution):
    """All points of the survey as bytes, read in parts of 50,000 points, and what was sent where."""
    made, path = sample
    monkeypatch.setattr(blocks, "READING", replace(blocks.READING, part_points=50_000))
    survey = open_survey([path], made.trajectory, SurveySettings(block=20_000), progress, ExecutionSettings(**execution))
    with contextlib.closing(survey.store):
        parts = [np.array(survey.section(road, number).records) for road in survey.store.roads() for number in survey.store.sections(road)]
        return np.concatenate(parts).tobytes()


def test_workers_read_what_threads_read(cluster, sample, monkeypatch):
    heard = Heard()
    assert points_read(sample, monkeypatch, heard, scheduler=cluster.address) == points_read(sample, monkeypatch)
    assert not heard.says("do not see the point clouds")


def test_a_worker_that_is_killed_while_it_reads_costs_no_part_that_was_read(cluster, sample, monkeypatch, tmp_path):
    work, finished = tmp_path / "work", {}

    class Kill(Progress):
        def report(self, fraction):
            found = {path: path.stat().st_ino for path in work.glob("kept-*.plain")}
            if found and not finished:
                finished.update(found)
                cluster.kill_a_worker()

    assert points_read(sample, monkeypatch, Kill(), scheduler=cluster.address, work_folder=str(work)) == points_read(sample, monkeypatch)
    assert finished and all(path.stat().st_ino == number for path, number in finished.items())


def test_point_clouds_that_workers_do_not_see_are_read_here(cluster, sample, monkeypatch):
    heard = Heard()
    monkeypatch.setattr(executing.Cluster, "sees", lambda self, paths: False)
    assert points_read(sample, monkeypatch, heard, scheduler=cluster.address) == points_read(sample, monkeypatch)
    assert heard.says("do not see the point clouds")


@pytest.fixture(scope="module")
def stages_by_threads(sample):
    return found_by(sample)


@pytest.mark.parametrize("phase", STAGE_PHASES)
def test_a_worker_that_is_killed_in_a_later_stage_costs_nothing(cluster, sample, stages_by_threads, phase):
    killed = []

    def kill():
        if not killed:
            killed.append(phase)
            cluster.kill_a_worker()

    executor = cluster_of(cluster.address, False, None)
    assert found_by(sample, AtPhase(executor, phase, kill)) == stages_by_threads
    assert killed and not executor.folder.exists()


@pytest.mark.parametrize("phase", STAGE_PHASES)
def test_cancel_in_a_later_stage_ends_within_two_seconds(cluster, sample, phase):
    ends_soon_when_cancelled(cluster, phase, partial(found_by, sample))
