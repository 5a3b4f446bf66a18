"""Chrome, Chromium or Edge for the tests of the screens: found on the machine, else installed.

`python -m tests.panel.browser.chromium` installs one if none is found (`make test` runs it).
"""

import os
import shutil
import subprocess
import sys
from contextlib import suppress
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
# The first two are pages of the browser's own beside every page, 0.6 s of a processor each time;
# the others are what Playwright disables: its list does not count once there is one here.
UNUSED = (
    "WebUIOmniboxPopup", "WebUIOmniboxAimPopup",
    "AimEnabled", "AvoidUnnecessaryBeforeUnloadCheckSync", "DestroyProfileOnBrowserClose",
    "HttpsFirstBalancedModeAutoEnable", "HttpsUpgrades", "LensOverlay", "MediaRouter",
    "NetworkTimeServiceQuerying", "OptimizationHints", "PaintHolding", "PreconnectToSearch",
    "ThirdPartyStoragePartitioning",
)  # fmt: skip
OPTIONS = [
    "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync",
    f"--disable-features={','.join(UNUSED)}",
]  # fmt: skip
QUIET = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
LONGEST_S = 300.0  # of one step of an installation
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


def _installers() -> list[list[str]]:
    """What to try: the browser of the system where it may be installed, then Playwright's own."""
    own = [sys.executable, "-m", "playwright", "install", "chromium"]
    if not shutil.which("apt-get") or os.geteuid() != 0:
        return [own]
    system = ["apt-get", "install", "--yes", "--no-install-recommends", "chromium"]
    return [["apt-get", "update"], system, own]  # a new machine has no lists of packages


def install() -> int:
    """Install a browser if none is found."""
    if path := found():
        print(f"browser for the tests of the screens: {path}")
        return 0
    print("installing a browser for the tests of the screens")
    for command in _installers():
        with suppress(subprocess.TimeoutExpired):
            subprocess.run(
                command, check=False, stdout=subprocess.DEVNULL, timeout=LONGEST_S, env=QUIET
            )
        if found():
            return 0
    print(MISSING)
    return 0  # the tests of the screens fail with this text; all others run


if __name__ == "__main__":
    sys.exit(install())
