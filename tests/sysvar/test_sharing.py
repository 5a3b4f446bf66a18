"""Several processes and threads on one store: seen at once, never torn, never lost."""

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Thread

import pytest
from tests.waiting import until

from openacr.sysvar import Store
from openacr.sysvar.database import Database
from openacr.sysvar.tabs import CONTROL
from openacr.sysvar.values import Value


@contextmanager
def process(code: str, path: Path) -> Iterator[subprocess.Popen[str]]:
    """Another process with an open `store`; it says `ready`, then runs on at a line of input."""
    opening = f"from openacr.sysvar import Store\nstore = Store({str(path)!r})\n"
    started = subprocess.Popen(
        [sys.executable, "-c", f"{opening}print('ready', flush=True)\ninput()\n{code}"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    assert started.stdout is not None
    assert started.stdout.readline() == "ready\n"
    try:
        yield started
    finally:
        started.kill()
        started.communicate()


def go(started: subprocess.Popen[str], line: str = "") -> None:
    assert started.stdin is not None
    started.stdin.write(line + "\n")
    started.stdin.flush()


ECHO = """
while True:
    n, value = input().split()
    store.write(int(n), float(value))
    print('written', flush=True)
"""


@pytest.mark.req("MILL-SYSVAR-SHARE")
def test_a_value_written_by_another_process_is_seen_at_the_next_read(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with Store(path) as store, process(ECHO, path) as other:
        assert other.stdout is not None
        go(other)
        for turn in range(1, 200):
            go(other, f"2001 {turn}")
            assert other.stdout.readline() == "written\n"
            assert store.read(2001) == turn
        go(other, "650002 33")
        assert other.stdout.readline() == "written\n"
        assert store.read(650_002) == 33


COUNT = """
for turn in range(150):
    with store.transaction(is_durable=False):
        store.write(150, store.read(150) + 1)
        store.write(151, store.read(150))
"""


@pytest.mark.req("MILL-SYSVAR-CONCUR")
def test_parallel_writers_lose_nothing_and_readers_see_no_half_group(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    with Store(path) as store, process(COUNT, path) as one, process(COUNT, path) as two:
        for each in (one, two):
            go(each)
        looks = 0
        while one.poll() is None or two.poll() is None:
            with store.transaction(is_durable=False):
                assert store.read(150) == store.read(151)
            looks += 1
            time.sleep(0.001)
        assert looks
        assert (store.read(150), store.read(151)) == (300, 300)


HAMMER = """
value = 0.0
while True:
    value += 1
    with store.transaction(is_durable=False):
        for n in range(1001, 1041):
            store.write(n, value)
    print(int(value), flush=True)
"""


@pytest.mark.req("MILL-SYSVAR-CRASH")
def test_a_killed_writer_leaves_its_last_committed_group(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    for delay_s in (0.02, 0.035, 0.05, 0.08):
        with process(HAMMER, path) as writer:
            go(writer)
            time.sleep(delay_s)
            os.kill(writer.pid, signal.SIGKILL)
            said, _ = writer.communicate()
        committed = int(said.splitlines()[-1]) if said.strip() else 0
        with Store(path) as store:
            values = {store.read(n) for n in range(1001, 1041)}
            assert len(values) == 1  # never a half group
            assert values.pop() in (committed, committed + 1)  # the last may not have been said
            with store.transaction():
                for n in range(1001, 1041):
                    store.write(n, 0.0)


def test_what_a_dead_writer_left_of_the_counter_hides_nothing(tmp_path: Path) -> None:
    """Its number stays odd: every read asks the database."""
    path = tmp_path / "s.db"
    with Store(path) as store, Store(path) as other:
        store._counter.begin()
        for turn in range(5):
            other._counter.begin = other._counter.end = lambda: None  # type: ignore[method-assign]
            other.write(150, float(turn))
            assert store.read(150) == turn


@pytest.mark.req("MILL-SYSVAR-API")
def test_sql_of_another_program_is_seen_soon(tmp_path: Path) -> None:
    import sqlite3

    path = tmp_path / "s.db"
    with Store(path) as store:
        store.write(2001, 1.0)
        foreign = sqlite3.connect(path)
        assert foreign.execute("SELECT value FROM cell WHERE number = 2001").fetchone() == (1.0,)
        foreign.execute(
            "INSERT OR REPLACE INTO cell VALUES (2001, 4, (SELECT max(changed) + 1 FROM cell))"
        )
        foreign.commit()
        foreign.close()
        until(lambda: store.read(2001) == 4.0)


def test_a_writer_waits_for_the_one_at_work(tmp_path: Path) -> None:
    path = tmp_path / "s.db"
    busy = Database(path)
    busy.begin(is_durable=False)
    busy.write_rows([(150, 1.0, 1)])
    with Store(path) as store, process("store.write(150, 2.0)", path) as other:
        go(other)
        time.sleep(0.15)
        assert other.poll() is None
        assert store.read(150) == 0.0
        busy.commit()
        assert other.wait(60) == 0
        assert store.read(150) == 2.0
    busy.close()


def test_many_processes_may_open_a_new_store_at_once(tmp_path: Path) -> None:
    path = tmp_path / "new" / "s.db"
    code = (
        "import sys\nfrom openacr.sysvar import Store\n"
        f"store = Store({str(path)!r})\nstore.write(100 + int(sys.argv[1]), 1.0)"
    )
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    started = [
        subprocess.Popen([sys.executable, "-c", code, str(n)], env=environment) for n in range(4)
    ]
    assert [each.wait(60) for each in started] == [0, 0, 0, 0]
    with Store(path) as store:
        assert [store.read(100 + n) for n in range(4)] == [1.0] * 4


def test_a_cached_read_costs_about_a_dictionary_access(tmp_path: Path) -> None:
    with Store(tmp_path / "s.db") as store:
        store.write(2001, 1.5)
        best = min(_seconds_per_read(store) for _ in range(20))
    assert best < 5e-6  # typically 0.25 us; a read of the database takes 20 times as long


def _seconds_per_read(store: Store) -> float:
    begin = time.thread_time()
    for _ in range(1000):
        store.read(2001)
    return (time.thread_time() - begin) / 1000


def test_a_default_that_is_read_while_another_thread_changes_the_unit_is_not_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with Store(tmp_path / "s.db") as store:
        writer = Thread(target=store.write, args=(CONTROL.default_units, 1))
        default = store.default

        def interrupted(n: int) -> Value:
            found = default(n)
            if n == CONTROL.default_lead_in_radius and not writer.ident:
                writer.start()
                writer.join(0.1)  # it has to wait for the end of the read
            return found

        monkeypatch.setattr(store, "default", interrupted)
        store.read(CONTROL.default_lead_in_radius)
        writer.join()
        assert store.read(CONTROL.default_lead_in_radius) == 6.35
