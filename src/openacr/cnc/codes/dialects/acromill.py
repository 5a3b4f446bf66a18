"""The `acromill` dialect: all codes of the tables, in the order blocks act."""

from openacr.cnc.codes import gcodes, mcodes, words  # noqa: F401  fill the table
from openacr.cnc.codes.table import DIALECTS, Dialect, Step
from openacr.cnc.codes.tables import ACROMILL
from openacr.cnc.reading.grammar import ACROMILL as GRAMMAR

ORDER = (
    Step.UNIT,  # F of the same block is read in it
    Step.FEED,
    Step.SPEED,
    Step.TOOL,
    Step.RADIUS,
    Step.LENGTH_NUMBER,
    Step.PLANE,
    Step.DISTANCE,
    Step.RETURN_LEVEL,
    Step.CENTRES,
    Step.PATH,
    Step.CYCLE_OFF,
    Step.MACRO_OFF,
    Step.WORK,
    Step.LOCAL,
    Step.SCALE,
    Step.ROTATION,
    Step.ZERO,
    Step.LENGTH,
    Step.FIXTURE,
    Step.COMPENSATION,
    Step.DATA,
    Step.TRANSFER,
    Step.TOOL_CHANGE,
    Step.SPINDLE,
    Step.COOLANT,
    Step.SWITCHES,
    Step.DWELL,
    Step.MOTION,
    Step.MACRO_CALL,
    Step.SPINDLE_OFF,
    Step.COOLANT_OFF,
    Step.STOP,
)
DIALECTS["acromill"] = Dialect(
    "acromill",
    GRAMMAR,
    ACROMILL,
    ORDER,
    centre_codes={
        0: "G200 F0 or P250003 = 0",
        1: "G200 F1, P250003 = 1 or --dialect rs274ngc",
        2: "G200 F2 or P250003 = 2",
    },
)
