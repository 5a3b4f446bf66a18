"""Each word of the cases: what holds, and what is reported where it does not."""

from pathlib import Path

import pytest
from tests.conform.one_case import HEAD, case_of

from openacr.conform import read, report, run


def differs(folder: Path, steps: str, about: str = "") -> str:
    """What is reported of a case of these steps, without its file; empty where it holds."""
    case, path = case_of(folder, about + steps), folder / "cases.txt"
    difference = run(case)
    if difference is None:
        return ""
    place, _, rest = report(case, difference).partition("\n")
    assert place.startswith(f"{path}:") and place.endswith(' in "A"')
    assert difference.at is not None
    assert place.removeprefix(f"{path}:").split(":")[0] == str(difference.at.number)
    number = difference.at.number - (HEAD + about).count("\n")
    return f"{number}|" + "|".join(" ".join(line.split()) for line in rest.split("\n"))


LOOP = "program 0:\n    10 GOTO 10\n"
COUNT = 'program 1:\n    PRINT "a"\n    PRINT "b";\n> PROG1\n> RUN\nwait 10 ms\n'
MOVE = (
    '> PROG0\n> ATTACH MASTER0\n> ATTACH SLAVE0 AXIS0 "X"\n> PPU X1000\n> DRIVE ON X\n'
    "> JOG ACC X1000 JOG DEC X1000 JOG VEL X25\n> JOG INC X10\n"
)

ONE = "part:\n    G1 X1 F60\n    M2\n"


@pytest.mark.parametrize(
    "steps",
    [
        "> ?1\n1\n> ?2\n2",
        ">?1\n1",
        "> ?1\n# a remark\n\n1",
        '> PRINT "wait 1 s"\n|wait 1 s',
        '> PRINT " A "\n| A |',
        "> PRINT\n|",
        '> PRINT "A";\nASYS>',
        "> DIM\n...\n> ?1\n1",
        '> PRINT "|"\n|||',
        '> PRINT "1"\n1\n> PRINT "#"\n|#',
        "SYS> PROG3\nP03> PLC1\nPLC1>",
        'type PRINT "A"\nshows: A',
        LOOP + "> PROG0\ntype LRUN\nwait 1 s\nshows:\npress Esc\nP00> ?BIT1024\n-1",
        COUNT + "prints:\n    a\n    b\\\nprints:",
        COUNT + "prints: a\n    b\\",
        "? 1 + 2 -> 3",
        '? 1; BIT32; "A"; 0.5 -> 1; 0; "A"; 0.5',
        "? 1.5 -> 1.25 +- 0.25  # exactly at its end",
        "> DIM P(1)\nprogram 0:\n    10 P0 = 7\n> RUN PROG0\nwait 10 ms\n? P0 -> 7",
        "SYS> PROG5\nprogram 0:\n    10 GOTO 10\nP05>",
        "plc 0:\n    10 LD 0\n    20 OUT 32\n> RUN PLC0\ninput 0 on\nwait 20 ms\n? BIT32 -> -1",
        "> DIM PLC0(500)\nplc 0:\n    10 LD 0\n",
        "flag 128 on\n> ?BIT128\n-1\nflag 128 off\n> ?BIT128\n0",
        "input 3 on\nwait 1 period\n? BIT3 -> -1\nrelease input 3\nwait 1 period\n? BIT3 -> 0",
        "> DWL 0.02\ntook 20.5 ms\ntook 0.0205 s\ntook 41 periods",
        "> DWL 0.02\ntook 42 periods +- 1 periods  # at the end of the tolerance",
        MOVE + "wait until BIT792 = 0 within 425 ms\ntook 0.425 s\n? P12297 -> 10000",
        MOVE + "wait until BIT792 = -1 within 0 s\nwait until BIT792 <> -1 within 1 s",
        "> PROG0\n> DIM LV(1)\n>> 00 88 00 30\n<< 00 88 00 30 i32=0",
        '>> "?5" 0D\n<< "?5" 0D 0A "5" 0D 0A "SYS>"',
        ">> 00 88 00 30\n<< 00 ?? 00 30 ?? 00 00 00",
        ">> 07 01 00 00 f32=0.5\n<<",
        "channel COM1\nSYS> PROG1\nchannel STREAM1\nSYS>\nchannel COM1\nP01>",
        "channel PACKETS\n>> 00 88 00 30\n<< 00 88 00 30 00 00 00 00",
        "press ^X\npress ^Y\npress ^Z",
        "wait 1 s\n> REBOOT\ntook 0 s\nSYS>",
        "? P6916 -> 0\n>> 00 88 00 30\n<< 00 88 00 30 i32=0\n? P6916 -> 0",
        "program 0:\n    PROGRAM\n    PRINT 1\n    ENDP\n> PROG0\n> LIST\nPROGRAM\n PRINT 1\nENDP",
        "flag 32 on\nwait until BIT32 = -1 within 0 s\nwait until BIT32 = 1 within 0 s",
        "analog P6408 = 5\nwait 1 period\n? ROUND(P6408) -> 5",
        "check setup:\n    CONFIG ENC4 DAC4 STEPPER4 NONE  # W: CONFIG acts after ESAVE and REBOOT",
        ONE + "entries:\n    line X1 F60\n    end\nrun\nat X1\ntook 1.01 s",
        ONE + "store Master Feed ACC/DEC = 10\nrun\ntook 1.1 s",
        ONE + "press START\nwait for RUN\nwait 0.2 s\npress STOP\nwait for PAUSED\nstate: PAUSED",
        "part:\n    M0\n    G0 X1\npress START\nwait for HOLD\nat 0\npress START\n"
        "wait for IDLE\nat X1",
        "part of dialect rs274ngc:\n    g1 x1 y-2 f60\nentries: line X1 Y-2 F60",
        "part:\n    P130 = 5\nrun\nstore ? P130; P131 -> 5; 0",
        "part:\n    PRINT(1)\nrun\nsays: 1\nsays:",
        "part:\n    G28 X1\nentries:\n    rapid X1\n    rapid 0\n    confirm at reference",
        ONE + "start dry\nwait for IDLE\ntook 0.616666 s +- 1 periods  # 100/60 u/s",
        "part:\n    G0 Z1\n    G1 X1 F60\n    X2\nstart line 3, free at 2\nwait until P12288 > 0"
        " within 3 s\n? P12800 -> 20000\nwait for IDLE\nat X2 Z1",
        ONE + "start line 9\nline 9: the program has lines 1 to 2",
        ONE + "start soon\nsoon: a program starts with dry, block, skipping, optional stop,"
        " any tool, line 5, free at 2",
        "press STOP\nnothing runs: the state is IDLE",
        ONE + "start block\nwait for HOLD\nat X1\nblock off\npress START\nwait for IDLE",
        ONE + "start\nclick FOV 5\nwait for IDLE\ntook 2.005 s +- 120 periods  # when it acts",
        ONE + "start\nwait 0.5 s\npress STOP\nwait for PAUSED\nwait 0.1 s\ntrace back\nwait 5 s\n"
        "? P12288 -> 0\ntrace aside\naside: a path is traced back, forward, stop",
        "jog X+\nwait 0.5 s\njog X off\nwait 0.5 s\n? P12288 > 0; P12346 -> -1; 0",
        "jog X+0.01\njog Y- fast increment 4\nwait 1 s\nat X0.01 Y-0.001",
        "jog X\nX: jogs are X+, X- fast, X off, X+0.5, X- increment 3",
        "home B\naxis B is not configured; configured are X Y Z",
        "parm P5 = 2.5\nparm ? P5; P150 -> 2.5; 0\nparm P200 = 1\nP200 is not an operator variable:"
        " P0 to P199 are (`openacr sysvar` has the others)",
        "file M300.TXT:\n    G0 X#3\n    RET\npart:\n    M300 Z2\nrun\nat X2",
        "store on disk\nstore P130 = 5\nrestart\nstore ? P130; P650000 -> 5; 6000",
        "wheel X\nno hand wheel is installed for axis X\nwheel",
        "zero X Y5\nreads Y5\nat 0\ngo to zero Y\nat Y-5\nreads 0\nclear zero\nreads Y-5",
        "jog X+\nwait 1 s\n? P12346 <> 0 -> -1\nlose panel\nwait 1 s\n? P12346; P12297 -> 0; 0",
        "jog X+\nlose host\nwait 3 s\n? P12346; P12297 > 0 -> 0; -1",
        "mdi G91 G1 X0.1 F600\nmdi G1 Q1\nE206 word has no meaning in this block: Q\nat X0.1",
        "check part:\n    G1 X1 F1\n    G77  # E: E203 unknown G code: G77",
        "part:\n    G77\npress START\nPROGRAM:1:1: E203 unknown G code: G77",
        "library part CIRCLE P200=2 D1\nentries:\n    rapid Z0.1\n    ...",
        "library part CIRCLE P200=99999\n...\nentries:",
        "store P271 = 2\nballscrew Y:\n    Y0E.002\n    Y1E0\nwait 50 ms\n? P12555 -> 20",
        "ballscrew X:\n    X0E.1  # E: 1 entry; a table needs 2",
        "ballscrew X measured, home at 1:\n    0 0 0\n    1 0.9 1.0\nmakes:\n    X0E.05000\n"
        "    X1E.00000",
        "check setup:\n    DIM P(1)\n    BLAH  # E: Unknown command",
        "check program 2:\n    10 PRINT 1\n    20 BLAH  # E: Unknown command\n    30 END",
    ],
)
def test_a_case_that_holds(tmp_path: Path, steps: str) -> None:
    assert differs(tmp_path, steps) == ""


@pytest.mark.parametrize(
    ("steps", "reported"),
    [
        ("> ?1\n2", "2|2|expected: 2|shown: 1"),
        ("> DIM\n...\n> ?1\n2", "4|2|expected: 2|shown: 1"),
        ("> ?1", "1|> ?1|expected: (nothing)|shown: 1"),
        ("> DIM P(1)\n...\nX", "1|> DIM P(1)|expected: ...|X|shown: (nothing)"),
        ("> ?1\n1\n1", "1|> ?1|expected: 1|1|shown: 1"),
        ('> PRINT "A "\nA', "2|A|expected: A|shown: |A |"),
        ('> PRINT "A";\nA', "2|A|expected: A|shown: ASYS>"),
        ('> PRINT "#1"\n#2', "2|#2|expected: #2|shown: |#1|"),
        ("flag 32 on\nwait until BIT32 <> -1 within 0 s",
         "2|wait until BIT32 <> -1 within 0 s|expected: BIT32 <> -1 within 0 s|shown: BIT32 <> 1"
         " did not hold within 0 s: BIT32 (OUTPUT: OUT 32) is 1|time 0.0000 s"),
        ("restart", "1|restart|expected: a step that can be done|shown: `store on disk` has to come"
         " first: a store in memory is lost"),
        ("zero X5\nreads X4", "2|reads X4|expected: X4 Y0 Z0|shown: X5 Y0 Z0"),
        ("click AOV 1", "1|click AOV 1|expected: a step that can be done|shown: AOV: the overrides"
         " are FOV, ROV, SOV"),
        ("P00> VER", "1|P00> VER|expected: P00>|shown: SYS>"),
        ("> DWL 61", "1|> DWL 61|expected: an answer within 60 s|shown: (nothing)"),
        ("type ?1\n> ?2\n2", "2|> ?2|expected: (nothing before this line)|shown: 1"),
        ("type ?1\npress ^X", "2|press ^X|expected: (nothing before this line)|shown: 1"),
        ("type ?1\nchannel COM1", "2|channel COM1|expected: (nothing before this line)|shown: 1"),
        ("type ?1", "1|type ?1|expected: (nothing at the end)|shown: 1"),
        ("shows: A", "1|shows: A|expected: A|shown: (nothing)"),
        ("type ?1\nshows:", "2|shows:|expected: (nothing)|shown: 1"),
        ("prints:\n    A", "1|prints:|expected: A|shown: (nothing)"),
        (COUNT + "prints:\n    a\n    b", "9|b|expected: a|b|shown: a|b\\"),
        ("press ^X\nA", "1|press ^X|expected: A|shown: (nothing)"),
        ("channel ABC\n> ?1",
         "2|> ?1|expected: a step that can be done|shown: ABC: the channels are"
         " COM1, COM2, DPCB, PACKETS, STREAM1, STREAM2, STREAM3, STREAM4, STREAM5"),
        ("program 0:\n    10 PRINT 1\n    20 BLAH",
         "3|20 BLAH|expected: a line the card stores|shown: Unknown command"),
        ("plc 0:\n    10 LD 0\n    20 FOO",
         "3|20 FOO|expected: a line the card stores|shown: Unknown command"),
        ("? 1 -> 2", "1|? 1 -> 2|expected: 2|shown: 1"),
        ("? 1; 3 -> 1; 2", "1|? 1; 3 -> 1; 2|expected: 1; 2|shown: 1; 3"),
        ("? 1;2 -> 1", "1|? 1;2 -> 1|expected: 1|shown: 1; 2"),
        ('? "A" -> "B"', '1|? "A" -> "B"|expected: "B"|shown: "A"'),
        ('? 1 -> "1"', '1|? 1 -> "1"|expected: "1"|shown: 1'),
        ("? BLAH -> 1", '1|? BLAH -> 1|expected: 1|shown: "Undefined symbol"'),
        ("? P99999 -> 1",
         "1|? P99999 -> 1|expected: a step that can be done|shown: Invalid parameter"),
        ("? 1.5 -> 1.25 +- 0.249  # x",
         "1|? 1.5 -> 1.25 +- 0.249 # x|expected: 1.25 +- 0.249|shown: 1.5"),
        ("> DWL 0.02\ntook 20 ms",
         "2|took 20 ms|expected: 0.02 s (40 periods)|shown: 0.0205 s (41 periods)"),
        ("> DWL 0.02\ntook 43 periods +- 1 periods  # x",
         "2|took 43 periods +- 1 periods # x|expected: 0.0215 s (43 periods)"
         "|shown: 0.0205 s (41 periods)"),
        ("wait until BIT32 = -1 within 4 periods",
         "1|wait until BIT32 = -1 within 4 periods|expected: BIT32 = -1 within 0.002 s"
         "|shown: BIT32 = 1 did not hold within 0.002 s: "
         "BIT32 (OUTPUT: OUT 32) is 0|time 0.0020 s"),
        ("wait until 5 within 1 s", "1|wait until 5 within 1 s|expected: a step that can be done"
         "|shown: '5': a condition is P or BIT, its number, one of <= >= <> = < > and a value"),
        ("analog P1 = 5", "1|analog P1 = 5|expected: a step that can be done"
         "|shown: P1 shows no analog input"),
        (">> 00 88 00 30\n<< 00 88 00 31 00 00 00 00",
         "2|<< 00 88 00 31 00 00 00 00|expected: 00 88 00 31 00 00 00 00"
         "|shown: 00 88 00 30 00 00 00 00"),
        (">> 00 88 00 30\n<< 00 88 00 30 ?? 00 00 00 00",
         "2|<< 00 88 00 30 ?? 00 00 00 00|expected: 00 88 00 30 ?? 00 00 00 00"
         "|shown: 00 88 00 30 00 00 00 00"),
        (">> 00 88 00 30\n<< 00 88 00 30 00 00 00",
         "2|<< 00 88 00 30 00 00 00|expected: (nothing at the end)|shown: ^@"),
        (">> 00 88 00 30\n<<", "2|<<|expected: (nothing)|shown: 00 88 00 30 00 00 00 00"),
        (ONE + "run\nat X1.0001", "5|at X1.0001|expected: X10001 Y0 Z0 pulses"
         "|shown: X10000 Y0 Z0 pulses"),
        (ONE + "run\nat X1 Z1",
         "5|at X1 Z1|expected: X10000 Y0 Z10000 pulses|shown: X10000 Y0 Z0 pulses"),
        (ONE + "run\nat 0", "5|at 0|expected: X0 Y0 Z0 pulses|shown: X10000 Y0 Z0 pulses"),
        (ONE + "run\ntook 2019 periods",
         "5|took 2019 periods|expected: 1.0095 s (2019 periods)|shown: 1.01 s (2020 periods)"),
        (ONE + "entries: line X1 F60.00001",
         "4|line X1 F60.00001|expected: line X1 F60.00001|shown: line X1 F60|end"),
        ("part:\n    M0\nrun", "3|run|expected: IDLE|shown: HOLD M0"),
        ("store P1001 = 0.5\nstore ? P1001; P1002 -> 0.5; 0.5",
         "2|store ? P1001; P1002 -> 0.5; 0.5|expected: 0.5; 0.5|shown: 0.5; 0"),
        ("store P400101 = 31", "1|store P400101 = 31|expected: (nothing)|shown: P400101 Discrete"
         " Output 1 cannot be 31: outputs of the card are 32 to 63 (-1: not connected)"),
        ("state: RUN", "1|state: RUN|expected: RUN|shown: IDLE"),
        ("says: A", "1|says: A|expected: A|shown: (nothing)"),
        ("alarm: 5", "1|alarm: 5|expected: 5|shown: (nothing)"),
        ("part:\n    G1 X1 F60\npress START\nno", "3|press START|expected: no|shown: (nothing)"),
        ("library part CIRCLE 3",
         "1|library part CIRCLE 3|expected: a step that can be done|"
         "shown: CIRCLE 3: expected NAME P200=3 ... D1"),
        ("ballscrew X:\n    X0E1\n    Y",
         "3|Y|expected: (no message)|shown: # E: 'Y' is not like X1E.00175"),
        ("ballscrew X:\n    X0E1  # E: no\n    X1E0",
         "2|X0E1 # E: no|expected: # E: no|shown: (no message)"),
        ("ballscrew W:\n    W0E1\n    W1E0",
         "1|ballscrew W:|expected: a step that can be done|"
         "shown: axis W is not configured; configured are X Y Z"),
        ("ballscrew X measured, home at 0:\n    0 0\n    1 0\nmakes:\n    X0E.00000",
         "4|makes:|expected: X0E.00000|shown: X0E.00000|X1E1.00000"),
        ("mdi G77", "1|mdi G77|expected: (nothing)|shown: E203 unknown G code: G77"),
        ("check part:\n    G77",
         "2|G77|expected: (no message)|shown: # E: E203 unknown G code: G77"),
        ("check setup:\n    DIM P(1)\n    DIM P(1)",
         "3|DIM P(1)|expected: (no message)|shown: # E: Re-dimensioned block"),
        ("check setup:\n    DIM P(1)  # E: Syntax error",
         "2|DIM P(1) # E: Syntax error|expected: # E: Syntax error|shown: (no message)"),
    ],
)  # fmt: skip
def test_a_case_that_does_not_hold(tmp_path: Path, steps: str, reported: str) -> None:
    assert differs(tmp_path, steps) == reported


def test_an_endless_answer_is_given_up_after_a_minute_of_the_card(tmp_path: Path) -> None:
    shown = differs(tmp_path, LOOP + "> PROG0\n> LRUN")
    assert shown == "4|> LRUN|expected: an answer within 60 s|shown: (nothing)"


def test_a_machine_is_a_project_or_the_text_of_its_file(tmp_path: Path) -> None:
    folder = tmp_path / "machines" / "two-units"
    folder.mkdir(parents=True)
    (folder / "setup.8k").write_text("DIM P(1)\nP0=5\n")
    assert differs(tmp_path, "> ?P0\n5", "machine: two units\n") == ""
    model = 'machine:\n    [card]\n    model = "ACR1505"\n'
    assert differs(tmp_path, "> VER\nACR1505", model).endswith("Version 1.18.06 Update 15")


def test_a_machine_that_cannot_be_loaded_is_a_failure_of_its_case(tmp_path: Path) -> None:
    folder = tmp_path / "machines" / "bad"
    folder.mkdir(parents=True)
    (folder / "setup.8k").write_text("BLAH\n")
    path = tmp_path / "cases.txt"
    path.write_text(HEAD + "machine: bad\n> VER\n")
    (case,) = read(path)
    difference = run(case)
    assert difference is not None
    assert report(case, difference) == (
        f'{path}:1: in "A"\nexpected: a machine that can be loaded\n'
        f"shown:    {folder / 'setup.8k'}:1: Unknown command"
    )


def test_nothing_of_a_case_is_left_for_the_next(tmp_path: Path) -> None:
    first = (
        "> DIM P(5)\n> P1=7\nprogram 0:\n    10 GOTO 10\n> RUN PROG0\ninput 1 on\nchannel COM1\n"
    )
    assert differs(tmp_path, first + "> PROG2\ntype LRUN\nwait 1 s") == ""
    assert (
        differs(tmp_path, "? BIT1024; BIT1 -> 0; 0\n> ?P1\nUndefined variable\nchannel COM1\nSYS>")
        == ""
    )
