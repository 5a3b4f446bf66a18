"""The tables that the files of codes fill."""

from openacr.cnc.codes.table import Table

ACROMILL = Table()
RS274NGC = Table()
