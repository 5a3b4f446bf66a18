"""MBUF and LOOK: how many moves a master holds, and how it looks ahead over them."""

from openacr.errors import CardError, StoreError
from openacr.map.hidden.path import MOVES, MOVES_PER_MASTER
from openacr.map.memory import Memory
from openacr.map.rows import masters, moves
from openacr.map.words import mf4
from openacr.messages import INVALID_ARGUMENT, OUT_OF_MEMORY
from openacr.motion.card import MASTERS, Card

DEPTH = 10  # moves that wait with MBUF ON and no DIM MBUF
HALF_TURN_DEG = 180.0


def waiting(card: Card, master: int) -> int:
    """Moves in the buffer after the present one."""
    return max(card.memory.I[masters.queued[master]] - 1, 0)


def is_empty(card: Card, master: int) -> bool:
    """Whether a master has no move at all."""
    return card.memory.I[masters.queued[master]] == 0


def fits(card: Card, master: int, count: int) -> bool:
    """Whether the ring of a master holds `count` waiting moves as it is."""
    return count < card.memory.I[masters.size[master]]


def switch_on(card: Card, master: int, count: int) -> None:
    """MBUF ON: let `count` moves wait, or the usual number for 0; a larger ring must be empty."""
    depth = count or DEPTH
    if not fits(card, master, depth):
        _move_ring(card, master, depth + 1)
    card.memory.I[masters.depth[master]] = depth
    card.memory.I[mf4.word[master]] |= mf4.MBUF_MODE
    if count:
        card.memory.I[mf4.word[master]] |= mf4.MBUF_USER_RAM


def switch_off(card: Card, master: int) -> None:
    """MBUF OFF of an empty buffer: one move waits, as on a new card."""
    _place_ring(card, master, master * MOVES_PER_MASTER, MOVES_PER_MASTER)
    card.memory.I[masters.depth[master]] = 1
    card.memory.I[mf4.word[master]] &= ~(mf4.MBUF_MODE | mf4.MBUF_USER_RAM)


def _move_ring(card: Card, master: int, size: int) -> None:
    """Lend a longer ring: the first gap among those of the other masters."""
    start = MASTERS * MOVES_PER_MASTER
    for first, waiting in sorted(_lent(card, master)):
        if start + size <= first:
            break
        start = max(start, waiting)
    if start + size > MOVES:
        raise CardError(OUT_OF_MEMORY)
    _place_ring(card, master, start, size)


def _lent(card: Card, without: int) -> list[tuple[int, int]]:
    """First record and the one after the last of the rings that other masters were lent."""
    found = []
    for master in range(MASTERS):
        first = card.memory.I[masters.first[master]]
        if master != without and first >= MASTERS * MOVES_PER_MASTER:
            found.append((first, first + card.memory.I[masters.size[master]]))
    return found


def _place_ring(card: Card, master: int, first: int, size: int) -> None:
    for row, value in ((masters.first, first), (masters.size, size), (masters.head, 0)):
        card.memory.I[row[master]] = value


# look-ahead


def switch_look(card: Card, master: int, *, on: bool) -> None:
    """LOOK ON and OFF."""
    flags = card.memory.I[mf4.word[master]] & ~mf4.LOOK_AHEAD_MODE
    card.memory.I[mf4.word[master]] = flags | mf4.LOOK_AHEAD_MODE if on else flags
    card.memory.I[masters.look_dirty[master]] = 1


def looks(card: Card, master: int) -> bool:
    """Whether look-ahead is on."""
    return bool(card.memory.I[mf4.word[master]] & mf4.LOOK_AHEAD_MODE)


def set_look_angles(card: Card, master: int, from_deg: float, to_deg: float) -> None:
    """Turns up to the first angle are free, from the second on as slow as possible."""
    if not 0.0 <= from_deg <= to_deg <= HALF_TURN_DEG:
        raise CardError(INVALID_ARGUMENT)
    card.memory.F[masters.look_from_deg[master]] = from_deg
    card.memory.F[masters.look_to_deg[master]] = to_deg


def look_angles(card: Card, master: int) -> tuple[float, float]:
    """Both angles."""
    return card.memory.F[masters.look_from_deg[master]], card.memory.F[masters.look_to_deg[master]]


def check_rings(memory: Memory) -> None:
    """StoreError unless the rings of all masters lie in the records of moves, apart."""
    taken: set[int] = set()
    for master in range(masters.COUNT):
        first, size, head, queued, section_cnt = (
            memory.I[row[master]]
            for row in (
                masters.first,
                masters.size,
                masters.head,
                masters.queued,
                masters.section_cnt,
            )
        )
        ring = set(range(first, first + size))
        if (
            first + size > moves.COUNT
            or head >= size
            or max(queued, section_cnt) > size
            or ring & taken
        ):
            raise StoreError(f"the snapshot is damaged: the moves of master {master} lie wrong")
        taken |= ring
