"""One picture on many machines."""
