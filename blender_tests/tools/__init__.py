"""The measuring programs, each with tests of its own."""
