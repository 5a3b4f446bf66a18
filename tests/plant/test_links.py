"""What each axis of a machine moves in the drawing, and what carries it."""

from math import pi
from pathlib import Path

import pytest

from openacr.errors import SourceError
from openacr.plant.describe.body_schema import Body
from openacr.plant.describe.links import Link, Subject, links_of, subject_of
from openacr.plant.describe.load import load_world, parse_world

DRIVE = 'drive = { mode = "exact" }\ncounts_per_rev = 4000\n'


def links(*axes: tuple[str, str]) -> dict[str, Link]:
    """Links of axes with these names and units."""
    found = links_of(Subject(place, *each) for place, each in enumerate(axes))
    return {each.name: each for each in found}


def carried(found: dict[str, Link]) -> dict[str, str | None]:
    names = list(found)
    return {k: None if v.parent is None else names[v.parent] for k, v in found.items()}


def test_a_mill_without_tables_is_a_chain_in_the_order_of_its_file() -> None:
    found = links(("X", "mm"), ("Y", "mm"), ("Z", "mm"), ("C", "deg"))
    assert carried(found) == {"X": None, "Y": "X", "Z": "Y", "C": "Z"}
    assert [each.direction for each in found.values()] == [
        (1, 0, 0), (0, 1, 0), (0, 0, 1), (0, 0, 1),
    ]  # fmt: skip
    assert [each.is_rotary for each in found.values()] == [False, False, False, True]
    step = pytest.approx(19.2)  # above the carrier; the vertical axis before it
    assert [each.origin for each in found.values()] == [
        (0, 0, 0), (0, 0, step), (step, 0, 0), (0, 0, step),
    ]  # fmt: skip


def test_axes_of_no_chain_are_on_the_ground_side_by_side() -> None:
    found = links(("X", "mm"), ("X2", "mm"), ("U", "mm"), ("3", "units"), ("Q", "rev"))
    assert set(carried(found).values()) == {None}
    rail = 0.06 * 200.0
    assert [each.origin for each in found.values()] == [(0, 4 * rail * n, 0) for n in range(5)]
    assert found["U"].direction == (1, 0, 0)


@pytest.mark.parametrize(
    ("name", "units", "turns", "direction", "per_unit"),
    [
        ("Y1", "in", False, (0, 1, 0), 25.4), ("W", "m", False, (0, 0, 1), 1000.0),
        ("A", "deg", True, (1, 0, 0), 1.0), ("B", "units", True, (0, 1, 0), 1.0),
        ("B", "mm", False, (1, 0, 0), 1.0), ("X", "rev", True, (0, 0, 1), 360.0),
        ("0", "units", False, (1, 0, 0), 1.0), ("C", "RAD", True, (0, 0, 1), 180 / pi),
    ],
)  # fmt: skip
def test_name_and_unit_say_how_an_axis_moves(
    name: str, units: str, turns: bool, direction: tuple[float, ...], per_unit: float
) -> None:
    found = links((name, units))[name]
    assert (found.is_rotary, found.direction, found.per_unit) == (turns, direction, per_unit)


def test_the_arm_of_an_axis_that_turns_lies_across_its_axis_of_rotation() -> None:
    found = links(("A", "deg"), ("B", "deg"), ("C", "deg"))
    longest = {name: each.size.index(max(each.size)) for name, each in found.items()}
    assert longest == {"A": 1, "B": 0, "C": 0}


def test_a_table_says_otherwise_and_the_carrier_comes_first() -> None:
    slide = Body(
        rotary=False, direction=(0.0, 0.6, 0.8), parent="y", origin=(1.0, 2.0, 3.0), per_unit=2.0,
        size=(4.0, 5.0, 6.0), at=(7.0, 8.0, 9.0), colour="#102030",
    )  # fmt: skip
    first = Subject(0, "X", "deg", (-10.0, 20.0), slide)
    x, y = reversed(links_of([first, Subject(1, "Y", "mm", None, Body(parent=""))]))
    assert (y.name, y.parent, y.low, y.high, y.has_ends) == ("Y", None, -100.0, 100.0, False)
    assert (x.parent, x.origin, x.is_rotary) == (0, (1.0, 2.0, 3.0), False)
    assert x.direction == pytest.approx((0.0, 0.6, 0.8), abs=1e-15)
    assert (x.low, x.high, x.has_ends) == (-20.0, 40.0, True)
    assert (x.size, x.at, x.colour) == ((4.0, 5.0, 6.0), (7.0, 8.0, 9.0), "#102030")


def test_what_carries_an_axis_follows_the_file_also_where_carriers_are_put_first() -> None:
    axes = [
        Subject(0, "A", "deg", None, Body(parent="B")),
        Subject(1, "B", "deg", None, Body(parent="")),
        Subject(2, "Z", "mm"),
    ]
    found = {each.name: each for each in links_of(axes)}
    assert carried(found) == {"B": None, "A": "B", "Z": "B"}


def test_a_direction_of_another_length_has_length_1() -> None:
    found = links_of([Subject(0, "X", "mm", None, Body(direction=(0.3, 0.0, -0.4)))])
    assert found[0].direction == pytest.approx((0.6, 0.0, -0.8), abs=1e-15)


def test_the_ends_are_hard_stops_else_limit_switches() -> None:
    limits = "positive_limit = { at = 30.0 }\nnegative_limit = { at = -2.0 }\n"
    axes = f"[[axis]]\nnumber = 0\nname = 'X'\n{limits}{DRIVE}"
    stops = axes.replace("number = 0", "number = 0\ntravel = [-3.0, 31.0]")
    half = axes.replace("negative_limit = { at = -2.0 }\n", "")
    assert subject_of(parse_world(axes).axis[0]).ends_u == (-2.0, 30.0)
    assert subject_of(parse_world(stops).axis[0]).ends_u == (-3.0, 31.0)
    assert subject_of(parse_world(half).axis[0]).ends_u is None


def test_a_carrier_that_does_not_exist_is_no_endless_search() -> None:
    with pytest.raises(ValueError, match="axis X is carried by itself or by no axis"):
        links_of([Subject(0, "X", "mm", None, Body(parent="Y"))])


def test_a_file_is_sought_beside_the_machine_file(tmp_path: Path) -> None:
    file = tmp_path / "machine.toml"
    file.write_text(f"[[axis]]\nnumber = 0\n{DRIVE}[axis.body]\nfile = 'slide.STL'\n")
    with pytest.raises(SourceError) as refused:
        load_world(file)
    assert str(refused.value) == (
        f"{file}:6:1: axis 0: there is no file 'slide.STL' (it is sought in {tmp_path})"
    )
    (tmp_path / "slide.STL").write_bytes(b"solid\n")
    assert load_world(file).axis[0].body.file == "slide.STL"
