"""Places, spans and names of kinds as the protocol has them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING
from urllib.parse import quote, unquote

from lsprotocol import types
from pygls.uris import from_fs_path, to_fs_path

from openacr.editing.document import Document, Edit, Place, Span
from openacr.editing.marks import Kind

if TYPE_CHECKING:
    from openacr.editing.completions import Completion, Item
    from openacr.editing.engine import Colored
    from openacr.editing.outlines import Entry
    from openacr.editing.symbols import Finding
    from openacr.language_server.found import Found

NO_FILES = Path("/no-file")  # where texts without a file would be
SOURCE = "openacr"
ITEM_KINDS = {
    Kind.COMMAND: types.CompletionItemKind.Keyword,
    Kind.KEYWORD: types.CompletionItemKind.Operator,
    Kind.FUNCTION: types.CompletionItemKind.Function,
    Kind.CODE: types.CompletionItemKind.Method,
    Kind.WORD: types.CompletionItemKind.Property,
    Kind.PARAMETER: types.CompletionItemKind.Field,
    Kind.FLAG: types.CompletionItemKind.EnumMember,
    Kind.AXIS: types.CompletionItemKind.Struct,
    Kind.ALIAS: types.CompletionItemKind.Constant,
    Kind.LABEL: types.CompletionItemKind.Reference,
    Kind.ROUTINE: types.CompletionItemKind.Module,
    Kind.NAMED: types.CompletionItemKind.Variable,
}
SYMBOL_KINDS = {
    Kind.LABEL: types.SymbolKind.Key,
    Kind.ALIAS: types.SymbolKind.Constant,
    Kind.ROUTINE: types.SymbolKind.Function,
}
TOKENS = {
    Kind.COMMAND: "keyword",
    Kind.KEYWORD: "keyword",
    Kind.FUNCTION: "function",
    Kind.OPERATOR: "operator",
    Kind.CODE: "method",
    Kind.WORD: "property",
    Kind.PARAMETER: "parameter",
    Kind.CELL: "parameter",
    Kind.FLAG: "enumMember",
    Kind.VARIABLE: "variable",
    Kind.NAMED: "variable",
    Kind.AXIS: "class",
    Kind.ALIAS: "macro",
    Kind.LABEL: "label",
    Kind.ROUTINE: "namespace",
    Kind.NUMBER: "number",
    Kind.STRING: "string",
    Kind.REMARK: "comment",
}
TOKEN_TYPES = list(dict.fromkeys(TOKENS.values()))
TOKEN_MODIFIERS = ["definition"]
_TOKEN_NUMBERS = {kind: TOKEN_TYPES.index(name) for kind, name in TOKENS.items()}


def path_of(uri: str) -> Path:
    """The path of a document; one without a file gets a path where no file is."""
    found = to_fs_path(uri) if uri.startswith("file:") else None
    return Path(found) if found else NO_FILES / unquote(uri).replace("/", "_")


def uri_of(path: Path) -> str:
    """The URI of a file."""
    return from_fs_path(str(path)) or quote(str(path))


class Columns:
    """Columns of lines in the unit a client and the server have agreed on."""

    def __init__(self, width: Callable[[str], int]) -> None:
        self._width = width

    def of(self, document: Document, place: Place) -> types.Position:
        """The position of a place; beyond the text it is the last one of it."""
        place = document.nearest(place)
        text = document.lines[place.line][: place.column]
        return types.Position(place.line, len(text) if text.isascii() else self._width(text))

    def place(self, document: Document, position: types.Position) -> Place:
        """The place of a position, or the nearest one."""
        return document.place_of(position.line, position.character, self._width)

    def range(self, document: Document, span: Span) -> types.Range:
        """The range of a span."""
        return types.Range(self.of(document, span.start), self.of(document, span.end))

    def span(self, document: Document, found: types.Range) -> Span:
        """The span of a range."""
        return Span(self.place(document, found.start), self.place(document, found.end))

    def edit(self, document: Document, edit: Edit) -> types.TextEdit:
        """A change."""
        return types.TextEdit(self.range(document, edit.span), edit.text)

    def diagnostic(self, document: Document, finding: Finding) -> types.Diagnostic:
        """A finding."""
        severities = types.DiagnosticSeverity
        return types.Diagnostic(
            self.range(document, finding.span),
            finding.text,
            severity=severities.Warning if finding.is_warning else severities.Error,
            code=finding.code or None,
            source=SOURCE,
        )

    def diagnostics(self, document: Document, found: Found) -> list[types.Diagnostic]:
        """The findings of a file, and one that counts those that are left out."""
        shown = [self.diagnostic(document, each) for each in found.shown]
        if found.next is None:
            return shown
        where = self.range(document, found.next.span)
        text = f"{found.left_out} more findings are not shown"
        severity = types.DiagnosticSeverity.Information
        return [*shown, types.Diagnostic(where, text, severity=severity, source=SOURCE)]

    def completion(self, document: Document, found: Completion) -> types.CompletionList:
        """Proposals."""
        span = self.range(document, found.span)
        items = [self._item(item, span, place) for place, item in enumerate(found.items)]
        return types.CompletionList(is_incomplete=not found.is_whole, items=items)

    @staticmethod
    def _item(item: Item, span: types.Range, place: int) -> types.CompletionItem:
        return types.CompletionItem(
            item.label,
            kind=ITEM_KINDS.get(item.kind),
            detail=item.detail or None,
            filter_text=item.sought or None,
            sort_text=f"{place:04}",
            text_edit=types.TextEdit(span, item.text or item.label),
            data=place,
        )

    def symbols(self, document: Document, found: Iterable[Entry]) -> list[types.DocumentSymbol]:
        """The entries of an outline."""
        return [self._symbol(document, entry) for entry in found]

    def _symbol(self, document: Document, entry: Entry) -> types.DocumentSymbol:
        last = len(document.lines[min(entry.last, len(document.lines) - 1)])
        whole = Span(Place(entry.first, 0), Place(entry.last, last))
        name = Span(Place(entry.first, 0), Place(entry.first, len(document.lines[entry.first])))
        module = types.SymbolKind.Module
        return types.DocumentSymbol(
            entry.name,
            SYMBOL_KINDS.get(entry.kind, module) if entry.kind else module,
            self.range(document, whole),
            self.range(document, name),
            detail=entry.detail or None,
            children=self.symbols(document, entry.parts) or None,
        )

    def tokens(self, document: Document, found: Iterable[Colored]) -> types.SemanticTokens:
        """Parts of lines, each relative to the one before it."""
        return types.SemanticTokens(list(self._tokens(document, found)))

    def _tokens(self, document: Document, found: Iterable[Colored]) -> Iterator[int]:
        line = column = 0
        for each, mark in found:
            number = _TOKEN_NUMBERS.get(mark.kind)
            start = self.of(document, Place(each, mark.start)).character
            length = self.of(document, Place(each, mark.end)).character - start
            if number is None or length <= 0:
                continue
            if each != line:
                column = 0
            yield from (each - line, start - column, length, number, int(mark.is_definition))
            line, column = each, start
