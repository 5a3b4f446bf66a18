"""Card time follows the wall clock by absolute deadlines and never spirals."""

import asyncio
import re
import time
from itertools import count, cycle
from pathlib import Path

import pytest
from tests.io.fake_card import FakeCard

import openacr
from openacr.errors import UserError
from openacr.io.pacing import MAX_LAG_S, Pacer
from openacr.io.server import CardServer

PERIOD_S = 0.0005


def started(speed: float = 1.0) -> Pacer:
    pacer = Pacer(PERIOD_S, speed)
    pacer.start(100.0)
    return pacer


@pytest.mark.parametrize("keeps_time", [False, True])
def test_a_lag_is_warned_of_unless_the_card_keeps_time_itself(
    keeps_time: bool, caplog: pytest.LogCaptureFixture
) -> None:
    pacer = Pacer(PERIOD_S, keeps_time=keeps_time)
    pacer.start(100.0)
    assert pacer.due_tk(101.0 + MAX_LAG_S) == 1
    assert ("cannot keep real time" in caplog.text) is not keeps_time


def advance_all(pacer: Pacer, now_s: float) -> int:
    total = 0
    while due := pacer.due_tk(now_s):
        pacer.advanced(due)
        total += due
    return total


@pytest.mark.parametrize(("speed", "ticks"), [(1.0, 2000), (0.5, 1000), (4.0, 8000)])
def test_one_second_holds_the_right_number_of_ticks(speed: float, ticks: int) -> None:
    pacer = started(speed)
    done = sum(advance_all(pacer, 100.0 + at / 777) for at in range(1, 778))
    assert abs(done - ticks) <= 1


def test_late_wake_ups_do_not_add_up() -> None:
    pacer = started()
    now_s, done = 100.0, 0
    while now_s < 130.0:
        now_s += 0.00137
        done += advance_all(pacer, now_s)
    assert abs(done - (now_s - 100.0) / PERIOD_S) <= 1


def test_a_delay_is_caught_up_in_bounded_pieces() -> None:
    pacer = started()
    assert pacer.due_tk(100.1) == 20
    assert advance_all(pacer, 100.1) in (199, 200)
    assert pacer.report().lost_s == 0.0


def test_a_long_standstill_is_given_up_and_counted() -> None:
    pacer = started()
    assert advance_all(pacer, 160.0) == 1
    assert pacer.report().lost_s == pytest.approx(60.0, abs=0.01)
    assert advance_all(pacer, 160.1) in (199, 200)


def test_a_card_that_is_too_slow_loses_time_but_not_its_pace() -> None:
    pacer, now_s = started(), 100.0
    for _ in range(1000):
        due = pacer.due_tk(now_s)
        pacer.advanced(due)
        now_s += 2 * due * PERIOD_S + 0.0001  # each tick takes two periods
        assert pacer.lag_s(now_s) < MAX_LAG_S + 0.05
    assert pacer.report().lost_s > 1.0


def test_ticks_taken_ahead_are_not_due_again() -> None:
    pacer = started()
    ahead = 0
    while pacer.may_run_ahead(100.0):
        pacer.advanced(1)
        ahead += 1
    assert ahead == 4
    assert pacer.due_tk(100.0 + 4 * PERIOD_S) == 0
    assert pacer.due_tk(100.0 + 5.1 * PERIOD_S) == 1


def test_the_pause_ends_when_the_next_tick_is_due() -> None:
    pacer = started()
    assert pacer.pause_s(100.0, 0.001) == pytest.approx(PERIOD_S)
    assert pacer.pause_s(100.01, 0.001) == 0.0
    pacer.advanced(100)
    assert pacer.pause_s(100.0, 0.001) == 0.001


def test_the_report_holds_percentiles_of_the_error() -> None:
    pacer = started()
    for at in range(100):
        advance_all(pacer, 100.0 + 0.001 * (at + 1))
    pacer.due_tk(100.2)
    report = pacer.report()
    assert report.observations > 100
    assert report.median_s <= 0.0011
    assert report.worst_s == pytest.approx(0.1, abs=0.001)
    assert "pacing error" in str(report)


@pytest.mark.parametrize("speed", [0.0, -1.0, float("nan"), float("inf")])
def test_a_speed_must_be_above_zero(speed: float) -> None:
    with pytest.raises(UserError, match="speed"):
        Pacer(PERIOD_S, speed)


def test_no_clock_that_can_be_set_reaches_card_time(monkeypatch: pytest.MonkeyPatch) -> None:
    """The date is set back and forth by days; card time follows the steady clock all the same."""
    dates = cycle([1e9, 1e9 + 86_400.0, 0.0, 4e9])
    monkeypatch.setattr(time, "time", lambda: next(dates))
    card = FakeCard()
    steady_s = count(1000.0, 0.001)  # one millisecond each time it is read
    reads = 0

    async def body() -> None:
        nonlocal reads
        server, stop = CardServer(card), asyncio.Event()

        def now_s() -> float:
            nonlocal reads
            reads += 1
            if reads == 500:
                stop.set()
            return next(steady_s)

        server._now = now_s
        await server.run(stop)

    asyncio.run(body())
    # The last readings may come after the last advance.
    assert reads * 0.001 / PERIOD_S - 10 <= card.tick <= reads * 0.001 / PERIOD_S


def test_a_card_with_much_to_compute_is_left_for_the_sockets() -> None:
    """Ten milliseconds are due, and each tick computes for one: the hosts wait for three."""
    spent_s = 0.0

    class Slow(FakeCard):
        def advance(self, ticks: int) -> None:
            nonlocal spent_s
            super().advance(ticks)
            spent_s += 0.001 * ticks

    card = Slow()
    server = CardServer(card)
    server._now, server._work_s = (lambda: 1.01), (lambda: spent_s)
    server._pacer.start(1.0)
    server._catch_up()
    assert card.tick == 4, "steps of a millisecond of the card, of two ticks each"
    server._catch_up()
    assert card.tick == 4, "a host that is read meanwhile does not advance it again"
    server._worked_s = 0.0
    server._catch_up()
    assert card.tick == 8, "what is due is not lost"


def test_only_the_stamps_of_files_and_alarms_read_the_date() -> None:
    """Pacing, deadlines and time-outs take clocks that cannot be set."""
    source = Path(openacr.__file__).parent
    dated = re.compile(r"\btime\.time(_ns)?\(|\btime import .*\btime\b|datetime\.|\.localtime\(")
    found = {
        path.relative_to(source).as_posix()
        for path in source.rglob("*.py")
        if dated.search(path.read_text(encoding="utf-8"))
    }
    panel = {"panel/files.py", "panel/server/kept.py", "panel/server/calls/journals.py"}
    kernel = {"fieldbus/ethercat/emulated/port.py"}  # the kernel stamps frames with the date
    stamps = {"cli/run/journals.py", "mill/card/alarms.py", "bridge/clock.py"}
    assert found == stamps | panel | kernel
