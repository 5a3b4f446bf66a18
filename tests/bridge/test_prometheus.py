"""Metrics over HTTP, read with the parsers of the Prometheus client."""

import logging
from collections.abc import Iterator
from pathlib import Path

import httpx
import pytest
from prometheus_client.openmetrics.parser import text_string_to_metric_families as open_metrics
from prometheus_client.parser import text_string_to_metric_families
from tests.bridge.bench import VALUES, GivenFeed, bridged, url
from tests.waiting import LIMIT_S, until

from openacr.bridge import web
from openacr.errors import UserError
from openacr.io.bounded_log import LINES, Bounded

Samples = dict[tuple[str, str], float]
FILE = 'name = "mill"\nrate_hz = 50\n[prometheus]\nport = 0\n' + VALUES


def samples(text: str) -> Samples:
    """Values by the name of the metric and its labels without the machine."""
    found = {}
    for family in text_string_to_metric_families(text):
        for sample in family.samples:
            labels = dict(sample.labels)
            assert labels.pop("machine") == "mill"
            found[sample.name, ",".join(labels.values())] = sample.value
    return found


@pytest.fixture
def feed() -> GivenFeed:
    return GivenFeed()


@pytest.fixture
def metrics(feed: GivenFeed) -> Iterator[str]:
    with bridged(FILE, feed) as bridge:
        yield url(bridge, "prometheus")


def scraped(metrics: str) -> Samples:
    return samples(httpx.get(metrics, timeout=LIMIT_S).text)


def test_every_value_is_a_metric_with_its_unit(metrics: str) -> None:
    until(lambda: scraped(metrics))
    assert scraped(metrics) == {
        ("openacr_available", ""): 1.0,
        ("openacr_execution", "ACTIVE"): 1.0,
        ("openacr_mode", "AUTOMATIC"): 1.0,
        ("openacr_emergency_stop", "ARMED"): 1.0,
        ("openacr_state", "RUN"): 1.0,
        ("openacr_program", "plate.nc"): 1.0,
        ("openacr_line", ""): 12.0,
        ("openacr_block", "G1 X1"): 1.0,
        ("openacr_work_system", "G54"): 1.0,
        ("openacr_tool", ""): 3.0,
        ("openacr_tools", "3,diameter 6 mm, length 50.25 mm, flat"): 1.0,
        ("openacr_tools", "12,length -7.5 mm, ball"): 1.0,
        ("openacr_parts", ""): 4.0,
        ("openacr_run_time_seconds", ""): 12.5,
        ("openacr_moving", ""): 1.0,
        ("openacr_path_speed_mm_per_second", ""): 2.0,
        ("openacr_feed_mm_per_second", ""): 2.0,
        ("openacr_feed_override_percent", ""): 80.0,
        ("openacr_rapid_override_percent", ""): 100.0,
        ("openacr_spindle_speed_rpm", ""): 900.0,
        ("openacr_spindle_override_percent", ""): 100.0,
        ("openacr_spindle_on", ""): 1.0,
        **{
            (f"openacr_{name}", ""): 0.0
            for name in ("flood", "mist", "dry_run", "single_block", "barred")
        },
        ("openacr_message", "DOOR / COOLANT LOW"): 1.0,
        ("openacr_alarms", "34,X: drive is off"): 1.0,
        ("openacr_axis_actual_mm", "X"): 1.5,
        ("openacr_axis_actual_mm", "Y"): -2.0,
        ("openacr_axis_actual_degrees", "C"): 90.25,
        ("openacr_axis_commanded_mm", "X"): 1.0,
        ("openacr_axis_commanded_mm", "Y"): 2.0,
        ("openacr_axis_commanded_degrees", "C"): 90.0,
        ("openacr_axis_following_error_mm", "X"): 0.5,
        ("openacr_axis_following_error_mm", "Y"): 0.0,
        ("openacr_axis_following_error_degrees", "C"): 0.25,
        ("openacr_axis_work_mm", "X"): 11.0,
        ("openacr_axis_work_mm", "Y"): 12.0,
        ("openacr_axis_work_degrees", "C"): 90.0,
        ("openacr_axis_to_go_mm", "X"): 0.0,
        ("openacr_axis_to_go_mm", "Y"): 1.0,
        ("openacr_axis_to_go_degrees", "C"): 2.0,
        **{("openacr_axis_homed", axis): on for axis, on in zip("XYC", (1, 0, 1), strict=True)},
        **{("openacr_axis_jogging", axis): 0.0 for axis in "XYC"},
        ("openacr_user_pulses", ""): 400.0,
        ("openacr_user_gate", ""): 1.0,
    }


def test_values_that_are_not_known_have_no_sample_and_come_back(
    metrics: str, feed: GivenFeed
) -> None:
    known = feed.moment
    feed.lose()
    until(lambda: scraped(metrics).get(("openacr_available", "")) == 0.0)
    assert set(scraped(metrics)) == {
        ("openacr_available", ""),
        ("openacr_alarms", "34,X: drive is off"),
    }
    feed.moment = known
    until(lambda: ("openacr_line", "") in scraped(metrics))


def test_open_metrics_are_given_where_they_are_asked_for(metrics: str) -> None:
    asked = {"accept": "application/openmetrics-text; version=1.0.0"}
    until(lambda: scraped(metrics))
    answer = httpx.get(metrics, headers=asked, timeout=LIMIT_S)
    assert answer.headers["content-type"].startswith("application/openmetrics-text")
    found = open_metrics(answer.text)  # type: ignore[no-untyped-call]
    names = {family.name for family in found}
    assert {"openacr_line", "openacr_axis_actual_mm"} <= names


def test_meaning_and_unit_are_the_help_of_a_metric(metrics: str) -> None:
    until(lambda: scraped(metrics))
    text = httpx.get(metrics, timeout=LIMIT_S).text
    assert "# HELP openacr_feed_mm_per_second programmed feed [MILLIMETER/SECOND]\n" in text
    assert "# HELP openacr_user_pulses encoder of X [pulses]\n" in text


def test_the_parameters_of_chosen_values_are_watched_once_each(
    metrics: str, feed: GivenFeed
) -> None:
    assert feed.watched == [12290, 4096]


def test_nothing_can_be_changed(metrics: str) -> None:
    assert httpx.post(metrics, timeout=LIMIT_S).status_code == 405
    assert httpx.get(metrics.removesuffix("metrics"), timeout=LIMIT_S).status_code == 404


def test_a_name_that_a_page_of_any_site_could_use_is_refused(metrics: str) -> None:
    answer = httpx.get(metrics, headers={"host": "evil.example"}, timeout=LIMIT_S)
    assert answer.status_code == 403


@pytest.mark.parametrize(
    "given", [None, ("openacr", "wrong"), ("other", "hush"), ("openacr", ""), ("", "")]
)
def test_a_password_that_is_set_has_to_be_given(
    given: tuple[str, str] | None, tmp_path: Path
) -> None:
    (tmp_path / "secret").write_text("hush\n")
    text = FILE.replace("port = 0\n", 'port = 0\npassword_file = "secret"\n')
    with bridged(text, GivenFeed(), tmp_path) as bridge:
        place = url(bridge, "prometheus")
        refused = httpx.get(place, auth=given, timeout=LIMIT_S)
        assert (refused.status_code, refused.text) == (401, "a password is needed\n")
        assert refused.headers["www-authenticate"].startswith("Basic ")
        for scheme in ("Bearer aHVzaA==", "Basic ###", "Basic"):
            headers = {"authorization": scheme}
            assert httpx.get(place, headers=headers, timeout=LIMIT_S).status_code == 401
        admitted = httpx.get(place, auth=("openacr", "hush"), timeout=LIMIT_S)
        assert admitted.status_code == 200


def test_wrong_passwords_are_slowed_and_the_right_one_ends_that(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    now_s = 100.0
    monkeypatch.setattr("openacr.bridge.web.clock_s", lambda: now_s)
    (tmp_path / "secret").write_text("hush\n")
    text = FILE.replace("port = 0\n", 'port = 0\npassword_file = "secret"\n')
    with bridged(text, GivenFeed(), tmp_path) as bridge:

        def asked(secret: str) -> tuple[int, str | None]:
            auth = ("openacr", secret)
            answer = httpx.get(url(bridge, "prometheus"), auth=auth, timeout=LIMIT_S)
            return answer.status_code, answer.headers.get("retry-after")

        assert [asked("wrong") for _ in range(3)] == [(401, None)] * 3
        assert asked("hush") == (429, "1")
        answer = httpx.get(url(bridge, "prometheus"), timeout=LIMIT_S)
        assert answer.text == "too many wrong passwords: wait 1 s\n"
        now_s = 101.0
        assert asked("wrong") == (401, None)
        now_s = 101.5
        assert asked("hush") == (429, "2")
        now_s = 103.0
        assert asked("hush") == (200, None)
        assert [asked("wrong") for _ in range(2)] == [(401, None)] * 2
        assert asked("hush") == (200, None)
    said = [r.getMessage() for r in caplog.records if r.name == "openacr.bridge.web"]
    assert said == [f"wrong password from 127.0.0.1 ({k})" for k in (1, 2, 3, 4, 1, 2)]


def test_a_request_without_a_password_is_no_wrong_one(tmp_path: Path) -> None:
    (tmp_path / "secret").write_text("hush\n")
    text = FILE.replace("port = 0\n", 'port = 0\npassword_file = "secret"\n')
    with bridged(text, GivenFeed(), tmp_path) as bridge:
        place = url(bridge, "prometheus")
        found = [httpx.get(place, timeout=LIMIT_S).status_code for _ in range(4)]
        assert found == [401] * 4


def test_a_port_in_use_is_said_and_nothing_is_left_running(metrics: str) -> None:
    port = metrics.split(":")[2].split("/")[0]
    text = FILE.replace("port = 0", f"port = {port}")
    with (
        pytest.raises(UserError) as refused,
        bridged(text, GivenFeed()),
    ):
        pass
    assert str(refused.value) == (
        f"port {port} on 127.0.0.1 is in use (is it running already?); choose another one with"
        " port = N in [prometheus], 0 picks a free one"
    )


def test_one_scraper_that_reads_nothing_does_not_keep_another_one_waiting(metrics: str) -> None:
    import socket

    host, port = metrics.removeprefix("http://").split("/")[0].split(":")
    with socket.create_connection((host, int(port))) as silent:
        silent.sendall(b"GET /metrics HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n" * 20)
        until(lambda: scraped(metrics))


def test_connections_that_are_refused_do_not_fill_the_log(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.setattr(web, "MOST_CONNECTIONS", 1)
    server_log = logging.getLogger(web.SERVER_LOG)
    for each in [one for one in server_log.filters if isinstance(one, Bounded)]:
        server_log.removeFilter(each)  # it counts what other tests have logged
    with bridged(FILE, GivenFeed()) as bridge:
        answers = [httpx.get(url(bridge, "prometheus")).status_code for _ in range(LINES + 3)]
    assert answers == [503] * (LINES + 3)
    assert sum("concurrency" in each.getMessage() for each in caplog.records) == LINES
