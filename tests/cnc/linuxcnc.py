"""The interpreter of LinuxCNC as a judge: the moves of `rs274 -g`, in machine coordinates.

Its lines for the programs of `tests/data/ngc` are kept beside them (`*.canon`), for `rs274` is on
few computers. Where it is (Debian package linuxcnc-uspace), `python -m tests.cnc.linuxcnc` writes
them again; the version belongs into `tests/evidence.toml`.

`rs274` prints the calls of its canonical machining functions, in program units. What they come to
on a machine is written in the documentation of LinuxCNC (Coordinate Systems, "G10 L2") and of
its canonical functions: a point is shifted by the offset of G52 and G92, turned by the rotation of
the work system about Z, shifted by the offset of that system and by the tool offset.
"""

import math
import os
import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import pytest
from tests.cnc.ngc_programs import PROGRAMS, is_judged
from tests.cnc.programs import Run

from openacr.cnc.canonical import Arc, Dwell, Line, Probe, Rapid, Say

PROGRAM = shutil.which("rs274")
needs_linuxcnc = pytest.mark.skipif(
    PROGRAM is None, reason="rs274 of LinuxCNC (Debian package linuxcnc-uspace) is not installed"
)
NEAR = 2e-3  # it prints four decimals; a rotation and a radius add some of them
_CALL = re.compile(r"([A-Z_0-9]+)\((.*)\)\s*$")
_NUMBER = re.compile(r"-?\d+\.?\d*")
_TABLE = "T1 P1 Z0.5 D0.25\nT2 P2 Z1.25 D0.5\n"
_PLANES = {"CANON_PLANE_XY": (0, 1, 2), "CANON_PLANE_XZ": (2, 0, 1), "CANON_PLANE_YZ": (1, 2, 0)}
_LIMIT_S = 20


@dataclass(frozen=True, slots=True)
class Move:
    """One move: `R`, `L`, `A` or `D` (dwell), its end, and of arcs centre and sweep."""

    kind: str
    end: tuple[float, ...]
    centre: tuple[float, ...] = ()
    sweep_deg: float = 0.0
    feed: float = 0.0


@dataclass(slots=True)
class Canon:
    """What the canonical functions keep."""

    origin: list[float] = field(default_factory=lambda: [0.0] * 6)
    shift: list[float] = field(default_factory=lambda: [0.0] * 6)
    tool: list[float] = field(default_factory=lambda: [0.0] * 6)
    turn_deg: float = 0.0
    plane: tuple[int, int, int] = (0, 1, 2)
    at: list[float] = field(default_factory=lambda: [0.0] * 6)  # program
    moves: list[Move] = field(default_factory=list)
    texts: list[str] = field(default_factory=list)
    feed: float = 0.0

    def machine(self, point: list[float]) -> tuple[float, ...]:
        """A program point on the machine."""
        p = [a + b for a, b in zip(point, self.shift, strict=True)]
        angle = math.radians(self.turn_deg)
        x, y = p[0], p[1]
        p[0] = x * math.cos(angle) - y * math.sin(angle)
        p[1] = x * math.sin(angle) + y * math.cos(angle)
        return tuple(a + o + t for a, o, t in zip(p, self.origin, self.tool, strict=True))

    def take(self, name: str, text: str) -> bool:
        """One call; whether it says anything of the moves."""
        numbers = [float(each) for each in _NUMBER.findall(text)]
        if name in ("STRAIGHT_TRAVERSE", "STRAIGHT_FEED", "STRAIGHT_PROBE"):
            self.at = numbers[:6]
            kind = {"STRAIGHT_TRAVERSE": "R", "STRAIGHT_FEED": "L"}.get(name, "P")
            feed = self.feed if kind == "L" else 0.0
            self._add(Move(kind, self.machine(self.at), feed=feed))
        elif name == "ARC_FEED":
            self._arc(numbers)
        elif name == "SET_G5X_OFFSET":
            self.origin = numbers[1:7]
        elif name == "SET_G92_OFFSET":
            self.shift = numbers[:6]
        elif name == "SET_XY_ROTATION":
            self.turn_deg = numbers[0]
        elif name == "USE_TOOL_LENGTH_OFFSET":
            self.tool = numbers[:6]
        elif name == "SELECT_PLANE":
            self.plane = _PLANES[text]
        elif name == "SET_FEED_RATE":
            self.feed = numbers[0]
        elif name == "DWELL":
            self.moves.append(Move("D", (numbers[0],)))
        elif name == "MESSAGE":
            self.texts.append(text.strip('"'))
        else:
            return False
        return True

    def _add(self, move: Move) -> None:
        """A move; one that stays where it is moves nothing."""
        last = next((each for each in reversed(self.moves) if each.kind != "D"), None)
        here = last.end if last else (0.0,) * 6  # where the machine begins
        if move.kind != "R" or math.dist(here, move.end) > NEAR:
            self.moves.append(move)

    def _arc(self, numbers: list[float]) -> None:
        end1, end2, c1, c2, turns, across, *rest = numbers
        first, second, drill = self.plane
        start = self.at
        end = [0.0] * 3 + rest[:3]
        end[first], end[second], end[drill] = end1, end2, across
        middle = list(start)
        middle[first], middle[second] = c1, c2
        begins = math.atan2(start[second] - c2, start[first] - c1)
        sweep = math.atan2(end2 - c2, end1 - c1) - begins
        if turns > 0:
            sweep = (sweep % math.tau or math.tau) + math.tau * (turns - 1)
            sweep += math.tau if sweep < 1e-3 else 0.0
        else:
            sweep = -((-sweep) % math.tau or math.tau) + math.tau * (turns + 1)
        self.at = end
        centre = self.machine(middle)
        where = (centre[first], centre[second])
        self.moves.append(Move("A", self.machine(end), where, math.degrees(sweep), self.feed))


def golden(path: Path) -> Path:
    """The file with the lines of LinuxCNC for a program."""
    return path.with_suffix(".canon")


def printed(path: Path) -> str:
    """What LinuxCNC prints of the moves of a program in inches, one call per line, to its end."""
    assert PROGRAM is not None
    with tempfile.TemporaryDirectory(prefix="openacr-rs274-") as name:
        folder = Path(name)
        program = f"G20 {path.read_text(encoding='utf-8')}"
        (folder / "program.ngc").write_text(program, encoding="utf-8")
        (folder / "tool.tbl").write_text(_TABLE, encoding="utf-8")
        (folder / "first.var").write_text("", encoding="utf-8")
        command = [PROGRAM, "-g", "-t", "tool.tbl", "-v", "first.var", "program.ngc"]
        home = os.environ | {"HOME": name}  # where it shares its table of tools
        done = subprocess.run(
            command,
            cwd=name,
            env=home,
            capture_output=True,
            text=True,
            timeout=_LIMIT_S,
            check=False,
        )
    canon = Canon()
    kept: list[str] = []
    for line in done.stdout.splitlines():
        found = _CALL.search(line)
        if found and found[1] == "PROGRAM_END":
            return "".join(kept)
        if found and canon.take(found[1], found[2]):
            kept.append(f"{found[0].rstrip()}\n")
    raise AssertionError(f"LinuxCNC refuses it: {done.stdout[-300:]}{done.stderr[-300:]}")


def judged(path: Path) -> Canon:
    """What LinuxCNC does with a program, by the lines that are kept of it."""
    canon = Canon()
    for line in golden(path).read_text(encoding="utf-8").splitlines():
        found = _CALL.fullmatch(line)
        assert found, line
        assert canon.take(found[1], found[2]), line
    return canon


def own(done: Run) -> list[Move]:
    """The moves of a run in the same form; turns of one arc together."""
    found: list[Move] = []
    last = None
    for entry in done.entries:
        if isinstance(entry, Rapid | Line):
            kind = "R" if isinstance(entry, Rapid) else "L"
            feed = entry.pace.feed_upm if isinstance(entry, Line) else 0.0
            found.append(Move(kind, entry.end[:6], feed=feed))
        elif isinstance(entry, Probe):
            found.append(Move("P", entry.end[:6]))
        elif isinstance(entry, Dwell):
            found.append(Move("D", (entry.seconds,)))
        elif isinstance(entry, Arc):
            sweep = math.degrees(entry.sweep_rad)
            if isinstance(last, Arc) and _is_turn(last, entry):
                sweep += found.pop().sweep_deg
            found.append(Move("A", entry.end[:6], entry.centre, sweep, entry.pace.feed_upm))
        last = entry
    return found


def _is_turn(one: Arc, other: Arc) -> bool:
    return one.source == other.source and one.centre == other.centre


def texts(done: Run) -> list[str]:
    """The messages of a run."""
    return [entry.text for entry in done.entries if isinstance(entry, Say)]


def compare_texts(mine: list[str], theirs: list[str]) -> None:
    """AssertionError at the first message with another number."""
    assert len(mine) == len(theirs), (mine, theirs)
    for here, there in zip(mine, theirs, strict=True):
        numbers = [[float(each) for each in _NUMBER.findall(text)] for text in (here, there)]
        assert numbers[0] == pytest.approx(numbers[1], abs=NEAR), (here, there)


def compare(mine: list[Move], theirs: list[Move]) -> None:
    """AssertionError at the first move that differs."""
    assert [each.kind for each in mine] == [each.kind for each in theirs], (mine, theirs)
    for here, there in zip(mine, theirs, strict=True):
        assert here.end == pytest.approx(there.end, abs=NEAR), (here, there)
        assert here.centre == pytest.approx(there.centre, abs=NEAR), (here, there)
        assert here.sweep_deg == pytest.approx(there.sweep_deg, abs=0.5), (here, there)
        assert here.feed == pytest.approx(there.feed, abs=NEAR), (here, there)


def main() -> None:
    """Write the lines of LinuxCNC for every program that it judges."""
    for path in filter(is_judged, PROGRAMS):
        golden(path).write_text(printed(path), encoding="utf-8", newline="\n")


if __name__ == "__main__":
    main()
