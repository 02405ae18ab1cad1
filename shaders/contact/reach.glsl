// When nodes come within a clearance: engine/cpu/node_gap.cpp has the same in doubles (docs/exact.md, "Clearance"). Included
// after node_pair.glsl. Both meshes' matrices are read anew for each pair of nodes, a row at a time, since a lane has no registers
// left to keep them in.

// Bound on m . x for the points x of a node: of its box, or of its slab and the rest of its box.
float topOf(Node node, vec3 m) {
  const float along = dot(m, node.normal);
  const vec3 rest = m - along * node.normal;
  return min(dot(m, node.centre) + dot(abs(m), node.halfExtent),
             dot(rest, node.centre) + dot(abs(rest), node.halfExtent) + along * node.middle + abs(along) * node.slab);
}

// A row of a mesh's matrix, and a coordinate of its origin in two parts.
struct Row {
  vec3 linear;
  float high, low;
};
Row rowOf(vec4 coarse, vec4 fine) { return Row(coarse.xyz + fine.xyz, coarse.w, fine.w); }
Row sensorRow(uint search, int i) { return rowOf(sensorTexel(search, kTexelCoarse + i), sensorTexel(search, kTexelFine + i)); }
Row objectRow(uint object, int i) { return rowOf(objectTexel(object, kTexelCoarse + i), objectTexel(object, kTexelFine + i)); }

// Not before this; beyond `limit` if not until then. The pair of meshes is in range. A plane tells, across the gap between the
// nodes' boxes at about the time at which balls around them meet; any plane would be valid.
float reachedFrom(uint search, uint object, Node a, Node b, float clearance, float farthest, float limit) {
  const float scale = scaleOf(search);
  // From one origin to the other, and from one middle to the other.
  vec3 apart, gap, extent;
  float placing = sensorTexel(search, kTexelError).x + objectTexel(object, kTexelError).x, added = 0.0;
  for (int i = 0; i < 3; ++i) {
    const Row rowA = sensorRow(search, i), rowB = objectRow(object, i);
    const vec3 alongA = rowA.linear * scale, alongB = rowB.linear * scale;
    apart[i] = differenceInParts(rowB.high, rowB.low, rowA.high, rowA.low) * scale;
    gap[i] = apart[i] + dot(alongB, b.centre) - dot(alongA, a.centre);
    extent[i] = dot(abs(alongA), a.halfExtent) + dot(abs(alongB), b.halfExtent);
    placing += 4.0 * kUnit * (abs(rowA.high) + abs(rowA.low) + abs(rowB.high) + abs(rowB.low));
    added += sum3(abs(alongA)) + sum3(abs(alongB)) + abs(apart[i]);
  }
  const vec3 direction = sensorTexel(search, kTexelDirection).xyz;
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
  const float margin = scale * placing + 192.0 * kUnit * added + 16.0 * kUnit * farthest + 1e-11;
  float spare = dot(n, apart) - 1.00001 * length(n) * clearance - sum3(abs(n)) * margin;
  // Compilers do not know that this is 0: they would keep the rows that were read above.
  const uint zero = gl_WorkGroupID.z;
  vec3 m = vec3(0.0);
  for (int i = 0; i < 3; ++i) m += n[i] * (sensorRow(search + zero, i).linear * scale);
  spare -= topOf(a, m);
  m = vec3(0.0);
  for (int i = 0; i < 3; ++i) m -= n[i] * (objectRow(object + zero, i).linear * scale);
  spare -= topOf(b, m);
  return spare > 0.0 ? 0.9999 * spare / max(dot(n, direction), 1e-30) : 0.0;
}
