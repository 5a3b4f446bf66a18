"""OFFSETS and MESSAGES: compensation and fixtures, names, panel buttons, user messages."""

from openacr.sysvar.schema import AXES, Tab

_OFFSETS = Tab("OFFSETS", 950_000)


def _fixtures(axis: int) -> range:
    """The fixture offsets of an axis, that of G101 first."""
    return _OFFSETS.series(99, step=10, first=1).real(
        2010 + axis, "Fixture {}", "u", axis=axis, doc="Offset of G101..G199."
    )


class OFFSETS:
    """Compensation, fixtures, names of inputs and outputs, panel buttons."""

    tab = _OFFSETS
    tab.motion()
    backlash = tab.by_axis.real(
        0, "Backlash", "u", low=0, doc="Slack of the drive, taken up on reversal."
    )
    ballscrew_on = tab.by_axis.boolean(
        10, "Ballscrew on", doc="Whether the ballscrew table is applied."
    )
    ballscrew_file = tab.by_axis.text(20, "Ballscrew file", doc="File of the ballscrew table.")
    tab.still()
    fixtures = tuple(_fixtures(axis) for axis in range(AXES))  # by axis
    input_name = tab.series(1000).text(10_000, "Input {} name", doc="Shown beside the input.")
    output_name = tab.series(1000).text(20_000, "Output {} name", doc="Shown beside the output.")
    _button = tab.series(32, step=20)
    button_caption = _button.text(
        30_000, "Button {} caption", doc="Caption; empty: the button is not shown."
    )
    button_set_bit = _button.integer(
        30_001, "Button {} set bit", -1, low=-1, high=65_535, doc="-1: none."
    )
    button_show_bit = _button.integer(
        30_002, "Button {} show bit", -1, low=-1, high=65_535, doc="-1: none."
    )
    button_mode = _button.choice(
        30_003, "Button {} mode", {0: "momentary", 1: "toggle"}, doc="What a press does."
    )


MESSAGE_COUNT, MESSAGE_CELLS = 32, 107
_COLOUR = {"low": 0, "high": 15}


class MESSAGES:
    """The user messages: a record of cells each."""

    tab = Tab("MESSAGES", 1_000_000)
    _record = tab.series(MESSAGE_COUNT, step=MESSAGE_CELLS)
    defined = _record.boolean(0, "Message {} defined", doc="Whether the message is defined.")
    bit = _record.integer(
        1,
        "Message {} bit",
        -1,
        low=-1,
        high=65_535,
        doc="Input, output or flag that shows it.",
    )
    level = _record.boolean(2, "Message {} level", 1, doc="State of the bit that shows it.")
    text_colour = _record.integer(
        3, "Message {} text colour", 15, doc="Colour of the text.", **_COLOUR
    )
    back_colour = _record.integer(
        4, "Message {} back colour", 4, doc="Colour of the background.", **_COLOUR
    )
    size = _record.integer(5, "Message {} size", 40, low=1, high=132, doc="Length in characters.")
    alarm = _record.boolean(6, "Message {} alarm", doc="True: the message is an alarm.")
    text = _record.text(7, "Message {} text", doc="Text of the message.")
    for _k in range(8, MESSAGE_CELLS):
        _record.integer(_k, "Message {} reserved", is_fixed=True, doc="Always 0.")
    messages_defined = tab.integer(
        MESSAGE_COUNT * MESSAGE_CELLS,
        "Messages defined",
        lambda at: sum(at.read(n) for n in MESSAGES.defined),
        is_fixed=True,
        doc="Number of messages defined.",
    )
