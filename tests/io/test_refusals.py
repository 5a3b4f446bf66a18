"""Refused connections in the log."""

import pytest

from openacr.io.refusals import LINES, Refusals


class Clock:
    now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def test_the_first_refusals_of_a_minute_have_a_line_each_the_others_are_counted(
    caplog: pytest.LogCaptureFixture,
) -> None:
    clock = Clock()
    refusals = Refusals(clock)
    for port in range(1000):
        refusals.note(f"10.0.0.7:{port}", "all streams are taken")
    first = [f"10.0.0.7:{port} refused: all streams are taken" for port in range(5)]
    assert [record.message for record in caplog.records] == first
    clock.now_s += 59.999
    refusals.note("10.0.0.8:1", "all streams are taken")
    assert len(caplog.records) == LINES
    clock.now_s += 0.001
    refusals.note("10.0.0.9:1", "not in the allowed networks")
    assert [record.message for record in caplog.records][LINES:] == [
        "996 more connections were refused",
        "10.0.0.9:1 refused: not in the allowed networks",
    ]


def test_a_minute_in_which_all_had_a_line_is_not_summed_up(
    caplog: pytest.LogCaptureFixture,
) -> None:
    clock = Clock()
    refusals = Refusals(clock)
    for _ in range(2):
        for port in range(5):
            refusals.note(f"10.0.0.7:{port}", "all streams are taken")
        clock.now_s += 60.0
    assert len(caplog.records) == 10
    assert not [record for record in caplog.records if "more" in record.message]
