"""Frames through python-can: what is taken, what is lost, what is said of the bus."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest
from tests.waiting import LIMIT_S, until

from openacr.errors import UserError
from openacr.fieldbus.canopen.frames import Frame, Trouble
from openacr.io import can_link
from openacr.io.can_link import CanLink

can = pytest.importorskip("can", reason="python-can is not installed")


@contextmanager
def pair(channel: str) -> Iterator[tuple[CanLink, Any]]:
    """A link, and the other end as python-can has it."""
    with can.Bus(interface="virtual", channel=channel) as other:
        link = CanLink("virtual", channel, 125)
        try:
            yield link, other
        finally:
            link.close()


def message(identifier: int, data: bytes = b"", **keys: bool) -> Any:
    return can.Message(arbitration_id=identifier, data=data, is_extended_id=False, **keys)


def taken(link: CanLink, count: int) -> list[Frame]:
    frames: list[Frame] = []

    def are_there() -> bool:
        frames.extend(link.take())
        return len(frames) >= count

    until(are_there)
    return frames


def test_frames_go_both_ways_in_their_order() -> None:
    with pair("both") as (link, other):
        assert link.send(Frame(0x203, b"\1\2")) and link.send(Frame(0x703, is_remote=True))
        first, second = other.recv(LIMIT_S), other.recv(LIMIT_S)
        assert (first.arbitration_id, bytes(first.data)) == (0x203, b"\1\2")
        assert (first.is_extended_id, first.is_remote_frame) == (False, False)
        assert (second.arbitration_id, second.is_remote_frame) == (0x703, True)
        other.send(can.Message(arbitration_id=0x183, data=b"x", is_extended_id=True))
        other.send(message(0x183, b"\5"))
        other.send(message(0x184, is_remote_frame=True))
        assert taken(link, 2) == [Frame(0x183, b"\5"), Frame(0x184, is_remote=True)]
        assert link.take() == [] and link.trouble() == Trouble()


def test_a_flood_is_bounded_and_what_was_lost_is_counted_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(can_link, "MOST_WAITING", 10)
    with pair("flood") as (link, other):
        for number in range(25):
            other.send(message(0x100 + number))
        lost = 0

        def all_arrived() -> bool:
            nonlocal lost
            lost += link.trouble().lost
            return lost == 15

        until(all_arrived)
        assert [frame.id for frame in link.take()] == list(range(0x100, 0x10A))
        assert link.trouble() == Trouble()


def test_a_flood_of_others_takes_no_room_where_only_some_are_listened_to(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(can_link, "MOST_WAITING", 10)
    with pair("others") as (link, other):
        link.listen({0x183, 0x703})
        for number in range(25):
            other.send(message(0x100 + number))
        other.send(message(0x703))
        assert taken(link, 1) == [Frame(0x703)]
        assert link.trouble() == Trouble()
        assert link.reopen() == ""  # still only those
        other.send(message(0x100))
        other.send(message(0x183))
        assert taken(link, 1) == [Frame(0x183)]
        link.listen(None)
        other.send(message(0x100))
        assert taken(link, 1) == [Frame(0x100)]


@pytest.mark.parametrize(
    ("kind", "detail", "seen"),
    [
        (0x04, 0x04, Trouble(errors=96)),  # warning, receiver
        (0x04, 0x20, Trouble(errors=96)),  # passive, sender
        (0x04, 0x01, Trouble(is_overrun=True)),
        (0x40, 0x00, Trouble(errors=256)),
    ],
)
def test_error_frames_of_linux_are_understood(kind: int, detail: int, seen: Trouble) -> None:
    with pair("errors") as (link, other):
        other.send(message(kind, bytes((0, detail, 0, 0, 0, 0, 0, 0)), is_error_frame=True))
        found = [Trouble()]

        def is_there() -> bool:
            found.append(link.trouble())
            return found[-1] != Trouble()

        until(is_there)
        assert found[-1] == seen
        assert link.trouble() == Trouble(errors=seen.errors), "the counter stays"
        other.send(message(0x100 if kind == 0x40 else 0x04, bytes((0, 0x40)), is_error_frame=True))
        until(lambda: link.trouble().errors == 0)


def test_a_bus_off_is_not_ended_by_a_late_warning() -> None:
    with pair("off") as (link, other):
        for kind, detail in ((0x40, 0), (0x04, 0x04), (0x04, 0x40)):
            other.send(message(kind, bytes((0, detail)), is_error_frame=True))
        other.send(message(0x1))
        taken(link, 1)
        assert link.trouble().errors == 256
        assert link.reopen() == ""
        assert link.trouble() == Trouble()


class Broken:
    """A bus whose driver fails."""

    def recv(self, wait_s: float) -> None:
        raise OSError(19, "No such device")

    def set_filters(self, filters: object) -> None:
        """Nothing is left out by it."""

    def send(self, sent: Any, timeout: float) -> None:
        raise can.CanOperationError("transmit buffer full")

    def shutdown(self) -> None:
        raise OSError(19, "No such device")


def test_an_interface_that_is_gone_is_noticed_and_can_come_back(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    with pair("gone") as (link, other):
        monkeypatch.setattr(can, "Bus", lambda **_: Broken())
        assert link.reopen() == ""
        assert not link.send(Frame(0x80))
        until(lambda: link.trouble().failure == "No such device")

        def cannot(**_: object) -> None:
            raise OSError(19, "No such device")

        monkeypatch.setattr(can, "Bus", cannot)
        assert link.reopen() == "No such device"
        assert not link.send(Frame(0x80)) and link.take() == []
        monkeypatch.undo()
        assert link.reopen() == ""
        assert link.send(Frame(0x80)) and other.recv(LIMIT_S).arbitration_id == 0x80


class Deaf(Broken):
    """A bus that takes frames; reading fails but for some times."""

    def __init__(self, readable: int = 0, each: int = 0) -> None:
        self._readable, self._each, self._reads = readable, each, 0

    def recv(self, wait_s: float) -> None:
        self._reads += 1
        if self._readable and self._reads % self._each == 0:
            self._readable -= 1
            return
        super().recv(wait_s)

    def send(self, sent: Any, timeout: float) -> None:
        """It is taken."""


def test_a_bus_that_cannot_be_read_takes_no_frames(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(can, "Bus", lambda **_: Deaf())
    link = CanLink("virtual", "deaf", 125)
    until(lambda: bool(link.trouble().failure))
    assert not link.send(Frame(0x80))
    link.close()


def test_failures_are_counted_in_a_row(monkeypatch: pytest.MonkeyPatch) -> None:
    bus = Deaf(readable=5, each=10)
    monkeypatch.setattr(can, "Bus", lambda **_: bus)
    link = CanLink("virtual", "deaf", 125)
    until(lambda: bool(link.trouble().failure))
    assert bus._reads == 60  # nine failures and a success, five times, then ten
    link.close()


def test_what_cannot_be_opened_is_named() -> None:
    with pytest.raises(UserError, match=r"^CAN can7: .*no-such-thing"):
        CanLink("no-such-thing", "can7", 125)


def test_without_python_can_the_extra_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "can", None)
    with pytest.raises(UserError, match=r"pip install 'openacr\[can\]'"):
        CanLink("virtual", "x", 125)


@pytest.mark.parametrize(
    ("channel", "options"),
    [
        ("239.74.163.2", {"channel": "239.74.163.2"}),
        ("239.74.163.2:5000", {"channel": "239.74.163.2", "port": 5000}),
        ("ff15::7", {"channel": "ff15::7"}),
        (None, {}),
    ],
)
def test_multicast_stays_on_this_computer(
    channel: str | None, options: dict[str, object], monkeypatch: pytest.MonkeyPatch
) -> None:
    given: dict[str, object] = {}
    monkeypatch.setattr(can, "Bus", lambda **keys: given.update(keys) or Broken())
    CanLink("udp_multicast", channel, 500).close()
    fixed = {"interface": "udp_multicast", "bitrate": 500_000, "hop_limit": 0, "fd": False}
    assert given == fixed | options
