"""What one host asks for is dealt with in slices: others are served between."""

import struct
from collections.abc import Iterator
from typing import Any

import pytest
from tests.controller.hosts import Host, connected

from openacr.basic.commands.program_control import SHOWN_LINE_WORK, WORK_PER_SLICE
from openacr.controller import Controller
from openacr.protocol.events import ControlKey
from openacr.protocol.segment import Segment

LINES = 230
SLICE_TICKS = 2
PER_SLICE = WORK_PER_SLICE // SHOWN_LINE_WORK
BODY = ("IF (BIT1)", *(f"SET {number}" for number in range(128, 128 + LINES)), "ENDIF")
SHOWN = ["PROGRAM", " IF (BIT 1)", *(f"  {line}" for line in BODY[1:-1]), "  ENDIF", "ENDP"]


@pytest.fixture
def long(host: Host) -> Host:
    """A host at a program of many lines."""
    host.type("PROG0", "PROGRAM", *BODY, "ENDP")
    return host


def slices(host: Host, line: str) -> Iterator[str]:
    """The answer, one time slice after the other, until the prompt."""
    heard = host.send(line + "\r").removeprefix(line + "|")
    yield heard
    while not heard.endswith("P00>"):
        heard = host.after(SLICE_TICKS)
        yield heard


def test_a_long_list_comes_slice_by_slice_and_is_complete(long: Host) -> None:
    answers = list(slices(long, "LIST"))
    assert "".join(answers) == "".join(f"{line}|" for line in SHOWN) + "P00>"
    assert len(answers) == -(-len(SHOWN) // PER_SLICE)
    assert all(answer.count("|") == PER_SLICE for answer in answers[:-1])
    assert long.type("LIST 10,30") == f"{SHOWN[0]}|{SHOWN[1]}|{SHOWN[2]}|P00>"
    assert long.type("LIST 20 : LIST 20") == f"{SHOWN[1]}|{SHOWN[1]}|P00>", "each from its start"


def test_a_range_of_a_list_keeps_the_depth_of_its_blocks(long: Host) -> None:
    wanted = f"{SHOWN[200]}|{SHOWN[201]}|P00>"
    assert "".join(slices(long, "LIST 2010-2020")) == wanted
    assert long.type("LIST 2010-2020") == wanted, "what is known is passed over at once"
    number = 10 * len(SHOWN)
    assert "".join(slices(long, f"LIST {number}")) == f"{SHOWN[-1]}|P00>"


def test_another_host_is_answered_while_a_list_goes_on(long: Host) -> None:
    other = Host(long.card)
    long.send("LIST\rVER\r")
    assert other.ask("?BIT1") == "0"
    assert other.send("\x18") == ""
    heard = long.after(SLICE_TICKS * 40)
    assert heard.count("P00>") == 2, "the next line follows the list"


def test_a_list_goes_on_in_a_snapshot(long: Host) -> None:
    answers = slices(long, "LIST")
    heard = next(answers)
    kept = long.card.snapshot()
    rest = "".join(answers)
    long.card.restore(kept)
    again = ""
    while not again.endswith("P00>"):
        again += long.after(SLICE_TICKS)
    assert again == rest
    assert heard + rest == "".join(f"{line}|" for line in SHOWN) + "P00>"


def test_a_list_that_is_broken_off_leaves_nothing_to_the_next_one(long: Host) -> None:
    long.send("LIST\r")
    long.close()
    again = Host(long.card)
    again.type("PROG0")
    assert again.type("LIST 20") == f"{SHOWN[1]}|P00>"


def test_what_arrives_together_is_dealt_with_turn_by_turn(host: Host) -> None:
    one_tick = 250  # units of work: 150 and 30 for each character
    asked = 40
    answer = "?1|1|SYS>"
    cost = 150 + 30 * 2
    first = -(-5000 // cost)
    assert host.send("?1\r" * asked) == answer * first
    heard, waited = "", 0
    while len(heard) < len(answer) * (asked - first):
        heard, waited = heard + host.after(1), waited + 1
    assert heard == answer * (asked - first), "each echo before its answer, as in one piece"
    debt = cost * first - 5000
    assert waited == -(-(cost * (asked - first - 1) + debt + 1) // one_tick)
    assert host.send("?1\r" * first) == answer * first, "what arrives anew has a turn of its own"


def test_what_arrives_while_lines_wait_gets_no_turn_of_its_own(host: Host) -> None:
    answer, cost = "?1|1|SYS>", 150 + 30 * 2
    first = -(-5000 // cost)
    assert host.send("?1\r" * (first + 1)) == answer * first
    assert host.send("?1\r" * first) == "", "a host that floods waits as if it had sent at once"
    assert host.after(first * cost // 250 + 8) == answer * (first + 1)
    assert host.send("?1\r" * first) == answer * first


class Counted(bytes):
    """Received bytes that count those copied out of them."""

    copied = 0

    def __getitem__(self, place: Any) -> Any:
        found = super().__getitem__(place)
        if isinstance(found, int):
            return found
        Counted.copied += len(found)
        return Counted(found)


@pytest.mark.parametrize("piece", [1 << 20, 1024, 7])
@pytest.mark.parametrize("begin", [b"", b"\x1c\x80\x00"])
def test_a_line_costs_the_same_however_many_wait_after_it(
    host: Host, monkeypatch: pytest.MonkeyPatch, piece: int, begin: bytes
) -> None:
    looks = 0
    take_keys = Segment.take_keys

    def counted(segment: Segment) -> tuple[list[ControlKey], bool]:
        nonlocal looks
        looks += 1
        return take_keys(segment)

    monkeypatch.setattr(Segment, "take_keys", counted)
    spent = {}
    for lines in (100, 800):
        data = begin + b"?1\r" * lines
        Counted.copied = looks = 0
        for at in range(0, len(data), piece):
            host.card.receive(host.stream, Counted(data[at : at + piece]))
        heard, ticks = host.heard(), 0
        while len(heard) < lines * len("?1|1|SYS>"):
            heard, ticks = heard + host.after(1), ticks + 1
        segments = -(-len(data) // piece)
        assert looks <= 2 * segments + ticks + 1
        spent[lines] = Counted.copied / len(data)
    assert spent[800] <= 3.0
    assert spent[800] <= spent[100] + 1.0


def test_many_keys_are_dealt_with_in_turns_and_the_last_of_each_acts_at_once(
    host: Host, monkeypatch: pytest.MonkeyPatch
) -> None:
    pressed: list[ControlKey] = []
    press = host.card.streams._press

    def noted(key: ControlKey) -> None:
        pressed.append(key)
        press(key)

    monkeypatch.setattr(host.card.streams, "_press", noted)
    kill, clear = ControlKey.CTRL_X, ControlKey.CTRL_Y
    begun = -(-5000 // 30)
    host.send("\x18" * begun + "\x19\x18\x19\x18" * 100)
    assert pressed == [kill] * begun + [clear, kill]
    assert host.card.memory.bit(8467), "the last key was a Ctrl-X"
    pressed.clear()
    host.after(1)
    assert host.send("\x18" + "?1\r" * 40) == "?1|1|SYS>" * 24
    assert pressed == [kill], "a key that has acted is not found again"
    assert host.after(20) == "?1|1|SYS>" * 16
    pressed.clear()
    host.send("?1\r" * 40 + "\x18\x19")
    assert pressed == [kill, clear]
    assert not host.card.memory.bit(8467)


def test_packets_that_ask_for_much_are_answered_turn_by_turn(host: Host) -> None:
    host.type("DIM P(1000)")
    other = Host(host.card)
    ask = bytes.fromhex("00 90 01 FF 01 00 50 00")
    cost, asked = 12 + 8 * 255, 20
    length = len(ask) + 4 * 255
    host.card.receive(host.stream, ask * asked)
    heard = b"".join(iter(lambda: host.card.take_output(host.stream), b""))
    assert len(heard) == length * -(-5000 // cost)
    assert other.ask("?BIT1") == "0"
    waited = 0
    while len(heard) < length * asked:
        host.card.advance(1)
        waited += 1
        heard += b"".join(iter(lambda: host.card.take_output(host.stream), b""))
    assert heard == (ask + bytes(4 * 255)) * asked
    assert waited == -(-(cost * (asked - 1) - 5000 + 1) // 250)


def test_pokes_count_by_their_values_and_moves_as_one(host: Host) -> None:
    host.type("DIM P(1000)")
    poke = bytes.fromhex("00 91 01 FF 01 00 50 00") + struct.pack("<255f", *[1.0] * 255)
    last = bytes.fromhex("1C 80 00")
    for packets, at_once in (
        (poke * 2, True),
        (poke * 3, False),
        (last * 415, True),
        (last * 417, False),
    ):
        host.card.bit[128] = host.card.bit[129] = False
        host.card.receive(host.stream, packets + bytes.fromhex("1C 81 00"))
        assert host.card.bit[129] is at_once, len(packets)
        host.card.advance(100)
        assert host.card.bit[129]


@pytest.mark.parametrize(("arrays", "at_once"), [(100, 23), (200, 12), (0, 250)])
def test_a_poke_counts_the_arrays_among_which_its_own_is_sought(
    host: Host, arrays: int, at_once: int
) -> None:
    host.type("DIM PROG0(100000)", "PROG0", "DIM LA(1000)")
    for number in range(arrays):
        host.type(f"DIM LA{number}(1)")
    free = 0x81FFF0  # in the heap, of no array
    poke = bytes.fromhex("00 91 00 01") + struct.pack("<Ii", free, 1)
    flag = bytes.fromhex("1C 80 00")
    for packets, is_done in ((at_once - 1, True), (at_once, False)):
        host.card.bit[128] = False
        host.card.receive(host.stream, poke * packets + flag)
        assert host.card.bit[128] is is_done, packets
        host.card.advance(200)
        assert host.card.bit[128]


def test_keys_go_before_lines_that_wait_for_their_turn(host: Host) -> None:
    key = "\x18"
    begin = host.card.memory.bit(8467)
    assert not begin
    host.send("?1\r" * 40 + "?2" + key + "\r")
    assert host.card.memory.bit(8467), "Kill All Motion Request of axis 0"
    assert host.after(100).endswith("?1|1|SYS>?2|2|SYS>"), "typed characters stay"


def test_bytes_of_a_packet_that_waits_are_no_keys(host: Host) -> None:
    host.card.receive(host.stream, b"?1\r" * 40 + b"\x1c\x18\x00\x18")
    assert not host.card.memory.bit(8467)


def test_lines_that_wait_for_their_turn_go_on_in_a_snapshot(host: Host) -> None:
    host.send("?1\r" * 60)
    kept = host.card.snapshot()
    heard = host.after(20)
    host.card.take_over(kept)
    assert host.after(20) == heard
    assert "?1|1|SYS>" in heard


def test_lines_that_wait_do_so_equally_long_however_time_is_cut() -> None:
    text = "P1=P1+1\r" * 60 + "SET 128\r"
    cuts = []
    for cut in (1, 7, 1000):
        again = connected("DIM P(5)")
        again.send(text)
        while not again.card.memory.bit(128):
            again.card.advance(cut) if cut < 1000 else again.card.until(128)
        again.heard()
        cuts.append((again.card.tick, again.ask("?P1")))
    assert {value for _, value in cuts} == {"60"}
    assert cuts[2][0] - cuts[0][0] == 1, "a turn comes after the tick; `until` sees it at the next"
    assert 0 <= cuts[1][0] - cuts[0][0] < 7


def test_another_host_is_served_while_lines_wait(host: Host) -> None:
    other = Host(host.card)
    host.send("?1\r" * 300)
    assert other.ask("?BIT1") == "0"
    assert len(host.after(1)) <= 2 * len("?1|1|SYS>")


def test_lines_of_a_caller_in_this_process_are_all_dealt_with() -> None:
    card = Controller()
    assert card.send("?1\r" * 300) == "?1\r\n1\r\nSYS>" * 300
    assert card.send("?2\r\n\r?3") == "?2\r\n2\r\nSYS>\r\nSYS>?3"


@pytest.mark.parametrize(("line", "work"), [
    ("ESAVE", 2000), ("ELOAD", 5500), ("FLASH SAVE", 25 * 80), ("FLASH IMAGE", 25 * 80),
    ("FLASH LOAD", 60 * 80), ("ERASE", 0),
])  # fmt: skip
def test_what_saves_and_loads_much_counts_as_much(host: Host, line: str, work: int) -> None:
    host.type("DIM PROG0(9000)", "DIM PLC0(4000)", "PROG0", *(f"{n} SET 32" for n in range(1, 61)))
    host.type("PLC0", *(f"{n} LD 1" for n in range(1, 21)), "SYS", "ESAVE", "FLASH SAVE")
    cost = 150 + 30 * len(line) + work
    sent = 5000 // cost + 40
    first = -(-5000 // cost)
    heard = host.send(f"{line}\r" * sent)
    assert heard.count("SYS>") == first
    waited = first * cost - 5000
    assert host.after(waited // 250).count("SYS>") == 0
    assert host.after(1).count("SYS>") >= 1


def test_what_a_program_saves_is_not_counted_for_a_host(host: Host) -> None:
    host.type("DIM PROG0(900)", "PROG0", "10 ESAVE", "20 ESAVE", "30 ESAVE", "RUN", "SYS")
    host.after(20)
    assert host.send("?1\r" * 40).count("SYS>") == -(-5000 // (150 + 30 * 2))
