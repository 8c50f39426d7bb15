"""Search: the anytime solver, simulated annealing, patches, shortening, coarsening."""
