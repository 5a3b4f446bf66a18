"""Cases on cards of every model: those that a model cannot have are left out, the others agree."""

from functools import cache
from pathlib import Path

import pytest
from tests.conform.one_case import case_of

from openacr.client.links import ProcessLink
from openacr.conform import Case, report, run
from openacr.conform.campaign import chosen, on_card_in_use, on_virtual_card
from openacr.conform.facts import lacking, suited
from openacr.conform.host import HostCard
from openacr.conform.read import supplied
from openacr.controller import Controller
from openacr.errors import FaultyFileError
from openacr.models import MODELS

EVERY = 149  # case, beginning with another one for each model


@cache
def every_case() -> list[Case]:
    return chosen(supplied(), [])


@pytest.mark.parametrize("model", MODELS)
def test_a_sample_of_the_cases_agrees_with_a_card_of_each_model(model: str) -> None:
    """And all cases that are about models."""
    cases = every_case()
    first = 14 * list(MODELS).index(model)
    sample = [case for case in cases if case.needs or case.model] + cases[first::EVERY]
    found = list(on_virtual_card(sample, model))
    wrong = [report(each.case, each.difference) for each in found if each.difference]
    assert wrong == []
    counts = {name: sum(each.result == name for each in found) for name in ("agrees", "not run")}
    assert counts["agrees"] > 30
    assert counts["not run"] == 0


@pytest.mark.parametrize(
    ("needs", "has", "has_not"),
    [
        ("NURBs", "ACR8010", "ACR1500"),
        ("look-ahead", "ACR1200", "ACR1500"),
        ("user flash", "ACR1500", "ACR8000"),
        ("battery", "ACR8020", "ACR8010"),
        ("no battery", "ACR8010", "ACR1505"),
        ("at least 9 axes", "ACR8020", "ACR8010"),
        ("at least 16 axes", "ACR8020", "ACR8010"),
        ("at most 8 axes", "ACR8010", "ACR8020"),
        ("at most 15 axes", "ACR8010", "ACR8020"),
        ("at least 32 inputs", "ACR8010", "ACR2000"),
        ("at least 9 masters", "ACR1505", "ACR1500"),
        ("at least 1 commutators", "ACR8010", "ACR8000"),
        ("at least 20 encoders, user flash", "ACR8010", "ACR8000"),
        ("at most 16 analog inputs, at least 16 analog outputs, NURBs", "ACR8010", "ACR1500"),
    ],
)
def test_a_case_is_for_the_models_that_have_what_it_needs(
    needs: str, has: str, has_not: str, tmp_path: Path
) -> None:
    case = case_of(tmp_path, f"needs: {needs}\n> ?1\n1\n")
    (found,) = on_virtual_card([case], has)
    assert found.result == "agrees"
    (found,) = on_virtual_card([case], has_not)
    assert found.result == "not for this model"
    assert found.bar.endswith(f"not of the {has_not}")
    assert found.data()["why"] == found.bar
    assert lacking(case.needs, MODELS[suited(case.needs)]) == ""


def test_a_case_runs_by_default_on_a_model_that_has_what_it_needs(tmp_path: Path) -> None:
    assert run(case_of(tmp_path, "> VER\nACR9000 Version 1.18.06 Update 15\n")) is None
    text = "needs: at least 16 axes\n> VER\nACR8020 Version 1.18.06 Update 15\n"
    assert run(case_of(tmp_path, text)) is None
    assert run(case_of(tmp_path, f"needs:\n{text[24:]}")) is not None


def test_a_need_that_is_not_known_is_a_fault_of_the_file(tmp_path: Path) -> None:
    for text in ("wings", "at least axes", "at least 8 wheels", "NURBs user flash", "user flash,"):
        with pytest.raises(FaultyFileError) as caught:
            case_of(tmp_path, f"needs: {text}\n> ?1\n1\n")
        assert (
            f"needs: {text}: expected NURBs, look-ahead, user flash, battery, no battery, at"
            in str(caught.value)
        )


@pytest.mark.parametrize(
    ("machine", "model", "result"),
    [
        ("period_s = 0.001", "ACR8020", "agrees"),  # the model asked for
        ("period_s = 0.001", "ACR9000", "not for this model"),
        ('model = "ACR8020"', "ACR9000", "agrees"),
        ('model = "ACR9000"', "ACR8020", "not for this model"),
    ],
)
def test_the_model_is_that_of_the_machine_where_it_names_one(
    machine: str, model: str, result: str, tmp_path: Path
) -> None:
    text = f"machine:\n    [card]\n    {machine}\nneeds: at least 16 axes\n> VER\n"
    case = case_of(tmp_path, text + "ACR8020 Version 1.18.06 Update 15\n")
    (found,) = on_virtual_card([case], model)
    assert found.result == result


@pytest.mark.parametrize(
    ("about", "model", "result"),
    [
        ("needs: user flash", "ACR9000", "agrees"),
        ("needs: user flash", "ACR8000", "not for this model"),
        ("needs: user flash", "", "not run"),
        ("model: ACR9000", "ACR9000", "agrees"),
        ("model: ACR8020", "ACR9000", "not for this model"),
        ("model: ACR8020", "ACR7000", "not run"),
        ("moves:", "ACR7000", "agrees"),
    ],
)
def test_a_card_in_use_is_asked_what_its_model_has(
    about: str, model: str, result: str, tmp_path: Path
) -> None:
    link = ProcessLink(Controller())
    link.open()
    case = case_of(tmp_path, f"{about}\n> ?1\n1\n")
    (found,) = on_card_in_use([case], HostCard(link), model)
    assert found.result == result
