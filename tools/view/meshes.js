// Triangle meshes, and where they stand.

import { cross, dot, lengthOf, minus, unit } from "./vectors.js";

/**
 * Of each thing a mesh, nine and three numbers.
 * @typedef {{mesh: Uint32Array, linear: Float32Array, at: Float64Array}} Poses
 */

/** A triangle mesh with the sphere around its box. */
export class Mesh {
  /**
   * `isBox`: only the box of a mesh of so many triangles is known. `radius`: of a sensor that is rounded; `isRound`: as a
   * ball or capsule, which is what is drawn. `parts`: of a cutter, which the triangles only show; else 0.
   */
  constructor({ name, positions, indices, triangles = indices.length / 3, isBox = false, isRound = false, radius = 0, parts = 0 }) {
    this.name = name;
    /** @type {Float32Array} */
    this.positions = positions;
    /** @type {Uint32Array} */
    this.indices = indices;
    this.triangles = triangles;
    this.isBox = isBox;
    this.isRound = isRound;
    this.radius = radius;
    this.parts = parts;
    this.drawn = indices.length / 3;
    /** @type {?number[][][]} */
    this.creaseLines = null;
    const lo = [Infinity, Infinity, Infinity], hi = [-Infinity, -Infinity, -Infinity];
    for (const vertex of indices) {
      for (let k = 0; k < 3; ++k) {
        const value = positions[3 * vertex + k];
        lo[k] = Math.min(lo[k], value);
        hi[k] = Math.max(hi[k], value);
      }
    }
    this.middle = lo.map((low, k) => 0.5 * (low + hi[k]) || 0);
    this.half = lo.map((low, k) => 0.5 * (hi[k] - low) || 0);
  }
  corners(triangle) {
    return [0, 1, 2].map((i) => {
      const vertex = this.indices[3 * triangle + i];
      return [...this.positions.subarray(3 * vertex, 3 * vertex + 3)];
    });
  }
  /** Whether a triangle crosses start + s * way, 0 < s < 0.998. */
  isCrossed(start, way) {
    const [sx, sy, sz] = start, [wx, wy, wz] = way, { positions: p, indices } = this;
    // By T. Moeller and B. Trumbore (1997); without arrays that live for a triangle.
    for (let t = 0; t < indices.length; t += 3) {
      const a = 3 * indices[t], b = 3 * indices[t + 1], c = 3 * indices[t + 2];
      const ux = p[b] - p[a], uy = p[b + 1] - p[a + 1], uz = p[b + 2] - p[a + 2];
      const vx = p[c] - p[a], vy = p[c + 1] - p[a + 1], vz = p[c + 2] - p[a + 2];
      const nx = wy * vz - wz * vy, ny = wz * vx - wx * vz, nz = wx * vy - wy * vx, volume = ux * nx + uy * ny + uz * nz;
      const x = sx - p[a], y = sy - p[a + 1], z = sz - p[a + 2], u = (x * nx + y * ny + z * nz) / volume;
      if (!(u >= 0 && u <= 1)) continue;
      const qx = y * uz - z * uy, qy = z * ux - x * uz, qz = x * uy - y * ux, v = (wx * qx + wy * qy + wz * qz) / volume;
      if (!(v >= 0 && u + v <= 1)) continue;
      const s = (vx * qx + vy * qy + vz * qz) / volume;
      if (s > 0 && s < 0.998) return true;
    }
    return false;
  }
  /** Pairs of points: the edges with one triangle, and those where two meet at more than 30 degrees. */
  creases() {
    this.creaseLines ??= creasesOf(this);
    return this.creaseLines;
  }
}

function creasesOf(mesh) {
  const found = new Map(), ids = new Map(), lines = [];
  // Vertices at one place are one, since the triangles of some files share none.
  const idOf = (p) => {
    const key = p.join();
    if (!ids.has(key)) ids.set(key, ids.size);
    return ids.get(key);
  };
  for (let t = 0; t < mesh.drawn; ++t) {
    const corners = mesh.corners(t), id = corners.map(idOf);
    const normal = unit(cross(minus(corners[1], corners[0]), minus(corners[2], corners[0])));
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3, key = Math.min(id[i], id[j]) * 2 ** 26 + Math.max(id[i], id[j]);
      if (!found.has(key)) found.set(key, { from: corners[i], to: corners[j], normal, isCrease: true });
      else found.get(key).isCrease = Math.abs(dot(found.get(key).normal, normal)) < 0.866;
    }
  }
  for (const { from, to, isCrease } of found.values()) if (isCrease) lines.push([from, to]);
  return lines;
}

/** Things in a row: of each a mesh, among those that `meshesOf` gives for it, and a pose, world = linear * local + at. */
export class Placed {
  /**
   * @param {(i: number) => Mesh[]} meshesOf
   * @param {Poses} poses
   */
  constructor(meshesOf, { mesh, linear, at }) {
    this.meshesOf = meshesOf;
    this.mesh = mesh;
    this.linear = linear;
    this.at = at;
    this.count = mesh.length;
    this.centre = new Float64Array(3 * this.count);
    this.radius = new Float64Array(this.count);
    for (let i = 0; i < this.count; ++i) {
      const { middle, half } = this.meshOf(i);
      const sides = [0, 0, 0];
      for (let k = 0; k < 3; ++k) {
        const row = linear.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3);
        this.centre[3 * i + k] = at[3 * i + k] + dot(row, middle);
        sides[k] = row.reduce((sum, value, j) => sum + Math.abs(value) * half[j], 0);
      }
      this.radius[i] = lengthOf(sides);
    }
  }
  meshOf(i) {
    return this.meshesOf(i)[this.mesh[i]];
  }
  centreOf(i) {
    return [...this.centre.subarray(3 * i, 3 * i + 3)];
  }
  /** Whether a triangle crosses a segment, short of its end. */
  crosses(i, from, to) {
    const linear = this.linear.subarray(9 * i, 9 * i + 9), rows = [0, 1, 2].map((k) => [...linear.subarray(3 * k, 3 * k + 3)]);
    const [a, b, c] = rows, columns = [cross(b, c), cross(c, a), cross(a, b)], volume = dot(a, columns[0]);
    if (!(Math.abs(volume) > 0)) return false;
    const toLocal = (v) => [0, 1, 2].map((k) => (v[0] * columns[0][k] + v[1] * columns[1][k] + v[2] * columns[2][k]) / volume);
    const start = toLocal(minus(from, this.at.subarray(3 * i, 3 * i + 3)));
    return this.meshOf(i).isCrossed(start, toLocal(minus(to, from)));
  }
  toWorld(i, point) {
    return [0, 1, 2].map((k) => this.at[3 * i + k] + dot(this.linear.subarray(9 * i + 3 * k, 9 * i + 3 * k + 3), point));
  }
}
