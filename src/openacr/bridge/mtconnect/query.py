"""What a request asks for: its parameters, and why it cannot be answered."""

import re
from collections.abc import Iterable, Mapping
from xml.etree import ElementTree as ET

from openacr.bridge.mtconnect.buffer import OutOfRangeError
from openacr.bridge.mtconnect.documents import ids_of

_INTEGER = re.compile(r"-?\d{1,18}")


class RequestError(Exception):
    """A request that cannot be answered: the code of the standard, and the code of HTTP."""

    def __init__(self, code: str, text: str, status: int = 400) -> None:
        super().__init__(text)
        self.code, self.status = code, status


def integer(query: Mapping[str, str], name: str) -> int | None:
    """An integer of a request; None where it is not given."""
    text = query.get(name)
    if text is None:
        return None
    if not _INTEGER.fullmatch(text):
        raise RequestError("INVALID_REQUEST", f"'{name}' must be an integer, not '{text[:40]}'")
    return int(text)


def bounded(query: Mapping[str, str], name: str, low: int, high: int) -> int | None:
    """An integer of a request; OutOfRangeError beyond its limits."""
    value = integer(query, name)
    if value is not None and not low <= value <= high:
        raise OutOfRangeError(f"'{name}' must be within {low} and {high}")
    return value


def switched(query: Mapping[str, str], name: str) -> bool:
    """A switch of a request, off where it is not given."""
    text = query.get(name, "false")
    if text not in ("true", "false"):
        raise RequestError("INVALID_REQUEST", f"'{name}' must be true or false, not '{text[:40]}'")
    return text == "true"


def selected(devices: Iterable[ET.Element], path: str) -> frozenset[str]:
    """The ids of the data items an XPath selects, or those inside what it selects."""
    root = ET.Element("Devices")
    root.extend(devices)
    found: list[ET.Element] = []
    for each in path.split("|"):
        try:
            found += root.findall(f".{each.strip()}")
        except (SyntaxError, KeyError, ValueError, TypeError, StopIteration):
            raise RequestError("INVALID_XPATH", f"The path could not be parsed: {path}") from None
    wanted = ids_of(found)
    if not wanted:
        raise RequestError("INVALID_XPATH", f"The path selects no data item: {path}")
    return wanted
