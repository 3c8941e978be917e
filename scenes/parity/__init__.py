"""One-feature scenes that Lancer and Cycles both render, and the judge that compares them: `make parity`."""
