"""Sending of moves to the card, each with the jerk limit that its axes need.

A packet has speed and ramp of a move, but no jerk: a move takes the one its master has when it
arrives (JRK). Moves with another one than every axis keeps are sent between two commands.
"""

from collections.abc import Iterable
from itertools import groupby
from operator import itemgetter

from openacr.mill.card.driver import MachineDriver
from openacr.mill.plan.moves.encoding import Encoder, Job
from openacr.mill.run.tracking import Tracker


def send(machine: MachineDriver, encoder: Encoder, tracker: Tracker, jobs: Iterable[Job]) -> int:
    """Send moves and track them; the count of packets."""
    packets = []
    for job in jobs:
        packet = encoder.packet(job)
        tracker.add(job, has_packet=packet is not None)
        if packet is not None:
            packets.append((job.jerk_ups3, packet))
    present = encoder.jerk_ups3
    for jerk_ups3, group in groupby(packets, itemgetter(0)):
        if jerk_ups3 != present:
            machine.limit_jerk(jerk_ups3)
            present = jerk_ups3
        machine.send(packet for _, packet in group)
    if present != encoder.jerk_ups3:
        machine.limit_jerk(encoder.jerk_ups3)
    return len(packets)
