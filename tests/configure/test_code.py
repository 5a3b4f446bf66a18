"""The configuration code made of the answers for the gantry, line by line."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.configure import code_files, parse_answers
from openacr.configure.answers import Answers, warnings
from openacr.configure.watch_code import kept_answers
from openacr.controller import Controller
from openacr.errors import SourceError

EXAMPLE = Path(__file__).parents[2] / "examples" / "gantry"
TEXT = (EXAMPLE / "configure.toml").read_text()


@pytest.fixture(scope="module")
def answers() -> Answers:
    return parse_answers((EXAMPLE / "configure.toml").read_text())


@pytest.fixture(scope="module")
def setup(answers: Answers) -> list[str]:
    return code_files(answers, TEXT)["setup.8k"].splitlines()


def statements(lines: list[str]) -> list[str]:
    return [line for line in lines if line and not line.startswith("REM")]


def part(setup: list[str], first: str, last: str) -> list[str]:
    """The statements from one line to another."""
    code = statements(setup)
    return code[code.index(first) : code.index(last) + 1]


def old(text: str = TEXT) -> Answers:
    """The answers for firmware that does not watch limits."""
    return parse_answers(text.replace("[card]", '[card]\nfirmware = "1.18.06"'))


@pytest.mark.req("ACR-WIZ-01")
def test_the_code_is_shown_before_anything_is_downloaded() -> None:
    shown = CliRunner().invoke(app, ["configure", str(EXAMPLE / "configure.toml")])
    assert shown.exit_code == 0
    assert "==> setup.8k <==\nSYS\nHALT ALL\n" in shown.output
    assert "AXIS2 SLM (6,0)\n" in shown.output


def test_it_is_the_code_of_the_example(setup: list[str]) -> None:
    assert statements(setup) == statements((EXAMPLE / "setup.8k").read_text().splitlines())


@pytest.mark.req("ACR-WIZ-02")
def test_it_starts_from_nothing(setup: list[str]) -> None:
    assert setup[:5] == ["SYS", "HALT ALL", "NEW ALL", "CLEAR", "DETACH ALL"]


@pytest.mark.req("ACR-WIZ-03")
def test_memory_is_shared_out(setup: list[str]) -> None:
    assert part(setup, "DIM PROG0(8192)", "DIM DEF(20)") == [
        "DIM PROG0(8192)",
        "DIM PROG1(4096)",
        *(f"DIM PROG{program}(1000)" for program in range(2, 15)),
        "DIM PROG15(28672)",
        "DIM P(100)",
        "DIM DEF(20)",
    ]


@pytest.mark.req("ACR-WIZ-04")
def test_a_comment_says_whose_parameters_are_whose(setup: list[str]) -> None:
    assert "REM P0-P99 and P201-P4095 are free for user programs" in setup
    assert "REM P100-P200 are used by generated code" in setup


@pytest.mark.req("ACR-WIZ-05")
def test_hardware_is_set_up_even_without_canopen_nodes(setup: list[str]) -> None:
    assert part(setup, "ADC MODE 1", "P32770=0") == [
        "ADC MODE 1", "P32768=5", "P32769=125", "P32772=50", "P32770=0",
    ]  # fmt: skip


@pytest.mark.req("ACR-WIZ-06")
def test_a_minimal_configuration_leaves_hardware_out(setup: list[str]) -> None:
    short = parse_answers(TEXT.replace("[card]", "[card]\nminimal = true"))
    code = statements(code_files(short, TEXT)["setup.8k"].splitlines())
    left_out = {"ADC MODE 1", "P32768=5", "P32769=125", "P32772=50", "P32770=0"}
    assert code == [line for line in statements(setup) if line not in left_out]


@pytest.mark.req(
    *("ACR-WIZ-07", "ACR-WIZ-08", "ACR-WIZ-09", "ACR-WIZ-10", "ACR-WIZ-11", "ACR-WIZ-12"),
    *("ACR-WIZ-13", "ACR-WIZ-14", "ACR-WIZ-15"),
)
@pytest.mark.parametrize(
    ("n", "decel", "travel"), [(0, 500, "24,0"), (1, 100, "24,0"), (2, 100, "6,0")]
)
def test_an_axis_is_set_up_in_one_piece(setup: list[str], n: int, decel: int, travel: str) -> None:
    assert part(setup, f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}", f"AXIS{n} ON") == [
        f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}",
        f"AXIS{n} PPU 39999.999404",
        f"AXIS{n} EXC (0.2,-0.2)",
        f"SET BIT{8468 + 32 * n}",
        f"CLR BIT{8464 + 32 * n}",
        f"CLR BIT{8470 + 32 * n}",
        f"SET BIT{8469 + 32 * n}",
        f"CLR BIT{8453 + 32 * n}",
        f"CLR BIT{8471 + 32 * n}",
        f"ENC{n} SRC 0",
        f"ENC{n} MULT 4",
        f"AXIS{n} PGAIN 0.002441",
        f"AXIS{n} IGAIN 0",
        f"AXIS{n} ILIMIT 0",
        f"AXIS{n} IDELAY 0",
        f"AXIS{n} DGAIN 1e-005",
        f"AXIS{n} DWIDTH 0",
        f"AXIS{n} FFVEL 0",
        f"AXIS{n} FFACC 0",
        f"AXIS{n} TLM 10",
        f"AXIS{n} FBVEL 0",
        *([f"AXIS{n} HLBIT {3 * n}"] if n else []),
        f"AXIS{n} HLDEC {decel}",
        *(f"SET BIT{flag + 32 * n}" for flag in (16144, 16145, 16148, 16149)),
        f"AXIS{n} SLM ({travel})",
        f"AXIS{n} SLDEC {decel}",
        *(f"CLR BIT{flag + 32 * n}" for flag in (16150, 16151)),
        f"DAC{n} GAIN 3276.8",
        f"AXIS{n} ON",
    ]


@pytest.mark.req("ACR-WIZ-16")
def test_axes_that_are_not_there_are_off(setup: list[str]) -> None:
    assert [line for line in setup if line.endswith(" OFF")] == [
        f"AXIS{number} OFF" for number in range(3, 8)
    ]


@pytest.mark.req("ACR-WIZ-17", "ACR-WIZ-18")
def test_masters_come_last_each_in_its_program(setup: list[str]) -> None:
    code = statements(setup)
    assert code[code.index("PROG0") :] == [
        *("PROG0", "DETACH", "ATTACH MASTER0"),
        *('ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"'),
        *("ACC 10", "DEC 10", "STP 10", "VEL 5", "JRK 0"),
        *("PROG1", "DETACH", "ATTACH MASTER1", 'ATTACH SLAVE0 AXIS2 "Z"'),
        *("ACC 20", "DEC 20", "STP 20", "VEL 10", "JRK 0"),
    ]


@pytest.mark.req("ACR-WIZ-20")
def test_jogging_and_homing_leave_no_code(answers: Answers) -> None:
    for chosen in (answers, old()):
        for code in code_files(chosen, TEXT).values():
            assert not any("JOG" in line or "HOME" in line for line in code.splitlines())


@pytest.mark.req("ACR-WIZ-21")
def test_all_settings_are_in_one_file_and_program_15_keeps_the_answers(answers: Answers) -> None:
    files = code_files(answers, TEXT)
    assert list(files) == ["setup.8k", "prog15.8k"]
    assert not statements(files["prog15.8k"].splitlines()[1:-1])
    assert parse_answers(kept_answers(files["prog15.8k"].splitlines())) == answers


@pytest.mark.req("ACR-WIZ-22", "ACR-TUT-04")
def test_older_firmware_gets_limit_code_in_program_7_and_plc_5() -> None:
    files = code_files(old(), TEXT)
    assert list(files) == ["setup.8k", "plc5.8k", "prog7.8k"]
    assert "30 OR 2016\n40 OUT 2016\n" in files["plc5.8k"]
    assert "IF ((BIT769=0) AND (BIT1984)) THEN SET 8467\n" in files["prog7.8k"]
    kept = parse_answers(kept_answers(files["prog7.8k"].splitlines()))
    assert kept == parse_answers(TEXT)


@pytest.mark.req("ACR-WIZ-22")
def test_limit_code_of_many_axes_spills_over_and_master_7_goes_to_program_8() -> None:
    axes = [
        f"[[axis]]\nnumber = {n}\nname = 'A{chr(65 + n)}'\nunits_per_rev = 1\n"
        f"counts_per_rev = 4000\nlimits = {{ first_input = {2 * n} }}\n"
        for n in range(16)
    ]
    masters = [f"[[master]]\nnumber = {n}\naxes = ['A{chr(65 + n)}']\n" for n in range(8)]
    text = '[card]\nmodel = "ACR8020"\n' + "".join(axes + masters)
    files = code_files(old(text), text)
    assert list(files) == ["setup.8k", "plc5.8k", "plc6.8k", "plc7.8k", "prog7.8k"]
    assert "PROG8\nDETACH\nATTACH MASTER7\n" in files["setup.8k"]
    newer = code_files(parse_answers(text), text)
    assert "PROG7\nDETACH\nATTACH MASTER7\n" in newer["setup.8k"]


@pytest.mark.req("ACR-WIZ-23")
def test_software_limits_are_in_p100_to_p131_for_older_firmware() -> None:
    code = statements(code_files(old(), TEXT)["setup.8k"].splitlines())
    values = [line for line in code if line[:3] in ("P10", "P11")]
    assert values == ["P100=24", "P116=0", "P101=24", "P117=0", "P102=6", "P118=0"]
    assert "DIM P(201)" in code


def test_what_is_hardly_meant_is_said() -> None:
    lonely = parse_answers(TEXT.replace('axes = ["X", "Y"]', 'axes = ["X"]'))
    assert list(warnings(lonely)) == ["axis Y has no master: it can jog, but takes part in no move"]
    crowded = parse_answers(TEXT.replace("[6, 0]", "[6, 0], first_input = 4"))
    assert list(warnings(crowded)) == ["input 4 is a limit of both Y and Z"]


@pytest.mark.parametrize(
    ("before", "after", "said"),
    [
        ("number = 1\nname", "number = 0\nname", "16:1: axis 0 is there twice"),
        ("number = 2", "number = 8", "24:1: axis 8 is not on an ACR9000"),
        ('name = "Y"', 'name = "x"', "17:1: the name x is there twice"),
        ('name = "Y"', 'name = "P"', "17:1: the name P is no axis"),
        ("[6, 0]", "[0, 6]", "the positive limit is not above the negative"),
        ('axes = ["Z"]', 'axes = ["W"]', "W is no axis of this file"),
        ('axes = ["Z"]', 'axes = ["X"]', "X has two masters"),
        ("number = 1\naxes", "number = 0\naxes", "master 0 cannot be had (again)"),
        ("vel = 5", "vel = -5", "vel: expected `float` >= 0.0"),
        ("vel = 5", "velocity = 5", "unknown key 'velocity'"),
        ("vel = 5", "vel = nan", "numbers have to be finite"),
        ('name = "Y"\n', "", "'name' is missing"),
        ("[card]", "[card", "configure.toml:3:"),
    ],
)
def test_what_is_wrong_is_said_with_its_place(before: str, after: str, said: str) -> None:
    assert before in TEXT
    with pytest.raises(SourceError) as error:
        parse_answers(TEXT.replace(before, after))
    assert said in str(error.value)


def test_files_are_written_once_and_read_back_from_the_card(tmp_path: Path) -> None:
    runner, source = CliRunner(), str(EXAMPLE / "configure.toml")
    assert runner.invoke(app, ["configure", source, str(tmp_path)]).exit_code == 0
    again = runner.invoke(app, ["configure", source, str(tmp_path)])
    assert again.exit_code == 2
    assert "exists; --force replaces it" in again.output
    kept = str(tmp_path / "prog15.8k")
    other = tmp_path / "other"
    assert runner.invoke(app, ["configure", kept, str(other)]).exit_code == 0
    assert (other / "setup.8k").read_text() == (tmp_path / "setup.8k").read_text()
    no_folder = tmp_path / "setup.8k" / "in"
    refused = runner.invoke(app, ["configure", source, str(no_folder)])
    assert refused.exit_code == 2
    assert f"{no_folder}: cannot be written: not a directory" in refused.output


def test_every_line_can_carry_a_remark_that_explains_it(answers: Answers, setup: list[str]) -> None:
    lines = code_files(answers, TEXT, is_explained=True)["setup.8k"].splitlines()
    assert [line.partition(" : REM ")[0] for line in lines] == setup
    meanings = dict(line.split(" : REM ") for line in lines if " : REM " in line)
    assert set(meanings) == set(statements(setup))
    assert meanings["AXIS0 PPU 39999.999404"] == "Set the pulses per unit"
    assert meanings["SET BIT16148"] == (
        "Positive Hardware Limit Enable on: The switch stops the axis (HLIM)"
    )
    assert meanings["CLR BIT16150"] == (
        "Positive Software Limit Enable off: SLM stops the axis (SLIM)"
    )
    assert meanings["P32768=5"] == "Master Node ID: Node number of the controller, 1 to 127"
    assert meanings["VEL 10"] == "Set the speed of moves"


def test_explained_code_is_written_to_a_folder(tmp_path: Path) -> None:
    words = ["configure", "--explain", str(EXAMPLE / "configure.toml"), str(tmp_path)]
    assert CliRunner().invoke(app, words).exit_code == 0
    assert "\nVEL 10 : REM Set the speed of moves\n" in (tmp_path / "setup.8k").read_text()


def test_plcs_of_the_user_get_memory_before_those_that_watch_limits() -> None:
    def dimensions(count: int, firmware: str) -> list[str]:
        text = TEXT.replace("[card]", f'[card]\nplcs = {count}\nfirmware = "{firmware}"')
        code = code_files(parse_answers(text), text)["setup.8k"].splitlines()
        return [line for line in code if line.startswith("DIM PLC")]

    assert dimensions(0, "1.18.15") == []
    assert dimensions(2, "1.18.15") == ["DIM PLC0(4096)", "DIM PLC1(4096)"]
    old = [f"DIM PLC{number}(4096)" for number in (5, 6, 7)]
    assert dimensions(0, "1.18.06") == old[: len(dimensions(0, "1.18.06"))] != []
    assert dimensions(5, "1.18.06")[:5] == [f"DIM PLC{number}(4096)" for number in range(5)]
    assert dimensions(5, "1.18.06")[5:] == dimensions(0, "1.18.06")


def test_moves_to_buffer_get_memory_from_the_program_that_sends_them() -> None:
    text = TEXT.replace("[card]", "[card]\nmoves = 200")
    code = code_files(parse_answers(text), text)["setup.8k"].splitlines()
    assert [line for line in code if line.startswith("DIM PROG0")] == ["DIM PROG0(35392)"]
    card = Controller()
    card.send("SYS\rDIM PROG0(35392)\rPROG0\rATTACH MASTER0\r")
    assert "DIM MBUF(200)" in card.send("DIM MBUF(200)\rDIM\r")
    with pytest.raises(SourceError, match="moves: expected `int` <= 1000"):
        parse_answers(TEXT.replace("[card]", "[card]\nmoves = 1001"))


def test_more_plcs_than_limit_code_leaves_are_refused() -> None:
    with pytest.raises(SourceError, match="plcs: expected `int` <= 5"):
        parse_answers(TEXT.replace("[card]", "[card]\nplcs = 6"))
