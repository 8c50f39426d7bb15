"""Training with PPO: configuration, trainer, checkpoints, several processes."""
