"""First contact of triangles, written down directly: every vertex against every face, every edge against every edge."""

import numpy as np


def first_contacts(moving: np.ndarray, standing: np.ndarray, displacement: np.ndarray) -> np.ndarray:
    """The fraction of the displacement at which each pair of triangles meets first; inf: not at all.

    moving: (n, 3, 3) and standing: (n, 3, 3) corners; displacement: (3,). In general position, and apart or crossing at
    the start.
    """
    times = [np.where(_cross(moving, standing) | _cross(standing, moving), 0.0, np.inf)]
    for corner in range(3):
        times.append(_point_meets_face(moving[:, corner], standing, displacement))
        times.append(_point_meets_face(standing[:, corner], moving, -displacement))
    for i in range(3):
        for k in range(3):
            a, b = moving[:, i], standing[:, k]
            times.append(_edges_meet(a, moving[:, (i + 1) % 3] - a, b, standing[:, (k + 1) % 3] - b, displacement))
    return np.min(times, axis=0)


def _point_meets_face(point: np.ndarray, face: np.ndarray, displacement: np.ndarray) -> np.ndarray:
    """point + t d = face0 + u e1 + v e2."""
    e1, e2 = face[:, 1] - face[:, 0], face[:, 2] - face[:, 0]
    columns = np.stack([np.broadcast_to(displacement, e1.shape), -e1, -e2], axis=-1)
    t, u, v = _solve(columns, face[:, 0] - point)
    return np.where((t >= 0) & (t <= 1) & (u >= 0) & (v >= 0) & (u + v <= 1), t, np.inf)


def _edges_meet(a: np.ndarray, along_a: np.ndarray, b: np.ndarray, along_b: np.ndarray, displacement: np.ndarray):
    """a + u along_a + t d = b + v along_b."""
    columns = np.stack([np.broadcast_to(displacement, a.shape), along_a, -along_b], axis=-1)
    t, u, v = _solve(columns, b - a)
    inside = (t >= 0) & (t <= 1) & (u >= 0) & (u <= 1) & (v >= 0) & (v <= 1)
    return np.where(inside, t, np.inf)


def _cross(edges_of: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Whether an edge of one triangle goes through the other."""
    crosses = np.zeros(len(faces), bool)
    for i in range(3):
        start = edges_of[:, i]
        along = edges_of[:, (i + 1) % 3] - start
        e1, e2 = faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]
        s, u, v = _solve(np.stack([along, -e1, -e2], axis=-1), faces[:, 0] - start)
        crosses |= (s >= 0) & (s <= 1) & (u >= 0) & (v >= 0) & (u + v <= 1)
    return crosses


def _solve(matrices: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """The three unknowns of each system, (3, n)."""
    return np.linalg.solve(matrices, vectors[..., None])[..., 0].T
