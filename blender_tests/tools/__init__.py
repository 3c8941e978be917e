"""The measuring programs; each has its own tests."""
