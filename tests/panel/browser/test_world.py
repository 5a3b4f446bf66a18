"""The pane World: where its links are drawn, and what is changed by hand in it."""

import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from playwright.sync_api import BrowserContext, Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import LONGEST_MS, READY, give, open_page, until_model
from tests.panel.browser.test_bench import open_pane

from openacr.controller import Controller
from openacr.panel.control.machine.installation import Installation
from openacr.panel.control.station import Station
from openacr.panel.machine import FOLDER, opened
from openacr.plant.describe.load import load_world

pytestmark = pytest.mark.evidence("oracle", "products of homogeneous matrices by numpy")
GRIPPER = """
[[device]]
kind = "gripper"
name = "jaws"
outputs = { close = 33 }
sign = { at = [0, 0, -50], parent = "Z" }
"""
STL = """solid wedge
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 60 0 0
vertex 0 40 30
endloop
endfacet
facet normal 0 0 -1
outer loop
vertex 0 0 0
vertex 0 40 30
vertex 60 0 0
endloop
endfacet
endsolid wedge
"""
FRAMES = (
    "([links, positions]) => import('/js/draw/kinematics.js').then(({ frames }) => "
    "frames(links, positions).flatMap(({ fixed, moving }) => [fixed, moving]))"
)


@pytest.fixture(scope="module")
def page(context: BrowserContext, served: Served) -> Iterator[Page]:
    """The workspace with the pane World."""
    page = open_page(context, f"{served.url}/bench")
    open_world(page)
    yield page


def card_bit(served: Served, number: int) -> bool:
    def read(station: Station) -> bool:
        assert station.installation.controller is not None
        return station.installation.controller.bit[number]

    return served.call(read)


def link(parent: int | None, origin: list[float], direction: list[float], **more: Any) -> Any:
    return {"parent": parent, "origin": origin, "direction": direction, "is_rotary": False,
            "per_unit": 1.0, **more}  # fmt: skip


def shift(x: float, y: float, z: float) -> Any:
    found = np.eye(4)
    found[:3, 3] = (x, y, z)
    return found


def turn(axis: int, degrees: float) -> Any:
    """A rotation about X (0), Y (1) or Z (2), by the right hand."""
    s, c = np.sin(np.radians(degrees)), np.cos(np.radians(degrees))
    found, (j, k) = np.eye(4), ((axis + 1) % 3, (axis + 2) % 3)
    found[j, j], found[j, k], found[k, j], found[k, k] = c, -s, s, c
    return found


def test_every_link_is_where_the_product_of_the_transforms_of_its_carriers_puts_it(
    page: Page,
) -> None:
    links = [
        link(None, [1, 2, 3], [1, 0, 0], per_unit=25.4),
        link(0, [0, 0, 10], [0, 0.6, -0.8]),
        link(1, [5, 0, 0], [0, 0, 1], is_rotary=True),
        link(2, [0, 7, 0], [0, 1, 0], is_rotary=True, per_unit=360.0),
        link(3, [0, 0, 9], [1, 0, 0], is_rotary=True),
        link(None, [0, 40, 0], [0, 0, 1]),
    ]
    positions = [2.0, -3.0, 30.0, 0.125, -70.0, 4.5]
    x = shift(1, 2, 3)
    y = x @ shift(50.8, 0, 0) @ shift(0, 0, 10)
    c = y @ shift(0, -1.8, 2.4) @ shift(5, 0, 0)
    b = c @ turn(2, 30) @ shift(0, 7, 0)
    a = b @ turn(1, 45) @ shift(0, 0, 9)
    z = shift(0, 40, 0)
    wanted = [
        x, x @ shift(50.8, 0, 0), y, y @ shift(0, -1.8, 2.4), c, c @ turn(2, 30),
        b, b @ turn(1, 45), a, a @ turn(0, -70), z, z @ shift(0, 0, 4.5),
    ]  # fmt: skip
    found = page.evaluate(FRAMES, [links, positions])
    for matrix, expected in zip(found, wanted, strict=True):
        np.testing.assert_allclose(np.reshape(matrix, (4, 4)).T, expected, atol=1e-12)


def test_the_drawing_follows_the_positions_of_the_world(page: Page) -> None:
    name = page.locator("[data-pane=world] .world-name[data-axis=X]")
    expect(name).to_have_text(re.compile(r"^X (119\.99|120\.00)\d mm$"))
    give(page, "mdi.execute", line="G21 G91 G0 X10")
    expect(name).to_have_text(re.compile(r"^X (129\.99|130\.00)\d mm$"))
    until_model(page, "!model.state.value.busy")
    assert page.complaints == []  # type: ignore[attr-defined]


def test_an_input_is_forced_and_released_by_its_keys_and_the_card_sees_it(
    page: Page, served: Served
) -> None:
    row = page.locator("[data-pane=world] [data-input='2']")
    expect(row).to_contain_text("home of axis X")
    before = card_bit(served, 2)
    for wish, text in (("on", "forced on"), ("off", "forced off")):
        row.get_by_role("button", name=f"Input 2 {wish}").click()
        expect(row.locator(".io-state")).to_have_text(text)
        assert card_bit(served, 2) is (wish == "on")
    row.get_by_role("button", name="Release input 2").click()
    expect(row.locator(".io-state")).to_have_text("on" if before else "off")
    expect(row.get_by_role("button", name="Release input 2")).to_be_disabled()


def test_a_fault_is_caused_with_its_value_shown_and_mended(page: Page) -> None:
    pane = page.locator("[data-pane=world]")
    pane.get_by_label("Axis of the fault").select_option("Y")
    pane.get_by_label("Kind of the fault").select_option("supply")
    expect(pane.locator("form .hint")).to_have_text("voltage V (above 0 to 320 V)")
    pane.get_by_label("voltage").fill("400")
    pane.get_by_role("button", name="CAUSE").click()
    expect(page.locator("#prompt")).to_contain_text("a supply of 400 V; above 0 to 320 V")
    pane.get_by_label("voltage").fill("40")
    pane.get_by_role("button", name="CAUSE").click()
    shown = pane.locator("[data-fault='1.supply']")
    expect(shown).to_contain_text("Y: supply too low 40 V")
    shown.get_by_role("button").click()
    expect(shown).to_have_count(0)


# --- devices, bodies, other cards -----------------------------------------------------


@pytest.fixture(scope="module")
def cell(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """The mill with a gripper, and a wedge of two faces as the body of Z."""
    folder = tmp_path_factory.mktemp("cell")
    (folder / "wedge.stl").write_text(STL)
    text = (FOLDER / "machine.toml").read_text()
    text = text.replace('name = "Z"\n', 'name = "Z"\nbody = { file = "wedge.stl" }\n') + GRIPPER
    (folder / "machine.toml").write_text(text)
    controller = Controller(world=load_world(folder / "machine.toml"), device_folder=folder)
    store = opened(folder / "sysvar.db")
    served = Served(folder, installation=Installation.inside(controller, store, folder))
    yield served
    served.close()


def test_devices_are_commanded_by_hand_and_bodies_come_from_files(
    context: BrowserContext, cell: Served
) -> None:
    page = context.new_page()
    page.set_default_timeout(LONGEST_MS)
    with page.expect_response(lambda answer: "/api/world/body" in answer.url) as answer:
        page.goto(f"{cell.url}/bench")
        page.wait_for_function(READY)
        open_world(page)
    assert (answer.value.status, answer.value.url.partition("?")[2]) == (200, "axis=2")
    assert answer.value.text() == STL
    pane = page.locator("[data-pane=world]")
    part = pane.get_by_role("button", name="jaws: part")
    expect(pane.locator(".world-name[data-device=jaws]")).to_have_text("jaws opened")
    for pressed in ("true", "false"):
        part.click()
        expect(part).to_have_attribute("aria-pressed", pressed)
    page.close()


def test_of_a_card_elsewhere_the_axes_are_drawn_and_the_pane_says_why_nothing_can_be_changed(
    context: BrowserContext, served: Served
) -> None:
    page = context.new_page()
    page.set_default_timeout(LONGEST_MS)

    def elsewhere(route: Route) -> None:
        about = route.fetch().json()
        nothing: dict[str, object] = {"inputs": [], "faults": [], "devices": []}
        links = [{**each, "file": ""} for each in reversed(about["links"])]
        links = [{**each, "parent": None} for each in links]
        route.fulfill(json={**about, **nothing, "links": links, "why_not": "it is elsewhere"})

    page.route("**/api/world", elsewhere)
    page.goto(f"{served.url}/bench")
    page.wait_for_function(READY)
    open_world(page)
    pane = page.locator("[data-pane=world]")
    expect(pane.locator(".world-note")).to_have_text("it is elsewhere")
    expect(pane.get_by_role("button", name="CAUSE")).to_have_count(0)
    give(page, "control.take", force=True)
    give(page, "mdi.execute", line="G21 G91 G0 Y2 Z1")  # of the card, which calls its start 0
    for name, place in (("Y", r"(1\.99|2\.00)"), ("Z", r"(0\.99|1\.00)")):
        shown = pane.locator(f".world-name[data-axis={name}]")
        expect(shown).to_have_text(re.compile(rf"^{name} {place}\d mm$"))
    until_model(page, "!model.state.value.busy")
    page.close()


def open_world(page: Page) -> None:
    page.get_by_role("button", name="PANES").click()
    page.get_by_role("dialog").get_by_role("button", name="World", exact=True).click()
    expect(page.locator("[data-pane=world] canvas")).to_be_visible()


DRAWN = """() => {
  const canvas = document.querySelector('[data-pane=world] canvas');
  const copy = document.createElement('canvas');
  [copy.width, copy.height] = [canvas.width, canvas.height];
  const pen = copy.getContext('2d');
  pen.drawImage(canvas, 0, 0);
  const { data } = pen.getImageData(0, 0, copy.width, copy.height);
  const [xs, ys] = [[], []];
  for (let at = 0; at < data.length; at += 4) {
    const [r, g, b, a] = data.slice(at, at + 4);
    if (a > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 40) {
      xs.push((at / 4) % copy.width);
      ys.push(Math.floor(at / 4 / copy.width));
    }
  }
  const span = (values) => values.reduce(([a, b], v) => [Math.min(a, v), Math.max(b, v)], [1e9, 0]);
  return [span(xs).map((v) => v / copy.width), span(ys).map((v) => v / copy.height)];
}"""


def test_a_fitted_machine_fills_its_picture_again_after_it_was_enlarged(
    page: Page,
) -> None:
    """In the coloured parts alone: its bodies, ends and signs, without rails and ground."""
    page.set_viewport_size({"width": 1366, "height": 768})
    pane = page.locator("[data-pane=world]")
    pane.get_by_role("button", name="FIT").click()
    page.wait_for_function(f"() => {{ const [x, y] = ({DRAWN})(); return y[1] - y[0] > 0.6; }}")
    for _ in range(3):
        pane.get_by_role("button", name="Zoom in").click()
    page.wait_for_function(f"() => {{ const [x, y] = ({DRAWN})(); return y[1] > 0.99; }}")
    pane.get_by_role("button", name="FIT").click()
    page.wait_for_function(f"() => {{ const [x, y] = ({DRAWN})(); return y[1] < 0.95; }}")
    assert page.complaints == []  # type: ignore[attr-defined]


LEAVING = """async () => {
  const { createDrawing } = await import('/js/bench/world/drawing.js');
  const about = await (await fetch('/api/world')).json();
  const links = [{ ...about.links[0], parent: null, file: '' }];
  const host = document.createElement('div');
  host.style.cssText = 'position: fixed; inset: 0; width: 600px; height: 400px';
  document.body.append(host);
  const turn = () => new Promise((done) => requestAnimationFrame(() => setTimeout(done)));
  const ends = [];
  const endings = { add: (...all) => ends.push(...all) };
  const drawing = createDrawing(host, endings, { links, devices: [] });
  const at = async (position) => {
    const no = () => false;
    drawing.show({ positions: [position], isActive: no, isForced: no, isBusy: no }, ['X'], []);
    for (let n = 0; n < 4; n++) await turn();
    return host.querySelector('.world-name').style.transform;
  };
  const found = [];
  for (const position of [0, 0.001, 20 * links[0].high, 0]) found.push(await at(position));
  ends.forEach((end) => end());
  host.remove();
  return found;
}"""


def test_a_machine_that_leaves_its_fitted_picture_is_fitted_again(page: Page) -> None:
    first, near, far, back = page.evaluate(LEAVING)
    assert near == first
    assert far != first
    assert back == far  # it is in the picture: nothing jumps


def test_a_forced_input_lights_a_lamp_in_every_browser_and_is_released_from_its_list(
    page: Page, served: Served
) -> None:
    lamp = page.get_by_role("button", name="FORCED: ")
    expect(lamp).to_be_hidden()
    page.bring_to_front()
    open_pane(page, "I/O")
    until_model(page, "model.forced.value.inputs.length")
    (first, second, *_) = served.call(lambda station: station.world.forced()["inputs"])
    give(page, "world.input", input=first, state="on")
    give(page, "world.input", input=second, state="off")
    expect(lamp).to_have_text("FORCED: 2")
    row = page.locator(f"[data-pane=io] [data-bit='{first}'] .io-state")
    expect(row).to_have_text("forced on")
    lamp.click()
    dialog = page.get_by_role("dialog", name="Forced inputs")
    dialog.get_by_role("button", name=f"RELEASE BIT{first}").click()
    expect(lamp).to_have_text("FORCED: 1")
    dialog.get_by_role("button", name="RELEASE ALL").click()
    expect(lamp).to_be_hidden()
    expect(page.locator("#prompt")).to_contain_text("1 input was released")
    assert served.call(lambda station: station.world.forced()["forced"]) == []
    item = {"id": f"BIT{first}", "number": first, "name": "", "object": "", "index": None,
            "section": "", "doc": "", "writable": True, "parameter": 0}  # fmt: skip
    page.evaluate(
        "(item) => void import('/js/frame/card_value.js').then((m) => m.changeValue(item, ''))",
        item,
    )
    page.get_by_role("dialog").get_by_role("button", name="FORCE ON").click()
    expect(lamp).to_have_text("FORCED: 1")
    give(page, "world.release")
    expect(lamp).to_be_hidden()
