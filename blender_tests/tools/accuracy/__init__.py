"""Is the error that renders report true: `make accuracy`."""
