"""Sample programs of the guide, run as they are used there."""

import pytest
from tests.system.terminal import Console

from openacr.channels import StreamKind

CRLF = "\r\n"


def two_axes() -> Console:
    console = Console()
    console.type("DIM P(100)", "DIM DEF(20)", "PROG0", "ATTACH MASTER0")
    assert console.type('ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"') == ""
    return console


ENABLE = (
    "GOSUB ENABLEDRIVE : REM to the subroutine",
    "END",
    "_ENABLEDRIVE",
    "DRIVE ON X Y",
    "DWL 0.2",
    'IF (BIT 8465) THEN PRINT "Axis0 is enable"',
    'IF (bit 8497) THEN PRINT "Axis1 is enable"',
    'IF (NOT BIT8465) THEN PRINT "Axis0 is not enable"',
    'IF (NOT bit8497) THEN PRINT "Axis1 is not enable"',
    "RETURN",
)


@pytest.mark.req("ACR-APP-ENABLE-01")
def test_drives_that_come_on_are_reported_after_200_ms() -> None:
    console = two_axes()
    console.program(0, *ENABLE)
    assert console.listen(0, 0.19) == ""
    console.card.advance(seconds=0.02)
    said = console.card.take_output(console.card.console).decode()
    assert said == f"Axis0 is enable{CRLF}Axis1 is enable{CRLF}"


@pytest.mark.req("ACR-APP-ENABLE-02")
def test_a_drive_with_a_fault_does_not_enable_and_is_reported() -> None:
    console = two_axes()
    console.type("SET 8500 SET 8485")  # drive I/O of axis 1, inverted fault level
    console.program(0, *ENABLE)
    assert console.listen(0, 0.5) == "Axis0 is enable|Axis1 is not enable"


EPL = (
    "GOSUB EnableEPLNetwork",
    "END",
    "_EnableEPLNetwork",
    "INH 16648",
    "IF (NOT Bit16649) THEN EPLC ON",
    "DWL 0.2",
    "WHILE (BIT 16640)",
    "WEND",
    'IF (BIT 16649) THEN PRINT "EPL NETWORK OPERATIONAL"',
    'IF (BIT 16650) THEN PRINT "EPL NETWORK START FAILED, GOING TO RESET NETWORK"',
    "IF (NOT BIT 16649)",
    "EPLC OFF",
    "SET ResetEPLNetwork",
    "INH -16657",
    "EPLC ON",
    "INH -16656",
    "ENDIF",
    "IF ((NOT BIT 16649) AND (ResetEPLNetwork))",
    'PRINT "EPL network problem occurred."',
    "ENDIF",
)


def epl() -> Console:
    console = Console()
    console.type("DIM DEF(2)", "#DEFINE ResetEPLNetwork BIT150")
    console.program(0, *EPL)
    return console


@pytest.mark.req("ACR-APP-EPL-01")
def test_the_network_program_waits_for_its_card_and_for_the_start_to_end() -> None:
    console = epl()
    assert console.listen(0, 5.0) == ""  # there is no card
    console.card.bit[16649] = True  # operational before
    console.card.bit[16640] = True  # and starting
    console.card.bit[16648] = True
    console.card.advance(seconds=1)
    assert console.card.take_output(console.card.console) == b""
    console.card.bit[16640] = False
    console.card.advance(seconds=0.1)
    said = console.card.take_output(console.card.console).decode()
    assert said == f"EPL NETWORK OPERATIONAL{CRLF}"
    assert not console.card.bit[150]


@pytest.mark.req("ACR-APP-EPL-02", "ACR-APP-EPL-03")
def test_a_network_that_does_not_start_is_reset_once_and_then_given_up() -> None:
    console = epl()
    console.card.bit[16648] = True
    said = console.listen(0, 1.0)
    assert said == (
        "EPL NETWORK START FAILED, GOING TO RESET NETWORK|EPL network problem occurred."
    )
    assert console.card.bit[150]
    assert not console.card.bit[1024]


OPEN_SAMPLE = (
    "CLEAR",
    "DIM $V(1,10)",
    "GOSUB OPENPORT",
    "END",
    "_OPENPORT",
    'OPEN "STREAM3:" AS #1',
    "_LOOP1",
    '$V0 = ""',
    'PRINT #1, ""',
    'PRINT #1, "What kind of fruit do you want?"',
    'PRINT #1, "(A)pple, (B)anana, (C)oconut"',
    'PRINT "I would like to have a";',
    'WHILE ($V0 = "")',
    "$V0 = UCASE$(INKEY$(1))",
    "WEND",
    'IF ($V0 = "A") THEN PRINT "n Apple"',
    'IF ($V0 = "B") THEN PRINT " Banana"',
    'IF ($V0 = "C") THEN PRINT " Coconut"',
    'IF ($V0 = "X") THEN GOTO LOOP2',
    "IF ($V0 = CHR$(27)) THEN GOTO LOOP2",
    "GOTO LOOP1",
    "_LOOP2",
    'PRINT #1, "Program terminated"',
    "CLOSE #1",
    "RETURN",
)
QUESTION = f"{CRLF}What kind of fruit do you want?{CRLF}(A)pple, (B)anana, (C)oconut{CRLF}"


class Fruit:
    """The open sample with a host on STREAM3 and a listener on the console."""

    def __init__(self) -> None:
        self.console = Console()
        self.card = self.console.card
        self.card.open_stream(StreamKind.TERMINAL)  # STREAM2
        self.host = self.card.open_stream(StreamKind.TERMINAL)
        self.card.take_output(self.host)
        self.console.program(0, *OPEN_SAMPLE)
        self.heard = self.console.listen(0, 0.1)

    def key(self, key: bytes) -> tuple[str, str]:
        """What STREAM3 and the listener get for a key."""
        self.card.receive(self.host, key)
        self.card.advance(seconds=0.2)
        return (
            self.card.take_output(self.host).decode(),
            self.card.take_output(self.card.console).decode(),
        )


@pytest.mark.req("ACR-APP-OPEN-01", "ACR-APP-OPEN-02", "ACR-APP-OPEN-03", "ACR-EVAL-17")
def test_the_fruit_question_goes_to_stream3_and_each_answer_completes_the_sentence() -> None:
    fruit = Fruit()
    assert fruit.heard == "I would like to have a"
    assert fruit.card.take_output(fruit.host).decode() == QUESTION
    fruit.card.advance(seconds=2)
    assert fruit.card.take_output(fruit.host) == b""  # INKEY$ does not wait, the loop does
    for key, answer in ((b"a", "n Apple"), (b"b", " Banana"), (b"C", " Coconut")):
        assert fruit.key(key) == (QUESTION, f"{answer}{CRLF}I would like to have a")
    assert fruit.card.bit[1024]
    assert fruit.key(b"\x1b")[0] == f"Program terminated{CRLF}"  # CHR$(27)
    assert not fruit.card.bit[1024]
    assert fruit.console.type('$V0 = "7.5"', 'PRINT USING "##";VAL($V0)') == " 8"


@pytest.mark.req("ACR-APP-OPEN-04")
@pytest.mark.parametrize("key", [b"x", b"\x1b"])
def test_x_or_escape_ends_the_fruit_program_and_gives_the_stream_back(key: bytes) -> None:
    fruit = Fruit()
    fruit.card.take_output(fruit.host)
    said, _ = fruit.key(key)
    assert said.startswith(f"Program terminated{CRLF}")
    assert not fruit.card.bit[1024]
    said, _ = fruit.key(b"?1+1\r")
    assert said == f"?1+1{CRLF}2{CRLF}SYS>"


@pytest.mark.req("ACR-APP-OPEN-05")
def test_clear_and_dim_give_one_string_variable_of_ten_characters() -> None:
    fruit = Fruit()
    console = Console()
    console.type("PROG0", "DIM $V(1,20)")
    console.program(0, "CLEAR", "DIM $V(1,10)", '$V0 = "ABCDEFGHIJKL"', "PRINT $V0", "$V1 = $V0")
    assert console.listen(0, 0.1) == "ABCDEFGHIJ|Error in PROG0 line 60: Undefined variable"
    assert fruit.card.bit[1024]


TEACH = """
CLEAR : REM Clear out any variables dimensioned
DIM LV(2) : REM Dimension 2 Long Variables
DIM DA(1) : REM Dimension 1 Double Array
DIM $V(1,10) : REM Dimension 1 String Variable of length 10

'Go to SUBROUTINE Teach
GOSUB Teach

END

_Teach
RES X : REM Reset position to zero
DRIVE OFF X : REM DISABLE DRIVE, teach points by manually move motor.

'Start of InputPoints Routine
_InputPoints

'Print to the terminal "points to teach" and stores value into String Variable 0
INPUT; "Enter number of points to teach (value must greater than 0) = "; $V0
'Stores the Value of String Variable 0 into Long Variable 1
LV1 = VAL($V0)

PRINT ""
PRINT LV1

'If Statement to check if value entered is correct
IF (LV1<=0)
    PRINT "ENTERED VALUE IS NOT VALID "; $V0
    PRINT "Value must be a number greater than 0"
    GOTO InputPoints
    ENDIF


DIM DA0(LV1)   : REM dimension array equal to number of points to teach

'use input 24 to tell controller to collect a teach point
'FOR/TO/STEP/NEXT loop to teach points into array
FOR LV0 = 0 TO (LV1-1) STEP 1
    PRINT "TURN MOTOR, THEN HIT INPUT 24 TO TEACH POINT"
    INH 24 : REM Inhibits the program until Input 24 is pressed
    DA0(LV0)=P12290/P12375 : REM Stores Double Array entry with Encoder Positive divide by PPU of Axis0
    INH -24 : REM Waits for Input 24 to turn off
    NEXT


PRINT "Teach Completed, Total Points Taught = ";LV1
PRINT "Press Input 24 to enable drives and move to zero/start position "
INH 24
INH -24

DRIVE ON X : REM Enable Axis0 "X"
DWL 0.5
X0 : REM Moves to Zero Position
INH -516  : REM Waits for Motion to be completed
PRINT "Input 24 to run taught points"
INH 24

'FOR/TO/STEP/NEXT loop to make absolute moves to position taught
FOR LV0=0 TO (LV1-1) STEP 1
    X(DA0(LV0))
    INH -516
    PRINT DA0(LV0) : REM Print to terminal the Position it move to.
    NEXT

RETURN
"""  # noqa: E501
PROMPT = "Enter number of points to teach (value must greater than 0) = "
TURN = f"TURN MOTOR, THEN HIT INPUT 24 TO TEACH POINT{CRLF}"


@pytest.mark.req(
    "ACR-APP-TEACH-01",
    "ACR-APP-TEACH-02",
    "ACR-APP-TEACH-03",
    "ACR-APP-TEACH-04",
    "ACR-APP-TEACH-05",
)
def test_points_taught_by_hand_are_run_in_order() -> None:
    console = two_axes()
    card = console.card
    console.type("PPU X4000 : ACC 100 DEC 100 STP 100 VEL 20")
    console.program(0, *(line for line in TEACH.splitlines() if line))
    assert console.listen(0, 0.1) == PROMPT
    assert card.p[12290] == 0

    def answer(text: str) -> str:
        card.send(text)
        card.advance(seconds=0.1)
        return card.take_output(card.console).decode()

    assert answer("none\r") == f"{CRLF}0{CRLF}ENTERED VALUE IS NOT VALID none{CRLF}" + (
        f"Value must be a number greater than 0{CRLF}{PROMPT}"
    )
    assert answer("3\r") == f"{CRLF}3{CRLF}{TURN}"
    for move in (1.5, 2.25, -3.0):  # by hand, the drive is off
        card.drag(0, move)
        card.advance(seconds=0.5)
        card.bit[24] = True
        card.advance(seconds=0.05)
        card.bit[24] = False
        card.advance(seconds=0.05)
    said = card.take_output(card.console).decode()
    assert said == 2 * TURN + (
        f"Teach Completed, Total Points Taught = 3{CRLF}"
        f"Press Input 24 to enable drives and move to zero/start position {CRLF}"
    )
    assert abs(card.p[12290] - 0.75 * 4000) <= 2
    for _ in range(2):
        card.bit[24] = True
        card.advance(seconds=0.05)
        card.bit[24] = False
        card.advance(seconds=2)
    card.advance(seconds=5)
    prompt, *rest = card.take_output(card.console).decode().split(CRLF)
    assert prompt == "Input 24 to run taught points"
    points = [float(text) for text in rest if text]
    assert points == pytest.approx([1.5, 3.75, 0.75], abs=2 / 4000)
    assert card.p[12288] == pytest.approx(points[-1] * 4000, abs=0.5)
    assert not card.bit[1024]
    console.type("ECHO 4")
    assert console.type("DIM") == "DIM LV(2)|DIM $V(1,10)|DIM DA(1)|DIM DA0(3)"


@pytest.mark.req("ACR-FLOW-18")
def test_the_goto_example_repeats_a_jog_free_move_an_output_pulse_and_a_two_second_wait() -> None:
    console = two_axes()
    console.type("PROG0", "ACC 100 DEC 100 STP 100 VEL 10")
    console.program(0, "_LOOP1", "SET 32", "X/1", "INH -516", "CLR 32", "DWL 2", "GOTO LOOP1")
    console.type("RUN")
    move_s = 1 / 10 + 10 / 100  # trapezoid of 1 unit
    for cycle in range(1, 4):
        assert console.card.until(32, True, timeout_s=2.1)
        started = console.card.time_s
        assert console.card.until(32, False, timeout_s=1)
        assert console.card.time_s - started == pytest.approx(move_s, abs=0.005)
        assert console.card.p[12288] == cycle


@pytest.mark.req("ACR-FLOW-08")
@pytest.mark.parametrize(("on", "x", "y"), [(True, 25, 0), (False, 0, 5)])
def test_the_if_else_example_moves_x_or_y_by_input_24(on: bool, x: int, y: int) -> None:
    console = two_axes()
    console.program(0, "IF (BIT 24)", "X/25", "ELSE", "Y5", "ENDIF")
    console.card.bit[24] = on
    console.type("RUN")
    console.card.advance(seconds=1)
    assert (console.card.p[12288], console.card.p[12288 + 256]) == (x, y)


@pytest.mark.req("ACR-EVAL-10", "ACR-EVAL-15")
def test_a_target_is_any_expression_of_constants_variables_bits_and_aliases() -> None:
    console = two_axes()
    console.type("SYS", "#DEFINE Pitch P30", "#DEFINE Gate BIT130", "SET 130", "PROG0")
    assert console.type("P0 = 10", "P2 = 3", "Pitch = 4", "X(P0 + P2 * P30)") == ""
    console.card.advance(seconds=1)
    assert console.card.p[12288] == 22
    console.type("X(Pitch * 2 - Gate + P12288)")
    console.card.advance(seconds=1)
    assert console.card.p[12288] == 22 + 9
