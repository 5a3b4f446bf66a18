"""Ramps of moves that the card limits in jerk: planned by the profile of the card itself.

A move begins with the speed and the acceleration of the one before it. The card brakes to the
final velocity a move is sent with, 0 for the last one before a stop; one that is sent without has
no end ramp. Where a speed just fits its end the last bit decides, so the numbers are those of
packets: floats of 32 bits, and lengths between whole pulses.
"""

import struct

from openacr.compiled import pick
from openacr.kernel.profile import profile_cy
from openacr.map.memory import Memory
from openacr.map.rows import profiles
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.plan.moves.phases import Phase, Phases

_plan = pick(profile_cy.profile_plan)
_reset = pick(profile_cy.profile_reset)
PROFILE = 0
SENT = struct.Struct("fff")


class JerkRamps:
    """Plans moves one after the other, each from the state the one before it ends with."""

    def __init__(self, encoder: Encoder) -> None:
        self._encoder = encoder
        self._memory = Memory()
        self._speed_ups = self._accel_ups2 = 0.0  # at the end of the last move

    def travel(self, job: Job) -> Phases:
        """The phases of a move."""
        F, ints, n = self._memory.F, self._memory.I, PROFILE
        length_u = self._encoder.sent_length_u(job)
        if length_u <= 0.0:  # within a pulse: it is not sent
            return [Phase(job.length_u, self._speed_ups, self._speed_ups, 0.0)]
        feed, ends, ramp = SENT.unpack(SENT.pack(job.feed_ups, job.exit_ups, job.ramp_ups2))
        stop_ramp = 0.0 if job.exit_ups >= job.feed_ups else ramp
        _reset(F, ints, n, self._speed_ups, self._accel_ups2)
        _plan(F, ints, n, length_u, feed, ends, ramp, ramp, stop_ramp, job.jerk_ups3)
        self._speed_ups = F[profiles.end_velocity[n]]
        self._accel_ups2 = F[profiles.plan_accel[n]]
        count = ints[profiles.seg_count[n]]
        places = [F[profiles.seg_distance[n] + k] for k in range(count)] + [length_u]
        speeds = [F[profiles.seg_velocity[n] + k] for k in range(count)] + [self._speed_ups]
        return [
            Phase(
                places[k + 1] - places[k],
                speeds[k],
                speeds[k + 1],
                F[profiles.seg_time_s[n] + k],
                F[profiles.seg_jerk[n] + k],
            )
            for k in range(count)
        ]
