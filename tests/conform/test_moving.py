"""Cases that jog one axis of a card in use, or set what is put back."""

from pathlib import Path

import pytest
from tests.conform.one_case import case_of
from tests.conform.test_host import Wire

from openacr import Controller
from openacr.client.errors import GarbledError
from openacr.conform import Case
from openacr.conform.asking import bar
from openacr.conform.campaign import Outcome, on_card_in_use
from openacr.conform.host import HostCard
from openacr.conform.moving import Permission, for_axis, of_axis
from openacr.errors import FaultyFileError

MOVES = "moves: 1 units at 2 units/s\nchanges: P12348, P12349, P12350\n"
VEL = "> AXIS0 JOG VEL 2\n"
REST = "wait until BIT792 = 0 within 5 s\n"
ANY = Permission(axis=0, may_set=True)
JOG = (
    f"{MOVES}{VEL}> AXIS0 JOG ACC 50\n> AXIS0 JOG DEC 50\nnote P12297 as begin\n"
    f"> AXIS0 JOG INC 1\n? BIT792 -> -1\n{REST}? (P12297-<begin>)/P12375 -> 1\n"
)


@pytest.mark.parametrize(
    "steps",
    [
        f"{MOVES}{VEL}> AXIS0 JOG INC 1\n{REST}> AXIS0 JOG INC -2\n{REST}> AXIS0 JOG INC 1",
        f"{MOVES}{VEL}> AXIS0 JOG INC 0.5\n> AXIS0 JOG INC 0.5",
        f"{MOVES}{VEL}> AXIS0 JOG INC 1\n> AXIS0 JOG OFF\n{REST}> AXIS0 JOG INC -1",
        f"{MOVES}> AXIS0 JOG VEL\n2\n> P12349 = 5\nwait 1 s\nnote P5 as a\n? P5-<a> -> 0",
        "changes: BIT128, P40\n> SET 128\n> CLR 128\n> BIT128=-1\n> P40=2.5\n? BIT128 -> -1",
        f"machine: {{}}\n{MOVES}> ?1\n1".replace("{}", "\n    [card]"),
    ],
)
def test_what_stays_within_its_travel_and_sets_what_it_says_may_run(
    tmp_path: Path, steps: str
) -> None:
    assert bar(case_of(tmp_path, steps), ANY) == ""


@pytest.mark.parametrize(
    ("steps", "reason"),
    [
        (f"{MOVES}> AXIS0 JOG INC 1", "line 6: no JOG VEL up to 2 is before it"),
        (f"{MOVES}> AXIS0 JOG VEL 2.001\n> AXIS0 JOG INC 1",
         "line 7: no JOG VEL up to 2 is before it"),
        (f"{MOVES}> AXIS0 JOG VEL 0\n> AXIS0 JOG INC 1",
         "line 7: no JOG VEL up to 2 is before it"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC 1.001", "line 7: it may go beyond 1 units"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC -1.001", "line 7: it may go beyond 1 units"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC 1\n{REST}> AXIS0 JOG INC 0.1",
         "line 9: it may go beyond 1 units"),
        # where it was stopped, or overtaken, is not certain
        (f"{MOVES}{VEL}> AXIS0 JOG INC 1\n> AXIS0 JOG OFF\n{REST}> AXIS0 JOG INC -1.1",
         "line 10: it may go beyond 1 units"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC 1\n> AXIS0 JOG INC -1.1",
         "line 8: it may go beyond 1 units"),
        (f"{MOVES}{VEL}> AXIS0 JOG FWD", "line 7: `AXIS0 JOG FWD` may change the card"),
        (f"{MOVES}{VEL}> AXIS0 JOG ABS 1", "line 7: `AXIS0 JOG ABS 1` may change the card"),
        (f"{MOVES}{VEL}> AXIS1 JOG INC 1", "line 7: `AXIS1 JOG INC 1` may change the card"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC P0", "line 7: `AXIS0 JOG INC P0` may change the card"),
        (f"{MOVES}{VEL}> AXIS0 JOG INC 1 : AXIS0 JOG FWD",
         "line 7: `AXIS0 JOG INC 1 : AXIS0 JOG FWD` may change the card"),
        (f"{MOVES}> AXIS0 JOG JRK 5",
         "line 6: `AXIS0 JOG JRK 5`: P12351 is not among the changes of the case"),
        ("changes: P12348\n> AXIS0 JOG INC 1",
         "line 5: `AXIS0 JOG INC 1`: the case says nothing about motion"),
        ("changes: P12348\n> AXIS0 JOG OFF",
         "line 5: `AXIS0 JOG OFF`: the case says nothing about motion"),
        ("changes: P40\n> P41=1", "line 5: `P41=1`: P41 is not among the changes of the case"),
        ("changes: BIT128\n> SET 129",
         "line 5: `SET 129`: BIT129 is not among the changes of the case"),
        ("changes: P40\n> P40=P41", "line 5: `P40=P41` may change the card"),
        (f"{MOVES}program 0:\n    10 REM", "line 6: `program NUMBER:` does more than ask"),
        (f"only: virtual\n{MOVES}> ?1\n1", "it needs the world around a virtual card"),
    ],
)  # fmt: skip
def test_anything_else_is_kept_away(tmp_path: Path, steps: str, reason: str) -> None:
    assert bar(case_of(tmp_path, steps), ANY) == reason


def test_motion_and_settings_are_allowed_apart(tmp_path: Path) -> None:
    moving = case_of(tmp_path, f"{MOVES}> ?1\n1")
    assert bar(moving, Permission(axis=3)) == ""
    assert bar(moving, Permission(may_set=True)) == "it moves a motor (--moving AXIS)"
    setting = case_of(tmp_path, "changes: P40\n> P40=1")
    assert bar(setting, Permission(may_set=True)) == ""
    assert bar(setting, Permission(axis=3)) == "it sets P40 and puts them back (--setting)"


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("moves: X", "moves: X: expected 1 units at 2 units/s"),
        ("moves: -1 units at 2 units/s", "expected 1 units at 2 units/s"),
        ("changes: P1, LV2", "changes: LV2: expected P or BIT with a number"),
    ],
)
def test_travel_and_changes_have_a_form(tmp_path: Path, line: str, said: str) -> None:
    with pytest.raises(FaultyFileError) as caught:
        case_of(tmp_path, f"{line}\n> ?1\n1")
    assert said in str(caught.value)


def test_a_case_about_axis_0_is_about_the_axis_that_is_allowed(tmp_path: Path) -> None:
    text = "P12288 P12543 P12544 P12287 BIT768 BIT799 BIT800 BIT8448 BIT8479 BIT128 P5"
    assert of_axis(text, 2) == (
        "P12800 P13055 P12544 P12287 BIT832 BIT863 BIT800 BIT8512 BIT8543 BIT128 P5"
    )
    assert of_axis(text, 0) == text
    assert of_axis("P12288 BIT768 BIT799 BIT8448", 7) == "P14080 BIT992 BIT1023 BIT8672"
    assert of_axis("P12288 BIT768 BIT799 BIT8448", 8) == "P14336 BIT7680 BIT7711 BIT8704"
    assert of_axis("BIT792 BIT8467", 15) == "BIT7928 BIT8947"
    case = for_axis(case_of(tmp_path, JOG), 1)
    assert case.changes == ("P12604", "P12605", "P12606")
    assert [step.at.text for step in case.steps][4:7] == [
        "> AXIS1 JOG INC 1", "? BIT824 -> -1", "wait until BIT824 = 0 within 5 s",
    ]  # fmt: skip


def two_axes() -> Controller:
    card = Controller()
    card.send("AXIS0 PPU 1000\rAXIS1 PPU 1000\rAXIS1 JOG VEL 7\r")
    return card


def run_on(wire: Wire, case: Case, axis: int) -> Outcome:
    wire.open()
    (found,) = on_card_in_use([case], HostCard(wire), "ACR9000", Permission(axis=axis))
    return found


def test_the_axis_is_jogged_and_returns_and_no_other_moves(tmp_path: Path) -> None:
    card = two_axes()
    card.send("AXIS1 JOG INC 0.25\r")
    card.advance(seconds=2)
    wire = Wire(card)
    found = run_on(wire, case_of(tmp_path, JOG), 1)
    assert found.result == "agrees", found.difference
    assert b"AXIS1 JOG INC 1\r" in wire.typed
    assert (card.p[12553], card.p[12290], card.bit[824]) == (250, 0, False)


def test_a_case_that_differs_while_the_axis_moves_still_brings_it_back(tmp_path: Path) -> None:
    card = two_axes()
    slow = case_of(tmp_path, JOG.replace("within 5 s", "within 0.1 s"))
    found = run_on(Wire(card), slow, 1)
    assert found.difference is not None
    assert found.difference.expected == "BIT824 = 0 within 0.1 s"
    assert (card.p[12553], card.bit[824]) == (0, False)
    wrong = case_of(tmp_path, JOG.replace("-> 1\n", "-> 2\n"))
    found = run_on(Wire(card), wrong, 1)
    assert (found.difference and found.difference.shown) == "1"
    assert card.p[12553] == 0


class Interrupted(Wire):
    """Ctrl-C is pressed when the axis has gone some pulses."""

    def read(self, timeout_s: float | None) -> bytes:
        if self.host.p[12553] > 300 and not self.is_pressed:
            self.is_pressed = True
            raise KeyboardInterrupt
        return super().read(timeout_s)

    is_pressed = False
    host: Controller


def test_ctrl_c_kills_the_motion_and_takes_the_kill_back_at_rest(tmp_path: Path) -> None:
    card = two_axes()
    wire = Interrupted(card)
    wire.host = card
    with pytest.raises(KeyboardInterrupt):
        run_on(wire, case_of(tmp_path, JOG), 1)
    stopped = card.p[12553]
    assert 300 < stopped < 1000
    card.advance(seconds=1)
    assert (card.p[12553], card.bit[824], card.bit[8467 + 32]) == (stopped, False, False)
    assert b"SET 8499\r" in wire.typed


def test_an_answer_that_is_no_number_ends_the_run_with_the_axis_at_rest(tmp_path: Path) -> None:
    card = two_axes()
    with pytest.raises(GarbledError, match="BIT824"):
        run_on(Wire(card, rb"\?BIT824\r\n-1\r\n", b"?BIT824\r\nwhat\r\n"),
               case_of(tmp_path, JOG.replace("? BIT792 -> -1\n", "")), 1)  # fmt: skip
    assert not card.bit[824]
