"""Checks of a snapshot for faults that will hurt the picture. Arrays and numpy, no bpy; one kind of fault a file."""
