"""What each feature costs: `make features`."""
