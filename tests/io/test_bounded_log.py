"""What hosts can make the log say, again and again, is written a few times and counted."""

import logging

import pytest

from openacr.io.bounded_log import LINES, Bounded, bounded

LOG = logging.getLogger("openacr.test_bounded_log")


class Clock:
    now_s = 100.0

    def __call__(self) -> float:
        return self.now_s


def messages(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [record.getMessage() for record in caplog.records]


def test_the_first_lines_of_a_minute_are_written_the_others_are_counted(
    caplog: pytest.LogCaptureFixture,
) -> None:
    clock = Clock()
    with bounded(clock, LOG):
        for port in range(1000):
            LOG.warning("%s refused", port)
        assert messages(caplog) == [f"{port} refused" for port in range(LINES)]
        clock.now_s += 59.999
        LOG.warning("%s refused", "x")
        assert len(caplog.records) == LINES
        clock.now_s += 0.001
        LOG.warning("%s refused", "y")
        LOG.warning("%s refused", "z")
        assert messages(caplog)[LINES:] == ["y refused (and 996 times more before)", "z refused"]


def test_a_minute_in_which_all_were_written_is_not_summed_up(
    caplog: pytest.LogCaptureFixture,
) -> None:
    clock = Clock()
    with bounded(clock, LOG):
        for _ in range(2):
            for port in range(LINES):
                LOG.warning("%s refused", port)
            clock.now_s += 60.0
    assert messages(caplog) == 2 * [f"{port} refused" for port in range(LINES)]


def test_each_kind_of_line_is_counted_by_itself(caplog: pytest.LogCaptureFixture) -> None:
    with bounded(Clock(), LOG):
        for _ in range(10):
            LOG.warning("%s refused", 1)
            LOG.warning("%s does not read", 1)
    assert messages(caplog) == LINES * ["1 refused", "1 does not read"]


def test_the_limit_ends_with_its_block(caplog: pytest.LogCaptureFixture) -> None:
    with pytest.raises(KeyError), bounded(Clock(), LOG):
        raise KeyError
    for _ in range(10):
        LOG.warning("again")
    assert len(caplog.records) == 10
    assert not [each for each in LOG.filters if isinstance(each, Bounded)]
