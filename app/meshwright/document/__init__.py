"""The document: a mesh with history, branches and selection; no Qt, no drawing, no agent."""
