"""No server holds a call for ever, whatever it sends; seconds are those of its own clock."""

import asyncio
import socket
from collections.abc import Awaitable, Callable, Iterator
from contextlib import closing, contextmanager, suppress
from itertools import repeat
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Event, Thread

import pytest
from tests.client.hostile import (
    SERVERS,
    Behaviour,
    HostileLink,
    drips,
    drips_prompts,
    floods,
    floods_slowly,
    never_prompts,
    silent,
)

from openacr.channels import EchoMode
from openacr.client import AsyncCard, Card, ClientError, GarbledError, Level, NoReplyError, Options
from openacr.client.async_links import ThreadLink
from openacr.client.moves import MoveStream
from openacr.client.script import Script
from openacr.protocol.move import Move

TEXT = "PROGRAM\nDWL 1\nENDP\n"


def backup(card: Card) -> None:
    with TemporaryDirectory() as folder:
        card.backup(Path(folder) / "b")


def listen(card: Card) -> None:
    with closing(card.listen(0, run=True)) as heard:
        next(heard)


CALLS: dict[str, Callable[[Card], object]] = {
    "connect": lambda card: card.connect(),
    "command": lambda card: card.command("?1"),
    "go": lambda card: card.go(Level.program(5)),
    "ask": lambda card: card.ask("6*7"),
    "read": lambda card: card.read(4097),
    "read_many": lambda card: card.read_many([12288, 12290, 8192]),
    "write": lambda card: card.write(4097, 1),
    "download": lambda card: card.download(TEXT, to=Level.program(0)),
    "upload": lambda card: card.upload(Level.program(0)),
    "listen": listen,
    "send_moves": lambda card: card.send_moves([Move.of({0: 1.0})]),
    "backup": backup,
}


@pytest.mark.parametrize("is_known", [False, True], ids=["from the start", "after a while"])
@pytest.mark.parametrize("server", SERVERS, ids=lambda server: server.__name__)
@pytest.mark.parametrize("call", CALLS)
def test_no_server_holds_a_call_for_ever(call: str, server: Behaviour, is_known: bool) -> None:
    link = HostileLink()
    card = Card(link)
    if is_known:
        card.connect()
    link.behaviour, link.passed_s = server, 0.0
    with suppress(ClientError):  # what was asked for may come back by chance
        CALLS[call](card)
    assert link.passed_s < 4200 if server is floods_slowly else link.passed_s < 250


ASYNC_CALLS: dict[str, Callable[[AsyncCard], Awaitable[object]]] = {
    "connect": lambda card: card.connect(),
    "command": lambda card: card.command("?1"),
    "read_many": lambda card: card.read_many([12288, 12290, 8192]),
    "download": lambda card: card.download(TEXT, to=Level.program(0)),
    "upload": lambda card: card.upload(Level.program(0)),
    "send_moves": lambda card: card.send_moves([Move.of({0: 1.0})]),
}


@pytest.mark.parametrize("server", SERVERS, ids=lambda server: server.__name__)
@pytest.mark.parametrize("call", ASYNC_CALLS)
def test_no_server_holds_an_awaited_call_for_ever(call: str, server: Behaviour) -> None:
    async def body() -> None:
        card = AsyncCard(ThreadLink(link))
        await card.connect()
        link.behaviour, link.passed_s = server, 0.0
        with suppress(ClientError):
            await ASYNC_CALLS[call](card)
        link.behaviour = None
        await card.close()

    link = HostileLink()
    asyncio.run(body())
    assert link.passed_s < 4200 if server is floods_slowly else link.passed_s < 250


def turned(server: Behaviour, options: Options | None = None) -> tuple[Card, HostileLink]:
    """A card that was one until now."""
    link = HostileLink()
    card = Card(link, options)
    card.connect()
    link.behaviour, link.passed_s = server, 0.0
    return card, link


def test_silence_ends_a_call_after_the_time_out() -> None:
    card, link = turned(silent)
    with pytest.raises(NoReplyError, match=r"no reply within 5 s to \?1 ") as failed:
        card.command("?1")
    assert not failed.value.is_begun
    assert link.passed_s == pytest.approx(5.0)


def test_a_reply_that_drips_is_given_up_at_the_deadline() -> None:
    card, link = turned(drips, Options(deadline_s=20.0))
    with pytest.raises(
        NoReplyError, match=r"no end of the reply within 20\.02 s to \?1 "
    ) as failed:
        card.command("?1")
    assert failed.value.is_begun
    assert link.passed_s == pytest.approx(20.0 + 20 / 1024, abs=0.001)


def test_every_kib_of_a_reply_gives_a_second_more() -> None:
    card, link = turned(floods_slowly, Options(deadline_s=20.0))
    with pytest.raises(GarbledError):
        card.command("?1")
    assert link.passed_s == (1 << 22) // 1100 + 1  # not the deadline: more than 4 MiB

    card, link = turned(lambda sent: repeat((1.0, b"x" * 512)), Options(deadline_s=20.0))
    with pytest.raises(ClientError):
        card.command("?1")
    assert link.passed_s == pytest.approx(40.0, abs=1.0)


def test_a_longer_time_out_of_one_command_moves_its_deadline() -> None:
    card, link = turned(never_prompts, Options(deadline_s=20.0))
    with pytest.raises(NoReplyError):
        card.command("DWL 100", timeout_s=100.0)
    assert link.passed_s == pytest.approx(100.0, abs=1.0)


def test_without_a_deadline_only_silence_ends_a_call() -> None:
    card, link = turned(never_prompts, Options(deadline_s=None))
    with pytest.raises(AssertionError, match="held for ever"):
        card.command("?1")
    card, link = turned(never_prompts, Options(timeout_s=None))
    with pytest.raises(AssertionError, match="held for ever"):
        card.command("?1")
    assert link.passed_s > 10_000


@pytest.mark.parametrize("echo", [EchoMode.CHARACTERS, EchoMode.NO_PROMPT, EchoMode(0)])
def test_a_reply_of_more_than_4_mib_is_none(echo: EchoMode) -> None:
    card, link = turned(floods, Options(echo=echo))
    with pytest.raises(GarbledError, match=r"garbled reply to \?1"):
        card.command("?1")
    assert link.passed_s < 1


def test_what_looks_like_prompts_again_and_again_ends_at_the_deadline() -> None:
    card, link = turned(drips_prompts, Options(deadline_s=20.0))
    with pytest.raises(NoReplyError):
        card.command("?1")
    assert link.passed_s == pytest.approx(20.0, abs=1.0)


def test_a_followed_program_is_heard_in_time_even_if_its_echo_never_ends() -> None:
    link = HostileLink()
    card = Card(link)
    card.go(Level.program(0))
    link.behaviour, link.passed_s = (lambda sent: repeat((0.01, b"x"))), 0.0
    with suppress(NoReplyError), closing(card.listen(0, run=True)) as heard:
        assert next(heard) == ""
        assert link.passed_s == pytest.approx(0.25, abs=0.02)


def test_moves_that_never_start_end_a_stream_after_its_patience() -> None:
    link = HostileLink()
    card = Card(link)
    for line in ("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "MBUF ON", "DRIVE ON X"):
        card.command(line)
    card.write_bit("master0.feedhold request", True)
    stream = MoveStream(depth=2, stall_s=3.0)
    begin_s = card.now_s()
    with pytest.raises(NoReplyError, match=r"no reply within 3 s to moves \(none starts\)"):
        card.send_moves([Move.of({0: float(n)}) for n in range(20)], stream)
    assert 3.0 < card.now_s() - begin_s < 4.0


@pytest.mark.parametrize("line", [b"?1", b"ECHO 4", b"\x18"])
@pytest.mark.parametrize("server", [floods, drips, never_prompts, silent])
def test_no_server_holds_a_piped_terminal_for_ever(server: Behaviour, line: bytes) -> None:
    link = HostileLink(server)
    script = Script(link, lambda data: None, wait_s=10.0)
    try:
        script.run([line])
    except NoReplyError as failed:
        assert failed.sent == line.decode()
    assert link.passed_s < 15


@contextmanager
def dripping_server() -> Iterator[str]:
    """The address of a real socket that sends a byte again and again, in time."""

    def drip(listener: socket.socket) -> None:
        with suppress(OSError):
            far, _ = listener.accept()
            with far:
                while not is_over.wait(0.05):
                    far.sendall(b"x")

    is_over = Event()
    with socket.create_server(("127.0.0.1", 0)) as listener:
        thread = Thread(target=drip, args=(listener,))
        thread.start()
        yield f"127.0.0.1:{listener.getsockname()[1]}"
        is_over.set()
        thread.join()


DRIPPING = Options(timeout_s=0.2, deadline_s=0.3, reconnect_s=0.0)


def test_a_real_socket_that_drips_is_given_up_at_the_deadline() -> None:
    with dripping_server() as target, pytest.raises(NoReplyError, match="no end of the reply"):
        Card.open(target, DRIPPING)


def test_asyncio_gives_up_a_real_socket_that_drips() -> None:
    async def body() -> None:
        with pytest.raises(NoReplyError, match="no end of the reply"):
            await AsyncCard.open(target, DRIPPING)

    with dripping_server() as target:
        asyncio.run(body())
