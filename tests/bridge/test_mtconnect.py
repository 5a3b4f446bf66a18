"""The MTConnect agent over HTTP: documents, sequence numbers, streams and what it refuses."""

import re
from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree as ET

import httpx
import pytest
from tests.bridge.bench import VALUES, GivenFeed, bridged, url
from tests.waiting import LIMIT_S, until

from openacr.bridge.clock import stamp
from openacr.bridge.items import items_of
from openacr.bridge.mtconnect.buffer import Buffer, OutOfRangeError
from openacr.bridge.mtconnect.model import data_item
from openacr.bridge.rows import Alarm

FILE = 'name = "mill"\nrate_hz = 50\n[mtconnect]\nport = 0\nuuid = "u-1"\n' + VALUES
STREAMS = "{urn:mtconnect.org:MTConnectStreams:1.8}"
DEVICES = "{urn:mtconnect.org:MTConnectDevices:1.8}"
ERROR = "{urn:mtconnect.org:MTConnectError:1.8}"
OWN = "{urn:openacr:MTConnect:1}"
STAMP = re.compile(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z")


@pytest.fixture
def feed() -> GivenFeed:
    return GivenFeed()


@pytest.fixture
def agent(feed: GivenFeed) -> Iterator[str]:
    with bridged(FILE, feed) as bridge:
        place = url(bridge, "mtconnect").removesuffix("/probe")
        until(lambda: current(place)["line"].text == "12")
        yield place


def asked(agent: str, where: str, status: int = 200, /, **query: object) -> ET.Element:
    answer = httpx.get(
        f"{agent}/{where}", params={k: str(v) for k, v in query.items()}, timeout=LIMIT_S
    )
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"].startswith("text/xml")
    return ET.fromstring(answer.text)


def refused(agent: str, where: str, status: int, /, **query: object) -> tuple[str, str]:
    """Code and text of an error document."""
    root = asked(agent, where, status, **query)
    assert root.tag == f"{ERROR}MTConnectError"
    (error,) = root.iter(f"{ERROR}Error")
    return error.attrib["errorCode"], error.text or ""


def head(root: ET.Element) -> dict[str, str]:
    return root[0].attrib


def observed(root: ET.Element) -> list[ET.Element]:
    return [each for each in root.iter() if "dataItemId" in each.attrib]


def current(agent: str, **query: object) -> dict[str, ET.Element]:
    return {each.attrib["dataItemId"]: each for each in observed(asked(agent, "current", **query))}


# --- probe ----------------------------------------------------------------------------


def test_the_device_has_its_components_and_every_value_as_a_data_item(agent: str) -> None:
    root = asked(agent, "probe")
    assert root.tag == f"{DEVICES}MTConnectDevices"
    device = root[1][0]
    assert device.attrib == {"id": "device", "name": "mill", "uuid": "u-1"}
    tags = [each.tag.removeprefix(DEVICES) for each in device.iter() if "name" in each.attrib]
    assert [tag for tag in tags if tag != "DataItem"] == [
        "Device", "Axes", "Linear", "Linear", "Rotary", "Rotary", "Controller", "Path",
    ]  # fmt: skip
    rows = {row.attrib["id"]: row.attrib for row in device.iter(f"{DEVICES}DataItem")}
    items = items_of(GivenFeed().axes)
    assert set(rows) == {item.name.replace(".", "_") for item in items} | {
        "user_pulses", "user_gate", "tools_removed",
    }  # fmt: skip
    assert rows["X_actual"] == {
        "category": "SAMPLE", "id": "X_actual", "name": "X.actual", "type": "POSITION",
        "subType": "ACTUAL", "units": "MILLIMETER", "coordinateSystem": "MACHINE",
    }  # fmt: skip
    assert (rows["C_actual"]["type"], rows["C_actual"]["units"]) == ("ANGLE", "DEGREE")
    assert rows["X_to_go"]["type"] == "x:TO_GO"
    assert (rows["feed_override"]["category"], rows["feed_override"]["subType"]) == (
        "EVENT", "PROGRAMMED",
    )  # fmt: skip
    assert rows["alarms"]["category"] == "CONDITION"
    assert rows["line"]["category"] == rows["user_gate"]["category"] == "EVENT"
    assert "units" not in rows["user_pulses"]


def test_data_items_are_in_the_components_the_standard_has_for_them(agent: str) -> None:
    device = asked(agent, "probe")[1][0]
    places = {
        row.attrib["id"]: component.attrib.get("id")
        for component in device.iter()
        for row in component.findall(f"{DEVICES}DataItems/{DEVICES}DataItem")
    }
    chosen = ("available", "alarms", "execution", "spindle_speed", "Y_actual", "user_gate", "mode")
    assert [places[each] for each in chosen] == [
        "device", "controller", "path", "spindle", "axis_Y", "controller", "controller",
    ]  # fmt: skip


@pytest.mark.parametrize("path", ["", "probe", "mill", "mill/probe", "u-1/probe"])
def test_the_probe_is_found_by_every_of_its_addresses(agent: str, path: str) -> None:
    assert asked(agent, path).tag == f"{DEVICES}MTConnectDevices"


def test_the_agent_is_a_device_with_the_connection_to_its_machine(agent: str) -> None:
    device, itself = asked(agent, "probe")[1]
    assert (itself.tag, itself.attrib["name"]) == (f"{DEVICES}Agent", "Agent")
    assert itself.attrib["uuid"] not in ("", device.attrib["uuid"])
    places = {
        row.attrib["type"]: component.tag.removeprefix(DEVICES)
        for component in itself.iter()
        for row in component.findall(f"{DEVICES}DataItems/{DEVICES}DataItem")
    }
    assert places == {
        "AVAILABILITY": "Agent", "DEVICE_ADDED": "Agent", "DEVICE_REMOVED": "Agent",
        "DEVICE_CHANGED": "Agent", "CONNECTION_STATUS": "Adapter",
    }  # fmt: skip
    ids = [each.attrib["id"] for each in asked(agent, "probe").iter() if "id" in each.attrib]
    assert len(ids) == len(set(ids))


@pytest.mark.parametrize("by", ["name", "uuid"])
def test_a_request_to_one_device_is_answered_for_it_alone(agent: str, by: str) -> None:
    for place, device in enumerate(asked(agent, "probe")[1]):
        name = device.attrib[by]
        assert [each.attrib[by] for each in asked(agent, f"{name}/probe")[1]] == [name]
        for request in ("current", "sample"):
            (stream,) = asked(agent, f"{name}/{request}")[1]
            assert stream.attrib[by] == name
        tools = asked(agent, f"{name}/assets")[1]
        assert [each.attrib["assetId"] for each in tools] == [["mill.T12", "mill.T3"], []][place]
    both = [each.attrib["name"] for each in asked(agent, "current")[1]]
    assert both == ["mill", "Agent"]
    assert refused(agent, "Agent/current", 400, path="//Linear")[0] == "INVALID_XPATH"


ALWAYS = {"creationTime", "sender", "instanceId", "version"}
HEADERS = {
    "probe": {"deviceModelChangeTime", "bufferSize", "assetBufferSize", "assetCount"},
    "current": {
        "deviceModelChangeTime", "bufferSize", "firstSequence", "lastSequence", "nextSequence",
    },
    "assets": {"deviceModelChangeTime", "assetBufferSize", "assetCount"},
    "nothing": {"bufferSize"},
}  # fmt: skip


@pytest.mark.parametrize("request_", HEADERS)
def test_a_header_has_the_attributes_that_the_schema_of_its_document_lists(
    agent: str, request_: str
) -> None:
    """MTConnectDevices, Streams, Assets and Error 1.8, the type HeaderType: all are required."""
    root = asked(agent, request_, 404 if request_ == "nothing" else 200)
    assert set(head(root)) == ALWAYS | HEADERS[request_]


# --- current --------------------------------------------------------------------------


def test_the_current_state_has_every_value_once(agent: str) -> None:
    found = current(agent)
    texts = {key: each.text for key, each in found.items()}
    assert texts == {
        "agent_available": "AVAILABLE", "device_added": "u-1", "connection": "ESTABLISHED",
        "device_removed": "UNAVAILABLE", "device_changed": "UNAVAILABLE",
        "available": "AVAILABLE", "execution": "ACTIVE", "mode": "AUTOMATIC",
        "emergency_stop": "ARMED", "state": "RUN", "program": "plate.nc", "line": "12",
        "block": "G1 X1", "work_system": "G54", "tool": "3", "tools": "mill.T12",
        "tools_removed": "UNAVAILABLE", "parts": "4", "run_time": "12.5",
        "time_left": "UNAVAILABLE", "moving": "ON", "path_speed": "2", "feed": "2",
        "feed_override": "80", "rapid_override": "100", "spindle_speed": "900",
        "spindle_override": "100", "spindle_on": "ON", "flood": "OFF", "mist": "OFF",
        "dry_run": "OFF", "single_block": "OFF", "barred": "OFF",
        "bus_stopped": "UNAVAILABLE", "bus_alarm": "UNAVAILABLE",
        "bus_frames_sent": "UNAVAILABLE", "bus_frames_lost": "UNAVAILABLE",
        "bus_frames_wrong": "UNAVAILABLE", "bus_frames_late": "UNAVAILABLE",
        "loop_cycles": "UNAVAILABLE", "loop_missed": "UNAVAILABLE", "loop_late_us": "UNAVAILABLE",
        "loop_worst_late_us": "UNAVAILABLE", "loop_worst_work_us": "UNAVAILABLE",
        "message": "DOOR / COOLANT LOW", "alarms": "X: drive is off",
        "X_actual": "1.5", "X_commanded": "1", "X_following_error": "0.5", "X_work": "11",
        "X_to_go": "0", "X_homed": "ON", "X_jogging": "OFF",
        "Y_actual": "-2", "Y_commanded": "2", "Y_following_error": "0", "Y_work": "12",
        "Y_to_go": "1", "Y_homed": "OFF", "Y_jogging": "OFF",
        "C_actual": "90.25", "C_commanded": "90", "C_following_error": "0.25", "C_work": "90",
        "C_to_go": "2", "C_homed": "ON", "C_jogging": "OFF",
        "user_pulses": "400", "user_gate": "ON",
    }  # fmt: skip
    tags = {key: each.tag for key, each in found.items()}
    assert tags["X_actual"] == f"{STREAMS}Position"
    assert tags["C_actual"] == f"{STREAMS}Angle"
    assert tags["feed_override"] == f"{STREAMS}PathFeedrateOverride"
    assert tags["X_following_error"] == f"{OWN}FollowingError"
    assert tags["alarms"] == f"{STREAMS}Warning"
    assert found["alarms"].attrib["nativeCode"] == "34"
    assert all(STAMP.fullmatch(each.attrib["timestamp"]) for each in found.values())


def test_a_part_of_the_device_can_be_asked_for(agent: str) -> None:
    assert set(current(agent, path='//Linear[@name="Y"]')) == {
        "Y_actual", "Y_commanded", "Y_following_error", "Y_work", "Y_to_go", "Y_homed", "Y_jogging",
    }  # fmt: skip
    both = '//DataItem[@type="POSITION"]|//DataItem[@type="ANGLE"]'
    names = {f"{axis}_{each}" for axis in "XYC" for each in ("actual", "commanded")}
    assert set(current(agent, path=both)) == names
    assert set(current(agent, path="//Path")) >= {"execution", "line"}
    for path in ("//Nothing", "//Linear[", "//DataItem[@type='X' and @name='Y']"):
        assert refused(agent, "current", 400, path=path)[0] == "INVALID_XPATH"


def test_the_state_at_a_sequence_number_is_that_of_its_time(agent: str, feed: GivenFeed) -> None:
    before = int(head(asked(agent, "current"))["lastSequence"])
    assert feed.moment.run is not None
    feed.moment = replace(feed.moment, run=replace(feed.moment.run, line=13))
    until(lambda: current(agent)["line"].text == "13")
    assert current(agent, at=before)["line"].text == "12"
    assert current(agent, at=before + 1)["line"].text == "13"
    assert set(current(agent, at=1)) == {"available"}
    last = int(head(asked(agent, "current"))["lastSequence"])
    for wrong in (0, last + 1):
        code, text = refused(agent, "current", 404, at=wrong)
        assert (code, text) == ("OUT_OF_RANGE", f"'at' must be within 1 and {last}")


# --- sample ---------------------------------------------------------------------------


def test_samples_go_on_where_the_last_ones_ended(agent: str) -> None:
    first = asked(agent, "sample", count=7)
    assert [int(each.attrib["sequence"]) for each in by_sequence(first)] == list(range(1, 8))
    assert head(first)["nextSequence"] == "8"
    second = asked(agent, "sample", **{"from": 8, "count": 5})
    assert [int(each.attrib["sequence"]) for each in by_sequence(second)] == list(range(8, 13))
    info = head(second)
    assert (info["firstSequence"], info["bufferSize"]) == ("1", "131072")
    last = int(info["lastSequence"])
    rest = asked(agent, "sample", **{"from": last + 1})
    assert (observed(rest), head(rest)["nextSequence"]) == ([], str(last + 1))
    zero = asked(agent, "sample", **{"from": 0, "count": 1})
    assert observed(zero)[0].attrib["sequence"] == "1"


def by_sequence(root: ET.Element) -> list[ET.Element]:
    return sorted(observed(root), key=lambda each: int(each.attrib["sequence"]))


def test_samples_go_back_from_the_end(agent: str) -> None:
    root = asked(agent, "sample", count=-3)
    last = int(head(root)["lastSequence"])
    numbers = [int(each.attrib["sequence"]) for each in by_sequence(root)]
    assert numbers == [last - 2, last - 1, last]
    assert head(root)["nextSequence"] == str(last - 3)


@pytest.mark.parametrize(
    ("query", "status", "code"),
    [
        ({"from": -1}, 400, "INVALID_REQUEST"),
        ({"from": 999999}, 404, "OUT_OF_RANGE"),
        ({"from": "x"}, 400, "INVALID_REQUEST"),
        ({"from": ""}, 400, "INVALID_REQUEST"),
        ({"count": 0}, 400, "INVALID_REQUEST"),
        ({"count": 131073}, 404, "OUT_OF_RANGE"),
        ({"count": -131073}, 404, "OUT_OF_RANGE"),
        ({"count": 1.5}, 400, "INVALID_REQUEST"),
        ({"interval": -1}, 404, "OUT_OF_RANGE"),
        ({"interval": 1, "heartbeat": 0}, 404, "OUT_OF_RANGE"),
        ({"interval": 1, "count": -5}, 400, "INVALID_REQUEST"),
    ],
)
def test_what_cannot_be_asked_is_refused_by_code(
    agent: str, query: dict[str, object], status: int, code: str
) -> None:
    assert refused(agent, "sample", status, **query)[0] == code


def test_unknown_devices_requests_and_assets_are_refused(agent: str) -> None:
    assert refused(agent, "lathe/probe", 404) == (
        "NO_DEVICE", "Could not find the device 'lathe'",
    )  # fmt: skip
    assert refused(agent, "mill/store", 400)[0] == "UNSUPPORTED"
    assert refused(agent, "current/line", 400)[0] == "UNSUPPORTED"
    assert refused(agent, "asset/T1", 404) == ("ASSET_NOT_FOUND", "Could not find the asset 'T1'")
    assert refused(agent, "current", 400, at=1, interval=5)[0] == "INVALID_REQUEST"
    assert httpx.put(f"{agent}/mill", timeout=LIMIT_S).status_code == 405


def test_the_instance_stays_while_the_agent_runs(agent: str) -> None:
    numbers = {head(asked(agent, path))["instanceId"] for path in ("probe", "current", "sample")}
    assert len(numbers) == 1
    assert int(numbers.pop()) > 1_700_000_000


# --- streams --------------------------------------------------------------------------


class Stream:
    """The documents of a multipart stream."""

    def __init__(self, answer: httpx.Response) -> None:
        assert answer.headers["content-type"].startswith("multipart/x-mixed-replace; boundary=")
        self._boundary = answer.headers["content-type"].partition("boundary=")[2].encode()
        self._parts = answer.iter_bytes()
        self._data = b""

    def next(self) -> ET.Element:
        while (found := self._taken()) is None:
            self._data += next(self._parts)
        return ET.fromstring(found)

    def _taken(self) -> bytes | None:
        headers, gap, body = self._data.partition(b"\r\n\r\n")
        if not gap:
            return None
        assert headers.strip().startswith(b"--" + self._boundary)
        match = re.search(rb"Content-length: (\d+)", headers)
        assert match is not None
        length = int(match[1])
        if len(body) < length + 2:
            return None
        self._data = body[length + 2 :]
        return body[:length]


def test_a_stream_sends_what_is_new_and_heartbeats_between(agent: str, feed: GivenFeed) -> None:
    query = {"interval": "10", "heartbeat": "50", "from": "1", "count": "1000"}
    with httpx.stream("GET", f"{agent}/sample", params=query, timeout=LIMIT_S) as answer:
        stream = Stream(answer)
        first = stream.next()
        assert by_sequence(first)[0].attrib["sequence"] == "1"
        following = head(first)["nextSequence"]
        silent = stream.next()
        assert (observed(silent), head(silent)["nextSequence"]) == ([], following)
        assert feed.moment.run is not None
        feed.moment = replace(feed.moment, run=replace(feed.moment.run, line=99))
        while not observed(found := stream.next()):
            assert head(found)["nextSequence"] == following
        (line,) = observed(found)
        assert (line.text, line.attrib["sequence"]) == ("99", following)
        assert head(found)["nextSequence"] == str(int(following) + 1)


def test_the_current_state_comes_again_at_its_interval_to_two_hosts(agent: str) -> None:
    query = {"interval": "20", "path": "//Path"}
    place = f"{agent}/current"
    with (
        httpx.stream("GET", place, params=query, timeout=LIMIT_S) as one,
        httpx.stream("GET", place, params=query, timeout=LIMIT_S) as other,
    ):
        for stream in (Stream(one), Stream(other)):
            for _ in range(3):
                texts = {e.attrib["dataItemId"]: e.text for e in observed(stream.next())}
                assert texts["line"] == "12"
                assert "X_actual" not in texts


def test_a_stream_ends_with_the_bridge(feed: GivenFeed) -> None:
    with bridged(FILE, feed) as bridge:
        place = url(bridge, "mtconnect").removesuffix("/probe")
        with httpx.stream(
            "GET", f"{place}/sample", params={"interval": "0"}, timeout=LIMIT_S
        ) as answer:
            stream = Stream(answer)
            stream.next()
            bridge.stop()
            with pytest.raises(StopIteration):
                while True:
                    stream.next()


# --- observations ---------------------------------------------------------------------

ITEMS = [data_item(item) for item in items_of(())]
PLACES = {item.id: place for place, item in enumerate(ITEMS)}
ONE, TWO = Alarm(3, "link lost", "ABORT"), Alarm(34, "X: drive is off", "REFUSE")


def test_alarms_are_a_condition_each_and_normal_when_they_are_gone() -> None:
    buffer = Buffer(ITEMS, 1000, stamp())
    place = PLACES["alarms"]

    def shown() -> list[tuple[str, str, str]]:
        found = [each for each in buffer.state() if each.item.id == "alarms"]
        return [(each.level, each.code, each.text) for each in found]

    assert shown() == [("Unavailable", "", "")]
    buffer.put([(place, ())], stamp())
    assert shown() == [("Normal", "", "")]
    buffer.put([(place, (ONE,))], stamp())
    buffer.put([(place, (ONE, TWO))], stamp())
    assert shown() == [("Fault", "3", "link lost"), ("Warning", "34", "X: drive is off")]
    begin = buffer.next
    buffer.put([(place, (TWO,))], stamp())
    found, _ = buffer.part(begin, 10)
    assert [(each.level, each.code) for each in found] == [("Normal", "3")]
    assert shown() == [("Warning", "34", "X: drive is off")]
    buffer.put([(place, ())], stamp())
    assert shown() == [("Normal", "", "")]
    buffer.put([(place, None)], stamp())
    assert shown() == [("Unavailable", "", "")]


def test_a_full_buffer_forgets_the_oldest_and_still_knows_the_state() -> None:
    buffer = Buffer(ITEMS, 100, stamp())
    line, tool = PLACES["line"], PLACES["tool"]
    buffer.put([(tool, 7)], stamp())
    for number in range(500):
        buffer.put([(line, number)], stamp())
    assert (buffer.last - buffer.first, buffer.next - buffer.last) == (99, 1)
    state = {each.item.id: each.text for each in buffer.state(buffer.first)}
    assert (state["tool"], state["line"], state["feed"]) == ("7", "400", "UNAVAILABLE")
    assert {e.item.id: e.text for e in buffer.state(buffer.last)}["line"] == "499"
    found, following = buffer.part(buffer.first, 2)
    assert ([each.text for each in found], following) == (["400", "401"], buffer.first + 2)
    for wrong in (buffer.first - 1, buffer.next + 1):
        with pytest.raises(OutOfRangeError):
            buffer.part(wrong, 1)
    with pytest.raises(OutOfRangeError):
        buffer.state(buffer.first - 1)
    found, following = buffer.part(buffer.first, -5)
    assert ([each.text for each in found], following) == (["400"], buffer.first)


def test_a_value_that_stays_is_not_observed_again() -> None:
    buffer = Buffer(ITEMS, 100, stamp())
    buffer.put([(PLACES["line"], 1)], stamp())
    begin = buffer.next
    buffer.put([(PLACES["line"], 1)], stamp())
    assert buffer.next == begin


def test_a_lost_machine_is_unavailable_as_a_whole(agent: str, feed: GivenFeed) -> None:
    feed.lose()
    until(lambda: current(agent)["available"].text == "UNAVAILABLE")
    found = {
        each.attrib["dataItemId"]: each.text for each in observed(asked(agent, "mill/current"))
    }
    assert {text for key, text in found.items() if key != "alarms"} == {"UNAVAILABLE"}
    assert current(agent, path="//Adapter")["connection"].text == "CLOSED"


def test_characters_that_xml_does_not_have_are_left_out(agent: str, feed: GivenFeed) -> None:
    text = "G1 \x07<X> & \x00é"
    feed.moment = replace(feed.moment, facts={**feed.moment.facts, "program": {"text": text}})
    until(lambda: current(agent)["block"].text == "G1 <X> & é")
