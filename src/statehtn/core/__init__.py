"""The compiled core seen from Python: grounding and search; the only importer of `statehtn._relax`."""
