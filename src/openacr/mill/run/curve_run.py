"""A planned curve on the card: its control points are sent as time passes, a few ahead.

Overrides act here, on the time of the plan, because the card only runs through its curve. On the
virtual machine, which cannot lose its host, so do feed holds, and little is sent ahead: it is what
they have to wait for. Over a link the card holds the feed itself, and its watchdog holds it at the
last piece from which the card comes to rest on what it has (`Reserve`). That number follows the
points it belongs to on the same line, so it is never ahead of them; before the first one the curve
is barred from beginning. After a hold the path continues from where it rests, as after any other.
"""

import math
from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from openacr.mill.card.driver import CardState, MachineDriver
from openacr.mill.config.curves import PERIOD_S, can_plan
from openacr.mill.config.settings import Settings
from openacr.mill.plan.curves.curve_limits import (
    ON_THE_LINE,
    RAMPS,
    SPARE,
    accelerations,
    moves_needed,
)
from openacr.mill.plan.curves.curve_packets import COUNTED, LEAD, CurvePackets
from openacr.mill.plan.curves.curve_reserve import Reserve
from openacr.mill.plan.curves.curve_window import CurveWindow
from openacr.mill.plan.curves.planned_path import PlannedPath
from openacr.mill.plan.moves.encoding import Job
from openacr.mill.run.tracking import Tracker
from openacr.protocol.packets import Packet
from openacr.sysvar.tabs import SPEEDS
from openacr.trajectory.override.timescale import Progress

AHEAD_S = 0.38  # of the plan known ahead of the points that are sent, at least
AHEAD_LINK_S = 1.0  # planned ahead over a link, where the host may be late
SENT_NEXT_S = 0.06  # of it taken ahead of what has room on the card, while nothing slows down
SHORT = 0.6  # of what is wanted ahead left when a path that does not arrive is brought to rest
TAKEN = 4  # points of the plan at once: what is taken is not planned again
LATER = 1.5  # times the longest time between two polls that the host may be late by
FADES = 0.995  # of that time in every poll
BUFFERED_S = 0.04  # of the curve on the virtual machine
Rows = NDArray[np.float64]


class CurveRun:
    """Sends one curve after the other to a card."""

    def __init__(
        self, machine: MachineDriver, settings: Settings, tracker: Tracker, most: int
    ) -> None:
        self._machine = machine
        self._settings = settings
        self._tracker = tracker
        self._packets = CurvePackets(settings)
        guards = can_plan(settings) and not machine.rounds_corners
        self._reserve = Reserve(settings) if guards else None
        self._most = most
        self._before = 0  # packets sent before the curve
        self._hold_at = 0  # the move at which the watchdog holds
        self._is_barred = False  # the curve is on the card and may not begin
        self._polled_s = machine.now_s
        self._late_s = 0.0  # the longest time between two polls, fading
        self.jobs = 0  # moves begun
        self._path: PlannedPath | None = None
        self._window: CurveWindow | None = None
        self._is_begun = False  # the first packets of the curve are sent
        self._before_u = 0.0, 0.0  # the path at the two control points before the last one
        self._job: Job | None = None  # the last move begun
        self._ramp_ups2 = min(accelerations(settings))
        self._factors = (1.0, 1.0)
        self._planned_factor = 1.0  # the highest one that the present curve was planned with
        self._holds = False

    # --- commands -----------------------------------------------------------------------

    @property
    def is_begun(self) -> bool:
        """Whether a curve is on the card and not ended."""
        return self._is_begun

    def override(self, feed: float, rapid: float) -> None:
        """Set feed and rapid override, 1 = as programmed."""
        self._factors = (feed, rapid)

    def hold(self) -> bool:
        """Bring the curve to rest and hold the card there; False if none is on the card."""
        if not self._is_begun:
            self.drop()
            return False
        self._holds = True
        if self._reserve is not None:
            self._machine.hold()
            self._let_run()
        return True

    def drop(self) -> None:
        """Forget the curve: the card holds none of it, or has dropped it."""
        self._path = self._window = self._job = None
        self._is_begun = self._holds = self._is_barred = False
        self._planned_factor = 1.0
        if self._reserve is not None:
            self._let_run()
        self._packets = CurvePackets(self._settings)

    @property
    def depth(self) -> int:
        """Pieces of the curve that are to wait on the card."""
        if self._reserve is None:
            return math.ceil(BUFFERED_S / PERIOD_S)
        if not self._is_begun:
            return self._on_the_line
        reserved = self._tracker.sent - self._before - self._reserve.hold_at
        return min(reserved + self._on_the_line, self._most - SPARE)

    @property
    def _on_the_line(self) -> int:
        """Pieces that the card may run before the host sends more: more where it has been late."""
        return max(ON_THE_LINE, math.ceil(LATER * self._late_s / PERIOD_S))

    def _let_run(self) -> None:
        """Let the watchdog hold at no move: the card holds already, or has nothing to hold."""
        self._hold_at = 0
        self._machine.let_run()

    @property
    def lack(self) -> str:
        """Why no curve may begin: the card could not come to rest on it without its host.

        It would stop dead at the end of what it has as soon as the host is late.
        """
        if self._reserve is None:
            return ""
        needed = moves_needed(self._settings)
        if self._most >= needed:
            return ""
        program = self._settings.master
        return (
            f"a path with a tolerance and a jerk limit needs a buffer of {needed} moves, that of"
            f" the card has {self._most}: give program {program} more memory in the set-up of the"
            f" card (DIM PROG{program}), lower the highest speed (P{SPEEDS.max_machine_speed}), or"
            f" do without a jerk limit (P{SPEEDS.path_jerk} = 0)"
        )

    # --- planning -----------------------------------------------------------------------

    def plan(self, path: PlannedPath, *, is_complete: bool, is_starved: bool) -> None:
        """Plan ahead; the curve begins with the next poll."""
        if self._holds or (self._window is not None and self._window.scale.is_complete):
            return  # what has arrived meanwhile begins another curve
        wanted_s = self._wanted_s if self._reserve is None else AHEAD_LINK_S
        if is_complete or (is_starved and self._ahead_s + path.ready_s < SHORT * wanted_s):
            path.stop()
        self._take(path)
        if self._reserve is not None:
            is_at_rest = not self._is_begun or self._is_barred
            while path.prepare(AHEAD_LINK_S - self._ahead_s) and is_at_rest:
                pass

    def _take(self, path: PlannedPath) -> None:
        """Take from the plan what is wanted of it now."""
        factor = max(self._factors[0], 1.0)
        self._planned_factor = max(self._planned_factor, factor)
        path.override(factor)
        while self._ahead_s < self._wanted_s and (found := path.take(TAKEN)) is not None:
            if self._window is None:
                self._path, self._window = path, CurveWindow(path.start, self._settings)
                self._before_u = 0.0, 0.0
                path.is_open = True
            self._window.append(found)
        window = self._window
        if window is not None and path.is_at_end and not window.scale.is_complete:
            window.complete()

    @property
    def _wanted_s(self) -> float:
        """How much of the plan is to be taken: what slows it down has its ramp in it.

        Over a link it is the card that holds. What is not taken is planned again where the
        feed rises, so nothing is taken there before it is sent, while no override slows down.
        """
        if self._reserve is not None and not self._slows:
            return max(self.depth - self._tracker.waiting, 0) * PERIOD_S + SENT_NEXT_S
        return max(AHEAD_S, RAMPS * self._window.stop_s) if self._window is not None else AHEAD_S

    @property
    def _slows(self) -> bool:
        """Whether the plan is, or is going to be, run at a lower scale of its time."""
        is_slow = self._window is not None and self._window.scale.scale < 1.0
        return is_slow or min(self._factors) < 1.0 or self._factors[0] < self._planned_factor

    @property
    def _ahead_s(self) -> float:
        return self._window.ahead_s if self._window is not None else 0.0

    # --- sending ------------------------------------------------------------------------

    def poll(self, sample: CardState) -> None:
        """Send what the card has room for; hold it where a hold has come to rest."""
        now_s = self._machine.now_s
        self._late_s = max(FADES * self._late_s, now_s - self._polled_s)
        self._polled_s = now_s
        if self._is_begun and (sample.is_killed or sample.may_have_lost):
            self._machine.hold()
            self.drop()  # a curve with missing points is not continued
        if self._holds and self._reserve is not None and self._is_begun:
            return  # the card holds; what it has of the curve is dropped and planned again
        if self._window is not None and (self._is_begun or self._tracker.is_at_end(sample)):
            packets = list(self._due())
            if packets:
                self._machine.send(packets)
        elif self._holds and self._tracker.is_at_end(sample):
            self._holds = False
            self._machine.hold()

    def _due(self) -> Iterator[Packet]:
        """What is to be sent now; over a link what a point needs may be further ones."""
        while (window := self._window) is not None:
            if self._path is not None and not self._holds and not window.scale.is_complete:
                self._take(self._path)
            packets = self._next_packets(window)
            yield from packets
            if self._reserve is None or not packets:
                break
        if self._reserve is not None:
            yield from self._released(self._reserve)

    def _released(self, reserve: Reserve) -> Iterator[Packet]:
        """How far the card may run on what it has got before; 0 where that ends at rest."""
        hold_at = self._before + max(reserve.hold_at, 1) if self._is_begun else 0
        is_enough = self._tracker.waiting >= self.depth or not self._is_begun
        if self._is_barred and not is_enough:
            return
        if hold_at != self._hold_at:
            self._hold_at = hold_at
            yield self._machine.holding_at(hold_at)
        if self._is_barred:
            self._is_barred = False
            yield self._machine.barring(False)

    def _next_packets(self, window: CurveWindow) -> list[Packet]:
        packets: list[Packet] = []
        progress = Progress.MOVES
        while progress is Progress.MOVES and self._tracker.waiting < self.depth:
            window.scale.want = self._want(window)
            progress, point = window.next()
            if progress is Progress.WAITS or (progress is Progress.HELD and not self._is_begun):
                break
            if not self._is_begun:
                self._begin(packets)
            if progress is not Progress.HELD:
                self._append(packets, point)
            self._note(window.path_u)
        if progress in (Progress.ENDED, Progress.HELD) and self._is_begun:
            self._finish(packets, point, has_ended=progress is Progress.ENDED)
        return packets

    def _want(self, window: CurveWindow) -> float:
        """The wanted scale of time for the present move, and for what is planned faster."""
        if self._holds:
            return 0.0
        job, (feed, rapid) = self._job, self._factors
        if job is None:
            return 1.0
        factor = rapid if job.is_rapid else feed / window.factor
        return min(max(factor, 0.0), 1.0)

    def _begin(self, packets: list[Packet]) -> None:
        """Begin the curve where the machine rests."""
        self._is_begun = True
        if self._reserve is not None:
            self._before = self._tracker.sent
            self._reserve.begin()
            self._is_barred = True
            packets.append(self._machine.barring(True))
        if self._path is not None:
            for _ in range(LEAD):
                self._append(packets, self._path.start)

    def _append(self, packets: list[Packet], point: Rows) -> None:
        packets.append(self._packets.point(point.tolist(), self._ramp_ups2))
        if self._reserve is not None:
            self._reserve.note(point)
        if self._packets.is_counted:
            self._tracker.add_packet()

    def _note(self, path_u: float) -> None:
        """Note the moves that begin in the piece of the last packet, which ends a point earlier.

        A card that holds by itself rests within a piece: there a move counts from the first piece
        that has nothing of the move before.
        """
        begin_u, end_u = self._before_u
        if self._packets.is_counted:
            self._begin_jobs(end_u if self._reserve is None else begin_u)
        self._before_u = end_u, path_u

    def _begin_jobs(self, path_u: float) -> None:
        if self._path is None:
            return
        for job in self._path.begun(path_u):
            self._tracker.add(job, has_packet=False)
            self._job = job
            self.jobs += 1

    def _finish(self, packets: list[Packet], point: Rows, *, has_ended: bool) -> None:
        """End the curve at rest, at a point that was sent three times."""
        while self._packets.count < COUNTED:
            self._append(packets, point)
        path = self._path
        if has_ended and path is not None and not path.fault:
            self._begin_jobs(path.planned_u)  # others that have arrived belong to the next curve
        packets.append(self._packets.end())
        self._tracker.add_packet()
        self._window = self._path = self._job = None
        self._is_begun = False
        self._planned_factor = 1.0
        if path is not None:
            path.end_at(point)
