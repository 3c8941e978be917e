"""What will hurt the picture, told from a snapshot before time is spent on it: arrays and numpy, no bpy, one idea a file."""
