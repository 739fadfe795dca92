"""The weights of the room: our own estimates, rounded. What a standard says or what follows from other numbers stands where it is used."""

from __future__ import annotations

from ..common.setting import table


@table
class EXECUTION:
    """Who does the work, and how long others are waited for."""

    worker_points: int = 5_000_000   # points of the files for each worker: starting takes it a second, a tenth of its time for so many
    beat_time: float = 2.0   # s between two signs of life of the caller
    caller_lost: float = 300.0   # s without one after which workers remove the caller's folder; a computer may be suspended for a while
    scheduler_lost: float = 15.0   # s without a connection to the scheduler after which the run ends
    close_time: float = 5.0   # s for the last tasks to let go of the folder
    paused_time: float = 20.0   # s without a result after which is looked whether memory makes all workers pause: they may do so for ever
    items_per_task: int = 4   # usually: a task costs caller, scheduler and worker 11 ms of the processor, an item of road 50 ms or more
    result_time: float = 30.0   # s until a result written by another machine is seen here: network file systems remember that it was not there
    connect_time: float = 20.0   # s for a scheduler to answer
    workers_time: float = 60.0   # s for the first worker to come
    least_memory: int = 1 << 30   # bytes: a section of a dense survey, its surroundings and what is imported (about 0.5 GB, measured) twice
    trials: int = 2   # of an item whose worker ended; what kills two workers kills a third
    end_time: float = 5.0   # s that a worker may take to end by itself
    last_words: int = 2000   # characters of what a dead worker wrote that are passed on
    runs_kept: int = 2   # times as many results as after the first run of a window, beyond which it begins anew: each correction adds a few
    unused_time: float = 86400.0   # s that no run used a file of a full work folder, after which it goes: no run at work reads it
    few_items: int = 8   # of a phase, which threads have done before workers have started, which takes these a second
    open_phases: int = 2   # phases kept open in a worker: the current one and the one before
    work_rounds: int = 8   # of work that a worker has in a phase at least, where its items come together, so that all end at about the same time
    least_tasks: int = 16   # that a phase is divided into where there is enough work, so that all workers end at about the same time
    look_time: float = 0.5   # s between two looks whether a phase is still wanted
    watch_time: float = 2.0   # s between two looks at BEAT
    trial_time: float = 30.0   # s that a trial may take on a busy computer
