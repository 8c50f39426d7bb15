"""The policy, its training, search and evaluation. Knows meshcore and torch, no Qt and no app."""
