"""The Markov decision process (section 4): task, candidates, observations, environments."""
