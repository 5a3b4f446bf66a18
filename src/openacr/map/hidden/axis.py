"""Hidden rows of axes, and of the encoders and stepper outputs that they use."""

from openacr.map.hidden.block import FINITE, HiddenBlock, Merge
from openacr.map.hidden.path import SLAVES

AXIS = HiddenBlock(
    prefix="AX",
    family="axes",
    count=16,
    merged={
        Merge.SHIFT: (
            "position_cnt",
            "gear_cnt",
            "jog_cnt",
            "cam_cnt",
            "ballscrew_cnt",
            "backlash_cnt",
            "kinematics_cnt",
            "joint_cnt",
            "seen_cnt",
            "psp_cnt",
            "ssp_cnt",
            "ssp_old_cnt",
            "jog_origin_cnt",
            "folded_cnt",
        ),
    },
    doubles=(
        "position_cnt",  # coordinated position
        "gear_cnt",
        "jog_cnt",
        "cam_cnt",
        "ballscrew_cnt",
        "backlash_cnt",
        "kinematics_cnt",  # INVK: joint position minus coordinated position
        "joint_cnt",  # INVK: joint position before the master has gone on
        "seen_cnt",  # INVK: coordinated position for which the joints are known
        "psp_cnt",
        "ssp_cnt",
        "ssp_old_cnt",
        "psp_velocity_cps",
        "ssp_velocity_cps",
        "ssp_accel_cps2",
        "target_cnt",  # target of the coordinated profiler
        "jog_target_cnt",
        "jog_origin_cnt",  # jog offset where the present jog plan started
        "folded_cnt",  # jog offset that JOG RES has taken into a path that is held
        "hldec_ups2",
        "sldec_ups2",
        "slm_plus_u",
        "slm_minus_u",
        "homvf_ups",
        "home_edge_cnt",
        "capture_cnt",
        "integral_v",
        "derivative_v",  # filtered slope of the error, before DGAIN
        "derivative_sum",
        ("derivative_history", 32),
        "error_old_cnt",
        "idle_s",  # time since the last commanded motion
        ("filter_state", 4),
        "lopass_hz",
        "notch_hz",
        "notch_width_hz",
        "rotary_u",
        "peak_velocity_cps",
        "peak_error_cnt",
        "travel_cnt",
        "velocity_sum_cnt",
        ("velocity_window_cnt", 64),
        "cam_smoothing_cps",  # smoothed minus actual speed of the cam, for the feed-forward
        "offset_u",  # OFFSET, FLZ and SCALE of programmed paths (motion/path/transform.py)
        "flz_u",
        "scale",
        "scale_center_u",
        "pm_band_u",  # PM, see kernel/axis/maintain_cy.py
        "pm_vel_ups",
        "pm_acc_ups2",
        "pm_time_s",
        "pm_off_s",  # how long the axis has been off
        "pm_cnt",  # steps put out beyond the setpoint
        "pm_from_cnt",  # the same when the present correction began
    ),
    ints=(
        "on",
        "backlash_by_direction",  # BKL DIR: 1 while the axis travels forward, 0 by its sign
        "master",  # -1 none
        "slave",
        "position_source",  # see kernel/axis/feedback_cy.py
        "position_index",
        "position_offset",  # of an ADC, set by RES
        "signal_source",
        "signal_index",
        "velocity_source",
        "velocity_index",
        "hlbit",
        "jog_mode",  # see kernel/jog/jog_cy.py
        "jog_sign",  # direction in which the jog profile counts
        "jog_want",  # direction of a continuous jog
        "jog_replan",
        "jog_turning",  # slowing down first, to turn round
        "pm_on",
        "pm_sign",  # direction of the present correction
        "kamr_old",
        "soft_old",
        "home_state",  # see kernel/jog/homing_cy.py
        "home_search",  # direction of the search
        "home_moving",  # direction of the present motion
        "home_reversed",  # a limit has turned the search round
        "home_input_old",
        "home_limit_hit",
        "capture_mode",  # -1 not armed
        "capture_copy",  # parameter that receives a copy, 0 none
        "enable_ticks",  # until the drive reports enabled, 0 idle
        "drive_old",
        "drive_seen",  # quaternary flags after the last step of the drive
        "drive_wired",  # position feedback then, -1: step in any case
        "switched_off",  # the drive was disabled at least once since power-up
        "feedback_broken",  # an encoder of the axis had a signal fault at the last look
        "drive_motor",  # motor of the world that the drive belongs to, -1 none
        "reset_ticks",
        "window_index",
        "window_count",
        "derivative_ticks",
        "derivative_index",
        "derivative_smooth",  # slopes averaged, 0 or 1 none
        "clipped",  # the torque limit acted in the last tick
        "shown_current",
        "shown_target",
        "shown_actual",
        "shown_gear",
        "shown_jog",
        "shown_cam",
        "shown_ballscrew",
        "changing",  # the shown positions could change in the latest tick
        "show_due",  # they have been put off until they are read
    ),
    ranges={
        "master": (-1, 15),
        "slave": (0, SLAVES - 1),
        "capture_copy": (0, 40959),
        "show_due": (0, 0),
        "drive_motor": (-1, 15),
        "window_index": (0, 63),
        "window_count": (0, 64),
        "derivative_index": (0, 31),
        "derivative_smooth": (0, 32),
        "signal_index": (0, 15),
        "home_state": (0, 255),
        "jog_mode": (0, 255),
    },
)

ENCODER = HiddenBlock(
    prefix="EN",
    family="encoders",
    count=24,
    doubles=(
        "raw_old_cnt",
        "partial_cnt",  # fraction of a count that MULT below 4 has left
        "step_cnt",  # counted in the last tick
    ),
    ints=(
        "mult",
        "source",
        "locked_to",  # 1 + the encoder whose counts are added; 0 none
        "seen",  # position of that encoder in the last tick
        "destination",  # parameter that gets the position; 0 none
    ),
    usual=FINITE,
    ranges={
        "locked_to": (0, 24),
        "destination": (0, 40959),
    },
)

# What few encoders need, apart from the rows that every tick reads.
ENCODER_EXTRA = HiddenBlock(
    prefix="ENX",
    family="encoders",
    is_whole=False,
    count=24,
    doubles=(
        "filter_old_cnt",  # LIMIT: raw count of the last tick
        "filter_level_cnt",  # raw count whose signals have passed the filter last
        "passed_cnt",  # edges that have passed in the last tick
        "filter_since_s",  # since the last edge
    ),
    ints=(
        "rotary",  # length of a turn, 0 linear
        "turned",  # what the wraps of ROTARY have taken off the position
        "shaft",  # what wraps and presets have taken off since power-up
        "limit_hz",  # quickest edges that count, 0 all
        "clock_hz",  # of the serial interface of an absolute encoder
        "width",  # its bits
    ),
)

# A stepper output: what goes to the drive, whatever its count is made.
STEPPER_OUTPUT = HiddenBlock(
    prefix="STO",
    family="stepper_outputs",
    count=16,
    doubles=(
        "pulses",  # since power-up
        "sent_cnt",  # the same before it is rounded
        "pm_old_cnt",
    ),
)
