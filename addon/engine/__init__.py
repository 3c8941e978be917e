"""F12 renders. Scripts find the results of the last render here."""

from .results import last_costs, last_messages, last_missing, last_statistics

__all__ = ["last_costs", "last_messages", "last_missing", "last_statistics"]
