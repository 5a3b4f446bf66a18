"""Files come to the part folder by hand; GRAPHICS draws the path or the stock of the loaded one."""

import re
from pathlib import Path

import pytest
from playwright.sync_api import Page, Route, expect
from tests.panel.bench import Served
from tests.panel.browser.conftest import let_through, load_file, picture, to_main_menu, until

DROP = """([name, text]) => {
  const data = new DataTransfer();
  data.items.add(new File([text], name));
  const list = document.querySelector('.file-list');
  for (const kind of ['dragover', 'drop'])
    list.dispatchEvent(new DragEvent(kind, { dataTransfer: data, cancelable: true }));
}"""
# A place on the mark of the chosen line, in pixels of the window.
MARKED = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=over]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  const found = [];
  for (let n = 0; n < data.length / 4; n++) if (data[4 * n + 3] > 250) found.push(n);
  if (!found.length) return null;
  const middle = found[found.length >> 1];
  const [box, ratio] = [canvas.getBoundingClientRect(), canvas.width / canvas.clientWidth];
  const [x, y] = [middle % canvas.width, Math.floor(middle / canvas.width)];
  return [box.x + x / ratio, box.y + y / ratio];
}"""
CHOSEN = "() => import('/js/draw/path.js').then((path) => path.chosenLine.value)"
CHOOSE = "(line) => import('/js/draw/path.js').then((path) => path.chosenLine.set(line))"
LINES = (
    "() => import('/js/draw/path.js').then((path) => path.path.value && [...path.path.value.lines])"
)


def path_lines(page: Page, more_than: int = 0) -> list[int]:
    """The lines of the path that is shown, once it is computed and has that many points."""
    until(page, lambda: len(page.evaluate(LINES) or []) > more_than)
    return list(page.evaluate(LINES))


def load_screen(page: Page) -> None:
    page.keyboard.press("F5")
    page.keyboard.press("F3")
    page.get_by_role("option", name="plate.nc").wait_for()


def test_a_chosen_file_is_uploaded_to_the_part_folder(
    page: Page, served: Served, tmp_path: Path
) -> None:
    load_screen(page)
    (tmp_path / "sent.nc").write_bytes(b"G0 X1\r\nM2\r\n")
    page.locator(".file-list input[type=file]").set_input_files(tmp_path / "sent.nc")
    page.get_by_role("option", name="sent.nc").wait_for()
    expect(page.locator("#prompt")).to_have_text("sent.nc is uploaded")
    assert (served.programs / "sent.nc").read_bytes() == b"G0 X1\r\nM2\r\n"


def test_the_text_beside_the_list_is_that_of_the_chosen_file(page: Page, served: Served) -> None:
    """However late the text of the one before comes."""
    for name, text in (("EARLY.TXT", "G0 X1\n"), ("LATER.TXT", "G0 X2\n")):
        (served.programs / name).write_text(text)
    held: list[Route] = []
    page.route("**/programs/text?path=EARLY.TXT*", lambda route: held.append(route))
    load_screen(page)
    shown = page.get_by_role("region", name="Text of the file")
    with page.expect_request("**/programs/text?path=EARLY.TXT*"):
        page.get_by_role("option", name="EARLY.TXT").click()
    page.get_by_role("option", name="LATER.TXT").click()
    expect(shown).to_have_text("G0 X2")
    until(page, lambda: held)
    let_through(page, held[0])
    expect(shown).to_have_text("G0 X2")
    page.unroute_all()


def test_the_folder_that_was_chosen_last_is_shown(page: Page, served: Served) -> None:
    """However late the list of the one before comes."""
    for name in ("covers", "plugs"):
        (served.programs / name).mkdir()
        (served.programs / name / f"{name}.nc").write_text("M2\n")
    held: list[Route] = []
    covers = "**/api/programs?folder=covers"
    page.route(covers, lambda route: held.append(route))
    load_screen(page)
    files = page.get_by_role("listbox", name="Part programs").get_by_role("option")
    with page.expect_request(covers):
        files.filter(has_text="covers").click()
    files.filter(has_text="plugs").click()
    expect(files.filter(has_text="plugs.nc")).to_have_count(1)
    until(page, lambda: held)
    let_through(page, held[0])
    expect(files.filter(has_text="plugs.nc")).to_have_count(1)
    expect(page.locator(".file-list .mono")).to_have_text("/plugs")
    page.unroute(covers)


def test_a_file_dropped_on_the_list_is_uploaded_and_can_be_loaded(
    page: Page, served: Served
) -> None:
    load_screen(page)
    page.evaluate(DROP, ["dropped.nc", "G0 X2\nM2\n"])
    page.get_by_role("option", name="dropped.nc").click()
    expect(page.get_by_role("region", name="Text of the file")).to_have_text("G0 X2\nM2")
    page.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#alarms .none")).to_have_text("dropped.nc")
    expect(page.locator("#screen")).to_be_hidden()
    assert (served.programs / "dropped.nc").read_text() == "G0 X2\nM2\n"
    to_main_menu(page)
    load_screen(page)
    page.get_by_role("option", name="plate.nc").click()
    page.get_by_role("button", name="LOAD FILE").click()
    expect(page.locator("#alarms .none")).to_have_text("plate.nc")
    expect(page.locator("#screen")).to_be_hidden()


def test_a_click_in_the_plot_chooses_the_line_of_the_listing(page: Page) -> None:
    page.click("#display-tab-graphics")
    line = max(path_lines(page, 20))  # of plate.nc, not of the program before it
    page.evaluate(CHOOSE, line)
    x, y = page.wait_for_function(MARKED).json_value()
    page.evaluate(CHOOSE, 0)
    page.mouse.click(x, y)
    assert page.evaluate(CHOSEN) == line
    page.click("#display-tab-program")
    chosen = page.locator(".listing-row.is-chosen")
    expect(chosen).to_have_attribute("data-line", str(line))
    other = page.locator(f".listing-row[data-line='{line - 1}']")
    other.click()
    assert page.evaluate(CHOSEN) == line - 1
    expect(other).to_have_class("listing-row is-chosen")
    page.click("#display-tab-graphics")


@pytest.mark.parametrize("theme", ["dark", "light"])
def test_the_grid_has_the_colour_of_the_theme(page: Page, theme: str) -> None:
    page.emulate_media(color_scheme="light" if theme == "dark" else "dark")
    page.click("#display-tab-graphics")
    path_lines(page)
    page.emulate_media(color_scheme=theme)  # type: ignore[arg-type]
    wanted = {"dark": [30, 40, 50], "light": [225, 231, 236]}[theme]
    page.wait_for_function(
        """(wanted) => {
          const canvas = document.querySelector('#display .picture [data-layer=ground]');
          const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
          let count = 0;
          for (let n = 0; n < data.length; n += 4)
            if (data[n + 3] === 255 && wanted.every((each, k) => data[n + k] === each)) count++;
          return count > 500;
        }""",
        arg=wanted,
    )


# --- stock: what a program leaves of the blank, from above and from the side ---------------

# How many pixels of the picture of the material have a colour, how many are red, and a sum that no
# two pictures share.
PIXELS = """() => {
  const canvas = document.querySelector('#display .picture [data-layer=material]');
  const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
  let [shown, red, sum] = [0, 0, 0];
  for (let n = 0; n < data.length; n += 4) {
    if (data[n + 3]) shown += 1;
    sum = (31 * sum + data[n] + data[n + 3]) | 0;
    if (data[n] > 180 && data[n + 1] < 60 && data[n + 2] < 60) red += 1;
  }
  return { shown, red, sum, all: data.length / 4 };
}"""
BAD = "G21 F600\nG10 L12 P1 R4\nD1\nG0 X1 Y1 Z5\nX0 Y0\nG1 Z-6\nX60\nG0 Y40\nZ5\nM2\n"


def show_view(page: Page, name: str, holds: str) -> None:
    """Press the key of a view and wait until it is drawn and something holds of its pixels."""
    before = page.evaluate(PIXELS)["sum"]
    page.get_by_role("button", name=name, exact=True).click()
    page.wait_for_function(
        f"() => {{ const {{ shown, red, sum }} = ({PIXELS})();"
        f" return sum !== {before} && {holds}; }}"
    )


def test_the_stock_is_shown_instead_of_the_path_until_its_key_is_pressed_again(
    page: Page, pictures: Path
) -> None:
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    note = page.locator(".stock-note")
    key.click()
    expect(key).to_have_attribute("aria-pressed", "true")
    expect(note).to_have_text("No rapid in material, no cut below the blank")
    page.wait_for_function(  # once the path is there as well, it is fitted
        f"() => {{ const {{ shown, all }} = ({PIXELS})(); return shown > all / 10; }}"
    )
    assert page.evaluate(PIXELS)["red"] == 0
    for view in ("3D", "FRONT", "TOP"):
        show_view(page, view, "shown > 1000")
        picture(page, pictures / f"stock-{view.lower()}.png")
    expect(page.locator(".picture [data-layer=strokes]")).to_be_hidden()
    key.click()
    expect(key).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".picture [data-layer=material]")).to_be_hidden()
    expect(page.locator(".picture [data-layer=strokes]")).to_be_visible()
    expect(note).to_have_text("")


def test_a_rapid_in_material_is_red_and_its_line_is_named(
    page: Page, served: Served, pictures: Path
) -> None:
    (served.programs / "bad.nc").write_text(BAD)
    load_file(page, "bad.nc")
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    key.click()
    note = page.locator(".stock-note")
    expect(note).to_have_text(re.compile("Rapid in material: line 8"))
    page.wait_for_function(f"() => ({PIXELS})().red > 10")
    show_view(page, "3D", "red > 10")
    picture(page, pictures / "stock-rapid.png")
    key.click()


def test_a_stock_that_cannot_be_computed_says_why_and_the_path_stays(
    page: Page, served: Served
) -> None:
    (served.programs / "bare.nc").write_text("G21 F100\nG1 Z-3\nX9\nM2\n")
    load_file(page, "bare.nc")
    page.click("#display-tab-graphics")
    key = page.get_by_role("button", name="STOCK")
    key.click()
    expect(page.locator(".stock-note")).to_have_text(
        "the radius of the tool is not known: no D is in force, and CMP RAD is 0"
    )
    expect(key).to_have_attribute("aria-pressed", "false")
    expect(page.locator(".picture [data-layer=strokes]")).to_be_visible()
