"""The timeline of the workspace: dragged back, on as another branch, STOP while time is still."""

import re
from collections.abc import Iterator

import pytest
from playwright.sync_api import BrowserContext, FloatRect, Locator, Page, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import open_page, until_model

from openacr.panel.control.station import Station


def prepare(station: Station) -> None:
    """Program 5 counts in P0."""
    for line in ("10 P0=P0+1", "20 DWL 0.01", "30 GOTO 10", "RUN"):
        station.link.machine.card.command(line, program=5)


def lived(station: Station) -> int:
    return station.times.history.lived_tk


def counted(station: Station) -> float:
    return station.times.history.read_rows([0])[0]


def is_still(station: Station) -> bool:
    return station.link.is_still


@pytest.fixture(scope="module")
def page(context: BrowserContext, served: Served) -> Iterator[Page]:
    """The workspace with the pane, on a card that counts."""
    served.call(prepare)
    page = open_page(context, f"{served.url}/bench")
    until_model(page, "model.hello.value.client")
    page.get_by_role("button", name="PANES").click()
    page.get_by_role("dialog").get_by_role("button", name="Timeline", exact=True).click()
    expect(page.get_by_role("slider", name="Moment")).to_be_visible()
    yield page


def complaints_of(page: Page) -> list[str]:
    """What the browser complained about, but for refusals, also those of a busy computer (503)."""
    found: list[str] = page.complaints  # type: ignore[attr-defined]
    return [each for each in found if "422" not in each and "503" not in each]


BACK_TK = 2000  # to where the moment is dragged: before STOP, which also holds the program


def test_stop_ends_a_pause(page: Page, served: Served) -> None:
    until_model(page, f"model.moment.value.last > {BACK_TK + 500}")
    pane(page).get_by_role("button", name="PAUSE", exact=True).click()
    run = page.locator("[data-pane=timeline]").get_by_role("button", name="RUN", exact=True)
    expect(run).to_be_visible()
    tick = served.call(lived)
    page.locator(".stop-key").click()
    expect(
        page.locator("[data-pane=timeline]").get_by_role("button", name="PAUSE", exact=True)
    ).to_be_visible()
    until_model(page, f"model.moment.value.last > {tick + 1000}")
    assert not served.call(is_still)


def test_the_moment_is_dragged_back_and_the_machine_operated_from_there_on_another_branch(
    page: Page, served: Served
) -> None:
    slider = page.get_by_role("slider", name="Moment")
    before = served.call(counted)
    slider.evaluate(
        "(slider, tick) => { slider.value = tick; slider.dispatchEvent(new Event('input')); }",
        BACK_TK,
    )
    until_model(page, "model.timeline.value.away && model.timeline.value.still")
    until_model(page, f"model.moment.value.tick === {BACK_TK}")
    expect(slider).to_have_value(str(BACK_TK))
    assert served.call(lived) == BACK_TK
    assert served.call(counted) < before
    slider.focus()
    page.keyboard.press("ArrowLeft")
    until_model(page, f"model.moment.value.tick === {BACK_TK - 1}")
    page.get_by_role("button", name="OPERATE FROM HERE").click()
    until_model(page, "!model.timeline.value.away && model.timeline.value.branches.length === 2")
    expect(page.locator("[data-branch='1'] strong")).to_contain_text("branch 1")
    expect(page.locator("#state")).to_contain_text("CARD RUNS")
    assert complaints_of(page) == []


def pane(page: Page) -> Locator:
    return page.locator("[data-pane=timeline]")


def moment(page: Page) -> int:
    found: int = page.evaluate(
        "import('/js/core/app.js').then(({ model }) => model.moment.value.tick)"
    )
    return found


def go_to(page: Page, text: str) -> None:
    field = pane(page).get_by_label("Time, s")
    field.fill(text)
    field.press("Enter")


def test_a_typed_time_is_shown_and_keys_go_by_seconds(page: Page, served: Served) -> None:
    period_s = served.call(lambda station: station.times.history.period_s)
    until_model(page, f"model.moment.value.last > {round(3.6 / period_s)}")
    go_to(page, "2,5")
    until_model(page, f"model.moment.value.tick === {round(2.5 / period_s)}")
    assert served.call(lived) == round(2.5 / period_s)
    for name, seconds in (("+1 s", 3.5), ("\u22121 s", 2.5), ("\u221220 s", 0.0)):
        pane(page).get_by_role("button", name=name).click()
        first = served.call(lambda station: station.times.history.timeline.branch.first.tick)
        tick = max(first, round(seconds / period_s))
        until_model(page, f"model.moment.value.tick === {tick}")
    pane(page).get_by_role("button", name="+20 s").click()
    until_model(page, "model.moment.value.tick === model.moment.value.last")


def test_a_time_that_is_not_known_is_refused_with_those_that_are(page: Page) -> None:
    before = moment(page)
    prompt = page.locator("#prompt")
    go_to(page, "99999")
    expect(prompt).to_have_text(
        re.compile(r"99999\.0000 s is not known on this branch: from [\d.]+ to [\d.]+ s are")
    )
    go_to(page, "soon")
    expect(prompt).to_contain_text("soon is no time: 885.8 or 14:45.8")
    assert moment(page) == before


def test_a_step_is_a_tick_or_a_line_of_a_program(page: Page, served: Served) -> None:
    go_to(page, "2")
    tick = served.call(lambda station: round(2.0 / station.times.history.period_s))
    until_model(page, f"model.moment.value.tick === {tick}")
    step = pane(page).get_by_role("button", name="STEP")
    what = pane(page).get_by_label("What a step is")
    step.click()
    until_model(page, f"model.moment.value.tick === {tick + 1}")
    what.select_option("back")
    step.click()
    until_model(page, f"model.moment.value.tick === {tick}")
    what.select_option("line")
    pane(page).get_by_label("Number of the program or master").fill("6")
    step.click()
    expect(page.locator("#prompt")).to_contain_text("PROG6 does not run")
    pane(page).get_by_label("Number of the program or master").fill("5")
    count = served.call(counted)
    for _ in range(3):  # once round
        now = served.call(lambda station: station.times.history.timeline.now)
        step.click()
        shown = (
            f"model.moment.value.tick === {now.tick} && model.moment.value.within === {now.within}"
        )
        until_model(page, f"!({shown})")
    assert served.call(counted) == count + 1
    what.select_option("tick")


def test_a_bookmark_is_a_tick_on_the_ruler_and_leads_to_its_moment(
    page: Page, served: Served
) -> None:
    go_to(page, "1.5")
    tick = served.call(lambda station: round(1.5 / station.times.history.period_s))
    until_model(page, f"model.moment.value.tick === {tick}")
    pane(page).get_by_label("Text of a bookmark").fill("before the cut")
    pane(page).get_by_role("button", name="MARK", exact=True).click()
    key = pane(page).get_by_role("button", name="before the cut")
    expect(key).to_have_count(1)  # the tick on the ruler is too small for a key
    for each in (pane(page).get_by_title("before the cut"), key):
        go_to(page, "2")
        until_model(page, f"model.moment.value.tick !== {tick}")
        each.click()
        until_model(page, f"model.moment.value.tick === {tick}")
    assert served.call(lived) == tick


def lane(page: Page, name: str) -> Locator:
    return pane(page).locator(f"[data-lane='{name}']")


def test_programs_have_lanes_a_click_goes_to_its_moment_and_the_wheel_zooms(page: Page) -> None:
    expect(lane(page, "program 5")).to_have_attribute("data-spans", re.compile("[1-9]"))
    slider = pane(page).get_by_role("slider", name="Moment")
    ruler = pane(page).locator(".time-ruler")
    ruler.scroll_into_view_if_needed()
    box = ruler.bounding_box()
    assert box is not None
    whole = [int(slider.get_attribute(name) or 0) for name in ("min", "max")]
    x, y = box["x"] + 0.25 * box["width"], box["y"] + 4.0
    page.mouse.click(x, y)
    expected = whole[0] + 0.25 * (whole[1] - whole[0])
    near = 2.0 * (whole[1] - whole[0]) / box["width"]
    until_model(page, f"Math.abs(model.moment.value.tick - {expected}) < {near}")
    page.mouse.wheel(0, -100)
    part = round((whole[1] - whole[0]) / 1.6)
    expect(slider).not_to_have_attribute("max", str(whole[1]))
    low, high = (int(slider.get_attribute(name) or 0) for name in ("min", "max"))
    assert abs(high - low - part) <= 1
    assert abs(low + 0.25 * part - expected) <= near  # what is below the pointer stays
    pane(page).get_by_role("button", name="ALL", exact=True).click()
    expect(slider).to_have_attribute("max", str(whole[1]))


def shown_part(page: Page) -> tuple[int, int]:
    slider = pane(page).get_by_role("slider", name="Moment")
    low, high = (int(slider.get_attribute(name) or 0) for name in ("min", "max"))
    return low, high


def ruler_box(page: Page) -> FloatRect:
    ruler = pane(page).locator(".time-ruler")
    ruler.scroll_into_view_if_needed()
    box = ruler.bounding_box()
    assert box is not None
    return box


def test_dragging_selects_a_span_with_its_sums_and_zooms_to_it(page: Page, served: Served) -> None:
    (first, last), box, before = shown_part(page), ruler_box(page), moment(page)
    y = box["y"] + 4.0
    page.mouse.move(box["x"] + 0.5 * box["width"], y)
    page.mouse.down()
    page.mouse.move(box["x"] + 0.4 * box["width"], y)
    page.mouse.move(box["x"] + 0.3 * box["width"], y)
    page.mouse.up()
    sums = pane(page).locator(".time-sums")
    row = sums.locator("[data-sum='program 5'] td")
    expect(row.first).to_have_text("PROG5")
    assert moment(page) == before  # a drag is no click
    text = sums.locator(".time-length").inner_text()
    found = re.fullmatch(r"Selected: ([\d.]+) s, from ([\d.]+) to ([\d.]+) s", text)
    assert found is not None, text
    length_s, from_s, to_s = map(float, found.groups())
    period_s = served.call(lambda station: station.times.history.period_s)
    near_s = 3.0 * (last - first) / box["width"] * period_s
    for got, part in ((from_s, 0.3), (to_s, 0.5)):
        assert abs(got - (first + part * (last - first)) * period_s) <= near_s
    assert abs(length_s - (to_s - from_s)) <= 2 * period_s
    expect(row.nth(1)).to_have_text(f"{length_s:.4f}")  # it runs all the time
    expect(row.nth(2)).to_have_text("100.0")
    expect(row.nth(4)).to_contain_text("lines")  # of at most 20 s
    pane(page).get_by_role("button", name="ZOOM TO SELECTION").click()
    low, high = (round(each / period_s) for each in (from_s, to_s))
    slider = pane(page).get_by_role("slider", name="Moment")
    expect(slider).to_have_attribute("min", str(low))
    expect(slider).to_have_attribute("max", str(high))
    pane(page).get_by_label("Parameters to compare").fill("")
    pane(page).get_by_label("Parameters to compare").fill("P0")
    pane(page).get_by_role("button", name="CURVES").click()
    expect(page.locator(".time-chart [data-parameter=P0]")).to_have_count(1)
    pane(page).get_by_role("button", name="CLEAR SELECTION").click()
    expect(sums).to_be_hidden()


def test_keys_zoom_and_move_along_only_while_the_focus_is_in_the_pane(page: Page) -> None:
    pane(page).get_by_role("button", name="ALL", exact=True).click()
    whole = shown_part(page)
    slider = pane(page).get_by_role("slider", name="Moment")
    page.mouse.move(0, 0)  # not over the lanes: the present moment stays where it is
    pane(page).get_by_label("Lanes", exact=True).focus()
    page.keyboard.press("w")
    expect(slider).not_to_have_attribute("max", str(whole[1]))
    low, high = shown_part(page)
    assert abs((high - low) - (whole[1] - whole[0]) / 1.6) <= 2
    page.keyboard.press("d")
    page.keyboard.press("a")
    page.keyboard.press("s")
    expect(slider).to_have_attribute("max", str(whole[1]))
    page.keyboard.press("w")
    expect(slider).not_to_have_attribute("max", str(whole[1]))
    zoomed = shown_part(page)
    field = pane(page).get_by_label("Filter the lanes")
    field.press_sequentially("sawd")  # letters of a text
    page.locator("#prompt").click()
    page.keyboard.press("s")
    assert shown_part(page) == zoomed
    expect(lane(page, "program 5")).to_have_count(0)  # filtered
    field.fill("prog5")
    expect(lane(page, "program 5")).to_have_count(1)
    field.fill("")


def test_lanes_are_pinned_and_groups_fold(page: Page) -> None:
    name = lane(page, "program 5")
    name.click()
    expect(name).to_have_attribute("aria-pressed", "true")
    pinned = pane(page).get_by_role("button", name=re.compile("Pinned"))
    expect(pinned).to_have_attribute("aria-expanded", "true")
    pinned.click()
    expect(name).to_have_count(0)
    pinned.click()
    name.click()
    expect(pinned).to_have_count(0)
    expect(name).to_have_attribute("aria-pressed", "false")


def test_the_next_change_of_a_flag_and_the_previous_line_are_gone_to(
    page: Page, served: Served
) -> None:
    period_s = served.call(lambda station: station.times.history.period_s)
    go_to(page, "2")
    until_model(page, f"model.moment.value.tick === {round(2.0 / period_s)}")
    pane(page).get_by_label("What is looked for").select_option("line")
    pane(page).get_by_label("Program", exact=True).fill("5")
    pane(page).get_by_label("Line", exact=True).fill("10")
    count = served.call(counted)
    before = moment(page)
    pane(page).get_by_role("button", name="NEXT").click()
    until_model(page, f"model.moment.value.tick > {before}")
    assert served.call(counted) == count + 1
    there = moment(page)
    assert (there - before) * period_s < 0.02
    pane(page).get_by_role("button", name="PREVIOUS").click()
    until_model(page, f"model.moment.value.tick < {there}")
    assert served.call(counted) == count
    pane(page).get_by_label("What is looked for").select_option("flag")
    pane(page).get_by_label("BIT516 or its name").fill("P0")
    pane(page).get_by_role("button", name="NEXT").click()
    expect(page.locator("#prompt")).to_contain_text("P0 is no flag: write BIT516 or its name")
    page.complaints.clear()  # type: ignore[attr-defined]  # the browser names the refusal


def test_another_branch_is_drawn_below_and_one_click_changes_to_it(page: Page) -> None:
    present: int = page.evaluate(
        "import('/js/core/app.js').then(({ model }) => model.timeline.value.branch)"
    )
    other = 1 - present
    key = pane(page).get_by_role("button", name=re.compile("below those of this branch"))
    key.click()
    expect(key).to_have_attribute("aria-pressed", "true")
    key.click()
    expect(key).to_have_attribute("aria-pressed", "false")
    for number in (other, present):
        pane(page).locator(f"[data-name='to {number}']").click()
        until_model(page, f"model.timeline.value.branch === {number}")
    go_to(page, "2")
    until_model(page, "model.moment.value.tick < model.moment.value.last")
    assert complaints_of(page) == []


def test_a_new_branch_here_keeps_what_followed_on_its_own(page: Page, served: Served) -> None:
    before = served.call(lambda station: station.times.history.timeline.branch.number)
    pane(page).get_by_role("button", name="NEW BRANCH HERE").click()
    until_model(page, "model.timeline.value.branches.length === 3")
    expect(pane(page).locator("[data-branch='2'] strong")).to_contain_text("branch 2")
    expect(pane(page).get_by_role("button", name="NEW BRANCH HERE")).to_be_disabled()
    row = pane(page).locator(f"[data-branch='{before}']")
    row.get_by_role("button", name="CHANGE TO").click()
    until_model(page, f"model.timeline.value.branch === {before}")
    pane(page).locator("[data-branch='2']").get_by_role("button", name="FORGET").click()
    expect(pane(page).locator("[data-branch='2']")).to_have_count(0)
    assert complaints_of(page) == []


def test_one_key_goes_to_the_first_difference_of_two_branches(page: Page, served: Served) -> None:
    def differ(station: Station) -> int:
        """A branch that sets an output in the past, with some time after it."""
        history = station.times.history
        tick = history.timeline.branch.last.tick - 500
        station.times.seek(tick)
        station.times.write(40, 1.0, is_flag=True)
        history.timeline.advance(400)
        return tick

    tick = served.call(differ)
    until_model(page, "model.timeline.value.branches.length === 3")
    others = served.call(
        lambda station: [at.number for at in station.times.history.timeline.branches]
    )
    present, before = others[-1], others[-2]
    lane = pane(page).locator(f"[data-lane='branch {before}']")
    lane.get_by_role("button", name="Go to the first difference").click()
    row = pane(page).locator("[data-difference='output']")
    expect(row).to_contain_text("output OUT 40")
    expect(row.locator("td.number")).to_have_text([re.compile(r"\d"), "1", "0"])
    until_model(page, f"Math.abs(model.moment.value.tick - {tick}) <= 1")
    expect(lane.get_by_role("button", name="below those of this")).to_have_attribute(
        "aria-pressed", "true"
    )
    go_to(page, "2")
    pane(page).locator(".time-lanes").focus()
    page.keyboard.press("f")  # from the branch that is compared
    until_model(page, f"Math.abs(model.moment.value.tick - {tick}) <= 1")
    pane(page).locator(f"[data-name='to {before}']").click()
    expect(pane(page).locator(".time-first")).to_be_hidden()
    pane(page).locator(f"[data-branch='{present}']").get_by_role("button", name="FORGET").click()
    expect(pane(page).locator(f"[data-branch='{present}']")).to_have_count(0)
    go_to(page, "2")
    until_model(page, "model.moment.value.tick < model.moment.value.last")
    assert complaints_of(page) == []


def compare(page: Page, parameters: str) -> None:
    page.get_by_label("Parameters to compare").fill(parameters)
    page.get_by_role("button", name="COMPARE").click()


def test_every_parameter_is_compared_on_a_scale_of_its_own(page: Page) -> None:
    compare(page, "P0, BIT81; system.global system clock")
    charts = page.locator(".time-chart[data-parameters='3'] [data-parameter]")
    expect(charts).to_have_count(3)
    names = charts.evaluate_all("(all) => all.map((each) => each.dataset.parameter)")
    assert names == ["P0", "BIT81", "P6916"]
    expect(charts.first).to_contain_text("branch 1")
    expect(charts.first).to_contain_text("first")
    expect(page.locator(".time-found [data-count]")).to_contain_text("differ")
    pane = page.locator("[data-pane=timeline] .scroll").first
    wide = page.evaluate("""() => [...document.querySelectorAll('[data-pane=timeline] .scroll, .time-chart, .time-legend')]
      .filter((each) => each.scrollWidth > each.clientWidth + 1).map((each) => each.className)""")  # noqa: E501
    assert wide == []
    expect(pane).to_be_visible()


def test_a_comparison_that_is_refused_says_why_in_the_pane(page: Page) -> None:
    refused = page.locator(".time-found [role=alert]")
    for parameters, why in (
        ("P0, nonsense", "no parameter and no flag is named 'nonsense'"),
        (",".join(f"P{n}" for n in range(9)), "9 parameters: 1 to 8 are sampled"),
    ):
        compare(page, parameters)
        expect(refused).to_have_text(why)
        expect(page.locator(".time-chart canvas")).to_have_count(0)
    compare(page, "P0")
    expect(refused).to_have_count(0)
    page.complaints.clear()  # type: ignore[attr-defined]  # the browser names the refusals


def test_labels_of_an_axis_have_room_and_a_curve_that_is_constant_a_height(page: Page) -> None:
    found = page.evaluate("""() => import('/js/bench/charts.js').then((m) => [
      m.axisSize(['100000', '0']) - m.axisSize(['0', '1']), m.axisSize(null), m.valueText(-75000),
      m.valueText(null), m.endsOf([[1, 1], [1]]), m.endsOf([[0, 100], [-100]]), m.endsOf([[NaN], []]),
    ])""")  # noqa: E501
    assert found == [37, 18, "\u221275000", "\u2013", [0.5, 1.5], [-116, 116], [0, 1]]


def cut(station: Station) -> None:
    """Have a part program be under way on the branch that is shown."""
    lines = ["G1 X4 F120", "G1 Y4", "G1 X0", "M2"]
    file = station.installation.programs / "slow.nc"
    file.write_text("\n".join(lines) + "\n")


def test_a_part_program_that_was_under_way_is_offered_to_start_at_its_line(
    page: Page, served: Served
) -> None:
    served.call(cut)
    go_to(page, "2")
    pane(page).get_by_role("button", name="OPERATE FROM HERE").click()
    until_model(page, "!model.timeline.value.away")
    expect(page.locator("dialog[open]")).to_have_count(0)  # nothing was cut there
    give = "import('/js/core/app.js').then(({{ give }}) => give({}))"
    page.evaluate(give.format("'program.load', { path: 'slow.nc' }"))
    page.evaluate(give.format("'run.begin'"))
    until_model(page, "model.program.value.line === 1")
    tick = served.call(lived)
    until_model(page, f"model.moment.value.last > {tick + 2000}")
    page.evaluate(give.format("'stop.all'"))
    until_model(page, "!model.state.value.busy")
    page.evaluate(give.format(f"'timeline.seek', {{ tick: {tick + 100} }}"))
    until_model(page, "model.moment.value.block?.line === 1")
    pane(page).get_by_role("button", name="OPERATE FROM HERE").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text("slow.nc was at line 1")
    dialog.get_by_role("button", name="START AT LINE 1").click()
    expect(dialog.get_by_label("Start line")).to_have_value("1")
    dialog.get_by_role("button", name="CANCEL").click()
    expect(dialog).to_have_count(0)
    assert complaints_of(page) == []
