"""MBUF and LOOK: how many moves a master holds, and how it looks ahead over them."""

from openacr.errors import CardError, StoreError
from openacr.map.hidden.motion import MOVES, MOVES_PER_MASTER
from openacr.map.memory import Memory
from openacr.map.numbers import (
    MF4_LOOK_AHEAD_MODE,
    MF4_MBUF_MODE,
    MF4_MBUF_USER_RAM,
    MF4_WORD,
    MQ_COUNT,
    MS_COUNT,
    MSF_LOOK_FROM_DEG,
    MSF_LOOK_TO_DEG,
    MSI_BASE,
    MSI_DEPTH,
    MSI_FIRST,
    MSI_HEAD,
    MSI_LOOK_DIRTY,
    MSI_QUEUED,
    MSI_SIZE,
    MSI_STRETCH,
    MSI_STRIDE,
)
from openacr.messages import INVALID_ARGUMENT, OUT_OF_MEMORY
from openacr.motion.card import MASTERS, Card
from openacr.motion.rows import master_ints, master_reals

DEPTH = 10  # moves that wait with MBUF ON and no DIM MBUF
HALF_TURN_DEG = 180.0


def waiting(card: Card, master: int) -> int:
    """Moves in the buffer behind the present one."""
    return max(card.memory.I[master_ints(master) + MSI_QUEUED] - 1, 0)


def is_empty(card: Card, master: int) -> bool:
    """Whether a master has no move at all."""
    return card.memory.I[master_ints(master) + MSI_QUEUED] == 0


def fits(card: Card, master: int, count: int) -> bool:
    """Whether the ring of a master holds `count` waiting moves as it is."""
    return count < card.memory.I[master_ints(master) + MSI_SIZE]


def switch_on(card: Card, master: int, count: int) -> None:
    """MBUF ON: let `count` moves wait, or the usual number for 0; a larger ring must be empty."""
    depth = count or DEPTH
    if not fits(card, master, depth):
        _move_ring(card, master, depth + 1)
    card.memory.I[master_ints(master) + MSI_DEPTH] = depth
    card.memory.I[MF4_WORD + master] |= MF4_MBUF_MODE
    if count:
        card.memory.I[MF4_WORD + master] |= MF4_MBUF_USER_RAM


def switch_off(card: Card, master: int) -> None:
    """MBUF OFF of an empty buffer: one move waits, as on a new card."""
    rows = master_ints(master)
    _place_ring(card, master, master * MOVES_PER_MASTER, MOVES_PER_MASTER)
    card.memory.I[rows + MSI_DEPTH] = 1
    card.memory.I[MF4_WORD + master] &= ~(MF4_MBUF_MODE | MF4_MBUF_USER_RAM)


def _move_ring(card: Card, master: int, size: int) -> None:
    """Lend a longer ring: the first gap among those of the other masters."""
    start = MASTERS * MOVES_PER_MASTER
    for first, behind in sorted(_lent(card, master)):
        if start + size <= first:
            break
        start = max(start, behind)
    if start + size > MOVES:
        raise CardError(OUT_OF_MEMORY)
    _place_ring(card, master, start, size)


def _lent(card: Card, without: int) -> list[tuple[int, int]]:
    """First record and the one behind the last of the rings that other masters were lent."""
    found = []
    for master in range(MASTERS):
        rows = master_ints(master)
        first = card.memory.I[rows + MSI_FIRST]
        if master != without and first >= MASTERS * MOVES_PER_MASTER:
            found.append((first, first + card.memory.I[rows + MSI_SIZE]))
    return found


def _place_ring(card: Card, master: int, first: int, size: int) -> None:
    rows = master_ints(master)
    for row, value in ((MSI_FIRST, first), (MSI_SIZE, size), (MSI_HEAD, 0)):
        card.memory.I[rows + row] = value


# look-ahead


def switch_look(card: Card, master: int, *, on: bool) -> None:
    """LOOK ON and OFF."""
    flags = card.memory.I[MF4_WORD + master] & ~MF4_LOOK_AHEAD_MODE
    card.memory.I[MF4_WORD + master] = flags | MF4_LOOK_AHEAD_MODE if on else flags
    card.memory.I[master_ints(master) + MSI_LOOK_DIRTY] = 1


def looks(card: Card, master: int) -> bool:
    """Whether look-ahead is on."""
    return bool(card.memory.I[MF4_WORD + master] & MF4_LOOK_AHEAD_MODE)


def set_look_angles(card: Card, master: int, from_deg: float, to_deg: float) -> None:
    """Turns up to the first angle are free, from the second on as slow as possible."""
    if not 0.0 <= from_deg <= to_deg <= HALF_TURN_DEG:
        raise CardError(INVALID_ARGUMENT)
    reals = master_reals(master)
    card.memory.F[reals + MSF_LOOK_FROM_DEG] = from_deg
    card.memory.F[reals + MSF_LOOK_TO_DEG] = to_deg


def look_angles(card: Card, master: int) -> tuple[float, float]:
    """Both angles."""
    reals = master_reals(master)
    return card.memory.F[reals + MSF_LOOK_FROM_DEG], card.memory.F[reals + MSF_LOOK_TO_DEG]


def check_rings(memory: Memory) -> None:
    """StoreError unless the rings of all masters lie in the records of moves, apart."""
    taken: set[int] = set()
    for master in range(MS_COUNT):
        rows = MSI_BASE + master * MSI_STRIDE
        first, size, head, queued, stretch = (
            memory.I[rows + row] for row in (MSI_FIRST, MSI_SIZE, MSI_HEAD, MSI_QUEUED, MSI_STRETCH)
        )
        ring = set(range(first, first + size))
        if first + size > MQ_COUNT or head >= size or max(queued, stretch) > size or ring & taken:
            raise StoreError(f"the snapshot is damaged: the moves of master {master} lie wrong")
        taken |= ring
