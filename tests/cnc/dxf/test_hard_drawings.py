"""Drawings that are hard to read: tiny lines, binary and damaged files, blocks without end."""

import math
from pathlib import Path
from typing import Any

import pytest
from ezdxf.entities.insert import Insert
from tests.cnc.dxf.programs import trace
from tests.cnc.dxf.test_convert import converted, drawing, square

from openacr.cnc.dxf import Options, convert, reading
from openacr.cnc.dxf.chains import joined, nodes_of
from openacr.cnc.dxf.doubles import without_doubles
from openacr.cnc.dxf.segments import Segment
from openacr.errors import UserError

EPSILON = 0.002


def tiny_circle(count: int, length: float) -> list[tuple[Segment, ...]]:
    """A regular polygon of single lines, each of this length."""
    radius = length / (2.0 * math.sin(math.pi / count))
    points = [
        (radius * math.cos(2.0 * math.pi * k / count), radius * math.sin(2.0 * math.pi * k / count))
        for k in range(count)
    ]
    return [(Segment(a, b),) for a, b in zip(points, [*points[1:], points[0]], strict=True)]


@pytest.mark.parametrize("length", [0.01, 0.0021, 0.002, 0.0019, 0.0015, 0.0005, 0.00002])
def test_a_contour_of_lines_shorter_than_epsilon_stays_whole(length: float) -> None:
    pieces = tiny_circle(500, length)
    assert without_doubles(pieces, EPSILON) == pieces
    (chain,) = joined(pieces, EPSILON)
    assert chain.is_closed
    assert chain.length == pytest.approx(500 * length)
    assert len(chain.segments) == 500


def test_a_map_of_tiny_lines_is_cut_to_its_full_length(tmp_path: Path) -> None:
    document = drawing(4)
    for (line,) in tiny_circle(2000, 0.0015):
        document.modelspace().add_line(line.start, line.end)
    result = converted(document, tmp_path, is_metric=True)
    assert result.notes == ()
    assert result.summary == "1 chain (1 closed) of 2000 entities"
    assert trace(result.text).length == pytest.approx(3.0, rel=0.02)


def test_gaps_beside_short_lines_are_joined_up_to_half_of_the_line() -> None:
    def chains(length: float, gap: float) -> int:
        pieces = [
            (Segment((0.0, 0.0), (1.0, 0.0)),),
            (Segment((1.0 + gap, 0.0), (1.0 + gap + length, 0.0)),),
        ]
        return len(joined(pieces, EPSILON))

    assert chains(0.003, 0.0014) == 1
    assert chains(0.003, 0.0016) == 2
    assert chains(1.0, 0.0019) == 1
    assert chains(1.0, 0.0021) == 2
    assert chains(0.0001, 0.0) == 1


def test_ends_of_one_short_line_are_two_joints() -> None:
    (start, end) = nodes_of([(Segment((0.0, 0.0), (0.001, 0.0)),)], EPSILON)
    assert start != end


def test_what_vanishes_in_a_joint_is_reported(tmp_path: Path) -> None:
    document = drawing()
    space = document.modelspace()
    space.add_line((0, 0), (1, 0))
    space.add_line((1, 0), (1.001, 0))
    space.add_line((1.001, 0), (2, 1))
    space.add_line((2, 1), (2, 1.001))
    space.add_line((2, 1.001), (3, 3))
    result = converted(document, tmp_path)
    assert result.notes == ("shorter than epsilon inside a joint, left out: 2",)
    assert result.summary == "1 chain (0 closed) of 5 entities"


def test_short_lines_drawn_twice_are_left_out_once() -> None:
    pieces = tiny_circle(50, 0.001)
    assert without_doubles([*pieces, *pieces], EPSILON) == pieces


@pytest.mark.parametrize(
    ("version", "notes"),
    [("R12", ("the drawing states no unit: taken as inch",)), ("R2010", ())],
)
def test_a_binary_file_is_read(version: str, notes: tuple[str, ...], tmp_path: Path) -> None:
    document = drawing(1, version)
    square(document.modelspace())
    path = tmp_path / "binary.dxf"
    document.saveas(path, fmt="bin")
    assert path.read_bytes().startswith(b"AutoCAD Binary DXF")
    result = convert(path, Options())
    assert result.notes == notes
    assert trace(result.text).length == 8.0


def test_a_damaged_file_is_recovered_and_says_so(tmp_path: Path) -> None:
    document = drawing()
    square(document.modelspace())
    path = tmp_path / "damaged.dxf"
    document.saveas(path)
    text = path.read_text()
    path.write_text(text[: text.rindex("  0\nENDSEC\n") - 2000])  # the end is missing
    result = convert(path, Options())
    assert result.notes == ("the file is damaged: what could be recovered is here",)
    assert trace(result.text).length == 8.0


def blocks_in_blocks(document: Any, deep: int, wide: int) -> None:
    """A line in blocks within blocks: wide ** deep of them, side by side."""
    block = document.blocks.new("B0")
    block.add_line((0, 0), (1, 0))
    for level in range(1, deep + 1):
        block = document.blocks.new(f"B{level}")
        for k in range(wide):
            block.add_blockref(f"B{level - 1}", (0, 3.0 * k * wide ** (level - 1)))
    document.modelspace().add_blockref(f"B{deep}", (0, 0))


def test_blocks_within_blocks_are_bounded(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    document = drawing()
    blocks_in_blocks(document, 3, 3)  # 1 + 3 + 9 + 27 insertions and 27 lines
    assert converted(document, tmp_path).summary == "27 chains (0 closed) of 27 entities"
    monkeypatch.setattr(reading, "MOST", 67)
    assert converted(document, tmp_path).summary == "27 chains (0 closed) of 27 entities"
    monkeypatch.setattr(reading, "MOST", 66)
    with pytest.raises(UserError, match="the drawing has more than 66 entities in its blocks"):
        converted(document, tmp_path)


@pytest.mark.parametrize(("deep", "wide", "array"), [(14, 30, 1), (1, 1, 32000), (4, 4, 100)])
def test_blocks_are_counted_before_they_are_expanded(
    deep: int, wide: int, array: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    document = drawing()
    blocks_in_blocks(document, deep, wide)
    counts = {"row_count": array, "column_count": array, "row_spacing": 9.0, "column_spacing": 9.0}
    document.modelspace().add_blockref(f"B{deep}", (0, 0), dxfattribs=counts)
    monkeypatch.setattr(Insert, "virtual_entities", None)
    with pytest.raises(UserError, match="the drawing has more than 2,000,000 entities in its"):
        converted(document, tmp_path)


@pytest.mark.parametrize(
    ("layer", "frozen", "count"),
    [("0", "FROZEN", 3), ("FROZEN", "FROZEN", 1), ("OTHER", "FROZEN", 3), ("OTHER", "0", 3)],
)
def test_what_is_frozen_is_not_counted(
    layer: str, frozen: str, count: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    document = drawing()
    document.layers.add("OTHER")
    document.layers.add("FROZEN")
    document.layers.get(frozen).freeze()
    blocks_in_blocks(document, 1, 1)  # an insertion of an insertion of a line
    square(document.modelspace())
    count += len(document.modelspace()) - 1
    (insert,) = (each for each in document.modelspace() if each.dxftype() == "INSERT")
    insert.dxf.layer = layer
    monkeypatch.setattr(reading, "MOST", count)
    assert converted(document, tmp_path).summary
    monkeypatch.setattr(reading, "MOST", count - 1)
    monkeypatch.setattr(Insert, "virtual_entities", None)
    with pytest.raises(UserError, match="more than"):
        converted(document, tmp_path)


def test_a_block_in_itself_is_too_deep(tmp_path: Path) -> None:
    document = drawing()
    square(document.modelspace())
    blocks_in_blocks(document, 0, 1)
    document.blocks.get("B0").add_blockref("B0", (0, 1))
    assert converted(document, tmp_path).notes == ("not used: 1 block nested deeper than 16",)


def test_blocks_nested_too_deep_are_reported(tmp_path: Path) -> None:
    document = drawing()
    square(document.modelspace())
    blocks_in_blocks(document, 15, 1)
    assert converted(document, tmp_path).notes == ()
    document = drawing()
    square(document.modelspace())
    blocks_in_blocks(document, 16, 1)
    assert converted(document, tmp_path).notes == ("not used: 1 block nested deeper than 16",)


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (1, 2), (2, 1), (2, 3)])
def test_an_array_of_a_block_is_all_its_rows_and_columns(
    rows: int, columns: int, tmp_path: Path
) -> None:
    document = drawing()
    document.blocks.new("HOLE").add_circle((0.5, 0), 0.1)
    document.modelspace().add_blockref(
        "HOLE",
        (10, 20),
        dxfattribs={
            "row_count": rows, "column_count": columns, "row_spacing": 5.0, "column_spacing": 2.0,
        },
    )  # fmt: skip
    path = tmp_path / "array.dxf"
    document.saveas(path)
    found = reading.read(path, layer="", is_metric=False, chord=lambda _: 0.001)
    wanted = [(10.5 + 2.0 * k, 20.0 + 5.0 * n) for k in range(columns) for n in range(rows)]
    assert [(round(x, 9), round(y, 9)) for x, y in sorted(found.circles)] == wanted
