"""Sessions with a card: recorded by a proxy, given to another card, compared."""

import asyncio
import io
import json
import logging
import socket
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.errors import SourceError
from openacr.io import proxy as module
from openacr.io.proxy import Proxy
from openacr.io.recording import Event, Recorder, What, is_recording, read_recording
from openacr.io.server import CardServer, Guests
from openacr.io.session_replay import SessionReplay

HEAD = b'{"format": "openacr recording", "version": 1, "card": "c:5002", "kind": "terminal"}\n'


def written(path: Path, *events: Event, kind: StreamKind = StreamKind.TERMINAL) -> Path:
    with path.open("wb") as file:
        recorder = Recorder(file, "c:5002", kind)
        for event in events:
            recorder.add(event)
    return path


SESSION = (
    Event(0.0, 1, What.OPEN),
    Event(0.01, 1, What.HOST, b"?1+1\r"),
    Event(0.02, 1, What.CARD, b"?1+1\r\n2\r\nSYS>"),
    Event(0.5, 1, What.HOST, bytes(range(256))),
    Event(0.6, 1, What.CLOSE),
)


def test_a_recording_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = written(tmp_path / "s.jsonl", *SESSION, kind=StreamKind.PACKETS)
    found = read_recording(path)
    assert found.events == SESSION
    assert (found.target, found.kind, found.is_whole) == ("c:5002", StreamKind.PACKETS, True)
    assert is_recording(path)
    line = path.read_text().splitlines()[2]
    assert json.loads(line) == {"t": 0.01, "c": 1, "what": "host", "data": "?1+1\r"}


def test_a_last_line_that_is_cut_off_is_left_out(tmp_path: Path) -> None:
    path = written(tmp_path / "s.jsonl", *SESSION)
    path.write_bytes(path.read_bytes()[:-5])
    found = read_recording(path)
    assert found.events == SESSION[:-1]
    assert not found.is_whole


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"", "1: not a recording of a session"),
        (b"{}\n", "1: not a recording of version 1"),
        (HEAD.replace(b"1,", b"2,"), "1: not a recording of version 1"),
        (HEAD + b"x\n", "2: not a line of a recording"),
        (HEAD + b'{"t": 0}\n', "2: not an event of a recording"),
        (HEAD + b'{"t": 0, "c": 1, "what": "left"}\n', "2: not an event of a recording"),
        (HEAD + b'{"t": 0, "c": 1, "what": "host"}\n', "2: connection 1 is not open"),
        (HEAD + 2 * b'{"t": 0, "c": 1, "what": "open"}\n', "3: connection 1 is opened twice"),
        (HEAD + b'{"t": NaN, "c": 1, "what": "open"}\n', "2: the time is not that of a next"),
        (HEAD + b'{"t": -1, "c": 1, "what": "open"}\n', "2: the time is not that of a next"),
        (
            HEAD + b'{"t": 2, "c": 1, "what": "open"}\n{"t": 1, "c": 1, "what": "close"}\n',
            "3: the time is not that of a next",
        ),
        (HEAD + '{"t": 0, "c": 1, "what": "open", "data": "\u20ac"}\n'.encode(), "2: not an event"),
    ],
)
def test_what_is_wrong_in_a_recording_is_named_with_its_line(
    tmp_path: Path, text: bytes, said: str
) -> None:
    path = tmp_path / "s.jsonl"
    path.write_bytes(text)
    with pytest.raises(SourceError) as refused:
        read_recording(path)
    assert str(refused.value).startswith(f"{path}:{said}")


# --- replay -----------------------------------------------------------------------------


def replayed(tmp_path: Path, *events: Event, card: Controller | None = None) -> SessionReplay:
    found = SessionReplay(card or Controller())
    found.run(read_recording(written(tmp_path / "s.jsonl", *events)))
    return found


def session(answer: bytes, *more: Event) -> tuple[Event, ...]:
    asked = Event(0.01, 1, What.HOST, b"?1+1\r")
    return (Event(0.0, 1, What.OPEN), asked, Event(0.4, 1, What.CARD, answer), *more)


def test_the_same_answers_in_other_pieces_and_at_other_times_are_the_same(tmp_path: Path) -> None:
    pieces = [
        Event(0.4 + 0.1 * n, 1, What.CARD, bytes([b])) for n, b in enumerate(b"\r\n2\r\nSYS>")
    ]
    assert replayed(tmp_path, *session(b"?1+1"), *pieces).found == []


def test_the_first_answer_that_differs_is_reported_with_its_request(tmp_path: Path) -> None:
    more = (
        Event(1.0, 1, What.HOST, b"?2+2\r"),
        Event(1.1, 1, What.CARD, b"?2+2\r\n5\r\nSYS>"),
        Event(2.0, 1, What.HOST, b"?3+3\r"),
        Event(2.1, 1, What.CARD, b"?3+3\r\n7\r\nSYS>"),
    )
    (found,) = replayed(tmp_path, *session(b"?1+1\r\n2\r\nSYS>", *more)).found
    assert (found.time_s, found.connection, found.sent) == (1.0, 1, b"?2+2\r")
    assert (found.recorded, found.replayed) == (b"5\r\n", b"4\r\n")


def test_an_answer_that_does_not_come_differs_and_one_too_many_at_the_end_does_not(
    tmp_path: Path,
) -> None:
    (found,) = replayed(tmp_path, *session(b"?1+1\r\n2\r\nSYS>Limit!\r\n")).found
    assert (found.recorded, found.replayed) == (b"SYS>Limit!\r\n", b"SYS>")
    assert replayed(tmp_path, *session(b"?1+1\r\n")).found == []


def test_connections_are_compared_each_by_itself(tmp_path: Path) -> None:
    other = (
        Event(0.5, 2, What.OPEN),
        Event(0.6, 2, What.HOST, b"SET 40\r"),
        Event(0.7, 2, What.CARD, b"SET 40\r\nSYS>"),
        Event(0.8, 1, What.HOST, b"?BIT40\r"),
        Event(0.9, 2, What.CLOSE),
        Event(0.9, 1, What.CARD, b"?BIT40\r\n-1\r\nSYS>"),
    )
    assert replayed(tmp_path, *session(b"?1+1\r\n2\r\nSYS>", *other)).found == []


def test_the_card_lives_as_long_as_the_recording(tmp_path: Path) -> None:
    card = Controller()
    replayed(tmp_path, Event(0.0, 1, What.OPEN), Event(2.5, 1, What.CLOSE), card=card)
    assert card.tick == 5000


# --- proxy ------------------------------------------------------------------------------

Talk = Callable[[Proxy, "tuple[str, int]"], Awaitable[None]]


def through_a_proxy(talk: Talk, file: io.BytesIO, guests: Guests | None = None) -> None:
    """Run a card, a proxy to it, and a host that gets the address of the proxy."""

    async def run() -> None:
        server, stop = CardServer(Controller()), asyncio.Event()
        card = await server.listen(StreamKind.TERMINAL, "127.0.0.1", 0)
        serving = asyncio.ensure_future(server.run(stop))
        recorder = Recorder(file, str(card), StreamKind.TERMINAL)
        proxy = Proxy((card.host, card.port), recorder, guests or Guests())
        place = await proxy.listen("127.0.0.1", 0)
        try:
            await asyncio.wait_for(talk(proxy, (place.host, place.port)), 60)
        finally:
            await proxy.close()
            stop.set()
            await serving

    asyncio.run(run())


def events_of(file: io.BytesIO, folder: Path) -> tuple[Event, ...]:
    path = folder / "s.jsonl"
    path.write_bytes(file.getvalue())
    return read_recording(path).events


async def asked(address: tuple[str, int], line: bytes) -> bytes:
    reader, writer = await asyncio.open_connection(*address)
    writer.write(line + b"\r")
    answer = await reader.readuntil(b"SYS>")
    writer.close()
    await writer.wait_closed()
    return answer


def test_the_proxy_passes_everything_on_and_the_recording_replays(tmp_path: Path) -> None:
    file = io.BytesIO()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        assert await asked(address, b"?6*7") == b"?6*7\r\n42\r\nSYS>"
        assert await asked(address, b"?BIT40") == b"?BIT40\r\n0\r\nSYS>"
        while file.getvalue().count(b'"close"') < 2:
            await asyncio.sleep(0.01)
        assert proxy.events == file.getvalue().count(b"\n") - 1

    through_a_proxy(talk, file)
    events = events_of(file, tmp_path)
    hosts = [(event.connection, event.data) for event in events if event.what is What.HOST]
    assert hosts == [(1, b"?6*7\r"), (2, b"?BIT40\r")]
    cards = b"".join(event.data for event in events if event.what is What.CARD)
    assert cards == b"?6*7\r\n42\r\nSYS>?BIT40\r\n0\r\nSYS>"
    assert replayed(tmp_path, *events).found == []


def test_a_host_that_is_reset_is_reset_at_the_card_at_once() -> None:
    file = io.BytesIO()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        host = socket.create_connection(address)
        while b'"open"' not in file.getvalue():
            await asyncio.sleep(0.01)
        host.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b"\1\0\0\0\0\0\0\0")
        host.close()
        while b'"close"' not in file.getvalue():
            await asyncio.sleep(0.01)

    through_a_proxy(talk, file)


def test_a_card_that_ends_ends_the_connection_of_the_host() -> None:
    async def run() -> None:
        async def greet(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            writer.write(b"bye")
            writer.close()

        card = await asyncio.start_server(greet, "127.0.0.1", 0)
        recorder = Recorder(io.BytesIO(), "c", StreamKind.TERMINAL)
        proxy = Proxy(card.sockets[0].getsockname(), recorder, Guests())
        place = await proxy.listen("127.0.0.1", 0)
        reader, writer = await asyncio.open_connection(place.host, place.port)
        assert await asyncio.wait_for(reader.read(), 30) == b"bye"
        writer.close()
        await proxy.close()
        card.close()

    asyncio.run(run())


def test_a_web_page_does_not_reach_the_card(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = io.BytesIO()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        reader, writer = await asyncio.open_connection(*address)
        writer.write(b"POST / HTTP/1.1\r\n\r\nP0=1\r")
        with pytest.raises((ConnectionError, asyncio.IncompleteReadError)):
            await reader.readexactly(1)
        writer.close()

    with caplog.at_level(logging.WARNING):
        through_a_proxy(talk, file)
    assert "it speaks HTTP or TLS" in caplog.text
    assert [event.what for event in events_of(file, tmp_path)] == [What.OPEN, What.CLOSE]


def test_a_host_of_another_network_is_refused(caplog: pytest.LogCaptureFixture) -> None:
    file = io.BytesIO()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        reader, writer = await asyncio.open_connection(*address)
        with pytest.raises((ConnectionError, asyncio.IncompleteReadError)):
            await reader.readexactly(1)
        writer.close()

    guests = Guests(Guests.of("10.0.0.0/8").networks[:1])
    through_a_proxy(talk, file, guests)
    assert b'"open"' not in file.getvalue()
    assert "127.0.0.1 refused" in caplog.text


def test_a_full_disk_ends_the_recording_and_not_the_connection(
    caplog: pytest.LogCaptureFixture,
) -> None:
    class Full(io.BytesIO):
        def write(self, data: bytes, /) -> int:  # type: ignore[override]
            if b'"host"' in data:
                raise OSError(28, "No space left on device")
            return super().write(data)

    file = Full()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        assert await asked(address, b"?6*7") == b"?6*7\r\n42\r\nSYS>"

    through_a_proxy(talk, file)
    assert "the recording ends here: no space left on device; connections go on" in caplog.text
    assert b'"card"' not in file.getvalue().split(b"\n", 1)[1]


def test_a_recording_on_a_disk_that_gets_full_ends_with_a_whole_event(tmp_path: Path) -> None:
    class Small(io.FileIO):
        def write(self, data: bytes, /) -> int:  # type: ignore[override]
            free = 200 - self.tell()
            if not free:
                raise OSError(28, "No space left on device")
            return super().write(data[: min(free, 30)])  # in parts

    path = tmp_path / "a"
    with Small(path, "wb") as file:
        recorder = Recorder(file, "c:5002", StreamKind.TERMINAL)
        recorder.add(SESSION[0])
        assert recorder.failure is None
        with pytest.raises(OSError, match="No space left"):
            for event in SESSION[1:]:
                recorder.add(event)
        assert recorder.failure is not None
    read = read_recording(path)
    assert (read.is_whole, read.events) == (True, SESSION[:2])


def test_a_card_that_cannot_be_reached_refuses_the_host(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    async def run() -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            gone = free.getsockname()
        recorder = Recorder(io.BytesIO(), "c", StreamKind.TERMINAL)
        proxy = Proxy(gone, recorder, Guests())
        place = await proxy.listen("127.0.0.1", 0)
        reader, writer = await asyncio.open_connection(place.host, place.port)
        with pytest.raises((ConnectionError, asyncio.IncompleteReadError)):
            await reader.readexactly(1)
        writer.close()
        await proxy.close()
        assert proxy.events == 0

    asyncio.run(run())
    assert "cannot connect to 127.0.0.1:" in caplog.text
    assert module.CONNECTIONS == 16
