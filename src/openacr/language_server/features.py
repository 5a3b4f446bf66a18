"""The requests of the protocol, each mapped to a question of the engine."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TYPE_CHECKING, Any, TypeVar

from lsprotocol import types
from pygls.exceptions import JsonRpcException

from openacr.errors import OpenacrError, UserError
from openacr.language_server.conversions import TOKEN_MODIFIERS, TOKEN_TYPES
from openacr.language_server.server import Server

if TYPE_CHECKING:
    import socket

    from openacr.editing.symbols import Location

REQUEST_FAILED = -32803
Asked = TypeVar("Asked", bound=Callable[..., Any])
FEATURES: list[tuple[str, Any, Callable[..., Any]]] = []


def feature(method: str, options: Any = None) -> Callable[[Asked], Asked]:
    """Enter a function as the answer to a method; a file that is not open has no answer.

    Each answer is a task: one that is withdrawn before its turn is not computed.
    """

    def enter(asked: Asked) -> Asked:
        @wraps(asked)
        async def answer(ls: Server, params: Any) -> Any:
            try:
                return asked(ls, params)
            except OpenacrError:
                return None

        FEATURES.append((method, options, answer))
        return asked

    return enter


def notified(method: str) -> Callable[[Asked], Asked]:
    """Enter a function as what follows from a notification, at once."""

    def enter(asked: Asked) -> Asked:
        FEATURES.append((method, None, asked))
        return asked

    return enter


def register(server: Server) -> None:
    """Give a server all features."""
    for method, options, answer in FEATURES:
        server.feature(method, options)(answer)


@notified(types.INITIALIZED)
def initialized(ls: Server, params: types.InitializedParams) -> None:
    """Columns are counted as agreed from now on."""
    ls.agree()


@notified(types.WORKSPACE_DID_CHANGE_WATCHED_FILES)
def watched(ls: Server, params: types.DidChangeWatchedFilesParams) -> None:
    """Files have changed on the disk."""
    ls.disk_changed()


@notified(types.TEXT_DOCUMENT_DID_SAVE)
def saved(ls: Server, params: types.DidSaveTextDocumentParams) -> None:
    """A file was written."""
    ls.disk_changed()


@feature(
    types.TEXT_DOCUMENT_COMPLETION,
    types.CompletionOptions(trigger_characters=["#", "<", "_"], resolve_provider=True),
)
def complete(ls: Server, params: types.CompletionParams) -> types.CompletionList:
    """Proposals for what is being typed."""
    document, place = ls.at(params.text_document.uri, params.position)
    found = ls.engine.complete(document.path, place)
    ls.proposed = found.items
    return ls.columns.completion(document, found)


@feature(types.COMPLETION_ITEM_RESOLVE)
def resolve(ls: Server, item: types.CompletionItem) -> types.CompletionItem:
    """More about a proposal of the last ones."""
    from openacr.editing.texts import markdown

    place = item.data if isinstance(item.data, int) else -1
    if 0 <= place < len(ls.proposed) and ls.proposed[place].label == item.label:
        text = markdown(ls.proposed[place].row)
        item.documentation = _markdown(text) if text else None
    return item


@feature(types.TEXT_DOCUMENT_HOVER)
def hover(ls: Server, params: types.HoverParams) -> types.Hover | None:
    """What stands at a position."""
    document, place = ls.at(params.text_document.uri, params.position)
    found = ls.engine.describe(document.path, place)
    if found is None:
        return None
    return types.Hover(_markdown(found[0]), ls.columns.range(document, found[1]))


@feature(
    types.TEXT_DOCUMENT_SIGNATURE_HELP,
    types.SignatureHelpOptions(trigger_characters=[" ", "("], retrigger_characters=[","]),
)
def signature(ls: Server, params: types.SignatureHelpParams) -> types.SignatureHelp | None:
    """How the command or function at a position is written."""
    document, place = ls.at(params.text_document.uri, params.position)
    answer = ls.engine.signature(document.path, place)
    if answer is None:
        return None
    found, text = answer
    parts = [types.ParameterInformation(part) for part in found.parts]
    active = found.active if 0 <= found.active < len(parts) else None
    information = types.SignatureInformation(found.label, _markdown(text), parts or None, active)
    return types.SignatureHelp([information], active_signature=0, active_parameter=active)


@feature(types.TEXT_DOCUMENT_DEFINITION)
def definition(ls: Server, params: types.DefinitionParams) -> list[types.Location]:
    """Where a name is defined."""
    document, place = ls.at(params.text_document.uri, params.position)
    return _locations(ls, ls.engine.definitions(document.path, place))


@feature(types.TEXT_DOCUMENT_REFERENCES)
def references(ls: Server, params: types.ReferenceParams) -> list[types.Location]:
    """Where a name stands."""
    document, place = ls.at(params.text_document.uri, params.position)
    wanted = params.context.include_declaration
    found = ls.engine.references(document.path, place, has_definitions=wanted)
    return _locations(ls, found)


@feature(types.TEXT_DOCUMENT_DOCUMENT_HIGHLIGHT)
def highlight(ls: Server, params: types.DocumentHighlightParams) -> list[types.DocumentHighlight]:
    """Where a name stands in the same file."""
    document, place = ls.at(params.text_document.uri, params.position)
    found = ls.engine.references(document.path, place)
    here = [each.span for each in found if each.path == document.path]
    return [types.DocumentHighlight(ls.columns.range(document, span)) for span in here]


@feature(types.TEXT_DOCUMENT_PREPARE_RENAME)
def prepare_rename(ls: Server, params: types.PrepareRenameParams) -> types.Range | None:
    """The name that would be changed."""
    document, place = ls.at(params.text_document.uri, params.position)
    span = ls.engine.renamable(document.path, place)
    return ls.columns.range(document, span) if span else None


@feature(types.TEXT_DOCUMENT_RENAME, types.RenameOptions(prepare_provider=True))
def rename(ls: Server, params: types.RenameParams) -> types.WorkspaceEdit:
    """Changes that give a name another spelling; the reason where that is refused."""
    document, place = ls.at(params.text_document.uri, params.position)
    try:
        changes = ls.engine.rename(document.path, place, params.new_name)
    except UserError as error:
        raise JsonRpcException(str(error), REQUEST_FAILED) from None
    edits: dict[str, list[types.TextEdit]] = {}
    for path, found in changes.items():
        text = ls.engine.files.document(path)
        if text is not None:
            edits[ls.uri(path)] = [ls.columns.edit(text, edit) for edit in found]
    return types.WorkspaceEdit(changes=dict(edits))


@feature(types.TEXT_DOCUMENT_DOCUMENT_SYMBOL)
def symbols(ls: Server, params: types.DocumentSymbolParams) -> list[types.DocumentSymbol]:
    """The outline of a file."""
    document = ls.document(params.text_document.uri)
    return ls.columns.symbols(document, ls.engine.entries(document.path))


@feature(types.TEXT_DOCUMENT_FOLDING_RANGE)
def folding(ls: Server, params: types.FoldingRangeParams) -> list[types.FoldingRange]:
    """The lines that fold together."""
    document = ls.document(params.text_document.uri)
    folds = ls.engine.folds(document.path)
    return [types.FoldingRange(fold.first, fold.last, kind=fold.kind or None) for fold in folds]


@feature(types.TEXT_DOCUMENT_FORMATTING)
def formatting(ls: Server, params: types.DocumentFormattingParams) -> list[types.TextEdit]:
    """The changes that make a file look as it is listed."""
    document = ls.document(params.text_document.uri)
    return [ls.columns.edit(document, edit) for edit in ls.engine.format(document.path)]


LEGEND = types.SemanticTokensLegend(TOKEN_TYPES, TOKEN_MODIFIERS)


@feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_FULL, LEGEND)
def all_tokens(ls: Server, params: types.SemanticTokensParams) -> types.SemanticTokens:
    """The kinds of the words of a file."""
    document = ls.document(params.text_document.uri)
    last = len(document.lines)
    return ls.columns.tokens(document, ls.engine.colored(document.path, 0, last))


@feature(types.TEXT_DOCUMENT_SEMANTIC_TOKENS_RANGE, LEGEND)
def tokens(ls: Server, params: types.SemanticTokensRangeParams) -> types.SemanticTokens:
    """The kinds of the words of some lines."""
    document = ls.document(params.text_document.uri)
    first, last = params.range.start.line, params.range.end.line
    return ls.columns.tokens(document, ls.engine.colored(document.path, first, last))


@feature(types.TEXT_DOCUMENT_INLAY_HINT)
def inlay_hints(ls: Server, params: types.InlayHintParams) -> list[types.InlayHint]:
    """What the numbers of parameters and flags in some lines stand for."""
    document = ls.document(params.text_document.uri)
    first, last = params.range.start.line, params.range.end.line
    return [
        types.InlayHint(ls.columns.of(document, place), text, padding_left=True)
        for place, text in ls.engine.shown(document.path, first, last)
    ]


@feature(
    types.TEXT_DOCUMENT_CODE_ACTION,
    types.CodeActionOptions(code_action_kinds=[types.CodeActionKind.QuickFix]),
)
def code_actions(ls: Server, params: types.CodeActionParams) -> list[types.CodeAction]:
    """The changes that the hints of what was found propose."""
    uri = params.text_document.uri
    document = ls.document(uri)
    span = ls.columns.span(document, params.range)
    return [
        types.CodeAction(
            fix.title,
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[ls.columns.diagnostic(document, finding)],
            is_preferred=True,
            edit=types.WorkspaceEdit(changes={uri: [ls.columns.edit(document, fix.edit)]}),
        )
        for finding, fix in ls.engine.fixes(ls.checks.shown(document.path), span)
    ]


def _markdown(text: str) -> types.MarkupContent:
    return types.MarkupContent(types.MarkupKind.Markdown, text)


def _locations(ls: Server, found: list[Location]) -> list[types.Location]:
    texts = [(each, ls.engine.files.document(each.path)) for each in found]
    return [
        types.Location(ls.uri(each.path), ls.columns.range(text, each.span))
        for each, text in texts
        if text is not None
    ]


def serve(server: Server, listener: socket.socket | None = None) -> None:
    """Serve one client over the standard streams, or the first that connects to a socket."""
    register(server)
    if listener is None:
        server.start_here()
    else:
        server.start_at(listener)
