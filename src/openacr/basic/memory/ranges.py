"""The ranges of numbers in stored data and snapshots: anything else is refused when it is read."""

from typing import Annotated, TypeAlias

from msgspec import Meta

ProgramNumber: TypeAlias = Annotated[int, Meta(ge=0, le=15)]  # masters and axes, too
OwnerNumber: TypeAlias = Annotated[int, Meta(ge=0, le=23)]  # programs, then PLCs
ThreadNumber: TypeAlias = Annotated[int, Meta(ge=0, le=47)]
DeviceNumber: TypeAlias = Annotated[int, Meta(ge=0, le=3)]
Index: TypeAlias = Annotated[int, Meta(ge=0, lt=1 << 31)]
IndexOrNone: TypeAlias = Annotated[int, Meta(ge=-1, lt=1 << 31)]
LineNumber: TypeAlias = Annotated[int, Meta(ge=0, le=999999)]
EchoBits: TypeAlias = Annotated[int, Meta(ge=0, le=7)]
ModeBits: TypeAlias = Annotated[int, Meta(ge=0, le=3)]
StringLength: TypeAlias = Annotated[int, Meta(ge=1, le=255)]
StringText: TypeAlias = Annotated[str, Meta(max_length=255)]
