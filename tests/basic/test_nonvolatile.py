"""What is saved: the list of parameters, user memory as text, Intel-HEX."""

from pathlib import Path

import msgspec
import pytest
from tests.basic.machine import Machine

from openacr.basic.commands.nonvolatile import hex_records
from openacr.basic.language import registry
from openacr.basic.memory import saved, saved_flags, saving, user_memory
from openacr.basic.memory.user_memory import UserMemory
from openacr.controller import Controller
from openacr.map import numbers as at
from openacr.map.rows import threads
from openacr.models import ACR8020, ACR9000
from openacr.project import find_project

EXAMPLES = sorted(path for path in Path("examples").iterdir() if path.is_dir())
SOURCES = {
    "AXIS0 GEAR SRC ENC4": "ENC4", "AXIS5 GEAR SRC ENC3": "ENC3", "AXIS5 CAM SRC ENC2": "ENC2",
    "AXIS5 BSC SRC P38912": "P38912", "AXIS5 HDW SRC ENC1": "ENC1", "AXIS5 JOG SRC ENC5": "ENC5",
}  # fmt: skip
SETTINGS = (
    "PROG 1", "ATTACH MASTER2", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE3 AXIS5 "Y"',
    "PPU X1000.5", "ACC 55.25", "VEL 0.1", "VECDEF Y0", "NOTCH X(100,20)", "LOPASS Y300",
    "HLIM X3", "SLIM Y2", "MAXVEL X7", "DAC3 GAIN 7", "ADC2 OFFSET -1", "AXIS7 OFF",
    "EXC X(1,-2)", "ATTACH AXIS6 STEPPER3 STEPPER3", "P32768=9", "P33040=3", "PERIOD 0.001",
    'IP GATE "10.0.0.9"', "MULT X-4", "JOG HOMVF Y3", "HLBIT Y7", "ADC MAX 3",
    "TMOV 2.5", "SRC ENC3", "MASTER5 SRC P38912", "MASTER6 TMOV 3", "MASTER6 TMOV OFF",
    "ENC3 ROTARY 1000", "ENC4 LIMIT 5000", "ENC5 CLOCK 100000", "ENC5 WIDTH 25",
    "ADC POS 7 2", "ADC NEG 3 1", *SOURCES,
)  # fmt: skip


def test_every_command_whose_value_is_kept_is_in_the_list_of_esave() -> None:
    rows = {row.name for row in registry.commands() if row.saved}
    kept = [each.words for each in saved.all_saved()]
    assert len(set(kept)) == len(kept)
    assert rows - set(kept) == set(saving.SAME_VALUE)
    beside = {each.words for each in saved_flags.saved_beside_commands()}
    assert set(kept) - rows == {"CANopen"} | beside
    assert set(saving.SAME_VALUE.values()) <= set(kept)


def test_saved_parameters_make_the_same_card() -> None:
    first, second = Machine(ACR8020), Machine(ACR8020)
    assert "|" not in first.type(*SETTINGS)
    image = saved.take(first.system)
    assert saved.put(second.system, _through_bytes(image)) == []
    assert saved.take(second.system) == image
    for line, source in SOURCES.items():
        assert second.type(line.removesuffix(f" {source}")).removesuffix("|SYS>") == source
    assert image != saved.take(Machine(ACR8020).system)
    for view in ("F", "I"):  # settings, filters, flags: all but the clock of the channels
        mine, other = getattr(first.card.memory, view), getattr(second.card.memory, view)
        first_row = {"F": at.USER_BASE, "I": 12288}[view]
        last_row = {"F": threads.reals[0], "I": 40960}[view]
        assert mine[first_row:last_row].tolist() == other[first_row:last_row].tolist()


def _through_bytes(image: dict[str, object]) -> dict[str, object]:
    return msgspec.msgpack.decode(msgspec.msgpack.encode(image), type=dict[str, object])


def test_parameters_of_a_larger_card_are_taken_as_far_as_they_fit() -> None:
    large, small = Machine(ACR8020), Machine(ACR9000)
    large.type("AXIS12 PPU 7", "AXIS3 PPU 5", "PROG 1", "ATTACH MASTER12")
    refused = saved.put(small.system, saved.take(large.system))
    assert refused == ["ATTACH MASTER #: Invalid argument"]
    assert small.type("AXIS3 PPU") == "5|SYS>"


def test_nonsense_in_place_of_a_value_is_named_and_left_out() -> None:
    card = Machine()
    image = saved.take(card.system) | {"PGAIN": [["high"]], "HLIM": 3, "IP": {"IP": "1.2.3"}}
    assert [line.split(":")[0] for line in saved.put(card.system, image)] == ["PGAIN", "HLIM", "IP"]
    assert saved.put(card.system, {"NO SUCH": 1}) == []


# user memory


TEXT = (
    "_start", 'PRINT "a ""b"" \xe9" : X10', "x10 jog abs X(Count+1)", "GOTO start",
    "rem hello ' there", "IF (Count = &HFF) THEN SET Lamp", "P2=1e-3-.5:P3=&B101",
)  # fmt: skip


def card_with_everything() -> Machine:
    card = Machine(ACR8020)
    card.type("DIM P(10)", "DIM DEF(3)", "#DEFINE Count P1", "#DEFINE Lamp BIT 32", "DIM COM1(999)")
    card.type("Count=5.5", "P38912=9", "P39200=1.5", 'PASSWORD ON "s"', "PROG 1", "ATTACH MASTER0")
    card.type('ATTACH SLAVE0 AXIS0 "X"', "DIM LV(3)", "DIM DA(2)", "DIM DA1(4)", "DIM SA(1)")
    card.type("DIM $V(2,10)", "DIM $A(2)", "DIM $A1(2,4)", '$V1="h\xe9llo"', '$A1(0)="abc"')
    card.type("LV2=7", "DA1(3)=1.25", "DIM MBUF(3)", "DIM DV(3)", "DV2=2.5")
    card.load(1, *TEXT)
    card.type("PROG 2", "10 PRINT 1:PRINT    2", "20   REM", "30 _label PRINT 2")
    return card


def test_user_memory_comes_back_as_it_was() -> None:
    first, second = card_with_everything(), Machine(ACR8020)
    image = user_memory.take(first.system, values=True)
    encoded = msgspec.msgpack.encode(image)
    assert user_memory.put(second.system, msgspec.msgpack.decode(encoded, type=UserMemory)) == []
    assert user_memory.take(second.system, values=True) == image
    assert _lines(first) == _lines(second)
    for program in ("SYS", "PROG 1", "PROG 2"):
        for line in (program, "DIM", "DEF", "MEM", "?Count;P38912;P39200"):
            assert second.type(line) == first.type(line)
    assert second.type("PROG 1", "?LV2;DV2;DA1(3);$V1;$A1(0)") == "P01>72.51.25h\xc3\xa9lloabc|P01>"


def _lines(card: Machine) -> list[object]:
    texts = card.system.programs.texts
    return [(n, line.tree, line.cost_bytes) for text in texts for n, line in sorted(text.items())]


def test_without_values_sizes_are_kept_and_everything_is_zero() -> None:
    first, second = card_with_everything(), Machine(ACR8020)
    user_memory.put(second.system, user_memory.take(first.system, values=False))
    assert second.type("DIM") == first.type("SYS", "DIM").removeprefix("SYS>")
    assert second.type("PROG 1", "?LV2;DA1(3);P1;$V1;$A1(0)") == "P01>000|P01>"


def test_lines_that_cannot_be_read_any_more_are_named_and_left_out() -> None:
    first, second = card_with_everything(), Machine(ACR8020)
    first.type("SYS", "DEF CLEAR")
    refused = user_memory.put(second.system, user_memory.take(first.system, values=True))
    assert [line.split(":")[0] for line in refused] == ["PROG1 line 40", "PROG1 line 70"]
    assert "start" in second.type('PASSWORD OFF "s"', "PROG 1", "LIST")


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda path: path.name)
def test_every_example_survives(folder: Path) -> None:
    first, _ = Controller.load(find_project(folder))
    second = Controller(first.model)
    image = user_memory.take(first.system, values=False)
    assert user_memory.put(second.system, image) == []
    for owner in first.system.owners():
        pairs = zip(
            first.system.programs.lines(owner), second.system.programs.lines(owner), strict=True
        )
        for before, after in pairs:
            assert (before.number, before.tree) == (after.number, after.tree)


# Intel-HEX


def test_hex_records_as_a_programmer_reads_them() -> None:
    assert list(hex_records(bytes(range(18)))) == [
        ":10000000000102030405060708090A0B0C0D0E0F78",
        ":020010001011CD",
        ":00000001FF",
    ]
    assert list(hex_records(bytes(65536)))[-2] == ":10FFF00000000000000000000000000000000000" + "01"


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("ESAVE", "P01>"),
        ("ELOAD", "Not valid at this level|P01>"),
        ("ERASE", "Not valid at this level|P01>"),
        ("FLASH SAVE", "Not valid at this level|P01>"),
        ("BRESET", "Not valid at this level|P01>"),
        ("PROM 0", "Not valid at this level|P01>"),
        ("FIRMWARE BACKUP", "Not valid at this level|P01>"),
    ],
)
def test_all_but_esave_belong_to_the_system_level(line: str, answer: str) -> None:
    card = Controller()
    card.send("PROG1\r")
    assert card.send(line + "\r").removeprefix(line + "\r\n").replace("\r\n", "|") == answer


KEPT_FLAGS = (
    *(8453, 8464, 8468, 8469, 8470, 8471, 8468 + 7 * 32),
    *(16144, 16145, 16146, 16152, 16153, 16154, 16144 + 7 * 32, 5651),
)
KEPT_PARAMETERS = (12370, 12376, 12401, 12402, 12401 + 7 * 256, 8211, 8211 + 7 * 256)
STATES = (8448, 8465, 8467, 8477, 8479, 16131, 16132, 16134, 5650)


def test_esave_keeps_the_flags_and_parameters_beside_its_commands_and_no_states() -> None:
    card = Controller("ACR8020")
    for flag in (*KEPT_FLAGS, *STATES):
        card.bit[flag] = True
    for number, value in zip(KEPT_PARAMETERS, range(2, 9), strict=True):
        card.p[number] = value
    card.send("ESAVE\rREBOOT\r")
    assert [flag for flag in KEPT_FLAGS if not card.bit[flag]] == []
    assert [card.p[number] for number in KEPT_PARAMETERS] == [2, 3, 4, 5, 6, 7, 8]
    assert [flag for flag in STATES if card.bit[flag]] == []
    assert not card.bit[16148]


def test_cleared_flags_come_back_cleared_and_the_others_of_their_word_stay() -> None:
    card = Controller("ACR8020")
    card.send("ESAVE\r")
    for flag in (16144, 16132, 5651, 5633):
        card.bit[flag] = True
    card.send("ELOAD\r")
    assert [card.bit[flag] for flag in (16144, 16132, 5651, 5633)] == [False, True, False, True]


def test_a_machine_with_closed_contacts_moves_after_reboot() -> None:
    card = Controller("ACR8020")
    for number in (0, 1):
        card.set_input(number, True)
    card.send('PROG0\rATTACH MASTER0\rATTACH SLAVE0 AXIS0 "X"\rHLBIT X0\rSET 16144\rSET 16145\r')
    card.send("HLIM X3\rESAVE\rREBOOT\r")
    card.advance(seconds=0.1)
    card.send("PROG0\rVEL 10 ACC 0 DEC 0 STP 0\rX5\r")
    card.advance(seconds=1)
    assert (card.p[12288], card.bit[8467]) == (5, False)
