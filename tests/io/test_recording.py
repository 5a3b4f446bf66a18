"""Sessions with a card: recorded by a proxy, given to another card, compared."""

import asyncio
import io
import json
import logging
import socket
from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest
from tests.io.sessions import HEAD, event, written

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.errors import StoreError
from openacr.io import proxy as module
from openacr.io.proxy import Proxy
from openacr.io.recorded_session import SessionRecorder, is_recording, read_recording
from openacr.io.server import CardServer, Guests
from openacr.io.session_replay import SessionReplay
from openacr.journal.entries import Entered, JournalEntry

OLD_HEAD = b'{"format": "openacr recording", "version": 1, "card": "c:5002", "kind": "terminal"}\n'

SESSION = (
    event(0.0, 1, Entered.OPEN),
    event(0.01, 1, Entered.BYTES, b"?1+1\r"),
    event(0.02, 1, Entered.SENT, b"?1+1\r\n2\r\nSYS>"),
    event(0.5, 1, Entered.BYTES, bytes(range(256))),
    event(0.6, 1, Entered.CLOSE),
)


def test_a_recording_is_read_as_it_was_written(tmp_path: Path) -> None:
    path = tmp_path / "s.jsonl"
    with path.open("wb", buffering=0) as file:
        recorder = SessionRecorder(file, "c:5002", StreamKind.PACKETS)
        recorder.note(1, Entered.OPEN)
        recorder.note(1, Entered.BYTES, bytes(range(256)))
        recorder.note(1, Entered.SENT, b"?1+1\r")
        recorder.note(1, Entered.CLOSE)
    found = read_recording(path)
    assert [(each.what, each.number, each.data) for each in found.entries] == [
        (Entered.OPEN, 1, b"packets"),
        (Entered.BYTES, 1, bytes(range(256))),
        (Entered.SENT, 1, b"?1+1\r"),
        (Entered.CLOSE, 1, b""),
    ]
    assert (found.header.card, found.is_whole, recorder.events) == ("c:5002", True, 4)
    assert is_recording(path)
    tick, *rest = json.loads(path.read_bytes().splitlines()[4])
    assert rest == ["sent", 1, "?1+1\r"]
    assert 0 <= found.time_s(found.entries[2]) == tick / 1e6 < 60


def test_a_recording_of_the_earlier_form_is_read(tmp_path: Path) -> None:
    path = tmp_path / "s.jsonl"
    path.write_bytes(
        OLD_HEAD.replace(b"terminal", b"serial")
        + b'{"t": 0.0, "c": 1, "what": "open"}\n'
        + b'{"t": 0.01, "c": 1, "what": "host", "data": "?1+1\\r"}\n'
        + b'{"t": 0.123457, "c": 1, "what": "card", "data": "\\u00ff"}\n'
        + b'{"t": 0.6, "c": 1, "what": "close"}\n{"t": 0.7'
    )
    found = read_recording(path)
    assert found.entries == (
        event(0.0, 1, Entered.OPEN, kind=StreamKind.SERIAL),
        event(0.01, 1, Entered.BYTES, b"?1+1\r"),
        event(0.123457, 1, Entered.SENT, b"\xff"),
        event(0.6, 1, Entered.CLOSE),
    )
    assert (found.header.card, found.is_whole) == ("c:5002", False)
    assert found.time_s(found.entries[2]) == 0.123457
    assert is_recording(path)


def test_a_recording_of_the_earlier_form_is_replayed(tmp_path: Path) -> None:
    path = tmp_path / "s.jsonl"
    path.write_bytes(
        OLD_HEAD
        + b'{"t": 0.0, "c": 1, "what": "open"}\n'
        + b'{"t": 0.25, "c": 1, "what": "host", "data": "?1+1\\r"}\n'
        + b'{"t": 0.4, "c": 1, "what": "card", "data": "?1+1\\r\\n3\\r\\nSYS>"}\n'
    )
    found = SessionReplay(Controller()).run(read_recording(path))
    assert found is not None
    assert (found.time_s, found.sent) == (0.25, b"?1+1\r")
    assert (found.recorded, found.replayed) == (b"3\r\n", b"2\r\n")


def test_a_last_line_that_is_cut_off_is_left_out(tmp_path: Path) -> None:
    path = written(tmp_path / "s.jsonl", *SESSION)
    path.write_bytes(path.read_bytes()[:-5])
    found = read_recording(path)
    assert found.entries == SESSION[:-1]
    assert not found.is_whole


OPENED = b'[0, "open", 1, "terminal", ""]\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (b"", "is not a journal"),
        (b"{}\n", "is not a journal"),
        (HEAD.replace(b"journal 1", b"journal 2"), "is not a journal"),
        (HEAD.split(b"\n")[0] + b"\n{}", "ends within its first record"),
        (HEAD.replace(b"card", b"cart"), "its first record cannot be read"),
        (HEAD + b"x\n", "line 3 is damaged"),
        (HEAD + b"[0]\n", "line 3 is damaged"),
        (HEAD + b'[0, "left", 1]\n', "line 3 is damaged"),
        (HEAD + OPENED + b'[0, "parameter", 1, 2.0]\n', "line 4 is damaged"),
        (HEAD + b'[0, "bytes", 1, "A"]\n', "line 3 is damaged: connection 1 is not open"),
        (HEAD + 2 * OPENED, "line 4 is damaged: connection 1 is opened twice"),
        (HEAD + OPENED.replace(b"0,", b"-1,"), "line 3 is damaged"),
        (HEAD + OPENED.replace(b"0,", b"10000000000001,"), "line 3 is damaged: the time is not"),
        (HEAD + OPENED.replace(b"0,", b"2,") + OPENED, "line 4 is damaged: the time is not"),
        (HEAD + OPENED + '[0, "sent", 1, "\u20ac"]\n'.encode(), "line 4 is damaged"),
        (OLD_HEAD.replace(b"1,", b"2,") + b"\n", "its first record cannot be read"),
        (OLD_HEAD + b"x\n", "line 2 is damaged"),
        (OLD_HEAD + b'{"t": 0}\n', "line 2 is damaged"),
        (OLD_HEAD + b'{"t": 0, "c": 1, "what": "left"}\n', "line 2 is damaged"),
        (OLD_HEAD + b'{"t": 0, "c": 1, "what": "host"}\n', "line 2 is damaged: connection 1"),
        (OLD_HEAD + b'{"t": NaN, "c": 1, "what": "open"}\n', "line 2 is damaged"),
        (OLD_HEAD + b'{"t": Infinity, "c": 1, "what": "open"}\n', "line 2 is damaged"),
        (OLD_HEAD + b'{"t": -1, "c": 1, "what": "open"}\n', "line 2 is damaged"),
        (OLD_HEAD + b'{"t": 0, "c": 1, "what": "open"}\n{"t": 1e9, "c": 1, "what": "close"}\n',
         "line 3 is damaged: the time is not"),
    ],
)  # fmt: skip
def test_what_is_wrong_in_a_recording_is_named_with_its_line(
    tmp_path: Path, text: bytes, said: str
) -> None:
    path = tmp_path / "s.jsonl"
    path.write_bytes(text)
    with pytest.raises(StoreError) as refused:
        read_recording(path)
    assert str(refused.value).replace(f"{path}: ", "").replace(f"{path} ", "").startswith(said)


def test_a_recording_is_no_journal_of_a_virtual_card(tmp_path: Path) -> None:
    with pytest.raises(StoreError, match="its first record cannot be read"):
        read_journal(written(tmp_path / "s.jsonl", *SESSION))


# --- replay -----------------------------------------------------------------------------


def replayed(
    tmp_path: Path, *events: JournalEntry, card: Controller | None = None
) -> SessionReplay:
    found = SessionReplay(card or Controller())
    found.run(read_recording(written(tmp_path / "s.jsonl", *events)))
    return found


def session(answer: bytes, *more: JournalEntry) -> tuple[JournalEntry, ...]:
    asked = event(0.01, 1, Entered.BYTES, b"?1+1\r")
    return (event(0.0, 1, Entered.OPEN), asked, event(0.4, 1, Entered.SENT, answer), *more)


def test_the_same_answers_in_other_pieces_and_at_other_times_are_the_same(tmp_path: Path) -> None:
    pieces = [
        event(0.4 + 0.1 * n, 1, Entered.SENT, bytes([b])) for n, b in enumerate(b"\r\n2\r\nSYS>")
    ]
    assert replayed(tmp_path, *session(b"?1+1"), *pieces).found == []


def test_the_first_answer_that_differs_is_reported_with_its_request(tmp_path: Path) -> None:
    more = (
        event(1.0, 1, Entered.BYTES, b"?2+2\r"),
        event(1.1, 1, Entered.SENT, b"?2+2\r\n5\r\nSYS>"),
        event(2.0, 1, Entered.BYTES, b"?3+3\r"),
        event(2.1, 1, Entered.SENT, b"?3+3\r\n7\r\nSYS>"),
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
        event(0.5, 2, Entered.OPEN),
        event(0.6, 2, Entered.BYTES, b"SET 40\r"),
        event(0.7, 2, Entered.SENT, b"SET 40\r\nSYS>"),
        event(0.8, 1, Entered.BYTES, b"?BIT40\r"),
        event(0.9, 2, Entered.CLOSE),
        event(0.9, 1, Entered.SENT, b"?BIT40\r\n-1\r\nSYS>"),
    )
    assert replayed(tmp_path, *session(b"?1+1\r\n2\r\nSYS>", *other)).found == []


def test_the_card_lives_as_long_as_the_recording(tmp_path: Path) -> None:
    card = Controller()
    replayed(tmp_path, event(0.0, 1, Entered.OPEN), event(2.5, 1, Entered.CLOSE), card=card)
    assert card.tick == 5000


# --- proxy ------------------------------------------------------------------------------

Talk = Callable[[Proxy, "tuple[str, int]"], Awaitable[None]]


def through_a_proxy(talk: Talk, file: io.BytesIO, guests: Guests | None = None) -> None:
    """Run a card, a proxy to it, and a host that gets the address of the proxy."""

    async def run() -> None:
        server, stop = CardServer(Controller()), asyncio.Event()
        card = await server.listen(StreamKind.TERMINAL, "127.0.0.1", 0)
        serving = asyncio.ensure_future(server.run(stop))
        recorder = SessionRecorder(file, str(card), StreamKind.TERMINAL)
        proxy = Proxy((card.host, card.port), recorder, guests or Guests())
        place = await proxy.listen("127.0.0.1", 0)
        try:
            await asyncio.wait_for(talk(proxy, (place.host, place.port)), 60)
        finally:
            await proxy.close()
            stop.set()
            await serving

    asyncio.run(run())


def events_of(file: io.BytesIO, folder: Path) -> tuple[JournalEntry, ...]:
    path = folder / "s.jsonl"
    path.write_bytes(file.getvalue())
    return read_recording(path).entries


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

    through_a_proxy(talk, file)
    events = events_of(file, tmp_path)
    hosts = [(each.number, each.data) for each in events if each.what is Entered.BYTES]
    assert hosts == [(1, b"?6*7\r"), (2, b"?BIT40\r")]
    cards = b"".join(each.data for each in events if each.what is Entered.SENT)
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
        recorder = SessionRecorder(io.BytesIO(), "c", StreamKind.TERMINAL)
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
    assert [each.what for each in events_of(file, tmp_path)] == [Entered.OPEN, Entered.CLOSE]


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
            if b'"bytes"' in data:
                raise OSError(28, "No space left on device")
            return super().write(data)

    file = Full()

    async def talk(proxy: Proxy, address: tuple[str, int]) -> None:
        assert await asked(address, b"?6*7") == b"?6*7\r\n42\r\nSYS>"

    through_a_proxy(talk, file)
    assert "the recording ends here: no space left on device; connections go on" in caplog.text
    assert b'"sent"' not in file.getvalue()


def test_a_recording_on_a_disk_that_gets_full_ends_with_a_whole_event(tmp_path: Path) -> None:
    class Small(io.FileIO):
        def write(self, data: bytes, /) -> int:  # type: ignore[override]
            free = 200 - self.tell()
            if not free:
                raise OSError(28, "No space left on device")
            return super().write(data[: min(free, 30)])  # in parts

    path = tmp_path / "a"
    with Small(path, "wb") as file:
        recorder = SessionRecorder(file, "c:5002", StreamKind.TERMINAL)
        recorder.note(1, Entered.OPEN)
        assert recorder.failure is None
        for answer in (b"?1+1\r", bytes(range(256)), b"no more"):
            recorder.note(1, Entered.SENT, answer)
        assert isinstance(recorder.failure, OSError)
        assert recorder.events == 2
    read = read_recording(path)
    assert (read.is_whole, [each.data for each in read.entries]) == (True, [b"terminal", b"?1+1\r"])


def test_a_card_that_cannot_be_reached_refuses_the_host(caplog: pytest.LogCaptureFixture) -> None:
    async def run() -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            gone = free.getsockname()
        recorder = SessionRecorder(io.BytesIO(), "c", StreamKind.TERMINAL)
        proxy = Proxy(gone, recorder, Guests())
        place = await proxy.listen("127.0.0.1", 0)
        reader, writer = await asyncio.open_connection(place.host, place.port)
        with pytest.raises((ConnectionError, asyncio.IncompleteReadError)):
            await reader.readexactly(1)
        writer.close()
        await proxy.close()
        assert recorder.events == 0

    asyncio.run(run())
    assert "cannot connect to 127.0.0.1:" in caplog.text
    assert module.CONNECTIONS == 16
