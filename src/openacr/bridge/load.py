"""Read a bridge file; errors give the line, the value and the permitted values."""

from collections.abc import Iterator
from pathlib import Path

from openacr.bridge.settings import BridgeFile, Chosen, Listening
from openacr.errors import OpenacrError, SourceError, UserError
from openacr.io.server import is_loopback
from openacr.map import parameters
from openacr.plant.describe import toml_file
from openacr.plant.describe.complaint import Complaint
from openacr.plant.describe.explaining import explain, not_finite

MOST_SECRET = 1000


def load_bridge(path: Path) -> BridgeFile:
    """Read and check a bridge file; SourceError with all that is wrong in it."""
    return parse_bridge(toml_file.read_text(path), str(path))


def parse_bridge(text: str, path: str = "bridge.toml") -> BridgeFile:
    """Check the text of a bridge file; everything wrong is raised together, with its places."""
    raw = toml_file.parse(text, path)
    found, messages = toml_file.convert_all(raw, BridgeFile)
    complaints = list(not_finite(raw))
    if not complaints:
        complaints = [explain(message, raw, BridgeFile) for message in messages]
    if found is not None and not complaints:
        complaints = list(problems(found))
    toml_file.refuse(_placed(text, path, complaints))
    if found is None:
        raise toml_file.wrong(text, path, (), "it describes no bridge")
    return found


def _placed(text: str, path: str, complaints: list[Complaint]) -> Iterator[SourceError]:
    return (toml_file.wrong(text, path, each.path, each.text, each.hint) for each in complaints)


def problems(file: BridgeFile) -> Iterator[Complaint]:
    """What is wrong although every value has the right type."""
    systems = systems_of(file)
    if not systems:
        known = ", ".join(name for name in SYSTEMS)
        yield Complaint((), f"no system is configured: it has none of the tables {known}")
    for name, system in systems.items():
        if isinstance(system, Listening) and system.password_file is None:
            if not is_loopback(system.address):
                what = f"{name}.address: other computers reach {system.address}"
                yield Complaint((name, "address"), f"{what}, and no password_file is given")
    yield from _of_opcua(file)
    yield from _of_sparkplug(file)
    if file.epics is not None and not file.epics.insecure and not is_loopback(file.epics.address):
        what = f"epics.address: other computers reach {file.epics.address}, without a password"
        yield Complaint(("epics", "address"), what, "insecure = true allows it")
    names: set[str] = set()
    for place, each in enumerate(file.value):
        yield from _of_value(("value", place), each, names)
        names.add(each.name)
    if len(set(file.card.axes)) < len(file.card.axes):
        yield Complaint(("card", "axes"), "card.axes: two axes have the same letter")


def _of_opcua(file: BridgeFile) -> Iterator[Complaint]:
    """Certificate and key belong together; other computers need both."""
    system = file.opcua
    if system is None:
        return
    if (system.certificate is None) != (system.private_key is None):
        yield Complaint(("opcua",), "opcua: certificate and private_key are given together")
    elif system.certificate is None and system.trusted is not None:
        what = "opcua.trusted: hosts show certificates only to a server that has one"
        yield Complaint(("opcua", "trusted"), what, "certificate and private_key")
    elif system.certificate is None and not is_loopback(system.address):
        what = f"opcua.address: other computers reach {system.address}"
        hint = "without a certificate passwords and values are not encrypted"
        yield Complaint(("opcua", "address"), f"{what}, and no certificate is given", hint)


def _of_sparkplug(file: BridgeFile) -> Iterator[Complaint]:
    """A password needs a user, and TLS on its path to another computer."""
    system = file.sparkplug
    if system is None:
        return
    if system.password_file is not None and system.user is None:
        yield Complaint(("sparkplug",), "sparkplug: password_file needs a user")
    if system.password_file is not None and not system.tls and not is_loopback(system.address):
        what = f"sparkplug: the password would reach {system.address} in clear text"
        yield Complaint(("sparkplug", "password_file"), what, "tls = true")
    keys = (system.authority, system.certificate, system.private_key)
    if not system.tls and any(key is not None for key in keys):
        yield Complaint(("sparkplug",), "sparkplug: certificates need tls = true")
    if (system.certificate is None) != (system.private_key is None):
        yield Complaint(("sparkplug",), "sparkplug: certificate and private_key are given together")


def _of_value(place: tuple[str | int, ...], each: Chosen, names: set[str]) -> Iterator[Complaint]:
    if each.name in names:
        yield Complaint((*place, "name"), f"value {each.name}: the name is used twice")
    if (each.parameter is None) == (each.flag is None):
        yield Complaint(place, f"value {each.name}: give either parameter or flag")
        return
    try:
        if each.parameter_number not in parameters():
            kind = "flag" if each.is_flag else "parameter"
            yield Complaint(place, f"value {each.name}: a card has no {kind} {each.number}")
    except OpenacrError as error:
        yield Complaint(place, f"value {each.name}: {error}")
    limits = (each.low, each.high)
    if each.is_flag and limits != (None, None):
        yield Complaint(place, f"value {each.name}: a flag has no low and high")
    elif each.write and not each.is_flag and None in limits:
        yield Complaint(place, f"value {each.name}: to be written it needs low and high")
    elif each.low is not None and each.high is not None and each.low > each.high:
        yield Complaint(place, f"value {each.name}: low {each.low:g} is above high {each.high:g}")


SYSTEMS = tuple(
    name
    for name in BridgeFile.__struct_fields__
    if name not in ("name", "rate_hz", "card", "value")
)


def systems_of(file: BridgeFile) -> dict[str, object]:
    """The configured systems by the names of their tables."""
    found = {name: getattr(file, name) for name in SYSTEMS}
    return {name: each for name, each in found.items() if each is not None}


def secrets_of(file: BridgeFile, folder: Path) -> dict[str, str | None]:
    """The password of each configured system; UserError where its file has none."""
    return {
        name: secret_of(folder, getattr(table, "password_file", None))
        for name, table in systems_of(file).items()
    }


def secret_of(folder: Path, name: str | None) -> str | None:
    """The password in a file beside the bridge file: its first line; None if none is named."""
    if name is None:
        return None
    path = folder / name
    lines = toml_file.read_text(path).splitlines()
    if not lines or not lines[0].strip() or len(lines[0]) > MOST_SECRET:
        raise UserError(f"{path}: the first line has to be the password")
    return lines[0].strip()
