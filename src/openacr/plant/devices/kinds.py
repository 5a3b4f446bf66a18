"""Which class a device of machine.toml is: one of the library, or of a file of the project."""

from pathlib import Path
from types import ModuleType
from typing import Final

import msgspec

from openacr.errors import UserError, reason
from openacr.plant.devices.conveyor import Conveyor
from openacr.plant.devices.device import Device
from openacr.plant.devices.gripper import Gripper
from openacr.plant.devices.light_curtain import LightCurtain
from openacr.plant.devices.spindle import Spindle
from openacr.plant.devices.tool_changer import ToolChanger
from openacr.plant.devices.vacuum import VacuumCup

LIBRARY: Final[dict[str, type[Device]]] = {
    "conveyor": Conveyor,
    "gripper": Gripper,
    "light-curtain": LightCurtain,
    "spindle": Spindle,
    "tool-changer": ToolChanger,
    "vacuum-cup": VacuumCup,
}
OWN = ".py:"


def is_own(kind: str) -> bool:
    """Whether a kind is a class of a file: `press.py:Press`."""
    return OWN in kind


def device_class(kind: str, folder: Path | None) -> type[Device]:
    """The class of a kind; own ones are in files of a folder. UserError if there is none.

    This executes the file.
    """
    if not is_own(kind):
        return LIBRARY[kind]
    file, _, name = kind.rpartition(":")
    if folder is None:
        raise UserError(f"the device {kind} is Python code, and no folder with {file} is given")
    found = getattr(_module(folder / file), name, None)
    if not (isinstance(found, type) and issubclass(found, Device) and found is not Device):
        raise UserError(f"{folder / file} has no class {name} that is a Device")
    for side in (found.COMMANDS, found.SIGNALS):
        if not all(each in (bool, float) for each in side.values()):
            raise UserError(f"{folder / file}: commands and signals of {name} are bool or float")
    return found


def _module(path: Path) -> ModuleType:
    module = ModuleType(path.stem)
    module.__file__ = str(path)
    try:
        exec(compile(path.read_bytes(), path, "exec"), module.__dict__)
    except OSError as failure:
        raise UserError(f"{path} cannot be read: {reason(failure)}") from None
    except Exception as error:
        raise UserError(f"{path}: {type(error).__name__}: {error}") from error
    return module


def made(found: type[Device], settings: dict[str, bool | int | float | str]) -> Device:
    """A device with its settings; UserError for one that it does not have or that is wrong."""
    known = [name for name in found.__struct_fields__ if not name.startswith("_")]
    for name in settings:
        if name not in known:
            raise UserError(f"no setting {name!r}: " + (", ".join(known) or "there are none"))
    try:
        return msgspec.convert(settings, found)
    except msgspec.ValidationError as error:
        raise UserError(f"settings: {error}") from None
