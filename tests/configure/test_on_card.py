"""Configuration code on a card: it loads without an error and does what it says."""

from pathlib import Path

import pytest

from openacr.configure import code_files, parse_answers
from openacr.configure.answers import warnings
from openacr.controller import Controller

EXAMPLE = Path(__file__).parents[2] / "examples" / "gantry"
AXES = 16


def sixteen() -> str:
    """Sixteen axes with two limit switches each, open contacts, for older firmware."""
    axes = [
        f"[[axis]]\nnumber = {n}\nname = 'A{chr(65 + n)}'\nunits_per_rev = 1\n"
        f"counts_per_rev = 4000\nlimits = {{ first_input = {2 * n}, soft = [10, -10],"
        " soft_is_enabled = true, contacts_are_closed = false }\n"
        for n in range(AXES)
    ]
    names = ", ".join(f"'A{chr(65 + n)}'" for n in range(AXES))
    head = '[card]\nmodel = "ACR8020"\nfirmware = "1.18.06"\n'
    return head + "".join(axes) + f"[[master]]\nnumber = 0\naxes = [{names}]\n"


def loaded(folder: Path, text: str) -> Controller:
    """A card with the configuration of some answers; refused lines raise."""
    files = code_files(parse_answers(text), text)
    for name, code in files.items():
        (folder / name).write_text(code)
    return Controller.from_project(folder)


@pytest.fixture
def card(tmp_path: Path) -> Controller:
    """The sixteen axes, enabled."""
    (tmp_path / "machine.toml").write_text('[card]\nmodel = "ACR8020"\n')
    card = loaded(tmp_path, sixteen())
    card.send("ECHO 4\rPROG0\rDRIVE ON " + " ".join(f"A{chr(65 + n)}" for n in range(AXES)) + "\r")
    card.advance(seconds=0.5)
    return card


def only(card: Controller, first: int) -> list[int]:
    """The axes whose flag of a family is set; time passes for the generated programs."""
    card.advance(seconds=0.5)
    return [axis for axis in range(AXES) if card.bit[first + axis]]


@pytest.mark.req("ACR-TUT-01", "ACR-WIZ-19")
def test_the_sample_project_is_set_up_without_warnings(tmp_path: Path) -> None:
    answers = parse_answers((EXAMPLE / "configure.toml").read_text())
    assert list(warnings(answers)) == []
    card = loaded(tmp_path, (EXAMPLE / "configure.toml").read_text())
    card.send("ECHO 6\r")
    shown = [card.send(f"AXIS{n}\r").strip() for n in range(8)]
    assert shown == ["ON"] * 3 + ["OFF"] * 5
    attached = card.send("ATTACH\r").splitlines()
    assert attached[:3] == [f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}" for n in range(3)]
    reports = {
        "PROG0": {"PGAIN X": "0.002441", "TLM X": "10,-10", "EXC X": "0.2,-0.2", "SLM X": "24,0",
                  "HLDEC X": "500", "DAC0 GAIN": "3276.8", "ENC0 MULT": "4", "ACC": "10",
                  "VEL": "5"},
        "PROG1": {"PPU Z": "40000", "SLM Z": "6,0", "ACC": "20", "STP": "20", "VEL": "10"},
    }  # fmt: skip
    for level, wanted in reports.items():
        card.send(f"{level}\r")
        assert {query: card.send(f"{query}\r").strip() for query in wanted} == wanted


@pytest.mark.req("ACR-TUT-02")
def test_leadscrew_limits_and_inputs_are_as_entered(tmp_path: Path) -> None:
    text = (EXAMPLE / "configure.toml").read_text()
    off = ", soft_is_enabled = false }"
    for soft, first in (("[24, 0]", 2), ("[6, 0]", 4)):
        assert soft + off in text
        text = text.replace(soft + off, f"{soft}, first_input = {first} }}")
    card = loaded(tmp_path, text)
    card.send("ECHO 6\rPROG0\r")
    asked = ("PPU X", "EXC X", "HLBIT X", "HLBIT Y", "SLM X", "SLM Y", "SLIM Y")
    assert [card.send(f"{line}\r").strip() for line in asked] == [
        *("40000", "0.2,-0.2", "0", "2", "24,0", "24,0", "3"),
    ]  # fmt: skip
    card.send("PROG1\r")
    assert [card.send(f"{line} Z\r").strip() for line in ("SLM", "HLBIT")] == ["6,0", "4"]
    for axis in range(3):  # closed contacts: an input that is off is an active limit
        for side in (0, 1):
            card.bit[2 * axis + side] = True
            card.advance(seconds=0.1)
            assert not card.bit[16128 + 32 * axis + side]
            card.bit[2 * axis + side] = False
            card.advance(seconds=0.1)
            assert card.bit[16128 + 32 * axis + side]


@pytest.mark.req("ACR-WIZ-FLAG-1984", "ACR-WIZ-FLAG-1992", "ACR-WIZ-FLAG-1968", "ACR-WIZ-FLAG-1976")
def test_enabled_and_disabled_drives_are_shown(card: Controller) -> None:
    assert only(card, 1984) == list(range(AXES))
    assert only(card, 1968) == []
    off: list[int] = []
    for name, axis in (("AB", 1), ("AA", 0), ("AH", 7), ("AI", 8), ("AP", 15)):
        card.send(f"DRIVE OFF {name}\r")
        off = sorted([*off, axis])
        assert only(card, 1968) == off
        assert only(card, 1984) == [n for n in range(AXES) if n not in off]


@pytest.mark.req("ACR-WIZ-FLAG-1952", "ACR-WIZ-FLAG-1960")
def test_faulted_drives_are_shown(card: Controller) -> None:
    assert only(card, 1952) == []
    flags = {axis: 8477 + 32 * axis for axis in (0, 7, 8, 15)}  # Latched Drive Fault
    for axis, flag in flags.items():
        card.send(f"SET {flag}\r")
        assert only(card, 1952) == [axis]
        card.send(f"CLR {flag}\r")
        assert only(card, 1952) == []


@pytest.mark.req("ACR-WIZ-FLAG-2000", "ACR-WIZ-FLAG-2008")
def test_an_axis_beyond_its_software_limits_is_stopped_once(card: Controller) -> None:
    assert only(card, 2000) == []
    hit = {"AA": (0, -1), "AC": (2, 1), "AH": (7, 1), "AI": (8, 1), "AL": (11, -1), "AP": (15, 1)}
    card.send("RES" + "".join(f" {name}{10.5 * side}" for name, (_, side) in hit.items()) + "\r")
    axes = [axis for axis, _ in hit.values()]
    assert only(card, 2000) == axes
    assert all(card.bit[8467 + 32 * axis] for axis in axes)
    card.send("".join(f"CLR {8467 + 32 * n}\r" for n in range(AXES)) + "CLR 522\r")
    card.advance(seconds=0.5)
    assert not any(card.bit[8467 + 32 * axis] for axis in axes)  # free to go back
    card.send("RES" + "".join(f" {name}9" for name in hit) + "\r")
    assert only(card, 2000) == []


@pytest.mark.req("ACR-WIZ-FLAG-2016", "ACR-WIZ-FLAG-2024", "ACR-WIZ-FLAG-2032", "ACR-WIZ-FLAG-2040")
@pytest.mark.parametrize(("family", "side"), [(2016, 0), (2032, 1)])
def test_limit_switches_are_latched_until_they_are_left_and_acknowledged(
    card: Controller, family: int, side: int
) -> None:
    assert only(card, family) == []
    hit = [0, 3, 7, 8, 12, 15]
    for axis in hit:
        card.bit[2 * axis + side] = True
    assert only(card, family) == hit
    card.bit[16132 + side + 32 * 12] = True  # encountered
    for axis in hit:
        card.bit[2 * axis + side] = False
    assert only(card, family) == [12]
    card.bit[16132 + side + 32 * 12] = False
    assert only(card, family) == []


@pytest.mark.parametrize(("axis", "name"), [(2, "AC"), (11, "AL")])
def test_an_enabled_axis_outside_its_error_band_is_stopped(
    card: Controller, axis: int, name: str
) -> None:
    kill = 8467 + 32 * axis
    card.send(f"CLR {8469 + 32 * axis}\r")  # the card itself does not respond
    card.send(f"TLM {name}0\rEXC {name}0.5\rJOG VEL {name}1\rJOG INC {name}0.4\r")
    card.advance(seconds=1)
    assert not card.bit[kill]
    card.send(f"JOG INC {name}0.4\r")
    assert card.until(kill, timeout_s=1.0)
