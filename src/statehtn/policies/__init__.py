"""Policies that can be asked, valued and simulated; what a run that looks for one returns, and files about it."""
