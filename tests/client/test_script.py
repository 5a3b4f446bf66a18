"""A session without a person over a real connection."""

import socket

import pytest
from tests.io.fake_card import FakeCard
from tests.io.threaded import served

from openacr.client import ConnectionLostError, NoReplyError
from openacr.client.links import TcpLink, wire_to
from openacr.client.script import Script


def replies(lines: list[bytes], wait_s: float = 5.0) -> bytes:
    shown = bytearray()
    with served(FakeCard()) as at:
        link = wire_to(str(at))
        link.open()
        try:
            Script(link, shown.extend, wait_s).run(lines)
        finally:
            link.close()
    return bytes(shown)


def test_each_line_waits_for_the_prompt_of_the_one_before() -> None:
    assert replies([b"LEN 12", b"SLEEP 100", b"LEN"]) == (
        b"LEN 12\r\n6\r\nSYS>SLEEP 100\r\nok\r\nSYS>LEN\r\n3\r\nSYS>"
    )


def test_escape_ends_listening_and_its_prompt_is_awaited() -> None:
    assert replies([b"LISTEN", b"\x1b", b"LEN"]) == b"LISTEN\r\n\r\nSYS>LEN\r\n3\r\nSYS>"


def test_control_keys_expect_no_answer() -> None:
    assert replies([b"\x18\x19", b"LEN"]) == b"LEN\r\n3\r\nSYS>"


def test_with_prompts_off_silence_ends_a_reply() -> None:
    assert replies([b"ECHO 4", b"LEN"]).endswith(b"3\r\nSYS>")


def test_a_line_without_a_reply_is_an_error_after_the_wait() -> None:
    with pytest.raises(NoReplyError, match="SLEEP 100000"):
        replies([b"SLEEP 100000"], wait_s=0.2)


def test_a_closed_connection_is_distinguished_from_silence() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        link = TcpLink("127.0.0.1", listener.getsockname()[1])
        link.open()
        listener.accept()[0].close()
        with pytest.raises(ConnectionLostError, match="closed"):
            link.read(5.0)
        link.close()
