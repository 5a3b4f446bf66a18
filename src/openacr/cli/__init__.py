"""The command line of openacr: thin shells around the layers below."""
