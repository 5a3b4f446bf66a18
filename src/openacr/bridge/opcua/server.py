"""The server: an object for the machine, whose variables follow the values of the bridge."""

from collections import deque
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from asyncua import Server, ua
from asyncua.common.node import Node

from openacr.bridge.clock import now
from openacr.bridge.items import Item, Readings
from openacr.bridge.library_logs import leave_out
from openacr.bridge.newest import Newest
from openacr.bridge.opcua.access import Attributes, Users
from openacr.bridge.opcua.events import Events
from openacr.bridge.opcua.nodes import TYPES, data_value, place_of, units_of
from openacr.bridge.opcua.notices import NAMES, NEWS, Notice, Notices
from openacr.bridge.opcua.trust import Trusted
from openacr.bridge.rows import Kind
from openacr.bridge.settings import OpcUa, port_key
from openacr.bridge.setup import Setup
from openacr.errors import UserError, read_bytes
from openacr.io.listening import listen_failure

MOST_NOTICES = 1000  # that wait to be sent
LIBRARY_LOG = "asyncua.server.server"
NAMESPACE = "urn:openacr:machine"
OPEN = (ua.SecurityPolicyType.NoSecurity,)
SEALED = (
    ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt,
    ua.SecurityPolicyType.Aes128Sha256RsaOaep_SignAndEncrypt,
    ua.SecurityPolicyType.Aes256Sha256RsaPss_SignAndEncrypt,
)


class OpcUaSystem:
    """One machine in the address space of an OPC UA server."""

    name = "opcua"

    def __init__(self, setup: Setup, settings: OpcUa) -> None:
        self._setup, self._settings = setup, settings
        self._items = setup.items
        trusted = None if settings.trusted is None else Trusted(setup.folder / settings.trusted)
        users: Any = Users(settings.user, setup.secret, trusted)
        self._server = Server(user_manager=users)
        self._nodes: list[Node] = []
        names = [item.name for item in setup.items]
        self._lost_place = names.index("available")
        self._noticed = {name: names.index(name) for name in NAMES}
        self._notices, self._waiting = Notices(), deque[Notice](maxlen=MOST_NOTICES)
        self._events: Events | None = None
        self._newest = Newest(self._write)
        self._is_started = False

    async def open(self) -> str:
        """Build the address space and listen; the endpoint."""
        settings, server = self._settings, self._server
        server.iserver.bind_condition_methods = NEWS  # severity of the events of ConditionRefresh
        await server.init()
        server.set_endpoint(f"opc.tcp://{settings.address}:{settings.port}/openacr")
        server.set_server_name(f"openacr {self._setup.machine}")
        token = (
            ua.AnonymousIdentityToken if self._setup.secret is None else ua.UserNameIdentityToken
        )
        server.set_identity_tokens([token])
        await self._secure()
        await self._build()
        leave_out(LIBRARY_LOG, OSError)  # it is raised as well
        try:
            await server.start()
        except OSError as error:
            key = port_key(self.name)
            raise listen_failure(settings.address, settings.port, error, key) from None
        self._is_started = True
        self._newest.start()
        port = settings.port if server.bserver is None else server.bserver.port
        return f"opc.tcp://{settings.address}:{port}/openacr"

    async def _secure(self) -> None:
        """Without a certificate there is no encryption; with one there is nothing else."""
        settings = self._settings
        await self._server.set_application_uri(settings.application_uri)
        if settings.certificate is None or settings.private_key is None:
            self._server.set_security_policy(list(OPEN))
            return
        self._server.set_security_policy(list(SEALED))
        folder = self._setup.folder
        await _load_key(folder / settings.certificate, self._server.load_certificate)
        await _load_key(folder / settings.private_key, self._server.load_private_key)

    async def _build(self) -> None:
        """The folders and variables; their ids are the names of the values."""
        index = await self._server.register_namespace(NAMESPACE)
        folders = Folders(self._server.nodes.objects, index)
        machine = ("Machines", self._setup.machine)
        identification = await folders.at((*machine, "Identification"))
        uri = f"urn:{self._setup.machine}"
        for name, text in (("Manufacturer", "openacr"), ("ProductInstanceUri", uri)):
            await identification.add_property(index, name, text)
        for item in self._items:
            place = place_of(item)
            parent = await folders.at((*machine, *place.folders))
            self._nodes.append(await self._variable(parent, item, place.name, index))
        items = {node.nodeid: item for node, item in zip(self._nodes, self._items, strict=True)}
        self._events = Events(self._server, index, self._setup.machine)
        await self._events.open()
        inner = self._server.iserver
        inner.attribute_service = Attributes(inner.aspace, items, self._setup.writer)

    async def _variable(self, parent: Node, item: Item, name: str, index: int) -> Node:
        """The variable of a value, which is not known yet."""
        kind = TYPES[item.row.kind]
        empty = [] if item.row.kind in (Kind.ALARMS, Kind.TOOLS) else ua.get_default_value(kind)
        place, shown = ua.NodeId(item.name, index), ua.QualifiedName(name, index)
        node = await parent.add_variable(place, shown, empty, kind, ua.NodeId(kind.value))
        unknown = data_value(item, None, now(), is_lost=True)
        space = self._server.iserver.aspace
        await space.write_attribute_value(node.nodeid, ua.AttributeIds.Value, unknown)
        meaning = ua.DataValue(ua.Variant(ua.LocalizedText(item.row.meaning)))
        await node.write_attribute(ua.AttributeIds.Description, meaning)
        if (unit := units_of(item)) is not None:
            await node.add_property(0, "EngineeringUnits", unit)
        if item.chosen is not None and item.chosen.write:
            await node.set_writable()
        return node

    # --- values -----------------------------------------------------------------------

    def publish(self, readings: Readings, changed: Sequence[int]) -> None:
        """Hand over what has changed, and what has happened."""
        named = {name: readings[place] for name, place in self._noticed.items()}
        self._waiting.extend(self._notices.of(named))
        self._newest.put(readings, changed)

    async def _write(self, readings: Readings, places: list[int]) -> None:
        space, time = self._server.iserver.aspace, now()
        is_lost = readings[self._lost_place] is False
        for place in places:
            value = data_value(self._items[place], readings[place], time, is_lost=is_lost)
            node = self._nodes[place].nodeid
            await space.write_attribute_value(node, ua.AttributeIds.Value, value)
        while self._waiting and self._events is not None:
            await self._events.send(self._waiting.popleft())

    async def close(self) -> None:
        """End sessions and server."""
        await self._newest.stop()
        if self._is_started:
            await self._server.stop()


class Folders:
    """Objects by their path below the objects of the server; each is made once."""

    def __init__(self, root: Node, index: int) -> None:
        self._found: dict[tuple[str, ...], Node] = {(): root}
        self._index = index

    async def at(self, path: tuple[str, ...]) -> Node:
        """The object at a path, made with all above it."""
        if path not in self._found:
            parent, index = await self.at(path[:-1]), self._index
            place, name = ua.NodeId("/".join(path), index), ua.QualifiedName(path[-1], index)
            self._found[path] = await parent.add_object(place, name)
        return self._found[path]


async def _load_key(path: Path, load: Any) -> None:
    """Load a certificate or a private key, in PEM or DER."""
    data = read_bytes(path)
    try:
        await load(data, format="pem" if b"-----BEGIN" in data else "der")
    except Exception as error:  # the library names no types of its own
        raise UserError(f"{path}: it is neither PEM nor DER ({error})") from None
