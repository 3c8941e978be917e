"""The cost of each feature: `make features`."""
