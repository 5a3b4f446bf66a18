"""The text of part programs: lines, words, expressions, statements and findings."""
