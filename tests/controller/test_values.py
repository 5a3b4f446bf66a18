"""How values and errors look (terminal protocol, sections 4 and 6)."""

import re

import pytest
from tests.controller.hosts import Host


def test_positions_and_flag_words_are_plain_integers(axes: Host) -> None:
    axes.type("X-12.345")
    axes.card.advance(2000)
    integers = [12288, 12289, 12290, 12294, 6144, 4096, 4097, 4112, 4120, 4600]
    for value in axes.asks(*(f"?P{number}" for number in integers)):
        assert re.fullmatch(r"-?\d+", value)
    assert axes.ask("?P12288") == "-12345"


def test_floats_print_with_the_digits_they_need(axes: Host) -> None:
    axes.type("X/0.0", "ACC 10000", "DEC 0.0001", "STP 4.9", "VEL 1000")
    assert axes.asks("?ACC", "?DEC", "?STP", "?VEL") == ["10000", "0.0001", "4.9", "1000"]
    axes.type("SYS", "DIM P(10)", "PROG0", "P0=1/3", "P1=100000000", "P2=123456.5")
    for value in axes.asks("?P0", "?P1", "?P2", "?1/3"):
        assert re.fullmatch(r"-?\d+(\.\d+)?", value)
    assert axes.ask("?P1") == "100000000"


def test_a_float_of_the_system_has_seven_digits(host: Host) -> None:
    host.card.p[8192 + 21] = 1 / 3  # any FP32 parameter
    value = host.ask("?P8213")
    assert len(value.lstrip("0.")) <= 7


def test_drive_reports_begin_with_the_words_hosts_look_for(axes: Host) -> None:
    assert axes.ask("DRIVE X").startswith("DRIVE ON")
    assert axes.ask("DRIVE AXIS0").startswith("DRIVE ON")
    assert axes.type("AXIS0 DRIVE OFF") == "P00>"
    for query in ("DRIVE X", "DRIVE AXIS0"):
        report = axes.ask(query)
        assert report.startswith("DRIVE OFF")
        assert "ON" not in report


@pytest.mark.parametrize("line", ["DRIVE ON X Y", "DRIVE ON AXIS0", "AXIS0 DRIVE ON"])
def test_drives_are_switched_in_all_forms(axes: Host, line: str) -> None:
    axes.type("DRIVE OFF X Y")
    assert axes.ask("DRIVE X").startswith("DRIVE OFF")
    axes.type(line)
    axes.card.advance(100)
    assert axes.ask("DRIVE X").startswith("DRIVE ON")


def test_errors_stand_on_a_line_of_their_own(axes: Host) -> None:
    assert axes.type("SYS", "X1") == "SYS>Unknown command|SYS>"
    axes.type("PROG0", "X100")
    assert axes.type("RES X") == "Not valid while in motion|P00>"


def test_no_error_text_contains_a_prompt_character() -> None:
    from openacr.messages import MESSAGES

    assert all(">" not in message.text for message in MESSAGES.values())


def test_hosts_may_run_their_set_up_again(host: Host) -> None:
    set_up = (
        "DIM P(100)", "DIM DEF(10)", "DIM PROG 15 16384", "#DEFINE started P50",
        "PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X1000", "SYS",
    )  # fmt: skip
    assert host.type(*set_up).count("|") == 0
    host.type("P50=3")
    again = host.type(*set_up)
    assert again.count(">") == len(set_up)
    assert "Re-dimensioned block|SYS>" in again
    assert host.asks("?started", "?P50") == ["3", "3"]
    assert host.type("PROG0", "ATTACH") == 'P00>ATTACH MASTER0|ATTACH SLAVE0 AXIS0 "X"|P00>'
    assert host.type("DRIVE ON X", "X1", "PROG15", "PROGRAM", "ENDP").count("|") == 0
    host.card.advance(2000)
    assert host.ask("?P12288") == "1000"
