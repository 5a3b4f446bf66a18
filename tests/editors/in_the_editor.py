"""The extension in Visual Studio Code itself, as code-server shows it in a browser.

Not part of `make test`: `make editor-test CODE_SERVER=FOLDER` runs it with code-server from npm
(`editors/vscode/README.md` says how it is installed). The folder SHOTS gets pictures.
"""

import json
import os
import shutil
import socket
import subprocess
import sys
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect, sync_playwright
from tests.panel.browser.chromium import OPTIONS, found

EXTENSION = Path(__file__).parents[2] / "editors" / "vscode"
LIMIT_MS = 60_000
PART = "F600\nP200=1\nG1 X(P200)\nG1 Y0.5\nM2\n"
Opened = Callable[..., Page]

pytestmark = pytest.mark.timeout(600)


@pytest.fixture(scope="session")
def extensions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the extension and the language client it needs."""
    folder = tmp_path_factory.mktemp("extensions")
    copy = folder / "openacr.openacr-0.1.0"
    shutil.copytree(EXTENSION, copy)
    subprocess.run(["npm", "install", "--omit=dev", "--no-audit"], cwd=copy, check=True)
    return folder


@pytest.fixture(scope="session")
def browser() -> Iterator[Browser]:
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found(), args=OPTIONS)
        yield browser
        browser.close()


@pytest.fixture
def opened(extensions: Path, browser: Browser, tmp_path: Path) -> Iterator[Opened]:
    """A function that opens a file of a folder in a new editor, with a path of openacr."""
    servers = []

    def open_file(name: str, text: str, path: str | None = None) -> Page:
        settings = {
            "openacr.path": path or str(Path(sys.executable).with_name("openacr")),
        }
        machine, folder = tmp_path / "user" / "Machine", tmp_path / "project"
        machine.mkdir(parents=True)
        folder.mkdir()
        (machine / "settings.json").write_text(json.dumps(settings))
        (folder / name).write_text(text)
        url, server = _served(tmp_path / "user", extensions)
        servers.append(server)
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        page.goto(f"{url}/?folder={folder}")
        page.get_by_role("treeitem", name=name).click(click_count=2, timeout=LIMIT_MS)
        expect(page.locator(".monaco-editor .view-line").first).to_be_visible(timeout=LIMIT_MS)
        return page

    yield open_file
    for server in servers:
        server.terminate()
        server.wait(60)


def _served(user: Path, extensions: Path) -> tuple[str, "subprocess.Popen[bytes]"]:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        url = f"127.0.0.1:{free.getsockname()[1]}"
    program = Path(os.environ["CODE_SERVER"]) / "out" / "node" / "entry.js"
    server = subprocess.Popen([
        "node", str(program), "--auth", "none", "--bind-addr", url, "--user-data-dir", str(user),
        "--config", str(user / "config.yaml"), "--extensions-dir", str(extensions),
        "--disable-telemetry", "--disable-update-check", "--disable-workspace-trust",
    ])  # fmt: skip
    while server.poll() is None:
        try:
            urllib.request.urlopen(f"http://{url}/healthz", timeout=5).close()
            break
        except (urllib.error.URLError, OSError):
            continue
    assert server.returncode is None
    return f"http://{url}", server


def picture(page: Page, name: str) -> None:
    if "SHOTS" in os.environ:
        page.screenshot(path=Path(os.environ["SHOTS"]) / f"{name}.png")


def test_findings_are_underlined_with_their_hints(opened: Opened) -> None:
    page = opened("prog0.8k", "PROGRAM\nSETT 32\nENDP\n")
    expect(page.locator(".squiggly-error").first).to_be_attached(timeout=LIMIT_MS)
    page.keyboard.press("Control+Shift+M")
    expect(page.get_by_text("did you mean SET?").last).to_be_visible(timeout=LIMIT_MS)
    picture(page, "findings")


def test_f5_debugs_a_part_program_forwards_and_backwards(opened: Opened) -> None:
    page = opened("part.nc", PART)
    expect(page.get_by_text("User variable 200").first).to_be_visible(
        timeout=LIMIT_MS
    )  # of the server
    page.keyboard.press("F5")
    stack = page.locator(".debug-call-stack")
    expect(stack.get_by_text("part.nc line 1")).to_be_visible(timeout=LIMIT_MS)
    for line in (2, 3):
        page.keyboard.press("F10")
        expect(stack.get_by_text(f"part.nc line {line}")).to_be_visible(timeout=LIMIT_MS)
    picture(page, "stepped")
    page.get_by_role("button", name="Step Back").click()
    expect(stack.get_by_text("part.nc line 2")).to_be_visible(timeout=LIMIT_MS)
    picture(page, "back")


def test_a_path_without_openacr_is_reported_with_its_reason(opened: Opened) -> None:
    page = opened("part.nc", PART, path="/nowhere/openacr")
    reason = page.get_by_text("the language server does not start: Launching server").first
    expect(reason).to_be_visible(timeout=LIMIT_MS)
    picture(page, "missing")
