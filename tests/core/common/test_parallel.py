"""Sections side by side, and work that goes on while others do theirs."""

import threading
import time

import pytest
from lanewright.core.common.errors import Cancelled
from lanewright.core.common.parallel import cancellation_scope, check_cancelled, ordered_map
from lanewright.core.common.progress import Progress


def test_results_come_in_order_though_later_sections_finish_first():
    def slow_first(number):
        time.sleep(0.05 if number == 0 else 0.0)
        return number

    assert list(ordered_map(slow_first, range(20), threads=4)) == list(range(20))


def test_an_error_in_one_section_is_raised():
    def fails(number):
        if number == 3:
            raise ValueError("section 3")
        return number

    with pytest.raises(ValueError, match="section 3"):
        list(ordered_map(fails, range(10), threads=2))


def test_cancel_stops_before_all_sections_are_worked():
    worked, lock = [], threading.Lock()

    def work(number):
        with lock:
            worked.append(number)
        return number

    class CancelsAtOnce(Progress):
        def report(self, fraction):
            raise Cancelled

    with pytest.raises(Cancelled):
        list(ordered_map(work, range(1000), CancelsAtOnce(), threads=2))
    assert len(worked) < 20


class CancelsWhenAsked(Progress):
    """Cancels at the third question."""

    asked = 0

    def report(self, fraction):
        self.asked += 1
        if self.asked == 3:
            raise Cancelled


def test_cancel_is_heard_while_a_section_is_worked_and_ends_it():
    ended = threading.Event()

    def endless(number):
        try:
            while True:
                check_cancelled()
                time.sleep(0.001)
        except Cancelled:
            ended.set()
            raise

    progress = CancelsWhenAsked()
    with pytest.raises(Cancelled):
        list(ordered_map(endless, range(3), progress, threads=1))
    assert progress.asked == 3 and ended.is_set()


def test_long_work_without_a_progress_argument_is_cancelled_within_a_scope():
    class Stop(Progress):
        def check_cancelled(self):
            raise Cancelled

    with cancellation_scope(Progress().part(0.2, 0.4)):
        check_cancelled()
        with pytest.raises(Cancelled), cancellation_scope(Stop().part(0.2, 0.4)):
            check_cancelled()
        check_cancelled()
    check_cancelled()


def test_a_worker_whose_result_is_awaited_is_not_cancelled():
    def work(number):
        check_cancelled()
        return number

    check_cancelled()
    list(ordered_map(work, range(5), threads=2))
    assert list(ordered_map(work, range(5), threads=2)) == list(range(5))


def test_no_more_results_wait_than_there_are_threads():
    made, lock = [0], threading.Lock()

    def work(number):
        with lock:
            made[0] += 1
        return number

    for taken, _ in enumerate(ordered_map(work, range(50), threads=2), start=1):
        assert made[0] <= taken + 3


def test_parts_of_the_work_share_the_bar():
    seen = []

    class Bar(Progress):
        def report(self, fraction):
            seen.append(round(fraction, 6))

    whole = Bar()
    list(ordered_map(lambda n: n, range(2), whole.part(0.5, 1.0), threads=1))
    assert seen == [0.75, 1.0]
