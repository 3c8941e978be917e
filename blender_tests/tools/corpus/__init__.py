"""Files that others made, rendered as they are by Lancer and by Cycles: `make corpus`."""
