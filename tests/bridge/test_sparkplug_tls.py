"""Sparkplug over TLS with a broker on real sockets: the right authority, wrong ones, two hosts."""

import socketserver
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.bridge.authority import Authority
from tests.bridge.bench import GivenFeed, bridged, show_line
from tests.bridge.mqtt import Metric, RunningBroker, Subscriber, named, node_file
from tests.waiting import until

from openacr.errors import UserError

LOG = "openacr.bridge.sparkplug.node"


@pytest.fixture
def authority(tmp_path: Path) -> Authority:
    return Authority(tmp_path, "authority")


@pytest.fixture
def broker(authority: Authority) -> Iterator[RunningBroker]:
    with RunningBroker(certificate=authority.server("127.0.0.1")) as running:
        yield running


def host(broker: RunningBroker, authority: Authority) -> Subscriber:
    return Subscriber(broker.port, change=lambda client: client.tls_set(str(authority.pem)))


def said(caplog: pytest.LogCaptureFixture) -> list[str]:
    return [each.getMessage() for each in caplog.records if each.name == LOG]


def test_two_hosts_of_one_broker_see_the_machine_over_tls_and_each_commands_it(
    broker: RunningBroker, authority: Authority, tmp_path: Path
) -> None:
    feed = GivenFeed()
    one, other = host(broker, authority), host(broker, authority)
    with bridged(
        node_file(broker.port, 'tls = true\nauthority = "authority.pem"\n'), feed, tmp_path
    ) as b:
        assert b.places == [f"sparkplug mqtts://127.0.0.1:{broker.port}"]
        births = [named(each.await_first("NBIRTH")) for each in (one, other)]
        assert births[0] == births[1]
        assert births[0]["line"] == 12
        one.command(Metric(name="Node Control/Rebirth", datatype=11, boolean_value=True))
        other.await_first("NBIRTH", 2)
        other.command(Metric(name="user/pulses", datatype=10, double_value=7.0))
        until(lambda: feed.written == [(12290, 7.0, False)])
        one.close()
        show_line(feed, 13)
        assert other.await_first("NDATA").seq == 1
    other.await_first("NDEATH")
    other.close()


def test_a_broker_of_another_authority_is_refused_and_the_log_says_why(
    broker: RunningBroker, authority: Authority, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    Authority(tmp_path, "wrong")
    watching = host(broker, authority)
    more = 'tls = true\nauthority = "wrong.pem"\n'
    with bridged(node_file(broker.port, more), GivenFeed(), tmp_path):
        until(lambda: said(caplog))
    assert said(caplog) == [
        f"sparkplug: the certificate of 127.0.0.1:{broker.port} is refused: unable to get local"
        " issuer certificate; it is tried again"
    ]
    assert watching.seen == []
    watching.close()


def test_a_broker_with_the_certificate_of_another_address_is_refused(
    authority: Authority, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    more = 'tls = true\nauthority = "authority.pem"\n'
    with (
        RunningBroker(certificate=authority.server("192.0.2.1")) as running,
        bridged(node_file(running.port, more), GivenFeed(), tmp_path),
    ):
        until(lambda: said(caplog))
    assert said(caplog) == [
        f"sparkplug: the certificate of 127.0.0.1:{running.port} is refused: IP address mismatch,"
        " certificate is not valid for '127.0.0.1'; it is tried again"
    ]


def test_a_server_that_speaks_no_tls_is_said(
    authority: Authority, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    with socketserver.TCPServer(("127.0.0.1", 0), Greeting) as server:
        threading.Thread(target=server.serve_forever).start()
        port = server.server_address[1]
        more = 'tls = true\nauthority = "authority.pem"\n'
        try:
            with bridged(node_file(port, more), GivenFeed(), tmp_path):
                until(lambda: said(caplog))
        finally:
            server.shutdown()
    (line,) = said(caplog)
    assert line.startswith(f"sparkplug: TLS with 127.0.0.1:{port} has failed: ")
    assert line.endswith("; it is tried again")


class Greeting(socketserver.BaseRequestHandler):
    """Answers the first bytes of a host in plain text."""

    def handle(self) -> None:
        self.request.recv(1)
        self.request.sendall(b"220 this is no TLS\r\n")
        while self.request.recv(4096):
            pass


def test_an_authority_that_is_no_certificate_is_said(tmp_path: Path) -> None:
    (tmp_path / "a.pem").write_text("no certificate")
    for name in ("a.pem", "missing.pem"):
        more = f'tls = true\nauthority = "{name}"\n'
        with (
            pytest.raises(UserError, match="sparkplug: the certificates cannot be used: "),
            bridged(node_file(1, more), GivenFeed(), tmp_path),
        ):
            pass
