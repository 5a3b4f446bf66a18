"""Chrome, Chromium or Edge for the tests of the screens: found on the machine, else installed.

`python -m tests.panel.browser.chromium` installs one if none is found (`make test` runs it).
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

NAMES = (
    "chromium", "chromium-browser", "google-chrome-stable", "google-chrome", "chrome",
    "microsoft-edge-stable", "microsoft-edge", "msedge",
)  # fmt: skip
PLACES = (
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
    "/Applications/Microsoft Edge.app/Contents/MacOS/Microsoft Edge",
    "C:/Program Files/Google/Chrome/Application/chrome.exe",
    "C:/Program Files (x86)/Microsoft/Edge/Application/msedge.exe",
)
OPTIONS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
]  # fmt: skip
MISSING = (
    "no Chrome, Chromium or Edge was found: install one (Debian and Ubuntu: apt install chromium; "
    "anywhere: python -m playwright install chromium), or name it in OPENACR_BROWSER"
)


def found() -> str | None:
    """The browser of this machine; OPENACR_BROWSER names another."""
    named = os.environ.get("OPENACR_BROWSER")
    if named:
        return named
    for name in NAMES:
        if path := shutil.which(name):
            return path
    return next((each for each in (*PLACES, _downloaded()) if Path(each).is_file()), None)


def _downloaded() -> str:
    """Where Playwright keeps its own Chromium, present or not."""
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        return playwright.chromium.executable_path


def install() -> int:
    """Install a browser: Playwright's own, else as root the one of the system."""
    if path := found():
        print(f"browser for the tests of the screens: {path}")
        return 0
    own = [sys.executable, "-m", "playwright", "install", "chromium"]
    system = ["apt-get", "install", "--yes", "--no-install-recommends", "chromium"]
    for command in (own, system):
        if shutil.which(command[0]):
            subprocess.run(command, check=False)
        if found():
            return 0
    print(MISSING)
    return 0  # the tests of the screens fail with this text; all others run


if __name__ == "__main__":
    sys.exit(install())
