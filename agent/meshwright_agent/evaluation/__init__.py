"""Evaluation (section 5): rollouts, rows of the paper's tables, baselines, figures."""
