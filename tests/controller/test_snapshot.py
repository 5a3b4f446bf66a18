"""Snapshots in a file: complete, and safe to read from a stranger."""

import random
import zlib
from collections.abc import Callable

import pytest
from msgspec import msgpack
from msgspec.structs import replace
from tests.controller.hosts import Host, at_axes, store
from tests.parity.journeys import WORLD
from tests.search import examples

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.controller import snapshot_file as snapshot
from openacr.controller.snapshot import Snapshot
from openacr.errors import StoreError
from openacr.plant.describe.load import parse_world
from openacr.protocol.move import Move


def busy_host() -> Host:
    """Axes that move, a program that waits, a line half typed, a packet half sent."""
    host = at_axes()
    store(host, "_L", "PRINT P0", "P0 = P0 + 1", "DWL 0.05", "GOTO L")
    host.type("SYS", "DIM P(10)", "FLASH SAVE", "ESAVE", "PROG0", "RUN", "X30 Y-10", "X0")
    host.card.advance(50)
    host.send("LRUN\r\x1bPRINT 1")
    return host


def test_a_card_from_a_file_goes_on_as_the_one_it_was_taken_from() -> None:
    host = busy_host()
    other = Host(host.card)
    host.card.receive(other.stream, b"?P0:DWL 0.1\r?P1\r\x00\x18")
    data = snapshot.encode(host.card.snapshot())
    assert len(data) < 100_000
    again = Controller("ACR9000")
    again.take_over(snapshot.decode(data))
    assert again.digest() == host.card.digest()
    assert again.lived_tk == host.card.lived_tk
    for card in (host.card, again):
        card.advance(300)
        card.receive(other.stream, b"\x00\x01")
        card.receive(host.stream, b"+1\rLIST\r")
        card.advance(3000)
    heard = [_heard(card, host.stream, other.stream) for card in (host.card, again)]
    assert heard[0][0].endswith(heard[1][0])
    assert "+1|2|P00>" in heard[1][0]
    assert heard[0][1].endswith(heard[1][1])
    assert again.digest() == host.card.digest()
    for card in (host.card, again):
        card.receive(host.stream, b"HALT ALL\rREBOOT\r")
        card.advance(100)
    assert again.digest() == host.card.digest()
    assert not again.system.programs.is_empty(0)


def _heard(card: Controller, *streams: int) -> list[str]:
    found = []
    for stream in streams:
        data = b""
        while part := card.take_output(stream):
            data += part
        found.append(data.decode("latin-1").replace("\r\n", "|"))
    return found


def test_a_card_returns_to_what_was_stored() -> None:
    card = Controller()
    card.send("AXIS0 PPU 5\rESAVE\r")
    before = card.snapshot()
    card.send("AXIS0 PPU 6\rESAVE\r")
    card.restore(before)
    card.send("REBOOT\r")
    assert card.send("AXIS0 PPU\r").splitlines()[1] == "5"


def test_a_battery_that_was_reset_stays_so() -> None:
    first, second = Controller("ACR8020"), Controller("ACR8020")
    first.send("PROG0\r10 PRINT 1\rSYS\rBRESET\r")
    second.take_over(snapshot.decode(snapshot.encode(first.snapshot())))
    for card in (first, second):
        card.send("REBOOT\r")
        assert card.system.programs.is_empty(0)
    assert first.digest() == second.digest()


def test_a_battery_that_was_reset_acts_again_in_a_state_from_before() -> None:
    card = Controller("ACR8020")
    before = card.snapshot()
    for _ in range(2):
        card.send("BRESET\rREBOOT\r")
        card.take_over(before)
        card.send("PROG0\r10 PRINT 1\rSYS\rREBOOT\r")
        assert not card.system.programs.is_empty(0)
        card.take_over(before)


# text


def twin(card: Controller) -> Controller:
    """Another card made of a snapshot in a file."""
    again = Controller(card.model, world=card.world)
    again.take_over(snapshot.decode(snapshot.encode(card.snapshot())))
    assert again.image() == card.image()
    return again


def agree(first: Controller, second: Controller, ticks: int) -> None:
    for tick in range(0, ticks, 4):
        for card in (first, second):
            card.advance(4)
        assert first.digest() == second.digest(), tick


def test_a_line_keeps_the_meaning_it_had_when_it_was_entered() -> None:
    """Aliases given anew and axes detached since then change no stored line, here as there."""
    host = at_axes()
    host.type("SYS", "DIM P(10)", "DIM PROG1(4000)", "DIM DEF(4)", "#DEFINE Inner 2")
    host.type("#DEFINE Cell P(Inner)")
    host.type("#DEFINE Same Cell", "PROG0")
    store(host, "Cell = 5", "Same = Same + 1", "X(Inner)")
    host.type("SYS", "#DEFINE Inner 3", "#DEFINE Cell P4")
    fill(host, 1, "Cell = 8", "Same = Same + 10")
    host.type("PROG0", "DETACH", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS1 "Z"')
    again = twin(host.card)
    for card in (host.card, again):
        card.receive(host.stream, b"SYS\rDEF\r?P2;P4\rRUN PROG1\r")
        card.advance(50)
        card.receive(host.stream, b"?P2;P4\rRUN PROG0\r")
        card.advance(50)
        card.receive(host.stream, b"?P2;P4\rPROG0\rLIST\rPROG1\rLIST\r")
    assert _heard(again, host.stream) == _heard(host.card, host.stream)
    assert (host.card.p[2], host.card.p[4]) == (6.0, 8.0)
    assert again.digest() == host.card.digest()


def test_a_program_goes_on_as_it_was_started_though_its_text_has_changed() -> None:
    host = at_axes()
    store(host, "_L", "P0 = P0 + 1", "DWL 0.01", "GOTO L")
    host.type("SYS", "DIM P(4)", "PROG0", "RUN")
    host.card.advance(30)
    host.type("20 P0 = P0 + 100")
    again = twin(host.card)
    agree(host.card, again, 200)
    assert 0 < host.card.p[0] < 50
    for card in (host.card, again):
        card.receive(host.stream, b"HALT\rLIST\r")
    assert " P0 = P0+100|" in _heard(host.card, host.stream)[0]


def test_code_that_was_made_for_arguments_meanwhile_does_not_show() -> None:
    """A restored card compiles expressions of arguments again, in another order."""
    host = at_axes()
    sums = "+".join(f"P{place}*{place}" for place in range(20))
    texts = [f"ACC (1+{sums}) : DWL 0.001" for _ in range(40)]
    store(host, "_L", *texts, "GOTO L")
    host.type("SYS", "DIM P(30)", "PROG0", "RUN")
    for _ in range(4):
        host.card.advance(9)
        agree(host.card, twin(host.card), 60)


def fill(host: Host, program: int, *lines: str) -> None:
    host.type(f"PROG{program}", "PROGRAM", *lines, "ENDP")


def in_every_wait() -> Host:
    """Programs that wait for times, flags, positions, input and room for moves; a PLC scans."""
    host = at_axes()
    card = host.card
    host.type("SYS", "DIM P(20)", "DIM PLC0(60)", "DIM PROG2(9000)", "DIM PROG3(9000)", "PROG0")
    store(host, "_L", "X/1", "X/-1", "DWL (0.002 + P9 * 0.001)", "GOTO L")
    fill(host, 1, "_A", "INH 40", "INH -40", "P1 = P1 + 1", "GOTO A")
    fill(host, 2, "DIM $V(2,40)", "_A", "INPUT $V0", "P2 = P2 + LEN($V0)", "GOTO A")
    fill(
        host, 3,
        "_A", "FOR P3 = 1 TO 4", "GOSUB S", "NEXT", "IHPOS P12290 (2000,0.05)", "GOTO A",
        "_S", "WHILE (P4 < P3 * 40)", "P4 = P4 + 1 : P5 = RND(9)", "WEND", "P4 = 0", "RETURN",
    )  # fmt: skip
    host.type("PLC0", "10 LD BIT 40", "20 TIM 0 30", "30 LD TIM 0", "40 OUT BIT 41", "RUN")
    host.type("SYS", "RUN PROG0", "RUN PROG1", "RUN PROG3", "PROG2")
    host.send("LRUN\r")
    card.advance(20)
    return host


@pytest.mark.search
def test_a_card_that_waits_for_everything_goes_on_as_if_undisturbed() -> None:
    host, chance = in_every_wait(), random.Random(5)
    card = host.card
    typist, serial = Host(card), Host(card, StreamKind.SERIAL)
    packets = Host(card, StreamKind.PACKETS)
    serial.send("MODE 3\r")
    traffic = [
        (host, b"some text\r"), (host, b"half"), (host, b"\x08 line\r"),
        (typist, b"?P1:DWL 0.01:?P2 : PROG1 : DWL 0.003 : ?P3\r"), (typist, b"?P"),
        (typist, b"DWL 0.02\r?1\r?2\r" + b"x" * 300 + b"\r"), (typist, b"\xff\xc3\r"),
        (serial, b"\x00#"), (serial, b"p\x02#C"), (serial, b"\x13?1\r"), (serial, b"\x11"),
        (packets, b"\x00\x30"), (packets, b"\x02\xff"),
        (host, b"\x1bHALT PROG3\r"), (host, b"RUN PROG3\rPROG2\rLISTEN\r"),
    ]  # fmt: skip
    for _ in range(examples(60, 3)):
        for sender, data in chance.sample(traffic, 2):
            card.receive(sender.stream, data)
        if chance.random() < 0.4:
            card.bit[40] = chance.random() < 0.5
        card.advance(chance.randrange(1, 40))
        again = twin(card)
        sender, data = chance.choice(traffic)
        for each in (card, again):
            each.receive(sender.stream, data)
        agree(card, again, 12)
        numbers = [other.stream for other in (host, typist, serial, packets)]
        for sent, other in zip(_heard(card, *numbers), _heard(again, *numbers), strict=True):
            assert sent == other


def test_moves_that_wait_for_room_hold_their_sender_back_there_too() -> None:
    host = at_axes()
    packets = Host(host.card, StreamKind.PACKETS)
    move = Move.of({0: 100000, 1: 5}, vel=0.01, acc=100.0)
    packets.send(move.encode() * 1200)
    host.card.advance(1000)  # they are dealt with in turns
    assert not host.card.accepts_input(packets.stream)
    again = twin(host.card)
    assert not again.accepts_input(packets.stream)
    agree(host.card, again, 20)


def test_a_new_connection_gets_the_number_it_would_have_got() -> None:
    host = at_axes()
    gone = Host(host.card)
    gone.close()
    again = twin(host.card)
    numbers = [card.open_stream(StreamKind.TERMINAL) for card in (host.card, again)]
    assert numbers[0] == numbers[1] > gone.stream


def test_an_answer_that_was_not_sent_yet_is_sent_by_the_other_card() -> None:
    host = at_axes()
    host.send("?1 : DWL 0.01 : ?2\r")
    again = twin(host.card)
    for card in (host.card, again):
        card.advance(40)
    assert _heard(again, host.stream) == _heard(host.card, host.stream)


# refusals


def test_a_snapshot_of_another_model_or_machine_is_refused() -> None:
    card, other = Controller("ACR9000"), Controller("ACR9040")
    with pytest.raises(StoreError, match="the snapshot is of an ACR9000, the card is an ACR9040"):
        other.restore(card.snapshot())
    world = parse_world(WORLD)
    with pytest.raises(StoreError, match="another machine connected"):
        Controller(world=world).restore(card.snapshot())
    with pytest.raises(StoreError, match="a version of openacr with another memory layout"):
        card.restore(replace(card.snapshot(), layout="0"))


def _beside(**changes: object) -> Callable[[Snapshot], Snapshot]:
    def change(kept: Snapshot) -> Snapshot:
        language = replace(kept.beside.language, **changes)
        return replace(kept, beside=replace(kept.beside, language=language))

    return change


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (_beside(aliases=7), "contradicts itself"),
        (_beside(programs=[[10**6], *([[]] * 23)]), "contradicts itself"),
        (_beside(threads={16 + 9: [0]}), "contradicts itself"),
        (_beside(channels={}), "other channels"),
        (_beside(config=("ENC1", "DAC4", "DAC4", "ADC8")), "refuses: Invalid argument"),
        (_beside(addresses={"IP": "1.2.3.4"}), "refuses: Invalid argument"),
        (lambda kept: replace(kept, beside=replace(kept.beside, moves=[b"\x04"])), "a move"),
    ],
)
def test_a_snapshot_that_makes_no_sense_leaves_the_card_as_it_was(
    change: Callable[[Snapshot], Snapshot], said: str
) -> None:
    host = busy_host()
    before, image = host.card.snapshot(), host.card.image()
    with pytest.raises(StoreError, match=said):
        host.card.restore(change(before))
    assert host.card.image() == image
    assert host.card.snapshot() == before
    host.card.advance(100)
    ended = host.card.digest()
    host.card.restore(before)
    host.card.advance(100)
    assert host.card.digest() == ended


def test_a_snapshot_that_was_cut_off_anywhere_is_refused() -> None:
    data = snapshot.encode(busy_host().card.snapshot())
    for end in (*range(0, 400, 7), *range(400, len(data), 997), len(data) - 1):
        with pytest.raises(StoreError, match="snapshot"):
            snapshot.decode(data[:end])
    with pytest.raises(StoreError, match="length differs"):
        snapshot.decode(data + b"x")


def test_a_snapshot_that_would_fill_the_memory_is_not_read_to_its_end() -> None:
    """A few kilobytes that would be inflated to gigabytes."""
    data = snapshot.encode(Controller().snapshot())
    begin = len(snapshot.MAGIC) + 4
    end = begin + int.from_bytes(data[begin - 4 : begin], "little")
    bomb = zlib.compress(bytes(1 << 28))
    with pytest.raises(StoreError, match="length differs"):
        snapshot.decode(data[:end] + bomb)
    header = msgpack.decode(data[begin:end], type=snapshot.Header)
    greedy = msgpack.encode(replace(header, beside_bytes=1 << 40))
    with pytest.raises(StoreError, match="cannot be read: Expected `int` <= 67108864"):
        snapshot.decode(snapshot.MAGIC + len(greedy).to_bytes(4, "little") + greedy + bomb)


def test_a_snapshot_with_another_fingerprint_is_refused() -> None:
    kept = Controller().snapshot()
    data = snapshot.encode(kept)
    other = snapshot.encode(replace(kept, rows=kept.rows[:-1] + b"x"))
    begin = len(snapshot.MAGIC) + 4
    end = begin + int.from_bytes(data[begin - 4 : begin], "little")
    with pytest.raises(StoreError, match="its fingerprint does not match"):
        snapshot.decode(data[:end] + other[end:])


@pytest.mark.parametrize("data", [b"", b"nonsense", b"openacr snapshot 2\n", zlib.compress(b"a")])
def test_what_is_no_snapshot_is_refused(data: bytes) -> None:
    with pytest.raises(StoreError, match="cannot be read"):
        snapshot.decode(data)
