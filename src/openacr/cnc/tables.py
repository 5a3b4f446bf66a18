"""The tables that the files of codes fill."""

from openacr.cnc.codes import Table

ACROMILL = Table()
RS274NGC = Table()
