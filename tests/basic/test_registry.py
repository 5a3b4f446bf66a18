"""The command table: one row per command, everything else derived."""

import pickle

import pytest

import openacr.basic.commands  # noqa: F401 - enters the commands
from openacr.basic.language import registry
from openacr.basic.language.grammar import Num
from openacr.basic.language.registry import ANY, command
from openacr.basic.vm.run import Run


def test_every_command_says_what_it_does() -> None:
    for row in registry.commands():
        assert row.summary.endswith("."), row.name
        assert row.group, row.name


def test_a_name_is_entered_once() -> None:
    with pytest.raises(ValueError, match="DWL is registered twice"):
        command("DWL", group="", levels=ANY)(print)


def test_forms_of_fixed_words_give_the_handler_nothing() -> None:
    row = registry.find("FOR")
    assert len(row.grammar) == 6
    assert len(row.forms) == 4


def test_keywords_cover_commands_functions_and_variables() -> None:
    assert {"DWL", "SIN", "P", "$V", "MOD", "THEN", "LEFT$"} <= registry.keywords()
    assert "LET" not in registry.keywords()


def test_rows_pickle_by_name() -> None:
    assert pickle.loads(pickle.dumps(registry.find("DWL"))) is registry.find("DWL")
    assert pickle.loads(pickle.dumps(registry.functions["SIN"])) is registry.functions["SIN"]


def test_a_new_command_is_one_decorated_function(monkeypatch: pytest.MonkeyPatch) -> None:
    from tests.basic.parsing import parse_line

    from openacr.basic.language.nodes import Number, Statement
    from openacr.basic.language.scope import Scope

    monkeypatch.setattr(registry, "_commands", dict(registry._commands))
    monkeypatch.setattr(registry, "root", registry.Node(dict(registry.root.children)))

    @command("FROB # GENTLY", group="Test", levels=ANY, grammar=(Num("force"),), ref="none")
    def frob(run: Run, number: int, force: float) -> None:
        """Frobnicate."""

    statement = parse_line("FROB 3 GENTLY 0.5", Scope()).blocks[0][0]
    assert isinstance(statement, Statement)
    assert statement.indices == (Number(3),)
    assert statement.arguments == (Number(0.5),)
