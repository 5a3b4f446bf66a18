"""Hidden rows of the world outside the card: motors, switches, wiring.

The position of a motor is a float64 number of encoder counts (four per line), 0 being the
count at which the encoder started; counts grow in the direction in which the encoder counts
up. All other quantities of a motor are in counts and seconds too, so that the step needs no
conversion: accelerations stand for torques, divided by the inertia.
"""

from openacr.map.hidden.block import ANY_NUMBER, FINITE, ROWS_I, SWITCH, HiddenBlock

INPUTS = 32

# Instance n is the motor whose encoder is wired to encoder input n.
MOTOR = HiddenBlock(
    prefix="PL",
    family="motors",
    count=16,
    doubles=(
        "position_cnt",
        "velocity_cps",
        "previous_cnt",  # position at the end of the tick before
        "raw_count",  # what the quadrature counter shows: whole counts, starting at 0
        "volts",  # at the terminals of the drive; of phases, what makes the same torque
        # parameters of the drive
        "dac_step",  # 1 for a 16-bit converter, 16 for a 12-bit one
        "offset_v",
        "accel_per_volt",
        "peak_accel",
        "supply_accel",  # of full supply voltage at standstill, 0: supply without limits
        "back_emf_per_s",
        "speed_per_volt_cps",
        "lag_s",
        # parameters of the mechanics
        "viscous_per_s",
        "coulomb_accel",
        "static_accel",
        "low_stop_cnt",
        "high_stop_cnt",
        "marker_pitch_cnt",
        "marker_phase_cnt",
        # no switch, region border or marker lies between these two
        "quiet_low_cnt",
        "quiet_high_cnt",
        # edges of the marker within the last tick, for position capture
        "marker_rise_fraction",
        "marker_rise_cnt",
        "marker_fall_fraction",
        "marker_fall_cnt",
        # factors of one step, valid for one length of the tick
        "cached_dt_s",
        "decay",
        "glide_s",
        "push_s2",
        "lag_decay",
    ),
    ints=(
        # 0 none; drives: 1 torque, 2 velocity, 3 ideal, 4 torque by phases, 5 stepper, 6 exact,
        # 7 on a bus
        "kind",
        "dac",  # of a stepper its output
        "drive_enabled",  # written by the card
        "drive_ready",
        "drive_fault",
        "fault_word",
        "fault_mask",
        "fault_closed",
        "marker",  # 1 while the marker is present
        "marker_edges",  # of the last tick: 1 rising, 2 falling, 3 both
        # faults from outside
        "encoder_fault",  # 1 edges are lost, 2 no signals, as the encoder flags; 4 no encoder
        "fault_report",  # of a drive without fault input: 0 none ever, 1 taken back, 2 fault
        "cable_cut",  # 1 while the motor gets no current
    ),
    usual=FINITE,
    ranges={
        "kind": (0, 255),
        "dac": (0, 15),
        "fault_word": (0, 40959),
        "quiet_low_cnt": ANY_NUMBER,
        "quiet_high_cnt": ANY_NUMBER,
        "low_stop_cnt": ANY_NUMBER,
        "high_stop_cnt": ANY_NUMBER,
    },
)

# What a motor that the card commutates has on top, see plant/physics/phases_cy.py.
PHASES = HiddenBlock(
    prefix="PLB",
    family="phases",
    count=16,
    doubles=("radians_per_cnt", "zero_rad", "peak_v"),
    ints=("second_dac", "phases"),
    usual=FINITE,
    ranges={
        "second_dac": (0, 15),
    },
)

# What a stepper motor has on top, see plant/physics/stepper_cy.py.
STEPPER = HiddenBlock(
    prefix="PLT",
    family="stepper_motors",
    count=16,
    doubles=(
        "field_cnt",  # where the field would hold the rotor
        "pulses_seen",  # of its output, until the last period
        "counts_per_pulse",
        "radians_per_cnt",  # of the field: a turn is four full steps
        "stiffness_per_s",  # angular frequency at which the rotor would swing without load
        "damping_per_s",
        ("speed_cps", 8),  # points of the torque-speed curve
        ("accel", 8),
    ),
    ints=("points",),
)

# What a load on an elastic shaft has on top, see plant/physics/compliance_cy.py.
COMPLIANCE = HiddenBlock(
    prefix="PLR",
    family="compliant_loads",
    count=16,
    doubles=(
        "flex_cnt",  # of the motor, from where it would be on a rigid shaft
        "flex_cps",
        "resonance_rad_s",  # of motor and load against each other; 0: the shaft is rigid
        "damping_per_s",
        "inertia_ratio",  # of the load to the motor
        # factors of one step, valid for one length of the tick
        "cached_dt_s",
        "keep_place",
        "place_of_speed_s",
        "keep_speed",
    ),
    usual=FINITE,
)

# What a drive on a bus has reported of its motor, see plant/physics/bus_motor_cy.py.
BUS_MOTOR = HiddenBlock(
    prefix="PLX",
    family="bus_motors",
    count=16,
    doubles=(
        "reported_cnt",  # its position
        "probe_rise_cnt",  # where its touch probe latched it
        "probe_fall_cnt",
    ),
    ints=(
        "has_probe",  # the first external input of a capture is the touch probe of the drive
        # of the touch probe, since the last tick: 1 rising, 2 falling; of the marker: 4, 8
        "reported_edges",
        "probe_edges",  # of the touch probe in this tick
    ),
    usual=FINITE,
    ranges={
        "has_probe": SWITCH,
    },
)

# The terminals of the analog inputs of the card and what is wired to them.
ANALOG = HiddenBlock(
    prefix="PLA",
    family="analogs",
    count=8,
    doubles=("volts", "base_v", "volts_per_cnt", "dac_step"),
    ints=("axis", "dac"),  # both + 1, 0 none,
    usual=FINITE,
    ranges={
        "axis": (0, 16),
        "dac": (0, 16),
    },
)

# What drives an input: a box in space, one entry per side of the box, or an output.
WIRE = HiddenBlock(
    prefix="PLW",
    family="wires",
    count=64,
    doubles=("low_cnt", "high_cnt", "delay_s", "waited_s"),
    ints=(
        "axis",
        "more",  # the next entry is a further condition of the same wire
        "slot",  # which input word
        "mask",
        "bit",
        "closed",  # contact: 0 normally open, 1 normally closed
        "active",
        "output_word",
        "output_mask",
    ),
    ranges={
        "axis": (0, 15),
        "more": SWITCH,
        "slot": (0, 15),
        "bit": (0, INPUTS - 1),
        "output_word": (0, ROWS_I),
        "low_cnt": ANY_NUMBER,
        "high_cnt": ANY_NUMBER,
    },
)

# The words in which inputs are wired.
INPUT_WORD = HiddenBlock(
    prefix="PLN",
    family="input_words",
    count=16,
    doubles=(),
    ints=(
        "word",
        "wired",
        "level",
        "stuck",  # forced from outside, whatever drives them
        "stuck_level",
    ),
    ranges={
        "word": (0, ROWS_I),  # see also plant/describe/places.py
    },
)

DEVICES = HiddenBlock(
    prefix="MDV",
    family="machine_devices",
    count=1,
    doubles=("due_tk",),  # tick of the next step of a device; 0: there are none
)

GENERAL = HiddenBlock(
    prefix="PLG",
    family="plant",
    count=1,
    doubles=(("rise_fraction", INPUTS), ("fall_fraction", INPUTS)),
    ints=(
        "rises",  # onboard inputs with a rising edge within the last tick
        "falls",
        "follows",  # the first entries of the wire table are driven by outputs
        "wires",
        "words",
        "analogs",  # something is wired to analog inputs
    ),
    ranges={
        "follows": (0, 64),
        "wires": (0, 64),
        "words": (0, 16),
    },
)
