"""Scenarios: operator actions and machine events during a run, and expected results.

A scenario file holds timed or conditional operator actions (`[[at]]`) and expectations
(`[[expect]]`). It is checked completely before anything runs, played by the tick of the
card without any clock, and ends in one verdict per expectation.
"""

from openacr.scenario.judge import Verdict
from openacr.scenario.load import load_scenario, parse_scenario
from openacr.scenario.play import Play
from openacr.scenario.schema import Action, Condition, Expectation, Scenario, State
from openacr.scenario.world import World

__all__ = [
    "Action",
    "Condition",
    "Expectation",
    "Play",
    "Scenario",
    "State",
    "Verdict",
    "World",
    "load_scenario",
    "parse_scenario",
]
