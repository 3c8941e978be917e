"""Operators: measure, check, save a bug report, course groups."""
