"""Solver of a symmetric positive definite 6 x 6 system by blocks."""

import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from jaxhydro.rotations import cross


def _inverse3(a: Float[Array, "3 3"]) -> Float[Array, "3 3"]:
    """Inverse of a 3 x 3 matrix by cofactors."""
    x, y, z = a[0], a[1], a[2]
    cofactors = jnp.stack([cross(y, z), cross(z, x), cross(x, y)], axis=1)
    return cofactors / (x @ cofactors[:, 0])


def inverse6(matrix: Float[Array, "6 6"]) -> Float[Array, "6 6"]:
    """Inverse of a symmetric positive definite 6 x 6 matrix from its 3 x 3 blocks.

    Golub and Van Loan 2013, Matrix Computations, section 3.2.11. As elementwise arithmetic it compiles and runs several
    times faster inside a time loop than a call of LAPACK. Such a call also makes a Jacobian through it slow to compile.
    """
    a, b, d = matrix[:3, :3], matrix[:3, 3:], matrix[3:, 3:]
    ia = _inverse3(a)
    iab = ia @ b
    schur = _inverse3(d - b.T @ iab)
    corner = -iab @ schur
    return jnp.concatenate([jnp.concatenate([ia - corner @ iab.T, corner], axis=1), jnp.concatenate([corner.T, schur], axis=1)])


def solve6(matrix: Float[Array, "6 6"], vector: Float[Array, "6"]) -> Float[Array, "6"]:
    """Solution x of M x = f for a symmetric positive definite M, by elimination of the first block.

    Sums, not products of matrices, with barriers between them: one kernel each, computed once.
    """
    a, b, d = matrix[:3, :3], matrix[:3, 3:], matrix[3:, 3:]
    ia = jax.lax.optimization_barrier(_inverse3(a))
    iab = (ia[:, :, None] * b[None]).sum(axis=1)
    schur = jax.lax.optimization_barrier(d - (b[:, :, None] * iab[:, None, :]).sum(axis=0))
    second = (_inverse3(schur) * (vector[3:] - (iab * vector[:3, None]).sum(axis=0))).sum(axis=1)
    first = (ia * vector[:3]).sum(axis=1) - (iab * second).sum(axis=1)
    return jnp.concatenate([first, second])


@jax.custom_jvp
def accelerate(
    mass: Float[Array, "6 6"],
    force: Float[Array, "6"],
    masses: Float[Array, " k"],
    moments: Float[Array, "6 6 k"],
) -> Float[Array, "6"]:
    """Solution x of (M + sum m_k J_k) x = f: acceleration from forces and masses.

    Derivatives reuse the inverse, dx = M^-1 (df - dM x), and never form that of the matrix.

    Args:
        mass: M of the body (kg, kg m, kg m²), (6, 6).
        force: f (N, N m), (6,).
        masses: m_k of elements and ends, (k,).
        moments: Constant J_k, (6, 6, k).
    """
    return solve6(*jax.lax.optimization_barrier((mass + moments @ masses, force)))


@accelerate.defjvp
def _accelerate_jvp(primals, tangents):
    mass, force, masses, moments = primals
    d_mass, d_force, d_masses, _ = tangents
    inverse = jax.lax.optimization_barrier(inverse6(mass + moments @ masses))
    solution = inverse @ force
    along = jax.lax.optimization_barrier(jnp.einsum("ijk,j->ik", moments, solution))
    return solution, inverse @ (d_force - d_mass @ solution - along @ d_masses)
