"""The calls of ComACRServer, the maker's COM server for Windows hosts, over this client.

A host that was written for it moves to any operating system: the methods and properties here have
its names and its order of arguments, and each is one packet or one line of the card. What has no
place here (events, configuration, EPL) does not exist, so that its use fails at once, by its name.
"""

from collections.abc import Iterable

from openacr.client.card import Card
from openacr.client.errors import ClientError, RefusedError
from openacr.client.links import Host
from openacr.client.options import Options
from openacr.client.values import Number
from openacr.protocol.move import Move
from openacr.protocol.move_codes import Code3
from openacr.protocol.override import FeedrateOverride, RapidOverride
from openacr.protocol.parameter import MaskParameter

OFFLINE, SERIAL, IP, USB = 0, 2, 3, 4  # transports of Connect
MOST_CUSTOM = 32  # parameters of one GetACRCustom
MASTER_STRIDE = 32  # between flags of masters
STOP_ALL_MOVES, KILL_ALL_MOVES = 523, 522


class ComACRServer:
    """A channel to one card; every call but Connect raises ClientError while it is offline."""

    def __init__(self, options: Options | None = None) -> None:
        self.bstrIP: str | Host = "192.168.10.40"  # or host:port, or a card in this process
        self.bstrPort = ""  # of a serial line: its path or name
        self.nBPS = 38400
        self.nMoveProfile = 0  # the master of moves
        self.fMoveVEL = self.fMoveFVEL = self.fMoveACC = -1.0  # negative: as they are
        self.bMoveAbsolute = True
        self._options = options
        self._card: Card | None = None
        self._read = ""

    # connection

    def Connect(self, transport: int, index: int = 0) -> None:
        """Connect by 3 (IP: `bstrIP`) or 2 (serial: `bstrPort`, `nBPS`); 0 goes offline.

        ClientError for USB, which has no place here, and where no card answers.
        """
        self.Disconnect()
        if transport == OFFLINE:
            return
        if transport not in (SERIAL, IP):
            raise ClientError(f"transport {transport}: known are 0 offline, 2 serial and 3 IP")
        target = self.bstrIP if transport == IP else self.bstrPort
        self._card = Card.open(target, self._options, baud=self.nBPS)

    def Disconnect(self) -> None:
        """Go offline; motion and programs continue."""
        card, self._card, self._read = self._card, None, ""
        if card is not None:
            card.close()

    def TestConnect(self) -> bool:
        """Whether the card answers."""
        if self._card is None:
            return False
        try:
            self._card.command("")
        except ClientError:
            return False
        return True

    @property
    def isOffline(self) -> bool:
        """Whether there is no connection."""
        return self._card is None

    @property
    def card(self) -> Card:
        """The card as this client knows it; ClientError while offline."""
        if self._card is None:
            raise ClientError("offline: Connect(3) connects to the card at bstrIP")
        return self._card

    # status

    def GetACRCustom(self, parameters: str) -> list[Number]:
        """The values of up to 32 parameters, written `P12288,P12290`, at one moment of the card."""
        numbers = [int(word.strip().upper().removeprefix("P")) for word in parameters.split(",")]
        if len(numbers) > MOST_CUSTOM:
            raise ClientError(f"GetACRCustom: {len(numbers)} parameters, at most {MOST_CUSTOM}")
        return self.card.read_many(numbers)

    # control

    def SetFlag(self, bit: int, value: bool, fast: bool = False) -> None:
        """Set or clear a flag."""
        self.card.write_bit(bit, bool(value))

    def SetParmFloat(self, parameter: int, value: float, fast: bool = False) -> None:
        """Set a parameter as a float."""
        self.card.write(parameter, float(value))

    def SetParmLong(self, parameter: int, value: int, fast: bool = False) -> None:
        """Set a parameter as an integer."""
        self.card.write(parameter, int(value))

    def SetParmLongMask(self, parameter: int, nand: int, or_: int, fast: bool = False) -> None:
        """Clear the bits of `nand` in an integer parameter, then set those of `or_`."""
        self.card.tell(MaskParameter(parameter, nand & 0xFFFFFFFF, or_ & 0xFFFFFFFF))

    def SetGlobal(self, card: int, index: int, value: float, fast: bool = False) -> None:
        """Set a global variable P0 to P4095; `card` counts those of a computer: not used."""
        self.card.write(index, float(value))

    def SetFOV(self, mask: int, value: float) -> None:
        """Set the feedrate override (1 is 100 %) of the masters in a mask."""
        self.card.tell(FeedrateOverride.of(_numbers(mask), value))

    def SetROV(self, mask: int, value: float) -> None:
        """Set the rapid override (1 is 100 %) of the masters in a mask."""
        self.card.tell(RapidOverride.of(_numbers(mask), value))

    def Move(self, mask: int, targets: Iterable[float]) -> None:
        """A move of `nMoveProfile`: a target in units for each slave in the mask, lowest first."""
        positions = dict(zip(_numbers(mask), map(float, targets), strict=True))
        limits = (self.fMoveVEL, self.fMoveFVEL, self.fMoveACC)
        vel, fvel, acc = (value if value >= 0.0 else None for value in limits)
        code3 = Code3.FLOATING_POINT | (0 if self.bMoveAbsolute else Code3.INCREMENTAL_TARGET)
        move = Move.of(
            positions, master=self.nMoveProfile, code3=code3, vel=vel, fvel=fvel, acc=acc
        )
        self.card.send_moves([move])

    def Stop(self, decel: bool = True) -> None:
        """End the moves of `nMoveProfile`: with DEC, or at once; clear the flag to move again."""
        flag = STOP_ALL_MOVES if decel else KILL_ALL_MOVES
        self.card.write_bit(flag + MASTER_STRIDE * self.nMoveProfile, True)

    # terminal

    def Write(self, text: str) -> None:
        """Type lines that end with CR; what the card answers is for `Read`."""
        for line in text.replace("\r\n", "\r").removesuffix("\r").split("\r"):
            try:
                heard = self.card.command(line)
            except RefusedError as refused:
                heard = [refused.text]
            self._read += "".join(f"{each}\r\n" for each in (line, *heard))

    def Read(self) -> str:
        """What was typed and answered since the last call; empty when nothing waits."""
        heard, self._read = self._read, ""
        return heard


def _numbers(mask: int) -> list[int]:
    """The numbers of the bits in a mask, lowest first."""
    return [number for number in range(mask.bit_length()) if mask >> number & 1]
