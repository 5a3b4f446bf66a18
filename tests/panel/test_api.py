"""HTTP calls of a panel: forms, programs, paths, the description of the interface."""

import gzip
import math
import os
import struct
import sys
import time
from typing import Any

import ezdxf
import httpx
import pytest
from tests.panel.bench import LIMIT_S, Served
from tests.waiting import until

from openacr.client.panels import PANELS
from openacr.cnc.parts.library import part_named
from openacr.map import flags, parameters
from openacr.mill.plan.pictures.blank import SIZES
from openacr.sysvar.tabs import CELLS, GENERAL, OFFSETS

HEAD = 88  # of the block of a path


@pytest.fixture
def panel(kept_panel: Served) -> Served:
    return kept_panel


@pytest.fixture
def web(panel: Served) -> Any:
    with httpx.Client(base_url=panel.url, timeout=LIMIT_S) as client:
        yield client


def ready(ask: Any) -> httpx.Response:
    """An answer that is computed beside: asked until it is there."""
    end_s = time.monotonic() + LIMIT_S
    while (answer := ask()).status_code == 202:
        assert time.monotonic() < end_s
        time.sleep(0.02)
    assert isinstance(answer, httpx.Response)
    return answer


# --- forms ----------------------------------------------------------------------------


def test_a_form_has_units_limits_help_and_values(web: httpx.Client) -> None:
    form = web.get("/api/forms/SERVO", params={"axis": 1}).json()
    assert [axis["name"] for axis in form["axes"]] == ["X", "Y", "Z"]
    assert form["axis"] == 1
    row = form["groups"][0]["rows"][0]
    assert row == {
        "number": 151000, "name": "P Gain", "kind": "real", "axis": 1, "axis_name": "Y",
        "unit": "V/pulse", "value": "0.002441", "number_value": 0.002441, "default": "0.00244",
        "is_default": False, "low": 0, "high": 10.0, "low_open": False, "words": None, "bits": [],
        "noun": "",
        "typical": "0.001", "help": "Volts per pulse of error.", "motion": True, "fixed": False,
        "wire": None,
    }  # fmt: skip


def test_limits_of_lengths_are_in_the_unit_of_the_machine(web: httpx.Client) -> None:
    rows = web.get("/api/forms/CONTROL2").json()["groups"][0]["rows"]
    epsilon = next(row for row in rows if row["name"] == "Epsilon for Compensation")
    assert (epsilon["unit"], epsilon["value"], epsilon["low"]) == ("mm", "0.0508", 0.0)
    assert epsilon["low_open"]


def test_typical_lengths_are_in_the_unit_of_the_machine(web: httpx.Client) -> None:
    rows = web.get("/api/forms/JOG").json()["groups"][0]["rows"]
    feed = next(row for row in rows if row["name"] == "Jog Feedrate")
    assert (feed["unit"], feed["typical"], feed["default"]) == ("mm/min", "254", "254")


def test_every_form_can_be_read(web: httpx.Client) -> None:
    names = [form["name"] for form in web.get("/api/forms").json()["forms"]]
    assert {"SERVO", "AXES", "WORK", "MODALS", "MESSAGES", "H-WEAR", "IONAMES"} <= set(names)
    for name in names:
        form = web.get(f"/api/forms/{name}").json()
        assert form["groups"] and all(group["rows"] for group in form["groups"]), name


@pytest.mark.req("MILL-G101-SET")
def test_fixture_offsets_are_listed_by_number_without_z_and_are_stored(
    web: httpx.Client, panel: Served
) -> None:
    rows = web.get("/api/forms/FIXTURES", params={"first": 3, "count": 2}).json()
    x, y = OFFSETS.fixtures[0][1], OFFSETS.fixtures[1][1]
    assert [row["number"] for row in rows["groups"][0]["rows"]] == [x, y]
    assert [row["axis_name"] for row in rows["groups"][0]["rows"]] == ["X", "Y"]
    assert rows["page"] == {"first": 3, "count": 2, "total": 198}
    assert web.put("/api/forms/FIXTURES", json={"values": {str(x): "2", str(y): "-3"}}).json() == {
        "stored": {str(x): "2", str(y): "-3"}, "refused": {}
    }  # fmt: skip
    store = panel.panel.installation.store
    assert (store.read(x), store.read(y)) == (2.0, -3.0)


def test_values_are_stored_and_shown_as_the_store_has_them(
    web: httpx.Client, panel: Served
) -> None:
    answer = web.put("/api/forms/JOG", json={"values": {"350000": "500", "350001": "100 in"}})
    assert answer.json() == {"stored": {"350000": "500", "350001": "2540"}, "refused": {}}
    assert panel.panel.installation.store.read(350_001) == 2540.0


def test_a_refused_value_says_why_and_nothing_of_the_page_is_stored(
    web: httpx.Client, panel: Served
) -> None:
    values = {"350000": "500", "350001": "-1", "350002": "fast", "150000": "1", "x": "1"}
    answer = web.put("/api/forms/JOG", json={"values": values})
    assert answer.status_code == 422
    refused = answer.json()["refused"]
    assert set(refused) == {"350001", "350002", "150000", "x"}
    assert refused["350001"].startswith("P350001 Jog Rapid (axis 0) cannot be -1: a number above 0")
    assert refused["150000"] == "P150000 is not on the page JOG"
    assert panel.panel.installation.store.read(350_000) == 600.0


def test_a_rule_between_settings_names_its_cell(web: httpx.Client) -> None:
    answer = web.put("/api/forms/AXES", json={"values": {"200000": "-10"}})
    assert answer.status_code == 422
    text = answer.json()["refused"]["200000"]
    assert "it has to be above the -Soft Limit, -5" in text


def test_long_tables_come_in_pages(web: httpx.Client) -> None:
    form = web.get("/api/forms/H-GEOMETRY", params={"first": 990, "count": 20}).json()
    assert form["page"] == {"first": 990, "count": 10, "total": 999}
    numbers = [row["number"] for row in form["groups"][0]["rows"]]
    assert numbers == list(range(2990, 3000))


def test_settings_are_found_by_words(web: httpx.Client) -> None:
    cells = web.get("/api/settings/search", params={"text": "plus soft limit"}).json()["cells"]
    assert cells == [] or all("form" in cell for cell in cells)
    cells = web.get("/api/settings/search", params={"text": "jog rapid"}).json()["cells"]
    assert {cell["number"] for cell in cells} >= {350_001, 351_001}
    assert {cell["form"] for cell in cells} == {"JOG"}


def test_stored_settings_count_for_the_next_jog(web: httpx.Client, panel: Served) -> None:
    web.put("/api/forms/JOG", json={"values": {"350000": "1200"}})
    until(
        lambda: panel.call(lambda station: not station.settings.must_renew and station.link.session)
    )
    assert panel.call(lambda station: station.link.machine.runner.settings.axis(0).jog_ups) == 20.0


# --- programs -------------------------------------------------------------------------


def test_programs_are_listed_read_and_stored(web: httpx.Client, panel: Served) -> None:
    entries = web.get("/api/programs").json()["entries"]
    assert "plate.nc" in [entry["name"] for entry in entries]
    part = web.get("/api/programs/text", params={"path": "plate.nc", "first": 3, "lines": 2})
    assert part.json()["lines"][0] == "G21 G90 G17 G40 G49 G200 F2"
    assert part.json()["total"] == 64
    stored = web.put("/api/programs/file", params={"path": "jobs/new.nc"}, content="G0 X1\nM2\n")
    assert stored.status_code == 200
    assert (panel.programs / "jobs" / "new.nc").read_text() == "G0 X1\nM2\n"
    whole = web.get("/api/programs/file", params={"path": "jobs/new.nc"})
    assert whole.text == "G0 X1\nM2\n"
    assert whole.headers["etag"] == f'"{stored.json()["version"]}"'


@pytest.mark.skipif(sys.platform == "win32", reason="names of files are Unicode there")
def test_a_name_that_is_not_utf8_is_listed_and_says_why_it_cannot_be_opened(
    web: httpx.Client, panel: Served
) -> None:
    old = os.fsencode(panel.programs) + b"/Geh\xe4use.nc"  # of a shop that wrote Latin-1
    with open(old, "w") as file:
        file.write("G0 X1\nM2\n")
    entries = web.get("/api/programs").json()["entries"]
    named = next(entry for entry in entries if entry["name"].startswith("Geh"))
    assert (named["name"], named["path"]) == ("Geh\ufffduse.nc", "Geh\ufffduse.nc")
    assert "plate.nc" in [entry["name"] for entry in entries]
    answer = web.get("/api/programs/text", params={"path": named["path"]})
    assert answer.status_code == 404
    assert answer.json()["error"]["text"] == (
        "Geh\ufffduse.nc: this name is not UTF-8: rename the file on the computer"
    )


def test_a_file_that_was_changed_meanwhile_is_not_overwritten(
    web: httpx.Client, panel: Served
) -> None:
    place = {"path": "a.nc"}
    version = web.put("/api/programs/file", params=place, content="G0 X1\n").json()["version"]
    assert web.put("/api/programs/file", params=place, content="x").status_code == 409
    (panel.programs / "a.nc").write_text("G0 X2\n")
    answer = web.put("/api/programs/file", params=place, content="x", headers={"if-match": version})
    assert answer.status_code == 409
    assert answer.json()["error"]["text"] == "a.nc was changed meanwhile: read it again"
    assert (panel.programs / "a.nc").read_text() == "G0 X2\n"
    answer = web.put("/api/programs/file", params=place, content="M2", headers={"if-match": "*"})
    assert answer.status_code == 200


@pytest.mark.parametrize(
    "path", ["../secret.nc", "a/../../b.nc", "/etc/passwd", ".hidden", "a\\b.nc", "a\nb", "x" * 300]
)
def test_names_stay_inside_the_folder(web: httpx.Client, panel: Served, path: str) -> None:
    answer = web.put("/api/programs/file", params={"path": path}, content="M2")
    if path == "/etc/passwd":  # a path of the folder, not of the computer
        assert (panel.programs / "etc" / "passwd").read_text() == "M2"
        return
    assert answer.status_code in (400, 422)
    assert "not allowed" in answer.json()["error"]["text"]


@pytest.mark.parametrize(("length", "status"), [(1000, 200), (1001, 422)])
def test_a_path_has_at_most_1000_bytes(web: httpx.Client, length: int, status: int) -> None:
    path = ("d/" * 500 + "d.nc")[-length:]
    answer = web.put("/api/programs/file", params={"path": path}, content="M2")
    assert answer.status_code == status
    assert status == 200 or "at most 1000 bytes" in answer.json()["error"]["text"]


@pytest.mark.parametrize("age_s", [3500.0, 3700.0])
def test_what_a_killed_process_left_of_an_upload_is_removed_after_an_hour(
    web: httpx.Client, panel: Served, age_s: float
) -> None:
    left = panel.programs / ".upload-abc"
    left.write_text("G0")
    then_s = left.stat().st_mtime - age_s
    os.utime(left, (then_s, then_s))
    answer = web.put("/api/programs/file", params={"path": "new.nc"}, content="M2")
    assert answer.status_code == 200
    assert left.exists() is (age_s < 3600.0)


def test_a_link_out_of_the_folder_is_not_followed(web: httpx.Client, panel: Served) -> None:
    (panel.programs.parent / "outside.nc").write_text("secret")
    (panel.programs / "link.nc").symlink_to(panel.programs.parent / "outside.nc")
    answer = web.get("/api/programs/file", params={"path": "link.nc"})
    assert answer.status_code == 404
    assert "secret" not in answer.text


def test_an_upload_beyond_its_limit_leaves_nothing(
    web: httpx.Client, panel: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("openacr.panel.server.calls.programs.MOST_UPLOAD", 1000)
    answer = web.post("/api/programs/upload", params={"path": "big.nc"}, content=b"G0\n" * 1000)
    assert answer.status_code == 413
    assert [p.name for p in panel.programs.iterdir() if "big" in p.name or "upload" in p.name] == []


def test_a_text_is_checked_while_it_is_typed(web: httpx.Client) -> None:
    body = {"text": "G21 G90\nG1 X10 F100\nG1 Q5\nM2\n", "path": "x.nc"}
    answer = web.post("/api/check", json=body).json()
    errors = [f for f in answer["findings"] if f["severity"] == "error"]
    assert [(f["line"], f["column"], f["code"]) for f in errors] == [(3, 4, "E206")]
    good = web.post("/api/check", json={"text": "G21 G90\nG0 X0\nG1 X10 F100\nM2\n"}).json()
    assert good["seconds"] == pytest.approx(6.0 + 2.2, abs=0.5)
    assert good["extents"]["X"] == [200.0, 210.0]


@pytest.mark.req("MILL-DXF-02", "MILL-DXF-05")
@pytest.mark.parametrize(
    ("asked", "corners"),
    [
        ({"drill": False}, ["X0 Y2", "X2 Y2", "X2 Y0"]),
        ({"drill": False, "direction": 0}, ["X0 Y2", "X2 Y2", "X2 Y0"]),
        ({"drill": False, "direction": 1}, ["X2 Y0", "X2 Y2", "X0 Y2"]),
        ({"drill": True, "drill_z": -6.35}, ["G98 G81 X0.5 Y1 Z-0.25"]),
    ],
)
def test_a_drawing_becomes_a_continuous_path_or_a_drill_pattern_as_asked(
    web: httpx.Client, panel: Served, asked: dict[str, object], corners: list[str]
) -> None:
    document = ezdxf.new("R2010")  # type: ignore[attr-defined]
    document.header["$INSUNITS"] = 1
    document.modelspace().add_lwpolyline([(0, 0), (2, 0), (2, 2), (0, 2)], close=True)
    document.modelspace().add_point((0.5, 1))
    document.saveas(panel.programs / "plate.dxf")
    answer = web.post("/api/dxf", json={"path": "plate.dxf", "output": "plate.TXT", **asked})
    assert answer.status_code == 200
    text = (panel.programs / "plate.TXT").read_text()
    places = [text.index(corner) for corner in corners]
    assert places == sorted(places)
    assert ("G81" in text) is bool(asked["drill"])
    assert ("X2 Y2" in text) is not bool(asked["drill"])


def test_the_path_of_the_loaded_program_is_one_block_of_bytes(
    web: httpx.Client, panel: Served
) -> None:
    (panel.programs / "square.nc").write_text("G21 G90\nG0 X10\nG1 X20 F300\nY10\nG0 Z5\nM2\n")
    answer = ready(lambda: web.get("/api/path", params={"path": "square.nc"}))
    blob = answer.content
    mark, points, lines, flags = struct.unpack_from("<4sIII", blob)
    assert (mark, points, lines, flags & 1) == (b"OAP2", 5, 3, 1)
    assert struct.unpack_from("<3f", blob, 48) == (200.0, 150.0, -60.0)
    places = [struct.unpack_from("<3f", blob, HEAD + 12 * n) for n in range(points)]
    assert places == [
        (0, 0, 0),
        (210, 0, 0),
        (220, 0, 0),
        (220, 160, 0),
        (220, 160, -55),
    ]  # machine coordinates; axes that no block has named yet stay
    assert struct.unpack_from("<6f", blob, 16) == (0.0, 0.0, -55.0, 220.0, 160.0, 0.0)
    at = HEAD + 12 * points
    assert struct.unpack_from(f"<{points}I", blob, at) == (0, 2, 3, 4, 5)
    at += 4 * points
    assert struct.unpack_from(f"<{lines}I", blob, at) == (0, 1, 3)
    assert blob[at + 4 * lines : at + 5 * lines] == bytes((0, 1, 0))
    assert len(blob) == at + 6 * lines
    again = web.get(
        "/api/path", params={"path": "square.nc"}, headers={"if-none-match": answer.headers["etag"]}
    )
    assert again.status_code == 304


def test_the_path_has_the_blank_of_the_sizes_in_the_store_around_what_is_cut(
    web: httpx.Client, panel: Served
) -> None:
    text = "G21 G90 G55\nG43 H1 G0 X10 Y5 Z5\nG1 Z-2 F300\nX20 Y35\nG0 X99\nM2\n"
    (panel.programs / "blank.nc").write_text(text)
    store = panel.panel.installation.store
    store.write(CELLS.h_length[1], 7.0)
    zero = [CELLS.work_systems[1][axis] for axis in range(3)]
    for cell, value in zip(zero, (100.0, 50.0, -60.0), strict=True):
        store.write(cell, value)

    def blank() -> tuple[float, ...]:
        answer = ready(lambda: web.get("/api/path", params={"path": "blank.nc"}))
        return struct.unpack_from("<6f", answer.content, 60)

    assert all(map(math.isnan, blank()))
    default = float(store.default(SIZES[2]))
    store.write(SIZES[2], default)  # as large as if it were not stored, but it is
    top = -60.0 + 7.0  # program Z0 where the spindle is, with the length of the tool
    assert blank() == pytest.approx((110.0, 55.0, top - default, 120.0, 85.0, top))
    for cell, size in zip(SIZES, (40.0, 50.0, 6.0), strict=True):
        store.write(cell, size)
    assert blank() == (95.0, 45.0, top - 6.0, 135.0, 95.0, top)
    (panel.programs / "blank.nc").write_text("G21 G90\nG0 X10\nM2\n")
    assert all(map(math.isnan, blank()))


def test_the_path_follows_the_work_offset(web: httpx.Client, panel: Served) -> None:
    (panel.programs / "line.nc").write_text("G21 G90\nG1 X20 F300\nM2\n")
    first = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    web.put("/api/forms/WORK", json={"values": {"910": "100", "911": "0", "912": "0"}})
    second = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    assert first.headers["etag"] != second.headers["etag"]
    assert struct.unpack_from("<f", second.content, HEAD + 12) == (120.0,)
    assert struct.unpack_from("<3f", second.content, 48) == (100.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("form", "values", "end"),
    [
        ("MODALS", {"100013": "91"}, 30.0),  # G91
        ("MODALS", {"100014": "20"}, 508.0),  # G20
    ],
)
def test_the_path_follows_the_run_setup(
    web: httpx.Client, panel: Served, form: str, values: dict[str, str], end: float
) -> None:
    (panel.programs / "line.nc").write_text("G53\nF300\nG1 X10\nX20\nM2\n")
    first = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    assert web.put(f"/api/forms/{form}", json={"values": values}).status_code == 200
    second = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    assert first.headers["etag"] != second.headers["etag"]
    assert struct.unpack_from("<f", second.content, HEAD + 24) == (end,)


def test_the_path_follows_p_parameters(web: httpx.Client, panel: Served) -> None:
    (panel.programs / "line.nc").write_text("G21 G90 G53\nG1 X(P199) F300\nM2\n")
    first = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    web.put("/api/pparm", json={"values": {"199": 7.5}})
    second = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    assert first.headers["etag"] != second.headers["etag"]
    assert struct.unpack_from("<f", second.content, HEAD + 12) == (7.5,)


def test_a_change_of_set_modals_chooses_the_start_set_unless_it_says_otherwise(
    web: httpx.Client, panel: Served
) -> None:
    store, chosen = panel.panel.installation.store, GENERAL.start_set_chosen
    path = "/api/forms/MODALS"
    assert web.put(path, json={"values": {"100012": "99"}}).status_code == 422
    assert store.read(chosen) == 0.0
    web.put(path, json={"values": {}})
    assert store.read(chosen) == 0.0
    stored = web.put(path, json={"values": {"100012": "18"}}).json()["stored"]
    assert stored == {"100012": "18", "100010": "1"}
    web.put(path, json={"values": {"100010": "0"}})
    assert store.read(chosen) == 0.0
    web.put(path, json={"values": {"100012": "19", "100010": "0"}})
    assert (store.read(chosen), store.read(GENERAL.start_plane)) == (0.0, 19.0)


def test_time_and_extents_of_the_sample_become_known(web: httpx.Client, panel: Served) -> None:
    end_s = time.monotonic() + LIMIT_S
    while (found := web.get("/api/program").json()) is None or found["seconds"] is None:
        assert time.monotonic() < end_s
        time.sleep(0.02)
    assert found["name"] == "plate.nc"
    assert found["tools"] == [1, 2]
    assert found["errors"] == 0
    assert found["extents"]["X"][1] - found["extents"]["X"][0] > 80.0
    listing = web.get("/api/program/listing", params={"first": 64, "lines": 10}).json()
    assert listing["total"] == 64
    assert len(listing["lines"]) == 1


# --- parts, card, help, interface -----------------------------------------------------


def test_parts_of_the_library_have_sizes_and_pictures(web: httpx.Client) -> None:
    parts = web.get("/api/parts").json()["parts"]
    assert len(parts) == 27
    part = parts[0]
    answer = web.post(f"/api/parts/{part['name']}/path", json={})
    assert answer.content[:4] == b"OAP2"
    assert part == part_named(part["name"]).data()  # as the command line describes it
    size = part["sizes"][0]
    wrong = {"values": {f"P{size['cell']}": size["high"] * 2 + 1}}
    refused = web.post(f"/api/parts/{part['name']}/path", json=wrong)
    assert refused.status_code == 422
    assert size["text"] in refused.json()["error"]["text"]


def test_parameters_of_the_card_are_found(web: httpx.Client) -> None:
    answer = web.get("/api/card/parameters", params={"text": "actual position", "object": "axis"})
    numbers = [each["number"] for each in answer.json()["parameters"]]
    assert 12_290 in numbers
    query: dict[str, str | int] = {"text": "in motion", "index": 0}
    found = web.get("/api/card/flags", params=query).json()["flags"]
    assert 516 in [each["number"] for each in found]


def test_parameters_and_flags_are_found_by_words_the_best_first(web: httpx.Client) -> None:
    found = web.get("/api/card/search", params={"text": "master1 in motion", "count": 2}).json()
    assert next(each["id"] for each in found["items"]) == "BIT548"
    found = web.get("/api/card/search", params={"text": "p12290", "count": 1}).json()
    assert [(each["id"], each["unit"]) for each in found["items"]] == [("P12290", "pulse")]
    assert web.get("/api/card/search", params={"text": "x", "count": 501}).is_client_error


def test_objects_of_the_card_are_listed_with_what_is_found_in_each(web: httpx.Client) -> None:
    def groups(**params: str | int) -> list[dict[str, Any]]:
        found: list[dict[str, Any]] = web.get("/api/card/groups", params=params).json()["groups"]
        return found

    everything = groups()
    assert sum(each["parameters"] for each in everything) == len(parameters())
    assert sum(each["flags"] for each in everything) == len(flags())
    assert groups(text="in motion", object="master", index=1) == [
        {"object": "MASTER", "index": 1, "parameters": 0, "flags": 1}
    ]
    assert groups(text="BIT5161") == [{"object": "MASTER", "index": 1, "parameters": 0, "flags": 1}]
    assert groups(text="p12288") == [{"object": "AXIS", "index": 0, "parameters": 1, "flags": 0}]
    bare = groups(object="none")
    assert [(each["object"], each["index"]) for each in bare] == [("none", None)]
    query: dict[str, str | int] = {"object": "none", "count": 500}
    listed = web.get("/api/card/parameters", params=query).json()["parameters"]
    assert len(listed) == bare[0]["parameters"]
    assert {each["object"] for each in listed} == {""}


def test_parameters_and_flags_are_found_by_number_and_by_name(web: httpx.Client) -> None:
    names = "BIT516; axis0.actual position;P5;"
    items = web.get("/api/card/named", params={"names": names}).json()["items"]
    assert [each["id"] for each in items] == ["BIT516", "P12290", "P5"]
    assert (items[0]["name"], items[0]["parameter"], items[0]["bit"]) == ("In Motion", 4112, 4)
    assert (items[1]["unit"], items[1]["object"], items[1]["index"]) == ("pulse", "AXIS", 0)
    for name, text in (
        ("P1000000", "there is no parameter P1000000"), ("BIT99999", "there is no flag BIT99999"),
        ("BIT5;turnip", "no parameter and no flag is named 'turnip'"),
    ):  # fmt: skip
        refused = web.get("/api/card/named", params={"names": name})
        assert refused.status_code == 422
        assert refused.json()["error"]["text"] == text


def test_panels_of_status_name_what_each_row_is_of_each_object(web: httpx.Client) -> None:
    listed = web.get("/api/card/panels").json()["panels"]
    assert [each["name"] for each in listed] == [panel.name for panel in PANELS]
    found = web.get("/api/card/panel", params={"name": "streams"}).json()
    assert found["objects"] == ["COM1", "COM2", "FIFO", "DPCB"]
    row = found["groups"][0]["rows"][1]
    assert row["name"] == "Line Buffer Count"
    assert [each["name"] for each in row["items"]] == [
        f"{thing} Line Buffer Count" for thing in found["objects"]
    ]
    assert row["items"][0]["id"] == f"P{row['items'][0]['number']}"
    refused = web.get("/api/card/panel", params={"name": "stars"})
    assert refused.status_code == 422
    assert "no panel 'stars': there are axes" in refused.json()["error"]["text"]


def test_operator_variables_of_card_and_store_are_read_and_written(web: httpx.Client) -> None:
    answer = web.put("/api/pparm", json={"values": {"5": 1.5, "150": 2.5}})
    assert answer.json() == {"values": {"5": 1.5, "150": 2.5}}
    values = web.get("/api/pparm").json()["values"]
    assert len(values) == 200
    assert (values[5], values[150]) == (1.5, 2.5)
    refused = web.put("/api/pparm", json={"values": {"200": 1.0}})
    assert "P200 is not an operator variable" in refused.json()["error"]["text"]


def test_help_is_there_for_menus_commands_and_cells(web: httpx.Client) -> None:
    assert web.get("/api/help/jog").json()["title"] == "JOG"
    assert web.get("/api/help/run.block").json()["text"].startswith("BLOCK")
    assert "Jog Rapid" in web.get("/api/help/350001").json()["title"]
    assert web.get("/api/help/nothing").status_code == 404


def test_the_interface_describes_itself(web: httpx.Client) -> None:
    found = web.get("/api/openapi.json").json()
    assert found["openapi"] == "3.1.0"
    assert {"get", "put"} == set(found["paths"]["/api/forms/{name}"])
    names = [each["name"] for each in found["paths"]["/api/forms/{name}"]["get"]["parameters"]]
    assert names == ["name", "axis", "first", "count"]
    assert found["x-commands"]["jog.press"]["role"] == "operate"
    for path, calls in found["paths"].items():
        for method, call in calls.items():
            assert call["summary"], (path, method)


def test_wrong_calls_are_answered_with_the_reason(web: httpx.Client) -> None:
    assert web.get("/api/forms/NONE").status_code == 404
    assert web.get("/api/forms/SERVO", params={"axis": "x"}).status_code == 400
    assert web.get("/api/forms/SERVO", params={"bad": 1}).status_code == 400
    answer = web.put("/api/forms/SERVO", content="{")
    assert answer.status_code == 400
    assert web.put("/api/forms/SERVO", json={"values": {"150000": 1}}).status_code == 400
    assert "/api/forms/SERVO" in answer.json()["error"]["text"]


def test_packed_answers_are_gzip(web: httpx.Client, panel: Served) -> None:
    (panel.programs / "line.nc").write_text("G21 G90\nG1 X20 F300\nM2\n")
    answer = ready(lambda: web.get("/api/path", params={"path": "line.nc"}))
    assert answer.headers["content-encoding"] == "gzip"
    with httpx.stream("GET", f"{panel.url}/api/path", params={"path": "line.nc"}) as raw:
        assert gzip.decompress(b"".join(raw.iter_raw()))[:4] == b"OAP2"


@pytest.mark.parametrize(
    ("pragma", "undo", "why"),
    [
        ("query_only = 1", "query_only = 0", "is read-only: nothing can be stored"),
        (
            "max_page_count = 1",
            "max_page_count = 100000",
            "cannot be written: the disk is full; nothing of this was stored",
        ),
    ],
)
def test_values_that_the_store_cannot_keep_are_refused_and_the_old_ones_stay(
    quiet_panel: Served, pragma: str, undo: str, why: str
) -> None:
    store = quiet_panel.panel.installation.store
    values = {str(number): "0.25" for number in range(2001, 2999)}

    def save() -> httpx.Response:
        return httpx.put(
            f"{quiet_panel.url}/api/forms/H-GEOMETRY", json={"values": values}, timeout=LIMIT_S
        )

    store._database._connection.execute(f"PRAGMA {pragma}")
    answer = save()
    store._database._connection.execute(f"PRAGMA {undo}")
    assert answer.status_code == 422
    assert answer.json()["error"] == {"code": "refused", "text": f"{quiet_panel.store} {why}"}
    assert {store.read(number) for number in range(2001, 2999)} == {0.0}
    assert save().status_code == 200
    assert {store.read(number) for number in range(2001, 2999)} == {0.25}


# --- stock ----------------------------------------------------------------------------

STOCK_HEAD = struct.Struct("<4sIII5fIII")
SLOT = "G21 F100\nG10 L12 P1 R2\nG0 X1 Y1 Z5\nG0 X0 Y0\nD1 G1 Z-3\nX20\nG0 Y5\nZ5\nM2\n"


def test_the_stock_of_a_program_is_heights_marks_and_lines(
    panel: Served, web: httpx.Client
) -> None:
    (panel.programs / "slot.nc").write_text(SLOT)
    answer = ready(lambda: web.get("/api/stock", params={"path": "slot.nc"}))
    assert (answer.status_code, answer.headers["content-encoding"]) == (200, "gzip")
    mark, columns, rows, flags, *place, rapids, belows, _ = STOCK_HEAD.unpack_from(answer.content)
    assert (mark, flags, rapids, belows) == (b"OAS1", 1, 1, 0)
    *_corner, cell, bottom, top = place
    assert columns == 500
    assert (top - bottom, cell * columns) == (pytest.approx(3.0), pytest.approx(24.0))
    assert struct.unpack_from("<I", answer.content, 48) == (7,)
    assert len(answer.content) == 48 + 4 + 3 * columns * rows
    heights = struct.unpack_from(f"<{columns * rows}H", answer.content, 52)
    assert set(heights) == {0, 65535}
    middle = int(2.0 / cell)  # the row of Y0: the blank begins a radius before it
    assert (heights[middle * columns + columns // 2], heights[-1]) == (0, 0)
    tag = {"if-none-match": answer.headers["etag"]}
    assert web.get("/api/stock", params={"path": "slot.nc"}, headers=tag).status_code == 304


def test_another_program_ends_the_stock_that_is_being_computed(
    panel: Served, web: httpx.Client
) -> None:
    long = "".join(f"X{n % 50}Y{n % 49}\n" for n in range(60_000))
    (panel.programs / "long.nc").write_text(f"G21 F100\nG10 L12 P1 R9\nD1 G1 Z-3\n{long}M2\n")
    (panel.programs / "slot.nc").write_text(SLOT)
    begun = web.get("/api/stock", params={"path": "long.nc"})
    assert (begun.status_code, sorted(begun.json())) == (202, ["done", "job"])
    assert ready(lambda: web.get("/api/stock", params={"path": "slot.nc"})).status_code == 200
    assert ready(lambda: web.get("/api/path", params={"path": "plate.nc"})).status_code == 200


def test_a_stock_is_stopped_and_begun_again(panel: Served, web: httpx.Client) -> None:
    (panel.programs / "slot.nc").write_text(SLOT.replace("X20", "X19"))  # never computed before
    web.get("/api/stock", params={"path": "slot.nc"})
    assert web.delete("/api/stock").json() == {}
    assert ready(lambda: web.get("/api/stock", params={"path": "slot.nc"})).status_code == 200


def test_a_stock_that_cannot_be_computed_says_why(panel: Served, web: httpx.Client) -> None:
    (panel.programs / "bare.nc").write_text("G21 F100\nG1 Z-3\nM2\n")
    answer = ready(lambda: web.get("/api/stock", params={"path": "bare.nc"}))
    assert answer.status_code == 422
    assert answer.json()["error"]["text"] == (
        "the radius of the tool is not known: no D is in force, and CMP RAD is 0"
    )
