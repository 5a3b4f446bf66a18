"""Files of the screens as the server sends them: modules named at once, packed, never delayed."""

import gzip
import os
import re
import socket
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from starlette.requests import Request
from tests.panel.bench import Served

from openacr.panel.server.modules import with_modules
from openacr.panel.server.static import WEB, static_file, with_parts

LINK = re.compile(r'<link rel="modulepreload" href="/([^"]+)">')
SCRIPT = '<script type="module" src="/js/main.js"></script>'
SITE = {
    "js/main.js": """import { a } from "./core/a.js";
async function start() {
  const [b, c] = await Promise.all([import("./frame/b.js"), import( "./frame/c.js")]);
}
""",
    "js/core/a.js": 'export { d } from "./d.js";\nimport {\n  e,\n} from "../e.js";\n',
    "js/core/d.js": 'import "./a.js";\n',
    "js/e.js": 'const later = () => import("./vendor/big.js");\n',
    "js/frame/b.js": 'import { a } from "../core/a.js";\nimport { f } from "./f.js";\n',
    "js/frame/c.js": "",
    "js/frame/f.js": '// import "./not.js" is only written here\n',
}


@pytest.fixture
def quiet_panel(kept_quiet_panel: Served) -> Served:
    return kept_quiet_panel


@pytest.fixture
def web(quiet_panel: Served) -> Iterator[httpx.Client]:
    with httpx.Client(base_url=quiet_panel.url) as client:
        yield client


def test_a_page_names_every_module_of_its_start_once_and_none_that_is_imported_later() -> None:
    page = with_modules(f"<head>{SCRIPT}</head>", lambda path: SITE[path])
    assert page.startswith(f"<head>{SCRIPT}\n")
    assert page.endswith("</head>")
    assert LINK.findall(page) == [
        "js/core/a.js", "js/core/d.js", "js/e.js",  # the script does not begin without these
        "js/frame/b.js", "js/frame/f.js", "js/frame/c.js",
    ]  # fmt: skip


def test_a_page_without_a_script_stays_as_it_is() -> None:
    assert with_modules("<p>nothing</p>", lambda path: SITE[path]) == "<p>nothing</p>"


def test_a_part_of_a_page_stands_where_its_line_was() -> None:
    files = {"parts/a.html": "    <b>1</b>\n    <b>2</b>\n", "top.html": "<i></i>\n"}
    lines = ("<p>", "    <!-- include parts/a.html -->", "<!-- include top.html -->", "<!-- a -->")
    page = "".join(f"{line}\n" for line in lines)
    assert with_parts(page, files.__getitem__) == (
        "<p>\n    <b>1</b>\n    <b>2</b>\n<i></i>\n<!-- a -->\n"
    )


@pytest.mark.parametrize("path", ["/", "/bench", "/login"])
def test_every_page_has_the_common_head_once_and_each_workspace_the_top(
    web: httpx.Client, path: str
) -> None:
    page = web.get(path).text
    assert "include" not in page
    for line in ('<meta charset="utf-8">', 'name="viewport"', 'href="/css/base.css"'):
        assert page.count(line) == 1
    for place in ("state", "alarms", "banner", "tools"):
        assert page.count(f'id="{place}"') == (path != "/login")


def test_a_page_is_sent_anew_when_one_of_its_parts_has_changed(tmp_path: Path) -> None:
    (tmp_path / "index.html").write_text("<!-- include top.html -->\n")
    request = Request({"type": "http", "headers": [], "path_params": {"path": ""}})
    found = []
    for text in ("one", "other"):
        (tmp_path / "top.html").write_text(text)
        answer = static_file(request, tmp_path)
        found.append((bytes(answer.body).decode(), answer.headers["etag"]))
    assert [body for body, _ in found] == ["one", "other"]
    assert found[0][1] != found[1][1]


def test_the_workspace_names_modules_that_are_there_and_no_library(web: httpx.Client) -> None:
    found = LINK.findall(web.get("/").text)
    assert {"js/core/link.js", "js/frame/status.js", "js/blocks/positions.js"} <= set(found)
    assert len(found) == len(set(found))
    assert all((WEB / path).is_file() for path in found)
    assert [path for path in found if path.startswith("vendor/") or "bench" in path] == []
    assert LINK.findall(web.get("/login").text) == []  # its script imports nothing


@pytest.mark.parametrize("path", ["/", "/js/main.js", "/vendor/three.js"])
def test_a_file_is_sent_packed_where_that_is_accepted_and_not_again_while_it_is_the_same(
    web: httpx.Client, path: str
) -> None:
    plain = web.get(path, headers={"Accept-Encoding": "identity"})
    assert "content-encoding" not in plain.headers
    with web.stream("GET", path, headers={"Accept-Encoding": "gzip"}) as answer:
        packed = b"".join(answer.iter_raw())
    assert answer.headers["content-encoding"] == "gzip"
    assert int(answer.headers["content-length"]) == len(packed) < len(plain.content)
    assert gzip.decompress(packed) == plain.content
    tag = plain.headers["etag"]
    assert answer.headers["etag"] == tag
    again = web.get(path, headers={"If-None-Match": tag})
    assert (again.status_code, again.content) == (304, b"")
    assert web.get(path, headers={"If-None-Match": '"another"'}).status_code == 200


def test_the_packed_file_of_a_library_is_the_one_that_is_installed(web: httpx.Client) -> None:
    with web.stream("GET", "/vendor/three.js", headers={"Accept-Encoding": "gzip"}) as answer:
        assert b"".join(answer.iter_raw()) == (WEB / "vendor" / "three.js.gz").read_bytes()


def test_a_changed_file_is_sent_as_it_is_now(tmp_path: Path) -> None:
    place = tmp_path / "a.js"

    def sent() -> tuple[bytes, str]:
        request = Request({"type": "http", "headers": [], "path_params": {"path": "a.js"}})
        answer = static_file(request, tmp_path)
        return bytes(answer.body), answer.headers["etag"]

    place.write_text("1")
    first = sent()
    place.write_text("12")
    assert (first[0], sent()[0]) == (b"1", b"12")
    assert sent()[1] != first[1]
    place.write_text("34")
    os.utime(place, ns=(1, 1))
    assert sent()[0] == b"34"


def test_the_body_of_an_answer_does_not_wait_for_the_acknowledgement_of_its_head(
    quiet_panel: Served,
) -> None:
    listening = quiet_panel._server.socket
    assert listening.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) != 0


def test_the_workspace_of_the_engineer_names_its_modules_and_none_of_a_pane(
    web: httpx.Client,
) -> None:
    found = LINK.findall(web.get("/bench").text)
    assert {"js/bench/workspace.js", "js/bench/bar.js", "js/frame/stop.js"} <= set(found)
    assert all((WEB / path).is_file() for path in found)
    assert [path for path in found if path.startswith("vendor/")] == ["vendor/dockview.js"]
    assert [path for path in found if "screens/" in path or "panes/" in path] == []
