"""Block-structured grids: the quads of a coarse mesh as blocks, their counts, and the fine grid."""
