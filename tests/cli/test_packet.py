"""`openacr packet`: hex dumps explained."""

import json

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app


def explain(*words: str) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["packet", *words])
    return result.exit_code, result.output


def test_a_parameter_request_names_its_parameter() -> None:
    code, text = explain("00 88 02 30")
    assert code == 0
    assert "GetLong" in text
    assert "02 30" in text
    assert "P12290" in text


def test_a_data_packet_names_every_parameter_of_its_mask() -> None:
    _, text = explain("0x00", "0x30", "0x02", "0x05")
    assert "P12290" in text
    assert "P12802" in text
    assert "P12546" not in text


def test_a_reply_shows_its_words_both_ways() -> None:
    _, text = explain("--reply", "008A0230", "0000803F")
    assert "1065353216 (as IEEE 1)" in text


def test_escaped_bytes_are_read_in_the_mode_of_the_stream() -> None:
    _, text = explain("--mode", "1", "1C 23 40 23 41")
    assert "BIT256" in text


def test_packets_may_follow_each_other() -> None:
    code, text = explain("--json", "1C 08 02 1D 08 02")
    assert code == 0
    assert [each["packet"] for each in json.loads(text)] == ["SetBit", "ClearBit"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("00 88 02", "is not complete"),
        ("55 00", "byte 1: no packet starts with 55"),
        ("00 8G", "'G' is no hex digit"),
        ("00 8", "odd number"),
        ("00 99 00 00", "no packet"),
    ],
)
def test_what_is_no_packet_is_said_with_its_place(words: str, said: str) -> None:
    code, text = explain(words)
    assert code == 2
    assert said in text
