"""`make bench`: every renderer side by side on this machine. Nothing here is asserted: tests judge pictures, not clocks."""
