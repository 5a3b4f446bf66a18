"""Long records: what the card went through, part by part, over HTTP."""

import csv
import io
import json
from pathlib import Path

import httpx
import numpy as np
import pytest
from pyarrow import parquet
from tests.panel.bench import HandStation, Served

from openacr.client.names import named
from openacr.errors import UserError
from openacr.panel.control.engineer.pyramid import Pyramid
from openacr.panel.control.station import Station
from openacr.panel.server.calls import record as calls

pytestmark = pytest.mark.evidence("oracle", "numpy over all samples")

CHANNELS = ["P6916", "P12290", "BIT1921"]  # milliseconds of the card, a position, a flag


def test_a_record_goes_on_beside_a_capture_and_has_every_sample(hand: HandStation) -> None:
    begun = hand.do("record.begin", channels=CHANNELS, period_ms=1)
    assert (begun["number"], begun["period_s"], begun["running"]) == (1, 0.001, True)
    assert begun["channels"] == CHANNELS
    hand.run(0.2)
    hand.do("scope.arm", channels=["P12288"], period_ms=0)
    hand.do("jog.increment", axis="X", direction=1, distance=1.0, tick=hand.tick)
    hand.run(0.3)
    hand.do("scope.stop")
    hand.run(0.1)
    hand.do("record.end")
    record = hand.station.records.record
    assert record is not None
    clock, place, flag = record.samples.samples(0, record.samples.next)
    assert abs(len(clock) - 600) <= 3
    assert np.diff(clock).tolist() == [1.0] * (len(clock) - 1)
    assert len(set(place)) > 20
    assert set(flag) == {0.0}
    assert hand.events("record")[-1]["running"] is False
    kept = record.samples.next
    hand.run(0.2)
    assert record.samples.next == kept
    hand.do("record.begin", channels=[1])
    with pytest.raises(UserError, match="this record was dropped"):
        record.samples.columns(0, 10, 10)
    hand.do("record.end")
    hand.until(lambda: not hand.is_busy)


def test_an_hour_of_a_virtual_card_is_computed_and_shown_whole(hand: HandStation) -> None:
    controller = hand.installation.controller
    assert controller is not None
    hand.do("record.begin", channels=["P6916"], period_ms=100)
    for _ in range(36):
        controller.advance(200_000)  # 100 s
        hand.station.records.collect()
    record = hand.station.records.record
    assert record is not None
    assert record.samples.next == 36_000
    found = record.samples.columns(0, 36_000, 100)
    begin = record.samples.samples(0, 1)[0, 0]
    low = [begin + 100.0 * found.width * n for n in range(found.low.shape[1])]
    assert found.low[0].tolist() == low
    hand.do("record.end")


def test_a_record_under_way_or_of_a_minute_is_dropped_only_if_that_is_wanted(
    hand: HandStation,
) -> None:
    hand.do("record.begin", channels=[1], period_ms=10)
    hand.run(0.1)
    error = hand.refused("record.begin", channels=[2])
    assert error["code"] == "taken"
    assert error["text"] == "a record of 0 s is under way: the new one drops it"
    assert hand.do("record.begin", channels=[2], period_ms=1000, take=True)["number"] == 2
    for seconds, is_kept in ((59, False), (1, True)):
        assert hand.installation.controller is not None
        hand.installation.controller.advance(2000 * seconds)
        hand.do("record.end")
        number = hand.station.records.data()["number"]
        if is_kept:
            error = hand.refused("record.begin", channels=[3])
            assert error["text"] == "a record of 60 s is kept: the new one drops it"
        else:
            assert hand.do("record.begin", channels=[3], period_ms=1000)["number"] == number + 1
            hand.installation.controller.advance(2000 * 59)
            hand.station.records.collect()


def test_a_channel_that_the_card_lacks_ends_no_record_that_is_kept(hand: HandStation) -> None:
    hand.do("record.begin", channels=[1])
    hand.run(0.1)
    hand.do("record.end")
    assert "P99999" in hand.refused("record.begin", channels=["P99999"])["text"]
    assert "channels" in hand.refused("record.begin", channels=[])["text"]
    record = hand.station.records.record
    assert record is not None and record.number == 1
    assert record.samples.samples(0, 1).shape == (1, 1)


def test_a_disk_that_is_full_ends_the_record_and_is_said(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(_self: Pyramid, _block: object) -> None:
        raise OSError(28, "No space left on device")

    hand.do("record.begin", channels=[1])
    monkeypatch.setattr(Pyramid, "append", full)
    hand.run(0.2)
    assert hand.station.records.data()["running"] is False
    said = [text for text in hand.said if "the record has ended" in text]
    assert said == ["the record has ended: [Errno 28] No space left on device"]
    assert "None" not in str(hand.station.records.data()["owner"])


def test_the_files_of_a_record_are_in_the_folder_of_the_panel(
    hand: HandStation, monkeypatch: pytest.MonkeyPatch
) -> None:
    folders: list[Path | None] = []
    plain = Pyramid.__init__

    def noted(self: Pyramid, channels: int, most: int, folder: Path | None = None) -> None:
        folders.append(folder)
        plain(self, channels, most, folder)

    monkeypatch.setattr(Pyramid, "__init__", noted)
    hand.do("record.begin", channels=[1])
    path = hand.installation.store.path
    assert path is not None
    assert folders == [path.parent]
    hand.do("record.end")


# --- over HTTP ------------------------------------------------------------------------

RNG = np.random.default_rng(1)
VALUES = np.cumsum(RNG.normal(size=(2, 5000)), axis=1)
VALUES[1, 100:200] = np.nan


@pytest.fixture
def url(kept_panel: Served) -> tuple[str, int]:
    """The address of the record with these values."""

    def put(station: Station) -> int:
        capture = [named("P1"), named("BIT516")]
        record = station.records.begin(1, capture, 0.001, take=True)
        station.records.end()
        record.samples = Pyramid(2, 1 << 24)
        record.samples.append(VALUES)
        return record.number

    return f"{kept_panel.url}/api/record", kept_panel.call(put)


def ask(url: tuple[str, int], path: str = "", **query: object) -> httpx.Response:
    return httpx.get(f"{url[0]}{path}", params={"number": url[1], **query}, timeout=60.0)  # type: ignore[dict-item]


@pytest.mark.parametrize(
    ("first", "last", "most"), [(0, 5000, 100), (10, 60, 100), (4990, 9000, 50), (0, 5000, 2)]
)
def test_a_part_comes_as_columns_cut_to_what_is_kept(
    url: tuple[str, int], first: int, last: int, most: int
) -> None:
    values = np.frombuffer(ask(url, "/view", first=first, last=last, most=most).content)
    begin, width, count, channels, kept, end = map(int, values[:6])
    assert (channels, kept, end) == (2, 0, 5000)
    blocks = values[6:].reshape(1 if width == 1 else 2, 2, count)
    for n in range(count):
        part = VALUES[:, begin + n * width : min(begin + (n + 1) * width, last)]
        np.testing.assert_array_equal(blocks[0][:, n], np.fmin.reduce(part, axis=1))
        np.testing.assert_array_equal(blocks[-1][:, n], np.fmax.reduce(part, axis=1))
    assert begin + count * width >= min(last, 5000)


def test_a_part_beyond_the_record_is_empty(url: tuple[str, int]) -> None:
    values = np.frombuffer(ask(url, "/view", first=5000, last=5100).content)
    assert values.tolist() == [5000, 1, 0, 2, 0, 5000]


def test_measures_and_values_of_a_part_are_those_of_its_samples(url: tuple[str, int]) -> None:
    found = ask(url, "/measures", first=90, last=150, at="95,150,5000").json()
    assert found["measures"][0] == pytest.approx({
        "count": 60, "min": VALUES[0, 90:150].min(), "max": VALUES[0, 90:150].max(),
        "mean": VALUES[0, 90:150].mean(), "rms": np.sqrt(np.mean(VALUES[0, 90:150] ** 2)),
    })  # fmt: skip
    assert found["measures"][1]["count"] == 10
    row = {"0": VALUES[0, 150], "1": None}
    assert found["at"] == [{"0": VALUES[0, 95], "1": VALUES[1, 95]}, row, {}]
    empty = ask(url, "/measures", first=110, last=120).json()["measures"][1]
    assert empty == {"count": 0, "min": None, "max": None, "mean": None, "rms": None}


def test_a_part_becomes_a_csv_file(url: tuple[str, int], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(calls, "AT_ONCE", 7)
    names = ["CH1 P1 [mm]", 'CH2 "a, b"']
    answer = ask(url, "/csv", first=95, last=115, names=json.dumps(names))
    assert answer.headers["content-disposition"].endswith(f'"record-{url[1]}-95-115.csv"')
    head, *rows = list(csv.reader(answer.text.splitlines()))
    assert head == ["time_s", *names]
    assert [float(row[0]) for row in rows] == [round(0.001 * n, 6) for n in range(20)]
    assert [float(row[1]) for row in rows] == VALUES[0, 95:115].tolist()
    assert [row[2] for row in rows[5:]] == [""] * 15


def test_a_part_becomes_a_parquet_file_of_the_same_columns(
    url: tuple[str, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(calls, "AT_ONCE", 7)
    names = ["CH1 P1 [mm]", "CH2"]
    answer = ask(url, "/parquet", first=95, last=115, names=json.dumps(names))
    assert answer.headers["content-disposition"].endswith(f'"record-{url[1]}-95-115.parquet"')
    found = parquet.read_table(io.BytesIO(answer.content))
    assert found.column_names == ["time_s", *names]
    assert found["time_s"].to_pylist() == pytest.approx([0.001 * n for n in range(20)])
    assert found["CH1 P1 [mm]"].to_pylist() == VALUES[0, 95:115].tolist()
    assert found["CH2"].to_pylist()[5:] == [None] * 15


@pytest.mark.parametrize(
    ("path", "query", "why"),
    [
        ("", {"number": 99}, "record 99 is not there any more"),
        ("/view", {"first": 0}, "Object missing required field `last`"),
        ("/csv", {"first": 0, "last": 9, "names": '["a"]'}, "1 names: the record has 2 channels"),
        ("/csv", {"first": 0, "last": 9, "names": "a"}, "names: a JSON list of texts is needed"),
        ("/parquet", {"first": 0, "last": 9, "names": '["a"]'}, "the record has 2 channels"),
        ("/parquet", {"first": 0, "last": 5001, "names": '["a", "b"]'}, "0 to 5000 are kept"),
        ("/csv", {"first": 0, "last": 5001, "names": '["a", "b"]'}, "0 to 5000 are kept"),
        ("/measures", {"first": 9, "last": 9}, "of this record 0 to 5000 are kept"),
    ],
)
def test_what_is_not_there_is_refused(
    url: tuple[str, int], path: str, query: dict[str, object], why: str
) -> None:
    answer = ask(url, path, **query)
    assert answer.status_code in (400, 422)
    assert why in answer.json()["error"]["text"]


def test_the_size_of_a_record_is_answered(url: tuple[str, int]) -> None:
    assert ask(url).json() == {
        "first": 0,
        "next": 5000,
        "bytes": 8 * 2 * (5000 + 5 * (312 + 19 + 1)),
    }
