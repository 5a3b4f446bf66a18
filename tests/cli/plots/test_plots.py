"""A picture shows every axis that moved, with units, and loses no peak."""

import json
import re
import xml.etree.ElementTree as ET
from dataclasses import replace
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal
from urllib.parse import unquote

import matplotlib as mpl
import numpy as np
import pytest
from matplotlib import image
from matplotlib.figure import Figure

from openacr.cli.plots import AxisCurves, BitCurve, Curves, draw, require
from openacr.cli.plots.curves import Array, Mark, edges, envelope, marks
from openacr.cli.plots.image import EVENT, EVENTS, build_figure
from openacr.cli.plots.page import build_page, page_data
from openacr.cli.plots.saved import save
from openacr.cli.results import Event
from openacr.errors import UserError

TIME_S: Array = np.arange(4000, dtype=np.float64) * 0.0005


def axis(number: int, *, name: str = "", master: int | None = 0, moves: bool = True) -> AxisCurves:
    position = 10.0 * np.sin(TIME_S * (number + 1)) if moves else np.zeros_like(TIME_S)
    error = np.zeros_like(TIME_S)
    error[1234] = 0.5 if moves else 0.0
    velocity = np.gradient(position, 0.0005)
    return AxisCurves(
        number, position, position - error, velocity, error, name=name, unit="mm", master=master
    )


def run(*axes: AxisCurves, bits: tuple[BitCurve, ...] = ()) -> Curves:
    return Curves(TIME_S, axes, bits, "gantry")


def texts_of_svg(path: Path) -> str:
    return " ".join(
        element.text or "" for element in ET.parse(path).iter("{http://www.w3.org/2000/svg}text")
    )


@pytest.mark.parametrize("size", [1, 10, 999, 20_000, 20_011])
def test_decimation_keeps_ends_and_every_extreme(size: int) -> None:
    values = np.random.default_rng(size).normal(size=size)
    kept = envelope(values, buckets=100)
    assert kept[0] == 0
    assert kept[-1] == size - 1
    assert np.all(np.diff(kept) > 0)
    assert values[kept].min() == values.min()
    assert values[kept].max() == values.max()
    assert kept.size <= max(500, 4 * size // 100 + 500)


def test_a_peak_of_one_sample_stays_in_its_place() -> None:
    values = np.zeros(100_000)
    values[54_321] = 1.0
    kept = envelope(values)
    assert 54_321 in kept
    assert kept.size < 10_000


def test_only_axes_that_moved_and_flags_that_changed_are_shown() -> None:
    off = np.zeros(TIME_S.size, dtype=np.bool_)
    blink = (TIME_S % 0.5) < 0.25
    curves = run(axis(0), axis(1, moves=False), bits=(BitCurve(32, off), BitCurve(33, blink)))
    assert [shown.number for shown in curves.moved] == [0]
    assert [bit.number for bit in curves.strips] == [33]


def test_the_plane_is_the_first_two_moving_axes_of_one_master() -> None:
    plane = run(axis(0, master=1), axis(1, moves=False), axis(2, master=0), axis(4, master=1)).plane
    assert plane is not None
    assert [shown.number for shown in plane] == [0, 4]
    assert run(axis(0, master=None), axis(1, master=None)).plane is None


def test_edges_are_the_times_a_flag_was_on() -> None:
    on = np.array([True, False, True, True, False, True])
    assert edges(BitCurve(1, on), np.arange(6.0)) == [(0.0, 1.0), (2.0, 4.0), (5.0, 5.0)]


def test_a_png_shows_all_panels(tmp_path: Path) -> None:
    path = tmp_path / "run.png"
    draw(run(axis(0), axis(1)), path)
    data = path.read_bytes()
    width, height = (int.from_bytes(data[at : at + 4]) for at in (16, 20))
    assert data.startswith(b"\x89PNG")
    assert width > height > 800


def test_an_svg_is_labelled_with_names_and_units(tmp_path: Path) -> None:
    path = tmp_path / "run.svg"
    blink = (TIME_S % 0.5) < 0.25
    draw(run(axis(0, name="X"), axis(1, name="Y"), bits=(BitCurve(32, blink, "clamp"),)), path)
    shown = texts_of_svg(path)
    for text in (
        "X (axis 0)",
        "Y (axis 1)",
        "position [mm]",
        "velocity [mm/s]",
        "following error [mm]",
        "time [s]",
        "commanded",
        "actual",
        "path, master 0",
        "X (axis 0) [mm]",
        "peak 0.5 mm",
        "clamp (BIT32)",
        "2 s simulated",
    ):
        assert text in shown


def test_a_run_without_motion_says_so(tmp_path: Path) -> None:
    draw(run(axis(0, moves=False)), tmp_path / "still.svg")
    assert "no axis moved" in texts_of_svg(tmp_path / "still.svg")
    draw(Curves(np.empty(0), ()), tmp_path / "empty.png")
    assert (tmp_path / "empty.png").stat().st_size > 1000


def test_a_page_stands_alone_and_holds_the_data(tmp_path: Path) -> None:
    path = tmp_path / "run.html"
    draw(run(axis(0, name="X </script>"), axis(1)), path)
    page = path.read_text(encoding="utf-8")
    assert not re.search(r"https?://", page)
    assert not re.search(r"<(link|img|script[^>]*\ssrc)", page)
    found = re.search(r'<script id="data"[^>]*>(.*?)</script>', page, re.DOTALL)
    assert found is not None
    data = json.loads(found[1])
    assert data["axes"][0]["title"] == "X </script> (axis 0)"
    assert max(data["axes"][0]["error"]) == 0.5
    assert data["path"]["labels"] == ["X </script> (axis 0) [mm]", "axis 1 [mm]"]


def test_a_page_of_nothing_can_be_built() -> None:
    assert page_data(Curves(np.empty(0), ()))["axes"] == []
    assert '"axes":[]' in build_page(Curves(np.empty(0), ()))


def test_a_page_has_all_modules_its_scripts_import() -> None:
    page = build_page(run(axis(0)))
    found = re.search(r'<script type="importmap">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    modules = {name: unquote(text) for name, text in json.loads(found[1])["imports"].items()}
    assert sorted(modules) == [
        "openacr/js/core/dom.js", "openacr/js/pages/run.js", "openacr/vendor/uplot.js",
    ]  # fmt: skip
    for text in modules.values():
        assert text.startswith("data:text/javascript,")
        wanted = re.findall(r'\b(?:from|import)\s*\(?\s*"([^"]+)"', text)
        assert set(wanted) <= set(modules)
    source = files("openacr.panel").joinpath("web/vendor/uplot.js").read_text("utf-8")
    assert modules["openacr/vendor/uplot.js"] == f"data:text/javascript,{source}"


def test_an_unknown_kind_of_picture_is_refused() -> None:
    with pytest.raises(UserError, match=r"run\.gif: pictures end in \.png, \.svg or \.html"):
        require(Path("run.gif"))


def test_a_missing_drawing_library_is_named_before_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("openacr.cli.plots.formats.find_spec", lambda name: None)
    with pytest.raises(UserError, match=r"need matplotlib: pip install 'openacr\[plot\]'"):
        require(Path("run.png"))
    require(Path("run.html"))


def events(*times_s: float) -> tuple[Event, ...]:
    return tuple(Event(time_s, f"event at {time_s:g}") for time_s in times_s)


def test_events_nearer_than_a_mark_is_wide_share_one() -> None:
    found = marks(events(0.0, 0.4, 0.5, 0.9, 3.0), 0.5)
    assert found == [Mark(0.0, 1, 2), Mark(0.5, 3, 4), Mark(3.0, 5, 5)]
    assert [mark.label for mark in found] == ["1\u20132", "3\u20134", "5"]
    assert marks((), 0.5) == []


def test_a_mark_begins_anew_only_beyond_the_first_event_of_the_last_one() -> None:
    # Each is near to the one before it; the third is as far as a mark is wide from the first.
    assert marks(events(1.0, 1.3, 1.6), 0.5) == [Mark(1.0, 1, 2), Mark(1.6, 3, 3)]


def with_events(*times_s: float) -> Curves:
    return replace(run(axis(0), axis(1)), events=events(*times_s))


def test_a_picture_lists_events_and_numbers_them_above_every_axis(tmp_path: Path) -> None:
    path = tmp_path / "run.svg"
    draw(with_events(0.5, 0.5, 1.5), path)
    texts = texts_of_svg(path)
    for line in ("  1  0.5000 s: event at 0.5", "  2  0.5000 s: event at 0.5",
                 "  3  1.5000 s: event at 1.5"):  # fmt: skip
        assert line.replace(" ", "") in texts.replace(" ", "").replace("\xa0", "")
    figure = build_figure(with_events(0.5, 0.5, 1.5))
    labels = [sorted(note.get_text() for note in panel.texts) for panel in figure.axes]
    # Two columns of three panels: numbers at the top ones only; then the path and the list.
    assert labels[:6] == [["1\u20132", "3"], [], [], ["1\u20132", "3"], [], []]


def test_every_panel_of_a_time_axis_has_a_line_at_every_event() -> None:
    figure = build_figure(with_events(0.5, 1.5))
    for panel in figure.axes[:6]:
        marked = (line for line in panel.lines if line.get_color() == EVENT)
        places = [float(np.asarray(line.get_xdata())[0]) for line in marked]
        assert places == [0.5, 1.5]
    assert not [line for line in figure.axes[6].lines if line.get_color() == EVENT]  # the path


def test_a_long_list_of_events_says_how_many_more_there_are() -> None:
    times = [0.01 * n for n in range(EVENTS + 3)]
    (text,) = build_figure(with_events(*times)).axes[-1].texts
    lines = text.get_text().split("\n")
    assert len(lines) == EVENTS + 1
    assert lines[-1] == "     and 3 more"
    (text,) = build_figure(with_events(*times[:EVENTS])).axes[-1].texts
    assert len(text.get_text().split("\n")) == EVENTS


def test_events_are_listed_where_no_axis_moved() -> None:
    figure = build_figure(replace(run(axis(0, moves=False)), events=events(0.5)))
    assert [text.get_text() for text in figure.axes[0].texts] == ["  1  0.5000 s: event at 0.5"]


def test_a_page_has_the_events() -> None:
    data = page_data(with_events(0.5, 1.5))
    assert data["events"] == [
        {"t": 0.5, "text": "event at 0.5"},
        {"t": 1.5, "text": "event at 1.5"},
    ]
    assert page_data(run(axis(0)))["events"] == []


@pytest.mark.parametrize("layout", ["constrained", None])
def test_a_png_is_drawn_once_and_has_the_pixels_that_matplotlib_gives_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, layout: Literal["constrained"] | None
) -> None:
    def figure() -> Figure:
        found = Figure(figsize=(4, 3), layout=layout)
        panel = found.add_subplot()
        panel.plot([0, 1], [0, 2e7], label="a")
        panel.set_title("a title", loc="left")
        panel.set_ylabel("a label")
        return found

    usual, own, vector = (tmp_path / name for name in ("usual.png", "own.PNG", "own.svg"))
    figure().savefig(usual, dpi=130)
    drawn: list[Figure] = []
    draw_figure = Figure.draw

    def counted(figure: Figure, renderer: Any) -> None:
        drawn.append(figure)
        draw_figure(figure, renderer)

    monkeypatch.setattr(Figure, "draw", counted)
    save(figure(), own, dpi=130)
    assert len(drawn) == 1
    assert own.read_bytes() != usual.read_bytes()  # packed in half the time
    assert np.array_equal(image.imread(usual), image.imread(own))
    with mpl.rc_context({"svg.fonttype": "none"}):
        save(figure(), vector, dpi=130)
    assert "a title" in texts_of_svg(vector)
