"""Tests of machine programs: cards as pytest fixtures, conditions, golden traces, coverage."""
