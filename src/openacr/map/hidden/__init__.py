"""State of the card that has no parameter number, one module per topic."""

from openacr.map.hidden import (
    cam,
    devices,
    engine,
    gear,
    motion,
    network,
    objects,
    plant,
    plc,
    sources,
    storage,
    system,
    threads,
)
from openacr.map.hidden.block import HiddenBlock

TOPICS = (
    system,
    storage,
    motion,
    plant,
    threads,
    devices,
    engine,
    plc,
    sources,
    gear,
    cam,
    objects,
    network,
)

HIDDEN_BLOCKS: tuple[HiddenBlock, ...] = tuple(
    value for topic in TOPICS for value in vars(topic).values() if isinstance(value, HiddenBlock)
)
