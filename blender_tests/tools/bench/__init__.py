"""`make bench`: every renderer side by side on this machine. Nothing is asserted: tests compare pictures, not times."""
