"""Types of the three views of the state buffer, for the sources that are also compiled."""

from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    F64: TypeAlias = memoryview[float]  # 64-bit floats
    I32: TypeAlias = memoryview[int]  # 32-bit integers
    F32: TypeAlias = memoryview[float]  # 32-bit floats
    U8: TypeAlias = memoryview[int]  # bytes
else:
    F64 = I32 = F32 = U8 = memoryview
