"""The OPC UA server, with the client of the library it is made with."""

import asyncio
import gc
import pickle
from collections.abc import Awaitable, Callable, Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from asyncua import Client, Server, ua
from asyncua.crypto.cert_gen import generate_private_key, generate_self_signed_app_certificate
from asyncua.crypto.security_policies import SecurityPolicyBasic256Sha256
from asyncua.server.address_space import NodeManagementService
from asyncua.server.internal_server import InternalServer
from asyncua.server.standard_address_space import standard_address_space
from cryptography.hazmat.primitives.serialization import Encoding, NoEncryption, PrivateFormat
from tests.bridge.bench import RUNNING, VALUES, GivenFeed, bridged, url
from tests.waiting import LIMIT_S

from openacr.bridge.load import parse_bridge
from openacr.bridge.rows import Alarm
from openacr.errors import SourceError, UserError
from openacr.mill.run.lifecycle import State

FILE = 'name = "mill"\nrate_hz = 50\n[opcua]\nport = 0\n' + VALUES
READ_ONLY = FILE.replace("write = true\nlow = -1000\nhigh = 1000\n", "").replace(
    "write = true\n", ""
)


@pytest.fixture(scope="module", autouse=True)
def quick_library() -> Iterator[None]:
    """The library makes its 6000 nodes once; they and its clock end with the server."""
    fill, stop = standard_address_space.fill_address_space, Server.stop
    run_clock = InternalServer._set_current_time_loop
    kept: list[bytes] = []

    def filled(service: NodeManagementService) -> None:
        gc.disable()  # it would look through all nodes again and again
        try:
            if not kept:
                fill(service)
                kept.append(pickle.dumps(service._aspace._nodes))
            else:
                service._aspace._nodes.update(pickle.loads(kept[0]))
        finally:
            gc.enable()

    async def clock(server: InternalServer) -> None:
        running = asyncio.create_task(run_clock(server))
        while not server._time_task_stop:
            await asyncio.sleep(0.02)
        running.cancel()

    async def stopped(server: Server) -> None:
        await stop(server)
        server.iserver.aspace._nodes.clear()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(standard_address_space, "fill_address_space", filled)
        patch.setattr(InternalServer, "_set_current_time_loop", clock)
        patch.setattr(Server, "stop", stopped)
        yield


def node(client: Client, name: str) -> Any:
    return client.get_node(ua.NodeId(name, 2))


async def until(holds: Callable[[], Awaitable[object]]) -> None:
    async with asyncio.timeout(LIMIT_S):
        while not await holds():
            await asyncio.sleep(0.02)


async def shown(client: Client, name: str) -> Any:
    """The value and the status code of a variable."""
    found = await node(client, name).read_data_value(raise_on_bad_status=False)
    return found.Value.Value, found.StatusCode.value


async def connected(place: str, work: Callable[[Client], Awaitable[None]], **more: Any) -> None:
    client = Client(place, timeout=LIMIT_S)
    if more:
        client.set_user(more["user"])
        client.set_password(more["password"])
    async with client:
        await until(lambda: _is(client, "available", True))
        await work(client)


async def _is(client: Client, name: str, value: object) -> bool:
    return bool((await shown(client, name))[0] == value)


def served(work: Callable[[Client, GivenFeed], Awaitable[None]], text: str = FILE) -> GivenFeed:
    """Run a conversation with a server."""
    feed = GivenFeed()
    with bridged(text, feed) as bridge:
        asyncio.run(connected(url(bridge, "opcua"), lambda client: work(client, feed)))
    return feed


def test_a_host_reads_browses_subscribes_and_sees_a_machine_that_is_lost() -> None:
    served(_reading)


async def _reading(client: Client, feed: GivenFeed) -> None:
    expected = {
        "execution": "ACTIVE", "program": "plate.nc", "line": 12, "feed_override": 80.0,
        "spindle_on": True, "alarms": ["34 X: drive is off"], "X.actual": 1.5, "C.actual": 90.25,
        "tools": ["T3 diameter 6 mm, length 50.25 mm, flat", "T12 length -7.5 mm, ball"],
        "X.homed": True, "user.pulses": 400.0, "user.gate": True,
    }  # fmt: skip
    assert {name: (await shown(client, name))[0] for name in expected} == expected
    assert await shown(client, "time_left") == (None, ua.StatusCodes.BadNoData)
    names = ["2:Machines", "2:mill", "2:Monitoring", "2:Axes", "2:X", "2:Actual"]
    found = await client.nodes.objects.get_child(names)
    assert found.nodeid == ua.NodeId("X.actual", 2)
    unit = await (await found.get_child("0:EngineeringUnits")).read_value()
    assert (unit.UnitId, unit.DisplayName.Text) == (5066068, "mm")
    described = (await found.read_description()).Text
    assert described == "actual position, machine coordinates"
    for path in (
        ("Production", "ActiveProgram", "Name"), ("Monitoring", "Channel", "FeedOverride"),
        ("Monitoring", "Spindle", "IsRotating"), ("Notification", "Alarms"),
        ("Equipment", "Tools", "ToolTable"),
        ("Monitoring", "MachineTool", "OperationMode"), ("Identification", "Manufacturer"),
    ):  # fmt: skip
        await client.nodes.objects.get_child(["2:Machines", "2:mill", *(f"2:{n}" for n in path)])
    await _following(client, feed)
    feed.moment = replace(feed.moment, facts={**feed.moment.facts, "alarms": {"active": []}})
    await until(lambda: _is(client, "alarms", []))
    feed.lose()
    await until(lambda: _is(client, "available", False))
    assert await shown(client, "line") == (None, ua.StatusCodes.BadNoCommunication)
    feed.moment = RUNNING
    await until(lambda: _is(client, "line", 12))


async def _following(client: Client, feed: GivenFeed) -> None:
    """A subscription gets what changes, and nothing else."""
    seen: list[Any] = []

    class Handler:
        def datachange_notification(self, which: Any, value: Any, data: Any) -> None:
            seen.append((which.nodeid.Identifier, value))

    subscription = await client.create_subscription(20, Handler())
    await subscription.subscribe_data_change([node(client, "line"), node(client, "tool")])
    await until(lambda: _true(len(seen) >= 2))
    assert feed.moment.run is not None
    feed.moment = replace(feed.moment, run=replace(feed.moment.run, line=77))
    await until(lambda: _true(("line", 77) in seen))
    assert sorted(map(str, seen)) == ["('line', 12)", "('line', 77)", "('tool', 3)"]
    await subscription.delete()


FIELDS = ("SourceName", "Severity", "ConditionName", "ActiveState/Id", "Retain", "AckedState/Id")


def test_alarms_are_conditions_and_programs_and_messages_events_of_the_server() -> None:
    served(_happening)


async def _happening(client: Client, feed: GivenFeed) -> None:
    seen: list[Any] = []

    class Handler:
        def event_notification(self, event: Any) -> None:
            seen.append(event)

    types = [ua.ObjectIds.BaseEventType, ua.ObjectIds.AlarmConditionType]
    subscription = await client.create_subscription(20, Handler())
    await subscription.subscribe_events(evtypes=types)
    new = Alarm(3, "link lost", "ABORT")
    old = feed.moment.facts["alarms"]["active"]
    shown = [*old, {"code": new.code, "text": new.text, "effect": new.effect}]
    assert feed.moment.run is not None
    feed.moment = replace(
        feed.moment,
        run=replace(feed.moment.run, state=State.ALARM),
        facts={**feed.moment.facts, "alarms": {"active": shown}},
    )
    await until(lambda: _true(len(seen) >= 2))
    feed.moment = replace(feed.moment, facts={**feed.moment.facts, "alarms": {"active": old}})
    await until(lambda: _true(len(seen) >= 3))
    begun, ended, over = seen
    assert begun.EventType.Identifier == ua.ObjectIds.AlarmConditionType
    assert ended.EventType.Identifier == ua.ObjectIds.BaseEventType
    assert [each.Message.Text for each in seen] == [
        "3 link lost", "program plate.nc was ended by an alarm", "3 link lost",
    ]  # fmt: skip
    assert [getattr(begun, name) for name in FIELDS] == ["mill", 800, "3", True, True, True]
    assert [getattr(over, name) for name in FIELDS] == ["mill", 800, "3", False, False, True]
    assert begun.NodeId == over.NodeId == ua.NodeId("alarms.3 link lost", 2)
    assert (begun.SourceNode, ended.SourceNode) == (ua.NodeId("alarms", 2), ua.NodeId("state", 2))
    assert (begun.ActiveState.Text, over.ActiveState.Text) == ("Active", "Inactive")
    assert begun.EventId != over.EventId
    await subscription.delete()


async def _true(holds: bool) -> bool:
    return holds


def test_a_host_that_connects_later_is_sent_the_active_alarms_when_it_asks_for_them() -> None:
    served(_refreshing)


async def _refreshing(client: Client, feed: GivenFeed) -> None:
    seen: dict[str, list[Any]] = {"asking": [], "other": []}

    class Handler:
        def __init__(self, name: str) -> None:
            self._name = name

        def event_notification(self, event: Any) -> None:
            seen[self._name].append(event)

    condition, method = ua.ObjectIds.ConditionType, ua.ObjectIds.ConditionType_ConditionRefresh
    start, end = ua.ObjectIds.RefreshStartEventType, ua.ObjectIds.RefreshEndEventType
    types, ids = [ua.ObjectIds.AlarmConditionType, start, end], {}
    for name in seen:
        subscription = await client.create_subscription(20, Handler(name))
        await subscription.subscribe_events(evtypes=types)
        ids[name] = ua.Variant(subscription.subscription_id, ua.VariantType.UInt32)

    async def refreshed() -> list[tuple[int, str, bool]]:
        """The events a refresh sends: type, text, whether it is active."""
        before = kinds("asking").count(end)
        await client.get_node(condition).call_method(ua.NodeId(method), ids["asking"])
        await until(lambda: _true(kinds("asking").count(end) > before))
        first = len(seen["asking"]) - 1 - kinds("asking")[::-1].index(start)
        return [
            (
                e.EventType.Identifier,
                e.Message.Text or "",
                bool(getattr(e, "ActiveState/Id", False)),
            )
            for e in seen["asking"][first:]
        ]

    def kinds(name: str) -> list[int]:
        return [e.EventType.Identifier for e in seen[name]]

    async def over(text: str) -> None:
        """Wait for the end of an alarm."""
        await until(
            lambda: _true(any(e.Message.Text == text and not e.Retain for e in seen["other"]))
        )

    def between(*texts: str) -> list[tuple[int, str, bool]]:
        alarms = [(ua.ObjectIds.AlarmConditionType, text, True) for text in texts]
        return [(start, "", False), *alarms, (end, "", False)]

    def show(*alarms: tuple[int, str]) -> None:
        active = [{"code": code, "text": text, "effect": "ABORT"} for code, text in alarms]
        feed.moment = replace(
            feed.moment, facts={**feed.moment.facts, "alarms": {"active": active}}
        )

    show((3, "link lost"), (34, "Y: drive is off"))
    await over("34 X: drive is off")
    assert await refreshed() == between("3 link lost", "34 Y: drive is off")
    show((34, "Y: drive is off"))
    await over("3 link lost")
    assert await refreshed() == between("34 Y: drive is off")
    assert start not in kinds("other")
    with pytest.raises(ua.UaStatusCodeError) as caught:
        unknown = ua.Variant(4711, ua.VariantType.UInt32)
        await client.get_node(condition).call_method(ua.NodeId(method), unknown)
    assert caught.value.code == ua.StatusCodes.BadSubscriptionIdInvalid


async def refused(client: Client, name: str, value: Any, kind: Any) -> int:
    """The status code of a write that must not happen."""
    with pytest.raises(ua.UaStatusCodeError) as caught:
        await node(client, name).write_value(ua.Variant(value, kind))
    return int(caught.value.code)


def test_only_values_the_file_lists_are_written_and_within_their_limits() -> None:
    feed = served(_writing)
    assert feed.written == [
        (12290, 1000.0, False), (12290, -1000.0, False), (2, 0.0, True), (2, 1.0, True),
    ]  # fmt: skip


async def _writing(client: Client, feed: GivenFeed) -> None:
    double, integer, boolean = ua.VariantType.Double, ua.VariantType.Int32, ua.VariantType.Boolean
    pulses, gate = node(client, "user.pulses"), node(client, "user.gate")
    await pulses.write_value(ua.Variant(1000.0, double))
    await pulses.write_value(ua.Variant(-1000, integer))
    await gate.write_value(ua.Variant(False, boolean))
    await gate.write_value(ua.Variant(True, boolean))
    codes = ua.StatusCodes
    for value, kind in ((1000.5, double), (-1001.0, double), (0.5, double)):
        assert await refused(client, "user.pulses", value, kind) == codes.BadOutOfRange
    assert await refused(client, "user.gate", 2, integer) == codes.BadOutOfRange
    assert await refused(client, "user.pulses", float("nan"), double) == codes.BadOutOfRange
    text = ua.VariantType.String
    wrong: list[Any] = [("user.pulses", "1", text), ("user.pulses", True, boolean)]
    for name, given, kind in (*wrong, ("user.gate", "1", text)):
        assert await refused(client, name, given, kind) == codes.BadTypeMismatch
    server_uris = await client.get_node(ua.ObjectIds.Server_ServerArray).read_value()
    assert server_uris == ["urn:openacr:bridge"]
    assert await refused(client, "user.pulses", [1.0], double) == codes.BadTypeMismatch
    assert await refused(client, "line", 3, ua.VariantType.Int64) == codes.BadNotWritable
    state = client.get_node(ua.ObjectIds.Server_ServiceLevel)
    with pytest.raises(ua.UaStatusCodeError):
        await state.write_value(ua.Variant(1, ua.VariantType.Byte))
    with pytest.raises(ua.UaStatusCodeError):
        await node(client, "line").write_attribute(
            ua.AttributeIds.DisplayName, ua.DataValue(ua.Variant(ua.LocalizedText("mine")))
        )
    feed.refusal = "the card does not answer"
    assert await refused(client, "user.gate", True, boolean) == codes.BadDeviceFailure


def test_nothing_is_written_where_the_file_does_not_allow_it() -> None:
    async def try_it(client: Client, feed: GivenFeed) -> None:
        code = await refused(client, "user.pulses", 1.0, ua.VariantType.Double)
        assert code == ua.StatusCodes.BadNotWritable
        with pytest.raises(ua.UaStatusCodeError):
            await client.nodes.objects.add_object(2, "mine")

    assert served(try_it, READ_ONLY).written == []


@cache
def signed(name: str) -> tuple[bytes, bytes]:
    """A certificate that is its own authority, and its key: finding its primes takes seconds."""
    key = generate_private_key()
    made = generate_self_signed_app_certificate(key, name, {}, [], extended=[])
    return (
        made.public_bytes(Encoding.PEM),
        key.private_bytes(Encoding.PEM, PrivateFormat.PKCS8, NoEncryption()),
    )


def certificate(folder: Path, name: str) -> tuple[Path, Path]:
    """The files of a certificate and its key."""
    paths = folder / f"{name}.pem", folder / f"{name}-key.pem"
    for path, text in zip(paths, signed(name), strict=True):
        path.write_bytes(text)
    return paths


def test_with_a_certificate_and_a_password_only_sealed_sessions_of_the_user_are_served(
    tmp_path: Path,
) -> None:
    certificate(tmp_path, "server")
    own, key = certificate(tmp_path, "known")
    (tmp_path / "secret").write_text("hush\n")
    text = FILE.replace(
        "port = 0\n",
        'port = 0\npassword_file = "secret"\ncertificate = "server.pem"\n'
        'private_key = "server-key.pem"\n',
    )

    async def session(place: str, user: str, password: str, *, is_sealed: bool = True) -> str:
        client = Client(place, timeout=LIMIT_S)
        client.set_user(user)
        client.set_password(password)
        if is_sealed:
            await client.set_security(SecurityPolicyBasic256Sha256, str(own), str(key))
        async with client:
            await until(lambda: _is(client, "program", "plate.nc"))
            return "read"

    with bridged(text, GivenFeed(), tmp_path) as bridge:
        place = url(bridge, "opcua")
        assert asyncio.run(session(place, "openacr", "hush")) == "read"
        for user, password in (("openacr", "wrong"), ("other", "hush"), ("openacr", "")):
            with pytest.raises(ua.UaError):
                asyncio.run(session(place, user, password))
        with pytest.raises((ua.UaError, ConnectionError, TimeoutError)):
            asyncio.run(session(place, "openacr", "hush", is_sealed=False))


def test_only_hosts_with_trusted_certificates_open_sessions(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    certificate(tmp_path, "server")
    known, other = certificate(tmp_path, "known"), certificate(tmp_path, "other")
    (tmp_path / "trusted").mkdir()
    known[0].rename(tmp_path / "trusted" / "known.pem")
    keys = 'certificate = "server.pem"\nprivate_key = "server-key.pem"\ntrusted = "trusted"\n'

    async def session(place: str, own: Path, key: Path) -> None:
        client = Client(place, timeout=LIMIT_S)
        await client.set_security(SecurityPolicyBasic256Sha256, str(own), str(key))
        async with client:
            await until(lambda: _is(client, "program", "plate.nc"))

    with bridged(FILE.replace("port = 0\n", f"port = 0\n{keys}"), GivenFeed(), tmp_path) as bridge:
        place = url(bridge, "opcua")
        asyncio.run(session(place, tmp_path / "trusted" / "known.pem", known[1]))
        with pytest.raises(ua.UaStatusCodeError) as caught:
            asyncio.run(session(place, *other))
        assert caught.value.code == ua.StatusCodes.BadUserAccessDenied
    said = [text for text in caplog.messages if "a host is refused" in text]
    assert said == ["opcua: a host is refused: CN=other is not among the trusted ones"]


def test_a_certificate_that_is_none_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.pem").write_text("no certificate")
    text = FILE.replace("port = 0\n", 'port = 0\ncertificate = "a.pem"\nprivate_key = "b.key"\n')
    with pytest.raises(UserError, match=r"a\.pem: it is neither PEM nor DER"):
        with bridged(text, GivenFeed(), tmp_path):
            pass


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        ('certificate = "a"\n', "certificate and private_key are given together"),
        ('private_key = "a"\n', "certificate and private_key are given together"),
        ('address = "0.0.0.0"\npassword_file = "s"\n', "and no certificate is given"),
        (
            'address = "0.0.0.0"\ncertificate = "a"\nprivate_key = "b"\n',
            "and no password_file is given",
        ),
    ],
)
def test_other_computers_need_a_password_and_a_certificate(keys: str, said: str) -> None:
    with pytest.raises(SourceError, match=said):
        parse_bridge("[opcua]\n" + keys)


def test_a_port_in_use_is_said_in_one_line(caplog: pytest.LogCaptureFixture) -> None:
    with bridged(FILE, GivenFeed()) as bridge:
        port = url(bridge, "opcua").split(":")[2].split("/")[0]
        with pytest.raises(UserError, match=rf"port {port} on .* is in use.*port = N in \[opcua\]"):
            with bridged(FILE.replace("port = 0", f"port = {port}"), GivenFeed()):
                pass
    assert not [record for record in caplog.records if record.exc_info]


def test_alarms_are_texts_with_their_codes() -> None:
    assert str(Alarm(34, "X: drive is off", "REFUSE")) == "34 X: drive is off"
