"""The script of the extension, run by Node with a stand-in for the editor."""

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import playwright
from tests.editors.textmate import FOLDER

NODE = (
    Path(playwright.__file__).parent
    / "driver"
    / ("node.exe" if sys.platform == "win32" else "node")
)
STAND_IN = """
const Module = require("node:module");
const [script, path, configuration] = process.argv.slice(1);
const shown = [];
let provider;
const nothing = { get: () => () => ({}) };
const vscode = {
  workspace: {
    getConfiguration: () => ({ get: (name) => (name === "path" ? path : "") }),
    onDidChangeConfiguration: () => ({}),
  },
  window: { showErrorMessage: (text) => shown.push(text) },
  commands: new Proxy({}, nothing),
  debug: {
    registerDebugAdapterDescriptorFactory: () => ({}),
    registerDebugConfigurationProvider: (_type, given) => (provider = given),
  },
};
class LanguageClient { async start() {} }
const load = Module._load;
Module._load = (name, ...rest) =>
  name === "vscode" ? vscode
  : name === "vscode-languageclient/node" ? { LanguageClient }
  : load(name, ...rest);
require(script)
  .activate({ subscriptions: [] })
  .then(() => provider.resolveDebugConfiguration(undefined, JSON.parse(configuration)))
  .then((resolved) => console.log(JSON.stringify({ resolved: resolved ?? null, shown })));
"""
LAUNCH = {"type": "openacr", "request": "launch", "name": "Project", "program": "shop"}


def resolved(path: str, configuration: dict[str, str]) -> dict[str, Any]:
    """What F5 starts with a setting `openacr.path`, and the messages shown before."""
    words = [
        str(NODE),
        "-e",
        STAND_IN,
        str(FOLDER / "extension.js"),
        path,
        json.dumps(configuration),
    ]
    done = subprocess.run(words, capture_output=True, text=True, timeout=60, check=True)
    found: dict[str, Any] = json.loads(done.stdout)
    return found


def test_a_debugger_that_starts_is_started_with_the_configuration_as_it_is() -> None:
    assert resolved(sys.executable, LAUNCH) == {"resolved": LAUNCH, "shown": []}


def test_a_wrong_path_of_openacr_is_reported_and_starts_no_session(tmp_path: Path) -> None:
    missing = str(tmp_path / "openacr")
    reason = f"openacr: the debugger does not start: spawn {missing} ENOENT."
    assert resolved(missing, LAUNCH) == {
        "resolved": None,
        "shown": [f"{reason} Is the setting openacr.path its path?"],
    }


def test_f5_without_a_file_asks_for_one_and_for_nothing_else(tmp_path: Path) -> None:
    languages = "acrobasic, acroplc, rs274"
    assert resolved(str(tmp_path / "openacr"), {}) == {
        "resolved": None,
        "shown": [f"openacr: open a file of {languages} first."],
    }
