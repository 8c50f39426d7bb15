"""Evaluation: rollouts, rows of the paper's tables, baselines, figures."""
