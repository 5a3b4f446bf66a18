"""Workflow, container and their page agree with the package; the start script brings both up."""

import os
import re
import shutil
import signal
import subprocess
import sys
import tomllib
import urllib.request
from pathlib import Path

import pytest
from typer.testing import CliRunner

from openacr.cli.main import app

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())
WORKFLOW = (ROOT / ".github" / "workflows" / "wheels.yml").read_text()
CONTAINER = (ROOT / "container" / "Containerfile").read_text()
START = ROOT / "container" / "start"
PAGE = (ROOT / "docs" / "releasing.md").read_text()


def test_wheels_are_built_for_every_python_the_package_names() -> None:
    named = {
        line.rsplit(" ", 1)[1]
        for line in PROJECT["project"]["classifiers"]
        if re.search(r":: 3\.\d+$", line)
    }
    built = PROJECT["tool"]["cibuildwheel"]["build"].split()
    assert {f"3.{each[3:5]}" for each in built} == named
    assert PROJECT["tool"]["cibuildwheel"]["environment"] == {"OPENACR_REQUIRE_EXT": "1"}


def test_wheels_are_built_on_every_system_and_the_tests_are_those_of_a_developer() -> None:
    runners = re.search(r"runner: \[(.*)\]", WORKFLOW)
    assert runners is not None
    systems = {each.split("-")[0] for each in runners[1].split(", ")}
    assert systems == {"ubuntu", "macos", "windows"}
    assert "ubuntu-24.04-arm" in runners[1]
    assert "- run: .ci/run\n" in WORKFLOW
    for line in re.findall(r"uses: (.*)", WORKFLOW):
        assert re.search(r"@v\d", line), line


def test_the_container_copies_what_the_build_reads_and_opens_the_ports_it_serves() -> None:
    copied = re.search(r"^COPY (pyproject.*) \./$", CONTAINER, re.MULTILINE)
    assert copied is not None
    folders = re.findall(r"^COPY (\w+) \1$", CONTAINER, re.MULTILINE)
    for name in (*copied[1].split(), *folders):
        assert (ROOT / name).exists(), name
    assert {"src", "examples", "parts", "conformance"} <= set(folders)
    assert "EXPOSE 5002 5006 5080\n" in CONTAINER
    ports = re.findall(r"_PORT:-(\d+)", START.read_text())
    assert ports == ["5002", "5006", "5080"]
    assert START.stat().st_mode & 0o111


@pytest.mark.parametrize("command", ["serve", "panel"])
def test_every_option_of_the_start_script_exists(command: str) -> None:
    text = START.read_text().replace("\\\n", " ")
    (line,) = re.findall(rf"^openacr {command} .*$", text, re.MULTILINE)
    shown = CliRunner().invoke(app, [command, "--help"], env={"COLUMNS": "200"}).stdout
    options = re.findall(r"--[a-z-]+", line)
    assert options
    for option in options:
        assert option in shown, option


def test_a_wheel_with_a_core_is_required_to_agree_with_plain_python() -> None:
    smoke = ROOT / "container" / "smoke.py"
    assert PROJECT["tool"]["cibuildwheel"]["test-command"].endswith("/container/smoke.py")
    found = subprocess.run(
        [sys.executable, str(smoke)], capture_output=True, text=True, check=False
    )
    _, compiled, first, _, pure, second = found.stdout.split()
    assert (pure, first) == ("False", second)
    assert found.returncode == int(compiled != "True")


@pytest.mark.skipif(shutil.which("sh") is None, reason="a script of POSIX")
def test_the_container_serves_card_and_panel_until_it_is_stopped(tmp_path: Path) -> None:
    environment = os.environ | {
        "PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}",
        "ACR_ADDRESS": "127.0.0.1", "ACR_DATA": str(tmp_path), "ACR_ASCII_PORT": "0",
        "ACR_BINARY_PORT": "0", "ACR_PANEL_PORT": "0",
    }  # fmt: skip
    with subprocess.Popen(
        ["sh", str(START)], env=environment, stdout=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        lines = sorted(process.stdout.readline() for _ in range(2))
        assert lines[0].startswith("listening ascii=127.0.0.1:")
        url = lines[1].removeprefix("panel ").strip()
        with urllib.request.urlopen(url, timeout=60) as page:
            assert page.status == 200
        process.send_signal(signal.SIGTERM)
        assert process.wait(60) == 0
    assert (tmp_path / "card").is_dir() and (tmp_path / "sysvar.db").exists()


def test_the_page_names_files_and_options_that_exist() -> None:
    for name in re.findall(r"`((?:\.github|container|web-bundle)/[\w./-]+)`", PAGE):
        assert (ROOT / name).exists(), name
    extras = re.search(r"whl\[([\w,]+)\]", PAGE)
    assert extras is not None
    assert set(extras[1].split(",")) == set(PROJECT["project"]["optional-dependencies"]) - {
        "dev", "site",
    }  # fmt: skip
