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


def hidden_bases(blocks: Iterable[HiddenBlock]) -> Iterator[tuple[HiddenBlock, int, int]]:
    """Where the float64 and the int32 rows of each block begin: all float64 rows come first."""
    blocks = tuple(blocks)
    real = HIDDEN_BASE
    whole = 2 * (HIDDEN_BASE + sum(block.count * block.doubles_stride for block in blocks))
    for block in blocks:
        yield block, real, whole
        real += block.count * block.doubles_stride
        whole += block.count * block.ints_stride


def hidden_constants(blocks: Iterable[HiddenBlock]) -> Iterator[Constant]:
    """Names of the hidden rows, then of the heap."""
    bases = tuple(hidden_bases(blocks))
    for block, real, _ in bases:
        yield f"{block.prefix}_COUNT", block.count
        if block.doubles:
            yield from _fields(f"{block.prefix}F", real, block.doubles_stride, block.doubles)
    for block, _, whole in bases:
        if block.ints:
            yield from _fields(f"{block.prefix}I", whole, block.ints_stride, block.ints)
    end = max(whole + block.count * block.ints_stride for block, _, whole in bases)
    heap = (end + 1) // 2 * 8
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
