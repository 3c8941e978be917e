"""Code that the measuring programs share: options, terminal, processes, turns, kept results, arithmetic, pages."""
