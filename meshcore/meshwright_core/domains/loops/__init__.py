"""The loops of curves around domains and regions: checks, shared sides, points between them."""
