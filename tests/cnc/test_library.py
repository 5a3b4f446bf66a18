"""Heads of library parts, sizes and their checks, the program a part becomes."""

from pathlib import Path

import pytest

from openacr.cnc.interpreter.survey import survey
from openacr.cnc.loading.load import load
from openacr.cnc.parts.library import FOLDER, names, part_named, prepared
from openacr.cnc.parts.part import Part, PartError, read_part
from openacr.errors import UserError
from openacr.sysvar import Store

HEAD = """\
;PART Keyhole plate
; a remark
;PARAM P200 "Length" in 4.0 0.1 24.0
;param P201 "Corner radius" in .25 0 2
;PARAM P202 "Angle" deg 30 -90 +90
;PARAM P203 "Holes" n 4 1 9
;PARAM P204 "Bore" mm 10 1 50
;CHECK P201*2 <= P200
;CHECK P203 MOD 2 = 0 OR P202 > 0
;START lower left corner

G1 X(P200)
;PARAM P205 "Not in the head" in 1 0 2
M2
"""


@pytest.fixture
def part(tmp_path: Path) -> Part:
    path = tmp_path / "keyhole.txt"
    path.write_text(HEAD)
    return read_part(path)


def test_the_head_names_sizes_with_units_and_ranges(part: Part) -> None:
    assert (part.name, part.title, part.start) == (
        "KEYHOLE",
        "Keyhole plate",
        "lower left corner",
    )
    assert [(size.cell, size.text, size.unit, size.default) for size in part.sizes] == [
        (200, "Length", "in", 4.0),
        (201, "Corner radius", "in", 0.25),
        (202, "Angle", "deg", 30.0),
        (203, "Holes", "n", 4.0),
        (204, "Bore", "mm", 10.0),
    ]
    assert [size.accepted for size in part.sizes] == [
        "0.1 to 24 in",
        "0 to 2 in",
        "-90 to 90 deg",
        "1 to 9",
        "1 to 50 mm",
    ]
    assert [rule.text for rule in part.rules] == ["P201*2 <= P200", "P203 MOD 2 = 0 OR P202 > 0"]


def test_sizes_are_found_by_cell_or_words(part: Part) -> None:
    assert part.size("p202").cell == part.size(" angle ").cell == 202
    with pytest.raises(UserError, match=r"KEYHOLE has no size width \(it has P200 Length, P201"):
        part.size("width")


def test_lengths_are_set_in_the_active_unit_with_lead_in_and_reading_of_arcs_from_the_store(
    part: Part,
) -> None:
    store = Store()
    store.write(250_005, 0.5)
    store.write(250_004, 1)
    store.write(250_003, 0)  # that of user programs, which has no say here
    inch = prepared(part, {200: 5.0}, store, is_metric=False)
    assert inch.ij_code == 1
    assert dict(inch.values) == pytest.approx(
        {200: 5, 201: 0.25, 202: 30, 203: 4, 204: 10 / 25.4, 224: 0, 233: 0.5}
    )
    metric = prepared(part, {200: 5.0}, store, is_metric=True)
    assert dict(metric.values) == pytest.approx(
        {200: 127, 201: 6.35, 202: 30, 203: 4, 204: 10, 224: 0, 233: 12.7}
    )
    assert prepared(part, {}, Store(), is_metric=False).ij_code == 2
    assert prepared(part, {}, Store(), is_metric=False).values[233] == 0.25


def test_the_radius_of_the_tool_is_that_of_d_with_wear_or_cmp_rad(part: Part) -> None:
    store = Store(is_metric=True)
    store.write(100_020, 3.0)
    store.write(1007, 5.0)
    store.write(1507, -0.1)
    assert prepared(part, {}, store, is_metric=True).values[224] == 3.0
    assert prepared(part, {}, store, is_metric=True, d_number=7).values[224] == 4.9
    assert prepared(part, {}, store, is_metric=False, d_number=7).values[224] == pytest.approx(
        4.9 / 25.4
    )
    with pytest.raises(UserError, match="offsets are D1 to D400"):
        prepared(part, {}, store, is_metric=True, d_number=401)


def test_a_part_may_use_p224_for_a_size_of_its_own(tmp_path: Path) -> None:
    path = tmp_path / "X.TXT"
    path.write_text(HEAD.replace("P204", "P224"))
    store = Store()
    store.write(100_020, 3.0)
    ready = prepared(read_part(path), {}, store, is_metric=True)
    assert ready.values[224] == 10
    assert "P224=10 ; Bore" in ready.program


def test_sizes_out_of_range_are_all_named_with_e222(part: Part) -> None:
    with pytest.raises(PartError) as refusal:
        prepared(part, {200: 25.0, 204: 0.5}, Store(), is_metric=False)
    assert [(found.code, found.line) for found in refusal.value.findings] == [
        ("E222", 3),
        ("E222", 7),
    ]
    assert "P200 Length = 25 (0.1 to 24 in)" in str(refusal.value)
    assert "P204 Bore = 0.5 (1 to 50 mm)" in str(refusal.value)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({200: 0.4}, "P201*2 <= P200 does not hold"),
        ({203: 3, 202: -5}, "P203 MOD 2 = 0 OR P202 > 0 does not hold"),
    ],
)
def test_conditions_are_checked_with_their_text(
    part: Part, given: dict[int, float], words: str
) -> None:
    with pytest.raises(PartError) as refusal:
        prepared(part, given, Store(), is_metric=False)
    (found,) = refusal.value.findings
    assert found.code == "E222"
    assert words in str(refusal.value)


@pytest.mark.parametrize(
    ("condition", "code"),
    [("P200/(P202-30) > 0", "E210"), ("P5 > 0", "E211"), ("INP(3)", "E108"), ("P30000=0", "E211")],
)
def test_a_condition_that_has_no_value_is_no_condition(
    condition: str, code: str, tmp_path: Path
) -> None:
    path = tmp_path / "X.TXT"
    path.write_text(HEAD.replace("P201*2 <= P200", condition))
    with pytest.raises(PartError) as refusal:
        prepared(read_part(path), {}, Store(), is_metric=False)
    assert [found.code for found in refusal.value.findings] == [code]


def test_conditions_may_ask_for_cells_of_the_store(tmp_path: Path) -> None:
    path = tmp_path / "X.TXT"
    path.write_text(HEAD.replace("P201*2 <= P200", "P200 > P150"))
    store = Store()
    prepared(read_part(path), {}, store, is_metric=False)
    store.write(150, 4.5)
    with pytest.raises(PartError, match="P200 > P150 does not hold"):
        prepared(read_part(path), {}, store, is_metric=False)


@pytest.mark.parametrize(
    ("line", "words"),
    [
        (";PARAM P205 Length in 1 0 2", "E108"),
        (';PARAM P205 "Length" in 1 0', "E108"),
        (';PARAM P205 "Length" cm 1 0 2', "the unit is one of in, mm, deg, n"),
        (';PARAM P205 "Length" in 3 0 2', "the default 3 is not 0 to 2"),
        (';PARAM P150 "Length" in 1 0 2', "sizes are P200 to P232"),
        (';PARAM P233 "Lead" in 1 0 2', "sizes are P200 to P232"),
        (';PARAM P200 "Again" in 1 0 2', "E202 word given twice: P200"),
        (";CHECK P201 <=", "E105"),
        (";CHECK P201 P202", "E104"),
    ],
)
def test_a_head_that_cannot_be_read_is_refused_with_its_line(
    line: str, words: str, tmp_path: Path
) -> None:
    path = tmp_path / "X.TXT"
    path.write_text(HEAD.replace(";START", f"{line}\n;START"))
    with pytest.raises(PartError) as refusal:
        read_part(path)
    assert words in str(refusal.value)
    assert [found.line for found in refusal.value.findings] == [10]


def test_a_text_without_title_is_no_part(tmp_path: Path) -> None:
    (tmp_path / "CYCLES.TXT").write_text("N81000 G0 Z(P253)\n;PART late\n")
    (tmp_path / "PLATE.TXT").write_text(HEAD)
    (tmp_path / "NOTES.MD").write_text(";PART x\n")
    assert names(tmp_path) == ["PLATE"]
    with pytest.raises(UserError, match=r"there is no part cycles \(there are PLATE\)"):
        part_named("cycles", tmp_path)
    with pytest.raises(PartError, match=";PART and a title are missing"):
        read_part(tmp_path / "CYCLES.TXT")
    assert part_named("plate.txt", tmp_path).title == "Keyhole plate"


def test_the_program_sets_everything_it_needs(part: Part) -> None:
    store = Store()
    store.write(1003, 0.125)
    lines = prepared(part, {200: 6}, store, is_metric=False, d_number=3).program.splitlines()
    assert lines[:12] == [
        "; KEYHOLE",
        "G20",
        "G200 F2",
        "F10",
        "D3",
        "P200=6 ; Length",
        "P201=0.25 ; Corner radius",
        "P202=30 ; Angle",
        "P203=4 ; Holes",
        "P204=0.393700787402 ; Bore",
        "P224=0.125 ; radius of the tool",
        "P233=0.25 ; radius of the lead-in",
    ]
    assert "\n".join(lines[12:]) + "\n" == HEAD


def test_the_feed_is_that_of_the_run_set_up_or_cut_speed_in_the_active_unit(part: Part) -> None:
    store = Store()
    assert prepared(part, {}, store, is_metric=True).feed == 254
    store.write(100_021, 25)
    assert prepared(part, {}, store, is_metric=False).feed == 25
    assert prepared(part, {}, store, is_metric=False, feed=7).feed == 7
    with pytest.raises(UserError, match="feed 0: it must be above 0"):
        prepared(part, {}, store, is_metric=False, feed=0)


@pytest.mark.req("MILL-LIB-LIST")
def test_at_least_20_parts_are_supplied_each_with_described_sizes() -> None:
    supplied = [part_named(name) for name in names()]
    assert len(supplied) >= 20
    assert {"RECTANGLE", "POCKET", "BOLTCIRC", "SLOT", "TRIANGLE"} <= {p.name for p in supplied}
    for part in supplied:
        assert part.title
        assert part.start
        assert part.sizes
        assert part.path.parent == FOLDER
        prepared(part, {}, Store(), is_metric=False)
        prepared(part, {}, Store(), is_metric=True)


@pytest.mark.parametrize("radius_in", [0.0, 0.1, 0.1875])
@pytest.mark.parametrize("is_metric", [False, True])
@pytest.mark.parametrize("name", names())
def test_nothing_is_found_about_a_supplied_part_of_default_size(
    name: str, is_metric: bool, radius_in: float
) -> None:
    store = Store()
    store.write(250_001, float(is_metric))
    store.write(100_020, radius_in * (25.4 if is_metric else 1.0))
    try:
        program = prepared(part_named(name), {}, store, is_metric=is_metric, feed=200.0).program
    except PartError as refused:
        assert "P224" in str(refused), "only for a tool that does not suit the part"
    else:
        assert survey(load(program, store), store).findings == []
