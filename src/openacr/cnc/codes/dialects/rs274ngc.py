"""The `rs274ngc` dialect: programs of other controls."""

from openacr.cnc.codes.ngc import contexts, gcodes, mcodes, splines  # noqa: F401  fill the table
from openacr.cnc.codes.ngc.parameters import NgcParameters
from openacr.cnc.codes.table import DIALECTS, Dialect, Step
from openacr.cnc.codes.tables import RS274NGC
from openacr.cnc.reading.grammar import RS274NGC as GRAMMAR
from openacr.cnc.state.modal import always, store_unit

ORDER = (
    Step.FEED_MODE,
    Step.FEED,
    Step.SPEED,
    Step.TOOL,
    Step.TOOL_CHANGE,
    Step.SPINDLE,
    Step.SPINDLE_OFF,
    Step.COOLANT,
    Step.COOLANT_OFF,
    Step.SWITCHES,
    Step.KEEP,
    Step.DWELL,
    Step.PLANE,
    Step.UNIT,
    Step.RADIUS,
    Step.COMPENSATION,
    Step.LENGTH,
    Step.WORK,
    Step.PATH,
    Step.DISTANCE,
    Step.CENTRES,
    Step.RETURN_LEVEL,
    Step.DATA,
    Step.ZERO,
    Step.CYCLE_OFF,
    Step.MOTION,
    Step.STOP,
)
DIALECTS["rs274ngc"] = Dialect(
    "rs274ngc",
    GRAMMAR,
    RS274NGC,
    ORDER,
    start={
        "motion": always(1),
        "plane": always(17),
        "distance": always(90),
        "unit": store_unit,
        "work": always(1),
        "path": always(64),
        "return_level": always(98),
        "centres": always(1),
    },
    assigns_last=True,
    labels=False,
    parameters=NgcParameters,
    has_own_cycles=True,
    rises_first=True,
    cycle_labels={74: 500, 86: 500, 89: 500},
    clearance_inch=0.010,
    has_spirals=False,
    has_entry_arcs=True,
    centre_codes={1: "G91.1", 2: "G90.1"},
)
