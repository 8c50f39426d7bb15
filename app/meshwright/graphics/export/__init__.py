"""Pictures, film strips and videos of a document."""
