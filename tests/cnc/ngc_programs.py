"""The programs of `tests/data/ngc`, and what they come to: `python -m tests.cnc.ngc_programs`.

Each file begins with its title, then with the evidence of what is expected: a section of the
documentation of LinuxCNC, or a closed form. `; judge: none, REASON` keeps it from LinuxCNC.
"""

import re
from pathlib import Path

from tests.cnc.programs import Bench, Run, run, shown

from openacr.cnc.canonical import Arc, Sync
from openacr.cnc.interpreter.interpreter import Options

FOLDER = Path(__file__).parents[1] / "data" / "ngc"
PROGRAMS = sorted(FOLDER.glob("*.ngc"))
CELLS = {2001: 0.5, 2002: 1.25, 1001: 0.125, 1002: 0.25}  # two tools: lengths and radii
_UNJUDGED = re.compile(r"^; judge: none, .+", re.MULTILINE)


def is_judged(path: Path) -> bool:
    """Whether LinuxCNC runs the program with the same moves."""
    return _UNJUDGED.search(path.read_text(encoding="utf-8")) is None


def run_of(path: Path, options: Options | None = None) -> Run:
    """The program on a machine in inches with six axes and two tools."""
    return run(path, CELLS, axes=6, dialect="rs274ngc", machine=Bench(), options=options)


def listed(done: Run) -> str:
    """The canonical entries, one per line: line of the program and entry; then warnings."""
    lines = []
    for entry in done.entries:
        if isinstance(entry, Sync):
            continue
        text = f"{entry.source.line:3} {shown(entry)}"
        if isinstance(entry, Arc):
            text += f" radius {entry.start_radius:.6g}"
        lines.append(text)
    lines += [str(each) for each in done.interpreter.warnings]
    if done.error is not None:
        lines.append(str(done.error))
    return "\n".join(lines) + "\n"


def main() -> None:
    """Write what the programs come to."""
    for path in PROGRAMS:
        path.with_suffix(".txt").write_text(listed(run_of(path)), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
