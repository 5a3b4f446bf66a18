"""One command channel: lines in, answers and prompts out."""

import pytest
from tests.basic.machine import Machine

from openacr.channels import Attention
from openacr.errors import CardError
from openacr.messages import DIVIDE_BY_ZERO


@pytest.fixture
def bench() -> Machine:
    return Machine()


@pytest.mark.parametrize(
    "line", ["", "   ", ":", "REM any text: here", "' a comment", "NONSENSE", "P0 = ", "(", '"']
)
def test_every_line_is_answered_by_exactly_one_prompt(bench: Machine, line: str) -> None:
    answer = bench.type("PROG 2", line)
    assert answer.endswith("P02>")
    assert answer.count(">") == 2


def test_an_unknown_word_has_its_message_on_a_line_of_its_own(bench: Machine) -> None:
    assert bench.type("NONSENSE 5") == "Unknown command|SYS>"


def test_an_overlong_line_is_refused(bench: Machine) -> None:
    bench.session.line_too_long()
    assert bench.sent() == "Line too long|SYS>"


def test_echo_modes_switch_off_errors_and_prompts(bench: Machine) -> None:
    assert bench.type("ECHO") == "1|SYS>"
    assert bench.type("ECHO 4") == ""
    assert bench.type("NONSENSE") == "Unknown command|"
    assert bench.type("ECHO") == "4|"
    assert bench.type("ECHO 2") == "SYS>"
    assert bench.type("NONSENSE") == "SYS>"
    assert bench.type("ECHO 8") == "SYS>"
    assert bench.session.echo == 2


def test_a_line_that_waits_is_answered_when_it_is_done(bench: Machine) -> None:
    bench.session.busy = True
    bench.session.write("1\r\n")
    assert bench.sent() == ""
    bench.session.finished()
    assert bench.sent() == "1|SYS>"
    assert bench.type("PROG 0", "?2 : DWL 0.01") == "P00>2|"
    bench.advance(30)
    assert bench.sent() == "P00>"


def test_an_error_at_the_end_of_a_long_line_is_reported(bench: Machine) -> None:
    bench.session.busy = True
    bench.session.finished(CardError(DIVIDE_BY_ZERO))
    assert bench.sent() == "Divide by zero|SYS>"


@pytest.mark.parametrize(
    ("line", "answer"),
    [
        ("PROG1 : ATTACH", "ATTACH MASTER1|P01>"),
        ("PROG (0+1) ATTACH : ACC 7 : PROG0 : ACC", "ATTACH MASTER1|20000|P00>"),
        ("PROG0 : SYS : ACC", "Unknown command|SYS>"),
        ("PROG1 : FOO : PROG0", "Unknown command|P01>"),
        ("PROG99 : ACC", "Invalid argument|P00>"),
        ("PROG1 : 'nothing", "P01>"),
        ("PROG1 : ACC : REM the rest", "20000|P01>"),
        ("IF (0) THEN PROG1 : ACC", "P00>"),
    ],
)
def test_what_follows_a_change_of_level_is_done_there(line: str, answer: str) -> None:
    card = Machine()
    card.type("PROG1", "ATTACH MASTER1", "PROG0", "ATTACH MASTER0")
    assert card.type(line) == answer


def test_the_rest_of_a_line_waits_for_what_stands_before_it() -> None:
    card = Machine()
    card.type("PROG1", "ATTACH MASTER1", "PROG0", "ATTACH MASTER0")
    assert card.type("ACC 5 : DWL 0.005 : PROG1 : ACC : DWL 0.005 : PROG0 : ACC") == ""
    card.advance(12)
    assert card.sent() == "20000|"
    assert card.session.state().rest.split() == [":", "ACC"]
    card.advance(12)
    assert card.sent() == "5|P00>"


def test_a_lost_connection_ends_the_line_with_its_rest() -> None:
    card = Machine()
    card.type("DWL 0.005 : PROG1 : SET 32")
    card.session.disconnect()
    card.session.connect()
    card.advance(20)
    assert (card.sent(), card.card.memory.bit(32)) == ("", False)


# storing


@pytest.mark.parametrize("line", ["0 VER", "1000000 VER", "1.5 VER", "10 20 VER", "10 20"])
def test_a_line_has_one_number_whole_and_of_six_digits(bench: Machine, line: str) -> None:
    assert bench.type("PROG 0", line, "LIST") == "P00>Syntax error|P00>P00>"


def test_a_line_that_cannot_be_read_is_not_stored(bench: Machine) -> None:
    assert bench.type("PROG 0", "10 NONSENSE", "LIST") == "P00>Unknown command|P00>P00>"


def test_storing_sets_program_modified(bench: Machine) -> None:
    bench.type("PROG 3", "10 VER")
    assert bench.card.memory.bit(1024 + 32 * 3 + 5)


def test_a_refused_line_inside_program_is_left_out(bench: Machine) -> None:
    answer = bench.type("PROG 0", "PROGRAM", "NONSENSE", "LIST", "REBOOT", "ENDP")
    assert answer == "P00>P00>Unknown command|P00>" + "Not valid at this level|P00>" * 2 + "P00>"
    assert bench.type("LIST") == "PROGRAM|ENDP|P00>"


@pytest.mark.parametrize(
    ("line", "prompt"), [("SYS", "SYS>"), (": PROG 5", "P05>"), ("PLC1", "PLC1>")]
)
def test_a_level_command_ends_the_text_as_endp_would(
    bench: Machine, line: str, prompt: str
) -> None:
    assert bench.type("PROG 0", "PROGRAM", "DWL 1", line) == f"P00>P00>P00>{prompt}"
    assert bench.type("PROG 0", "LIST") == "P00>PROGRAM| DWL 1|ENDP|P00>"


def test_the_misprint_of_program_and_label_on_one_line_is_understood(bench: Machine) -> None:
    bench.type("PROG 0", "PROGRAM0_start", "GOTO start", "ENDP")
    assert bench.type("LIST") == "PROGRAM| _start| GOTO start|ENDP|P00>"


def test_program_may_carry_a_remark_and_nothing_else(bench: Machine) -> None:
    assert bench.type("PROG 0", "PROGRAM X10") == "P00>Syntax error|P00>"
    assert bench.session.capture is None
    bench.type("PROGRAM : REM main", "ENDP")
    assert bench.type("LIST") == "PROGRAM : REM main|ENDP|P00>"


def test_the_text_of_a_running_program_is_not_replaced(bench: Machine) -> None:
    bench.type("PROG 0", "10 DWL 1", "RUN")
    assert bench.type("PROGRAM", "LIST") == "Program is running|P00>10 DWL 1|P00>"


# listening


def test_an_lrun_that_is_refused_gives_the_prompt_back(
    bench: Machine, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refuse(_program: int, _line: int | None = None) -> None:
        raise CardError(DIVIDE_BY_ZERO)

    monkeypatch.setattr(bench.control, "run", refuse)
    bench.type("PROG 0", "10 DWL 1")
    assert bench.type("LRUN") == "Divide by zero|P00>"
    assert bench.session.attention is Attention.COMMANDS


def test_the_prompt_returns_once_when_a_program_followed_with_lrun_ends(bench: Machine) -> None:
    bench.type("PROG 0", "10 DWL 1", "LRUN")
    bench.system.listeners.print(0, "done\r\n")
    bench.system.listeners.ended(0)
    bench.system.listeners.ended(0)
    assert bench.sent() == "done|P00>"
    assert bench.session.attention is Attention.COMMANDS


def test_the_other_side_may_end_talk_to_as_well(bench: Machine) -> None:
    other = bench.connect("COM2")
    bench.type("TALK TO COM2")
    other.escape()
    assert bench.sent(other) == "|SYS>"
    assert bench.sent() == "|SYS>", "the line that began it is answered, once"
    assert bench.type("ECHO") == "1|SYS>"


@pytest.mark.parametrize("who", ["caller", "called"])
def test_a_lost_connection_ends_talk_to_for_the_one_who_stays(bench: Machine, who: str) -> None:
    other = bench.connect("COM2")
    bench.type("TALK TO COM2")
    gone, left = (bench.session, other) if who == "caller" else (other, bench.session)
    gone.disconnect()
    gone.connect()
    assert left.attention is gone.attention is Attention.COMMANDS
    assert bench.sent(left) == ("" if who == "caller" else "|SYS>")


def test_a_channel_that_talks_already_is_in_use(bench: Machine) -> None:
    bench.connect("COM2")
    third = bench.connect("FIFO")
    bench.type("TALK TO COM2")
    assert bench.type("TALK TO COM2", on=third) == "Device in use|SYS>"
    assert bench.type("TALK TO COM1", on=third) == "Device in use|SYS>"


def test_a_lost_connection_ends_listening_and_capture_and_starts_afresh(bench: Machine) -> None:
    bench.type("PROG 1", "PROGRAM", "DWL 1")
    bench.session.disconnect()
    bench.session.write("lost")
    bench.session.connect()
    assert bench.type("") == "SYS>"
    assert not bench.system.programs.is_empty(1)


def test_the_state_of_a_channel_survives_a_snapshot(bench: Machine) -> None:
    bench.type("PROG 7", "ECHO 3", "MODE 1", "PROGRAM")
    other = Machine()
    other.session.restore(bench.session.state())
    assert other.session.state() == bench.session.state()
    assert other.session.prompt == "P07>"
