"""State of the card that has no parameter number, one module per topic."""

from openacr.map.hidden import (
    axis,
    devices,
    engine,
    followers,
    kernel,
    network,
    path,
    plant,
    plc,
    sources,
    status,
    storage,
    system,
    threads,
)
from openacr.map.hidden.block import HiddenBlock

TOPICS = (
    system,
    storage,
    path,
    axis,
    kernel,
    plant,
    threads,
    devices,
    engine,
    plc,
    sources,
    followers,
    status,
    network,
)

HIDDEN_BLOCKS: tuple[HiddenBlock, ...] = tuple(
    value for topic in TOPICS for value in vars(topic).values() if isinstance(value, HiddenBlock)
)
