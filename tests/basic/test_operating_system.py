"""Levels, attachments, aliases and reports as they are typed."""

import pytest
from tests.basic.machine import Machine
from tests.basic.parsing import parse_line

from openacr.basic.language import registry
from openacr.basic.language.registry import Level
from openacr.basic.language.scope import Scope
from openacr.errors import CardError
from openacr.messages import UNDEFINED_SYMBOL, UNKNOWN_COMMAND


@pytest.fixture
def bench() -> Machine:
    return Machine()


# aliases


def test_listed_programs_show_aliases_in_their_case(bench: Machine) -> None:
    bench.type("DIM DEF(5)", "#DEFINE EndOfTravel BIT16132", "PROG 0", "10 set EndOfTravel")
    assert bench.type("LIST") == "10 SET EndOfTravel|P00>"


# reports and settings


def test_help_lists_every_command_word(bench: Machine) -> None:
    lines = bench.type("HELP").removesuffix("SYS>").split("|")
    words = " ".join(lines).split()
    assert words == sorted(words)
    assert {row.words[0] for row in registry.commands()} - set(words) == {"LET"}
    assert all(len(line.split()) == 8 for line in lines[:-2])


@pytest.mark.parametrize(
    ("asked", "shown"),
    [
        ("VER", "VER: Print model and firmware version.|"),
        ("ver", "VER: Print model and firmware version.|"),
        ("SQRT", "SQRT(number): Square root.|"),
        ("ENC0 WIDTH", f"ENC # WIDTH: {registry.find('ENC # WIDTH').summary}|"),
        ("ENC # WIDTH", f"ENC # WIDTH: {registry.find('ENC # WIDTH').summary}|"),
        ("#DEFINE", f"#DEFINE: {registry.find('#DEFINE').summary}|"),
        ("PASSWORD ON", "PASSWORD ON: Protect the text of programs from LIST.|"),
        ("ELSE IF", "ELSEIF: Another condition, tested if all before it were false.|"),
        ("VERY", "Unknown command|"),
        ("VER PASSWORD", "Unknown command|"),
        ("0", "Unknown command|"),
        ("#", "Unknown command|"),
        ("? 5", f"PRINT: {registry.find('PRINT').summary}|"),
        ("CHR$", f"CHR$(number): {registry.find_function('CHR$').summary}|"),
    ],
)
def test_help_says_what_a_command_does(bench: Machine, asked: str, shown: str) -> None:
    assert bench.type(f"HELP {asked}") == f"{shown}SYS>"


def test_help_with_the_first_word_shows_all_commands_that_begin_so(bench: Machine) -> None:
    lines = bench.type("HELP PASSWORD").removesuffix("SYS>").split("|")[:-1]
    assert [line.partition(":")[0] for line in lines] == [
        "PASSWORD",
        "PASSWORD OFF",
        "PASSWORD ON",
    ]


def test_no_help_contains_a_prompt_character() -> None:
    assert all(">" not in row.summary for row in registry.commands())
    assert all(">" not in row.summary for row in registry.functions.values())


def test_period_is_not_changed_in_motion(bench: Machine) -> None:
    bench.card.memory.set_bit(792, True)
    assert bench.type("PERIOD 0.001") == "Not valid while in motion|SYS>"


def test_eplc_without_a_network_card_fails_to_start(bench: Machine) -> None:
    assert bench.type("EPLC") == "OFF|SYS>"
    assert bench.type("EPLC ON") == "SYS>"
    assert [bench.card.memory.bit(n) for n in (16640, 16648, 16649, 16650)] == [
        False, False, False, True,
    ]  # fmt: skip
    assert bench.type("EPLC", "EPLC OFF", "EPLC") == "FAILED|SYS>SYS>OFF|SYS>"


def test_expansion_boards_are_enabled_by_config(bench: Machine) -> None:
    assert bench.type("CONFIG XIO") == "CONFIG XIO 0|SYS>"
    assert bench.type("CONFIG XIO 2", "CONFIG XIO") == "SYS>CONFIG XIO 2|SYS>"
    assert [bench.card.memory.bit(flag) for flag in range(116, 120)] == [1, 1, 0, 0]
    assert bench.type("CONFIG XIO 5") == "Invalid argument|SYS>"
    assert bench.type("CONFIG IO INPUT 1 2", "CONFIG IO") == "Not supported|SYS>" * 2


AREAS = """
ALM BLM EXC HLBIT HLDEC HLIM IPB ITB JLM MAXVEL PM SLDEC SLIM SLM TLM CLOSE DTALK INPUT OPEN PRINT
TALK DRIVE EPLC HSINT INTCAP MSEEK MULT NORM OOP PPU REN RES ROTARY ADC ADCX AXIS CIP CMT DAC ENC
FSTAT LIMIT MASTER PLS RATCH SAMP STEPPER CIRCCW CIRCW INT INVK MOV NURB SINE SPLINE TANG TARC TRJ
CLR DWL IHPOS INH MASK SET TRG CLEAR DIM MEM BRESET ELOAD ERASE ESAVE FIRMWARE FLASH PBOOT PROM
ATTACH CONFIG CPU DEF #DEFINE DETACH DIAG ECHO HELP IP MODE PASSWORD PERIOD PLC PROG REBOOT STREAM
SYS VER AUT BLK HALT LIST LISTEN LRUN NEW PAUSE REM RESUME RUN STEP TROFF TRON BREAK END ENDP FOR
NEXT GOSUB GOTO IF ELSE ELSEIF ENDIF PROGRAM RETURN WHILE WEND DGAIN DIN DIP DWIDTH DZL DZU FBVEL
FFACC FFVC FFVEL FLT IDELAY IGAIN ILIMIT KVF KVI KVP LOPASS NOTCH PGAIN BKL BSC CAM GEAR HDW JOG
LOCK UNLOCK FLZ OFFSET ROTATE SCALE ACC DEC F FOV FVEL IVEL JRK LOOK MBUF ROV SRC STP SYNC TMOV TOV
VECDEF VECTOR VEL
"""


@pytest.mark.req("ACR-CMD-HELP")
def test_help_lists_every_command(bench: Machine) -> None:
    assert set(AREAS.split()) <= set(bench.type("HELP").replace("|", " ").split())


@pytest.mark.parametrize("word", sorted(AREAS.split()))
def test_no_command_of_the_manual_is_unknown(word: str) -> None:
    try:
        parse_line(word, Scope(Level.PROG))
    except CardError as error:  # its arguments are missing, or it belongs to programs
        assert error.message not in (UNKNOWN_COMMAND, UNDEFINED_SYMBOL)
