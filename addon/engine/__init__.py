"""F12: from the key to the picture in Blender's result. Scripts find the results of the last render here."""

from .results import last_costs, last_messages, last_missing, last_statistics

__all__ = ["last_costs", "last_messages", "last_missing", "last_statistics"]
