"""A link that is frozen or cut: old positions are greyed, nothing is moved, it comes back."""

from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until
from tests.proxy import Proxy

from openacr.panel.server import hello


@pytest.fixture(scope="module")
def stale_ms() -> int:
    """As on a machine."""
    return hello.STALE_MS


def is_jogging(served: Served) -> bool:
    return served.call(lambda station: bool(station.link.machine.runner.jogging.is_active))


def hold_x(page: Page, served: Served) -> None:
    """Hold the plus key of X until the machine jogs; a busy machine may end a press."""
    page.keyboard.press("F7")
    page.keyboard.press("F2")
    page.get_by_role("button", name="X plus").hover()

    def moves() -> bool:
        page.mouse.up()
        page.mouse.down()
        page.wait_for_timeout(100)
        return is_jogging(served)

    until(page, moves)


@pytest.fixture(scope="module")
def proxy(served: Served) -> Iterator[Proxy]:
    with Proxy(f"127.0.0.1:{served.port}") as proxy:
        yield proxy


@pytest.fixture(scope="module")
def workspace(context: BrowserContext, proxy: Proxy) -> Page:
    return open_page(context, proxy.url)


@pytest.mark.parametrize("how", ["frozen", "reset"])
def test_a_link_that_fails_stops_the_jog_and_comes_back_by_itself(
    page: Page, proxy: Proxy, served: Served, how: str
) -> None:
    hold_x(page, served)
    (proxy.freeze_down if how == "frozen" else proxy.reset)()
    until(page, lambda: not is_jogging(served))
    if how == "frozen":
        expect(page.locator("body.is-stale #banner")).to_be_visible()
        page.mouse.up()
        page.mouse.down()
        expect(page.locator("#prompt")).to_have_text(
            "⚠ Nothing is moved: the positions shown are old"
        )
    proxy.thaw()
    page.locator("body:not(.is-stale)").wait_for()
    rest = served.station.snapshot.commanded[0]
    page.wait_for_timeout(300)
    assert not is_jogging(served)  # the key is still down: its press is over
    assert served.station.snapshot.commanded[0] == pytest.approx(rest, abs=1e-9)
    page.mouse.up()
