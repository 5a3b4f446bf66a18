"""What a parameter or flag is, as facts with names: for the command line and for editors."""

from openacr.map.block import Access, Kind, Packet, Speed
from openacr.map.lookup import Flag, Parameter, is_described
from openacr.units import explain

GET_PACKET = 0x00
ACCESS = {
    Access.READ: "read",
    Access.WRITE: "write",
    Access.READ_WRITE: "read, write",
    Access.RESERVED: "reserved",
    Access.UNKNOWN: "not stated in the manual",
}
KIND = {
    Kind.LONG: "LONG (32-bit integer)",
    Kind.FP32: "FP32 (32-bit float)",
    Kind.FP64: "FP64 (64-bit float)",
}
SPEED = {Speed.FAST: "every servo period", Speed.SLOW: "in the slow scan"}


def facts_of(record: Parameter | Flag) -> dict[str, str]:
    """The facts that are known, by their names."""
    found = _of_flag(record) if isinstance(record, Flag) else _of_parameter(record)
    return {name: value for name, value in found.items() if value}


def object_of(record: Parameter | Flag) -> str:
    """The object a record belongs to, with its number: `axis 2`."""
    return record.object if record.index is None else f"{record.object} {record.index}"


def has_meaning(record: Parameter | Flag) -> bool:
    """Whether the manual says what it is."""
    return record.access is not Access.RESERVED and is_described(record.name)


def _of_parameter(parameter: Parameter) -> dict[str, str]:
    unit = f"{parameter.unit} ({explain(parameter.unit)})" if parameter.unit else ""
    return {
        "Object": object_of(parameter),
        "Section": parameter.section,
        "Type": KIND[parameter.kind],
        "Access": ACCESS[parameter.access],
        "Unit": unit,
        "At power-up": f"{parameter.default:g}" if parameter.default else "",
        "Packet": _packet(parameter.packet),
        "Reference": parameter.ref,
        "Erratum": parameter.erratum,
    }


def _of_flag(flag: Flag) -> dict[str, str]:
    return {
        "Object": object_of(flag),
        "Section": flag.section,
        "In the manual": "" if flag.printed == flag.name else "numbered, not named",
        "Held by": f"bit {flag.bit} of P{flag.parameter} (mask 0x{1 << flag.bit:08X})",
        "Access": ACCESS[flag.access],
        "Updated": SPEED.get(flag.speed, "not stated in the manual"),
        "Reference": flag.ref,
        "Erratum": flag.erratum,
    }


def _packet(packet: Packet | None) -> str:
    if packet is None:
        return "none documented"
    code, index, mask = packet.code, packet.group_index, packet.mask
    request = bytes((GET_PACKET, code, index, mask)).hex(" ").upper()
    return f"{request} (group 0x{code:02X}, index 0x{index:02X}, mask 0x{mask:02X})"
