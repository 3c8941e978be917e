"""Measure the course, chapter by chapter: `make course`."""
