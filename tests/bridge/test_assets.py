"""Cutting tools as assets of the MTConnect agent: documents, what is noted, what is refused."""

from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest
from tests.bridge.bench import RUNNING, GivenFeed, bridged, until, url
from tests.bridge.test_mtconnect import DEVICES, FILE, STAMP, STREAMS, asked, current, head, refused

from openacr.mill.config.tools import Tip, Tool

ASSETS = "{urn:mtconnect.org:MTConnectAssets:1.8}"
SMALL, LARGE = Tool(3, 3.0, 50.25, Tip.FLAT), Tool(12, None, -7.5, Tip.BALL)


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
