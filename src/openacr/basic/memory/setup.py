"""Settings of the card that take effect at the next REBOOT: hardware and network."""

from dataclasses import dataclass, field

from openacr.basic.memory.ip_address import IpAddress
from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT

DEFAULT_CONFIG = ("ENC8", "DAC4", "DAC4", "ADC8")
_ENCODERS = ("NONE", *(f"ENC{count}" for count in (2, 3, 4, 6, 8, 10)))
_OUTPUTS = ("NONE", "DAC2", "DAC4", "STEPPER2", "STEPPER4")
_MODULES = (_ENCODERS, (*_OUTPUTS, "DACSTEP2", "DACSTEP4"), _OUTPUTS, ("NONE", "ADC8"))
_PLACES = ("the encoders", "module 0", "module 1", "module 2")


def wrong_module(modules: tuple[str, ...]) -> str:
    """The first module that its place does not take, and those it takes; empty if all fit."""
    for module, allowed, place in zip(modules, _MODULES, _PLACES, strict=True):
        if module not in allowed:
            return f"{module} for {place}: known are {', '.join(allowed)}"
    return ""


@dataclass(slots=True)
class Setup:
    """CONFIG and IP as set; addresses are dotted."""

    config: tuple[str, ...] = DEFAULT_CONFIG
    addresses: dict[str, str] = field(
        default_factory=lambda: {"IP": "192.168.10.40", "MASK": "255.255.255.0", "GATE": "0.0.0.0"}
    )

    def configure(self, modules: tuple[str, ...]) -> None:
        """CONFIG enc mod0 mod1 mod2."""
        if wrong_module(modules):
            raise CardError(INVALID_ARGUMENT)
        self.config = modules

    def set_address(self, name: str, text: str) -> None:
        """IP, IP MASK or IP GATE; all numbers are checked before anything changes."""
        address = IpAddress.read(text)
        if name == "IP":
            address.check_host(IpAddress.read(self.addresses["MASK"]))
        self.addresses = self.addresses | {name: str(address)}

    def restore(self, config: tuple[str, ...], addresses: dict[str, str]) -> None:
        """Take over both settings from a snapshot."""
        if addresses.keys() != self.addresses.keys():
            raise CardError(INVALID_ARGUMENT)
        self.configure(config)
        self.addresses = {name: str(IpAddress.read(text)) for name, text in addresses.items()}
