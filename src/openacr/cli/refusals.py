"""Input errors of a command as JSON."""

import json
from collections.abc import Sequence
from typing import Any

from openacr.errors import OpenacrError, SourceError


def parts_of(error: OpenacrError) -> Sequence[OpenacrError]:
    """The single errors of a combined error."""
    return error.errors if isinstance(error, SourceError) else (error,)


def failed_json(errors: Sequence[OpenacrError]) -> str:
    """An object with `error`, the first sentence, and `errors`, each with its place.

    `path` is null and `line` and `column` are 0 where an error has no place.
    """
    record = {"error": str(errors[0]), "errors": [_record(error) for error in errors]}
    text = json.dumps(record, indent=2, ensure_ascii=False)
    return text.encode("utf-8", "replace").decode()


def _record(error: OpenacrError) -> dict[str, Any]:
    if not isinstance(error, SourceError):
        return {"path": None, "line": 0, "column": 0, "message": str(error), "hint": ""}
    return {
        "path": error.path or None,
        "line": error.line,
        "column": error.column,
        "message": error.text,
        "hint": error.hint,
    }
