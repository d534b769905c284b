"""HDDL, with cost distributions: reader and writer."""

from statehtn.hddl.diagnostics import HddlWarning
from statehtn.hddl.reader import read_hddl, read_hddl_text
from statehtn.hddl.writer import write_hddl

__all__ = ["HddlWarning", "read_hddl", "read_hddl_text", "write_hddl"]
