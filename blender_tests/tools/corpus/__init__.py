"""Render files of other authors, unmodified, by Lancer and by Cycles: `make corpus`."""
