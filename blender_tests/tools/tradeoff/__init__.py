"""Error against seconds: `make tradeoff`."""
