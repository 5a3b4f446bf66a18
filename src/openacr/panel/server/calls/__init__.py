"""The calls of `/api`, by theme; importing this package fills the table."""

from openacr.panel.server.calls import (  # noqa: F401
    ballscrew,
    card,
    commands,
    configure,
    forms,
    help,
    journals,
    lines,
    link,
    on_card,
    parts,
    pictures,
    programs,
    project,
    scope,
    session,
    texts,
    timeline,
    variables,
    world,
)
