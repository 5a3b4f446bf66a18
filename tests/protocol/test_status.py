"""The status service over UDP, sans sockets."""

import struct

import pytest

from openacr.protocol.status import (
    LIFE_S,
    SUBSCRIBERS,
    FastStatus,
    StatusRequest,
    Subscribers,
)

HOST = ("10.0.0.7", 40000)
ON = StatusRequest(is_on=True, interval_ms=10)
OFF = StatusRequest(is_on=False)


def times(subscribers: Subscribers, until_s: float, *connected: str) -> list[float]:
    """When datagrams are due, asked every millisecond."""
    due = []
    for step in range(round(until_s * 1000) + 1):
        found = list(subscribers.due(step / 1000, set(connected)))
        due += [step / 1000] * len(found)
    return due


@pytest.mark.parametrize(
    ("data", "request_"),
    [
        (bytes.fromhex("00000001 0000000A"), StatusRequest(is_on=True, interval_ms=10)),
        (bytes.fromhex("00000001 00000102"), StatusRequest(is_on=True, interval_ms=258)),
        (bytes.fromhex("01000000 0000000A"), StatusRequest(is_on=True, interval_ms=10)),
        (bytes.fromhex("00000000 00000000"), StatusRequest(is_on=False, interval_ms=0)),
        (bytes.fromhex("00000000 0000000A"), StatusRequest(is_on=False, interval_ms=10)),
        (b"", None),
        (bytes(7), None),
        (bytes(9), None),
    ],
)
def test_a_request_is_two_words_high_byte_first(data: bytes, request_: StatusRequest) -> None:
    assert StatusRequest.decode(data) == request_


def test_requests_are_encoded_as_hosts_of_real_cards_send_them() -> None:
    assert ON.encode() == bytes.fromhex("00000001 0000000A")
    assert OFF.encode() == bytes(8)


def test_a_datagram_is_eighty_words_high_byte_first() -> None:
    words = tuple(range(1, 81))
    data = FastStatus(words).encode()
    assert len(data) == 320
    assert data[:8] == bytes.fromhex("00000001 00000002")
    assert data[-4:] == bytes.fromhex("00000050")
    assert FastStatus.decode(data) == FastStatus(words)
    assert FastStatus.decode(data[:-1]) is None
    assert FastStatus.decode(data + b"\0") is None
    assert FastStatus().encode() == bytes(320)


def test_a_group_is_eight_words_as_long_or_fp32() -> None:
    data = b"".join(struct.pack(">8i", *range(-8 * n, -8 * n - 8, -1)) for n in range(9))
    data += struct.pack(">8f", *(0.5 * n - 1 for n in range(8)))
    status = FastStatus.decode(data)
    assert status is not None
    assert status.longs(0) == (0, -1, -2, -3, -4, -5, -6, -7)
    assert status.longs(8) == tuple(range(-64, -72, -1))
    assert status.floats(9) == (-1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 2.0, 2.5)


def test_a_subscriber_gets_a_datagram_every_interval_and_none_for_the_request_itself() -> None:
    subscribers = Subscribers()
    assert subscribers.take(ON, HOST, 0.0)
    assert times(subscribers, 0.055) == [0.01, 0.02, 0.03, 0.04, 0.05]


@pytest.mark.parametrize(
    ("asked_ms", "every_s"),
    [(0, 0.01), (9, 0.01), (11, 0.011), (250, 0.25), (60_000, 60.0), (0xFFFFFFFF, 60.0)],
)
def test_the_interval_is_ten_milliseconds_to_a_minute(asked_ms: int, every_s: float) -> None:
    subscribers = Subscribers()
    subscribers.take(StatusRequest(is_on=True, interval_ms=asked_ms), HOST, 0.0)
    assert list(subscribers.due(every_s - 0.0005, set())) == []
    assert list(subscribers.due(every_s + 0.0005, {HOST[0]})) == [HOST]


def test_intervals_that_were_missed_are_not_made_up_for() -> None:
    subscribers = Subscribers()
    subscribers.take(ON, HOST, 0.0)
    assert list(subscribers.due(0.0345, set())) == [HOST]
    assert list(subscribers.due(0.0395, set())) == []
    assert list(subscribers.due(0.0405, set())) == [HOST]


def test_zero_ends_a_subscription_of_its_sender_alone() -> None:
    subscribers = Subscribers()
    other = (HOST[0], HOST[1] + 1)
    subscribers.take(ON, HOST, 0.0)
    subscribers.take(ON, other, 0.0)
    assert subscribers.take(OFF, HOST, 0.0)
    assert subscribers.take(OFF, ("10.0.0.8", 1), 0.0)
    assert list(subscribers.due(0.015, set())) == [other]


def test_a_subscription_ends_a_minute_after_its_last_request() -> None:
    subscribers = Subscribers()
    subscribers.take(StatusRequest(is_on=True, interval_ms=1000), HOST, 0.0)
    subscribers.take(StatusRequest(is_on=True, interval_ms=1000), HOST, 5.0)
    assert list(subscribers.due(LIFE_S + 5.0, set())) == [HOST]
    assert list(subscribers.due(LIFE_S + 5.001, set())) == []
    assert len(subscribers) == 0


def test_a_subscription_of_a_connected_host_goes_on_and_ends_a_minute_after_it_left() -> None:
    subscribers = Subscribers()
    subscribers.take(StatusRequest(is_on=True, interval_ms=1000), HOST, 0.0)
    assert list(subscribers.due(500.0, {HOST[0], "10.0.0.8"})) == [HOST]
    assert list(subscribers.due(500.0 + LIFE_S, {"10.0.0.8"})) == [HOST]
    assert list(subscribers.due(501.0 + LIFE_S, {"10.0.0.8"})) == []
    assert len(subscribers) == 0


def test_asking_again_and_again_gives_no_more_datagrams() -> None:
    subscribers = Subscribers()
    sent = 0
    for step in range(1000):
        subscribers.take(ON, HOST, step / 1000)
        sent += len(list(subscribers.due(step / 1000, set())))
    assert sent == 99
    for step in range(1000, 2000):  # ending and beginning neither
        subscribers.take(OFF, HOST, step / 1000)
        subscribers.take(ON, HOST, step / 1000)
        sent += len(list(subscribers.due(step / 1000, set())))
    assert sent == 99


def test_another_interval_counts_from_the_last_datagram() -> None:
    subscribers = Subscribers()
    subscribers.take(ON, HOST, 0.0)
    assert list(subscribers.due(0.01, set())) == [HOST]
    subscribers.take(StatusRequest(is_on=True, interval_ms=50), HOST, 0.015)
    assert list(subscribers.due(0.0595, set())) == []
    assert list(subscribers.due(0.0605, set())) == [HOST]


def test_there_are_sixteen_subscribers_at_most() -> None:
    subscribers = Subscribers()
    for n in range(SUBSCRIBERS):
        assert subscribers.take(ON, ("10.0.0.7", n), 0.0)
    assert not subscribers.take(ON, ("10.0.0.7", 16), 0.0)
    assert subscribers.take(ON, ("10.0.0.7", 3), 0.0)
    assert len(subscribers) == SUBSCRIBERS == 16
    subscribers.take(OFF, ("10.0.0.7", 3), 0.0)
    assert subscribers.take(ON, ("10.0.0.7", 16), 0.0)
