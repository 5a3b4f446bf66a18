from collections.abc import Iterator
from itertools import pairwise

import pytest
from tests.client.cards import with_axis, wrapped

from openacr.channels import EchoMode
from openacr.client import Card, Level, NoReplyError, Options, RefusedError
from openacr.controller import Controller
from openacr.errors import MapError, UserError
from openacr.messages import UNKNOWN_COMMAND
from openacr.protocol.bits import ClearBit, SetBit


@pytest.fixture(params=[(1, True), (4, True), (0, False)], ids=["echo 1", "echo 4", "text only"])
def card(request: pytest.FixtureRequest) -> Iterator[Card]:
    """A card in this process, in every mode the client knows."""
    echo, uses_packets = request.param
    with Card.open(Controller(), Options(echo=EchoMode(echo), uses_packets=uses_packets)) as card:
        yield card


def test_commands_give_what_the_card_prints(card: Card) -> None:
    assert card.command("VER") == ["ACR9000 Version 1.18.06 Update 15"]
    assert card.command("AXIS0 PPU 2000") == []
    assert card.command("AXIS0 PPU") == ["2000"]
    assert card.command('PRINT "a>b"') == ["a>b"]
    assert card.ask("1+2*3") == 7


def test_a_refused_line_is_an_exception_with_line_and_text(card: Card) -> None:
    with pytest.raises(RefusedError) as refused:
        card.command("X10")
    assert (refused.value.line, refused.value.text) == ("X10", "Unknown command")
    assert refused.value.message is UNKNOWN_COMMAND
    assert "program level" in str(refused.value)
    assert card.ask("1") == 1


def test_parameters_by_number_and_name(card: Card) -> None:
    card.p[12375] = 800
    assert card.p["axis0.ppu"] == 800
    assert card.p["P12375"] == 800
    card.p["axis0.proportional gain"] = 0.1
    assert card.p[12304] == pytest.approx(0.1, rel=1e-6)
    card.p[4097] = -5
    assert card.p[4097] == -5
    assert isinstance(card.p[4097], int)


def test_user_variables_keep_all_their_digits(card: Card) -> None:
    card.command("DIM P(10)")
    card.p[3] = 1 / 3
    assert card.p[3] == pytest.approx(1 / 3, rel=1e-9)


def test_many_parameters_come_in_the_order_asked(card: Card) -> None:
    for axis in range(8):
        card.p[f"axis{axis}.ppu"] = 100 + axis
    numbers = [12375 + 256 * axis for axis in (7, 0, 3)]
    assert card.read_many([*numbers, 6916, 12375]) == [107, 100, 103, card.p[6916], 100]


def test_eight_axes_are_read_with_one_packet() -> None:
    card, link = wrapped()
    before = link.writes
    assert card.read_many([12288 + 256 * axis for axis in range(8)]) == [0] * 8
    assert link.writes == before + 1


def test_flags_by_number_and_name(card: Card) -> None:
    card.bit[32] = True
    card.bit["BIT33"] = True
    assert card.read_bits([32, 33, 34]) == [True, True, False]
    card.bit[32] = False
    assert not card.bit[32]
    assert not card.bit["master0.in motion"]


@pytest.mark.parametrize(
    ("what", "error", "text"),
    [
        ("axis0.folowing error", MapError, "perhaps Following Error"),
        ("following error", UserError, "name the object too"),
    ],
)
def test_a_name_that_means_nothing_or_several_things(
    card: Card, what: str, error: type[Exception], text: str
) -> None:
    with pytest.raises(error, match=text):
        card.read(what)


def test_arrays_of_a_program(card: Card) -> None:
    card.command("DIM LA(1)", program=2)
    card.command("DIM LA0(4)", program=2)
    card.write_array(2, "LA0", [5, -6], first=1)
    assert card.read_array(2, "la 0") == [0, 5, -6, 0]
    assert card.read_array(2, "LA0", range(1, 3)) == [5, -6]
    assert card.read_array(2, "DA0") == []
    with pytest.raises(UserError, match="is not a numeric array"):
        card.read_array(2, "XA0")


@pytest.mark.parametrize("word", ["LA", "SA"])
def test_long_arrays_are_read_whole_or_in_parts(card: Card, word: str) -> None:
    for line in (f"DIM {word}(2)", f"DIM {word}0(3)", f"DIM {word}1(600)"):
        card.command(line, program=2)
    values = [-7 if word == "LA" else -7.25, 5, 11]
    for index, value in zip((0, 255, 599), values, strict=True):
        card.write_array(2, f"{word}1", [value], first=index)
    whole: list[float] = [0] * 600
    whole[0], whole[255], whole[599] = values
    assert card.read_array(2, f"{word}1") == whole
    assert card.read_array(2, f"{word}1", range(250, 600, 5)) == whole[250:600:5]
    assert card.read_array(2, f"{word}1", range(599, 598, -1)) == [11]
    assert card.read_array(2, f"{word}1", range(0)) == []
    for array, part in ((1, range(599, 601)), (1, range(-1, 1)), (2, range(1))):
        with pytest.raises(RefusedError):
            card.read_array(2, f"{word}{array}", part)


def test_a_thousand_elements_are_read_with_few_packets() -> None:
    card, link = wrapped()
    for line in ("DIM LA(1)", "DIM LA0(4000)"):
        card.command(line, program=2)
    card.read_array(2, "LA0", range(1))
    before = link.writes
    assert card.read_array(2, "LA0", range(4000)) == [0] * 4000
    assert link.writes == before + 5  # four words that lead to it, 16 packets of 255 at once


def test_levels_are_reached_when_needed(card: Card) -> None:
    assert card.command("ATTACH", program=3) == []
    assert card.level == Level.program(3)
    card.go(Level.plc(1))
    assert card.level == Level.plc(1)
    card.command("PROG7")
    assert card.level == Level.program(7)
    card.go(Level())
    assert card.level == Level()


def test_an_axis_moves_and_tells_about_it(card: Card) -> None:
    with_axis(card)
    axis, master = card.axis(0), card.master(0)
    assert axis.is_enabled
    card.command("X5")
    assert master.is_in_motion
    assert master.vector_velocity >= 0
    assert card.wait(lambda: not master.is_in_motion, timeout_s=5)
    assert axis.current_position == 5000
    assert axis.actual_position == pytest.approx(5000, abs=100)
    assert axis.following_error == axis.current_position - axis.actual_position
    assert axis.read("target position") == 5000
    assert (axis.ppu, axis.flag("jog active")) == (1000, False)
    axis.write("ppu", 2000)
    assert axis.ppu == 2000
    with pytest.raises(AttributeError, match="write"):
        axis.ppu = 3


def test_a_program_is_stored_run_and_halted(card: Card) -> None:
    card.command("DIM PROG1(2000)")
    card.command("DIM P(10)")
    card.download("PROGRAM\n_L\nP1=P1+1\nDWL 0.001\nGOTO L\nENDP\n", to=Level.program(1))
    card.run(1)
    card.pause(0.1)
    card.halt(1)
    counted = card.p[1]
    assert counted > 5
    card.pause(0.1)
    assert card.p[1] == counted
    card.halt()


def test_killed_axes_move_again_after_clear_kills(card: Card) -> None:
    with_axis(card)
    card.kill_all()
    assert card.axis(0).is_killed
    with pytest.raises(RefusedError, match=r"Kill Motion Request Active.*clear_kills"):
        card.command("X1")
    card.clear_kills()
    assert not card.axis(0).is_killed
    card.command("X1")
    card.kill_all(disable=True)
    assert not card.axis(0).is_enabled


@pytest.mark.parametrize("echo", [1, 0])
def test_a_program_is_heard_until_it_ends(echo: int) -> None:
    card = Card.open(Controller(), Options(echo=EchoMode(echo)))
    card.command("DIM PROG0(2000)")
    card.download('PROGRAM\nPRINT "one"\nDWL 0.5\nPRINT "two"\nENDP\n', to=Level.program(0))
    assert "".join(card.listen(0, run=True)) == "one\ntwo\n"
    assert card.ask("2") == 2


def test_listening_ends_when_it_is_left_and_the_program_runs_on(card: Card) -> None:
    card.command("DIM PROG0(2000)")
    card.download('PROGRAM\n_L\nPRINT "x"\nDWL 0.01\nGOTO L\nENDP\n', to=Level.program(0))
    card.run(0)
    listening = card.listen(0)
    assert "x" in next(listening) + next(listening)
    with pytest.raises(UserError, match="being followed"):
        card.command("HALT")
    listening.close()
    assert card.bit["program0.running"]
    card.halt(0)
    assert card.ask("3") == 3


def test_packets_are_answered_while_a_program_is_followed() -> None:
    card = Card.open(Controller())
    card.command("DIM PROG0(2000)")
    card.download('PROGRAM\n_L\nPRINT "x"\nDWL 0.01\nGOTO L\nENDP\n', to=Level.program(0))
    heard = card.listen(0, run=True)
    assert "x" in next(heard)
    assert card.p["axis0.ppu"] == 1
    assert "x" in next(heard) + next(heard)
    heard.close()
    card.halt(0)


def test_a_line_that_waits_needs_a_longer_time_out() -> None:
    card = Card.open(Controller(), Options(timeout_s=0.5))
    assert card.command("DWL 1", timeout_s=2) == []
    with pytest.raises(NoReplyError, match="longer time-out"):
        card.command("DWL 0.8")
    assert card.ask("4") == 4


def test_watching_reads_again_and_again() -> None:
    card = Card.open(Controller())
    samples = card.watch([6916], every_s=0.1)
    times = [next(samples)[0] for _ in range(4)]
    assert [b - a for a, b in pairwise(times)] == [100, 100, 100]


def test_packets_without_an_answer_are_reported(card: Card) -> None:
    card.tell(SetBit(40))
    assert card.read_bit(40)
    card.tell(ClearBit(40))
    assert not card.read_bit(40)
