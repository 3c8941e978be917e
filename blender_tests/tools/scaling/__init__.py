"""How a still scales to a thousand machines: measured costs, a simulation that runs the farm's own code, a page and a chart."""
