"""Worker processes of this computer: every task once, whatever dies."""

import multiprocessing
import os
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.workers.calls import fatal, fatal_once, faulty, own_process, square
from tests.workers.orphans import left_by

from openacr.workers import Done, LocalPool, Lost


def test_every_task_has_its_result_once() -> None:
    with LocalPool(2) as pool:
        found = list(pool.results(square, range(50)))
        assert pool.results(square, []) is not None
        assert list(pool.results(square, [])) == []
    assert sorted(each.task for each in found) == list(range(50))
    assert all(isinstance(each, Done) and each.result == each.task**2 for each in found)
    assert pool.deaths == 0
    assert multiprocessing.active_children() == []


def test_the_tasks_are_spread_over_as_many_processes_as_given(tmp_path: Path) -> None:
    with LocalPool(2) as pool:
        tasks = pool.results(own_process, [str(tmp_path)] * 20)
        found = {each.result for each in tasks if isinstance(each, Done)}
    assert len(found) == 2
    assert os.getpid() not in found


def test_tasks_are_read_as_they_are_needed() -> None:
    read = []

    def tasks() -> Iterator[int]:
        for number in range(100):
            read.append(number)
            yield number

    with LocalPool(1) as pool:
        results = pool.results(square, tasks())
        next(results)
        assert len(read) <= 3


def test_a_task_that_ends_its_process_every_time_is_the_only_one_lost() -> None:
    with LocalPool(2) as pool:
        found = list(pool.results(fatal, range(12)))
    assert [each for each in found if isinstance(each, Lost)] == [
        Lost(3, "the worker process died")
    ]
    assert sorted(each.result for each in found if isinstance(each, Done)) == [
        number for number in range(12) if number != 3
    ]
    assert pool.deaths == 3  # among others, and twice alone


def test_a_task_whose_process_ends_once_is_done_again(tmp_path: Path) -> None:
    with LocalPool(2) as pool:
        found = list(pool.results(fatal_once, [(n, str(tmp_path)) for n in range(8)]))
    assert sorted(each.result for each in found if isinstance(each, Done)) == list(range(8))
    assert pool.deaths == 1


def test_an_error_of_a_task_is_a_result_without_value() -> None:
    with LocalPool(1) as pool:
        found = {each.task: each for each in pool.results(faulty, [1, 2, 3])}
    assert found[2] == Lost(2, "ZeroDivisionError: division by zero")
    assert found[3] == Done(3, 1.0)


@pytest.mark.skipif(sys.platform == "win32", reason="processes are looked up by signals")
def test_processes_end_with_a_parent_that_is_killed() -> None:
    children = left_by(
        """
        import tempfile
        import time
        from openacr.workers import LocalPool
        from tests.workers.calls import own_process
        if __name__ == "__main__":
            with tempfile.TemporaryDirectory() as folder, LocalPool(2) as pool:
                tasks = pool.results(own_process, [folder] * 20)
                found = {each.result for each in tasks}
                print(*found, flush=True)
                time.sleep(60)
        """
    )
    assert len(children) == 2
