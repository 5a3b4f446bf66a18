"""`openacr sysvar` shows, changes, exports and imports the cells of the store."""

import json
from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from openacr.cli.main import app
from openacr.cli.sysvar.read import complete_name
from openacr.sysvar import Store


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["sysvar", *arguments], env={"COLUMNS": "100"})


@pytest.mark.req("MILL-P-100000-1003424")
def test_a_parameter_changed_by_its_name_is_readable_through_its_number(own_store: Path) -> None:
    result = run("set", "cut speed=12.5", "Block Skip=7", "p2001=-1.25", "machine type=MILL 2")
    assert result.exit_code == 0, result.output
    assert "P650002 Cut Speed = 12.5 in/min" in result.output
    with Store(own_store) as store:
        assert [store.read(n) for n in (650_002, 400_000, 2001)] == [12.5, 7, -1.25]
        assert store.read_text(250_119) == "MILL 2"
    assert "P650002 Cut Speed = 12.5 in/min" in run("get", "650002").output


def test_a_name_that_begins_with_a_dash_is_taken_as_it_is_written(own_store: Path) -> None:
    result = run("set", "-soft limit x=-1", "--unit", "inch")
    assert (result.exit_code, "P200001 -Soft Limit (axis 0) = -1 in" in result.output) == (0, True)
    with Store(own_store) as store:
        assert store.read(200_001) == -1.0
    assert "P200001 -Soft Limit (axis 0) = -1 in" in run("get", "-soft limit x").output
    wrong = run("set", "cut speed=3", "--unti", "mm")
    assert wrong.exit_code == 2
    assert "--unti" in wrong.output


def test_get_explains_one_parameter_and_tabulates_several() -> None:
    output = run("get", "P650002").output
    assert "P650002 Cut Speed = 10 in/min" in output
    assert (
        "default 10 in/min, typically 10; takes a number above 0 up to 1000000 [in/min]" in output
    )
    output = run("get", "jog feedrate", "P400000").output
    assert all(f"P35{axis}000" in output for axis in range(8))
    assert "-1 (disable)" in output


def test_get_explains_each_of_several_that_are_named_one_by_one() -> None:
    output = run("get", "cut speed", "P400000").output
    assert "P650002 Cut Speed = 10 in/min" in output
    assert output.count("; takes ") == 2


@pytest.mark.req("MILL-SYS-UNITSWITCH")
def test_lengths_are_shown_and_read_in_the_wanted_unit_and_kept_in_the_default_one(
    own_store: Path,
) -> None:
    run("set", "cut speed=300", "epsilon for compensation=0.0508", "--unit", "mm")
    with Store(own_store) as store:
        assert store.read(650_002) == pytest.approx(300 / 25.4)
        assert store.read(250_101) == pytest.approx(0.002)
    output = run("get", "P650002", "--unit", "mm").output
    assert "Cut Speed = 300 mm/min" in output
    assert "default 254 mm/min, typically 254; takes a number above 0 up to 254" in output
    assert "takes a number above 0 up to 25400000 [mm/min]" in output
    run("set", "jog feedrate a=360", "jog feedrate x=254", "--unit", "mm")
    with Store(own_store) as store:
        assert [store.read(n) for n in (353_000, 350_000)] == [360.0, 10.0]
    assert "Cut Speed = 11.811023622 in/min" in run("get", "P650002").output
    run("set", "default units=mm")
    assert "Cut Speed = 300 mm/min" in run("get", "P650002").output
    assert "Jog Feedrate (axis 3) = 360 deg/min" in run("get", "jog feedrate a").output


def test_json_holds_every_field() -> None:
    (record,) = json.loads(run("get", "axis 1 dac polarity", "--json").output)
    assert (record["number"], record["axis"], record["value"]) == (201_005, 1, 0.0)
    assert record["choices"] == {"0": "pos", "1": "neg"}
    (record,) = json.loads(run("get", "P250005", "--json", "--unit", "mm").output)
    assert (record["value"], record["unit"]) == (6.35, "mm")


def test_list_shows_what_was_changed_and_whole_tabs() -> None:
    assert "all parameters have their defaults" in run("list").output
    run("set", "trial speed=50", "P2007=1")
    output = run("list").output
    assert "Trial Speed" in output
    assert "H length 7" in output
    assert "Cut Speed" not in output
    assert "Cut Speed" in run("list", "speeds").output
    assert len(json.loads(run("list", "OFFSETS", "--json").output)) > 2000


def test_one_refused_value_stores_none_of_them(own_store: Path) -> None:
    result = run("set", "trial speed=50", "cut speed=-1")
    assert result.exit_code == 2
    assert "error: P650002 Cut Speed cannot be -1: a number above 0" in result.output
    with Store(own_store) as store:
        assert store.read(650_001) == 100.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["get", "flux"], "no parameter of the store is named 'flux'"),
        (["set", "jog feedrate=3"], "'jog feedrate' can be P350000"),
        (["set", "P650002"], "sets nothing (write NAME=VALUE"),
        (["set", "P5=1"], "P5 is not in the store: it is a variable of the card"),
        (["set", "P100004=abc"], "a password is set by `openacr sysvar password`"),
        (["get", "P650002", "--unit", "cm"], "unit 'cm' is neither inch nor mm"),
        (["list", "SPEDS"], "error: unknown tab SPEDS (did you mean SPEEDS?)\n"),
        (["list", "nowhere"], "unknown tab nowhere (one of GENERAL, SERVO"),
        (["import", "missing.toml"], "missing.toml: cannot be read"),
    ],
)
def test_slips_are_explained(arguments: list[str], words: str) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert words in result.output


def test_a_store_can_be_named(tmp_path: Path) -> None:
    other = tmp_path / "other" / "mill.db"
    run("set", "P150=4", "--store", str(other))
    assert "P150 Global 150 = 4" in run("get", "P150", "--store", str(other)).output
    assert "P150 Global 150 = 0" in run("get", "P150").output


def test_looking_makes_no_file(own_store: Path, tmp_path: Path) -> None:
    assert "Cut Speed = 10 in/min" in run("get", "cut speed").output
    assert "all parameters have their defaults" in run("list").output
    assert 'unit = "inch"' in run("export").output
    assert not own_store.exists()
    result = run("get", "cut speed", "--store", str(tmp_path / "slip.db"))
    assert result.exit_code == 2
    assert "slip.db does not exist" in result.output


def test_names_are_completed() -> None:
    assert complete_name("Max M") == ["Max Machine Speed"]
    assert "SPEEDS" in complete_name("sp")


# --- export and import ------------------------------------------------------------------


@pytest.mark.parametrize("is_metric", [False, True])
def test_an_export_gives_an_equal_store(is_metric: bool, tmp_path: Path) -> None:
    first, second = tmp_path / "a.db", tmp_path / "b.db"
    with Store(first, is_metric=is_metric) as store, store.transaction():
        for n in (2001, 650_002, 280, 952_010, 150_000, 201_000, 150, 700_000):
            store.write(n, 1.0)
        store.write(244, 1.0)
        for click in range(16):
            store.write(450_000 + click, 11 * click)
        store.write_text(960_003, 'Door "A" \\ süd')
    file = tmp_path / "settings.toml"
    assert run("export", str(file), "--store", str(first)).exit_code == 0
    result = run("import", str(file), "--store", str(second))
    assert result.exit_code == 0, result.output
    with Store(first) as one, Store(second) as two:
        for parameter in one.find("speeds") + one.find("axes") + one.find("fov"):
            assert two.value(parameter.number) == one.value(parameter.number)
        for n in (2001, 280, 952_010, 150_000, 150, 700_000, 960_003, 250_001):
            assert two.value(n) == one.value(n)
        assert two.read(244) == 0  # how a run stands is no setting


def test_an_import_into_a_store_of_another_unit_converts_lengths(
    own_store: Path, tmp_path: Path
) -> None:
    run("set", "P150=1")
    file = tmp_path / "m.toml"
    file.write_text(
        'unit = "mm"\n[SPEEDS]\n"Cut Speed" = 254\nP200006 = 1000\n'
        'P203000 = 90\nP250010 = 45\n"default graphics" = false\n'
    )
    assert run("import", str(file)).output.startswith("5 settings stored")
    with Store(own_store) as store:
        values = [store.read(n) for n in (650_002, 200_006, 203_000, 250_010, 250_002, 250_001)]
    assert values == [10.0, 25_400.0, 90.0, 45.0, 0.0, 0.0]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("P650002 = -1\n", "P650002 Cut Speed cannot be -1"),
        ("P650002 = [1]\n", "P650002 Cut Speed cannot be [1]"),
        ("P650002 = \n", "at line 1"),
        ("flux = 1\n", "no parameter of the store is named 'flux'"),
        ("layout = 2\n", "layout 2 is not supported"),
        ('unit = "cm"\n', "unit 'cm' is neither"),
        ("P200002 = false\n", "has to be above the -Soft Limit"),
    ],
)
def test_a_bad_import_changes_nothing(
    own_store: Path, tmp_path: Path, text: str, words: str
) -> None:
    file = tmp_path / "bad.toml"
    file.write_text(f"{text}P150 = 3\n" if "layout" not in text else text)
    result = run("import", str(file))
    assert result.exit_code == 2
    assert words in result.output
    with Store(own_store) as store:
        assert store.read(150) == 0.0


def test_an_export_can_hold_everything() -> None:
    text = run("export", "--all").output
    assert "P650002 = 10.0  # Cut Speed [in/min]" in text
    assert "P250003 = 2  # I/J Inversion = absolute" in text
    assert len(text.splitlines()) > 10_000


# --- password ---------------------------------------------------------------------------


@pytest.mark.req("MILL-SYS-PASSWORD-HASH")
def test_a_password_is_neither_stored_nor_shown_in_clear_text(own_store: Path) -> None:
    assert run("password", "--new", "s3cret!").exit_code == 0
    shown = run("get", "P100004").output + run("get", "P100004", "--json").output
    assert "= set" in shown
    assert "s3cret!" not in shown
    files = [each for each in own_store.parent.iterdir() if each.is_file()]
    assert not any(b"s3cret!" in each.read_bytes() for each in files)
    with Store(own_store) as store:
        assert store.read_text(100_004) not in run("export", "--all").output


def test_without_a_terminal_a_new_password_has_to_be_given() -> None:
    asked = run("password")
    assert asked.exit_code == 2
    assert asked.output == "error: no terminal to ask for the new password; give --new\n"


@pytest.mark.req("MILL-SYS-PASSWORD")
def test_system_parameters_are_changed_with_the_right_password_only(own_store: Path) -> None:
    assert run("set", "P650002=11").exit_code == 0  # none is asked yet
    run("password", "--new", "s3cret!")
    refused = run("set", "P650002=12")
    assert refused.exit_code == 2
    assert "protected: give --password, or OPENACR_PASSWORD" in refused.output
    assert "wrong service password" in run("set", "P650002=12", "--password", "secret").output
    with Store(own_store) as store:
        assert store.read(650_002) == 11.0
    assert run("set", "P2001=1").exit_code == 0  # offsets are the operator's
    assert run("set", "P650002=12", "--password", "s3cret!").exit_code == 0
    assert run("password", "--new", "").exit_code == 2
    assert run("password", "--new", "", "--password", "s3cret!").exit_code == 0
    assert run("set", "P650002=13").exit_code == 0


@pytest.mark.req("MILL-M-CUSTOM")
def test_the_folder_of_m_codes_of_the_user_is_chosen_by_the_service(own_store: Path) -> None:
    folder = own_store.parent / "own"
    folder.mkdir()
    (folder / "M300.TXT").write_text("G91 G1 X1 F10\nG90\nRET\n")
    part = own_store.parent / "P.NC"
    part.write_text("M300\nM2\n")

    def checked() -> Result:
        return CliRunner().invoke(app, ["mill", "check", str(part)])

    run("password", "--new", "s3cret!")
    assert run("set", "P900010=own").exit_code == 2
    assert "P.NC:1:1: E205 unknown M code: M300" in checked().output
    assert run("set", "P900010=own", "--password", "s3cret!").exit_code == 0
    assert "moves: 1 line," in checked().output
