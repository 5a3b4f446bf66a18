"""PLCs on a whole card: entered, listed, run and halted as a host does it."""

import pytest
from tests.controller.hosts import Host

from openacr.controller import Controller
from openacr.protocol.events import ControlKey

EXAMPLE = """\
10 LD 0
20 AND NOT 1
30 LD 2
40 AND 3
50 OR LD
60 OUT 32
70 LD 32
80 TIM 0 500
90 LD TIM0
100 OUT 33
110 LD 4
120 LD 5
130 CNT 1 10
140 LD 6
150 LD 7
160 KR 2
170 END""".split("\n")
SLOW_SCAN_S = 0.05
RUNNING = 1536


@pytest.fixture
def host() -> Host:
    """At PLC0 of a card with a battery and room for two PLCs."""
    host = Host(Controller("ACR8020"))
    host.type("", "DIM PLC0(2000)", "DIM PLC1(2000)", "PLC0")
    return host


def entered(host: Host, *lines: str) -> Host:
    assert host.type(*lines) == "PLC0>" * len(lines)
    return host


def listed(host: Host) -> list[str]:
    return host.type("LIST").removesuffix("PLC0>").split("|")[:-1]


# the example


def test_a_listing_is_what_was_typed(host: Host) -> None:
    assert listed(entered(host, *EXAMPLE)) == EXAMPLE


def test_a_listing_read_again_is_the_same_plc(host: Host) -> None:
    entered(host, "10 ldn bit5:and kr3 rem both", "20 out not 32 set33", "30 tim1 : rem wait")
    first = listed(host)
    assert first == [
        "10 LD NOT BIT 5 : AND KR3 REM both", "20 OUT NOT 32 SET 33", "30 TIM 1 : REM wait",
    ]  # fmt: skip
    entered(host, "NEW", *first)
    assert listed(host) == first


# entry and memory


def test_an_instruction_costs_eight_bytes_and_a_remark_nothing(host: Host) -> None:
    entered(host, "10 LD 0 AND 1 TIM 0 500", "20 REM a timer")
    assert host.ask("MEM") == str(2000 - 3 * 8)
    entered(host, "10 LD 0")
    assert host.ask("MEM") == str(2000 - 8)
    entered(host, "10")
    assert host.ask("MEM") == "2000"


def test_text_beyond_the_dimension_is_refused(host: Host) -> None:
    host.type("SYS", "DIM PLC2(24)", "PLC2", "10 LD 0", "20 AND 1 AND 2")
    assert host.type("30 OUT 32") == "Out of memory|PLC2>"


def test_free_form_text_is_listed_with_program_and_endp(host: Host) -> None:
    entered(host, "PROGRAM", "PBOOT", "LD 0", "  OUT 32 : REM lamp", "ENDP")
    assert listed(host) == ["PROGRAM", " PBOOT", " LD 0", " OUT 32 : REM lamp", "ENDP"]
    entered(host, "35 OUT 33", "SET 5651")
    assert listed(host)[2:5] == ["30  LD 0", "35  OUT 33", "40  OUT 32 : REM lamp"]


def test_a_line_is_replaced_and_deleted_by_its_number(host: Host) -> None:
    entered(host, "10 LD 0", "20 OUT 32", "20 OUT 33", "10")
    assert listed(host) == ["20 OUT 33"]
    assert host.type("LIST 10", "LIST 20-") == "PLC0>20 OUT 33|PLC0>"


def test_words_of_acrobasic_are_not_valid_and_others_unknown(host: Host) -> None:
    assert host.type("10 ACC 5", "10 JMP 20", "LD 0") == (
        "Not valid at this level|PLC0>" + "Unknown command|PLC0>" + "Unknown command|PLC0>"
    )


def test_aliases_name_flags_and_numbers(host: Host) -> None:
    host.type("SYS", "DIM DEF(5)", "#DEFINE Start BIT2", "#DEFINE Slow 40", "PLC0")
    entered(host, "10 LD Start", "20 OUT Slow", "RUN")
    assert listed(host) == ["10 LD Start", "20 OUT Slow"]
    host.card.set_input(2, True)
    host.card.advance(1)
    assert host.card.bit[40]
    assert host.type("30 LD Stop") == "Undefined symbol|PLC0>"


# run and halt


def test_at_its_prompt_a_plc_needs_no_target(host: Host) -> None:
    entered(host, "10 LD 0", "20 OUT 32", "RUN")
    assert host.type("NEW") == host.type("PROGRAM") == "Program is running|PLC0>"
    assert host.ask("?BIT 1536") == "-1"
    entered(host, "HALT", "NEW")
    assert listed(host) == []
    assert host.type("LRUN") == "Not valid at this level|PLC0>"


def test_a_plc_that_is_wrong_does_not_start_and_says_why(host: Host) -> None:
    entered(host, "10 LD 0", "20 AND LD", "30 OUT 32")
    assert host.type("RUN") == "PLC error line 20: Stack underflow|PLC0>"
    assert not host.card.bit[RUNNING]
    entered(host, "20", "RUN")


def test_more_than_200_instructions_are_too_long(host: Host) -> None:
    for number in range(10, 210, 10):
        host.type(f"{number} " + "LD 0 OUT 32 " * 5)
    entered(host, "RUN", "HALT", "999 LD 1")
    assert host.type("RUN") == "PLC too long|PLC0>"


def test_a_running_plc_keeps_its_code_until_it_is_run_again(host: Host) -> None:
    card = entered(host, "10 LD 0", "20 OUT 32", "RUN", "20 OUT 33").card
    card.set_input(0, True)
    card.advance(1)
    assert card.bit[32] and not card.bit[33]
    entered(host, "HALT", "RUN")
    card.advance(1)
    assert card.bit[33]


def test_request_flags_are_served_in_the_slow_scan_and_clear_themselves(host: Host) -> None:
    card = entered(host, "10 LD 0", "20 OUT 32", "SET 1538").card
    card.advance(seconds=SLOW_SCAN_S)
    assert card.bit[RUNNING] and not card.bit[1538]
    entered(host, "SET 1539")
    card.advance(seconds=SLOW_SCAN_S)
    assert not card.bit[RUNNING] and not card.bit[1539]
    entered(host, "20 AND LD", "SET 1538")
    card.advance(seconds=SLOW_SCAN_S)
    assert not card.bit[RUNNING] and not card.bit[1538]


def test_a_plc_scans_every_tick_whatever_a_program_does(host: Host) -> None:
    entered(host, "10 LD NOT 32", "20 OUT 32", "RUN")
    host.type("PROG0", "PROGRAM", "_L", "P0=P0+1", "GOTO L", "ENDP", "SYS", "DIM P(1)", "RUN PROG0")
    states = []
    for _ in range(20):
        host.card.advance(1)
        states.append(host.card.bit[32])
    assert states == [True, False] * 10
    assert host.card.p[0] > 0


def test_ctrl_x_halts_plcs(host: Host) -> None:
    entered(host, "10 LD 0", "20 OUT 32", "RUN")
    host.card.press(ControlKey.CTRL_X)
    assert not host.card.bit[RUNNING]


def test_a_trace_holds_the_outputs_of_its_tick(host: Host) -> None:
    card = entered(host, "10 LD NOT 32", "20 OUT 32", "RUN").card
    card.record()
    card.advance(4)
    assert [int(word) for word in card.trace().outputs] == [1, 0, 1, 0]


# restart


def test_a_plc_that_cannot_boot_keeps_no_other_from_it(host: Host) -> None:
    entered(host, "10 PBOOT", "20 OUT 32")
    host.type("PLC1", "10 PBOOT", "20 LD 0", "SYS")
    assert host.type("PBOOT") == "PLC error line 20: LD expected|SYS>"
    assert not host.card.bit[RUNNING] and host.card.bit[RUNNING + 32]
    host.type("HALT ALL", "REBOOT")
    assert not host.card.bit[RUNNING] and host.card.bit[RUNNING + 32]


def test_reboot_halts_plcs_and_keeps_their_text(host: Host) -> None:
    entered(host, *EXAMPLE, "RUN", "REBOOT")
    again = Host(host.card)
    assert not host.card.bit[RUNNING]
    again.type("", "PLC0")
    assert listed(again) == EXAMPLE


def test_a_snapshot_goes_on_in_the_middle_of_a_timer(host: Host) -> None:
    card = entered(host, *EXAMPLE, "RUN").card
    card.set_input(0, True)
    card.advance(701)
    taken = card.snapshot()
    card.advance(400)
    assert card.bit[33]
    after = card.digest()
    entered(host, "NEW PLC1", "HALT", "NEW")
    card.restore(taken)
    assert card.p[6661] == 150 and not card.bit[33]
    card.advance(400)
    assert card.digest() == after
    assert listed(host) == EXAMPLE
