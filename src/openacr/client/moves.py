"""Stream binary moves ahead of the motion, up to the depth of the card's buffer.

Every packet increments the move counter of its master when its move starts, so

    waiting = sent - started

is known without an answer to each move. While it is below the depth of the buffer the card
accepts moves at once, and they never delay other requests on the same connection.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

from msgspec.structs import replace

from openacr.client import values
from openacr.client.effects import Op, Pause
from openacr.client.errors import NoReplyError
from openacr.client.talk import Talk
from openacr.errors import UserError
from openacr.map.rows import masters
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code0

DEPTH = 10  # moves that wait on a card with MBUF ON and no DIM MBUF
POLL_S = 0.002


@dataclass(slots=True)
class MoveStream:
    """A stream of moves of one master to a card with a buffer of `depth` moves.

    If the buffer stays full and no move starts for `stall_s`, `send` raises NoReplyError
    (None: never, e.g. for a feedhold or a very long move).
    """

    master: int = 0
    depth: int = DEPTH
    stall_s: float | None = 600.0
    sent: int = 0
    started: int = 0
    origin: int | None = None  # move counter at the start of the stream

    @property
    def waiting(self) -> int:
        """Count of moves sent but not yet started."""
        return self.sent - self.started

    @property
    def counter(self) -> int:
        """The parameter number of the move counter."""
        return masters.move_counter[self.master]

    def update(self, talk: Talk) -> Op[int]:
        """Read how many moves have started."""
        count = int((yield from values.read(talk, self.counter)))
        if self.origin is None:
            self.origin = count
        self.started = count - self.origin
        return self.started

    def send(self, talk: Talk, moves: Iterable[Move]) -> Op[int]:
        """Send moves, each when there is room for it; returns their count."""
        source = iter(moves)
        if self.origin is None:
            yield from self.update(talk)
        before = self.sent
        while batch := list(islice(source, max(self.depth - self.waiting, 1))):
            full_s = talk.now_s()
            while self.waiting >= self.depth:
                if (yield from self._has_started_some(talk)):
                    full_s = talk.now_s()
                elif self.stall_s is not None and talk.now_s() - full_s > self.stall_s:
                    raise NoReplyError(talk.name, "moves (none starts)", self.stall_s)
            yield from talk.tell(self._counted(batch))
            self.sent += len(batch)
        return self.sent - before

    def _has_started_some(self, talk: Talk) -> Op[bool]:
        before = self.started
        if (yield from self.update(talk)) != before:
            return True
        yield Pause(POLL_S)
        return False

    def _counted(self, moves: Iterable[Move]) -> Iterator[Move]:
        """The moves for this master, counting up."""
        for move in moves:
            if move.master != self.master:
                raise UserError(f"a move of master {move.master} on the stream of {self.master}")
            codes = bytes((move.codes[0] & ~Code0.COUNT_DOWN | Code0.COUNTER, *move.codes[1:]))
            yield replace(move, codes=codes)
