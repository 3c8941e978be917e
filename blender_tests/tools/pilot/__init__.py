"""`make pilot`: fits the pilot's model of costs to measured times."""
