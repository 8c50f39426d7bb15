"""The policy: network, inference, files, rollouts, and what it sees."""
