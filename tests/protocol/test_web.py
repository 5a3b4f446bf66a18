"""What a browser says first, in pieces of any size, and what hosts of a card say."""

import pytest

from openacr.protocol.web import Opening

BODY = b"\x18\r\nPROG0\r\nX100\r\n\x1c\x00\x02"
REQUESTS = [
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1:5002\r\n\r\n",
    b"GET /chat HTTP/1.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n\r\n",
    b"POST /x HTTP/1.1\r\nHost: h\r\n\r\n" + BODY,
    b"POST http://127.0.0.1:5002/ HTTP/1.1\r\n\r\n" + BODY,  # through a proxy
    b"POST /" + b"a" * 100_000 + b" HTTP/1.1\r\n\r\n" + BODY,
    b"OPTIONS * HTTP/1.0\r\n\r\n" + BODY,
    b"CONNECT 127.0.0.1:5002 HTTP/1.1\r\n\r\n" + BODY,
    b"X1 /Y2 HTTP/1.1\r\n\r\n" + BODY,  # a method of the page's own
    b"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n",
    b"PRI * HTTP/3\n",
    b"\r\n\r\nPOST / HTTP/1.1\r\n\r\n" + BODY,
    b"\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03" + BODY,  # https
]


@pytest.mark.parametrize("size", [1, 2, 3, 7, 1024, 1 << 20])
@pytest.mark.parametrize("request_bytes", REQUESTS, ids=lambda data: data[:16].decode("latin-1"))
def test_a_browser_is_known_before_any_line_packet_or_key_is_complete(
    request_bytes: bytes, size: int
) -> None:
    opening, passed = Opening(), b""
    for at in range(0, len(request_bytes), size):
        piece = request_bytes[at : at + size]
        if opening.is_web(piece):
            break
        passed += piece
    else:
        pytest.fail("not recognised")
    assert not any(byte < 0x20 for byte in passed.lstrip(b"\r\n").replace(b"\x16", b""))


@pytest.mark.parametrize("size", [1, 2, 3, 7, 1024])
@pytest.mark.parametrize(
    "data",
    [
        b"SYS\rVER\r",
        b"\rSYS\r? P0\r",
        b"PROG0\rREM GET / HTTP/1.1\r",  # not the first line
        b"GET\rPOST\r",
        b"PRINT HTTP/1.\r",
        b"PRINT HTTP/1.12\r",
        b"XHTTP/1.1\r",
        b"\x00\x88\x00\x20 HTTP/1.1\r",  # a packet, then text
        b"\x00\x30\x02\xff" * 50,
        b"\x16SYS\r",
        b"\x17\x03\x16\x03",
        b"\x03\x16\x03",
        b"\x18\x19\x1a",
        b"\x1b\r",
    ],
)
def test_what_hosts_of_a_card_say_is_nothing_of_the_kind(data: bytes, size: int) -> None:
    opening = Opening()
    pieces = [data[at : at + size] for at in range(0, len(data), size)]
    assert not any(opening.is_web(piece) for piece in pieces)


def test_an_opening_is_over_with_the_first_line_or_packet() -> None:
    opening = Opening()
    assert not opening.is_web(b"\r\nSY")
    assert not opening.is_over
    assert not opening.is_web(b"S\r")
    assert opening.is_over
    assert not opening.is_web(b"POST / HTTP/1.1\r\n\x16\x03")
