"""Search for better connectivity: the anytime solver, annealing, patches, shortening."""
