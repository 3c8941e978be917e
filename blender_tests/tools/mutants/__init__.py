"""Does a test fail where the code is wrong: `make mutants`."""
