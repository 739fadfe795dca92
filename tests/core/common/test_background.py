"""Work that goes on while others do theirs."""

import threading

import pytest
from lanewright.core.common.background import InBackground
from lanewright.core.common.errors import Cancelled, RoadExtractionError
from lanewright.core.common.parallel import check_cancelled
from lanewright.core.common.progress import Progress


class Log(Progress):
    def __init__(self):
        self.said = []

    def info(self, text):
        self.said.append((text, threading.current_thread()))

    def warn(self, text):
        self.info(text)


def test_the_result_comes_when_it_is_asked_for_and_what_was_said_then_and_by_the_thread_that_asks():
    go = threading.Event()

    def work(progress):
        progress.warn("first")
        progress.info("second")
        go.set()
        return 7

    log = Log()
    with InBackground(work) as found:
        assert go.wait(10.0)
        assert not log.said
        assert found.result(log) == 7
    here = threading.current_thread()
    assert log.said == [("first", here), ("second", here)]


def test_what_goes_wrong_is_raised_where_the_result_is_asked_for():
    def refuse(progress):
        raise RoadExtractionError("no lattice")

    with InBackground(refuse) as found, pytest.raises(RoadExtractionError, match="no lattice"):
        found.result()


@pytest.mark.parametrize("asks", ["progress", "scope"])
def test_work_whose_result_nobody_wants_ends(asks):
    ended, begun = threading.Event(), threading.Event()

    def work(progress):
        begun.set()
        try:
            while not ended.wait(0.01):
                progress.report(0.5) if asks == "progress" else check_cancelled()
        except Cancelled:
            ended.set()

    with pytest.raises(ZeroDivisionError), InBackground(work):
        assert begun.wait(10.0)
        raise ZeroDivisionError
    assert ended.is_set()


def test_cancel_is_heard_while_the_result_is_awaited():
    class CancelledByUser(Progress):
        def check_cancelled(self):
            raise Cancelled

    def work(progress):
        while True:
            check_cancelled()

    with pytest.raises(Cancelled), InBackground(work) as found:
        found.result(CancelledByUser())
