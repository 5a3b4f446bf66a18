"""The moves that are known, with the speeds that they end with (`planning_cy`)."""

from collections import deque
from collections.abc import Iterator
from typing import Generic, NamedTuple, TypeVar

from msgspec import Struct

from openacr.cnc.canonical import PathMode
from openacr.cnc.rows.room import doubles, integers
from openacr.compiled import pick
from openacr.errors import UserError
from openacr.mill.config.tabs import Speeds
from openacr.mill.plan.moves import move_rows_cy as row
from openacr.mill.plan.moves import planning_cy as core
from openacr.mill.plan.moves.geometry import Direction
from openacr.mill.plan.moves.phases import Phases, even
from openacr.views import F64

ROOM = 64  # moves there is room for at first
MODES = {PathMode.EXACT: core.EXACT, PathMode.CORNER: core.CORNER}
PASSES = 0.0  # corners at the feed
_add = pick(core.queue_add)
_ahead = pick(core.queue_ahead)
_drop = pick(core.queue_drop)
_speeds = pick(core.queue_speeds)
_travel = pick(core.queue_travel)


class CornerRules(Struct, frozen=True):
    """Corner settings of the CONTROL and SPEEDS tabs; speeds in units/s."""

    angle1_deg: float = 0.0
    angle2_deg: float = 0.0
    slowest_ups: float = 0.0
    step_ups: float = 0.0  # largest velocity step of one axis, 0 = any

    @classmethod
    def of(cls, speeds: Speeds) -> "CornerRules":
        """The rules of a machine."""
        return cls(speeds.angle1_deg, speeds.angle2_deg, speeds.corner_ups, speeds.corner_step_ups)

    def __post_init__(self) -> None:
        if self.angle2_deg and self.angle2_deg < self.angle1_deg:
            raise UserError(
                f"Acute Angle2 {self.angle2_deg} is below Acute Angle1 {self.angle1_deg}"
            )

    def put(self, X: F64) -> None:
        """Write them where the core reads them."""
        X[core.X_ANGLE1_DEG], X[core.X_ANGLE2_DEG] = self.angle1_deg, self.angle2_deg
        X[core.X_SLOWEST_UPS], X[core.X_STEP_UPS] = self.slowest_ups, self.step_ups


class Corner(NamedTuple):
    """A rounded corner, in the order of `move_rows_cy`."""

    turn: float  # length of the difference of the two unit tangents
    reach_u: float
    cap_ups: float
    ramp_ups2: float  # of the weaker of the two moves


class PlannedMove(Struct, kw_only=True):
    """One move in the planner; `start`/`end` are None where no linear axis moves."""

    length_u: float
    feed_ups: float
    ramp_ups2: float
    start: Direction | None
    end: Direction | None
    turns: Direction = ()  # what rotary axes turn by length, a degree as a length
    mode: PathMode = PathMode.FREE
    is_rapid: bool = False
    tolerance_u: float = 0.0  # of the corner at its end, towards another move with one
    is_joined: bool = False  # rounded into the next move by the card
    corner: Corner | None = None  # rounded corner at its end; None is straight on
    exit_ups: float = 0.0  # speed at its end


Moves = TypeVar("Moves", bound=PlannedMove)


def put(Q: F64, q: int, move: PlannedMove) -> None:
    """Write what the core plans of a move to the row at `q`."""
    Q[q + row.Q_LENGTH_U], Q[q + row.Q_FEED_UPS] = move.length_u, move.feed_ups
    Q[q + row.Q_RAMP_UPS2], Q[q + row.Q_TOLERANCE_U] = move.ramp_ups2, move.tolerance_u
    Q[q + row.Q_MODE] = MODES.get(move.mode, PASSES)
    Q[q + row.Q_IS_RAPID] = move.is_rapid
    Q[q + row.Q_HAS_TANGENT] = move.start is not None
    for first, numbers in (
        (row.Q_START, move.start or ()),
        (row.Q_END, move.end or ()),
        (row.Q_TURNS, move.turns),
    ):
        for k, number in enumerate(numbers, q + first):
            Q[k] = number


class Planner(Generic[Moves]):
    """Queue of moves that plans the end speed of each."""

    def __init__(self, rules: CornerRules, least_ahead: int = 0) -> None:
        self._moves: deque[Moves] = deque()
        self._J, self._X = integers(core.J_PLAN), doubles(core.X_PLAN)
        self._Q, self._B = doubles(ROOM * row.Q_SIZE), doubles(ROOM)
        self._J[core.J_LEAST] = least_ahead
        rules.put(self._X)

    def __len__(self) -> int:
        return len(self._moves)

    def __iter__(self) -> Iterator[Moves]:
        return iter(self._moves)

    def add(self, move: Moves) -> None:
        """Append a move."""
        end = self._J[core.J_HEAD] + self._J[core.J_COUNT]
        if end == len(self._B):
            self._Q, self._B = _doubled(self._Q), _doubled(self._B)
        put(self._Q, end * row.Q_SIZE, move)
        _add(self._J, self._X, self._Q, self._B)
        self._moves.append(move)

    def ready(self) -> int:
        """The count of moves that may be sent although more will follow."""
        return len(self._moves) - _ahead(self._J, self._Q, self._B) if self._moves else 0

    def release(self, room: int, *, is_complete: bool) -> Iterator[Moves]:
        """Remove and yield at most `room` moves that may be sent now.

        `is_complete`: no move follows for the moment; the last one ends at rest, and all may
        be sent.
        """
        if not self._moves or room <= 0:
            return
        _speeds(self._J, self._X, self._Q)
        count = len(self._moves) if is_complete else self.ready()
        for _ in range(min(room, count)):
            yield self._pop_first()

    def _pop_first(self) -> Moves:
        """Remove the first move, with what was planned of it."""
        move, Q, q = self._moves.popleft(), self._Q, self._J[core.J_HEAD] * row.Q_SIZE
        move.exit_ups, move.is_joined = Q[q + row.Q_EXIT_UPS], Q[q + row.Q_IS_JOINED] > 0.0
        is_round, *corner = Q[q + row.Q_ROUND : q + row.Q_SIZE]
        move.corner = Corner(*corner) if is_round else None
        _drop(self._J, Q, self._B, 1)
        return move

    def clear(self) -> list[Moves]:
        """Remove and return all moves."""
        moves = list(self._moves)
        self._moves.clear()
        self._J[core.J_HEAD] = self._J[core.J_COUNT] = 0
        self._J[core.J_BRAKE_HEAD] = self._J[core.J_BRAKE_END] = 0
        return moves


class Ramps:
    """The motion of planned moves, each from the speed the one before it ends with."""

    def __init__(self) -> None:
        self._X, self._Q = doubles(core.X_PLAN), doubles(row.Q_SIZE)

    def travel(self, move: PlannedMove) -> Phases:
        """The phases of a move that was released."""
        X, Q, corner = self._X, self._Q, move.corner
        put(Q, 0, move)
        Q[row.Q_EXIT_UPS], Q[row.Q_ROUND] = move.exit_ups, corner is not None
        for k, number in enumerate(corner or (), row.Q_ROUND + row.K_TURN):
            Q[k] = number
        ends = range(core.X_PHASES, core.X_PHASES + _travel(X, Q, 0) * core.PHASE, core.PHASE)
        return [even(*X[n : n + core.PHASE]) for n in ends]


def _doubled(numbers: F64) -> F64:
    """The same numbers with twice the room."""
    found = doubles(2 * len(numbers))
    found[: len(numbers)] = numbers
    return found
