"""Hidden rows of paths: profiles, move queues, curves and masters.

Positions are float64 pulses; the public LONG parameters show them rounded. Distances,
speeds and accelerations of a profile are in the unit of its owner: programming
units for masters, pulses for the jog profiler of an axis.
"""

from openacr.map.hidden.block import HiddenBlock, Merge

SEGMENTS = 16
SLAVES = 16
MOVES_PER_MASTER = 16
MOVES_DIMENSIONED = 512  # room for the buffers that DIM MBUF makes longer
MOVES = 16 * MOVES_PER_MASTER + MOVES_DIMENSIONED
POLES = 6
ARCS = 8
POINTS = 12  # of an unfinished curve
KNOTS = 24

# One motion profile: pieces of constant jerk, evaluated in order (kernel/profile/profile_cy.py).
# Instances 0-15 belong to the masters, 16-31 to the jog profilers of the axes, 32-47 to their
# position maintenance.
PROFILE = HiddenBlock(
    prefix="PR",
    family="profiles",
    count=48,
    merged_usually=Merge.LOOP,
    doubles=(
        ("seg_time_s", SEGMENTS),
        ("seg_jerk", SEGMENTS),
        ("seg_accel", SEGMENTS),
        ("seg_velocity", SEGMENTS),
        ("seg_distance", SEGMENTS),
        "time_s",  # since the start of the present segment
        "distance",
        "velocity",
        "accel",
        "jerk",
        "end_distance",
        "end_velocity",
        "target_velocity",  # cruising speed of the present plan
        "plan_distance",  # end of the plan while segments are appended
        "plan_velocity",
        "plan_accel",
    ),
    ints=(
        ("seg_kind", SEGMENTS),
        "seg_count",
        "seg_index",
        "kind",
    ),
    ranges={
        "seg_count": (0, SEGMENTS),
        "seg_index": (0, SEGMENTS),
    },
)

# Moves waiting for or executed by a master: a ring of records per master. The first 256
# belong to the masters in turn, those after them are lent with DIM MBUF.
MOVE = HiddenBlock(
    prefix="MQ",
    family="moves",
    count=MOVES,
    doubles=(
        "vel_ups",
        "acc_ups2",
        "dec_ups2",
        "stp_ups2",
        "jrk_ups3",
        "fvel_ups",
        "ivel_ups",
        "length_u",
        "maxvel_ups",  # bound by MAXVEL of the axes, 0 none
        "tmov_s",  # time it is to take, 0 as long as it needs
        "turn_deg",  # angle between its end and the beginning of the next
        "tolerance_u",  # how far the path may stay off the corner at its end, 0 exact
        "corner_u",  # from how far before that corner it is rounded, 0 not at all
        "corner_turn",  # size of the change of direction there, 0 to 2
        "corner_ups",  # highest speed in it
        "hsint_window_cnt",  # HSINT: captures count from `start` to `start + window`
        "hsint_start_cnt",
        "hsint_distance_cnt",  # and lead this much farther
        ("enter", 3),  # direction of the path at its beginning and end (slaves 0-2)
        ("leave", 3),
        ("target_cnt", SLAVES),
        ("delta_cnt", SLAVES),
        ("weight", SLAVES),
        ("tang", 5),  # see kernel/path/tangent_cy.py
    ),
    ints=(
        "slaves",  # mask of the slaves that take part
        "relative",  # of those, the ones whose displacement is given, not the target
        "rapid",
        "seek_axis",  # MSEEK: axis + 1
        "seek_mode",
        "curved",  # mask of the slaves that follow a curve, see kernel/path/curve_cy.py
        "half_wave",  # of those, the ones in Sinusoidal Mode
        "curve",  # 0 none but SINE, 1 CIRCW, 2 CIRCCW, 3 TARC, 4 and 5 SPLINE and NURB
        "degree",  # of SPLINE and NURB (kernel/path/bezier_cy.py)
        ("plane", 3),  # slaves of CIRCW, CIRCCW and TARC
        "interrupt",  # INT: flag + 1 that ends it, negative: by being clear
        "trigger",  # TRG: flag + 1 that starts it, negative: by being clear
        "trigger_axis",  # TRG: axis + 1 whose capture starts it
        "hsint_axis",  # HSINT: axis + 1
        "hsint_mode",
        "hsint_abort",  # flag + 1 that ends it
        "tang_slave",  # slave + 1 that is kept tangential along a curve
        "ahead",  # what is decided about the corner at its end: see lookahead_cy
        "marks",  # of a binary move: override lock, counter, interrupt, block skip; of a curve
    ),
    ranges={
        "slaves": (0, 0xFFFF),
        "relative": (0, 0xFFFF),
        "curved": (0, 0xFFFF),
        "half_wave": (0, 0xFFFF),
        "seek_axis": (0, SLAVES),
        "curve": (0, 5),
        "degree": (0, POLES - 1),
        "plane": (0, SLAVES - 1),
        "interrupt": (-17664, 17664),
        "trigger": (-17664, 17664),
        "trigger_axis": (0, SLAVES),
        "hsint_axis": (0, SLAVES),
        "hsint_abort": (-17664, 17664),
        "tang_slave": (0, SLAVES),
    },
)

# The curves of those moves: per slave a wave on a straight base (kernel/path/curve_cy.py). SPLINE
# and NURB keep up to six poles per slave in the first six rows (kernel/path/bezier_cy.py).
CURVE = HiddenBlock(
    prefix="MW",
    family="curves",
    count=MOVES,
    doubles=(
        ("amplitude_cnt", SLAVES),
        ("growth_cnt", SLAVES),
        ("phase_rad", SLAVES),
        ("sweep_rad", SLAVES),
        ("end_cnt", SLAVES),  # value of the wave at its end
        ("slope_cnt", SLAVES),  # of the base, over the whole move
        ("point_cnt", 3),  # centre of CIRCW and CIRCCW, mid point of TARC
        ("radius_scale", 3),  # of the axes of a circle: an ellipse
        ("pole_weight", POLES),
        ("arc_u", ARCS),  # length of a curve up to each eighth of its parameter
        "span",  # the path along a curve: its length, or its time
    ),
)

MASTER = HiddenBlock(
    prefix="MS",
    family="masters",
    count=16,
    doubles=(
        "acc_ups2",
        "dec_ups2",
        "stp_ups2",
        "jrk_ups3",
        "fvel_ups",
        "ivel_ups",
        ("vecdef", SLAVES),
        ("target_cnt", SLAVES),  # end of the last queued move, per slave
        "origin_u",  # path distance at which the present move begins
        "travel_u",  # distance of the path in completed moves (P8207)
        "section_u",  # path distance at which the present plan ends
        "entry_ups",  # speed and acceleration a replacing move (TRJ) is entered with
        "entry_ups2",
        "look_from_deg",  # LOOK ANG
        "look_to_deg",
        "look_cap_ups",  # highest speed that suits all junctions of the present plan, 0 none
        "look_exit_ups",  # speed at its end
        "pace",  # path time per time in the last tick
        "tang_deg",  # TANG ANG
        "tolerance_u",  # path tolerance of the moves to come (motion/path/corners.py)
        "corner_in_turn",
        "corner_in_ups",
        "corner_out_turn",
        "corner_out_ups",
        "corner_in_u",  # the rounded corner the path has passed, see kernel/path/corner_cy.py
        ("corner_in_cnt", SLAVES),
        "corner_out_u",  # the one ahead
        ("corner_out_cnt", SLAVES),
        "rotate_deg",  # ROTATE of programmed paths (motion/path/transform.py)
        ("rotate_center_u", 2),
        "stop_ups2",  # rate and jerk of a feed hold of a curve in time (kernel/path/timed_stop_cy)
        "stop_ups3",  # 0: not found yet, -1: as in any other move
        ("stop_now", 3),
        ("stop_accel", SLAVES),  # limits of the axes while it is sought, in pulses
        ("stop_jerk", SLAVES),
    ),
    ints=(
        "program",  # program that owns the master, -1 none
        ("slave_axis", SLAVES),  # axis of each slave, -1 none
        "first",  # record at ring index 0
        "size",  # records in the ring
        "head",  # ring index of the present move
        "queued",  # moves in the ring, the present one included
        "depth",  # moves that may wait after the present one
        "moving",  # the move at the head has begun
        "hold",  # 0 none, 1 feedholding, 2 in feedhold
        "drop_at_rest",  # HALT: drop all moves once the path has stopped
        "seek_phase",  # of MSEEK, see kernel/path/seek_cy.py
        "cut",  # the present move ends where it comes to rest, or is to: see interrupt_cy
        "response",  # ticks until INT polls its flag again
        "hsint_phase",  # see kernel/path/hsint_cy.py
        "section_cnt",  # moves the present plan runs through, the present one included
        "look_dirty",  # the buffer has changed: look ahead again
        "trigger",  # TRG for the next move to be issued, as in the move
        "trigger_axis",
        "room_below",  # moves in the ring below which waiting binary moves find room
        "manner",  # of the present move: what speed is not carried over from or to
        "paced",  # path time is not simply time: another source, or TOV
        "tang_axis",  # TANG: axis + 1
        "invk_program",  # INVK: program + 1 that computes the joints
        "invk_moving",  # In Motion when the joints were last computed
        "rounding",  # some corners are rounded: plans end within moves (kernel/path/round_cy.py)
        "piece",  # the present plan ends within the present move
        "corner_next",  # record + 1 that leaves the corner just passed
        "corner_smooth_in",  # the corners are rounded for a jerk limit
        "corner_smooth_out",
        "sync_go",  # SYNC: the move at the head may begin
        "sync_start",  # SYNC MDI: a cycle start has arrived
        "final_zero",  # FVEL Zero Active as the present plan knows it
        "step_go",  # STEP in block mode: one move may begin in spite of Start Move Inhibit
        ("rotate_slave", 2),  # the plane of ROTATE
    ),
    ranges={
        "program": (-1, 15),
        "slave_axis": (-1, 15),
        "first": (0, MOVES - 1),
        "size": (1, MOVES),
        "head": (0, MOVES - 1),
        "queued": (0, MOVES),
        "section_cnt": (0, MOVES),
        "trigger": (-17664, 17664),
        "trigger_axis": (0, SLAVES),
        "tang_axis": (0, SLAVES),
        "invk_program": (0, 16),
        "corner_next": (0, MOVES),
        "rotate_slave": (0, SLAVES - 1),
    },
)

# What SPLINE and NURB have been given and cannot follow yet (motion/path/splines.py).
CURVE_POINTS = HiddenBlock(
    prefix="CP",
    family="curve_points",
    count=16,
    doubles=(
        ("point_cnt", POINTS * SLAVES),
        ("weight", POINTS),
        ("knot", KNOTS),  # NURB: knots; SPLINE: time of the move to each point
        ("tangent_cps", SLAVES),  # SPLINE: at the beginning of the next move
    ),
    ints=(
        "slaves",  # mask of the slaves of the curve
        "points",
        "knots",
        "points_before",  # SPLINE: points before the beginning of the next move
        "rank",  # NURB: 0 the usual one
        "open",  # moves have been handed over and more will follow
        "live",  # flags of a curve are to be kept true
    ),
    ranges={
        "slaves": (0, 0xFFFF),
        "points": (0, POINTS),
        "knots": (0, KNOTS),
        "points_before": (0, POINTS),
        "rank": (0, POLES),
    },
)
