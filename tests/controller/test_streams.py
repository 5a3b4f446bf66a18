"""Several hosts on one card (terminal protocol, section 1)."""

import pytest
from tests.controller.hosts import X_AND_Y, Host, connected, store

from openacr.channels import StreamKind
from openacr.controller import Controller
from openacr.errors import NoFreeStreamError
from openacr.map.rows import devices

DATA = bytes.fromhex("00 30 02 01")


def test_four_network_hosts_at_once_then_no_stream_is_free(host: Host) -> None:
    others = [Host(host.card) for _ in range(3)]
    names = [host.card.streams.session(each.stream) for each in (host, *others)]
    assert [session and session.name for session in names] == [
        "STREAM2", "STREAM3", "STREAM4", "STREAM5"
    ]  # fmt: skip
    with pytest.raises(NoFreeStreamError):
        host.card.open_stream(StreamKind.TERMINAL)
    others[1].close()
    again = Host(host.card)
    session = host.card.streams.session(again.stream)
    assert session is not None
    assert session.name == "STREAM4"


def test_packet_connections_take_no_stream(host: Host) -> None:
    packets = [Host(host.card, StreamKind.PACKETS) for _ in range(6)]
    assert [each.raw(DATA) for each in packets] == [DATA + bytes(4)] * 6
    assert not host.card.bit[8467]
    assert Host(host.card).ask("?1") == "1"


def test_a_new_connection_begins_at_sys_whatever_the_one_before_did(host: Host) -> None:
    host.send("PROG4\rECHO 7\rMODE 3\r?1")
    host.close()
    assert Host(host.card).send("?2\r") == "?2|2|SYS>"


def test_serial_lines_have_their_own_streams(host: Host) -> None:
    first, second = Host(host.card, StreamKind.SERIAL), Host(host.card, StreamKind.SERIAL)
    assert first.type("PROG1") == "P01>"
    assert second.ask("?1") == "1"
    with pytest.raises(NoFreeStreamError):
        host.card.open_stream(StreamKind.SERIAL)


def test_xoff_holds_the_answers_of_a_serial_line_and_xon_lets_them_go(host: Host) -> None:
    serial = Host(host.card, StreamKind.SERIAL)
    assert serial.send("\x13?1\r") == ""
    assert serial.send("\x11") == "?1|1|SYS>"


def test_the_line_printed_by_a_program_reaches_only_who_listens(axes: Host) -> None:
    other = Host(axes.card)
    store(axes, "DWL 0.1", 'PRINT "text"')
    assert axes.type("RUN") == "P00>"
    other.type("PROG0", "LISTEN")
    assert other.after(500) == "text|"
    assert axes.heard() == ""


# lines that wait


def test_a_dwell_is_answered_when_it_is_over(host: Host) -> None:
    assert host.send("DWL 0.5\r") == "DWL 0.5|"
    assert host.after(990) == ""
    assert host.after(20) == "SYS>"


def test_inhibit_is_answered_when_the_flag_comes(host: Host) -> None:
    assert host.send("INH 32\r") == "INH 32|"
    assert host.after(5000) == ""
    host.card.bit[32] = True
    assert host.after(4) == "SYS>"


def test_a_move_into_a_full_buffer_is_answered_when_there_is_room(axes: Host) -> None:
    assert axes.type("X10", "X20") == "P00>P00>"
    assert axes.send("X30\r") == "X30|"
    while not (heard := axes.after(1)):
        assert axes.card.p[12288] <= 10000
    assert heard == "P00>"
    assert axes.card.p[12288] == pytest.approx(10000, abs=200)
    assert axes.type("PROG0") == "P00>"


def test_output_before_a_wait_is_sent_before_it(host: Host) -> None:
    assert host.send("PRINT 1:DWL 0.1:PRINT 2\r") == "PRINT 1:DWL 0.1:PRINT 2|1|"
    assert host.after(300) == "2|SYS>"


def test_typed_ahead_lines_are_executed_in_their_turn(host: Host) -> None:
    assert host.send("DWL 0.1\rPROG3\r?BIT32\rSET 32\r") == "DWL 0.1|PROG3|?BIT32|SET 32|"
    assert host.after(300) == "SYS>P03>0|P03>P03>"
    assert host.card.bit[32]


def test_other_streams_do_not_wait(axes: Host) -> None:
    other = Host(axes.card)
    axes.send("DWL 10\r")
    assert other.ask("?1") == "1"
    assert axes.after(100) == ""


def test_blocked_lines_end_at_the_same_tick_however_time_is_cut() -> None:
    def answered(step: int) -> tuple[list[str], str]:
        host = connected(*X_AND_Y)
        host.send("X1:X2:X3\rPRINT 1:DWL 0.1:PRINT P6916\r?P6916\r")
        heard = []
        for _ in range(4000 // step):
            heard.append(host.after(step))
        return ["".join(heard)], host.card.digest()

    assert answered(1) == answered(40) == answered(4000)


def test_a_host_that_leaves_takes_its_waiting_line_with_it(host: Host) -> None:
    host.send("INH 32:SET 40\rSET 41\r")
    host.close()
    host.card.bit[32] = True
    host.card.advance(100)
    assert not host.card.bit[40]
    assert not host.card.bit[41]
    assert Host(host.card).ask("?BIT32") == "-1"


def test_a_reboot_starts_every_stream_afresh(axes: Host) -> None:
    other = Host(axes.card)
    other.send("PROG3\rECHO 4\r")
    axes.send("X100\rREBOOT\r")
    axes.heard()
    assert axes.asks("?P12288", "?BIT516", "?BIT8465") == ["0", "0", "0"]
    assert other.ask("?1") == "1"
    axes.send("\r")
    assert axes.send("\r") == "|SYS>"


def test_programs_and_lines_of_several_hosts_run_side_by_side_after_a_reboot(axes: Host) -> None:
    other = Host(axes.card)
    axes.send("REBOOT\r")
    axes.heard()
    axes.type("DIM P(10)", "PROG0")
    store(axes, "_L", "P0=P0+1", "DWL 0.001", "GOTO L")
    assert axes.type("RUN") == "P00>"
    other.send("DWL 0.05:PRINT 7\r")
    axes.card.advance(60)
    assert axes.ask("?1+2") == "3"
    axes.card.advance(60)
    assert other.heard() == "7|SYS>"
    assert float(axes.ask("?P0")) > 20


@pytest.mark.parametrize("model", ["ACR1505", "ACR8020", "ACR9000", "ACR9030", "ACR9040"])
def test_every_model_can_be_talked_to(model: str) -> None:
    card = Controller(model)
    assert card.send("?1\r") == "?1\r\n1\r\nSYS>"
    assert [Host(card).ask("?2") for _ in range(4)] == ["2"] * 4


def test_a_serial_line_counts_what_waits_and_what_was_executed() -> None:
    card = Controller()
    serial = Host(card, StreamKind.SERIAL)
    assert [card.p[n] for n in (7008, 7009, 7010, 7011)] == [0, 0, 256, 0]
    serial.send("DWL 1\r?1\r?2\rVEL")
    assert [card.p[n] for n in (7008, 7009, 7010, 7011)] == [9, 2, 247, 1]
    card.advance(seconds=1.1)
    assert [card.p[n] for n in (7008, 7009, 7010, 7011)] == [3, 0, 253, 3]
    assert [card.p[n] for n in (7024, 7025, 7027)] == [0, 0, 0]


def test_the_free_space_of_a_line_is_that_of_its_dimension(host: Host) -> None:
    host.type("DIM COM1(1000)")
    Host(host.card, StreamKind.SERIAL).send("VE")
    assert host.ask("?P7010") == "998"


def test_bytes_in_strings_and_remarks_are_kept_as_they_were_sent(host: Host) -> None:
    host.send("ECHO 0\r")
    assert host.send(b'?LEN("\xe4\x96");"\xe4\x96\x92"\r') == "2\xe4\x96\x92|SYS>"
    assert host.send(b'?LEN("\xc3\xa4");"\xc3\xa4"\r') == "2\xc3\xa4|SYS>"
    assert host.send(b"?5\x962;\x93\xe2\x80\x9d\r") == "3|SYS>"
    host.send("PROG0\r")
    assert host.send(b"10 REM it\x92s \xe4\r") == "P00>"
    assert host.send("LIST\r") == "10 REM it\x92s \xe4|P00>"


@pytest.mark.parametrize("device", [0, 1])
def test_a_sender_is_held_while_64_kib_wait_for_a_program_and_let_go_at_half(
    axes: Host, device: int
) -> None:
    sender, card = Host(axes.card), axes.card
    opening = 'OPEN "STREAM3:" AS #1' if device else "REM"
    axes.type("DIM $V(1,10)")
    store(axes, opening, "INH 33", "WHILE (1)", f"$V0 = INKEY$({device})", "WEND")
    axes.type("RUN")
    if not device:
        sender.type("PROG0", "LISTEN")
    card.advance(100)
    waiting = card.system.devices.row((0, device), devices.characters)
    for size in (*[1024] * 63, 1023):
        sender.send(b"x" * size)
    assert card.accepts_input(sender.stream)
    sender.send(b"x")
    assert (card.accepts_input(sender.stream), card.memory.I[waiting]) == (False, 1 << 16)
    assert card.accepts_input(axes.stream)
    card.bit[33] = True
    while not card.accepts_input(sender.stream):
        assert card.memory.I[waiting] >= 1 << 15
        card.advance(1)
    assert (1 << 15) - 200 < card.memory.I[waiting] < 1 << 15
