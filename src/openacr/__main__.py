"""`python -m openacr`: the command line without its script."""

from openacr.cli.main import main

main()
