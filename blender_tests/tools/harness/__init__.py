"""What all measuring programs share: options, terminal, processes, turns, results that are kept, arithmetic, pages."""
