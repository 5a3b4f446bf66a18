"""Plain lines many at a time: the same as one by one."""

import random
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.cnc.programs import Bench, Run, made, unrolled
from tests.search import search

from openacr.cnc.canonical import Entry, Line, Polyline, Rapid
from openacr.cnc.interpreter.by_line import lines_cy, scanning
from openacr.cnc.interpreter.by_line.scanning import Scanner
from openacr.cnc.interpreter.interpreter import Interpreter, Options
from openacr.cnc.loading.load import load
from openacr.cnc.reading import scan_cy as scan
from openacr.cnc.reading.findings import BlockError
from openacr.cnc.reading.line_shapes import LineShapes
from openacr.cnc.rows import scans
from openacr.compiled import pick


def slow(text: str, **more: object) -> Run:
    """Every line by itself."""
    done = made(text, **more)  # type: ignore[arg-type]
    done.interpreter.execution.scanner = Never(done.interpreter)
    return finished(done)


def fast(text: str, **more: object) -> Run:
    return finished(made(text, **more))  # type: ignore[arg-type]


def finished(done: Run) -> Run:
    try:
        for entry in done.interpreter.entries():
            done.entries.append(entry)
    except BlockError as error:
        done.error = error.finding
    return done


class Never(Scanner):
    @property
    def is_free(self) -> bool:
        return False


def bare(entries: list[Entry]) -> list[object]:
    """What a machine does with them."""
    moves: list[object] = []
    for entry in unrolled(iter(entries)):
        if isinstance(entry, Line):
            moves.append(("L", entry.end, entry.pace, entry.source.line))
        elif isinstance(entry, Rapid):
            moves.append(("R", entry.end, None, entry.source.line))
        else:
            moves.append((type(entry).__name__, None, None, 0))
    return moves


def number(chance: random.Random) -> str:
    value = chance.choice(
        [
            f"{chance.uniform(-9, 9):.{chance.randrange(7)}f}",
            f".{chance.randrange(1000)}",
            f"{chance.randrange(20)}.",
            f"-{chance.randrange(9)}",
            f"+{chance.randrange(9)}.5",
            f"0000{chance.randrange(9)}",
            "123456789012345678",
            "0",
            "-.0",
        ]
    )
    return " " * chance.randrange(2) + value


def word(chance: random.Random) -> str:
    kind = chance.random()
    if kind < 0.8:
        return chance.choice("XYZxyzAU") + number(chance)
    if kind < 0.9:
        return chance.choice(["G1", "g01", "G0", "G1", "G 1"])
    return chance.choice(["F100", "F50.5", "f7"])


def line(chance: random.Random) -> str:
    if chance.random() < 0.03:
        return chance.choice(
            ["", "(note)", "G91", "G90", "G21", "G20", "M8", "; end", "P200=1", "G92 X1", "G54",
             "G61", "G64", "G9 X1", "G55 X0", "X(1+1)", "G2 X1 I1 J1", "G1"]
        )  # fmt: skip
    words = [word(chance) for _ in range(chance.randrange(1, 5))]
    letters = [w[0].upper() for w in words]
    if len(set(letters)) < len(letters):
        return line(chance)
    chance.shuffle(words)
    return " " * chance.randrange(2) + " ".join(words)


@search(60)
@given(seed=st.integers(0, 10**9))
def test_both_ways_give_the_same_moves(seed: int) -> None:
    chance = random.Random(seed)
    ends = chance.choice(["\n", "\r\n", "\r"])
    lines = ["F10"] + [line(chance) for _ in range(300)]
    text = ends.join(
        f"N{k} {one}" if chance.random() < 0.2 else one for k, one in enumerate(lines, 1)
    )
    cells = {910: 0.125, 921: -3.0, 800: 0.0}
    axes = 7
    done, single = fast(text, cells=cells, axes=axes), slow(text, cells=cells, axes=axes)
    assert done.interpreter.program.findings == single.interpreter.program.findings
    if done.interpreter.program.errors:
        return
    assert bare(done.entries) == bare(single.entries)
    assert done.error == single.error
    assert done.interpreter.position == single.interpreter.position
    assert done.interpreter.modal == single.interpreter.modal


def test_many_lines_come_as_one_polyline() -> None:
    text = "F100\nG1 X0 Y1\n" + "\n".join(f"X{k}" for k in range(1, 1001)) + "\nM2"
    done = fast(text)
    (polyline,) = done.of(Polyline)
    assert isinstance(polyline, Polyline)
    assert polyline.ends.shape == (1001, 8)
    assert polyline.ends[-1].tolist() == [1000, 1, 0, 0, 0, 0, 0, 0]
    assert polyline.lines.tolist() == list(range(2, 1003))
    assert polyline.source.text == "G1 X0 Y1"
    assert polyline.pace.feed_upm == 100


@pytest.mark.parametrize(
    "change",
    ["G51 X0 Y0 P2", "G68 X0 Y0 R30", "G41 D1", "G66 P5", "M595", "G93"],
)
def test_where_more_depends_on_a_line_each_is_read_by_itself(change: str) -> None:
    text = f"F100\nG1\n{change}\n" + "\n".join(f"X{k} Y{k % 7}" for k in range(1, 60))
    text += "\nM2\nN5 P200=P200+1\nRET"
    dialect = "rs274ngc" if change == "G93" else "acromill"
    if dialect == "rs274ngc":
        pytest.importorskip("openacr.cnc.codes.dialects.rs274ngc")
        text = text.split("\nN5")[0].replace("\nX", "\nF60 X")
    done = made(text, {1001: 0.1, 250_112: 3}, axes=4, dialect=dialect)
    entries = list(done.interpreter.entries())
    assert not any(isinstance(entry, Polyline) for entry in entries)
    assert sum(isinstance(entry, Line) for entry in entries) >= 59


def test_labels_in_plain_lines_are_found() -> None:
    lines = "\n".join(f"N{k} X{k}" for k in range(1, 500))
    text = f"F10\nN500 G1 X0\n{lines}\nIF P200=1 THEN GOTO 501\nP200=1\nGOTO 490\nN501 M2"
    done = fast(text, cells={200: 0.0})
    ends = [entry.end[0] for entry in unrolled(iter(done.entries)) if isinstance(entry, Line)]
    assert ends == [*range(1, 500), *range(490, 500)]


def test_a_label_given_twice_is_found_in_plain_lines() -> None:
    lines = "\n".join(f"N{k} X{k}" for k in [*range(1, 50), 20, *range(60, 90)])
    (error,) = made("F10\nG1 X0\n" + lines).interpreter.program.errors
    assert (error.code, error.line) == ("E221", 52)
    assert "line 22" in error.hint
    (error,) = made(
        "F10\nN5 (a) X0\n" + lines.replace("N20 X20\nN60", "N60")
    ).interpreter.program.errors
    assert (error.code, error.line) == ("E221", 7)


def test_the_executor_is_the_same_compiled_and_plain() -> None:
    chance = random.Random(5)
    text = "F10\n" + "\n".join(line(chance) for _ in range(400))
    entries = []
    for function in (lines_cy.run_lines, pick(lines_cy.run_lines)):
        done = made(text, axes=4, options=Options(has_batches=True))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(scanning, "_run_lines", function)
            entries.append(unrolled(iter(finished(done).entries)))
    assert list(entries[0]) == list(entries[1])


def test_numbers_are_read_as_float_reads_them() -> None:
    chance = random.Random(9)
    for _ in range(3000):
        digits = str(chance.randrange(10 ** chance.randrange(1, 16)))
        cut = chance.randrange(len(digits) + 1)
        text = f"{digits[:cut]}.{digits[cut:]}"
        shapes = LineShapes({}, "(")
        data = memoryview(bytearray(text.encode()))
        end = scan.scan_number(data, 0, len(text), shapes.F)
        assert end == len(text)
        assert shapes.F[scans.value] == float(text)


@pytest.mark.req("MILL-LOAD-BIG")
def test_a_large_file_is_read_in_windows(tmp_path: Path) -> None:
    """200 000 lines of 6 MB: more than one window, every line once, in order."""
    path = tmp_path / "BIG.NC"
    with path.open("w") as file:
        file.write("F100\nG1 X0 Y0\n")
        for k in range(1, 200_001):
            file.write(f"X{k / 1000:.4f} Y{k % 977 / 100:.4f} Z-{k % 13}.25\n")
    done = made("M2")
    program = load(path, done.cells)
    assert program.findings == []
    assert program.line_cnt == 200_002
    run = Interpreter(program, done.cells, Bench())
    seen = 2
    most = 0
    for entry in run.entries():
        if isinstance(entry, Polyline):
            assert entry.lines[0] == seen + 1
            seen = int(entry.lines[-1])
            most = max(most, len(entry.lines))
    assert seen == 200_002
    assert most <= 8192
    assert run.position[:3] == (200.0, 200_000 % 977 / 100, -(200_000 % 13) - 0.25)
