"""Forecast of the run time of a program, many moves at a time: `Predictor` in the compiled core.

The moves and their speeds are the same. A desk, where there is one, gets as jobs only the moves
whose positions may be beyond something, and is asked nothing about the others.
"""

from __future__ import annotations

from array import array
from typing import TYPE_CHECKING, Protocol

from openacr.cnc import canonical as c
from openacr.cnc.reading.line_shapes import MOST_ROWS
from openacr.cnc.rows.room import doubles, integers
from openacr.compiled import pick
from openacr.mill.config.settings import S_PER_MIN
from openacr.mill.plan.estimate import forecast_cy as core
from openacr.mill.plan.estimate.predicting import Prediction, Timing
from openacr.mill.plan.moves import move_rows_cy as row
from openacr.mill.plan.moves import planning_cy as plan
from openacr.mill.plan.moves.move_law import put_machine
from openacr.mill.plan.moves.planning import MODES, PASSES, CornerRules, put

if TYPE_CHECKING:
    from openacr.cnc.canonical.batches import Origin
    from openacr.mill.config.settings import Settings
    from openacr.mill.plan.moves.encoding import Job, Motion
    from openacr.views import F64

MOST_PACES = 4096
_moves = pick(core.forecast_moves)
_add = pick(core.forecast_add)
_release = pick(core.forecast_release)
_close = pick(core.forecast_close)


class Desk(Protocol):
    """Observer of the moves whose positions have to be looked at."""

    @property
    def unhomed(self) -> int:
        """The mask of axes whose first move it is to see."""

    def read(self, job: Job) -> None:
        """Receive a move that is not planned yet."""

    def note_slow(self, cnt: int, first: c.Source, slowest: c.Source, share: float) -> None:
        """Receive the count of moves in chains below their feed, and what the slowest reaches."""


class Forecast(Timing):
    """Adds up the times of the moves of a program."""

    def __init__(
        self,
        settings: Settings,
        begin: c.Point,
        *,
        is_dry: bool = False,
        rounds: bool = True,
        desk: Desk | None = None,
    ) -> None:
        """`rounds`: as on the virtual machine, which supports path tolerances."""
        super().__init__(settings, begin, is_dry=is_dry, rounds=rounds)
        self._desk = desk
        self._files: list[str] = []
        self._known: dict[c.Pace, F64] = {}
        self._origins: tuple[Origin, ...] = ()  # those of the last moves, and their paces
        self._paces: tuple[c.Pace, ...] = ()
        self._paced = doubles(0)
        self._dwell_s = 0.0
        self._J, self._X = integers(core.J_FLAGS + MOST_ROWS), doubles(core.X_SIZE)
        self._Q, self._B = doubles(core.QUEUE * row.Q_SIZE), doubles(core.QUEUE)
        put_machine(self._J, self._X, settings, is_dry=is_dry)
        CornerRules.of(settings.speeds).put(self._X)
        self._J[plan.J_LEAST] = settings.forward_threshold

    @property
    def found(self) -> Prediction:
        """The times so far."""
        X = self._X
        return Prediction(
            X[core.X_RAPID_S], X[core.X_FEED_S], self._dwell_s, self._J[core.J_RELEASED]
        )

    def add(self, entry: c.Entry) -> None:
        """Add the next entry of the program."""
        if isinstance(entry, c.Moves) and self._encoder.runs_arcs:
            self._many(entry)
        else:
            super().add(entry)

    def rest(self, dwell_s: float = 0.0) -> None:
        """Add a stop with a dwell."""
        _release(self._J, self._X, self._Q, self._B, True)
        self._dwell_s += dwell_s

    def close(self) -> None:
        """The program has ended: tell the desk how slow it was."""
        self.rest()
        J, X = self._J, self._X
        _close(J, X)
        if self._desk is not None and J[core.J_SLOW_CNT]:
            first = self._source(X[core.X_FIRST_FILE], X[core.X_FIRST_LINE])
            slowest = self._source(X[core.X_WORST_FILE], X[core.X_WORST_LINE])
            self._desk.note_slow(J[core.J_SLOW_CNT], first, slowest, X[core.X_WORST_SHARE])

    def _source(self, file: float, line: float) -> c.Source:
        return c.Source(self._files[int(file)], int(line), "")

    def _file(self, name: str) -> int:
        """The number of a file."""
        if name not in self._files:
            self._files.append(name)
        return self._files.index(name)

    def _many(self, moves: c.Moves) -> None:
        """Plan moves; those that are flagged are shown to the desk."""
        J, X, count = self._J, self._X, len(moves)
        self._take_common(moves)
        J[row.J_UNHOMED] = self._desk.unhomed if self._desk else 0
        X[row.X_BEGIN_U : row.X_BEGIN_U + row.AXES] = array("d", self._position)
        J[core.J_ROWS] = count
        flagged = _moves(J, X, self._Q, self._B, moves.rows, moves.ends, moves.arcs, self._paced)
        if self._desk is not None:
            for k in J[core.J_FLAGS : core.J_FLAGS + flagged]:
                begin = moves.end_of(k - 1) if k else self._position
                self._desk.read(self._encoder.job(moves.entry(k), begin))
        self._position = moves.end_of(count - 1)

    def _take_common(self, moves: c.Moves) -> None:
        """The texts and paces of moves; those of lines that were executed together are the same."""
        if moves.origins is not self._origins:
            self._origins = moves.origins
            for k, origin in enumerate(moves.origins):
                self._J[core.J_FILES + k] = self._file(origin.file)
        if moves.paces is not self._paces:
            self._paces, size = moves.paces, core.PACE
            self._paced = doubles(len(moves.paces) * size)
            for k, pace in enumerate(moves.paces):
                self._paced[k * size : (k + 1) * size] = self._known.get(pace) or self._pace(pace)

    def _pace(self, pace: c.Pace) -> F64:
        """The row of a pace, remembered while there is room: most programs have few."""
        found = doubles(core.PACE)
        found[core.PACE_UPS] = self._encoder.line_speed(pace)
        mode = c.PathMode.EXACT if pace.is_confirmed else pace.mode
        found[core.PACE_MODE] = MODES.get(mode, PASSES)
        found[core.PACE_CORNER_U] = self._encoder.tolerance(pace)
        found[core.PACE_WANTED_UPS] = pace.feed_upm / S_PER_MIN
        if len(self._known) < MOST_PACES:
            self._known[pace] = found
        return found

    def _move(self, job: Job) -> None:
        """Plan a move that is a job already."""
        if self._desk is not None:
            self._desk.read(job)
        self._position = job.finish
        if job.length_u <= 0.0:
            return
        Q, entry = self._Q, job.entry
        q = (self._J[plan.J_HEAD] + self._J[plan.J_COUNT]) * row.Q_SIZE
        put(Q, q, job)
        Q[q + row.Q_WANTED_UPS] = _wanted(entry)
        Q[q + row.Q_LINE], Q[q + row.Q_FILE] = entry.source.line, self._file(entry.source.file)
        _add(self._J, self._X, Q, self._B)


def _wanted(entry: Motion) -> float:
    return 0.0 if isinstance(entry, c.Rapid) else entry.pace.feed_upm / S_PER_MIN
