"""Who gets in: hosts, origins, passwords, roles, headers."""

import asyncio
import re
import time
from pathlib import Path

import httpx
import pytest
import websockets
from tests.panel.bench import LIMIT_S, Client, Served
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.errors import UserError
from openacr.panel.roles import Role
from openacr.panel.server import accounts, delays
from openacr.panel.server.accounts import Accounts, file_of
from openacr.panel.server.panel import require_password
from openacr.sysvar import Store, password


@pytest.fixture(autouse=True)
def quick_hashes(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hash takes 50 ms on purpose."""
    monkeypatch.setattr(accounts, "_COST", {"n": 2, "r": 1, "p": 1})


@pytest.fixture
def panel(kept_panel: Served) -> Served:
    return kept_panel


def guarded(panel: Served) -> httpx.Client:
    """A panel with passwords, and a browser without a log-in."""
    for role in Role:
        panel.panel.accounts.set_password(role, f"secret {role.word}")
    return httpx.Client(base_url=panel.url, timeout=LIMIT_S)


@pytest.mark.parametrize(
    ("host", "is_let_in"),
    [
        ("127.0.0.1:5080", True), ("localhost", True), ("192.168.1.5:80", True), ("[::1]:80", True),
        ("evil.example", False), ("localhost.evil.example:5080", False), ("", False),
        ("127.0.0.1.evil.example", False), ("[::1", False),
    ],
)  # fmt: skip
def test_only_numbers_and_known_names_are_hosts(panel: Served, host: str, is_let_in: bool) -> None:
    answer = httpx.get(f"{panel.url}/api/me", headers={"host": host})
    assert (answer.status_code == 200) is is_let_in


@pytest.mark.parametrize(
    ("headers", "is_let_in"),
    [
        ({}, True),
        ({"origin": "http://HOST"}, True),
        ({"origin": "http://evil.example"}, False),
        ({"origin": "null"}, False),
        ({"origin": "http://["}, False),
        ({"origin": "http://HOST.evil.example"}, False),
        ({"sec-fetch-site": "cross-site"}, False),
        ({"sec-fetch-site": "same-site"}, False),
        ({"sec-fetch-site": "same-origin"}, True),
    ],
)
def test_only_pages_of_this_server_change_anything(
    panel: Served, headers: dict[str, str], is_let_in: bool
) -> None:
    own = f"127.0.0.1:{panel.port}"
    sent = {name: value.replace("HOST", own) for name, value in headers.items()}
    answer = httpx.put(
        f"{panel.url}/api/forms/JOG", json={"values": {"350000": "500"}}, headers=sent
    )
    assert (answer.status_code == 200) is is_let_in
    assert (panel.panel.installation.store.read(350_000) == 500.0) is is_let_in


def test_every_answer_has_the_headers_of_a_strict_page(panel: Served) -> None:
    for path in ("/", "/api/me", "/no/such/page"):
        headers = httpx.get(panel.url + path).headers
        assert headers["content-security-policy"].startswith("default-src 'self'; ")
        assert "unsafe" not in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"


def test_with_passwords_nothing_is_shown_before_the_log_in(panel: Served) -> None:
    with guarded(panel) as web:
        assert web.get("/api/forms").status_code == 401
        assert web.get("/").headers["location"] == "/login"
        assert web.get("/api/me").json() == {"role": None, "roles": [], "login": True}

    async def scene() -> None:
        async with websockets.connect(panel.ws_url) as socket:
            with pytest.raises(websockets.exceptions.ConnectionClosed) as ended:
                await socket.recv()
            assert ended.value.rcvd is not None
            assert ended.value.rcvd.code == 4401

    asyncio.run(scene())


def test_a_log_in_gives_its_role_and_no_more(panel: Served) -> None:
    with guarded(panel) as web:
        answer = web.post("/api/login", json={"role": "operate", "password": "secret operate"})
        assert answer.json() == {"role": "operate"}
        cookie = answer.headers["set-cookie"]
        assert "HttpOnly" in cookie and "SameSite=strict" in cookie
        assert web.get("/api/me").json()["roles"] == ["view", "operate"]
        values = {"values": {"350000": "500"}}
        answer = web.put("/api/forms/JOG", json=values)
        assert (answer.status_code, answer.json()["error"]["needs"]) == (403, "service")
        assert web.put("/api/forms/H-WEAR", json={"values": {"3001": "0.1"}}).status_code == 200
        web.post("/api/logout")
        assert web.get("/api/forms").status_code == 401


def test_wrong_passwords_make_the_next_try_wait(
    panel: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(delays, "FIRST_DELAY_S", delays.LONGEST_DELAY_S)  # longer than the test
    with guarded(panel) as web:
        wrong = {"role": "service", "password": "secret operate"}
        codes = [web.post("/api/login", json=wrong).status_code for _ in range(4)]
        assert codes == [401, 401, 401, 429]
        right = {"role": "service", "password": "secret service"}
        assert web.post("/api/login", json=right).status_code == 429


def test_a_role_without_control_is_refused_on_the_socket(panel: Served) -> None:
    with guarded(panel) as web:
        web.post("/api/login", json={"role": "view", "password": "secret view"})
        cookie = "; ".join(f"{name}={value}" for name, value in web.cookies.items())

    async def scene() -> None:
        headers = {"Cookie": cookie}
        async with websockets.connect(panel.ws_url, additional_headers=headers) as socket:
            client = Client(socket)
            answer = await client.do("home.start", axes="X")
            assert answer["error"]["code"] == "role"
            assert client.events[0]["role"] == "view"
            assert (await client.do("stop.hold"))["ok"]

    asyncio.run(scene())


def test_log_out_ends_the_connections_of_the_session(panel: Served) -> None:
    with guarded(panel) as web:
        web.post("/api/login", json={"role": "operate", "password": "secret operate"})
        cookie = "; ".join(f"{name}={value}" for name, value in web.cookies.items())

        async def scene() -> None:
            headers = {"Cookie": cookie}
            async with websockets.connect(panel.ws_url, additional_headers=headers) as socket:
                client = Client(socket)
                await client.do("name", name="x")
                await asyncio.to_thread(web.post, "/api/logout")
                with pytest.raises(websockets.exceptions.ConnectionClosed):
                    while True:
                        await client.take()

        asyncio.run(scene())


def test_the_password_of_the_store_guards_the_system_parameters(panel: Served) -> None:
    password.change(panel.panel.installation.store, "machine")
    with httpx.Client(base_url=panel.url, timeout=LIMIT_S) as web:
        assert web.get("/api/me").json()["role"] == "setup"
        values = {"values": {"350000": "500"}}
        assert web.put("/api/forms/JOG", json=values).status_code == 403
        web.post("/api/login", json={"role": "service", "password": "machine"})
        assert web.put("/api/forms/JOG", json=values).status_code == 200


def test_an_address_that_others_reach_needs_a_password(panel: Served) -> None:
    with pytest.raises(UserError, match="no password is set"):
        require_password(panel.panel, "0.0.0.0", is_loopback=False)
    require_password(panel.panel, "127.0.0.1", is_loopback=True)
    panel.panel.accounts.set_password(Role.OPERATE, "long enough")
    require_password(panel.panel, "0.0.0.0", is_loopback=False)


def test_passwords_are_kept_as_hashes_and_survive_a_restart(panel: Served) -> None:
    panel.panel.accounts.set_password(Role.OPERATE, "long enough")
    file = panel.store.with_name("sysvar.db-panel")
    assert "long enough" not in file.read_text()
    assert file.stat().st_mode & 0o077 == 0
    again = Accounts(file, Store())
    assert again.is_right(Role.OPERATE, "long enough")
    assert not again.is_right(Role.OPERATE, "long  enough")
    assert not again.is_right(Role.SERVICE, "long enough")
    with pytest.raises(UserError, match="8 characters at least"):
        again.set_password(Role.VIEW, "short")
    file.write_text("{broken")
    with pytest.raises(UserError, match="cannot be read"):
        Accounts(file, Store())


def test_the_log_in_page_and_its_files_are_there_before_the_log_in(panel: Served) -> None:
    with guarded(panel) as web:
        page = web.get("/", follow_redirects=True)
        assert (page.status_code, page.url.path) == (200, "/login")
        assert page.headers["content-type"] == "text/html; charset=utf-8"
        files = re.findall(r'(?:href|src)="(/[^"]+)"', page.text)
        assert "/js/login.js" in files
        assert [web.get(name).status_code for name in files] == [200] * len(files)
        assert re.search(r"<script(?![^>]*src=)|<style|style=|\son\w+=", page.text) is None
        roles = re.findall(r'<option value="(\w+)"', page.text)
        assert roles == [role.word for role in Role]


def test_the_form_of_the_log_in_page_works_without_scripts(panel: Served) -> None:
    with guarded(panel) as web:
        page = web.get("/login").text
        action = re.findall(r'<form [^>]*method="post" action="([^"]+)"', page)
        assert action == ["/api/login/form"]
        wrong = web.post(action[0], data={"role": "setup", "password": "secret operate"})
        assert (wrong.status_code, wrong.headers["location"]) == (303, "/login?wrong=1")
        right = web.post(action[0], data={"role": "setup", "password": "secret setup"})
        assert (right.status_code, right.headers["location"]) == (303, "/")
        assert web.get("/api/me").json()["role"] == "setup"
        assert web.get("/").status_code == 200


def test_the_wait_after_wrong_passwords_is_at_least_a_second_in_words(panel: Served) -> None:
    with guarded(panel) as web:
        panel.panel.accounts.delays._failed["127.0.0.1"] = (3, time.monotonic() + 29.5)
        answer = web.post("/api/login", json={"role": "view", "password": "secret view"})
        assert answer.status_code == 429
        waits = re.fullmatch(
            r"too many wrong passwords: wait (\d+) s", answer.json()["error"]["text"]
        )
        assert waits is not None
        assert 1 <= int(waits[1]) <= 30


def test_a_password_is_set_and_removed_from_the_command_line(tmp_path: Path) -> None:
    store = tmp_path / "s.db"
    words = ["panel", "--store", str(store), "--set-password", "operate"]
    answer = CliRunner().invoke(app, words, input="long enough\nlong enough\n")
    assert "the password of the role operate was set" in answer.output
    assert Accounts(file_of(store), Store()).is_right(Role.OPERATE, "long enough")
    answer = CliRunner().invoke(app, words, input="\n\n")
    assert "the password of the role operate was removed" in answer.output
    assert not Accounts(file_of(store), Store()).are_asked
