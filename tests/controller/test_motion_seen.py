"""Motion as hosts see it (terminal protocol, section 9)."""

import pytest
from tests.controller.hosts import Host, store


def test_flags_are_set_before_the_reply_to_a_move(axes: Host) -> None:
    assert axes.send("X10\r?BIT516\r") == "X10|P00>?BIT516|-1|P00>"
    axes.card.advance(4000)
    assert axes.asks("?BIT516", "?P12288", "?P12289") == ["0", "10000", "10000"]


@pytest.mark.parametrize("jog", ["FWD", "INC 1", "ABS 1"])
def test_flags_are_set_before_the_reply_to_a_jog(axes: Host, jog: str) -> None:
    words = jog.split()
    line = f"JOG {words[0]} X{''.join(words[1:])}"
    assert axes.send(f"{line}\r?BIT792\r") == f"{line}|P00>?BIT792|-1|P00>"


def test_the_jog_flag_clears_when_the_position_is_final(axes: Host) -> None:
    axes.type("AXIS0 JOG INC 1.5")
    while axes.ask("?BIT792") == "-1":
        axes.card.advance(1)
    assert axes.ask("?P12294") == "1500"
    axes.card.advance(1000)
    assert axes.asks("?P12294", "?P12290", "?P12288") == ["1500", "1500", "0"]


def test_jog_abs_counts_in_the_jog_offset(axes: Host) -> None:
    axes.type("X10")
    axes.card.advance(4000)
    axes.type("AXIS0 JOG ABS 2")
    axes.card.advance(4000)
    assert axes.asks("?P12288", "?P12294") == ["10000", "12000"]
    axes.type("RES X 50", "JOG REN X")
    axes.type("AXIS0 JOG ABS 1")
    axes.card.advance(4000)
    assert axes.ask("?P12297") == "1000"


def test_a_host_may_set_the_target_to_the_position(axes: Host) -> None:
    assert axes.type("P12289=P12288") == "P00>"
    assert axes.ask("?P12288") == axes.ask("?P12289")


def test_halt_all_stops_moves_typed_at_a_prompt(axes: Host) -> None:
    axes.type("X1000")
    axes.card.advance(500)
    assert axes.type("HALT ALL") == "P00>"
    axes.card.advance(2000)
    assert axes.ask("?BIT516") == "0"
    stopped = int(axes.ask("?P12288"))
    assert 0 < stopped < 1000_000
    axes.card.advance(1000)
    assert axes.ask("?P12288") == str(stopped)
    assert axes.type("X0") == "P00>"  # nothing bars the next move


def test_halt_prog_stops_moves_typed_at_its_prompt(axes: Host) -> None:
    axes.type("X1000", "SYS")
    axes.card.advance(500)
    assert axes.type("HALT PROG0") == "SYS>"
    axes.card.advance(2000)
    assert axes.asks("?BIT516", "?BIT8467") == ["0", "0"]


def test_no_limit_shows_while_no_switch_is_active(axes: Host) -> None:
    assert axes.asks("?P4600", "?P4601") == ["0", "0"]


def test_motion_and_programs_go_on_when_the_host_leaves(axes: Host) -> None:
    store(axes, "_L", "DWL 0.1", "GOTO L")
    axes.type("RUN", "X10")
    axes.card.advance(100)
    axes.close()
    axes.card.advance(4000)
    assert axes.card.p[12288] == 10000
    assert axes.card.system.control.is_running(0)
