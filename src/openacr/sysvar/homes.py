"""Where every P number is kept, whether it survives power-off, and who may write it."""

from bisect import bisect_right
from dataclasses import dataclass
from enum import Enum

from openacr.sysvar.lookup import parameter
from openacr.sysvar.schema import CARD_PARAMETERS, FIRST_SYSTEM, Parameter


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


@dataclass(frozen=True, slots=True)
class Home:
    """A range of numbers with the same place and rights."""

    first: int
    last: int
    use: str
    host: Host
    is_persistent: bool
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


def _card(first: int, last: int, use: str, writer: Writer) -> Home:
    return Home(first, last, use, Host.CARD, is_persistent=False, writer=writer)


def _store(first: int, last: int, use: str, writer: Writer = Writer.PROGRAM) -> Home:
    return Home(first, last, use, Host.STORE, is_persistent=True, writer=writer)


def _nothing(first: int, last: int) -> Home:
    return Home(first, last, "none", Host.NONE, is_persistent=False, writer=Writer.NONE)


LAST_SYSTEM = 1_003_424
BEYOND = 1 << 62

HOMES = (
    _nothing(-BEYOND, -1),
    _card(0, 33, "global variables", Writer.PROGRAM),
    _card(34, 89, "reserved internal", Writer.WARNED),
    _card(90, 99, "reserved internal", Writer.NONE),
    _store(100, 199, "globals"),
    _store(200, 233, "user variables"),
    _store(234, 244, "system variables", Writer.NONE),
    _store(245, 245, "parts finished"),
    _store(246, 248, "system variables", Writer.NONE),
    _store(249, 270, "canned cycles"),
    _store(271, 279, "reference positions", Writer.WARNED),
    _store(280, 317, "reference points"),
    _store(318, 399, "reference positions", Writer.WARNED),
    _store(400, 799, "available"),
    _store(800, 832, "floating zero"),
    _store(833, 899, "available"),
    _store(900, 999, "work coordinates"),
    _store(1000, 1000, "D radius 0", Writer.NONE),
    _store(1001, 1400, "D radius"),
    _store(1401, 1499, "available"),
    _store(1500, 1500, "D wear 0", Writer.NONE),
    _store(1501, 1900, "D wear"),
    _store(1901, 1997, "available"),
    _store(1998, 1999, "current D"),
    _store(2000, 2000, "H length 0", Writer.NONE),
    _store(2001, 2999, "H length"),
    _store(3000, 3000, "H wear 0", Writer.NONE),
    _store(3001, 3999, "H wear"),
    _store(4000, 4001, "current H"),
    _store(4002, 4095, "available"),
    Home(CARD_PARAMETERS[0], CARD_PARAMETERS[-1], "card parameters", Host.LIVE, False, Writer.CARD),
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
