"""The systems a bridge file configures. Their packages are imported only where they are used."""

from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any

from openacr.bridge.bridge import Bridge, System
from openacr.bridge.feed import Feed
from openacr.bridge.items import Item
from openacr.bridge.load import secrets_of, systems_of
from openacr.bridge.settings import BridgeFile
from openacr.bridge.setup import Setup
from openacr.bridge.writing import Writer
from openacr.errors import UserError

# Table of the file: module and class, which takes a set-up and its table.
CLASSES = {
    "prometheus": ("openacr.bridge.prometheus", "PrometheusSystem"),
    "mtconnect": ("openacr.bridge.mtconnect.agent", "MTConnectSystem"),
    "opcua": ("openacr.bridge.opcua.server", "OpcUaSystem"),
    "sparkplug": ("openacr.bridge.sparkplug.node", "SparkplugSystem"),
    "epics": ("openacr.bridge.epics", "EpicsSystem"),
}
MISSING = "a bridge to {} needs more packages ({}): pip install 'openacr[bridge]'"


def bridge_of(file: BridgeFile, folder: Path, feed: Feed) -> Bridge:
    """The bridge of a file, whose passwords are in files of a folder; UserError if it cannot be."""
    secrets = secrets_of(file, folder)
    found: list[tuple[Callable[..., System], Any, str | None]] = [
        (_class_of(name), table, secrets[name]) for name, table in systems_of(file).items()
    ]
    writer = Writer(feed)

    def make(items: tuple[Item, ...]) -> list[System]:
        return [
            system(Setup(items, file.name, secret, folder, writer), table)
            for system, table, secret in found
        ]

    return Bridge(file, feed, make)


def _class_of(name: str) -> Callable[..., System]:
    module, kind = CLASSES[name]
    try:
        found: Callable[..., System] = getattr(import_module(module), kind)
    except ModuleNotFoundError as error:
        raise UserError(MISSING.format(name, error.name)) from None
    return found
