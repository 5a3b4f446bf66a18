"""Velocity profile: the ramps, speeds and overrides of a master."""

from __future__ import annotations

from openacr.basic.commands.value_commands import Value, master_values, value_elsewhere
from openacr.map.rows import masters
from openacr.motion.axis.settings import fp32, fp64, not_negative, vector_weight

GROUP = "Velocity Profile"
REF = "PG Velocity Profile"
PER_MINUTE = 60.0

VELOCITY = fp32(masters.user_velocity, not_negative)

master_values(
    (
        Value("ACC", fp64(masters.acc_ups2, not_negative),
              "Set the acceleration of moves; 0 is no ramp.", "units/s2", "20000"),
        Value("DEC", fp64(masters.dec_ups2, not_negative),
              "Set the ramp to a lower speed inside a path; 0 is no ramp.", "units/s2", "20000"),
        Value("STP", fp64(masters.stp_ups2, not_negative),
              "Set the ramp at the end of a move; 0 merges it with the next.", "units/s2", "20000"),
        Value("JRK", fp64(masters.jrk_ups3, not_negative),
              "Set the jerk of all ramps; 0 makes them straight.", "units/s3"),
        Value("VEL", VELOCITY, "Set the speed of moves.", "units/s", "10000"),
        Value("F", VELOCITY,
              "Set the speed of moves per minute.", "units/min", "600000", factor=PER_MINUTE),
        Value("FVEL", fp64(masters.fvel_ups, not_negative),
              "Set the speed to which the end ramp of a move slows down.", "units/s"),
        Value("IVEL", fp64(masters.ivel_ups, not_negative),
              "Set the speed with which a move from rest begins.", "units/s"),
        Value("FOV", fp32(masters.feedrate_override, not_negative),
              "Scale the speed of feed moves at once.", "", "1", saved=False),
        Value("ROV", fp32(masters.rapid_feedrate_override, not_negative),
              "Scale the speed of rapid moves at once.", "", "1", saved=False),
        Value("VECTOR", fp32(masters.manual_vector, not_negative),
              "Set the length of moves all of whose axes have weight 0.", "units"),
    ),
    group=GROUP,
    ref=REF,
)  # fmt: skip


value_elsewhere(
    "VECDEF",
    vector_weight,
    "Set the weight of axes in the length of a move; 0 leaves an axis out.",
    default="1",
    group=GROUP,
    ref=REF,
)
