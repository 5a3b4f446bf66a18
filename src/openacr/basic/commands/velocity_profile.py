"""Velocity profile: the ramps, speeds and overrides of a master."""

from __future__ import annotations

from openacr.basic.commands.value_commands import Value, master_values, value_elsewhere
from openacr.map.numbers import (
    MA_FEEDRATE_OVERRIDE,
    MA_MANUAL_VECTOR,
    MA_RAPID_FEEDRATE_OVERRIDE,
    MA_USER_VELOCITY,
    MSF_ACC_UPS2,
    MSF_DEC_UPS2,
    MSF_FVEL_UPS,
    MSF_IVEL_UPS,
    MSF_JRK_UPS3,
    MSF_STP_UPS2,
)
from openacr.motion.axis.settings import of_master, of_master_real, vector_weight

GROUP = "Velocity Profile"
REF = "PG Velocity Profile"
PER_MINUTE = 60.0

VELOCITY = of_master(MA_USER_VELOCITY)

master_values(
    (
        Value("ACC", of_master_real(MSF_ACC_UPS2),
              "Set the acceleration of moves; 0 is no ramp.", "units/s2", "20000"),
        Value("DEC", of_master_real(MSF_DEC_UPS2),
              "Set the ramp to a lower speed inside a path; 0 is no ramp.", "units/s2", "20000"),
        Value("STP", of_master_real(MSF_STP_UPS2),
              "Set the ramp at the end of a move; 0 merges it with the next.", "units/s2", "20000"),
        Value("JRK", of_master_real(MSF_JRK_UPS3),
              "Set the jerk of all ramps; 0 makes them straight.", "units/s3"),
        Value("VEL", VELOCITY, "Set the speed of moves.", "units/s", "10000"),
        Value("F", VELOCITY,
              "Set the speed of moves per minute.", "units/min", "600000", factor=PER_MINUTE),
        Value("FVEL", of_master_real(MSF_FVEL_UPS),
              "Set the speed to which the end ramp of a move slows down.", "units/s"),
        Value("IVEL", of_master_real(MSF_IVEL_UPS),
              "Set the speed with which a move from rest begins.", "units/s"),
        Value("FOV", of_master(MA_FEEDRATE_OVERRIDE),
              "Scale the speed of feed moves at once.", "", "1", saved=False),
        Value("ROV", of_master(MA_RAPID_FEEDRATE_OVERRIDE),
              "Scale the speed of rapid moves at once.", "", "1", saved=False),
        Value("VECTOR", of_master(MA_MANUAL_VECTOR),
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
