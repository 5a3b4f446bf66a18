"""Where every P number is kept, whether it survives power-off, and who may write it."""

from bisect import bisect_right
from collections.abc import Iterator
from enum import Enum
from itertools import pairwise

from msgspec import Struct

from openacr.sysvar.lookup import parameter
from openacr.sysvar.schema import (
    CARD_PARAMETERS,
    FIRST_SYSTEM,
    FRONT_END_VARIABLES,
    GLOBAL_VARIABLES,
    INTERNAL_VARIABLES,
    Parameter,
)
from openacr.sysvar.tabs import CELLS


class Host(Enum):
    """Where a parameter is kept."""

    CARD = "card"  # a user variable of the card
    STORE = "store"
    LIVE = "live"  # a real-time parameter of the card
    NONE = "none"


class Writer(Enum):
    """Who may assign a parameter in a part program."""

    PROGRAM = "program"  # every program
    WARNED = "warned"  # every program, with warning W220
    NONE = "none"  # no program: E212
    SERVICE = "service"  # only MDI with the service role, else E212
    CARD = "card"  # as the card allows


UNKNOWN = "E211"
READ_ONLY = "E212"
RESERVED = "W220"


class Home(Struct, frozen=True):
    """A range of numbers with the same place and rights."""

    first: int
    last: int
    use: str
    host: Host
    writer: Writer

    @property
    def is_on_card(self) -> bool:
        """Whether the parameter is kept on the card."""
        return self.host in (Host.CARD, Host.LIVE)

    @property
    def read_error(self) -> str | None:
        """The error code when a program reads such a number, None if it may."""
        return UNKNOWN if self.host is Host.NONE else None

    def write_error(self, *, is_service: bool = False) -> str | None:
        """The error code when a program assigns such a number, None if it may."""
        if self.host is Host.NONE:
            return UNKNOWN
        if self.writer is Writer.NONE or (self.writer is Writer.SERVICE and not is_service):
            return READ_ONLY
        return None

    @property
    def write_warning(self) -> str | None:
        """The warning code when a program assigns such a number, None without one."""
        return RESERVED if self.writer is Writer.WARNED else None


def _card(numbers: range, use: str, writer: Writer) -> Home:
    return Home(numbers[0], numbers[-1], use, Host.CARD, writer)


def _store(first: int, last: int, use: str, writer: Writer = Writer.PROGRAM) -> Home:
    return Home(first, last, use, Host.STORE, writer)


def _nothing(first: int, last: int) -> Home:
    return Home(first, last, "none", Host.NONE, Writer.NONE)


LAST_SYSTEM = 1_003_424
BEYOND = 1 << 62


def _cells() -> Iterator[Home]:
    """The cells of programs in the store; a row extends to the first cell of the next one."""
    program, none, warned = Writer.PROGRAM, Writer.NONE, Writer.WARNED
    rows = (
        (CELLS.first_global, "globals", program),
        (CELLS.user_variables[0], "user variables", program),
        (CELLS.tool_selected, "system variables", none),
        (CELLS.parts_finished, "parts finished", program),
        (CELLS.last_alarm, "system variables", none),
        (CELLS.cycle_code, "canned cycles", program),
        (CELLS.homed_axes, "reference positions", warned),
        (CELLS.reference_point_1[0], "reference points", program),
        (CELLS.reference_point_4.stop, "reference positions", warned),
        (CELLS.free[0], "available", program),
        (CELLS.floating_zero_active, "floating zero", program),
        (CELLS.free_after_zero[0], "available", program),
        (CELLS.common_work_shift[0], "work coordinates", program),
        (CELLS.d_radius[0], "D radius 0", none),
        (CELLS.d_radius[1], "D radius", program),
        (CELLS.free_after_radius[0], "available", program),
        (CELLS.d_wear[0], "D wear 0", none),
        (CELLS.d_wear[1], "D wear", program),
        (CELLS.free_after_radius_wear[0], "available", program),
        (CELLS.current_d_radius, "current D", program),
        (CELLS.h_length[0], "H length 0", none),
        (CELLS.h_length[1], "H length", program),
        (CELLS.h_wear[0], "H wear 0", none),
        (CELLS.h_wear[1], "H wear", program),
        (CELLS.current_h_length, "current H", program),
        (CELLS.free_after_length[0], "available", program),
        (CARD_PARAMETERS.start, "", none),
    )
    for (first, use, writer), (following, _, _) in pairwise(rows):
        yield _store(first, following - 1, use, writer)


HOMES = (
    _nothing(-BEYOND, -1),
    _card(GLOBAL_VARIABLES, "global variables", Writer.PROGRAM),
    _card(INTERNAL_VARIABLES, "reserved internal", Writer.WARNED),
    _card(FRONT_END_VARIABLES, "reserved internal", Writer.NONE),
    *_cells(),
    Home(CARD_PARAMETERS[0], CARD_PARAMETERS[-1], "card parameters", Host.LIVE, Writer.CARD),
    _nothing(CARD_PARAMETERS.stop, FIRST_SYSTEM - 1),
    _store(FIRST_SYSTEM, LAST_SYSTEM, "system parameters", Writer.SERVICE),
    _nothing(LAST_SYSTEM + 1, BEYOND),
)
_FIRSTS = tuple(home.first for home in HOMES)


def home_of(n: int) -> Home:
    """The home of parameter `n`.

    An expression can use neither text nor system parameters missing from the table.
    """
    home = HOMES[bisect_right(_FIRSTS, n) - 1]
    if n < FIRST_SYSTEM or home.host is Host.NONE:
        return home
    found = parameter(n)
    if found is None or found.is_text:
        return _nothing(n, n)
    return _store(n, n, found.name, _system_writer(found))


def _system_writer(found: Parameter) -> Writer:
    return Writer.NONE if found.row.is_fixed else Writer.SERVICE
