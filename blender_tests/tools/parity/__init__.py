"""Render the scenes of scenes/parity by Lancer and by Cycles: `make parity`."""
