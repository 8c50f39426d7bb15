"""The Markov decision process: task, candidate half-edges, observations, environments."""
