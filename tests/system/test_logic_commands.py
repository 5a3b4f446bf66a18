"""Flags, waits and masks: what programs and terminals do with bits."""

import pytest
from tests.system.terminal import Console


@pytest.fixture
def card() -> Console:
    return Console()


@pytest.mark.req("ACR-CMD-SET", "ACR-CMD-CLR", "ACR-PAR-04", "ACR-PAR-05", "ACR-PAR-06")
@pytest.mark.parametrize("on", ["SET 32", "SET BIT32", "BIT32=1"])
@pytest.mark.parametrize("off", ["CLR 32", "CLR BIT32", "BIT32=0"])
def test_bits_are_set_and_cleared_in_three_forms_and_read_as_minus_one_and_zero(
    card: Console, on: str, off: str
) -> None:
    assert card.type(on, "?BIT32", "?P4097") == "-1|1"
    assert card.type(off, "?BIT32", "?P4097") == "0|0"


@pytest.mark.req("ACR-CMD-DWL")
def test_a_dwell_holds_its_own_program_for_its_time_only(card: Console) -> None:
    card.type("DIM P(100)")
    card.program(0, "P0=1", "DWL 0.25", "P0=2")
    card.program(1, "_LOOP", "P1=P1+1", "GOTO LOOP")
    card.type("PROG1", "RUN", "PROG0", "RUN")
    card.card.advance(seconds=0.24)
    counted = int(card.type("?P1"))
    assert card.type("?P0") == "1"
    assert counted > 100
    card.card.advance(seconds=0.03)
    assert card.type("?P0") == "2"
    assert int(card.type("?P1")) > counted


@pytest.mark.req("ACR-CMD-INH")
def test_inh_waits_for_a_bit_to_be_set_or_with_a_minus_cleared(card: Console) -> None:
    card.type("DIM P(10)")
    card.program(0, "INH 2", "P0=1", "INH -516", "P0=2")
    card.card.bit[516] = True
    card.type("PROG0", "RUN")
    card.card.advance(seconds=0.1)
    assert card.type("?P0") == "0"
    card.card.bit[2] = True
    card.card.advance(seconds=0.01)
    assert card.type("?P0") == "1"
    card.card.advance(seconds=0.1)
    assert card.type("?P0") == "1"
    card.card.bit[516] = False
    card.card.advance(seconds=0.01)
    assert card.type("?P0") == "2"


@pytest.mark.req("ACR-CMD-IHPOS")
def test_ihpos_waits_for_a_parameter_or_its_time(card: Console) -> None:
    card.type("DIM P(10)")
    card.program(0, "IHPOS P6160(40000,5.5)", "P0=1", "IHPOS -P6160(-5,5.5)", "P0=2")
    card.type("PROG0", "RUN", "AXIS1 OFF")
    for counts, done in ((0, 0), (40000, 0), (40001, 1), (-5, 1), (-6, 2)):
        card.type(f"ENC1 RES {counts}")
        card.card.advance(seconds=0.5)
        assert card.type("?P0") == str(done)
    assert not card.card.bit[1028]  # no time was over


@pytest.mark.req("ACR-CMD-IHPOS")
def test_ihpos_goes_on_when_its_time_is_over(card: Console) -> None:
    card.type("DIM P(10)")
    card.program(0, "IHPOS P6160(40000,5.5)", "P0=1")
    card.type("PROG0", "RUN")
    card.card.advance(seconds=5.49)
    assert card.type("?P0") == "0"
    card.card.advance(seconds=0.02)
    assert card.type("?P0") == "1"


@pytest.mark.req("ACR-CMD-MASK")
def test_mask_clears_one_set_of_bits_and_then_sets_another(card: Console) -> None:
    card.type("P4097=255")
    assert card.type("MASK P4097(15,257)", "?P4097") == str(255 & ~15 | 257)
    assert card.type("MASK P4097(4294967295,5)", "?P4097", "?BIT32", "?BIT33") == "5|-1|0"


@pytest.mark.req("ACR-CMD-TRG")
def test_trg_holds_the_next_move_and_shows_that_it_is_pending(card: Console) -> None:
    card.type("PROG0", "ATTACH MASTER0", 'ATTACH SLAVE0 AXIS0 "X"', "ATTACH AXIS0 ENC0 DAC0")
    card.type("PPU X1000", "VEL 100", "ACC 0", "DEC 0", "STP 0", "AXIS0 ON")
    assert card.type("TRG 24", "X1", "?BIT539") == "-1"
    card.card.advance(seconds=0.2)
    assert card.type("?P12288") == "0"
    card.card.bit[24] = True
    card.card.advance(seconds=0.2)
    assert card.type("?BIT539", "?P12288") == "0|1000"
