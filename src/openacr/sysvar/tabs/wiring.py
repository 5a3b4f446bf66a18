"""I/O, FOV, ROV, SOV, PROBE, SPINDLE and TOOL: wiring of the machine, and override tables."""

from openacr.sysvar.schema import COLOUR, INPUT, OUTPUT, At, Tab


class IO:
    """Inputs and outputs of the machine."""

    tab = Tab("I/O", 400_000)
    tab.motion()
    block_skip = tab.integer(
        0, "Block Skip", -1, typical="user", doc="Input of the block-skip switch.", **INPUT
    )
    optional_stop = tab.integer(
        1, "Optional Stop", -1, typical="user", doc="Input of the optional-stop switch.", **INPUT
    )
    feedhold_input = tab.integer(
        2, "FeedHold Input", -1, typical="user", doc="Input of the feed hold.", **INPUT
    )
    cycle_start_input = tab.integer(
        3, "Cycle Start Input", -1, typical="user", doc="Input of cycle start.", **INPUT
    )
    emergency_stop = tab.integer(
        4, "Emergency Stop", -1, typical="user", doc="Input of the emergency stop.", **INPUT
    )
    soft_limits_input = tab.integer(
        5, "Soft Limits Input", -1, typical="user", doc="Input of the maintenance key.", **INPUT
    )
    jog_joystick_input = tab.integer(
        6,
        "Jog JoyStick Input",
        -1,
        typical="user",
        doc="First of the joystick's four inputs.",
        **INPUT,
    )
    g27_input = tab.integer(
        10, "G27 Input", -1, typical="user", doc="Confirms the reference point.", **INPUT
    )
    g27_output = tab.integer(
        11, "G27 Output", -1, typical="user", doc="On at the reference point.", **OUTPUT
    )
    lubrication_error = tab.integer(
        12, "Lubrication Error", -1, typical="user", doc="Input of the lubrication fault.", **INPUT
    )
    drive_enable_output = tab.integer(
        13, "Drive enable output", -1, doc="Off at an emergency stop.", **OUTPUT
    )
    g28_error_output = tab.integer(
        19, "G28 Error Output", -1, doc="On when an axis missed its reference point.", **OUTPUT
    )
    discrete_output = tab.series(13, first=1).integer(
        101, "Discrete Output {}", -1, doc="On by M12.., off by M25.. .", **OUTPUT
    )


CLICKS = 16


class OverrideTab:
    """The tab of an override switch: a percentage for each of its clicks."""

    def __init__(self, name: str, base: int, percents: tuple[int, ...], click: int) -> None:
        def percent(at: At) -> float:
            return float(percents[at.index])

        self.tab = tab = Tab(name, base)
        self.percents = tab.series(CLICKS).real(
            0, "Click {}", "%", percent, low=0, high=200, doc="Not below that of the click before."
        )
        self.switch = tab.integer(
            16, "Switch input", -1, doc="First of four inputs, binary coded.", **INPUT
        )
        self.click = tab.integer(
            17, "Click without switch", click, low=0, high=CLICKS - 1, doc="Click in use."
        )


FOV = OverrideTab("FOV", 450_000, tuple(range(0, 160, 10)), 10)
ROV = OverrideTab(
    "ROV", 500_000, (0, 5, 10, 20, 25, 30, 35, 40, 45, 50, 60, 70, 80, 90, 95, 100), 15
)
SOV = OverrideTab("SOV", 550_000, tuple(range(50, 130, 5)), 10)


class PROBE:
    """The probe of G31."""

    tab = Tab("PROBE", 600_000)
    tab.motion()
    input = tab.integer(
        0,
        "Probe Input",
        -1,
        doc="Input of the probe of G31. Axis n (0 to 7) captures at 24 + n, 16 + n, 8 + n and n:"
        " 24, 16, 8, 0 for the first axis, 25, 17, 9, 1 for the second. Others are polled.",
        **INPUT,
    )
    edge = tab.choice(1, "Edge", {0: "leading", 1: "trailing"}, doc="Edge that trips.")
    capture = tab.choice(
        2, "Capture", {0: "hardware", 1: "software"}, doc="How positions are captured."
    )
    back_up_feed = tab.real(
        3, "Back-up feed", "u/m", low=0, high=1e6, doc="Feed back to the trip point, 0 = F."
    )
    tripped_at_start_check = tab.boolean(
        4, "Tripped-at-start check", 1, doc="Refuse G31 if the probe has tripped already."
    )
    reference_input_wait = tab.real(
        5, "Reference input wait", "s", 1, low=0, high=3600, doc="Longest wait of G27."
    )
    wired_to_each_axis = tab.boolean(
        6, "Wired to each axis", 0, doc="The probe is on the capture input of each axis."
    )


class SPINDLE:
    """The spindle and the coolant."""

    tab = Tab("SPINDLE", 800_000)
    tab.motion()
    code = tab.integer(
        0,
        "Spindle Code",
        0,
        typical="6",
        low=0,
        high=31,
        bits=(
            "-10 to 10 V, else 0 to 10 V",
            "wait for At Speed",
            "At Speed is high, else low",
            "wait for At Zero",
            "At Zero is high, else low",
        ),
        doc="Bits for handshake and speed range.",
    )
    scaling = tab.real(
        1, "Spindle Scaling", "V/rpm", 0, typical="0.00333", low=0, doc="Volts per rpm."
    )
    dac = tab.integer(
        2,
        "Spindle DAC",
        -1,
        typical="3",
        low=-1,
        high=7,
        words={-1: "none"},
        doc="Analog output of the spindle.",
    )
    at_zero_input = tab.integer(
        3, "At Zero Input", -1, typical="user", doc="Zero speed reached.", **INPUT
    )
    at_speed_input = tab.integer(
        4, "At Speed Input", -1, typical="user", doc="Speed reached.", **INPUT
    )
    cw_output = tab.integer(
        5, "Spindle CW Output", -1, typical="user", doc="On clockwise.", **OUTPUT
    )
    ccw_output = tab.integer(
        6, "Spindle CCW Output", -1, typical="user", doc="On counter-clockwise.", **OUTPUT
    )
    off_output = tab.integer(
        7, "Spindle OFF Output", 0, typical="user", doc="On at rest, 0: not connected.", **OUTPUT
    )
    exception_input = tab.integer(
        8, "Spindle Exception Input", -1, typical="user", doc="Fault, also at rest.", **INPUT
    )
    coolant_mist_output = tab.integer(9, "Coolant Mist Output", -1, doc="On by M7.", **OUTPUT)
    coolant_flood_output = tab.integer(10, "Coolant Flood Output", -1, doc="On by M8.", **OUTPUT)
    coolant_off_output = tab.integer(11, "Coolant OFF Output", -1, doc="On by M9.", **OUTPUT)
    orient_output = tab.integer(
        12, "Orient Output", -1, doc="On while the spindle is oriented.", **OUTPUT
    )
    oriented_input = tab.integer(
        13, "Oriented Input", -1, doc="On when the spindle is oriented.", **INPUT
    )
    orient_time = tab.real(
        14, "Orient time", "s", 1, low=0, high=3600, doc="Wait where there is no Oriented Input."
    )
    time_out = tab.real(
        15, "Spindle time-out", "s", 30, low=0, high=3600, doc="Longest wait, 0: unlimited."
    )


class TOOL:
    """Tool changes and colours."""

    tab = Tab("TOOL", 900_000)
    changed_input = tab.integer(
        0, "Tool Changed Input", -1, doc="On when the tool was changed.", **INPUT
    )
    change_output = tab.integer(
        1, "Tool Change Output", -1, doc="On while a tool change is requested.", **OUTPUT
    )
    manual_tool_change = tab.boolean(2, "Manual Tool Change", 1, doc="False: automatic.")
    change_time_out = tab.real(
        3, "Tool change time-out", "s", low=0, high=86_400, doc="Longest wait, 0: unlimited."
    )
    custom_m_folder = tab.text(
        10, "Custom M folder", "mcodes", doc="Folder of the files Mnnn.TXT, relative to the store."
    )
    colour = tab.series(1000).integer(
        1000,
        "Tool {} colour",
        lambda at: float(at.index % 16),
        doc="Colour of the path of the tool.",
        **COLOUR,
    )
    tip = tab.series(1000).choice(
        2000,
        "Tool {} tip",
        {0: "flat", 1: "ball"},
        doc="End of the cutter, for the picture of the stock. Not in the guide.",
    )
