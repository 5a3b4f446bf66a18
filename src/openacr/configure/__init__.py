"""Configuration code for a machine, generated from the answers of its builder in a file."""

from openacr.configure.answers import Answers
from openacr.configure.files import code_files
from openacr.configure.load import parse_answers

__all__ = ["Answers", "code_files", "parse_answers"]
