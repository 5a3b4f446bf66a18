"""I/O, FOV, ROV, SOV, PROBE, SPINDLE and TOOL: what is wired to what, and override tables."""

from openacr.sysvar.schema import INPUT, OUTPUT, At, Tab

IO = Tab("I/O", 400_000)
IO.motion()
IO.integer(0, "Block Skip", -1, typical="user", doc="Input of the block-skip switch.", **INPUT)
IO.integer(1, "Optional Stop", -1, typical="user", doc="Input of the switch.", **INPUT)
IO.integer(2, "FeedHold Input", -1, typical="user", doc="Input of the feed hold.", **INPUT)
IO.integer(3, "Cycle Start Input", -1, typical="user", doc="Input of cycle start.", **INPUT)
IO.integer(4, "Emergency Stop", -1, typical="user", doc="Input; active stops.", **INPUT)
IO.integer(5, "Soft Limits Input", -1, typical="user", doc="Maintenance key of jogging.", **INPUT)
IO.integer(6, "Jog JoyStick Input", -1, typical="user", doc="First of four inputs.", **INPUT)
IO.integer(10, "G27 Input", -1, typical="user", doc="Confirms the reference point.", **INPUT)
IO.integer(11, "G27 Output", -1, typical="user", doc="On at the reference point.", **OUTPUT)
IO.integer(12, "Lubrication Error", -1, typical="user", doc="Input of the contact.", **INPUT)
IO.integer(13, "Drive enable output", -1, doc="Off at an emergency stop.", **OUTPUT)
IO.integer(19, "G28 Error Output", -1, doc="On when the point is missed.", **OUTPUT)
IO.integer(
    101, "Discrete Output {}", -1, count=13, first=1, doc="On by M12.., off by M25.. .", **OUTPUT
)

CLICKS = 16


def _override(name: str, base: int, percents: tuple[int, ...], click: int) -> Tab:
    """The tab of an override switch: a percentage for each of its clicks."""
    tab = Tab(name, base)

    def percent(at: At) -> float:
        return float(percents[at.index])

    tab.real(
        0, "Click {}", "%", percent, count=CLICKS, low=0, high=200, doc="Not below the one before."
    )
    tab.integer(16, "Switch input", -1, doc="First of four inputs, binary.", **INPUT)
    tab.integer(17, "Click without switch", click, low=0, high=CLICKS - 1, doc="In use.")
    return tab


FOV = _override("FOV", 450_000, tuple(range(0, 160, 10)), 10)
ROV = _override("ROV", 500_000, (0, 5, 10, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90, 95, 100), 15)
SOV = _override("SOV", 550_000, tuple(range(50, 130, 5)), 10)

PROBE = Tab("PROBE", 600_000)
PROBE.motion()
PROBE.integer(0, "Probe Input", -1, doc="Input of the probe of G31.", **INPUT)
PROBE.choice(1, "Edge", {0: "leading", 1: "trailing"}, doc="Edge that trips.")
PROBE.choice(2, "Capture", {0: "hardware", 1: "software"}, doc="How positions are caught.")
PROBE.real(3, "Back-up feed", "u/m", low=0, high=1e6, doc="Back to the trip point, 0 = F.")
PROBE.boolean(4, "Tripped-at-start check", 1, doc="Refuse G31 on a tripped probe.")
PROBE.real(5, "Reference input wait", "s", 1, low=0, high=3600, doc="Of G27.")
PROBE.boolean(6, "Wired to each axis", 0, doc="The probe is on the capture input of each axis.")

SPINDLE = Tab("SPINDLE", 800_000)
SPINDLE.motion()
SPINDLE.integer(
    0, "Spindle Code", 0, typical="6", low=0, high=31, doc="Bits of handshake and range."
)
SPINDLE.real(1, "Spindle Scaling", "V/rpm", 0, typical="0.00333", low=0, doc="Volts per rpm.")
SPINDLE.integer(
    2,
    "Spindle DAC",
    -1,
    typical="3",
    low=-1,
    high=7,
    words={-1: "none"},
    doc="Analog output of the spindle.",
)
SPINDLE.integer(3, "At Zero Input", -1, typical="user", doc="Zero speed reached.", **INPUT)
SPINDLE.integer(4, "At Speed Input", -1, typical="user", doc="Speed reached.", **INPUT)
SPINDLE.integer(5, "Spindle CW Output", -1, typical="user", doc="On clockwise.", **OUTPUT)
SPINDLE.integer(6, "Spindle CCW Output", -1, typical="user", doc="On the other way.", **OUTPUT)
SPINDLE.integer(7, "Spindle OFF Output", 0, typical="user", doc="On at rest, 0 none.", **OUTPUT)
SPINDLE.integer(8, "Spindle Exception Input", -1, typical="user", doc="Fault.", **INPUT)
SPINDLE.integer(9, "Coolant Mist Output", -1, doc="On by M7.", **OUTPUT)
SPINDLE.integer(10, "Coolant Flood Output", -1, doc="On by M8.", **OUTPUT)
SPINDLE.integer(11, "Coolant OFF Output", -1, doc="On by M9.", **OUTPUT)
SPINDLE.integer(12, "Orient Output", -1, doc="On while the spindle is oriented.", **OUTPUT)
SPINDLE.integer(13, "Oriented Input", -1, doc="Answers the orient output.", **INPUT)
SPINDLE.real(14, "Orient time", "s", 1, low=0, high=3600, doc="Without the input.")
SPINDLE.real(15, "Spindle time-out", "s", 30, low=0, high=3600, doc="Of waits, 0 none.")

TOOL = Tab("TOOL", 900_000)
TOOL.integer(0, "Tool Changed Input", -1, doc="The tool is changed.", **INPUT)
TOOL.integer(1, "Tool Change Output", -1, doc="A change is wanted.", **OUTPUT)
TOOL.boolean(2, "Manual Tool Change", 1, doc="False: automatic.")
TOOL.real(3, "Tool change time-out", "s", low=0, high=86_400, doc="0 none.")
TOOL.text(10, "Custom M folder", "mcodes", doc="Files Mnnn.TXT, beside the store.")
TOOL.integer(
    1000,
    "Tool {} colour",
    lambda at: float(at.index % 16),
    count=1000,
    low=0,
    high=15,
    doc="Of its path.",
)
