"""The policy, its training, search and evaluation."""
