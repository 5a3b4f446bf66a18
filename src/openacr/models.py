"""Controller models: how many of everything a card has, and what only some of them have.

A model is one row below; nothing else in the sources knows models by name. Masters, slaves and
programs are those the manuals state; counts they do not state are those of the largest card of
the family (20 encoders, 16 analog outputs and inputs).
"""

from enum import Flag

from msgspec import Struct


class Feature(Flag):
    """What commands need and some models lack."""

    NONE = 0
    NURBS = 1
    LOOK_AHEAD = 2
    USER_FLASH = 4

    def __str__(self) -> str:
        """Name the features as a sentence does: `no NURBs and no look-ahead`."""
        return " and ".join(f"no {_TITLES[one]}" for one in self)


_TITLES = {
    Feature.NURBS: "NURBs",
    Feature.LOOK_AHEAD: "look-ahead",
    Feature.USER_FLASH: "user flash",
}


class Model(Struct, frozen=True, kw_only=True):
    """One controller model.

    `axes` counts those of the firmware, which ATTACH knows; a small board has `connectors` for
    some of them, the others keep their default attachment (Programmer's Guide, Output Module
    Software Configuration Examples 4 to 7).
    """

    name: str
    axes: int = 16
    connectors: int | None = None  # None: for every axis
    masters: int = 16
    slaves: int = 16
    programs: int = 16
    plcs: int = 8
    encoders: int = 20
    dacs: int = 16
    adcs: int = 16
    commutators: int = 8
    lines: int = 32  # digital inputs on the board, and as many outputs
    streams: tuple[str, ...]
    has_fixed_adc_mode: bool = False  # 16-bit analog inputs only
    has_digits_in_names: bool = False  # of aliases: the successors; see `digits_in_names`
    has_battery: bool = False  # keeps programs and variables without power
    has_canopen: bool = False
    lacks: Feature = Feature.NONE
    firmware: str = "1.18.06"
    update: int = 15

    @property
    def connected_axes(self) -> int:
        """How many axes the board can drive."""
        return self.axes if self.connectors is None else self.connectors

    @property
    def version(self) -> str:
        """What VER prints."""
        return f"{self.name} Version {self.firmware} Update {self.update}"

    @property
    def serial_number(self) -> int:
        """P7040: the card type, which is the digits of the name, followed by four zeros."""
        return int(self.name.removeprefix("ACR")) * 10000

    @property
    def firmware_number(self) -> int:
        """P7042: the digits of the firmware version, 11806 for 1.18.06."""
        return int(self.firmware.replace(".", ""))


# STREAM1 is USB or the process the card runs in, the others are network connections. Cards
# for a PC slot have no network of their own; here hosts reach them over it all the same.
_NETWORK = ("STREAM1", "STREAM2", "STREAM3", "STREAM4", "STREAM5")
_CARD_STREAMS = ("FIFO", "COM1", "COM2", *_NETWORK)
_DPCB_STREAMS = (*_CARD_STREAMS, "DPCB")
_BOX_STREAMS = ("COM1", "COM2", *_NETWORK)

# Boards of the front end's guide; what is not written here they have like the others. NURBs and
# look-ahead are missing on "less expensive controllers like the ACR1500", the only one it names.
# DPCB and user flash follow from what the Programmer's Guide omits for which model in the
# sequence of Return to Factory Default. The ACR8000 has no commutators (User's Guide Part 2,
# CMT Parameters and CMT Flags).
ACR1200 = Model(name="ACR1200", axes=8, connectors=2, masters=8, streams=_BOX_STREAMS)
ACR1500 = Model(
    name="ACR1500", axes=8, connectors=4, masters=8, streams=_CARD_STREAMS,
    lacks=Feature.NURBS | Feature.LOOK_AHEAD,
)  # fmt: skip
ACR2000 = Model(name="ACR2000", axes=8, lines=16, connectors=4, masters=8, streams=_CARD_STREAMS)
ACR8000 = Model(
    name="ACR8000", axes=8, masters=8, commutators=0, streams=_CARD_STREAMS,
    lacks=Feature.USER_FLASH,
)  # fmt: skip
ACR8010 = Model(name="ACR8010", axes=8, masters=8, streams=_CARD_STREAMS)
ACR1505 = Model(name="ACR1505", axes=8, streams=_DPCB_STREAMS, has_battery=True)
ACR8020 = Model(name="ACR8020", streams=_DPCB_STREAMS, has_battery=True)
ACR9000 = Model(
    name="ACR9000", axes=8, masters=8, slaves=8, streams=_BOX_STREAMS,
    has_fixed_adc_mode=True, has_canopen=True,
)  # fmt: skip
ACR9030 = Model(name="ACR9030", streams=_BOX_STREAMS, has_fixed_adc_mode=True, has_canopen=True)
ACR9040 = Model(name="ACR9040", streams=_BOX_STREAMS, has_fixed_adc_mode=True, has_canopen=True)

_ROWS = [row for row in globals().values() if isinstance(row, Model)]
MODELS = {row.name: row for row in sorted(_ROWS, key=lambda row: row.name)}
DEFAULT_MODEL = ACR9000
