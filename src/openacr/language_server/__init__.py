"""The language server: `openacr.editing` by the Language Server Protocol."""
