"""What the window shares with the system: settings, threads, signals, compilation."""
