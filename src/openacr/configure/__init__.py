"""Configuration code for a machine, made of the answers its builder gives in a file."""

from openacr.configure.answers import Answers
from openacr.configure.files import code_files
from openacr.configure.load import load_answers

__all__ = ["Answers", "code_files", "load_answers"]
