"""Cutting tools as assets of the MTConnect agent: documents, what is noted, what is refused."""

import re
from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest
from tests.bridge.bench import RUNNING, GivenFeed, bridged, url
from tests.bridge.test_mtconnect import DEVICES, FILE, STAMP, STREAMS, asked, current, head, refused
from tests.waiting import until

from openacr.mill.config.tools import Tip, Tool

ASSETS = "{urn:mtconnect.org:MTConnectAssets:1.8}"
SMALL, LARGE = Tool(3, 3.0, 50.25, Tip.FLAT), Tool(12, None, -7.5, Tip.BALL)
# The order of the standard (MTConnect 1.8, Part 4.1), values as its schema of assets lists them.
LIFE_CYCLE = (
    "CutterStatus", "ReconditionCount", "ToolLife", "ProgramToolGroup", "ProgramToolNumber",
    "Location", "ProcessSpindleSpeed", "ProcessFeedRate", "ConnectionCodeMachineSide",
    "Measurements", "CuttingItems",
)  # fmt: skip
LOCATIONS = {
    "POT", "STATION", "CRIB", "SPINDLE", "TRANSFER_POT", "RETURN_POT", "STAGING_POT", "REMOVAL_POT",
    "EXPIRED_POT", "END_EFFECTOR",
}  # fmt: skip
MEASURED = re.compile(r"[+-]?\d+(\.\d+)?([Ee][+-]?\d+)?")


@pytest.fixture
def feed() -> GivenFeed:
    return GivenFeed(replace(RUNNING, tools=(SMALL, LARGE)))


@pytest.fixture
def agent(feed: GivenFeed) -> Iterator[str]:
    with bridged(FILE, feed) as bridge:
        place = url(bridge, "mtconnect").removesuffix("/probe")
        until(lambda: ids(asked(place, "assets")))
        yield place


def ids(root: ET.Element) -> list[str]:
    assert root.tag == f"{ASSETS}MTConnectAssets"
    return [each.attrib["assetId"] for each in root[1]]


def changed(agent: str, feed: GivenFeed, *tools: Tool) -> int:
    """Change the tool table; the sequence number of the first observation after it."""
    begin = int(head(asked(agent, "current"))["nextSequence"])
    feed.moment = replace(feed.moment, tools=tools)
    until(lambda: int(head(asked(agent, "current"))["nextSequence"]) > begin)
    return begin


def noted(agent: str, begin: int) -> list[tuple[str, str | None]]:
    """The observations of assets from a sequence number on."""
    root = asked(agent, "sample", **{"from": begin})
    found = [each for each in root.iter() if "assetType" in each.attrib]
    assert {each.attrib["assetType"] for each in found} <= {"CuttingTool"}
    found.sort(key=lambda each: int(each.attrib["sequence"]))
    return [(each.tag.removeprefix(STREAMS), each.text) for each in found]


def test_every_tool_of_the_table_is_a_cutting_tool(agent: str) -> None:
    root = asked(agent, "asset/mill.T3")
    (tool,) = root[1]
    shown = dict(tool.attrib)
    assert STAMP.fullmatch(shown.pop("timestamp"))
    assert shown == {
        "assetId": "mill.T3", "serialNumber": "mill.T3", "toolId": "3", "deviceUuid": "u-1",
    }  # fmt: skip
    text = [(each.tag.removeprefix(ASSETS), each.attrib, each.text) for each in tool.iter()]
    assert text[1:] == [
        ("Description", {}, "flat end"),
        ("CuttingToolLifeCycle", {}, None),
        ("CutterStatus", {}, None),
        ("Status", {}, "UNKNOWN"),
        ("ProgramToolNumber", {}, "3"),
        ("Location", {"type": "SPINDLE"}, "0"),
        ("Measurements", {}, None),
        ("CuttingDiameterMax", {"code": "DC", "units": "MILLIMETER"}, "6"),
        ("FunctionalLength", {"code": "LF", "units": "MILLIMETER"}, "50.25"),
    ]
    (other,) = asked(agent, "asset/mill.T12")[1]
    sizes = other.find(f".//{ASSETS}Measurements")
    assert sizes is not None
    assert [(each.tag.removeprefix(ASSETS), each.text) for each in sizes] == [
        ("FunctionalLength", "-7.5"),
    ]  # fmt: skip
    assert other[0].text == "ball end"


def life_cycle(agent: str, name: str) -> ET.Element:
    """The life cycle of a tool, in the form the schema asks for."""
    found = asked(agent, f"asset/{name}")[1][0].find(f"{ASSETS}CuttingToolLifeCycle")
    assert found is not None
    tags = [each.tag.removeprefix(ASSETS) for each in found]
    assert tags == sorted(set(tags), key=LIFE_CYCLE.index)
    for life in found.iter(f"{ASSETS}ToolLife"):
        assert set(life.attrib) == {"type", "countDirection"}
        assert (life.attrib["type"], life.attrib["countDirection"]) == ("WEAR", "UP")
        assert float(life.text or "") > 0.0
    for place in found.iter(f"{ASSETS}Location"):
        assert place.attrib["type"] in LOCATIONS
        assert str(int(place.text or "")) == place.text
    (sizes,) = found.iter(f"{ASSETS}Measurements")
    assert len(sizes) > 0
    assert all(MEASURED.fullmatch(size.text or "") for size in sizes)
    return found


@pytest.mark.parametrize(
    ("radius_wear_u", "length_wear_u", "life"),
    [(-0.01, 0.0, "0.02"), (0.0, -0.25, "0.25"), (-0.2, 0.25, "0.4"), (0.0, 0.0, None)],
)
def test_the_life_of_a_tool_is_its_greater_wear_and_its_sizes_have_nominal_ones(
    agent: str, feed: GivenFeed, radius_wear_u: float, length_wear_u: float, life: str | None
) -> None:
    worn = replace(
        SMALL, radius_u=3.0 + radius_wear_u, length_u=50.25 + length_wear_u,
        radius_wear_u=radius_wear_u, length_wear_u=length_wear_u,
    )  # fmt: skip
    changed(agent, feed, worn, replace(LARGE, length_u=-7.25))
    found = life_cycle(agent, "mill.T3")
    shown = [each.text for each in found.iter(f"{ASSETS}ToolLife")]
    assert shown == ([] if life is None else [life])
    (sizes,) = found.iter(f"{ASSETS}Measurements")
    assert [float(size.text or "") for size in sizes] == [
        pytest.approx(6.0 + 2.0 * radius_wear_u), pytest.approx(50.25 + length_wear_u),
    ]  # fmt: skip
    assert [size.get("nominal") for size in sizes] == [
        "6" if radius_wear_u else None, "50.25" if length_wear_u else None,
    ]  # fmt: skip


def test_the_place_of_the_tool_in_the_spindle_is_known_and_no_other(
    agent: str, feed: GivenFeed
) -> None:
    def in_spindle() -> list[str]:
        names = ("mill.T3", "mill.T12")
        return [n for n in names if list(life_cycle(agent, n).iter(f"{ASSETS}Location"))]

    def load(tool: int | None) -> list[tuple[str, str | None]]:
        begin = int(head(asked(agent, "current"))["nextSequence"])
        assert feed.moment.run is not None
        run = replace(feed.moment.run, tool=tool or 0)
        feed.moment = replace(feed.moment, run=run)
        until(lambda: current(agent)["tool"].text == str(tool or 0))
        return sorted(noted(agent, begin))

    assert in_spindle() == ["mill.T3"]
    assert load(12) == [("AssetChanged", "mill.T12"), ("AssetChanged", "mill.T3")]
    assert in_spindle() == ["mill.T12"]
    assert load(None) == [("AssetChanged", "mill.T12")]
    assert in_spindle() == []


def test_assets_are_counted_in_the_headers(agent: str) -> None:
    header = head(asked(agent, "assets"))
    assert (header["assetCount"], header["assetBufferSize"]) == ("2", "999")
    root = asked(agent, "probe")
    assert (head(root)["assetCount"], head(root)["assetBufferSize"]) == ("2", "999")
    (count,) = root.iter(f"{DEVICES}AssetCount")
    assert (count.attrib, count.text) == ({"assetType": "CuttingTool"}, "2")
    assert list(asked(agent, "assets")[0]) == []


def test_the_device_says_that_it_reports_changed_and_removed_assets(agent: str) -> None:
    rows = {
        row.attrib["type"]: row.attrib for row in asked(agent, "probe").iter(f"{DEVICES}DataItem")
    }
    assert rows["ASSET_CHANGED"] == {
        "category": "EVENT", "id": "tools", "name": "tools", "type": "ASSET_CHANGED",
        "discrete": "true",
    }  # fmt: skip
    assert rows["ASSET_REMOVED"] == {
        "category": "EVENT", "id": "tools_removed", "name": "tools_removed",
        "type": "ASSET_REMOVED",
    }  # fmt: skip


@pytest.mark.parametrize("path", ["assets", "asset", "mill/assets", "u-1/asset"])
def test_the_assets_are_found_by_every_of_their_addresses(agent: str, path: str) -> None:
    assert ids(asked(agent, path)) == ["mill.T12", "mill.T3"]


def test_assets_are_chosen_by_id_count_type_and_device(agent: str) -> None:
    assert ids(asked(agent, "assets/mill.T3;mill.T12")) == ["mill.T3", "mill.T12"]
    assert ids(asked(agent, "mill/asset/mill.T12")) == ["mill.T12"]
    assert ids(asked(agent, "assets", count=1)) == ["mill.T12"]
    assert ids(asked(agent, "assets", type="CuttingTool", device="u-1")) == ["mill.T12", "mill.T3"]
    assert ids(asked(agent, "assets", type="Pallet")) == []
    assert ids(asked(agent, "assets", device="Agent")) == []


def test_what_cannot_be_asked_of_assets_is_refused_by_code(agent: str) -> None:
    assert refused(agent, "asset/mill.T3;mill.T4", 404) == (
        "ASSET_NOT_FOUND", "Could not find the asset 'mill.T4'",
    )  # fmt: skip
    assert refused(agent, "assets", 404, device="lathe")[0] == "NO_DEVICE"
    assert refused(agent, "lathe/assets", 404)[0] == "NO_DEVICE"
    assert refused(agent, "assets", 404, count=0) == (
        "OUT_OF_RANGE", "'count' must be within 1 and 999",
    )  # fmt: skip
    assert ids(asked(agent, "assets", count=999)) == ["mill.T12", "mill.T3"]
    assert refused(agent, "assets", 404, count=1000)[0] == "OUT_OF_RANGE"
    assert refused(agent, "assets", 400, removed="yes")[0] == "INVALID_REQUEST"
    assert refused(agent, "assets/mill.T3/more", 400)[0] == "UNSUPPORTED"


def test_a_changed_tool_is_noted_each_time_and_comes_first(agent: str, feed: GivenFeed) -> None:
    begin = changed(agent, feed, replace(SMALL, length_u=50.5), LARGE)
    assert noted(agent, begin) == [("AssetChanged", "mill.T3")]
    assert ids(asked(agent, "assets")) == ["mill.T3", "mill.T12"]
    begin = changed(agent, feed, replace(SMALL, length_u=50.75), LARGE)
    assert noted(agent, begin) == [("AssetChanged", "mill.T3")]
    begin = changed(
        agent, feed, replace(SMALL, length_u=50.75), LARGE, Tool(4, 1.0, None, Tip.FLAT)
    )
    assert noted(agent, begin) == [("AssetChanged", "mill.T4")]
    assert head(asked(agent, "assets"))["assetCount"] == "3"


def test_a_removed_tool_is_noted_and_shown_where_it_is_asked_for(
    agent: str, feed: GivenFeed
) -> None:
    begin = changed(agent, feed, LARGE)
    assert noted(agent, begin) == [("AssetRemoved", "mill.T3")]
    assert current(agent)["tools"].text == "mill.T12"
    root = asked(agent, "assets")
    assert (ids(root), head(root)["assetCount"]) == (["mill.T12"], "1")
    assert ids(asked(agent, "assets", removed="false")) == ["mill.T12"]
    every = asked(agent, "assets", removed="true")
    assert [each.get("removed") for each in every[1]] == [None, "true"]
    assert ids(every) == ["mill.T12", "mill.T3"]
    assert asked(agent, "asset/mill.T3")[1][0].attrib["removed"] == "true"
    begin = changed(agent, feed, LARGE, SMALL)
    assert noted(agent, begin) == [("AssetChanged", "mill.T3")]
    assert asked(agent, "asset/mill.T3")[1][0].get("removed") is None


def test_the_last_changed_tool_is_no_longer_it_when_it_is_removed(
    agent: str, feed: GivenFeed
) -> None:
    begin = changed(agent, feed, SMALL)
    assert noted(agent, begin) == [
        ("AssetRemoved", "mill.T12"), ("AssetChanged", "UNAVAILABLE"),
    ]  # fmt: skip
    begin = changed(agent, feed)
    assert noted(agent, begin) == [("AssetRemoved", "mill.T3")]


def test_a_machine_that_comes_back_has_its_assets_without_a_change(
    agent: str, feed: GivenFeed
) -> None:
    before = asked(agent, "asset/mill.T3")[1][0].attrib
    known = feed.moment
    feed.lose()
    until(lambda: current(agent)["tools"].text == "UNAVAILABLE")
    assert ids(asked(agent, "assets")) == ["mill.T12", "mill.T3"]
    begin = int(head(asked(agent, "current"))["nextSequence"])
    feed.moment = known
    until(lambda: current(agent)["available"].text == "AVAILABLE")
    assert noted(agent, begin) == []
    assert asked(agent, "asset/mill.T3")[1][0].attrib == before
