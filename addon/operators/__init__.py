"""Operators: measure, check, save a bug report, add the course's node groups, take over Cycles' settings, delete
resume files."""
