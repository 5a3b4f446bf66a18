"""The XML documents of an agent: devices, streams, assets, errors (MTConnect 1.8)."""

from collections.abc import Iterable, Mapping
from xml.etree import ElementTree as ET

from openacr.bridge.mtconnect.assets import Asset
from openacr.bridge.mtconnect.buffer import Observation
from openacr.bridge.mtconnect.devices import Place
from openacr.bridge.mtconnect.model import (
    ASSET_CHANGED,
    ASSET_REMOVED,
    CUTTING_TOOL,
    OWN,
    Category,
)

VERSION = "1.8"
OWN_NAMESPACE = "urn:openacr:MTConnect:1"
XSI = "http://www.w3.org/2001/XMLSchema-instance"
Header = Mapping[str, object]


def document(
    kind: str, header: Header, body: ET.Element, *, counts: Mapping[str, int] | None = None
) -> bytes:
    """A document: its root of this kind, header and body; in the header assets by type."""
    space = f"urn:mtconnect.org:{kind}:{VERSION}"
    place = f"{space} http://schemas.mtconnect.org/schemas/{kind}_{VERSION}.xsd"
    root = ET.Element(
        kind,
        {
            "xmlns": space,
            f"xmlns:{OWN}": OWN_NAMESPACE,
            "xmlns:xsi": XSI,
            "xsi:schemaLocation": place,
        },
    )
    head = ET.SubElement(root, "Header", {key: str(value) for key, value in header.items()})
    if counts is not None:
        inside = ET.SubElement(head, "AssetCounts")
        for type_, count in counts.items():
            ET.SubElement(inside, "AssetCount", {"assetType": type_}).text = str(count)
    root.append(body)
    return bytes(ET.tostring(root, encoding="UTF-8", xml_declaration=True))


def ids_of(elements: Iterable[ET.Element]) -> frozenset[str]:
    """The ids of the data items that are elements, or are inside them."""
    return frozenset(row.attrib["id"] for each in elements for row in each.iter("DataItem"))


GROUPS = {Category.SAMPLE: "Samples", Category.EVENT: "Events", Category.CONDITION: "Condition"}


def streams(found: Iterable[Observation], places: Mapping[str, Place]) -> ET.Element:
    """Observations by device, component and category; `places` are those of the data items."""
    body = ET.Element("Streams")
    by_component: dict[str, dict[Category, list[Observation]]] = {}
    for each in found:
        place = places[each.item.id].component.attrib["id"]
        groups = by_component.setdefault(place, {})
        groups.setdefault(each.item.category, []).append(each)
    of_devices: dict[str, ET.Element] = {}
    for groups in by_component.values():
        device, component = places[next(iter(groups.values()))[0].item.id]
        named = {key: device.attrib[key] for key in ("name", "uuid")}
        if named["uuid"] not in of_devices:
            of_devices[named["uuid"]] = ET.SubElement(body, "DeviceStream", named)
        of_devices[named["uuid"]].append(_component_stream(component, groups))
    return body


def _component_stream(
    component: ET.Element, groups: Mapping[Category, Iterable[Observation]]
) -> ET.Element:
    """The observations of a component."""
    found = ET.Element(
        "ComponentStream",
        {
            "component": component.tag,
            "componentId": component.attrib["id"],
            "name": component.attrib["name"],
        },
    )
    for category, group in GROUPS.items():
        if category in groups:
            rows = ET.SubElement(found, group)
            rows.extend(_observed(each) for each in groups[category])
    return found


def _observed(each: Observation) -> ET.Element:
    item = each.item
    shown = {
        "dataItemId": item.id,
        "name": item.name,
        "sequence": str(each.sequence),
        "timestamp": each.stamp,
    }
    if item.sub:
        shown["subType"] = item.sub
    if item.type in (ASSET_CHANGED, ASSET_REMOVED):
        shown["assetType"] = CUTTING_TOOL
    if item.category is Category.CONDITION:
        shown["type"] = item.type
        if each.code:
            shown["nativeCode"] = each.code
    element = ET.Element(each.level or item.element, shown)
    element.text = _plain(each.text) or None
    return element


def _plain(text: str) -> str:
    """A text without the characters that XML does not have."""
    return "".join(c for c in text if c >= " " or c in "\t\n")


def assets(found: Iterable[Asset], uuid: str) -> ET.Element:
    """Cutting tools with what the tool table knows; nothing is known of their state."""
    body = ET.Element("Assets")
    for each in found:
        shown = {
            "assetId": each.id,
            "serialNumber": each.id,
            "toolId": str(each.tool.number),
            "deviceUuid": uuid,
            "timestamp": each.stamp,
        }
        if each.is_removed:
            shown["removed"] = "true"
        one = ET.SubElement(body, CUTTING_TOOL, shown)
        ET.SubElement(one, "Description").text = f"{each.tool.tip.name.lower()} end"
        one.append(_life_cycle(each))
    return body


def _life_cycle(asset: Asset) -> ET.Element:
    """What changes with the use of a tool, in the order of the standard."""
    cycle, tool = ET.Element("CuttingToolLifeCycle"), asset.tool
    ET.SubElement(ET.SubElement(cycle, "CutterStatus"), "Status").text = "UNKNOWN"
    if (wear_mm := max(map(abs, tool.wears_mm))) > 0.0:
        life = ET.SubElement(cycle, "ToolLife", {"type": "WEAR", "countDirection": "UP"})
        life.text = f"{wear_mm:.9g}"
    ET.SubElement(cycle, "ProgramToolNumber").text = str(tool.number)
    if asset.is_in_spindle:
        ET.SubElement(cycle, "Location", {"type": "SPINDLE"}).text = ONLY_SPINDLE
    sizes = ET.SubElement(cycle, "Measurements")
    for (name, code), size_mm, worn_mm in zip(SIZES, tool.sizes_mm, tool.wears_mm, strict=True):
        if size_mm is not None:
            row = ET.SubElement(sizes, name, {"code": code, "units": "MILLIMETER"})
            row.text = f"{size_mm:.9g}"
            if worn_mm:
                row.set("nominal", f"{size_mm - worn_mm:.9g}")
    return cycle


SIZES = (("CuttingDiameterMax", "DC"), ("FunctionalLength", "LF"))  # codes of ISO 13399
ONLY_SPINDLE = "0"


def errors(code: str, text: str) -> ET.Element:
    """One error."""
    body = ET.Element("Errors")
    ET.SubElement(body, "Error", {"errorCode": code}).text = _plain(text)
    return body
