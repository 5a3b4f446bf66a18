"""The tables of bridge.toml: what is published, to which systems, and who may read it."""

from enum import StrEnum
from typing import Annotated

from msgspec import Meta, Struct

from openacr.client.names import flag_number, parameter_number
from openacr.map.block import FLAG_WORD_BASE

BITS_PER_WORD = 32
LOOPBACK = "127.0.0.1"
Name = Annotated[
    str,
    Meta(
        pattern=r"^[A-Za-z][A-Za-z0-9_]{0,39}$",
        description="a letter, then letters, digits and _, at most 40 in all, in quotes",
    ),
]
Port = Annotated[int, Meta(ge=0, le=65535)]
Text = Annotated[str, Meta(min_length=1, max_length=200)]
Token = Annotated[str, Meta(pattern="^[^/+#]{1,60}$")]  # one level of a topic


def port_key(system: str) -> str:
    """Where the port of a system is chosen."""
    return f"port = N in [{system}]"


class Length(StrEnum):
    """The unit of lengths on a card."""

    MM = "mm"
    INCH = "inch"


class _Table(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """A table of the file: unknown keys are errors."""


class Chosen(_Table, frozen=True):
    """A parameter or flag of the card that is published, too; `write` lets systems set it."""

    name: Name
    parameter: int | str | None = None
    flag: int | str | None = None
    meaning: str = ""
    unit: Annotated[str, Meta(max_length=30)] = ""
    write: bool = False
    low: float | None = None
    high: float | None = None

    @property
    def is_flag(self) -> bool:
        """Whether it is a flag."""
        return self.flag is not None

    @property
    def number(self) -> int:
        """The number of the parameter or flag; UserError for an unknown one."""
        if self.flag is not None:
            return flag_number(self.flag)
        return parameter_number(self.parameter if self.parameter is not None else "")

    @property
    def parameter_number(self) -> int:
        """The parameter that is read: for a flag that of its word."""
        return FLAG_WORD_BASE + self.number // BITS_PER_WORD if self.is_flag else self.number

    @property
    def bit(self) -> int:
        """The place of a flag in its word."""
        return self.number % BITS_PER_WORD


EXACTLY_ONE: dict[type[Struct], tuple[tuple[str, ...], ...]] = {Chosen: (("parameter", "flag"),)}


class OnCard(_Table, frozen=True):
    """What a card alone does not say: the letters of its axes, and their unit."""

    axes: tuple[Annotated[str, Meta(pattern="^[A-Z]$")], ...] = ("X", "Y", "Z")
    unit: Length = Length.MM


class Listening(_Table, frozen=True):
    """Where a system listens, and the password hosts have to give."""

    port: Port
    address: Text = LOOPBACK
    user: Text = "openacr"
    password_file: Text | None = None


class Prometheus(Listening, frozen=True):
    """Metrics for Prometheus over HTTP."""

    port: Port = 9780


class MTConnect(Listening, frozen=True):
    """An MTConnect agent over HTTP."""

    port: Port = 5000
    uuid: Annotated[str, Meta(pattern="^[A-Za-z0-9_.-]{1,60}$")] | None = None
    buffer: Annotated[int, Meta(ge=100, le=1_048_576)] = 131_072


class OpcUa(Listening, frozen=True):
    """An OPC UA server; with a certificate every connection is signed and encrypted."""

    port: Port = 4840
    certificate: Text | None = None
    private_key: Text | None = None
    trusted: Text | None = None
    application_uri: Text = "urn:openacr:bridge"


class Sparkplug(_Table, frozen=True):
    """An edge node of Sparkplug B at a broker of MQTT; user and password are those there."""

    group: Token = "openacr"
    primary_host: Token | None = None
    address: Text = LOOPBACK
    port: Annotated[int, Meta(ge=1, le=65535)] = 1883
    client_id: Text | None = None
    user: Text | None = None
    password_file: Text | None = None
    tls: bool = False
    authority: Text | None = None
    certificate: Text | None = None
    private_key: Text | None = None


class Epics(_Table, frozen=True):
    """Process variables over Channel Access, which has no passwords."""

    address: Text = LOOPBACK
    port: Annotated[int, Meta(ge=1, le=65535)] = 5064
    prefix: Annotated[str, Meta(pattern=r"^[A-Za-z0-9_:.-]{1,30}$")] | None = None
    insecure: bool = False


class BridgeFile(_Table, frozen=True):
    """A bridge; a system without its table is off."""

    name: Name = "openacr"
    rate_hz: Annotated[float, Meta(ge=0.1, le=50.0)] = 10.0
    card: OnCard = OnCard()
    value: tuple[Chosen, ...] = ()
    prometheus: Prometheus | None = None
    mtconnect: MTConnect | None = None
    opcua: OpcUa | None = None
    sparkplug: Sparkplug | None = None
    epics: Epics | None = None
