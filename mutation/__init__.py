"""Mutation testing: break one place of the source, run its tests, see whether one fails.

`make mutate` explains itself with `python -m mutation --help`. A mutant is killed when a test
fails or does not end, and survives when all pass: then no test holds that place. The order of
work: `changes` (which lines), `operators` (what may be broken there), `reach` (which tests run a
line), `trial` (one mutant in a copy of the tree), `report`.
"""
