"""Turn messages about wrong values of a TOML file into ones that name the permitted values."""

from collections.abc import Iterator
from difflib import get_close_matches
from typing import Any

from msgspec import inspect

from openacr.plant.describe import locate, toml_file
from openacr.plant.describe.complaint import Complaint


def not_finite(raw: dict[str, Any]) -> Iterator[Complaint]:
    """The infinities and NaN of a file, by name."""
    for path in toml_file.not_finite(raw):
        what = f"{_name(path)} is {_value(path, raw)}; it must be a finite number"
        yield Complaint(path, what)


def explain(message: str, raw: dict[str, Any], kind: type) -> Complaint:
    """A message of the converter to `kind` as one that names key, value and permitted values."""
    reason, path = toml_file.complaint_of(message)
    if unknown := toml_file.UNKNOWN.fullmatch(reason):
        return _unknown_key(path, unknown[1], raw, kind)
    if missing := toml_file.MISSING.fullmatch(reason):
        text = f"{_table(path)} lacks the key {missing[1]!r}"
        return Complaint(path, text, _keys(path, raw, kind))
    value = _value(path, raw)
    shown = "a table" if isinstance(value, dict) else f"{_toml(value)}"
    return Complaint(path, f"{_name(path)} is {shown}; it must be {_allowed(path, raw, kind)}")


def _unknown_key(path: locate.Path, key: str, raw: dict[str, Any], root: type) -> Complaint:
    known = _known_keys(path, raw, root)
    close = get_close_matches(key, known, 1)
    hint = f"did you mean {close[0]!r}?" if close else _keys(path, raw, root)
    return Complaint((*path, key), f"unknown key {key!r} in {_table(path)}", hint)


def _keys(path: locate.Path, raw: dict[str, Any], root: type) -> str:
    return "known keys: " + ", ".join(_known_keys(path, raw, root))


def _known_keys(path: locate.Path, raw: dict[str, Any], root: type) -> list[str]:
    kind = _type_at(path, raw, root)
    if isinstance(kind, inspect.UnionType):
        return ["mode"]
    if not isinstance(kind, inspect.StructType):
        return []
    tag = [kind.tag_field] if kind.tag_field else []
    return [*tag, *(field.encode_name for field in kind.fields)]


def _table(path: locate.Path) -> str:
    """Show a table as it is headed in the file: [axis.motor]."""
    keys = [part for part in path if isinstance(part, str)]
    return f"[{'.'.join(keys)}]" if keys else "the file"


def _name(path: locate.Path) -> str:
    """Name of a key with its table, list positions as in `travel[0]`."""
    name = ""
    for part in path:
        name += f"[{part}]" if isinstance(part, int) else f".{part}"
    return name.removeprefix(".")


def _value(path: locate.Path, raw: Any) -> Any:
    for part in path:
        raw = raw[part]
    return raw


def _toml(value: object) -> str:
    """Show a value as it is written in the file."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list):
        return f"[{', '.join(_toml(inner) for inner in value)}]"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _type_at(path: locate.Path, raw: Any, root: type) -> inspect.Type:
    """Walk the schema along `path`; the file itself decides between the kinds of drive."""
    kind: inspect.Type = _plain(inspect.type_info(root), raw)
    for part in path:
        raw = raw[part]
        kind = _plain(_inner(kind, part), raw)
    return kind


def _inner(kind: inspect.Type, part: str | int) -> inspect.Type:
    if isinstance(kind, inspect.StructType):
        return next((f.type for f in kind.fields if f.encode_name == part), inspect.StrType())
    if isinstance(kind, inspect.VarTupleType | inspect.ListType):
        return kind.item_type
    if isinstance(kind, inspect.TupleType) and isinstance(part, int):
        return kind.item_types[part]
    return kind


def _plain(kind: inspect.Type, raw: Any) -> inspect.Type:
    """Remove the `None` of optional keys and choose the kind of drive by its mode."""
    if not isinstance(kind, inspect.UnionType):
        return kind
    kinds = [one for one in kind.types if not isinstance(one, inspect.NoneType)]
    if len(kinds) == 1:
        return kinds[0]
    mode = raw.get("mode") if isinstance(raw, dict) else None
    return next((k for k in kinds if isinstance(k, inspect.StructType) and k.tag == mode), kind)


def _allowed(path: locate.Path, raw: dict[str, Any], root: type) -> str:
    """Describe in words the values permitted at `path`."""
    if path[-1:] == ("mode",) and path[-2:] != ("bus", "mode"):
        return 'one of "torque", "velocity", "ideal", "phases", "stepper", "exact"'
    return _words(_type_at(path, raw, root))


def _words(kind: inspect.Type) -> str:
    if isinstance(kind, inspect.IntType):
        return f"a whole number from {kind.ge} to {kind.le}" if kind.le is not None else "a number"
    if isinstance(kind, inspect.FloatType):
        if kind.le is None:
            bound = kind.gt if kind.ge is None else kind.ge
            low = "from" if kind.gt is None else "above"
            return "a number" if bound is None else f"a number {low} {bound:g}"
        low = f"above {kind.gt:g}" if kind.gt is not None else f"from {kind.ge:g}"
        return f"a number {low} to {kind.le:g}"
    if isinstance(kind, inspect.EnumType):
        return "one of " + ", ".join(_toml(member.value) for member in kind.cls)
    if isinstance(kind, inspect.Metadata):
        return str((kind.extra_json_schema or {}).get("description") or _words(kind.type))
    if isinstance(kind, inspect.StrType):
        return f"a text in quotes{_form(kind)}"
    if isinstance(kind, inspect.TupleType):
        return f"a list of {len(kind.item_types)} values, each {_words(kind.item_types[0])}"
    if isinstance(kind, inspect.VarTupleType | inspect.ListType):
        if isinstance(kind.item_type, inspect.StructType):
            return "a list of tables"
        size = f" of {kind.min_length} to {kind.max_length}" if kind.max_length else " of"
        return f"a list{size} values, each {_words(kind.item_type)}"
    if isinstance(kind, inspect.UnionType):
        return " or ".join(map(_words, kind.types))
    if isinstance(kind, inspect.DictType):
        return f"a table of axes, each {_words(kind.value_type)}"
    return "a table"


def _form(kind: inspect.StrType) -> str:
    """What a text has to be, where not any text will do."""
    if kind.pattern is not None:
        return f" of the form {kind.pattern}"
    if kind.max_length is not None:
        return f" of {kind.min_length or 0} to {kind.max_length} characters"
    return ""
