"""Writers of block-structured grids, one format each."""
