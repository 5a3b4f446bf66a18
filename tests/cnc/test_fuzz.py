"""Mutated programs: an error with its line or a correct reading, never anything else."""

import random
from itertools import islice

import pytest
from tests.cnc.programs import Bench, made, shown, unrolled

from openacr.cnc.canonical import Arc, BlockEnd, Entry, Line, Motion, Polyline, Probe, Rapid, Sync
from openacr.cnc.interpreter.interpreter import Options
from openacr.cnc.interpreter.mdi import Mdi
from openacr.cnc.reading.findings import TEXTS, BlockError, Finding

MOVES = (Rapid, Line, Arc, Polyline, Probe)
ACROMILL = """\
N100 G90 G17 G1 X1.5 Y-2 F100 (note)
G2 X3 Y0 I1 J.5
G3 X1 Y1 R2 F50.5 S1000 M3
/ G0 Z5 M8
P200 = 1.555*Sin(45) + P6/(P10+1)
#150=#150+1 X(P150) Y-#151
IF P150<5 THEN GOTO 100
IF #1 = 1 THEN GOSUB 500
GOSUB 500
G65 P500 L2 X1 Y2 Z3 A4 G10 M11
G66 P500 X1
G67
G81 X1 Y1 Z-1 R.1 F10
G83 G91 X1 Z-1 R-.5 Q.3 L3
G76 X2 Z-1 R0 Q.1 P.5
G80 G98 G40 G49
G41 D1 G1 X5 Y5
G42 D2 X1
G40 X0
G43 H1 Z1
G101 X1
G51 X0 Y0 Z0 P2
G51 I-1 J1 K1
G50
G68 X0 Y0 R30
G69
G52 X1
G54 X1
G59.1
G92 X0 Y0
G10 L2 P1 X1 Y2
G10 L12 P1 R.25
G28 X1 Y1
G29 X2
G30 P3 X1
G31 X9
G27 X1
G4 F.5
G9 X1
G200 F1
T3 M6
T P3
M12 M25 M105 M205
M595
M599
(MSG, hello)
PRINT "a"; P150*2; "b"
INPUT "how many", P150
OUT(33) = 1
BIT(130) = INP(3) XOR 1
N500 X(#1+ABS(#2)) Y1
RET
M2
$I CYCLES.TXT
O1234
%
G21 G91 G0X-.5Y.5Z+1.
; nothing
REM comment
"""
OTHER = """\
O100 sub
G1 X#1 Y[#2+1] F100
O100 endsub
O101 while [#1 LT 5]
#1=[#1+1] #<_x>=3
O101 endwhile
O102 if [#<a> EQ 1]
O102 elseif [1]
O102 else
O102 endif
O103 repeat [3]
O103 endrepeat
O100 call [1] [2]
O104 do
O104 while [0]
#3=100
O#3 call
O[#3] call [1]
O200
M98 P200
M99
G41.1 D.5 X1
G42 X2
G40 X3
(DEBUG, #1 #<_x> P1)
G38.2 Z-1 F10
G43.1 Z1
G2 X1 Y1 R1
G81 X1 Z-1 R.1
G64 P.01
G53 G0 X1
G93 G1 X1 F2
G10 L20 P1 X0
G92.1
M64 P1
M66 P1 L3
M98 P100
M30
X[ATAN[1]/[2]] YABS[-1] Z[2**3 MOD 5]
G28.1
#5161=3
G10 L2 P1 X1 R30
G10 L20 P0 X1 Y2
G52 X1 Y2
G0 @5 ^30
G91 @1
G[#1+1] X2 F10
M[3+#2] S100
G3 X1 Y0 I-1 P3 Z1
G5 X1 Y1 I0 J3 P0 Q-3
G5 X2 Y2 P0 Q1
G5.1 X4 Y0 I2 J4
G5.2 X1 Y1 P1 L3
X2 Y2 P.5
G5.3
M70
M72
M73
M61 Q2
M66 P1 L3 Q2
G4 P1 X2
G43.2 X1
(LOG, #<_x> #5399)
#3=EXISTS[#<_feed>]
"""
LETTERS = 'GMXYZABCUVFSTDHNPLRQIJKOEW@^#[]()+-*/=<>.,;:"$%/ 0123456789\t\u2212é\x00\x1a'


def mutated(line: str, chance: random.Random) -> str:
    characters = list(line)
    for _ in range(chance.choice([0, 1, 1, 2, 4])):
        at = chance.randrange(len(characters) + 1)
        kind = chance.random()
        if kind < 0.4:
            characters.insert(at, chance.choice(LETTERS))
        elif kind < 0.7 and at < len(characters):
            del characters[at]
        elif kind < 0.9 and at < len(characters):
            characters[at] = chance.choice(LETTERS)
        else:
            characters[at:at] = list(chance.choice(["1e9", "99999", "((", "P9999", "GOTO 1", "G1"]))
    return "".join(characters)


def program(lines: list[str], chance: random.Random, count: int) -> str:
    chosen = chance.sample(lines, min(count, len(lines)))
    if "RET" in lines and chance.random() < 0.7:
        words = ["M2", "$I CYCLES.TXT", "RET", "%"]
        chosen = ["F10", *[line for line in chosen if line not in words], "M2"]
        labels = {line.split()[0] for line in chosen if line[:1] == "N"}
        chosen += [f"{label} RET" for label in ("N100", "N500") if label not in labels]
        chosen += ["$I CYCLES.TXT"]
    share = chance.choice([0.0, 0.0, 0.05, 0.3])
    chosen = [mutated(line, chance) if chance.random() < share else line for line in chosen]
    return chance.choice(["\n", "\r\n", "\r"]).join(chosen)


def attempt(text: str, dialect: str, chance: random.Random) -> None:
    """Load and run one program; anything but a finding is a failure."""
    machine = Bench(
        trip=(0.5,) * 8 if chance.random() < 0.3 else None,
        bits={n for n in range(40) if chance.random() < 0.5},
        is_skipping=chance.random() < 0.5,
    )
    options = Options(
        is_dry=chance.random() < 0.2,
        has_block_ends=chance.random() < 0.4,
        collects_errors=chance.random() < 0.3,
    )
    cells = {1001: 0.1, 1002: -0.05, 2001: 1.0, 250_112: 3.0, 400_010: 3.0}
    done = made(text, cells, axes=7, dialect=dialect, options=options, machine=machine)
    run = done.interpreter
    last = run.program.line_cnt
    for finding in run.program.findings:
        assert finding.code in TEXTS
        assert 1 <= finding.line
        assert finding.file != "PROGRAM" or finding.line <= max(last, 1)
    if run.program.errors:
        return
    entries, block = run.entries(), list[Entry]()
    try:
        for entry in islice(entries, 3000):
            if isinstance(entry, Polyline):
                assert len(entry.ends) == len(entry.lines)
            block.append(entry)
            if isinstance(entry, BlockEnd):
                block.clear()
    except BlockError as error:
        assert error.finding.code in TEXTS
        assert 1 <= error.finding.line
        assert next(entries, None) is None
        # Compensation issues moves later: those of a line may be from an earlier pass over it.
        is_of_chain = error.finding.code.startswith("E32")
        if options.has_block_ends and error.finding.code[0] == "E" and not is_of_chain:
            moves = [e for e in block if isinstance(e, MOVES) and here(e) == here(error.finding)]
            assert not moves, f"{error} after {moves} in\n{text}"
    except Exception as error:
        raise AssertionError(f"{error!r} from\n{text}") from error


def here(what: Motion | Finding) -> tuple[str, int]:
    """File and line."""
    place = what if isinstance(what, Finding) else what.source
    return place.file, place.line


def typed(lines: list[str], dialect: str, chance: random.Random) -> None:
    mdi = Mdi(made("M2\nN500 X1\nRET", dialect=dialect, axes=7).interpreter)
    for line in lines:
        try:
            for _ in islice(mdi.execute(line), 3000):
                pass
        except BlockError as error:
            assert error.finding.code in TEXTS
        except Exception as error:
            raise AssertionError(f"{error!r} from {line!r}") from error


def outcome(text: str, dialect: str, *, has_block_ends: bool) -> list[str]:
    """What a program does up to its error, without what only single block adds."""
    options = Options(has_block_ends=has_block_ends)
    done = made(text, {1001: 0.1, 2001: 1.0}, axes=7, dialect=dialect, options=options)
    if done.interpreter.program.errors:
        return []
    seen: list[str] = []
    try:
        for entry in islice(unrolled(done.interpreter.entries()), 2000):
            if not isinstance(entry, BlockEnd | Sync):
                seen.append(f"{entry.source.line} {shown(entry)}")
                if len(seen) == 200:
                    return seen
    except BlockError as error:
        seen.append(str(error))
    return seen


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
def test_programs_do_the_same_block_by_block(dialect: str) -> None:
    chance = random.Random(7)
    corpus = {"acromill": ACROMILL, "rs274ngc": OTHER}[dialect].splitlines()
    loops = {
        "acromill": "P150=0|N9 P150=P150+1|G91 X1|#151=#151+P150|IF P150<7 THEN GOTO 9|G90 X#151",
        "rs274ngc": "O9 while [#1 LT 7]|#1=[#1+1]|G91 X1|#151=[#151+#1]|O9 endwhile|G90 X#151",
    }[dialect].split("|")
    for _ in range(60):
        lines = ["F10", *loops, *program(corpus, chance, 8).splitlines()]
        text = "\n".join(lines)
        both = [outcome(text, dialect, has_block_ends=on) for on in (False, True)]
        assert both[0] == both[1], text


def fuzz(seed: int, lines: int) -> None:
    chance = random.Random(seed)
    done = 0
    while done < lines:
        name, corpus = chance.choice((("acromill", ACROMILL), ("rs274ngc", OTHER)))
        text = corpus.splitlines()
        if name == "rs274ngc":
            text += ["G1 X1 Y2 F100", "G2 X3 Y0 I1 J.5", "G41 D1 X5", "G40 X1", "G55"]
        count = chance.randrange(1, 30)
        if chance.random() < 0.8:
            attempt(program(text, chance, count), name, chance)
        else:
            typed([mutated(chance.choice(text), chance) for _ in range(count)], name, chance)
        done += count


@pytest.mark.req("MILL-LOAD-ERR")
@pytest.mark.parametrize("seed", range(4))
def test_mutated_lines_are_read_or_refused(seed: int) -> None:
    fuzz(seed, 5000)


@pytest.mark.soak
def test_a_million_mutated_lines_are_read_or_refused() -> None:
    for seed in range(200):
        fuzz(1000 + seed, 5000)
