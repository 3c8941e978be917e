"""Random small scenes by Lancer and by Cycles, to find what differs without a message: `make differ`."""
