"""What commands print beside plain lines: JSON, and tables of rich."""

import json

import typer


def print_json(content: object) -> None:
    """Print a record, or a list of them, for programs."""
    typer.echo(json.dumps(content, indent=2, ensure_ascii=False))


def print_rich(content: object) -> None:
    """Print a table or a text with a style, as wide as the terminal."""
    from rich.console import Console

    Console(highlight=False).print(content)
