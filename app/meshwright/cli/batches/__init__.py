"""Many files at a time: one part, worker processes, clusters, and the table of all."""
