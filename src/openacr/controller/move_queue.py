"""Binary moves that have arrived and wait for room in the buffer of their master.

Move packets are not answered, so none may be lost: moves that do not fit wait here in order
of arrival, and the engine returns in the tick in which a buffer has room again. While MOST
moves of a master wait, the streams that sent some of them are not read: their transport
holds these senders back, and no others. Until then packets and control keys that arrive
after waiting moves act at once. A refused move (killed, at a limit) discards the moves
that follow it, since they would start from the wrong position.
"""

import logging
from collections import deque
from collections.abc import Iterator

from openacr.errors import CardError
from openacr.map.rows import kernel, masters
from openacr.motion.card import Card
from openacr.motion.interlocks import scale_of
from openacr.motion.path import curve_moves, host_moves, moves
from openacr.motion.path.curve_modes import Family
from openacr.motion.path.host_moves import Arc, HostMove, HostPoint
from openacr.motion.path.move_request import Direction
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code1, Curve
from openacr.protocol.packets import PacketError

log = logging.getLogger(__name__)
MOST = 1024
_FAMILIES = {Curve.NURB: Family.NURB, Curve.SPLINE: Family.SPLINE}
_WAITING = kernel.moves_waiting


class MoveQueue:
    """The waiting moves of all masters."""

    def __init__(self, card: Card) -> None:
        self._card = card
        self._waiting: dict[int, deque[Move]] = {}

    def is_full(self, master: int) -> bool:
        """Whether senders of moves for a master have to be held back."""
        return len(self._waiting.get(master, ())) >= MOST

    def add(self, move: Move) -> None:
        """Issue a move, after those already waiting."""
        if move.master not in self._waiting and self._has_room(move):
            try:
                self._make(move)
            except (CardError, PacketError) as refused:
                log.debug("master %d: %s", move.master, refused)
            return
        self._waiting.setdefault(move.master, deque()).append(move)
        self._issue(move.master)

    def drain(self) -> None:
        """Issue the moves that now have room."""
        for master in list(self._waiting):
            self._issue(master)

    def _issue(self, master: int) -> None:
        waiting = self._waiting[master]
        try:
            while waiting and self._has_room(waiting[0]):
                self._make(waiting.popleft())
        except (CardError, PacketError) as refused:
            log.debug("master %d: %s; %d later moves dropped", master, refused, len(waiting))
            waiting.clear()
        if not waiting:
            del self._waiting[master]
        self._note()

    def _make(self, move: Move) -> None:
        if move.header.curve in _FAMILIES:
            host_moves.take_point(self._card, _host_point(self._card, move))
        else:
            host_moves.issue(self._card, _host_move(self._card, move))

    def _has_room(self, move: Move) -> bool:
        if move.master >= self._card.model.masters:
            return True  # no reason to wait: it will be refused
        row, limit = self._room(move)
        return self._card.memory.I[row] < limit

    def _room(self, move: Move) -> tuple[int, int]:
        """Row in I, and the value below which it must stay, for a move to have room."""
        if move.header.curve in _FAMILIES:
            return curve_moves.room_row(self._card, move.master, curve_moves.MOST)
        return moves.room_row(self._card, move.master)

    def _note(self) -> None:
        """Set for which masters the engine has to report room, and how much."""
        rows = self._card.memory.I
        rows[_WAITING] = sum(1 << master for master in self._waiting)
        for master, waiting in self._waiting.items():
            rows[masters.room_below[master]] = self._room(waiting[0])[1]

    def clear(self) -> None:
        """Discard all waiting moves, as at power-up."""
        self._waiting.clear()
        self._note()

    def state(self) -> list[bytes]:
        """The waiting moves, for a snapshot."""
        return [move.encode() for waiting in self._waiting.values() for move in waiting]

    def restore(self, state: list[bytes]) -> None:
        """Restore what `state` returned."""
        self._waiting.clear()
        for data in state:
            move = Move.decode(data)
            self._waiting.setdefault(move.master, deque()).append(move)
        self._note()


def _host_move(card: Card, move: Move) -> HostMove:
    """The move a packet requests of a card in its present mode."""
    profile = move.profile(host_moves.has_rapid_modes(card, move.master))
    return HostMove(
        master=move.master,
        targets_cnt=dict(_pulses(card, move, move.targets)),
        relative=move.header.is_relative,
        arc=_arc(card, move) if move.header.curve is Curve.ARC else None,
        vel_ups=move.vel,
        acc_ups2=move.acc,
        fvel_ups=move.fvel,
        stop_ramp=profile.stop_ramp,
        final_velocity_zero=profile.final_velocity_zero,
        rapid=profile.rapid,
        override_locked=profile.override_locked,
        count=move.header.counter_step,
        interrupt=move.header.interrupts,
        block_skip=move.header.is_block_skip,
        tolerance_u=move.tolerance,
    )


def _host_point(card: Card, move: Move) -> HostPoint:
    """A point of a curve: the first scaling field is its knot, the second a NURB's weight."""
    knot, weight = move.scaling or (None, None)
    is_nurb = move.header.curve is Curve.NURB
    profile = move.profile(host_moves.has_rapid_modes(card, move.master))
    if not is_nurb and not move.code1 & Code1.SPLINE_KNOTS:
        knot = None
    return HostPoint(
        master=move.master,
        family=_FAMILIES[move.header.curve],
        targets_cnt=dict(_pulses(card, move, move.targets)),
        relative=move.header.is_relative,
        knot=knot,
        weight=weight if is_nurb and move.targets else None,
        vel_ups=move.vel,
        acc_ups2=move.acc,
        fvel_ups=move.fvel,
        override_locked=profile.override_locked,
        count=move.header.counter_step,
    )


def _pulses(
    card: Card, move: Move, values: tuple[tuple[int, int | float], ...]
) -> Iterator[tuple[int, float]]:
    """A value in pulses: integers are pulses, floats are units of the slave's axis."""
    for slave, value in values:
        axis = host_moves.slave_axis(card, move.master, slave)
        yield slave, value * (scale_of(card, axis) if isinstance(value, float) else 1.0)


def _arc(card: Card, move: Move) -> Arc:
    if move.centers is None:
        raise PacketError("the packet of an arc has no centers")
    slaves = move.arc_slaves
    pair = ((slaves[0], move.centers[0]), (slaves[1], move.centers[1]))
    center = [value for _, value in _pulses(card, move, pair)]
    return Arc(
        slaves,
        (center[0], center[1]),
        Direction.COUNTER_CLOCKWISE if move.header.is_counterclockwise else Direction.CLOCKWISE,
        relative_center=move.header.has_relative_center,
        radius_scale=move.scaling or (1.0, 1.0),
    )
