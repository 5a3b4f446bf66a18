"""Part programs per second: lines to canonical moves, macro loops, whole files, whole checks.

`rs274` of LinuxCNC, where it is installed, reads the same files for comparison.
"""

import math
import random
import shutil
import sys
import tempfile
from pathlib import Path

from bench.figures import at_least, at_most, best_s, command_s, value_only
from openacr.cnc.canonical import Entry
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.sysvar import Store

LINES = 200_000
MIXED = 50_000
PASSES = 50_000
STORE = Store()
SWITCHES = "G17", "G90", "G40", "G17 G90 G21", "M8", "G54", "S8000 M3", "T1 M6", "S6500", "M5"
LOOP = f"""F100
G65 P9000
M2
N9000 #1=0
N10 #1=#1+1
#2=SIN(#1)*10
#3=COS(#1)*10
X#2 Y#3
#4=#4+#2
IF #1<{PASSES} THEN GOTO 10
RET
"""
O_WORDS = f"""F100
#1=0
o1 while [#1 lt {PASSES}]
#1=[#1+1]
#2=[sin[#1]*10]
#3=[cos[#1]*10]
X#2 Y#3
#4=[#4+#2]
o1 endwhile
M2
"""
EXPRESSIONS = "".join(f"G1 X{k}.5 Y(P200*{k % 7}+.5) F{k % 50 + 1}\n" for k in range(50_000))
ARCS = "F100 G0 X0 Y0\n" + "".join(f"G3 X{k % 2} I{k % 2 - 0.5}\n" for k in range(1, 50_000))
HOLES = "F100 G0 Z5\nG99 G81 X0 Y0 Z-2 R1\n" + "".join(
    f"X{k % 100} Y{k / 100:.2f}\n" for k in range(4_000)
)
COMPENSATED = "F100 G0 X-5 Y-5\nG41.1 D.1 G1 X0 Y0\n" + "".join(
    f"X{k / 10:.1f} Y{k % 2 / 100:.2f}\n" for k in range(1, 10_000)
)


def finishing(lines: int) -> str:
    """A finishing program of small straight moves."""
    chance = random.Random(1)
    x = y = z = 0.0
    rows = ["G90 G1 F1000"]
    for _ in range(lines):
        x, y = x + chance.uniform(-0.2, 0.2), y + chance.uniform(-0.2, 0.2)
        z = -chance.random()
        rows.append(f"X{x:.4f} Y{y:.4f} Z{z:.4f}")
    return "\n".join([*rows, "M2"]) + "\n"


def mixed(lines: int) -> str:
    """A shop file: lines, arcs, rapids, N numbers, remarks, modal words, switches."""
    chance = random.Random(2)
    x = y = 0.0
    rows = ["G21 G90 G94 G17 G40", "G91.1", "T1 M6", "S8000 M3", "G0 X0 Y0 Z5", "F800"]
    while len(rows) < lines - 1:
        kind, number = chance.random(), len(rows) * 10
        if kind < 0.6:
            x, y = x + chance.uniform(-1, 1), y + chance.uniform(-1, 1)
            rows.append(f"N{number} G1 X{x:.4f} Y{y:.4f} Z{-chance.random():.3f}")
        elif kind < 0.85:
            a, i, j = chance.uniform(0.2, 6.0), chance.uniform(0.5, 2.0), chance.uniform(-2, 2)
            x, y, i, j = round(x, 4), round(y, 4), round(i, 4), round(j, 4)
            to_x = x + i - i * math.cos(a) + j * math.sin(a)
            to_y = y + j - i * math.sin(a) - j * math.cos(a)
            rows.append(f"G3 X{to_x:.4f} Y{to_y:.4f} I{i:.4f} J{j:.4f}")
            x, y = to_x, to_y
        elif kind < 0.9:
            rows.append(f"(contour {number})")
        elif kind < 0.93:
            rows.append(f"G1 X{x:.4f} F{chance.randrange(100, 900)} (finish)")
        elif kind < 0.97:
            rows.append(chance.choice(SWITCHES))
        else:
            rows += ["G0 Z2", f"G0 X{x:.4f} Y{y:.4f}", "G1 Z-1 F200"]
    return "\n".join([*rows, "M30"]) + "\n"


def interpreted(source: str | Path, dialect: str = "acromill") -> list[Entry]:
    """Load a program and read it to its end."""
    cells = Shadow(STORE)
    program = load(source, cells, dialect)
    options = Options(has_batches=True)
    return list(Interpreter(program, cells, VirtualMachine(), dialect, options).entries())


def _theirs_s(path: Path) -> float:
    """The same program by the interpreter of LinuxCNC; 0 where that is not installed."""
    rs274 = shutil.which("rs274")
    if rs274 is None:
        print("  rs274 of LinuxCNC (linuxcnc-uspace): not installed")
        return 0.0
    table, numbers = path.with_name("tool.tbl"), path.with_name("first.var")
    table.write_text("T1 P1 Z0.5 D0.25\n")
    numbers.write_text("")  # without both it ends at once
    home = f"HOME={path.parent}"  # where it shares its table of tools
    files = ["-t", str(table), "-v", str(numbers), str(path), "/dev/null"]
    return command_s(["env", home, rs274, "-g", *files])


def _file(name: str, text: str, most: float) -> None:
    """A program loaded and interpreted, and the whole command `mill check`."""
    lines = text.count("\n")
    per_s = lines / best_s(lambda: interpreted(text, "rs274ngc"), 3)
    at_least(f"lines of {name} loaded and interpreted per second", per_s, 300_000, "1/s")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "FILE.NGC")
        path.write_text(text)
        command = "from openacr.cli.main import main; main()"
        arguments = ["mill", "check", "--dialect", "rs274ngc", str(path)]
        check_s = command_s([sys.executable, "-c", command, *arguments])
        value_only(f"  openacr mill check of {lines} lines", check_s, "s")
        theirs_s = _theirs_s(path)
        if theirs_s:
            value_only("  rs274 of LinuxCNC on the same file", theirs_s, "s")
            value_only("  its lines per second", lines / theirs_s, "1/s")
            at_most("  mill check in all, of its time", check_s / theirs_s, most, "x")


def main() -> None:
    _file("a finishing program", finishing(LINES), 1.0)
    _file("a shop file", mixed(MIXED), 1.0)
    _file("a long shop file", mixed(LINES), 0.5)
    passes = PASSES / best_s(lambda: interpreted(LOOP), 3)
    at_least("passes of a macro loop of 6 lines per second", passes, 180_000, "1/s")
    passes = PASSES / best_s(lambda: interpreted(O_WORDS, "rs274ngc"), 3)
    at_least("passes of a loop of 6 lines by O-words", passes, 180_000, "1/s")
    _lines("blocks with expressions", EXPRESSIONS, "acromill", 150_000)
    _lines("arcs", ARCS, "rs274ngc", 500_000)
    _lines("holes of a canned cycle", HOLES, "rs274ngc", 100_000)
    _lines("compensated lines", COMPENSATED, "rs274ngc", 200_000)


def _lines(name: str, text: str, dialect: str, target: float) -> None:
    """Lines of one kind, loaded and interpreted."""
    per_s = text.count("\n") / best_s(lambda: interpreted(text, dialect), 3)
    at_least(f"{name} per second", per_s, target, "1/s")


if __name__ == "__main__":
    main()
