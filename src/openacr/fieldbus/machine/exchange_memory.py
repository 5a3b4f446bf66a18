"""What the real-time loop and Python share for a bus."""

from openacr.fieldbus.machine import exchange_cy as at
from openacr.views import F64, I32, U8


class ExchangeMemory:
    """Rows, numbers and frames of `exchange_cy.py`; as it is made, nothing is exchanged."""

    def __init__(self) -> None:
        self.rows: I32 = memoryview(bytearray(4 * at.B_ROWS)).cast("i")
        self.numbers: F64 = memoryview(bytearray(8 * at.N_ROWS)).cast("d")
        self.out: U8 = memoryview(bytearray(at.X_SIZE))
        self.back: U8 = memoryview(bytearray(at.FRAME_ROOM))
