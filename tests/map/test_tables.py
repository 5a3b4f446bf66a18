"""The derived tables agree with the transcription of the manuals, row for row."""

import csv
from collections.abc import Iterator
from pathlib import Path

import pytest

from openacr.map import Parameter, flag, flags, packet_groups, parameter, parameters
from openacr.map.block import (
    FP32,
    LONG,
    Block,
    Packet,
    Span,
    consecutive,
    objects_apart,
    sixteen_apart,
)
from openacr.map.flag_block import FlagBlock

pytestmark = pytest.mark.evidence("manual", "User's Guide Part 2, Appendix A and B")

DATA = Path(__file__).parents[1] / "data"
DRIVE_TALK_ROWS = {*range(2, 8), *range(20, 38)} - {21}  # configuration and status items


def rows(name: str) -> Iterator[dict[str, str]]:
    with (DATA / name).open(newline="", encoding="utf-8") as file:
        yield from csv.DictReader(file)


def packet_texts(found: Parameter) -> tuple[str, str, str]:
    if found.packet is None:
        return "", "", ""
    packet = found.packet
    return f"0x{packet.code:02X}", f"0x{packet.group_index:02X}", f"0x{packet.mask:02X}"


def index_text(index: int | None) -> str:
    return "" if index is None else str(index)


def test_every_transcribed_parameter_is_derived() -> None:
    for row in rows("parameters.csv"):
        if row["number"] == "0-4095":
            continue
        found = parameter(int(row["number"]))
        derived = (
            found.name,
            found.kind.value,
            found.access.value,
            *packet_texts(found),
            found.section,
            found.object,
            index_text(found.index),
        )
        columns = ("name", "type", "access", "code", "group_index", "mask")
        printed = (*(row[c] for c in columns), row["section"], row["object"], row["index"])
        assert derived == printed, row["number"]


def test_every_transcribed_flag_is_derived() -> None:
    for row in rows("flags.csv"):
        found = flag(int(row["number"]))
        derived = (
            found.printed,
            found.access.value,
            found.speed.value,
            str(found.parameter),
            str(found.bit),
            found.section,
            found.object,
            index_text(found.index),
        )
        columns = ("name", "access", "speed", "parameter", "bit_index")
        printed = (*(row[c] for c in columns), row["section"], row["object"], row["index"])
        assert derived == printed, row["number"]


def test_nothing_is_derived_beyond_the_transcription_but_the_known_additions() -> None:
    transcribed = {int(r["number"]) for r in rows("parameters.csv") if r["number"] != "0-4095"}
    added = set(parameters()) - transcribed
    senary_words = set(range(4632, 4648))
    user_rows = set(range(4096)) | set(range(38912, 39424))
    drive_talk = {28672 + 256 * axis + row for axis in range(16) for row in DRIVE_TALK_ROWS}
    assert added == senary_words | user_rows | drive_talk
    flag_numbers = {int(r["number"]) for r in rows("flags.csv")}
    assert set(flags()) - flag_numbers == set(range(17152, 17664))


def test_packet_groups_hold_the_transcribed_parameters() -> None:
    derived = packet_groups()
    transcribed = [row for row in rows("binary-groups.csv") if row["count"] != "0"]
    assert len(derived) == len(transcribed)
    for row in transcribed:
        fields = derived[int(row["code"], 16), int(row["group_index"], 16)]
        first, stride, count = (int(row[c]) for c in ("first_parameter", "stride", "count"))
        assert [n for n in fields if n is not None] == [first + stride * k for k in range(count)]


@pytest.mark.req("BIN-068")
def test_fields_of_a_packet_group_share_one_type() -> None:
    groups = packet_groups()
    for row in rows("binary-groups.csv"):
        fields = groups.get((int(row["code"], 16), int(row["group_index"], 16)), ())
        kinds = {parameter(number).kind.value for number in fields if number is not None}
        assert kinds == ({row["type"]} if int(row["count"]) else set())


@pytest.mark.req("ACR-KAMR-01", "ACR-KAMR-30")
def test_kill_flags_lie_where_the_formulas_say() -> None:
    for axis in range(16):
        assert flag(8467 + 32 * axis).name == "Kill All Motion Request"
        assert flag(8467 + 32 * axis).index == axis
    for master in range(16):
        number = 522 + 32 * master if master < 8 else 7434 + 32 * (master - 8)
        assert (flag(number).name, flag(number).index) == ("Kill All Moves Request", master)


@pytest.mark.req("ACR-PAR-15")
def test_all_groups_of_the_manual_are_present() -> None:
    heads = {found.section.split(":")[0] for found in parameters().values()}
    assert {"Master Parameters", "Axis Parameters", "Object Parameters"} <= heads
    assert "Program Parameters" in heads
    assert {"Master Flags", "Axis Flags", "Program Flags"} <= {f.section for f in flags().values()}


@pytest.mark.parametrize(
    ("number", "says"),
    [
        (9244, "P9245"),
        (4277, "0x06"),
        (10240, "0x21"),
        (14336, "0x31"),
        (4192, "0x0B"),
        (4296, "0x14"),
    ],
)
def test_misprints_of_parameters_are_noted(number: int, says: str) -> None:
    assert says in parameter(number).erratum


def test_errata_of_one_object_do_not_stick_to_the_others() -> None:
    assert parameter(9244 + 256).erratum == ""
    assert parameter(4176).erratum == ""
    assert flag(2186).erratum.startswith("Printed as BIT2188")
    assert flag(2186 + 32).erratum == ""


def test_flags_without_a_printed_name_have_a_meaning_of_their_own() -> None:
    assert (flag(8469).name, flag(8469).printed) == ("EXC Response Enable", "Undocumented")
    assert flag(17160).name == "Jog Home Request"


def test_units_are_words_of_the_house() -> None:
    block = Block("Test", object="T", prefix="", spans=(Span(0, 1),))
    with pytest.raises(ValueError, match="no unit furlong"):
        block.row(0, "Speed", FP32, unit="furlong/s")


def test_declaring_a_row_twice_is_refused() -> None:
    block = Block("Test", object="T", prefix="", spans=(Span(0, 1),))
    block.row(0, "One", LONG)
    with pytest.raises(ValueError, match="declared twice"):
        block.row(0, "Two", LONG)
    words = FlagBlock("Test", object="T", prefix="", spans=(Span(4096, 1),), word_name="T")
    words.row(3, "One")
    with pytest.raises(ValueError, match="declared twice"):
        words.row(3, "Two")


def test_packet_rules() -> None:
    assert consecutive(0x10)(4277) == Packet(0x10, 0x16, 0x20)
    assert sixteen_apart(6272) == Packet(0x18, 0x80, 0x01)
    assert objects_apart(12288 + 256 * 9 + 3) == Packet(0x38, 0x03, 0x02)
