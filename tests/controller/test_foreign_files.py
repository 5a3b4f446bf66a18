"""Journals and snapshots from a stranger: refused with a reason, or lived through; never harm."""

import json
import random
from base64 import b64encode
from pathlib import Path
from typing import Any

import pytest
from msgspec.structs import replace
from tests.controller.hosts import Host, at_axes, store
from tests.parity.journeys import WORLD
from tests.search import examples

from openacr.controller import Controller
from openacr.controller.journal import read_journal
from openacr.controller.recorder import Recorder
from openacr.controller.replay import Replay
from openacr.controller.snapshot import Snapshot
from openacr.controller.snapshot_file import decode, encode
from openacr.errors import StoreError
from openacr.map import numbers as at
from openacr.map.hidden import HIDDEN_BLOCKS
from openacr.map.hidden.block import ANY_NUMBER, ROWS_F, ROWS_I, places
from openacr.map.memory import Memory
from openacr.map.names import every_name
from openacr.map.rows import (
    bus_nodes,
    bus_signals,
    input_words,
    masters,
    scheduler,
    storage,
    threads,
)
from openacr.map.valid import check_rows
from openacr.plant.describe.load import parse_world

LIMITED = [
    (block, view, name, offset, size, block.ranges.get(name, usual))
    for block in HIDDEN_BLOCKS
    for view, fields, usual in (("F", block.doubles, block.usual), ("I", block.ints, ANY_NUMBER))
    for name, offset, size in places(fields)
    if block.ranges.get(name, usual) != ANY_NUMBER
]


def busy() -> Host:
    host = at_axes(parse_world(WORLD))
    host.type("SYS", "DIM P(10)", "DIM PLC0(60)", "PROG0", "DIM LV(4)", "DIM LA(2)", "DIM LA1(9)")
    host.type("DIM DA(1)", "DIM DA0(5)", "MBUF ON 20")
    store(
        host, "_L", "GOSUB S", "X/1 : X/-1", "LV1 = LV1 + 1", "GOTO L", "_S", "DWL .003", "RETURN"
    )
    host.type("PLC0", "10 LD BIT 40", "20 TIM 0 30", "30 LD TIM 0", "40 OUT BIT 41", "RUN", "PROG0")
    host.type("RUN")
    host.card.advance(200)
    return host


@pytest.fixture(scope="module")
def kept() -> Snapshot:
    return busy().card.snapshot()


def changed(kept: Snapshot, view: str, row: int, value: float) -> Snapshot:
    rows = bytearray(kept.rows)
    memoryview(rows).cast("d" if view == "F" else "i")[row] = value  # type: ignore[call-overload]
    return replace(kept, rows=bytes(rows))


@pytest.fixture(scope="module")
def memory(kept: Snapshot) -> Memory:
    """The rows of the snapshot, as those of a file are checked."""
    found = Memory()
    found.restore(kept.rows)
    return found


def test_the_rows_of_a_file_are_checked(kept: Snapshot) -> None:
    row = place_of("THI_BASE") + at.THI_DEPTH
    with pytest.raises(StoreError, match="TH depth of 0 is"):
        decode(encode(changed(kept, "I", row, -(2**31))))


@pytest.mark.parametrize("row", LIMITED, ids=lambda row: f"{row[0].prefix}_{row[2]}")
def test_a_row_outside_its_range_is_refused_by_name(memory: Memory, row) -> None:  # type: ignore[no-untyped-def]
    block, view, name, offset, size, (low, high) = row
    last = place_of(f"{block.prefix}{view}_BASE") + (
        (block.count - 1) * place_of(f"{block.prefix}{view}_STRIDE") + offset + size - 1
    )
    wrong = (low - 1, high + 1) if view == "I" else (low - max(1.0, abs(low)), 2 * high + 1.0)
    views: Any = memory.F if view == "F" else memory.I
    before = views[last]
    try:
        for value in wrong:
            if view == "F" or abs(value) < 2**31:
                views[last] = value
                said = f"{block.prefix} {name} of {block.count - 1} is"
                with pytest.raises(StoreError, match=said):
                    check_rows(memory)
        if view == "F":
            views[last] = float("nan")
            with pytest.raises(StoreError, match="is nan"):
                check_rows(memory)
    finally:
        views[last] = before


def test_every_range_names_a_row_and_lies_within_the_memory() -> None:
    for block in HIDDEN_BLOCKS:
        names = {name for fields in (block.doubles, block.ints) for name, _, _ in places(fields)}
        assert block.ranges.keys() <= names, block.prefix
    assert 2 * at.HIDDEN_BASE < at.HEAP_BYTE_BASE // 4 < ROWS_I < at.MEMORY_BYTES // 4
    assert at.HEAP_BYTE_BASE // 8 < ROWS_F + 1 or ROWS_F < at.MEMORY_BYTES // 8


HEAP = at.HEAP_BYTE_BASE // 4
STORAGE = storage.ints[0]


@pytest.mark.parametrize(
    ("row", "value", "said"),
    [
        (STORAGE + at.STI_LV_BASE, HEAP - 1, "overlap"),
        (STORAGE + at.STI_LV_COUNT, at.HEAP_BYTES // 4, "overlap"),
        (STORAGE + at.STI_LV_COUNT, -1, "overlap"),
        (STORAGE + at.STI_LA_BASE, 5, "outside the heap"),
        (STORAGE + at.STI_LA_COUNT, 1 << 30, "outside the heap"),
        (STORAGE + at.STI_DA_BASE, HEAP, "overlap|odd|outside"),
        (masters.first[0], 760, "moves of master 0"),
        (masters.ints[0] + masters.INTS_SIZE + at.MSI_FIRST, 33, "moves of master 2"),
        (masters.head[0], 64, "moves of master 0"),
        (masters.queued[0], 65, "moves of master 0"),
        (masters.section_cnt[0], 65, "moves of master 0"),
        (input_words.word[0], 4095, "a wire ends at row 4095"),
        (input_words.word[0], at.PUBLIC_COUNT, "a wire ends at row"),
        (input_words.word[0], bus_nodes.ints[0] - 1, "a wire ends at row"),
        (bus_signals.input[0], bus_nodes.reals[0] - 1, "a signal ends at row"),
        (7, 0, "kinds of parameters"),
    ],
)
def test_rows_that_do_not_fit_each_other_are_refused(
    kept: Snapshot, row: int, value: int, said: str
) -> None:
    with pytest.raises(StoreError, match=said):
        decode(encode(changed(kept, "I", row, value)))


@pytest.mark.parametrize(
    ("row", "value"),
    [
        (at.THI_PC, 1), (at.THI_PC, 10**6), (at.THI_PC, -3), (at.THI_SP, 1),
        (at.THI_FLOW_BACK, 1), (at.THI_FLOW_BACK, 1 << 20),
    ],
)  # fmt: skip
def test_a_program_in_the_middle_of_an_operation_is_refused(
    kept: Snapshot, row: int, value: int
) -> None:
    made = changed(kept, "I", threads.depth[0], 1)
    made = changed(made, "I", threads.flow_kind[0], 4)
    again = changed(made, "I", threads.ints[0] + row, value)
    card = Controller(world=parse_world(WORLD))
    with pytest.raises(StoreError, match="in the middle of an"):
        card.restore(decode(encode(again)))


@pytest.mark.parametrize("row", [at.THI_STATE, "mark"])
def test_a_thread_that_executes_nothing_is_refused(kept: Snapshot, row: object) -> None:
    place = scheduler.programs
    if row != "mark":
        place = threads.state[9]
    card = Controller(world=parse_world(WORLD))
    with pytest.raises(StoreError, match="thread 9 executes nothing"):
        card.restore(decode(encode(changed(kept, "I", place, 1 | 1 << 9 if row == "mark" else 1))))


def place_of(name: str) -> int:
    return every_name()[name]


def lived_through(data: bytes) -> bool:
    """Whether a card was made of it; it then lives for a while."""
    card = Controller(world=parse_world(WORLD))
    try:
        card.take_over(decode(data))
    except StoreError:
        return False
    card.advance(40)
    card.send("?1\rLIST\rRUN\r")
    card.advance(20)
    return True


@pytest.mark.search
def test_wild_rows_are_refused_or_do_no_harm(kept: Snapshot) -> None:
    chance = random.Random(3)
    fields = [
        (view, place_of(f"{block.prefix}{view}_BASE"), place_of(f"{block.prefix}{view}_STRIDE"),
         block.count, offset, size)
        for block in HIDDEN_BLOCKS
        for view, names in (("F", block.doubles), ("I", block.ints))
        for _, offset, size in places(names)
    ]  # fmt: skip
    lived = 0
    most = examples(250)
    for _ in range(most):
        made = kept
        for _ in range(chance.randrange(1, 4)):
            view, base, stride, count, offset, size = chance.choice(fields)
            row = base + chance.randrange(count) * stride + offset + chance.randrange(size)
            ints = (-1, 0, 1, 2, 15, 16, 17, 63, 64, 255, 2**31 - 1, -(2**31))
            reals = (0.0, -1.0, 1e-300, 1e9, -1e15, 1e300, float("inf"), float("nan"))
            value = chance.choice(ints if view == "I" else reals)
            made = changed(made, view, row, value)
        lived += lived_through(encode(made))
    assert most / 12 < lived < most


@pytest.mark.search
def test_wild_bytes_are_refused_or_do_no_harm(kept: Snapshot) -> None:
    chance, data = random.Random(4), encode(kept)
    for _ in range(examples(150)):
        wild = bytearray(data)
        for _ in range(chance.randrange(1, 5)):
            wild[chance.randrange(len(wild))] = chance.randrange(256)
        if lived_through(bytes(wild)):  # only the name of the version may be another
            found = decode(bytes(wild))
            assert found.rows == kept.rows and found.beside == kept.beside
    lived = 0
    beside = chance.randrange  # plain data, packed again so that only its sense is wrong
    most = examples(100, 4)
    for _ in range(most):
        language = kept.beside.language
        lines = list(language.table.lines)
        place = beside(len(lines))
        text = "".join(chr(beside(1, 255)) for _ in range(beside(30)))
        lines[place] = replace(lines[place], text=text, scope=beside(3))
        table = replace(language.table, lines=lines)
        made = replace(kept.beside, language=replace(language, table=table))
        lived += lived_through(encode(replace(kept, beside=made)))
    assert 0 < lived < most


# journals


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("journals") / "a.journal"
    host = busy()
    host.card.recorder = Recorder(host.card, path)
    host.send("?1\rDWL 0.01\r?2\r")
    host.card.advance(300)
    host.card.drag(0, 0.25)
    host.card.set_input(9, True)
    host.card.p[3] = 2.5
    host.card.advance(3000)
    host.close()
    host.card.close()
    return path


def test_wild_journals_are_refused_or_replayed(written: Path, tmp_path: Path) -> None:
    chance, lines = random.Random(7), written.read_bytes().split(b"\n")
    path, replayed = tmp_path / "b", 0
    for _ in range(120):
        wild = list(lines)
        place = chance.randrange(1 if chance.random() < 0.3 else 2, len(wild))
        line = bytearray(wild[place])
        for _ in range(chance.randrange(1, 4)):
            if line:
                line[chance.randrange(len(line))] = chance.choice(b'0123456789,[]{}"-eabz\x00\xff')
        wild[place] = bytes(line)
        path.write_bytes(b"\n".join(wild))
        try:
            Replay(read_journal(path)).run(0.2)
            replayed += 1
        except StoreError as error:
            assert str(error)
    assert replayed > 10


@pytest.mark.parametrize(
    ("record", "said"),
    [
        ([10**15, "flag", 130, 1], "is damaged: tick 1000000000000000 follows tick"),
        ([0, "flag", 130, 1], "is damaged: tick 0 follows tick"),
        ([210, "drag", 999, 1.0], "axis 999"),
        ([210, "drag", -1, 1.0], "line 3 is damaged"),
        ([210, "input", 10**6, 1], "input 1000000"),
        ([210, "parameter", 10**6, 1.0], "cannot be applied to this card"),
        ([210, "bytes", 77, "?1\r"], "there is no connection 77"),
        ([210, "bytes", 1, "\u20ac"], "line 3 is damaged"),
        ([210, "key", 1], "line 3 is damaged"),
        ([210, "open", 5, "telepathy", ""], "line 3 is damaged"),
        ([210, "open", 5, "terminal", "STREAM9"], "cannot be applied to this card"),
        ([210.5, "close", 1], "line 3 is damaged"),
    ],
)
def test_an_entry_that_no_card_has_written_is_refused(
    written: Path, tmp_path: Path, record: list[object], said: str
) -> None:
    magic, head, *_ = written.read_bytes().split(b"\n")
    first = json.loads(head)["tick"]
    if isinstance(record[0], int) and 0 < record[0] < 10**9:
        record = [first + 10, *record[1:]]
    path = tmp_path / "b"
    path.write_bytes(b"\n".join([magic, head, json.dumps(record).encode(), b""]))
    with pytest.raises(StoreError, match=said):
        Replay(read_journal(path)).run()


def test_a_header_that_no_card_has_written_is_refused(written: Path, tmp_path: Path) -> None:
    magic, head, *rest = written.read_bytes().split(b"\n")
    known, path = json.loads(head), tmp_path / "b"
    world = known["world"]
    axis = {**world["axis"][0], "number": 1}
    for change, said in (
        ({"model": "ACR1"}, "unknown model, ACR1"),
        ({"period_s": 0.001}, "two different tick lengths"),
        ({"tick": -1}, "its first record cannot be read"),
        ({"digest_every_tk": 0}, "its first record cannot be read"),
        ({"world": {**world, "axis": [axis, axis]}}, "its machine is damaged"),
        ({"snapshot": "?" + known["snapshot"]}, "its snapshot cannot be read"),
        ({"snapshot": b64encode(b"x").decode()}, "the snapshot cannot be read"),
    ):
        path.write_bytes(b"\n".join([magic, json.dumps(known | change).encode(), *rest]))
        with pytest.raises(StoreError, match=said):
            Replay(read_journal(path))
