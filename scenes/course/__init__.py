"""`make course`: what the course's three texts ask for, what was built for it, and whether it does what their formulas say."""
