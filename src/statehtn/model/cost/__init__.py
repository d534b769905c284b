"""Uncertain costs: their laws, how a domain states them, and what a ground action costs."""
