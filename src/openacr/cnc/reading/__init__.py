"""The text of part programs: lines, words, expressions, statements, and what is wrong with them."""
