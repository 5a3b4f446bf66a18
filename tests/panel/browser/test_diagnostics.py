"""The screens of DIAGNOSTICS on a running virtual mill."""

import re
from collections.abc import Callable, Iterator
from functools import partial

import pytest
from playwright.sync_api import Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import at_rest, give, until, until_model

from openacr.client import Level
from openacr.map import parameters
from openacr.panel.control.station import Station
from openacr.sysvar.tabs import CONTROL, OFFSETS

SHOW = "(name) => import('/js/frame/menu_bar.js').then(({ openMenu }) => openMenu(name))"
LISTED = """() => [...document.querySelectorAll('#screen tbody tr')].map((row) =>
  [row.cells[0].textContent, row.cells[1].textContent, row.cells[2].querySelector('strong').textContent])"""  # noqa: E501


def open_diagnostics(page: Page, key: int, screen: str) -> None:
    page.evaluate(SHOW, "diagnostics")
    page.keyboard.press(f"F{key}")
    page.wait_for_selector(f"#screen[data-screen={screen}]:not([hidden]) .screen-body > *")


@pytest.fixture
def running(page: Page, served: Served) -> Iterator[Page]:
    """The workspace while X moves slowly."""
    give(page, "mdi.execute", line="G21 G91 G1 X60 F20")
    until_model(page, "model.state.value.state === 'RUN'")
    yield page
    give(page, "stop.all")
    at_rest(page, served)


# --- the servo loop: every value of the loop of one axis, as the card has it ---------------

# Places in the block of an axis that each box shows, with decimals; None: six digits.
LOOP: dict[str, list[tuple[int, int | None]]] = {
    "current": [(0, 0)], "gear": [(8, 0)], "jog": [(9, 0)], "cam": [(10, 0)],
    "backlash": [(12, 0)], "primary": [(6, 0)], "ballscrew": [(11, 0)], "secondary": [(7, 0)],
    "actual": [(2, 0)], "error": [(3, 0)],
    "p": [(24, 4), (16, None)],
    "i": [(25, 4), (17, None), (18, None), (19, None)],
    "d": [(26, 4), (20, None), (21, None)],
    "ffvel": [(66, 4), (22, None), (27, 0)],
    "ffacc": [(67, 4), (23, None), (28, 0)],
    "fbvel": [(65, 4), (64, None)],
    "sum": [(29, 4)],
    "filter0": [(48, None), (49, None), (50, None), (51, None), (52, None)],
    "filter1": [(53, None), (54, None), (55, None), (56, None), (57, None)],
    "filtered": [(30, 4)], "limits": [(40, None), (41, None)], "output": [(31, 4)],
}  # fmt: skip
GIVEN = {  # gains, limits, and coefficients of filters that are off
    16: 0.0025, 17: 1e-06, 18: 1.5, 19: 0.25, 20: 1e-05, 21: 0.002, 22: 3e-05, 23: 2e-06,
    40: 9.5, 41: -9.25, 64: 1e-06,
    **{48: 0.1, 49: 0.2, 50: 0.3, 51: 0.4, 52: 0.5, 53: 0.6, 54: 0.7, 55: 0.8, 56: 0.9, 57: 1.1},
}  # fmt: skip
BOXES = """(root) => Object.fromEntries([...root.querySelectorAll('[data-box]')].map((box) =>
  [box.dataset.box, [...box.querySelectorAll('[text-anchor=end]')].map((each) => Number(each.textContent))]))"""  # noqa: E501
SHOWN = f"() => ({BOXES})(document.querySelector('.loop-picture'))"
# The boxes of a drawing whose every value is its place and a quarter.
PLACES = f"""() => import('/js/draw/loop.js').then(({{ drawLoop }}) => {{
  const loop = drawLoop('');
  loop.update((place) => place + 0.25);
  return ({BOXES})(loop.element);
}})"""


def boxes(values: Callable[[int], float]) -> dict[str, list[float]]:
    """What the boxes show of values by their places."""
    return {
        box: [
            float(f"{values(place):.6g}") if decimals is None else round(values(place), decimals)
            for place, decimals in rows
        ]
        for box, rows in LOOP.items()
    }


@pytest.mark.req("MILL-DIAG-SERVO")
def test_the_servo_loop_of_the_chosen_axis_is_drawn_with_all_its_values(
    page: Page, served: Served
) -> None:
    open_diagnostics(page, 6, "servo")
    first = 12288 + 256  # of Y

    def values() -> dict[int, float]:
        def read(station: Station) -> dict[int, float]:
            places = {place for box in LOOP.values() for place, _ in box}
            return {place: float(station.link.machine.card.read(first + place)) for place in places}

        return served.call(read)

    def write(new: dict[int, float]) -> None:
        def do(station: Station) -> None:
            for place, value in new.items():
                station.link.machine.card.write(first + place, value)

        served.call(do)

    expect(page.locator(".loop-picture [data-box] .title")).to_have_count(22)
    assert page.evaluate(PLACES) == boxes(lambda place: place + 0.25)
    expect(page.locator("[data-box=p] .gain").nth(1)).to_have_text("0.002441")  # of X
    page.get_by_role("radio", name="Y").click()
    before = values()
    write({**GIVEN, 8: 250})  # a gear offset moves the setpoints
    until(page, lambda: page.evaluate(SHOWN) == boxes(values().__getitem__))
    card = values()
    assert {place: card[place] for place in GIVEN} == pytest.approx(GIVEN, rel=1e-6)
    assert card[6] == before[6] + 250
    assert card[7] == before[7] + 250
    assert card[2] != before[2]
    expect(page.locator("#screen [role=status]")).to_have_text("Loop closed \u00b7 filters off")
    page.get_by_role("radio", name="X").click()
    expect(page.locator("[data-box=p] .gain").nth(1)).to_have_text("0.002441")
    expect(page.locator("[data-box=gear] .value")).to_have_text("0")
    write({place: before[place] for place in (*GIVEN, 8)})


@pytest.mark.req("MILL-DIAG-IO", "MILL-DIAG-IO-NAMES")
def test_io_status_shows_every_input_and_output_live(page: Page, served: Served) -> None:
    store = served.panel.installation.store
    page.evaluate(SHOW, "display")
    page.keyboard.press("F3")
    page.locator(f"#cell-{OFFSETS.input_name[3]}").fill("Door closed")
    save = page.get_by_role("button", name="SAVE", exact=True)
    save.click()
    expect(save).to_be_disabled()
    open_diagnostics(page, 1, "io")
    rows = page.locator("#screen .io-row")
    expect(rows).to_have_count(64)
    bits = [int(str(row.get_attribute("data-bit"))) for row in rows.all()]
    assert bits == [*range(64)]
    expect(page.locator("#screen [data-bit='3'] .io-name")).to_have_text("Door closed")
    for bit in (21, 40, 63):
        for text, on in (("on", True), ("off", False)):
            served.call(partial(_switch, bit=bit, on=on))
            expect(page.locator(f"#screen [data-bit='{bit}'] .io-state")).to_have_text(text)
            lamp = page.locator(f"#screen [data-bit='{bit}'] .lamp.is-on")
            expect(lamp).to_have_count(int(on))
    inputs = served.call(lambda station: int(station.link.machine.card.read(4096)))
    expect(page.locator("#screen [data-bit='0'] .io-state")).to_have_text(
        "on" if inputs & 1 else "off"
    )
    store.write(CONTROL.io_expansion_modules, 2)
    expect(rows).to_have_count(64 + 2 * 64)
    bits = [int(str(row.get_attribute("data-bit"))) for row in rows.all()]
    assert bits == [
        *range(32), *range(256, 288), *range(320, 352),
        *range(32, 64), *range(288, 320), *range(352, 384),
    ]  # fmt: skip
    store.write(CONTROL.io_expansion_modules, 0)
    expect(rows).to_have_count(64)
    until_model(page, "model.status.value.machine.length === 3")


@pytest.mark.req("MILL-DIAG-TERM", "MILL-DIAG-TERM-RUN")
def test_the_terminal_sends_lines_as_they_are_also_while_a_program_runs(
    page: Page, served: Served
) -> None:
    served.call(lambda station: station.link.machine.card.write(3, 41.5))
    open_diagnostics(page, 2, "terminal")
    text = page.locator("#screen .xterm-rows")
    line = page.get_by_label("Line for the card")
    line.fill("?P3")
    line.press("Enter")
    expect(text).to_contain_text("41.5")
    give(page, "mdi.execute", line="G21 G91 G1 X60 F20")
    until_model(page, "model.state.value.state === 'RUN'")
    served.call(lambda station: station.link.machine.card.write(3, 42.25))
    line.fill("?P3")
    line.press("Enter")
    expect(text).to_contain_text("42.25")
    assert served.call(lambda station: station.link.machine.runner.is_busy)
    give(page, "stop.all")
    at_rest(page, served)


# --- scope ----------------------------------------------------------------------------


def fill(page: Page, values: dict[str, str]) -> None:
    for label, value in values.items():
        page.get_by_label(label, exact=True).fill(value)


@pytest.mark.req("MILL-OV-SCOPE4", "MILL-DIAG-SCOPE-CH", "MILL-DIAG-SCOPE-TIME")
def test_the_scope_shows_four_channels_while_the_machine_moves(running: Page) -> None:
    page = running
    open_diagnostics(page, 3, "scope")
    for n, (source, scale, offset) in enumerate(
        [
            ("P12288", "1000", "0"), ("P12290", "500", "200"), ("P12291", "2", "-1"),
            ("P12288", "250", "-40"),
        ],
        1,
    ):  # fmt: skip
        fill(page, {
            f"Source of channel {n}": source, f"Scale of channel {n}, units/div": scale,
            f"Offset of channel {n}": offset,
        })  # fmt: skip
    heads = page.locator("#screen .scope-channel .hint")
    expect(heads).to_have_text(["source", "units/div", "offset"])
    fill(page, {"Sweep, ms/div": "50", "Sampling, ms": "5"})
    page.locator("#screen").get_by_role("button", name="START", exact=True).click()
    expect(page.locator("#screen .scope-chart .u-series")).to_have_count(5)
    state = page.locator("#screen .hint[role=status]")
    expect(state).to_have_text(re.compile(r"^[1-9]\d* samples$"))
    first = str(state.text_content())
    expect(state).not_to_have_text(first)  # it goes on
    shown = page.evaluate(
        "() => import('/js/scope/screen.js').then((module) => module.shown.value)"
    )
    assert shown["x"] == [0, 500]  # ten divisions of 50 ms
    assert shown["y"] == [-5, 5]
    assert len(shown["channels"]) == 4
    one, _, _, other = shown["channels"]  # the same parameter with two scales and offsets
    assert [value * 250.0 - 40.0 for value in other] == pytest.approx(
        [value * 1000.0 for value in one]
    )
    times = shown["times"]
    assert all(abs(t - 5.0 * k) < 1e-6 for k, t in enumerate(times))
    assert len(times) <= 100  # 500 ms at 5 ms
    page.get_by_label("Offset of channel 2", exact=True).fill("0")
    page.get_by_role("button", name="STOP SCOPE").click()
    expect(state).to_have_text(re.compile(r"^Stopped at \d+ samples$"))
    fill(page, {"Sweep, ms/div": "0"})
    page.locator("#screen").get_by_role("button", name="START", exact=True).click()
    expect(page.locator("#prompt")).to_have_text("⚠ Sweep and sampling are times above 0 ms")


@pytest.mark.req("MILL-DIAG-SCOPE-INDEX")
def test_the_scope_runs_an_index_profile_and_records_it_from_its_start(
    page: Page, served: Served
) -> None:
    at_rest(page, served)
    open_diagnostics(page, 3, "scope")
    fill(page, {
        "Source of channel 1": "P12290", "Source of channel 2": "", "Source of channel 3": "",
        "Source of channel 4": "", "Scale of channel 1, units/div": "1000",
        "Sweep, ms/div": "100", "Sampling, ms": "10",
        "Index profile": "ACC 500\nDEC 500\nSTP 500\nJRK 0\nF600\nRES X\nX5",
    })  # fmt: skip
    before = served.call(lambda station: station.link.machine.runner.stream.host.position()[0])
    page.get_by_role("button", name="INDEX", exact=True).click()
    dialog = page.get_by_role("dialog", name="INDEX")
    expect(dialog.locator("p")).to_have_text("The axis moves now: X5. Is its path free?")
    dialog.get_by_role("button", name="INDEX").click()
    state = page.locator("#screen .hint[role=status]")
    expect(state).to_have_text(re.compile(r"^\d{3,} samples$"))  # 1 s and more
    at_rest(page, served)
    after = served.call(lambda station: station.link.machine.runner.stream.host.position()[0])
    assert after - before == pytest.approx(5.0, abs=1e-6)
    values = page.evaluate(
        "() => import('/js/scope/screen.js').then((module) => module.shown.value.channels[0])"
    )
    assert len(values) == 100  # ten divisions of 100 ms, from the start
    scale = served.call(
        lambda station: station.link.machine.runner.settings.named("X").pulses_per_unit
    )
    # Friction holds the axis some counts beside its setpoint, at both ends.
    assert (values[-1] - values[0]) * 1000.0 == pytest.approx(5.0 * scale, abs=10.0)
    page.get_by_role("button", name="AUTOSCALE").click()
    size = page.get_by_label("Scale of channel 1, units/div", exact=True).input_value()
    assert float(size) * 8 >= 5.0 * scale
    page.get_by_role("button", name="STOP SCOPE").click()


# --- gains ----------------------------------------------------------------------------


@pytest.mark.req("MILL-OV-TUNEHERE", "MILL-DIAG-GAIN", "MILL-DIAG-GAIN-ENTER")
def test_gains_reach_the_running_card_at_enter_and_are_stored(
    running: Page, served: Served
) -> None:
    page, store = running, served.panel.installation.store
    axes = [a["name"] for a in page.evaluate(
        "() => import('/js/core/app.js').then(({ model }) => model.axes)")]  # fmt: skip
    kept, entered = {}, {}
    open_diagnostics(page, 4, "gain")
    expect(page.locator("#screen [role=radio]")).to_have_text(axes)
    for axis in range(len(axes)):
        page.locator("#screen [role=radio]").nth(axis).click()
        for gain, name, value, offset in (
            (0, "P Gain", round(0.003 + axis / 1e4, 9), 16),
            (1, "I Gain", round(0.002 + axis / 1e4, 9), 17),
        ):
            cell = 150_000 + 1000 * axis + gain
            number = 12288 + 256 * axis + offset

            def on_card(number: int = number) -> float:
                return float(served.call(lambda station: station.link.machine.card.read(number)))

            before, kept[cell] = on_card(), store.read(cell)
            field = page.locator(f"#gain-{cell}")
            field.fill(str(value))
            field.press("Tab")
            assert on_card() == before  # typed, not entered
            field.press("Enter")
            expect(page.locator("#prompt")).to_have_text(
                f"{name} is {value}; it is stored once the machine rests"
            )
            assert on_card() == pytest.approx(value, rel=1e-6)
            assert store.read(cell) == kept[cell]
            entered[cell] = value
    assert served.call(lambda station: station.link.machine.runner.is_busy)
    give(page, "stop.all")
    at_rest(page, served)
    until(page, lambda: {cell: store.read(cell) for cell in entered} == entered)
    page.locator("#screen [role=radio]").first.click()
    page.locator("#gain-150000").fill("999999")
    page.locator("#gain-150000").press("Enter")
    expect(page.locator("#prompt")).to_contain_text("cannot be 999999: a number from 0 to 10")
    assert store.read(150_000) == 0.003
    field = page.locator("#gain-150000")
    for text in ("high", ""):  # no number, and no 0 either
        field.fill(text)
        field.press("Enter")
        expect(page.locator("#prompt")).to_contain_text("P Gain: Not a number")
        assert store.read(150_000) == 0.003
        page.locator("#screen [role=radio]").first.click()
        expect(field).to_have_value("0.003")
    field.fill("0.0025")
    field.press("Enter")
    expect(page.locator("#prompt")).to_have_text("P Gain is 0.0025")
    assert store.read(150_000) == 0.0025


# --- lists ----------------------------------------------------------------------------


@pytest.mark.req("MILL-DIAG-PARAMS")
def test_board_parameters_lists_every_parameter_with_its_value(page: Page, served: Served) -> None:
    known = {f"P{p.number}": p.name for p in parameters().values()}
    open_diagnostics(page, 5, "board")
    place = page.locator("#screen .screen-head button", has_text=" of ")
    total = len(known)
    listed: dict[str, str] = {}
    numbers = list(known)
    marked = {
        1: 0.1,
        40: -3.0,
        59: 1234567891.0,
    }  # variables of the first page, which nothing changes
    for number, value in marked.items():
        served.call(partial(_command, line=f"P{number}={value}"))
    for first in (0, 60, (total - 1) // 60 * 60):
        expect(place).to_have_text(f"{first + 1}\u2013{min(total, first + 60)} of {total}")
        expect(page.locator("#screen tbody strong").first).not_to_have_text("\u2013")
        rows = page.evaluate(LISTED)
        assert [number for number, _, _ in rows] == numbers[first : first + 60]
        listed.update({number: name for number, name, _ in rows})
        if first == 0:
            for number, value in marked.items():
                shown = page.locator("#screen tbody strong").nth(numbers.index(f"P{number}"))
                expect(shown).to_have_text(f"{value:.12g}")
            served.call(partial(_command, line="P40=7"))
            shown = page.locator("#screen tbody strong").nth(numbers.index("P40"))
            expect(shown).to_have_text("7")
            page.get_by_role("button", name="NEXT", exact=True).click()
        elif first == 60:
            place.click()
            page.locator("dialog .pad-value").fill(str(total))
            page.keyboard.press("Enter")
    assert listed == {number: known[number] for number in listed}
    page.get_by_label("Name or number").fill("P12288")
    expect(place).to_have_text("1\u20131 of 1")
    shown = page.locator("#screen tbody strong")
    place_x = served.call(lambda station: station.link.machine.card.read(12288))
    expect(shown).to_have_text(str(int(place_x)))
    page.get_by_label("Name or number").fill("P12304")  # the gain P of axis 0
    gain = served.call(lambda station: station.link.machine.card.read(12304))
    expect(shown).to_have_text(f"{gain:.6g}")
    assert 0.0 < gain < 1.0


ANOTHER_LOAD = """() => import('/js/core/app.js').then(({ link }) => {
  const { command } = link;
  link.command = (name, args) => args?.line === 'CPU'
    ? Promise.resolve({ lines: ['Foreground 12.3%', 'Background 87.7%'] }) : command.call(link, name, args);
})"""  # noqa: E501
AS_IT_IS = "() => import('/js/core/app.js').then(({ link }) => { delete link.command; })"


@pytest.mark.req("MILL-DIAG-CPU")
def test_cpu_load_is_shown_in_per_cent_also_while_a_program_runs(
    running: Page, served: Served
) -> None:
    page = running
    lines = served.call(lambda station: station.link.machine.card.command("CPU"))
    open_diagnostics(page, 7, "cpu")
    shares = page.locator("#screen .cpu-row strong")
    expect(shares).to_have_text([line.split()[1].replace("%", " %") for line in lines])
    assert page.locator("#prompt").get_attribute("data-kind") != "error"
    meters = page.locator("#screen meter").evaluate_all("(all) => all.map((each) => each.value)")
    assert sum(meters) == pytest.approx(100.0)
    page.evaluate(ANOTHER_LOAD)
    expect(shares).to_have_text(["12.3 %", "87.7 %"])  # it is asked for again
    meters = page.locator("#screen meter").evaluate_all("(all) => all.map((each) => each.value)")
    assert meters == [12.3, 87.7]
    page.evaluate(AS_IT_IS)


@pytest.mark.req("MILL-DIAG-FSTAT")
def test_fast_status_shows_the_copies_of_the_card(page: Page, served: Served) -> None:
    at_rest(page, served)
    for line in ("FSTAT CLEAR", "FSTAT PERIOD 20", "FSTAT 0 (48,0,0)", "FSTAT ON"):
        served.call(partial(_command, line=line))
    rows = [p for p in parameters().values() if p.object == "FSTAT"]
    open_diagnostics(page, 8, "fast")
    live = page.locator("#screen .live")
    expect(live).to_have_count(len(rows))
    numbers = page.locator("#screen td.quiet").all_inner_texts()
    assert numbers == [f"P{p.number}" for p in rows]
    period = page.locator("#screen tr", has_text="FSTAT Period").locator(".live")
    expect(period).to_have_text("20")


@pytest.mark.req("MILL-DIAG-MEM", "MILL-DIAG-MEM-GUARD")
def test_the_memory_is_divided_with_a_warning_and_not_while_a_program_runs(
    page: Page, served: Served
) -> None:
    at_rest(page, served)
    served.call(lambda station: station.link.machine.card.command("10 PRINT 1", program=1))
    open_diagnostics(page, 9, "memory")
    expect(page.locator("#screen .memory-row")).to_have_count(24)
    labels = page.locator("#screen .memory-row label").all_inner_texts()
    assert labels == [f"PROG{n}" for n in range(16)] + [f"PLC{n}" for n in range(8)]
    field = page.locator("#memory-PROG1")
    expect(field).to_have_value("65536")
    expect(page.locator("#memory-PLC0")).to_have_value("0")
    field.fill("many")
    page.get_by_role("button", name="SAVE AND CLEAR THE CARD").click()
    expect(page.locator("#prompt")).to_have_text("⚠ PROG1: a whole number of bytes")
    field.fill("16384")
    page.locator("#memory-PLC0").fill("2048")
    give(page, "mdi.execute", line="G21 G91 G1 X30 F10")
    until_model(page, "model.state.value.state === 'RUN'")
    dialog = page.get_by_role("dialog", name="Memory configuration")
    save = page.get_by_role("button", name="SAVE AND CLEAR THE CARD")
    save.click()
    expect(dialog.locator("p")).to_have_text(
        "All programs, PLC programs and variables that are stored on the card are lost."
        " The machine is set up again."
    )
    dialog.get_by_role("button", name="SAVE AND CLEAR THE CARD").click()
    expect(page.locator("#prompt")).to_have_text(
        "⚠ the machine moves: the memory is shown and changed at rest only"
    )
    give(page, "stop.all")
    at_rest(page, served)
    program = lambda station: station.link.machine.card.command("LIST", program=1)  # noqa: E731
    assert served.call(program) == ["10 PRINT 1"]
    save.click()
    dialog.get_by_role("button", name="SAVE AND CLEAR THE CARD").click()
    expect(page.locator("#prompt")).to_have_text("The memory of the card is divided anew")
    expect(field).to_have_value("16384")
    expect(page.locator("#memory-PLC0")).to_have_value("2048")
    assert served.call(program) == []
    lines = served.call(_dimensions)
    assert {"DIM PROG1(16384)", "DIM PLC0(2048)"} <= set(lines)


def _dimensions(station: Station) -> list[str]:
    station.link.machine.card.go(Level())
    return station.link.machine.card.command("DIM")


def _switch(station: Station, *, bit: int, on: bool) -> None:
    station.link.machine.card.write_bit(bit, on)


def _command(station: Station, *, line: str) -> None:
    station.link.machine.card.command(line)
