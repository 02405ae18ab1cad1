// When nodes come within a clearance: engine/cpu/mesh_search.cpp has the same in doubles (docs/exact.md, "Clearance"). Included
// after node_pair.glsl. All is read anew for each pair of nodes, since a lane has no registers left to keep it in.

// Bound on n . x for the points x of a node, from the origin of its mesh: of its box, or of its slab and the rest of its box.
float topOf(Node node, mat3 world, vec3 n) {
  const vec3 m = n * world;
  const float along = dot(m, node.normal);
  const vec3 rest = m - along * node.normal;
  return min(dot(m, node.centre) + dot(abs(m), node.halfExtent),
             dot(rest, node.centre) + dot(abs(rest), node.halfExtent) + along * node.middle + abs(along) * node.slab);
}

// Not before this; beyond `limit` if not until then. The pair of meshes is in range. A plane tells, across the gap between the
// nodes' boxes at about the time at which balls around them meet; any plane would be valid.
float reachedFrom(uint search, uint object, Node a, Node b, float clearance, float farthest, float limit) {
  const MatrixRows rowsA = sensorRows(search, kTexelCoarse), fineA = sensorRows(search, kTexelFine);
  const MatrixRows rowsB = objectRows(object, kTexelCoarse), fineB = objectRows(object, kTexelFine);
  const vec3 direction = sensorTexel(search, kTexelDirection).xyz;
  const float scale = scaleOf(search);
  const mat3 worldA = matrixOf(rowsA, fineA) * scale, worldB = matrixOf(rowsB, fineB) * scale;
  // From one origin to the other, and from one middle to the other.
  const vec3 apart = differenceInParts(lastOf(rowsB), lastOf(fineB), lastOf(rowsA), lastOf(fineA)) * scale;
  const vec3 gap = apart + worldB * b.centre - worldA * a.centre;
  const vec3 extent = abs3(worldA) * a.halfExtent + abs3(worldB) * b.halfExtent;
  const float nearest = dot(gap, direction), room = clearance + length(extent);
  const vec3 passing = gap - nearest * direction;
  const float before = room * room - dot(passing, passing);
  const float at = clamp(before > 0.0 ? nearest - sqrt(before) : nearest, 0.0, limit);
  const vec3 then = gap - at * direction;
  vec3 n = sign(then) * max(abs(then) - extent, vec3(0.0));
  // Boxes that pass each other stay apart across the motion.
  if (at == nearest) n -= dot(n, direction) * direction;
  // Squares of less might flush to 0.
  if (max3(abs(n)) < 1e-6) return 0.0;
  // Of positions: as placed, of their differences, of the direction and of all that is summed below.
  const vec3 added = (abs3(worldA) + abs3(worldB)) * vec3(1.0) + abs(apart);
  const vec3 parts = abs(lastOf(rowsA)) + abs(lastOf(fineA)) + abs(lastOf(rowsB)) + abs(lastOf(fineB));
  const float placing = scale * (sensorTexel(search, kTexelError).x + objectTexel(object, kTexelError).x + 4.0 * kUnit * sum3(parts)) +
                        192.0 * kUnit * sum3(added) + 16.0 * kUnit * farthest + 1e-11;
  const float height = dot(n, apart) - topOf(a, worldA, n) - topOf(b, worldB, -n);
  const float spare = height - 1.00001 * length(n) * clearance - sum3(abs(n)) * placing;
  return spare > 0.0 ? 0.9999 * spare / max(dot(n, direction), 1e-30) : 0.0;
}
