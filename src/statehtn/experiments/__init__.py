"""Comparison runs: which runs a suite asks for, each in a process of its own, and what is kept of them."""
