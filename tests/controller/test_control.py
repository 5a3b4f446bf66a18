"""Programs and motion started, held and ended from a terminal, and the card restarted."""

import struct

import pytest
from tests.controller.hosts import X_AND_Y, Host, connected, store

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.models import MODELS
from openacr.plant import schema

PAUSED = 1048


def shuttle(host: Host) -> None:
    """A program that is always under distance; it counts its rounds in P0."""
    host.type("SYS", "DIM P(10)", "PROG0")
    store(host, "_L", "X50", "X0", "P0=P0+1", "GOTO L")
    host.type("RUN")
    host.card.advance(400)
    assert host.ask("?BIT516") == "-1"


@pytest.mark.req("ACR-RUN-07", "ACR-CMD-HALT")
@pytest.mark.parametrize("line", ["HALT", "HALT PROG0", "HALT ALL"])
def test_halt_stops_motion_and_ends_the_program(axes: Host, line: str) -> None:
    shuttle(axes)
    assert axes.type(line) == "P00>"
    axes.card.advance(1000)
    before = axes.asks("?BIT516", "?BIT1024", "?P12288", "?P0")
    assert before[:2] == ["0", "0"]
    axes.card.advance(4000)
    assert axes.asks("?BIT516", "?BIT1024", "?P12288", "?P0") == before


def test_halt_stops_a_plc(axes: Host) -> None:
    axes.type("SYS", "DIM PLC0(1000)", "PLC0")
    axes.type("10 LD 40", "20 OUT 41")
    axes.type("RUN")
    axes.card.bit[40] = True
    axes.card.advance(200)
    assert axes.card.bit[41]
    axes.type("SYS", "HALT PLC0")
    axes.card.bit[40] = False
    axes.card.advance(200)
    assert axes.card.bit[41]


@pytest.mark.req("ACR-RUN-09", "ACR-RUN-10", "ACR-CMD-PAUSE", "ACR-CMD-RESUME")
@pytest.mark.parametrize("which", ["", " PROG0", " ALL"])
def test_pause_holds_the_move_and_resume_ends_it_where_it_was_going(axes: Host, which: str) -> None:
    axes.type("SYS", "DIM P(10)", "PROG0")
    store(axes, "X50", "INH -516", "P0=1")
    axes.type("RUN")
    axes.card.advance(400)
    assert axes.type(f"PAUSE{which}") == "P00>"
    axes.card.advance(1000)
    held = axes.asks("?P12288", f"?BIT{PAUSED}", "?P0")
    assert 0 < int(held[0]) < 50_000
    assert held[1:] == ["-1", "0"]
    axes.card.advance(4000)
    assert axes.asks("?P12288", f"?BIT{PAUSED}", "?P0") == held
    assert axes.type(f"RESUME{which}") == "P00>"
    axes.card.advance(4000)
    assert axes.asks("?P12288", f"?BIT{PAUSED}", "?P0") == ["50000", "0", "1"]


@pytest.mark.req("ACR-CMD-PAUSE", "ACR-CMD-RESUME")
@pytest.mark.parametrize("resume", ["RESUME PROG2", f"CLR {PAUSED + 64}"])
def test_another_program_is_paused_and_resumed_by_its_number(resume: str) -> None:
    host = connected("DIM P(10)", "PROG2", "ATTACH MASTER2", 'ATTACH SLAVE0 AXIS2 "Z"')
    host.type("PPU Z1000", "ACC 1000 DEC 1000 STP 1000 VEL 10")
    assert host.type("PROGRAM", "Z5", "INH -580", "P0=1", "ENDP", "RUN").count("P02>") == 6
    host.card.advance(400)
    host.type("SYS", "PAUSE PROG2")
    host.card.advance(400)
    held = host.card.p[12800]
    assert 0 < held < 5000
    assert [host.card.bit[PAUSED + 32 * n] for n in range(4)] == [False, False, True, False]
    host.card.advance(2000)
    assert host.card.p[12800] == held
    host.type("PROG0", resume)
    host.card.advance(4000)
    assert (host.card.p[12800], host.card.p[0], host.card.bit[PAUSED + 64]) == (5000, 1, False)


@pytest.mark.req("ACR-KAMR-13", "ACR-KAMR-14", "ACR-KAMR-41", "ACR-KAMR-43")
@pytest.mark.parametrize("key", ["\x18", "\x1a"])
def test_ctrl_x_and_ctrl_z_bring_every_axis_to_rest(axes: Host, key: str) -> None:
    axes.type("HLDEC X500 Y500", "Y1000")
    axes.card.advance(400)
    axes.type("SYS", "DIM PROG1(1000)", "PROG1", "PROGRAM", "DWL 100", "ENDP", "RUN", "PROG0")
    started = axes.card.axis(1).commanded_u
    speed = axes.card.axis(1).velocity_ups
    axes.send(key)
    axes.card.advance(4000)
    distance = speed * speed / (2 * 500)
    assert axes.card.axis(1).commanded_u - started == pytest.approx(distance, abs=0.2)
    assert [axes.card.bit[8467 + 32 * n] for n in range(8)] == [True] * 8
    assert axes.asks("?BIT516", "?BIT792", "?BIT824", "?BIT1056") == ["0"] * 4
    enabled = [axes.card.bit[8465 + 32 * n] for n in range(2)]
    assert enabled == [key == "\x18"] * 2


@pytest.mark.req("ACR-KAMR-13", "ACR-KAMR-41", "ACR-KAMR-43")
@pytest.mark.parametrize("key", ["\x18", "\x1a"])
def test_they_reach_the_last_of_sixteen_axes_attached_or_not(key: str) -> None:
    host = connected(model="ACR8020")
    host.send(key)
    host.card.advance(1)
    assert [host.card.bit[8467 + 32 * n] for n in range(16)] == [True] * 16


@pytest.mark.req("ACR-KAMR-29", "ACR-KAMR-38")
def test_ctrl_y_reaches_the_last_of_sixteen_axes_and_masters() -> None:
    host = connected(model="ACR8020")
    kills = [8467 + 32 * n for n in range(16)]
    kills += [base + 32 * n for base in (522, 7434) for n in range(8)]
    for number in kills:
        host.card.bit[number] = True
    host.card.advance(1)
    assert all(host.card.bit[number] for number in kills)
    host.send("\x19")
    host.card.advance(1)
    assert not any(host.card.bit[number] for number in kills)


@pytest.mark.req("ACR-KAMR-29", "ACR-KAMR-38", "ACR-KAMR-42")
def test_ctrl_y_clears_the_kills_of_all_axes_and_masters_and_moves_nothing(axes: Host) -> None:
    axes.type("X1000")
    axes.card.advance(400)
    axes.send("\x18")
    axes.card.advance(2000)
    assert axes.card.bit[522]
    axes.send("\x19")
    kills = [8467 + 32 * n for n in range(8)] + [522 + 32 * n for n in range(8)]
    assert [axes.card.bit[number] for number in kills] == [False] * 16
    before = axes.asks("?P12290", "?P12294")
    axes.card.advance(2000)
    assert axes.asks("?P12290", "?P12294") == before
    assert axes.type("X0 Y0") == "P00>"


@pytest.mark.req("ACR-KAMR-34")
@pytest.mark.parametrize("by", ["terminal", "program", "packet"])
def test_kill_all_moves_can_be_set_by_terminal_program_and_packet(axes: Host, by: str) -> None:
    axes.type("X1000")
    axes.card.advance(400)
    if by == "terminal":
        axes.type("SET 522")
    elif by == "program":
        axes.type("PROG1", "10 SET 522", "RUN", "PROG0")
    else:
        Host(axes.card, StreamKind.PACKETS).raw(b"\x1c" + struct.pack("<H", 522))
    axes.card.advance(5)
    here = axes.card.axis(0).commanded_cnt
    axes.card.advance(2000)
    assert (axes.card.bit[522], axes.card.bit[516]) == (True, False)
    assert 0 < axes.card.axis(0).commanded_cnt == here < 1_000_000
    assert axes.type("X0") == "Master Kill All Moves Request Active|P00>"


@pytest.mark.req("ACR-KAMR-11")
def test_a_host_may_set_the_kill_flag_with_a_packet(axes: Host) -> None:
    packets = Host(axes.card, StreamKind.PACKETS)
    axes.type("X1000")
    axes.card.advance(400)
    packets.raw(b"\x1c" + struct.pack("<H", 8467))
    axes.card.advance(2000)
    assert axes.ask("?BIT516") == "0"
    assert axes.type("X0") == "Associated Slave Kill Motion Request Active|P00>"


def test_drive_off_and_on_in_one_breath_lifts_what_a_limit_has_left(axes: Host) -> None:
    axes.type("X1000")
    axes.card.advance(400)
    axes.type("SET 8467")
    axes.card.advance(2000)
    assert axes.ask("?BIT8499") == "-1"
    assert axes.type("CLR 8467", "DRIVE OFF X", "DRIVE ON X") == "P00>" * 3
    axes.card.advance(100)
    assert axes.asks("?BIT8465", "?BIT8499", "?BIT522") == ["-1", "0", "0"]
    assert axes.type("Y5") == "P00>"
    axes.card.advance(2000)
    assert axes.ask("?P12544") == "5000"


def test_a_limit_switch_stops_the_axis_and_the_host_gets_it_going_again() -> None:
    default = schema.default_world(MODELS["ACR9000"])
    limited = schema.Axis(
        number=0, drive=default.axis[0].drive, encoder_lines=1000,
        positive_limit=schema.LimitSwitch(at=20.0, input=0),
    )  # fmt: skip
    world = schema.World(card=default.card, axis=(limited, *default.axis[1:]))
    host = Host(Controller(world=world))
    host.type(*X_AND_Y, "HLIM X3", "HLDEC X1000")
    host.card.advance(100)
    host.type("X100")
    host.card.advance(3000)
    assert host.asks("?BIT516", "?BIT8467") == ["0", "-1"]
    assert int(host.ask("?P4600")) & 7 == 1
    assert 20_000 < int(host.ask("?P12290")) < 40_000
    assert host.type("CLR 8467", "AXIS0 DRIVE OFF", "AXIS0 DRIVE ON") == "P00>" * 3
    host.card.advance(100)
    assert host.type("Y3") == "P00>"
    host.card.advance(2000)
    assert host.ask("?P12544") == "3000"
    assert host.type("X/-30") == "P00>"
    host.card.advance(4000)
    assert int(host.ask("?P4600")) & 7 == 0
    assert host.ask("?BIT8467") == "0"


@pytest.mark.req("ACR-RST-01", "ACR-IMM-05")
def test_a_reboot_ends_everything_and_forgets_programs_without_a_battery(axes: Host) -> None:
    shuttle(axes)
    axes.type("SET 32")
    other = Host(axes.card)
    other.type("PROG5")
    axes.send("REBOOT\r")
    axes.heard()
    axes.card.advance(1000)
    assert axes.asks("?BIT1024", "?BIT32", "?BIT516", "?P4097") == ["0"] * 4
    assert other.send("\r") == "|SYS>"
    assert axes.type("PROG0", "LIST") == "P00>P00>"


@pytest.mark.req("ACR-RUN-03")
def test_pboot_starts_a_program_at_power_up() -> None:
    host = connected("DIM P(10)", "DIM PROG0(1000)", "PROG0", model="ACR8020")
    store(host, "PBOOT", "_L", "DWL 0.01", "SET 33", "GOTO L")
    assert host.ask("?BIT1024") == "0"
    host.send("REBOOT\r")
    host.heard()
    host.card.advance(200)
    assert host.asks("?BIT1024", "?BIT33") == ["-1", "-1"]


def test_a_plc_reads_names_with_digits() -> None:
    model = schema.Card(digits_in_names=True).board
    host = Host(Controller(model))
    host.type("DIM PLC0(500)", "DIM DEF(4)", "#DEFINE Valve1 BIT32", "PLC0")
    host.type("#DEFINE Door2 BIT128", "10 LD Door2", "20 OUT Valve1")
    assert host.type("LIST") == "10 LD Door2|20 OUT Valve1|PLC0>"
    host.type("RUN", "SET 128")
    host.card.advance(200)
    assert host.ask("?BIT32") == "-1"
