"""Part programs per second: plain lines to canonical moves, macro loops, whole files."""

import random
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

from bench.figures import at_least, best_s, value_only
from openacr.cnc.canonical import Entry
from openacr.cnc.interpreter.interpreter import Interpreter
from openacr.cnc.loading.load import load
from openacr.cnc.state.hosts import VirtualMachine
from openacr.cnc.state.shadow import Shadow
from openacr.sysvar import Store

LINES = 200_000
PASSES = 50_000
STORE = Store()
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


def interpreted(source: str | Path) -> list[Entry]:
    """Load a program and read it to its end."""
    cells = Shadow(STORE)
    program = load(source, cells)
    return list(Interpreter(program, cells, VirtualMachine()).entries())


def _other_interpreter(path: Path, lines: int, ours: float) -> None:
    """The same program by the interpreter of LinuxCNC, where that is installed."""
    rs274 = shutil.which("rs274")
    if rs274 is None:
        print("  rs274 of LinuxCNC (linuxcnc-uspace): not installed")
        return
    began = time.perf_counter()
    subprocess.run([rs274, "-g", str(path), "/dev/null"], check=False, capture_output=True)
    theirs = lines / (time.perf_counter() - began)
    value_only("  rs274 of LinuxCNC, the same lines per second", theirs, "1/s")
    at_least("  ratio to it", ours / theirs, 2.0, "x")


def main() -> None:
    text = finishing(LINES)
    ours = LINES / best_s(lambda: interpreted(text), 3)
    at_least("lines of G1 loaded and interpreted per second", ours, 700_000, "1/s")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, "FINISH.NC")
        path.write_text(text)
        _other_interpreter(path, LINES, ours)
    passes = PASSES / best_s(lambda: interpreted(LOOP), 3)
    at_least("passes of a macro loop of 6 lines per second", passes, 100_000, "1/s")
    words = "\n".join(f"G1 X{k}.5 Y(P200*{k % 7}) M8 F{k % 50 + 1}" for k in range(10_000))
    value_only("lines with codes and formulas per second", 10_000 / best_s(
        lambda: interpreted(words), 3), "1/s")  # fmt: skip


if __name__ == "__main__":
    main()
