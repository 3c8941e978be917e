"""`make course`: the requirements of the course's three texts, their implementation, and the errors against the formulas."""
