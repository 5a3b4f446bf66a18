"""`openacr tune`: measure, propose, apply, undo."""

import json
import math
import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from tests.tuning.worlds import axis_text, elastic
from typer.testing import CliRunner

from openacr.cli import tune
from openacr.cli.main import app
from openacr.client import Card
from openacr.controller import Controller
from openacr.tuning.propose import Proposal

SET_UP = """PROG0
ATTACH MASTER0
ATTACH SLAVE0 AXIS0 "X"
PPU X800
MULT X4
PGAIN X0.006 DGAIN X0.00007
"""
ROWS = (12304, 12305, 12308, 12310)  # PGAIN IGAIN DGAIN FFVEL


@pytest.fixture
def project(tmp_path: Path) -> Path:
    (tmp_path / "machine.toml").write_text(axis_text(0))
    (tmp_path / "setup.8k").write_text(SET_UP)
    return tmp_path


@pytest.fixture
def card(project: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Card]:
    """The card that the commands reach at `mill:1`."""
    found = Card.open(Controller.from_project(project))

    @contextmanager
    def connected(target: str, baud: int, silence_s: float) -> Iterator[Card]:
        yield found

    monkeypatch.setattr(tune, "connected", connected)
    found.command("AXIS0 DRIVE ON")
    found.pause(0.2)
    monkeypatch.chdir(project)
    yield found
    found.close()


def called(*words: object, text: str = "") -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["tune", *map(str, words)], input=text)
    return result.exit_code, result.stdout, result.stderr


def test_gains_of_a_project_are_proposed_as_a_line_for_its_files(project: Path) -> None:
    picture = project / "axis0.svg"
    words = ("propose", project, 0, "--time", "0.6", "--bandwidth", "50")
    code, text, problems = called(*words, "--move", "10", "50", "500", "--plot", picture)
    assert (code, problems) == (0, "")
    lines = text.splitlines()
    assert lines[0] == "axis 0: 1800 samples at 2000 Hz, amplitude 100 pulses, 2 to 60 Hz"
    assert lines[3] == "resonance: none was found from 2 to 60 Hz"
    assert lines[4].startswith("sure: yes, ")
    rows = {line[:26].strip(): line[26:].split() for line in lines[5:-1]}
    assert rows[""] == ["present", "proposed"]
    assert rows["PGAIN"][0] == "0.006"
    assert rows["crossover [Hz]"][1] == "50.0"
    assert rows["phase margin [deg]"][1] == "55.0"
    present, proposed = map(float, rows["move: error [pulses]"])
    assert proposed < present / 4
    assert lines[-1].startswith(f"AXIS0 PGAIN {float(rows['PGAIN'][1]):.4g}"[:14])
    assert "coherence" in picture.read_text()


def test_recording_and_computing_are_shown_while_they_last(
    project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[str] = []

    @contextmanager
    def progress_bar(title: str) -> Iterator[Callable[[int, int], None]]:
        shown.append(title)
        yield lambda done, total: None
        shown.append("end")

    monkeypatch.setattr(tune, "progress_bar", progress_bar)
    code, _text, problems = called("measure", project, 0, "--time", "0.6")
    assert (code, problems) == (0, "")
    assert shown == ["recording", "end", "identifying the motor", "end"]


def test_a_measurement_is_also_one_json_object(project: Path) -> None:
    code, text, _problems = called("measure", project, 0, "--time", "0.6", "--json")
    found = json.loads(text)
    assert code == 0
    assert found["is_sure"] is True
    assert found["motor"]["accel_per_volt"] == pytest.approx(
        0.1542 / 3e-5 * 4000 / 6.28319, rel=0.02
    )
    lengths = {name: len(found[name]["time_s"]) for name in ("measured", "modelled")}
    assert lengths == {"measured": 1800, "modelled": 1800}
    assert set(found["bode"]) == {"measured", "frequency_hz", "motor", "present", "proposed"}
    assert found["present"]["gains"]["PGAIN"] == pytest.approx(0.006)


def test_a_step_reports_what_the_axis_did_and_leaves_its_gains(card: Card, project: Path) -> None:
    before = [card.read(row) for row in ROWS]
    code, _out, err = called("step", "mill:1", 0, "--time", "0.2")
    assert (code, "by 100 pulses and back, for 0.2 s: say --yes" in err) == (2, True)
    code, out, _err = called("step", "mill:1", 0, "--time", "0.2", "--plot", "step.png", "--yes")
    assert code == 0
    printed = {line[:26].strip(): line[26:].strip() for line in out.splitlines()[-3:]}
    code, out, _err = called("step", "mill:1", 0, "--time", "0.2", "--json", "--yes")
    found = json.loads(out)
    share = max(found["measured"]["actual_cnt"]) / 100.0
    overshoot = found["figures"]["overshoot_percent"]
    assert overshoot == pytest.approx(100.0 * max(0.0, share - 1.0), abs=1.0)
    assert float(printed["overshoot [%]"]) == pytest.approx(overshoot, abs=2.0)
    assert float(printed["rise [ms]"]) == pytest.approx(1000.0 * found["figures"]["rise_s"], abs=2)
    assert (project / "step.png").read_bytes()[:4] == b"\x89PNG"
    assert [card.read(row) for row in ROWS] == before


def test_gains_are_applied_when_confirmed_and_undone_from_the_file(card: Card) -> None:
    before = [card.read(row) for row in ROWS]
    words = ("mill:1", 0, "--time", "0.6", "--bandwidth", "40", "--yes")
    code, text, problems = called("apply", *words)
    assert (code, problems) == (0, "")
    assert text.splitlines()[-1] == (
        "set; the former gains are in gains.json: openacr tune undo mill:1 gains.json"
    )
    after = [card.read(row) for row in ROWS]
    assert after[0] > before[0] and after[3] > 0
    assert called("apply", *words) == (
        2, "", "error: gains.json exists: choose another file for the former gains (--keep)\n"
    )  # fmt: skip
    code, text, problems = called("undo", "mill:1", "gains.json")
    assert (code, problems) == (0, "")
    assert text.startswith("axis 0: PGAIN 0.006 IGAIN 0 ")
    assert [card.read(row) for row in ROWS] == before


def test_gains_that_the_card_takes_back_leave_no_file(
    card: Card, project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    bad = {"PGAIN": 0.2, "DGAIN": 0.0}
    monkeypatch.setattr(Proposal, "gains", property(lambda _proposal: bad))
    before = [card.read(row) for row in ROWS]
    code, text, problems = called("apply", "mill:1", 0, "--time", "0.6", "--yes")
    assert code == 2
    assert problems.endswith("; what was changed was taken back\n")
    assert "set;" not in text
    assert [card.read(row) for row in ROWS] == before
    assert not (project / "gains.json").exists()


def test_an_axis_of_a_card_moves_only_after_a_yes(card: Card) -> None:
    code, text, problems = called("measure", "mill:1", 0)
    assert (code, text) == (2, "")
    assert problems == (
        "error: axis 0 of mill:1 will move by 100 pulses to both sides, 2 to 60 Hz, for 1.5 s"
        " at most: say --yes\n"
    )
    assert card.read("axis0.jog offset") == 0


def test_a_loop_too_soft_to_move_is_said_and_nothing_is_proposed(card: Card) -> None:
    card.command("AXIS0 PGAIN 0")
    card.command("AXIS0 DGAIN 0")
    code, _text, problems = called("propose", "mill:1", 0, "--time", "0.6", "--yes")
    assert code == 2
    assert problems == (
        "error: the axis moved by 0 counts: at least 10 are needed (a larger amplitude, higher"
        " gains, or is its drive off?)\n"
    )


def test_a_resonance_is_reported_with_its_uncertainty_and_in_the_json(project: Path) -> None:
    (project / "machine.toml").write_text(elastic(190.0, 0.02, 0))
    words = ("measure", project, 0, "--band", "2", "400")
    code, text, _problems = called(*words, "--plot", project / "a.svg")
    assert code == 0
    assert "resonance 1" in (project / "a.svg").read_text()
    line = next(line for line in text.splitlines() if line.startswith("resonance: "))
    numbers = re.fullmatch(
        r"resonance: (\S+) Hz \(\+-0\.3\), antiresonance (\S+) Hz,"
        r" damping (\S+) \(\+-\S+\), load (\S+) of the motor",
        line,
    )
    assert numbers is not None
    assert [float(each) for each in numbers.groups()] == [
        pytest.approx(190.0, rel=0.01),
        pytest.approx(190.0 / math.sqrt(1.5), rel=0.02),
        pytest.approx(0.02, abs=0.006),
        pytest.approx(0.5, rel=0.06),
    ]
    whole = json.loads(called(*words, "--json")[1])
    found, bode = whole["resonance"], whole["bode"]
    assert found["resonance_hz"] == pytest.approx(190.0, rel=0.01)
    assert found["deviations"]["resonance_hz"] < 1.0
    size = dict(zip(bode["motor"]["magnitude_db"], bode["frequency_hz"], strict=True))
    beyond = {db: hz for db, hz in size.items() if hz > 170.0}
    assert beyond[max(beyond)] == pytest.approx(190.0, rel=0.01)  # the peak is drawn
    assert found["reason"] == ""


def test_an_axis_without_a_resonance_says_up_to_where_there_is_none(project: Path) -> None:
    words = ("measure", project, 0, "--band", "2", "145")
    found = json.loads(called(*words, "--json")[1])["resonance"]
    assert (found["resonance_hz"], found["searched_hz"]) == (None, [2.0, 145.0])


def test_gains_reach_no_further_than_the_band_and_the_report_says_so(project: Path) -> None:
    words = ("propose", project, 0, "--time", "0.8", "--band", "2", "25")
    code, text, _problems = called(*words)
    assert code == 0
    rows = {line[:26].strip(): line[26:].split() for line in text.splitlines()}
    assert 22.0 < float(rows["crossover [Hz]"][1]) < 25.0
    barred = next(line for line in text.splitlines() if line.startswith("faster is barred: "))
    assert re.search(r" Hz nothing was measured: the response is known up to 2\d(\.\d)? Hz", barred)
    code, text, problems = called(*words, "--bandwidth", "26")
    assert (code, "proposed" in text) == (1, False)
    assert problems.startswith("error: no gains are proposed: at 26 Hz nothing was measured")


def test_a_bandwidth_that_cannot_be_is_refused_after_the_judgement(card: Card) -> None:
    words = ("propose", "mill:1", 0, "--time", "0.6", "--yes", "--bandwidth", "390")
    code, text, problems = called(*words)
    assert code == 1
    assert "crossover [Hz]" in text and "proposed" not in text
    assert problems.startswith("error: no gains are proposed: at 390 Hz ")


@pytest.mark.parametrize(
    ("words", "problem"),
    [
        (("apply", ".", 0), ". is a project: put the lines that `propose` prints into its files"),
        (("undo", "mill:1", "none.json"), "none.json: No such file or directory"),
        (("undo", "mill:1", "setup.8k"), "setup.8k: not a file of `openacr tune apply`"),
        (("propose", ".", 0, "--plot", "a.html"), "a.html: pictures of tuning end in .png or .svg"),
        (("measure", ".", 0, "--amplitude", "4"), "amplitude [pulses] 4: from 5 to 100000"),
        (("measure", ".", 9), "axis 9: this card does not have it"),
    ],
)
def test_what_cannot_be_done_is_said_before_anything_moves(
    card: Card, words: tuple[object, ...], problem: str
) -> None:
    code, text, problems = called(*words)
    assert (code, text, problems) == (2, "", f"error: {problem}\n")


def test_a_sweep_is_as_long_as_a_program_has_room_for_and_worse_steps_are_said() -> None:
    gantry = Path(__file__).parents[2] / "examples" / "gantry"
    code, text, problems = called("propose", gantry, 0)
    assert (code, problems) == (0, "")
    lines = text.splitlines()
    assert lines[1] == "  a sweep of 0.55 s: no empty program has room for 1.5 s"
    hint = "(--phase, --bandwidth ask for calmer ones)"
    assert [line for line in lines if line.startswith("worse")] == [
        f"worse than the present gains: overshoot [%] of a step 22.0 instead of 19.0 {hint}",
        f"worse than the present gains: settling [ms] of a step 23.5 instead of 18.5 {hint}",
    ]
    code, text, problems = called("measure", gantry, 0, "--time", "1.5")
    assert (code, "less time (0.55 s fit), or DIM PROG" in problems) == (2, True)


def test_an_axis_is_named_by_its_number_or_as_programs_call_it(project: Path) -> None:
    code, text, _ = called("step", project, "x", "--json")
    assert (code, json.loads(text)["axis"]) == (0, 0)
    code, text, problems = called("step", project, "Y")
    assert (code, problems) == (2, "error: AXIS Y: give a number from 0 to 15 or X\n")
    assert called("step", project, "16")[2] == "error: AXIS 16: give a number from 0 to 15 or X\n"
