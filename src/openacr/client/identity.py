"""What a card says about itself: model, firmware, options; only queries are sent."""

import re

from msgspec import Struct, field

from openacr.client import Card
from openacr.client.errors import ClientError, ConnectionLostError, RefusedError
from openacr.client.links import DEFAULT_BAUD, Host
from openacr.client.options import Options
from openacr.map.numbers import (
    P_CARD_SERIAL_NUMBER,
    P_DIAGNOSTICS,
    P_FIRMWARE_VERSION,
    P_UPDATE_NUMBER,
)
from openacr.models import MODELS, Model

# Lines whose answers are shown as they are; a card that does not know one says so.
OPTION_QUERIES = ("CONFIG", "MEM", "PERIOD", "ATTACH")
VERSION = re.compile(
    r"(?P<model>\S+) Version (?P<firmware>\d+(?:\.\d+)*)(?: Update (?P<update>\d+))?"
)


class Identity(Struct, frozen=True):
    """A card as its answers describe it."""

    address: str
    version: str  # the answer to VER
    model: str  # empty: the answer has another form
    firmware: tuple[int, ...]  # 1, 18, 6
    update: int
    serial_number: int
    diagnostics: int  # a set bit is a failure
    has_packets: bool  # it answers binary packets on this connection
    options: dict[str, list[str]] = field(default_factory=dict)

    @property
    def hardware(self) -> Model | None:
        """The row of the model table, None for a model that is not in it."""
        return MODELS.get(self.model)

    @property
    def firmware_text(self) -> str:
        """The firmware version with dots, as VER prints it."""
        found = VERSION.match(self.version)
        return found["firmware"] if found else ""


def identify(
    target: str | Host, options: Options | None = None, *, baud: int = DEFAULT_BAUD
) -> Identity:
    """Ask a card what it is, by text first, then whether it answers packets.

    ConnectionLostError, NoReplyError or GarbledError where there is no card.
    """
    patience = options or Options()
    by_text = Options(
        timeout_s=patience.timeout_s, deadline_s=patience.deadline_s, reconnect_s=0.0,
        uses_packets=False,
    )  # fmt: skip
    with Card.open(target, by_text, baud=baud) as card:
        version = " ".join(_answer(card, "VER"))
        numbers = [
            int(_number(card, number))
            for number in (P_CARD_SERIAL_NUMBER, P_FIRMWARE_VERSION, P_UPDATE_NUMBER, P_DIAGNOSTICS)
        ]
        found = {line: _answer(card, line) for line in OPTION_QUERIES}
        name = card.name
    serial, firmware, update, diagnostics = numbers
    match = VERSION.match(version)
    return Identity(
        name,
        version,
        match["model"] if match else "",
        _parts(match["firmware"])
        if match
        else (firmware // 10000, firmware // 100 % 100, firmware % 100),
        int(match["update"] or 0) if match else update,
        serial,
        diagnostics,
        _has_packets(target, patience, baud),
        found,
    )


def _parts(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split(".")))


def _answer(card: Card, line: str) -> list[str]:
    """The answer to a query; that of a card which does not know it is its error text."""
    try:
        return card.command(line)
    except RefusedError as refused:
        return [refused.text]


def _number(card: Card, parameter: int) -> float:
    try:
        return card.read(parameter)
    except RefusedError:
        return 0


def _has_packets(target: str | Host, patience: Options, baud: int) -> bool:
    """Whether a parameter read by a packet arrives."""
    with_packets = Options(
        timeout_s=patience.timeout_s, deadline_s=patience.deadline_s, reconnect_s=0.0
    )
    try:
        with Card.open(target, with_packets, baud=baud) as card:
            card.read(P_CARD_SERIAL_NUMBER)
    except ConnectionLostError:
        raise
    except ClientError:
        return False
    return True
