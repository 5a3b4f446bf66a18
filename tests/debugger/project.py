"""A project to be debugged: two programs, a routine, an error, a PLC."""

from pathlib import Path

from openacr.controller import Controller

SETUP = """\
SYS
DIM PROG0(4000)
DIM PROG1(4000)
DIM P(20)
DIM PLC0(1000)
"""
PROG0 = """\
PROGRAM
REM counts, and calls a routine from the third time on
DIM LV(3)
_LOOP
P0=P0+1
IF (P0>2) THEN GOSUB DOUBLE
DWL 0.01
GOTO LOOP
_DOUBLE
P1=P0*2
SET 40
CLR 40
RETURN
ENDP
"""
PROG1 = """\
PROGRAM
P5=P5+1
DWL 0.5
P6=1/P7
ENDP
"""
PLC0 = """\
10 LD 40
20 OUT 41
"""


def write(folder: Path) -> Path:
    for name, text in (
        ("setup.8k", SETUP), ("prog0.8k", PROG0), ("prog1.8k", PROG1), ("plc0.8k", PLC0)
    ):  # fmt: skip
        (folder / name).write_text(text)
    return folder


def card_of(folder: Path) -> Controller:
    return Controller.from_project(write(folder))
