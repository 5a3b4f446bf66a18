"""Where everything lies in the state buffer.

    int32 index     0  kind of each parameter number, two bits each
                 4096  public parameters up to P40959, one 32-bit word each
    float64 index 20480  user variables P0 to P4095
                  24576  hidden float64 rows, then hidden int32 rows
    byte HEAP_BYTE_BASE  1 MiB for local variables and arrays of programs

The kinds stand where the user variables would have their 32-bit words; those are float64
and live above.
"""

from collections.abc import Iterable, Iterator

from openacr.map.block import Kind
from openacr.map.hidden.block import Field, HiddenBlock, places

PUBLIC_COUNT = 40960
USER_COUNT = 4096
USER_BASE = PUBLIC_COUNT * 4 // 8
HIDDEN_BASE = USER_BASE + USER_COUNT
HEAP_BYTES = 1 << 20
KIND_CODES = {None: 0, Kind.LONG: 1, Kind.FP32: 2, Kind.FP64: 3}

Constant = tuple[str, int]


def slug(name: str) -> str:
    """A table name as part of a constant name."""
    kept = "".join(c if c.isalnum() else " " for c in name.upper().replace("'", ""))
    return "_".join(kept.split())


def hidden_constants(blocks: Iterable[HiddenBlock]) -> Iterator[Constant]:
    """Place all hidden rows: float64 first, then int32, then the heap."""
    blocks = tuple(blocks)
    base = HIDDEN_BASE
    for block in blocks:
        yield f"{block.prefix}_COUNT", block.count
        if block.doubles:
            yield from _fields(f"{block.prefix}F", base, block.doubles_stride, block.doubles)
        base += block.count * block.doubles_stride
    base *= 2
    for block in blocks:
        if block.ints:
            yield from _fields(f"{block.prefix}I", base, block.ints_stride, block.ints)
        base += block.count * block.ints_stride
    heap = (base + 1) // 2 * 8
    yield "HEAP_BYTE_BASE", heap
    yield "HEAP_BYTES", HEAP_BYTES
    yield "MEMORY_BYTES", heap + HEAP_BYTES


def _fields(prefix: str, base: int, stride: int, fields: tuple[Field, ...]) -> Iterator[Constant]:
    yield f"{prefix}_BASE", base
    yield f"{prefix}_STRIDE", stride
    for name, offset, size in places(fields):
        yield f"{prefix}_{slug(name)}", offset
        if size > 1:
            yield f"{prefix}_{slug(name)}_SIZE", size
