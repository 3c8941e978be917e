"""The course, chapter by chapter, measured now: `make course`."""
