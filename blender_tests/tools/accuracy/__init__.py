"""Is the error that renders tell true: `make accuracy`."""
