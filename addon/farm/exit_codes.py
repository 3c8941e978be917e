"""Exit codes of all commands, which farms read."""

# WRONG_USE: a file or an option is wrong, so that another try is useless.
DONE, FAILED, WRONG_USE = 0, 1, 2
