"""Attachments: feedback and output of axes, masters and slaves of programs."""

import pytest
from tests.system.terminal import Console


def attached(*lines: str) -> Console:
    console = Console()
    assert console.type("PROG0", *lines) == ""
    return console


@pytest.mark.req("ACR-ATT-01", "ACR-ATT-02")
def test_axes_start_with_their_own_encoder_and_output_and_report_them() -> None:
    lines = Console().type("ATTACH").split("|")
    assert lines == [f"ATTACH AXIS{n} ENC{n} DAC{n} ENC{n}" for n in range(8)]


@pytest.mark.req("ACR-ATT-02", "ACR-ATT-03", "ACR-ATT-04", "ACR-ATT-05")
@pytest.mark.parametrize(
    ("typed", "reported"),
    [
        ("ENC3 DAC2 ENC3", "ENC3 DAC2 ENC3"),
        ("ADC4 DAC4 ADC4", "ADC4 DAC4 ADC4"),
        ("ENC4 DAC4 ENC9", "ENC4 DAC4 ENC9"),
        ("ENC4 DAC4 ADC5", "ENC4 DAC4 ADC5"),
        ("ENC4 CMT2 ENC4", "ENC4 CMT2 ENC4"),
        ("STEPPER4 STEPPER4", "STEPPER4 STEPPER4 STEPPER4"),
        ("ENC7 DAC7", "ENC7 DAC7 ENC7"),
    ],
)
def test_an_axis_takes_feedback_output_and_velocity_feedback(typed: str, reported: str) -> None:
    console = Console()
    assert console.type(f"ATTACH AXIS4 {typed}") == ""
    assert console.type("ATTACH").split("|")[4] == f"ATTACH AXIS4 {reported}"


@pytest.mark.req("ACR-ATT-03")
@pytest.mark.parametrize("word", ["ENC", "ADC", "STEPPER"])
@pytest.mark.parametrize(("model", "steppers"), [("ACR9000", 8), ("ACR8020", 16)])
def test_the_position_is_any_encoder_analog_input_or_stepper_of_the_card(
    word: str, model: str, steppers: int
) -> None:
    console = Console(model)
    count = {"ENC": 20, "ADC": 16, "STEPPER": steppers}[word]
    for number in range(count):
        given = f"{word}{number} {f'STEPPER{number}' if word == 'STEPPER' else 'DAC2'}"
        assert console.type(f"ATTACH AXIS2 {given}") == ""
        shown = console.type("ATTACH").split("|")[2]
        assert shown == f"ATTACH AXIS2 {given} {word}{number}"
    assert console.type(f"ATTACH AXIS2 {word}{count} DAC2") == "Invalid argument"


@pytest.mark.parametrize("what", ["ENC20 DAC0", "ENC0 DAC16", "ADC16 DAC0", "ENC0 CMT8"])
def test_hardware_the_card_does_not_have_is_refused(what: str) -> None:
    console = Console()
    assert console.type(f"ATTACH AXIS0 {what}") == "Invalid argument"
    assert console.type("ATTACH").startswith("ATTACH AXIS0 ENC0 DAC0 ENC0")


@pytest.mark.req("ACR-ATT-06")
def test_an_analog_input_closes_the_loop_of_an_axis() -> None:
    console = Console()
    assert console.type("ATTACH AXIS4 ADC4 DAC4 ADC4", "AXIS4 PGAIN 0.01") == ""
    console.card.p[6408 + 16 * 4] = 1.5  # volts at ADC4: 1500 counts
    console.card.advance(2)
    assert console.card.p[12290 + 256 * 4] == 1500
    assert console.card.p[12291 + 256 * 4] == -1500
    assert console.card.p[6400 + 16 * 4] == pytest.approx(-10.0, abs=1e-3)  # torque limit


@pytest.mark.req("ACR-ATT-07")
def test_another_encoder_gives_the_velocity_feedback() -> None:
    console = Console()
    lines = ("ATTACH AXIS4 ENC4 DAC4 ENC7", "AXIS4 PGAIN 0", "AXIS4 FBVEL 0.001")
    assert console.type(*lines, "AXIS7 PPU 1000", "AXIS7 JOG VEL 5", "AXIS7 JOG FWD") == ""
    console.card.advance(seconds=3)
    assert console.card.p[6145 + 16 * 7] == pytest.approx(5000, rel=0.5)
    assert console.card.p[12353 + 256 * 4] > 2.5  # FBVEL term of axis 4 [V]
    assert console.card.p[12319 + 256 * 4] < 0


@pytest.mark.req("ACR-ATT-09")
def test_a_master_belongs_to_one_program_and_a_program_has_one_master() -> None:
    console = attached("ATTACH MASTER0")
    assert console.type("ATTACH MASTER1") == "Master already attached"
    assert console.type("PROG1", "ATTACH MASTER0") == "Master already attached"
    assert console.type("PROG0", "ATTACH") == "ATTACH MASTER0"


@pytest.mark.req("ACR-ATT-10", "ACR-ATT-15")
@pytest.mark.parametrize(
    ("model", "masters", "slaves"),
    [("ACR9000", 8, 8), ("ACR8020", 16, 16), ("ACR1505", 16, 16), ("ACR9040", 16, 16)],
)
def test_masters_and_slaves_end_with_the_number_the_model_has(
    model: str, masters: int, slaves: int
) -> None:
    console = Console(model)
    assert console.type("PROG0", f"ATTACH MASTER{masters}") == "Invalid argument"
    assert console.type(f"ATTACH MASTER{masters - 1}") == ""
    assert console.type(f'ATTACH SLAVE{slaves} AXIS0 "X"') == "Invalid argument"
    assert console.type(f'ATTACH SLAVE{slaves - 1} AXIS0 "X"') == ""


@pytest.mark.req("ACR-ATT-11")
def test_a_slave_needs_a_master_first() -> None:
    assert Console().type("PROG0", 'ATTACH SLAVE0 AXIS0 "X"') == "No master attached"


@pytest.mark.req("ACR-ATT-12")
def test_any_master_serves_any_program() -> None:
    console = Console()
    for program, master in ((0, 5), (5, 0), (15, 7)):
        assert console.type(f"PROG{program}", f"ATTACH MASTER{master}", "ATTACH") == (
            f"ATTACH MASTER{master}"
        )


@pytest.mark.req("ACR-ATT-13")
def test_every_master_has_its_own_slaves_from_0_upward() -> None:
    console = attached("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    assert console.type("PROG1", "ATTACH MASTER1", 'ATTACH SLAVE0 AXIS1 "X"') == ""
    assert console.type("ATTACH") == 'ATTACH MASTER1|ATTACH SLAVE0 AXIS1 "X"'
    assert console.type("PROG0", "ATTACH") == 'ATTACH MASTER0|ATTACH SLAVE0 AXIS0 "X"'


@pytest.mark.req("ACR-ATT-14", "ACR-ATT-22")
def test_an_axis_has_one_slave_until_it_is_detached() -> None:
    console = attached("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"')
    assert console.type('ATTACH SLAVE1 AXIS0 "Y"') == "Axis already attached"
    assert console.type('ATTACH SLAVE0 AXIS1 "Y"') == "Slave already attached"
    assert console.type("PROG1", "ATTACH MASTER1", 'ATTACH SLAVE0 AXIS0 "X"') == (
        "Axis already attached"
    )
    assert console.type("PROG0", "DETACH", "PROG1", 'ATTACH SLAVE0 AXIS0 "X"') == ""


@pytest.mark.req("ACR-ATT-16")
def test_a_master_takes_as_many_slaves_as_there_are_axes() -> None:
    console = Console("ACR8020")
    names = [chr(ord("A") + n) * 2 for n in range(16)]
    lines = [f'ATTACH SLAVE{n} AXIS{n} "{name}"' for n, name in enumerate(names)]
    assert console.type("PROG0", "ATTACH MASTER0", *lines) == ""
    assert console.type("ATTACH").split("|")[1:] == lines


@pytest.mark.req("ACR-ATT-17", "ACR-ATT-19")
@pytest.mark.parametrize("name", ["", "ABCDE", "X1", "P", "F", "p", "_"])
def test_a_name_is_one_to_four_letters_and_not_p_or_f(name: str) -> None:
    console = attached("ATTACH MASTER0")
    assert console.type(f'ATTACH SLAVE0 AXIS0 "{name}"') == "Illegal name"
    assert console.type('ATTACH SLAVE0 AXIS0 "ABCD"') == ""


@pytest.mark.req("ACR-ATT-18")
def test_a_name_is_known_to_its_program_only_and_axis_numbers_everywhere() -> None:
    console = attached("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "PPU X 4000")
    assert console.type("PROG1", "PPU X") == "Undefined symbol"
    assert console.type("X10") == "Unknown command"
    assert console.type("AXIS0 PPU", "SYS", "AXIS0 PPU") == "4000|4000"


@pytest.mark.req("ACR-ATT-23")
def test_attach_alone_reports_the_attachments_of_the_program() -> None:
    console = attached("ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', 'ATTACH SLAVE1 AXIS1 "Y"')
    assert console.type("ATTACH") == (
        'ATTACH MASTER0|ATTACH SLAVE0 AXIS0 "X"|ATTACH SLAVE1 AXIS1 "Y"'
    )
    assert console.type("PROG1", "ATTACH") == ""
