"""Generators of problems: the same sizes and the same seed make the same text, everywhere."""
