"""The dialect of files in the styles of many post-processors, and the sentence that reports it."""

from pathlib import Path

import pytest
from tests.cnc.programs import made
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.mill.config.dialects import choose, choose_for
from openacr.sysvar import Store

FOLDER = Path(__file__).parents[1] / "data" / "dialects"
NGC, ACR = "rs274ngc", "acromill"
OTHER = "(--dialect chooses another)"
STYLES = {
    "carbide_arcs": (
        f"dialect {NGC} by its features: I and J from the start of the arc in line 9 {OTHER}"
    ),
    "carbide_lines": ("dialect acromill: nothing in the file points to another one"),
    "estlcam_arcs": (
        f"dialect {NGC} by its features: post-processor Estlcam in line 2, I and J from the "
        f"start of the arc in line 10, end M30 in line 13 {OTHER}"
    ),
    "fanuc_call": (
        "dialect acromill by its features: G65 in line 4; features of rs274ngc: framed by % "
        "in line 1, end M30 in line 5 (--dialect rs274ngc)"
    ),
    "fanuc_hand": (
        f"dialect {NGC} by its features: framed by % in line 1, safety line with G17, G40 and "
        f"G80 in line 3, length G43 H in line 6, end M30 in line 11 {OTHER}"
    ),
    "fanuc_macro": (
        f"dialect {NGC} by its features: framed by % in line 1, expression in brackets in line "
        "4, M99 in line 9; features of acromill: statement in line 8 (--dialect acromill)"
    ),
    "freecad_grbl": (f"dialect {NGC} by its features: post-processor Freecad in line 1 {OTHER}"),
    "fusion_grbl": (
        f"dialect {NGC} by its features: G94 in line 5, post-processor Fusion in line 8, end "
        f"M30 in line 19 {OTHER}"
    ),
    "fusion_linuxcnc": (
        f"dialect {NGC} by its features: framed by % in line 1, G94 in line 4, G91.1 in line "
        f"4, length G43 H in line 14 {OTHER}"
    ),
    "guide_compensation": (f"dialect acromill by its features: G200 in line 2 {OTHER}"),
    "guide_cycle": (f"dialect acromill by its features: statement in line 7 {OTHER}"),
    "guide_dwell": (f"dialect acromill by its features: dwell G4 F in line 3 {OTHER}"),
    "guide_loop": (
        f"dialect acromill by its features: parameter P in line 3, statement in line 8 {OTHER}"
    ),
    "guide_tangent": (f"dialect acromill by its features: M595 in line 2, M596 in line 5 {OTHER}"),
    "gsender_circle": (
        "dialect acromill, as no feature decides; features of rs274ngc: end M30 in line 7; I and "
        "J of the whole circle in line 5 are read as positions (radius 150 about X-75 Y0); "
        "rs274ngc reads distances (radius 75 about X0 Y0) (--dialect rs274ngc)"
    ),
    "hsmworks_fanuc": (
        f"dialect {NGC} by its features: framed by % in line 1, G94 in line 5, safety line "
        f"with G17, G40 and G80 in line 5, length G43 H in line 14 {OTHER}"
    ),
    "kicad_flatcam": (
        f"dialect {NGC} by its features: post-processor Flatcam in line 1, G94 in line 5, "
        f"dwell G4 P in line 9 {OTHER}"
    ),
    "lines_only": ("dialect acromill: nothing in the file points to another one"),
    "lines_with_m30": (
        "dialect acromill, as no feature decides; features of rs274ngc: end M30 in line 5 "
        "(--dialect rs274ngc)"
    ),
    "linuxcnc_spline": (
        f"dialect {NGC} by its features: tolerance G64 P in line 2, G5 in line 4 {OTHER}"
    ),
    "mastercam_arcs": (
        f"dialect {NGC} by its features: framed by % in line 1, safety line with G17, G40 and "
        "G80 in line 5, length G43 H in line 8, I and J from the start of the arc in line 11 "
        f"{OTHER}"
    ),
    "pcb2gcode_mill": (
        f"dialect {NGC} by its features: post-processor Pcb2Gcode in line 2, G94 in line 4, "
        f"tolerance G64 P in line 8, dwell G4 P in line 11 {OTHER}"
    ),
    "sheetcam_mill": (
        f"dialect {NGC} by its features: post-processor Mach3 in line 2, I and J from the "
        f"start of the arc in line 15, end M30 in line 16 {OTHER}"
    ),
    "two_minds": (
        "dialect acromill by its features: G200 in line 2; features of rs274ngc: G94 in line "
        "1 (--dialect rs274ngc)"
    ),
    "vectric_inch": (
        f"dialect {NGC} by its features: post-processor Vectric in line 3, safety line with "
        "G17, G40 and G80 in line 6, G91.1 in line 7, G94 in line 13; features of acromill: "
        "G70 in line 7 (--dialect acromill)"
    ),
}


@pytest.mark.parametrize("name", STYLES)
def test_the_dialect_of_a_style_is_found_and_reported(name: str) -> None:
    choice = choose(FOLDER / f"{name}.nc", Store())
    assert choice.text == STYLES[name]
    assert choice.is_worth_reporting == (
        f"dialect {NGC}" in choice.text or "; features of " in choice.text
    )


def test_every_file_is_judged() -> None:
    assert {path.stem for path in FOLDER.glob("*.nc")} == set(STYLES)


RUNS = sorted(set(STYLES) - {"fanuc_call", "fanuc_macro", "two_minds", "vectric_inch"})


@pytest.mark.parametrize("name", RUNS)
def test_files_are_read_without_an_error_in_the_dialect_that_is_found(name: str) -> None:
    path = FOLDER / f"{name}.nc"
    done = made(path, {250_112: 3.0}, axes=4, dialect=choose(path, Store()).name)
    assert [str(each) for each in done.interpreter.program.errors] == []
    list(done.interpreter.entries())


def test_a_whole_circle_is_reported_where_nothing_else_is_of_another_dialect() -> None:
    circle = b"G0 X75 Y0\nG2 X75 Y0 I-75 J0\nM2\n"
    choice = choose_for(circle, Store())
    assert choice.is_worth_reporting
    assert choice.text.startswith("dialect acromill, as no feature decides; I and J of the whole")
    for known in (b"P200=4\n", b"G200 F2\n", b"G4 F1\n"):
        assert not choose_for(known + circle, Store()).is_worth_reporting
    assert not choose_for(circle, Store(), "acromill").is_worth_reporting


def test_units_of_mach_are_refused_by_the_codes_to_write() -> None:
    done = made(FOLDER / "vectric_inch.nc", dialect=NGC)
    (error,) = done.interpreter.program.errors
    assert str(error) == (
        "vectric_inch.nc:7:1: E203 unknown G code: G70"
        " (turning cycles are for lathes; inches are G20, millimetres G21)"
    )


@pytest.mark.parametrize("command", ["check", "time", "plot"])
def test_commands_report_an_ambiguous_choice(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("OPENACR_STORE", str(tmp_path / "sysvar.db"))
    file = FOLDER / "lines_with_m30.nc"
    words = ["mill", command, str(file)]
    if command == "plot":
        words.append(str(tmp_path / "a.svg"))
    result = CliRunner().invoke(app, words)
    assert f"{file}: {STYLES['lines_with_m30']}\n" in result.output
    chosen = CliRunner().invoke(app, [*words, "--dialect", ACR])
    assert "as no feature decides" not in chosen.output
