"""OFFSETS and MESSAGES: compensation and fixtures, names, panel buttons, user messages."""

from openacr.sysvar.schema import AXES, Tab

OFFSETS = Tab("OFFSETS", 950_000)
OFFSETS.motion()
_BY_AXIS = {"count": AXES, "is_by_axis": True}
OFFSETS.real(0, "Backlash", "u", low=0, doc="Slack taken up on reversal.", **_BY_AXIS)
OFFSETS.boolean(10, "Ballscrew on", doc="Whether the ballscrew table acts.", **_BY_AXIS)
OFFSETS.text(20, "Ballscrew file", doc="File of the ballscrew table.", **_BY_AXIS)
OFFSETS.still()
for _axis in range(AXES):
    OFFSETS.real(
        2010 + _axis,
        "Fixture {}",
        "u",
        count=99,
        step=10,
        first=1,
        axis=_axis,
        doc="Of G101..G199.",
    )
OFFSETS.text(10_000, "Input {} name", count=1000, doc="Shown beside the input.")
OFFSETS.text(20_000, "Output {} name", count=1000, doc="Shown beside the output.")
_BUTTON = {"count": 32, "step": 20}
OFFSETS.text(30_000, "Button {} caption", doc="Empty: there is no such button.", **_BUTTON)
OFFSETS.integer(30_001, "Button {} set bit", -1, low=-1, high=65_535, doc="-1 none.", **_BUTTON)
OFFSETS.integer(30_002, "Button {} show bit", -1, low=-1, high=65_535, doc="-1 none.", **_BUTTON)
OFFSETS.choice(
    30_003, "Button {} mode", {0: "momentary", 1: "toggle"}, doc="What a press does.", **_BUTTON
)

MESSAGE_COUNT, MESSAGE_CELLS = 32, 107

MESSAGES = Tab("MESSAGES", 1_000_000)
_RECORD = {"count": MESSAGE_COUNT, "step": MESSAGE_CELLS}
MESSAGES.boolean(0, "Message {} defined", doc="Whether there is such a message.", **_RECORD)
MESSAGES.integer(
    1,
    "Message {} bit",
    -1,
    low=-1,
    high=65_535,
    doc="Input, output or flag that shows it.",
    **_RECORD,
)
MESSAGES.boolean(2, "Message {} level", 1, doc="State of the bit that shows it.", **_RECORD)
_COLOUR = {"low": 0, "high": 15, **_RECORD}
MESSAGES.integer(3, "Message {} text colour", 15, doc="Of the letters.", **_COLOUR)
MESSAGES.integer(4, "Message {} back colour", 4, doc="Behind the letters.", **_COLOUR)
MESSAGES.integer(5, "Message {} size", 40, low=1, high=132, doc="Length in letters.", **_RECORD)
MESSAGES.boolean(6, "Message {} alarm", doc="True: it is an alarm.", **_RECORD)
MESSAGES.text(7, "Message {} text", doc="What is shown.", **_RECORD)
for _k in range(8, MESSAGE_CELLS):
    MESSAGES.integer(_k, "Message {} reserved", is_fixed=True, doc="Always 0.", **_RECORD)
MESSAGES.integer(
    MESSAGE_COUNT * MESSAGE_CELLS,
    "Messages defined",
    lambda at: sum(at.read(1_000_000 + m * MESSAGE_CELLS) for m in range(MESSAGE_COUNT)),
    is_fixed=True,
    doc="How many messages there are.",
)
