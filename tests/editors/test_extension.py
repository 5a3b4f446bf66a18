"""The extension for Visual Studio Code claims what is there: files, commands, attributes."""

import json
import re
import shutil
from pathlib import Path
from typing import Any

import msgspec
import pytest
from tests.editors.textmate import FOLDER
from typer.testing import CliRunner

from openacr.cli.main import app
from openacr.debugger import requests
from openacr.editing.engine import Engine
from openacr.editing.languages import CONTROLLER_NAMES, CONTROLLER_SUFFIX

ROOT = FOLDER.parents[1]
PACKAGE: dict[str, Any] = json.loads((FOLDER / "package.json").read_text(encoding="utf-8"))
CLAIMS = PACKAGE["contributes"]
SCRIPT = (FOLDER / "extension.js").read_text(encoding="utf-8")
LANGUAGES = [each["id"] for each in CLAIMS["languages"]]
(DEBUGGER,) = CLAIMS["debuggers"]
LAUNCH: dict[str, Any] = DEBUGGER["configurationAttributes"]["launch"]["properties"]


def paths(value: object) -> list[str]:
    """All relative paths of a claim."""
    if isinstance(value, str):
        return [value] if value.startswith("./") else []
    inner = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    return [path for each in inner for path in paths(each)]


def test_every_file_that_is_named_is_there_and_the_version_is_that_of_the_package() -> None:
    named = {PACKAGE["main"], *paths(CLAIMS)}
    assert len(named) == 9
    assert [name for name in named if not (FOLDER / name).is_file()] == []
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert f'\nversion = "{PACKAGE["version"]}"\n' in project
    assert f"openacr-{PACKAGE['version']}.vsix" in (FOLDER / "README.md").read_text("utf-8")


def test_the_languages_are_those_the_server_knows_and_txt_is_left_alone() -> None:
    assert LANGUAGES == ["acrobasic", "acroplc", "rs274"]
    assert set(LANGUAGES) & CONTROLLER_NAMES == {"acrobasic", "acroplc"}
    suffixes = {each["id"]: each.get("extensions", []) for each in CLAIMS["languages"]}
    assert suffixes == {"acrobasic": [CONTROLLER_SUFFIX], "acroplc": [], "rs274": [".nc", ".ngc"]}
    assert CLAIMS["languages"][1]["filenamePatterns"] == ["plc[0-7].8k"]
    assert 'CONTROLLER = ["acrobasic", "acroplc"]' in SCRIPT
    assert 'LANGUAGES = [...CONTROLLER, "rs274"]' in SCRIPT
    assert {f"onLanguage:{name}" for name in LANGUAGES} <= set(PACKAGE["activationEvents"])
    assert [each["language"] for each in CLAIMS["snippets"]] == LANGUAGES


def test_every_grammar_has_the_scope_that_its_claim_names() -> None:
    assert [each["language"] for each in CLAIMS["grammars"]] == LANGUAGES
    for claim in CLAIMS["grammars"]:
        grammar = json.loads((FOLDER / claim["path"]).read_text(encoding="utf-8"))
        assert grammar["scopeName"] == claim["scopeName"] == f"source.{claim['language']}"


def test_commands_of_the_palette_are_those_the_script_registers() -> None:
    claimed = [each["command"] for each in CLAIMS["commands"]]
    assert re.findall(r'registerCommand\("([\w.]+)", \w+\)', SCRIPT) == claimed
    limited = {each["command"] for each in CLAIMS["menus"]["commandPalette"]}
    assert limited == set(claimed) - {"openacr.restartServer"}


def test_settings_are_those_the_script_reads_and_no_other() -> None:
    claimed = set(CLAIMS["configuration"]["properties"])
    read = set(re.findall(r'setting\("(\w+)"', SCRIPT))
    read |= set(re.findall(r'"(\w+)"', re.findall(r"of \[(.*?)\]", SCRIPT)[0]))
    assert {f"openacr.{name}" for name in read} == claimed
    assert CLAIMS["configuration"]["properties"]["openacr.path"]["default"] == "openacr"


@pytest.mark.parametrize(
    ("words", "options"),
    [
        (("lsp",), {"--store", "--dialect"}),
        (("debug",), set()),
        (("check",), set()),
        (("run",), {"--plot"}),
        (("mill", "check"), {"--store", "--dialect"}),
        (("mill", "plot"), {"--store", "--dialect"}),
    ],
)
def test_commands_of_openacr_that_the_script_calls_have_their_options(
    words: tuple[str, ...], options: set[str]
) -> None:
    result = CliRunner().invoke(app, [*words, "--help"])
    assert result.exit_code == 0
    assert options <= set(re.findall(r"^  (--\w+)", result.output, re.MULTILINE))
    assert "[" + ", ".join(f'"{word}"' for word in words) in SCRIPT


def test_a_launch_takes_exactly_the_attributes_of_the_debugger() -> None:
    schema = msgspec.json.schema(requests.Launch)
    expected = schema["$defs"]["Launch"]["properties"]
    described = {
        name: {key: value for key, value in each.items() if key != "description"}
        for name, each in LAUNCH.items()
    }
    described["program"]["default"] = ""  # of the server: the folder is the editor's
    assert described == expected


def test_every_offered_configuration_is_one_the_debugger_takes() -> None:
    offered = [
        *DEBUGGER["initialConfigurations"],
        *(each["body"] for each in DEBUGGER["configurationSnippets"]),
    ]
    assert len(offered) == 4
    for each in offered:
        assert (
            (each["type"], each["request"]) == (DEBUGGER["type"], "launch") == ("openacr", "launch")
        )
        own = {
            name: value for name, value in each.items() if name not in ("type", "request", "name")
        }
        assert set(own) <= set(LAUNCH)
        assert len({"program", "journal", "partProgram"} & set(own)) == 1
        msgspec.convert(own, requests.Launch)


def test_the_attributes_are_those_of_the_page() -> None:
    page = (ROOT / "docs" / "debugging.md").read_text(encoding="utf-8")
    table = page.partition("A launch takes these arguments:")[2].partition("\n\n")[2]
    rows = re.findall(r"^\| `(\w+)`", table.partition("\n\n")[0], re.MULTILINE)
    assert rows == list(LAUNCH)


def test_the_debugger_is_the_one_that_the_script_starts() -> None:
    assert 'registerDebugAdapterDescriptorFactory("openacr"' in SCRIPT
    assert 'new vscode.DebugAdapterExecutable(command, ["debug"])' in SCRIPT
    assert [each["language"] for each in CLAIMS["breakpoints"]] == ["acrobasic", "rs274"]
    assert DEBUGGER["languages"] == ["acrobasic", "acroplc", "rs274"]


def test_the_only_package_needed_is_the_language_client() -> None:
    assert list(PACKAGE["dependencies"]) == ["vscode-languageclient"]
    assert "devDependencies" not in PACKAGE
    needed = set(re.findall(r'require\("([^"]+)"\)', SCRIPT))
    assert needed == {
        "node:child_process",
        "node:path",
        "vscode",
        "vscode-languageclient/node",
    }


# problems

PATTERN: dict[str, Any] = CLAIMS["problemMatchers"][0]["pattern"]
NO_BOARD = "no modelled card has an ETHERNET Powerlink board: BIT16648 stays clear"
PROBLEM = re.compile(PATTERN["regexp"])


def problems(*words: object) -> list[tuple[str, ...]]:
    """Line, column, severity and text of what the editor lists of the output of a command."""
    shown = CliRunner().invoke(app, [str(word) for word in words]).output
    keys = ("file", "line", "column", "severity", "message")
    hits = [hit for line in shown.splitlines() if (hit := PROBLEM.match(line))]
    found = [tuple(hit[PATTERN[key]] or "" for key in keys) for hit in hits]
    assert {path for path, *_ in found} <= {str(words[-1])}
    return [tuple(rest) for _, *rest in found]


def test_findings_of_controller_files_are_problems(tmp_path: Path) -> None:
    path = tmp_path / "prog0.8k"
    path.write_text("PROGRAM\nFOO\nEPLC ON\nENDP\n")
    assert problems("check", path) == [
        ("2", "1", "", "Unknown command (did you mean FLOOR?)"),
        ("3", "1", "warning", NO_BOARD),
    ]
    assert "$openacr" in SCRIPT


def test_errors_and_warnings_of_part_programs_are_problems(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G20 G90\nG1 X2\nG999\n")
    assert problems("mill", "check", "--dialect", "acromill", path) == [
        ("2", "4", "W", "W218 motion with no F and no start feed chosen"),
        ("3", "1", "", "E203 unknown G code: G999"),
    ]


# snippets and files


def expanded(body: list[str]) -> str:
    """A snippet with its proposals in place, nothing typed."""
    return "\n".join(re.sub(r"\$\{\d+:([^}]*)\}|\$0", r"\1", line) for line in body) + "\n"


SNIPPETS = [
    (claim["language"], name, each)
    for claim in CLAIMS["snippets"]
    for name, each in json.loads((FOLDER / claim["path"]).read_text("utf-8")).items()
]
FILES = {
    "acrobasic": "gantry/prog0.8k",
    "acroplc": "plc_excess_error/plc0.8k",
    "rs274": "gantry/part.nc",
}


@pytest.mark.parametrize(("language", "name", "snippet"), SNIPPETS)
def test_a_snippet_is_free_of_errors(
    language: str, name: str, snippet: dict[str, Any], tmp_path: Path
) -> None:
    path = tmp_path / FILES[language]
    shutil.copytree(ROOT / "examples" / path.parent.name, path.parent)
    text = expanded(snippet["body"])
    is_framed = language == "rs274" or name == "Program"
    engine = Engine(dialect="acromill")
    engine.open(path, text if is_framed else f"PROGRAM\n{text}ENDP\n", language)
    found = engine.findings(engine.subject(path))[path]
    assert [each.message for each in found if not each.is_warning] == []
    assert snippet["description"]
    assert (
        snippet["prefix"] in name.lower() or snippet["prefix"] in expanded(snippet["body"]).lower()
    )


@pytest.mark.parametrize("name", ["controller", "part-program"])
def test_the_configuration_of_a_language_has_its_comments_and_words(name: str) -> None:
    found = json.loads((FOLDER / "languages" / f"{name}.json").read_text("utf-8"))
    words = re.compile(found["wordPattern"])
    lines = {
        "controller": ("'", "JOG VEL _Head CHR$ #DEFINE 1.5"),
        "part-program": (";", "G38.2 X1 #<safe> N10 1.5 SIN"),
    }
    mark, line = lines[name]
    assert found["comments"]["lineComment"] == mark
    assert words.findall(line) == line.split()
