"""Exit codes of all commands, which farms read."""

from ..bindings.abi import LancerError

# WRONG_USE: a file or an option is wrong, so that another try is useless.
DONE, FAILED, WRONG_USE = 0, 1, 2


class WrongUse(LancerError):
    """A file or an option that ends a command with WRONG_USE."""
