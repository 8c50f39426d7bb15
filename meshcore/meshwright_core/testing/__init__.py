"""A slow face-list mesh to compare with, and random operations for tests and benchmarks."""
