"""The rs274ngc dialect: the unit it starts in, and cycles in incremental distances."""

import pytest
from tests.cnc.programs import Run, errors, run

DEFAULT_UNIT, POWER_UP_UNIT, IS_START_CHOSEN, START_UNIT = 250_001, 850_030, 100_010, 100_014


def ngc(text: str, cells: dict[int, float] | None = None, **more: object) -> Run:
    return run(text.replace("|", "\n"), cells, dialect="rs274ngc", **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("cells", "moves"),
    [
        ({DEFAULT_UNIT: 0}, ["L X3", "L Y2 Z1", "L X3 Y2 Z1"]),
        ({DEFAULT_UNIT: 1}, ["L X3", "L Y2 Z1", "L X3 Y2 Z1"]),
        ({DEFAULT_UNIT: 1, POWER_UP_UNIT: 20}, ["L X3", "L Y2 Z1", "L X3 Y2 Z1"]),
        ({DEFAULT_UNIT: 0, POWER_UP_UNIT: 21}, ["L X3", "L Y2 Z1", "L X3 Y2 Z1"]),
        ({DEFAULT_UNIT: 1, IS_START_CHOSEN: 1, START_UNIT: 20}, ["L X3", "L Y2 Z1", "L X3 Y2 Z1"]),
    ],
)
def test_words_before_g20_and_g21_are_in_the_unit_of_the_machine(
    cells: dict[int, float], moves: list[str]
) -> None:
    assert ngc("G1 F30 X3|X0 Y2 Z1|X3", cells).moves == moves


@pytest.mark.parametrize(
    ("unit", "text", "x"),
    [(1, "G20", 25.4), (1, "G21", 1.0), (0, "G21", 1 / 25.4), (0, "G20", 1.0)],
)
def test_g20_and_g21_say_otherwise(unit: float, text: str, x: float) -> None:
    (end,) = ngc(f"{text}|G1 F30 X1", {DEFAULT_UNIT: unit}).ends
    assert end[0] == pytest.approx(x, abs=1e-9)


def test_the_feed_of_a_program_without_a_unit_is_millimetres_on_a_metric_machine() -> None:
    (line,) = ngc("G1 F30 X3", {DEFAULT_UNIT: 1}).entries[:1]
    assert line.pace.feed_upm == 30.0  # type: ignore[union-attr]


# Z of every move; the levels are Z0 + R and R + Z (RS274/NGC, G91: R counts from the level
# the series of cycles began at, Z from R).
@pytest.mark.parametrize(
    ("text", "z"),
    [
        ("G0 Z2|G91 G81 Z-5 R1", [2, 3, -2, 3]),
        ("G0 Z2|G91 G99 G81 Z-5 R1", [2, 3, -2, 3]),
        ("G0 Z2|G91 G81 X1 Z-5 R1|X1|X1", [2, 3, 3, -2, 3, 3, -2, 3, 3, -2, 3]),
        ("G0 Z2|G91 G81 X1 Z-5 R1|G81 X1|G81 X1 Z-4", [2, 3, 3, -2, 3, 3, -2, 3, 3, -1, 3]),
        ("G0 Z2|G91 G81 X1 Z-5 R1 L3", [2, 3, 3, -2, 3, 3, -2, 3, 3, -2, 3]),
        ("G0 Z2|G91 G81 X1 Z-5 R1|G81 X1 R2", [2, 3, 3, -2, 3, 4, 4, -1, 4]),
        ("G0 Z2|G91 G81 X1 Z-5 R1|G82 X1 P1", [2, 3, 3, -2, 3, 3, -2, 3]),
        # another motion in between begins another series
        ("G0 Z2|G91 G81 X1 Z-5 R1|G0 X1|G81 X1 Z-5 R1", [2, 3, 3, -2, 3, 3, 4, 4, -1, 4]),
        ("G0 Z2|G91 G81 X1 Z-5 R1|G80|G81 X1 Z-5 R1", [2, 3, 3, -2, 3, 4, 4, -1, 4]),
        # R below the start: nothing to rise to, G98 returns to the start, G99 to R
        ("G0 Z2|G91 G81 X1 Z-5 R-1|X1", [2, 2, 1, -4, 2, 2, 1, -4, 2]),
        ("G0 Z2|G91 G99 G81 X1 Z-5 R-1|X1", [2, 2, 1, -4, 1, 1, -4, 1]),
        ("G0 Z2|G91 G81 X1 Z-5 R0|X1", [2, 2, -3, 2, 2, -3, 2]),
        # absolute levels do not count from anything
        ("G0 Z2|G81 X1 Z-5 R3|X2", [2, 3, 3, -5, 3, 3, -5, 3]),
        ("G0 Z2|G99 G81 X1 Z-5 R1|G98 G81 X2", [2, 2, 1, -5, 1, 1, -5, 2]),
        # tapping and boring return through the same levels
        ("G0 Z2|G91 G85 X1 Z-5 R1", [2, 3, 3, -2, 3]),
        ("G0 Z2|G91 G83 X1 Z-5 R1 Q3", [2, 3, 3, 0, 3, 0.01, -2, 3]),
    ],
)
def test_incremental_cycles_count_r_from_the_level_they_began_at(text: str, z: list[float]) -> None:
    assert [end[2] for end in ngc(f"F10|{text}").ends] == z


@pytest.mark.parametrize("dialect", ["acromill", "rs274ngc"])
@pytest.mark.parametrize(
    ("text", "moves"),
    [
        ("G0 G17 G40 G49 G80 G90|X1", ["R X1"]),
        ("G80 G0 Z1|X2", ["R Z1", "R X2 Z1"]),
        ("G0 G80 Z1", ["R Z1"]),
        ("F3 G80 G1 X1|Y1", ["L X1", "L X1 Y1"]),
        ("F3 G80 G2 X2 R1", ["A X2 about 1,0 -180"]),
        ("G90 G80 G40 G0 X1 Y1", ["R X1 Y1"]),
    ],
)
def test_g80_goes_with_the_motion_of_its_block(dialect: str, text: str, moves: list[str]) -> None:
    assert run(text.replace("|", "\n"), dialect=dialect).moves == moves


@pytest.mark.parametrize("text", ["G80 G0 Z2", "G0 G80 Z2"])
def test_g80_beside_a_motion_ends_the_cycle_before_it_moves(text: str) -> None:
    moves = ngc(f"F10 G0 Z1|G81 X1 Z-1 R.5|{text}|X3").ends
    assert moves[-2:] == [(1, 0, 2), (3, 0, 2)]


def test_g80_alone_still_leaves_no_motion() -> None:
    assert errors("G0 X1\nG80\nX2", dialect="rs274ngc") == ["E206"]
    assert errors("G0 X1\nG80 X2", dialect="rs274ngc") == ["E206"]
    assert errors("G80 G80", dialect="rs274ngc") == ["E201"]
    assert errors("G0 G1 X2", dialect="rs274ngc") == ["E201"]
