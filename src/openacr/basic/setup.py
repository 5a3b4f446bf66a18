"""Settings of the card that take effect at the next REBOOT: hardware and network."""

from dataclasses import dataclass, field

from openacr.errors import CardError
from openacr.messages import INVALID_ARGUMENT

DEFAULT_CONFIG = ("ENC8", "DAC4", "DAC4", "ADC8")
_ENCODERS = ("NONE", *(f"ENC{count}" for count in (2, 3, 4, 6, 8, 10)))
_OUTPUTS = ("NONE", "DAC2", "DAC4", "STEPPER2", "STEPPER4")
_MODULES = (_ENCODERS, (*_OUTPUTS, "DACSTEP2", "DACSTEP4"), _OUTPUTS, ("NONE", "ADC8"))


@dataclass(slots=True)
class Setup:
    """CONFIG and IP as set; addresses are dotted."""

    config: tuple[str, ...] = DEFAULT_CONFIG
    addresses: dict[str, str] = field(
        default_factory=lambda: {"IP": "192.168.10.40", "MASK": "255.255.255.0", "GATE": "0.0.0.0"}
    )

    def configure(self, modules: tuple[str, ...]) -> None:
        """CONFIG enc mod0 mod1 mod2."""
        for module, allowed in zip(modules, _MODULES, strict=True):
            if module not in allowed:
                raise CardError(INVALID_ARGUMENT)
        self.config = modules

    def set_address(self, name: str, text: str) -> None:
        """IP, IP MASK or IP GATE; all numbers are checked before anything changes."""
        changed = self.addresses | {name: ".".join(map(str, _octets(text)))}
        if name == "IP":
            _check_host(_octets(text), _octets(changed["MASK"]))
        self.addresses = changed

    def state(self) -> tuple[tuple[str, ...], dict[str, str]]:
        """Both settings, for a snapshot."""
        return self.config, dict(self.addresses)

    def restore(self, state: tuple[tuple[str, ...], dict[str, str]]) -> None:
        """Take over what `state` returned."""
        config, addresses = state
        self.config, self.addresses = config, dict(addresses)


def _octets(text: str) -> list[int]:
    """The four numbers of a dotted address."""
    parts = text.strip().split(".")
    if len(parts) != 4 or not all(part.isascii() and part.isdigit() for part in parts):
        raise CardError(INVALID_ARGUMENT)
    octets = [int(part) for part in parts]
    if max(octets) > 255:
        raise CardError(INVALID_ARGUMENT)
    return octets


def _check_host(address: list[int], mask: list[int]) -> None:
    """A host address has no octet 255, and its part outside the mask is not zero."""
    host = [octet & ~bits & 255 for octet, bits in zip(address, mask, strict=True)]
    if 255 in address or not any(host):
        raise CardError(INVALID_ARGUMENT)
