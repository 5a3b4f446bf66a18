"""The command line of openacr: thin wrappers of the layers below."""
