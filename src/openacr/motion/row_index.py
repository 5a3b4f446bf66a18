"""Indices into the memory views by object number, for the slow side."""

from openacr.map.numbers import (
    AF1_WORD,
    AF1_WORD_HIGH,
    AF2_WORD,
    AF2_WORD_HIGH,
    AX_BASE,
    AX_STRIDE,
    AXF_BASE,
    AXF_STRIDE,
    AXI_BASE,
    AXI_STRIDE,
    MA_BASE,
    MA_STRIDE,
    MF1_WORD,
    MF1_WORD_HIGH,
    MF2_WORD,
    MF2_WORD_HIGH,
    MSF_BASE,
    MSF_STRIDE,
    MSI_BASE,
    MSI_STRIDE,
)


def axis_parameter(axis: int) -> int:
    """Parameter number of the first row of an axis."""
    return AX_BASE + axis * AX_STRIDE


def axis_reals(axis: int) -> int:
    """Index in F of the hidden float64 rows of an axis."""
    return AXF_BASE + axis * AXF_STRIDE


def axis_ints(axis: int) -> int:
    """Index in I of the hidden int32 rows of an axis."""
    return AXI_BASE + axis * AXI_STRIDE


def axis_word(axis: int) -> int:
    """Parameter number of the primary flag word of an axis."""
    return axis + (AF1_WORD if axis < 8 else AF1_WORD_HIGH)


def axis_word2(axis: int) -> int:
    """Parameter number of the secondary flag word of an axis."""
    return axis + (AF2_WORD if axis < 8 else AF2_WORD_HIGH)


def master_parameter(master: int) -> int:
    """Parameter number of the first row of a master."""
    return MA_BASE + master * MA_STRIDE


def master_reals(master: int) -> int:
    """Index in F of the hidden float64 rows of a master."""
    return MSF_BASE + master * MSF_STRIDE


def master_ints(master: int) -> int:
    """Index in I of the hidden int32 rows of a master."""
    return MSI_BASE + master * MSI_STRIDE


def master_word(master: int) -> int:
    """Parameter number of the primary flag word of a master."""
    return master + (MF1_WORD if master < 8 else MF1_WORD_HIGH)


def master_word2(master: int) -> int:
    """Parameter number of the secondary flag word of a master."""
    return master + (MF2_WORD if master < 8 else MF2_WORD_HIGH)
