"""The error handler: every trouble gets its code and text, and motion is possible again."""

import re
from collections.abc import Callable
from math import sqrt

import pytest
from tests.examples.observe import Observation, load, observe
from tests.examples.watches import ERRORS

from openacr.channels import StreamKind
from openacr.controller import Controller

X, Y = 0, 1
KILL_MOVES, KILL = 522, 8467
HALT_ON_ERROR, PRINT_ERRORS, ERROR_OCCURRED, CLEAR_CODES = 128, 129, 130, 131
PAUSED, RUNS = 1050, 1024
MEI_CODE, CANOPEN_CODE, X_CODE, Y_CODE = 50, 51, 52, 53
OTHER = "Other fault (user set KAMR bit, EPL Network Fault, etc.)"


class Bench:
    """The card of the example with a terminal on its second network connection."""

    def __init__(self) -> None:
        self.card = load("error_handler")
        self.card.open_stream(StreamKind.TERMINAL)
        self.second = self.card.open_stream(StreamKind.TERMINAL)
        self.card.advance(seconds=0.1)
        self.card.send("PROG0\rDRIVE ON X Y\r")
        self.card.advance(seconds=0.2)
        self.heard()

    def heard(self) -> str:
        """What the second connection has received since the last time."""
        return self.card.take_output(self.second).decode("latin-1")

    def wait(self, seconds: float = 0.2) -> str:
        """Let the card live; what arrived on the second connection."""
        text = ""
        for _ in range(round(seconds / 0.01)):
            self.card.advance(seconds=0.01)
            text += self.heard()
        return text

    def type_in(self, line: str) -> str:
        return self.card.send(f"{line}\r")

    def can_move(self, axis: int) -> bool:
        card = self.card
        if card.bit[KILL + 32 * axis] or card.bit[KILL_MOVES]:
            return False
        here = card.axis(axis).commanded_u
        self.type_in(f"{'XY'[axis]}/-1")
        self.wait(0.5)
        return abs(card.axis(axis).commanded_u - (here - 1)) < 1e-6


@pytest.fixture
def bench() -> Bench:
    return Bench()


@pytest.fixture(scope="module")
def run() -> Observation:
    return observe(ERRORS)


def soft_limit(bench: Bench) -> None:
    bench.type_in("JOG FWD X")
    bench.card.until(16140)


def hard_limit(axis: str, jog: str) -> Callable[[Bench], None]:
    latch = {"FWD": 16132, "REV": 16133}[jog] + 32 * "XY".index(axis)

    def drive(bench: Bench) -> None:
        bench.type_in(f"SLIM {axis}0")
        bench.type_in(f"JOG {jog} {axis}")
        assert bench.card.until(latch)

    return drive


def excess_error(bench: Bench) -> None:
    bench.type_in("TLM Y0.1")
    bench.type_in("Y5")
    bench.card.until(8511)


def excess_error_of_x(bench: Bench) -> None:
    bench.type_in("TLM X0.1")
    bench.type_in("X/-5")
    bench.card.until(8479)


def drive_fault(bench: Bench) -> None:
    bench.card.set_input(16, True)
    bench.card.until(8477)
    bench.card.set_input(16, False)


def set_by_user(bench: Bench) -> None:
    bench.type_in("SET 8467")


@pytest.mark.req("ACR-ERR-12", "ACR-ERR-19")
@pytest.mark.parametrize(
    ("trouble", "codes", "texts"),
    [
        pytest.param(
            soft_limit,
            (1, 0),
            ["Axis 0 Error 1 -> Positive Software End-of-travel hit, Axis 0"],
            marks=pytest.mark.req("ACR-ERR-05"),
        ),
        *(
            pytest.param(
                hard_limit("X", jog),
                (code, 7),
                [
                    f"Axis 0 Error {code} -> {side} Hardware End-of-travel hit, Axis 0",
                    f"Axis 1 Error 7 -> {OTHER}",
                ],
                marks=pytest.mark.req("ACR-ERR-06", "ACR-KAMR-21"),
            )
            for jog, code, side in (("FWD", 3, "Positive"), ("REV", 4, "Negative"))
        ),
        *(
            pytest.param(
                hard_limit("Y", jog),
                (7, code),
                [
                    f"Axis 0 Error 7 -> {OTHER}",
                    f"Axis 1 Error {code} -> {side} Hardware End-of-travel hit, Axis 1",
                ],
                marks=pytest.mark.req("ACR-ERR-06", "ACR-KAMR-21"),
            )
            for jog, code, side in (("FWD", 3, "Positive"), ("REV", 4, "Negative"))
        ),
        pytest.param(
            excess_error,
            (7, 5),
            [
                f"Axis 0 Error 7 -> {OTHER}",
                "Axis 1 Error 5 -> Axis 1 disabled due to excess position error",
            ],
            marks=pytest.mark.req("ACR-ERR-07", "ACR-KAMR-16"),
        ),
        pytest.param(
            excess_error_of_x,
            (5, 7),
            [
                "Axis 0 Error 5 -> Axis 0 disabled due to excess position error",
                f"Axis 1 Error 7 -> {OTHER}",
            ],
            marks=pytest.mark.req("ACR-ERR-07"),
        ),
        pytest.param(
            drive_fault,
            (7, 7),
            [
                "Axis 0 Error 7 -> Latched Drive Fault, Axis 0.",
                f"Axis 1 Error 7 -> {OTHER}",
            ],
            marks=pytest.mark.req("ACR-ERR-09", "ACR-KAMR-15"),
        ),
        pytest.param(
            set_by_user,
            (7, 7),
            [f"Axis 0 Error 7 -> {OTHER}", f"Axis 1 Error 7 -> {OTHER}"],
            marks=pytest.mark.req("ACR-ERR-09", "ACR-KAMR-09"),
        ),
    ],
)
def test_a_trouble_has_its_code_and_its_text(
    bench: Bench,
    trouble: Callable[[Bench], None],
    codes: tuple[int, int],
    texts: list[str],
) -> None:
    bench.type_in(f"CLR {CLEAR_CODES}")
    trouble(bench)
    lines = bench.wait().split("\r\n")
    assert lines[1:] == [*texts, "", ""]
    assert (bench.card.p[X_CODE], bench.card.p[Y_CODE]) == codes
    assert not bench.card.bit[ERROR_OCCURRED]
    assert (bench.card.bit[8479], bench.card.bit[8511]) == (False, False)
    assert not any(bench.card.bit[latch] for latch in (16132, 16133, 16164, 16165))


@pytest.mark.req("ACR-ERR-11")
def test_motion_is_possible_again_after_a_limit_switch(bench: Bench) -> None:
    hard_limit("X", "REV")(bench)
    assert bench.card.bit[KILL]
    bench.wait()
    assert not bench.card.bit[16133]
    bench.type_in("JOG RES X")
    bench.type_in("X-5")
    bench.wait(1.5)
    assert bench.card.axis(X).commanded_u == -5.0
    assert bench.can_move(Y)


@pytest.mark.req("ACR-ERR-05")
def test_a_software_limit_kills_the_moves_only_until_it_has_been_reported(bench: Bench) -> None:
    bench.type_in("X20")
    assert bench.card.until(16140, timeout_s=3.0)
    assert bench.card.bit[KILL_MOVES]
    assert not bench.card.bit[KILL]
    bench.wait()
    assert not bench.card.bit[KILL_MOVES]
    bench.type_in("JOG RES X")
    assert bench.can_move(X)


@pytest.mark.req("ACR-ERR-18", "ACR-KAMR-17")
def test_the_stop_of_the_kill_is_waited_for(run: Observation) -> None:
    kill = run.rises(16132)[0]
    rest = next(event for event in run.falls(792) if event.time_s > kill.time_s)
    cleared = run.falls(16132)[0]
    assert kill.time_s < rest.time_s <= cleared.time_s
    # X12 Y4 at 10 units/s: this is the share of X, and HLDEC is 500 units/s2
    speed_ups = 10 * 12 / sqrt(12**2 + 4**2)
    assert rest.time_s - kill.time_s == pytest.approx(speed_ups / 500, abs=0.001)
    assert rest.commanded_u[0] - kill.commanded_u[0] == pytest.approx(speed_ups**2 / 1000, abs=0.01)


@pytest.mark.req("ACR-ERR-13", "ACR-ERR-14")
def test_each_trouble_is_reported_once_and_its_codes_are_reset(bench: Bench) -> None:
    set_by_user(bench)
    assert bench.wait().count("Axis 0 Error 7") == 1
    assert (bench.card.p[X_CODE], bench.card.p[Y_CODE]) == (0, 0)
    assert not bench.card.bit[ERROR_OCCURRED]
    assert bench.wait(0.5) == ""
    bench.type_in(f"SET {ERROR_OCCURRED}")  # by hand: a message without any code
    assert re.fullmatch(r"Approximate Time Running : .* Seconds \r\n\r\n", bench.wait())
    assert not bench.card.bit[ERROR_OCCURRED]
    set_by_user(bench)
    assert bench.wait().count("Axis 0 Error 7") == 1


@pytest.mark.req("ACR-ERR-12")
def test_without_print_errors_nothing_is_sent(bench: Bench) -> None:
    bench.type_in("PROG1")
    bench.card.receive(bench.second, b"?1\r")
    assert "SYS>" not in bench.wait(), "the program has the stream"
    bench.type_in(f"CLR {PRINT_ERRORS}")
    bench.wait()
    bench.card.receive(bench.second, b"?1\r")
    assert bench.wait() == "?1\r\n1\r\nSYS>", "it is closed"
    set_by_user(bench)
    assert bench.wait() == ""
    assert not bench.card.bit[KILL]


@pytest.mark.req("ACR-ERR-10")
@pytest.mark.parametrize("is_halted", [True, False])
def test_program_0_is_halted_or_paused(bench: Bench, is_halted: bool) -> None:
    bench.type_in("RUN")
    bench.wait(0.5)
    if is_halted:
        bench.type_in(f"SET {HALT_ON_ERROR}")
    assert bench.card.bit[RUNS]
    set_by_user(bench)
    bench.wait()
    assert bench.card.bit[RUNS] is not is_halted
    assert bench.card.bit[PAUSED] is not is_halted


@pytest.mark.req("ACR-ERR-03")
def test_an_open_motion_enable_input_is_reported_and_its_closing_too(bench: Bench) -> None:
    bench.card.bit[5646] = True
    assert "MEI Error 1 -> Motion Enable Input is open\r\n" in bench.wait()
    assert bench.card.p[MEI_CODE] == 1
    assert bench.card.bit[5645]
    assert all(bench.card.bit[flag] for flag in (KILL, KILL + 32))
    bench.card.bit[5646] = False
    bench.wait()
    assert bench.card.p[MEI_CODE] == 0
    assert not any(bench.card.bit[flag] for flag in (5645, 5647, KILL, KILL + 32))


@pytest.mark.req("ACR-ERR-04")
@pytest.mark.parametrize("problem", [3, 5, 10])
def test_a_canopen_problem_has_the_number_of_its_state(bench: Bench, problem: int) -> None:
    bench.card.p[32779] = problem
    text = bench.wait()
    assert f"CANopen Error {problem} -> CANopen network problem occurred.\r\n" in text
    assert bench.card.p[CANOPEN_CODE] == problem
    bench.type_in("PROG1")
    for state, said in (
        (2, "CANopen status is good"),
        (1, "CANopen is ready to start (SET 11265)"),
    ):
        bench.card.p[CANOPEN_CODE] = problem
        bench.card.p[32779] = state
        assert bench.wait(0.1) == ""
        assert bench.card.p[CANOPEN_CODE] == 0
        assert said in bench.type_in("?$V1")


@pytest.mark.req("ACR-ERR-08")
@pytest.mark.parametrize("drive", ["OFF", "ON"])
def test_an_encoder_fault_is_reported_with_the_drive_off(bench: Bench, drive: str) -> None:
    bench.type_in(f"CLR {CLEAR_CODES}")
    bench.type_in(f"DRIVE {drive} X")
    bench.wait(0.1)
    bench.card.bit[2560] = True
    bench.card.advance(2)
    assert not bench.card.bit[8465]  # the card has switched a drive off that was on
    set_by_user(bench)
    text = bench.wait()
    assert bench.card.p[X_CODE] == 6
    assert "Axis 0 Error 6 -> Axis 0 disabled due to encoder fault" in text
    assert not bench.card.bit[2560]  # the program has tried ENC 0 RES


@pytest.mark.req("ACR-ERR-08")
def test_an_encoder_fault_is_no_reason_while_the_drive_is_on(bench: Bench) -> None:
    bench.type_in("ATTACH AXIS0 ENC2 DAC0 ENC2")  # a fault of encoder 0 leaves the axis alone
    bench.type_in(f"CLR {CLEAR_CODES}")
    bench.type_in("DRIVE ON X")
    bench.wait(0.1)
    bench.card.bit[2560] = True
    bench.card.advance(2)
    assert bench.card.bit[8465]
    set_by_user(bench)
    text = bench.wait()
    assert bench.card.p[X_CODE] == 7
    assert "encoder fault" not in text
    assert bench.card.bit[2560]


@pytest.mark.req("ACR-ERR-08")
@pytest.mark.parametrize("axis", [X, Y])
def test_an_encoder_fault_is_no_reason_where_a_limit_is_one_already(
    bench: Bench, axis: int
) -> None:
    bench.type_in(f"CLR {CLEAR_CODES}")
    bench.type_in(f"DRIVE OFF {'XY'[axis]}")
    bench.wait(0.1)
    bench.card.bit[2560 + 32 * axis] = True
    bench.card.bit[16132 + 32 * axis] = True  # the positive hardware limit was encountered
    bench.type_in(f"SET {KILL + 32 * axis}")
    text = bench.wait()
    assert bench.card.p[X_CODE + axis] == 3
    assert "encoder fault" not in text
    assert bench.card.bit[2560 + 32 * axis]


@pytest.mark.req("ACR-ERR-15")
def test_the_time_is_split_into_its_parts(bench: Bench) -> None:
    bench.card.p[6916] = 93_784_005
    set_by_user(bench)
    (line,) = re.findall(r"Approximate .*", bench.wait())
    match = re.fullmatch(
        r"Approximate Time Running : 1 Days  2 Hours  3 Minutes  4\.(\d+) Seconds \r?", line
    )
    assert match
    assert 5 <= int(match[1]) < 50  # a pass of the program later


@pytest.mark.req("ACR-ERR-17")
def test_it_starts_at_power_up_by_run_and_by_flag() -> None:
    card = load("error_handler")
    card.advance(seconds=0.1)
    assert card.bit[1056]
    card.send("HALT PROG1\r")
    card.advance(seconds=0.1)
    assert not card.bit[1056]
    for start in ("RUN PROG1", "SET 1064"):
        card.send(f"{start}\r")
        card.advance(seconds=0.1)
        assert card.bit[1056], start
        card.send("HALT PROG1\r")
        card.advance(seconds=0.1)


@pytest.mark.req("ACR-ERR-01")
def test_it_can_be_run_again_and_still_reports(bench: Bench) -> None:
    bench.type_in("HALT PROG1")
    bench.wait()
    bench.type_in("RUN PROG1")
    bench.wait()
    set_by_user(bench)
    assert "Axis 0 Error 7" in bench.wait()


def test_program_0_goes_through_all_its_troubles(run: Observation) -> None:
    found = re.findall(r"Axis (\d Error \d)", run.printed)
    limits, drives = ["0 Error 1", "0 Error 3", "1 Error 7"], ["0 Error 7", "1 Error 5"]
    assert found == [*limits, *drives, "0 Error 7", "1 Error 7"]


def test_the_reports_do_not_go_to_other_terminals(bench: Bench) -> None:
    card: Controller = bench.card
    set_by_user(bench)
    card.advance(seconds=0.3)
    assert "Axis 0 Error 7" not in card.take_output(card.console).decode("latin-1")


@pytest.mark.req("ACR-ERR-02")
def test_it_names_flags_and_parameters() -> None:
    card = load("error_handler")
    card.send("ECHO 6\rRUN PROG1\r")
    card.advance(seconds=0.5)
    listed = card.send("SYS\rDEF\r").replace("BIT ", "BIT")
    names = re.findall(r"#DEFINE \w+ (\w+)", listed)
    flags = (16140, 16132, 769, 8477, 522, 8467, 2560, 5646)
    assert {*(f"BIT{flag}" for flag in flags), "P50", "P51", "P52", "P53"} <= set(names)
