// The lanes' walks: down the tree over objects, then down both meshes' trees.

// Of a lane.
MeshPair meshes;
const MeshPair kNoMeshes = MeshPair(mat3(0.0), mat3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0),
                                    vec3(0.0), vec3(0.0), 0.0, 0.0, 0.0, false);

// Lanes without an object walk the tree over objects until they find one.
uint findObjects(uint named) {
  ++work;
  const SensorBox box = sensorBoxOf(search);
  const float scale = scaleOf(search), most = limit * unscaleOf(search);
  // The node to visit next, link and gap, if it `has` one: that need not wait on the stack.
  uvec2 next = uvec2(0);
  bool has = false;
  [[dont_unroll]] for (uint step = 0; step < kObjectSteps; ++step) {
    const bool searching = named == kNobody && current.x == kNobody && (has || (depth > 0 && depth == objectDepth)) &&
                           depth + uint(has) < allowed;
    const uint count = countOf(searching);
    if (count == 0 || (count < (kFew + 1) / 2 && step > 0)) break;
    ++work;
    countWork(kWorkObjectNode, searching);
    if (searching) {
      if (!has) next = stack[--depth].yz;
      has = uintBitsToFloat(next.y) <= limit;
      if (has && !isLeaf(next.x)) {
        const int t = int(2 * next.x);
        const uvec4 x0 = texelFetch(objectNodeTexels, t), x1 = texelFetch(objectNodeTexels, t + 2);
        const vec2 at0 = meetsBox(box, uintBitsToFloat(x0), uintBitsToFloat(texelFetch(objectNodeTexels, t + 1))),
                   at1 = meetsBox(box, uintBitsToFloat(x1), uintBitsToFloat(texelFetch(objectNodeTexels, t + 3)));
        const bool meets0 = at0.x <= at0.y && at0.x <= most, meets1 = at1.x <= at1.y && at1.x <= most;
        const bool swap = meets1 && (!meets0 || at1.x < at0.x);
        const uvec2 entry0 = uvec2(x0.w, floatBitsToUint(at0.x * scale)), entry1 = uvec2(x1.w, floatBitsToUint(at1.x * scale));
        if (meets0 && meets1) stack[depth++] = uvec3(kNobody, swap ? entry0 : entry1);
        next = swap ? entry1 : entry0;
        has = meets0 || meets1;
      }
      if (has && isLeaf(next.x)) {
        if ((next.x & kLinkItem) <= least) named = next.x & kLinkItem;
        has = false;
      }
      objectDepth = depth;
    }
  }
  if (has) stack[depth++] = uvec3(kNobody, next);
  if (has) objectDepth = depth;
  return named;
}

// Whether the object shares a mask bit with the query and is not excluded.
bool isEligible(uint named) {
  ++work;
  // Excluded objects are in ascending order.
  const uvec2 range = excludedOf(search);
  uint first = range.x, end = range.y;
  while (countOf(first < end) != 0) {
    ++work;
    const uint middle = (first + end) / 2;
    if (first < end) {
      if (excluded[middle] < named) {
        first = middle + 1;
      } else {
        end = middle;
      }
    }
  }
  const bool isExcluded = first < range.y && excluded[first] == named;
  return !isExcluded && (objectMask(named) & sensorMask(search)) != 0;
}

// Lanes with a new object begin at its root, or at the nodes of their task (`current`). `resumes`: lanes have forgotten what
// they know of the object that they are in.
void enterObjects(uint named, bool resumes) {
  ++work;
  // All lanes run the loop over excluded objects.
  const bool enters = isEligible(named == kNobody ? 0 : named) && named != kNobody;
  if (enters) object = named;
  const bool places = enters || (resumes && (current.x != kNobody || depth > objectDepth));
  countWork(kWorkObject, places);
  if (places) {
    meshes = meshPairOf(search, object);
    if (!meshes.inRange) {
      atomicOr(states[search].flags, kSearchOutOfRange);
      current.x = kNobody;
    } else if (enters && current.x == kNobody) {
      current = uvec3(sensorRoot(search) | kLinkPair, objectRoot(object), 0);
    }
  }
}

// The stack entry that descends the larger of two nodes, which are not both leaves.
uvec3 entryOf(uint ia, Node a, uint ib, Node b, Approach approach) {
  const bool intoA = isLeaf(b.link) || (!isLeaf(a.link) && approach.sizeA > approach.sizeB);
  const uint gap = floatBitsToUint(approach.gap);
  return intoA ? uvec3(a.link | kLinkLeaf, ib, gap) : uvec3(ia, b.link, gap);
}

// Descends both meshes' trees: tests the two children of one node with the other node, or two roots with each other.
void descend() {
  ++work;
  // Whether lanes without work could find some after the loop.
  const bool more = countOf(current.x == kNobody && (depth > 0 || tasksLeft)) != 0;
  [[dont_unroll]] for (uint step = 0; step < kNodeSteps; ++step) {
    if (current.x == kNobody && depth > objectDepth) current = stack[--depth];
    const bool tries = current.x != kNobody && depth < allowed;
    const uint count = countOf(tries);
    if (count == 0 || leafTail - leafHead + 2 * kLanes > kQueue || (count < kFew && step > 0 && more)) break;
    work += 4;
    const bool near = tries && uintBitsToFloat(current.z) <= limit && object <= least;
    const bool intoA = isLeaf(current.x), areRoots = (current.x & kLinkPair) != 0;
    uvec3 nearest = uvec3(kNobody, 0, 0), other = nearest;
    [[dont_unroll]] for (uint child = 0; child < 2; ++child) {
      bool leaves = false;
      uint linkA = 0, linkB = 0;
      float gap = 0.0;
      const bool tests = near && (child == 0 || !areRoots);
      countWork(kWorkNodePair, tests);
      if (tests) {
        const uint ia = (current.x & kLinkItem) + (intoA ? child : 0), ib = current.y + (intoA ? 0 : child);
        const Node a = nodeAt(ia), b = nodeAt(ib);
        Approach approach = approachOf(meshes, a, b, limit);
#ifdef RADAR_CLEARANCES
        if (approach.gap < kMiss && clearanceOf(search) > 0.0) {
          const float from = reachedFrom(search, object, a, b, clearanceOf(search), meshes.farthest, limit);
          approach.gap = from > limit ? kMiss : max(approach.gap, from);
        }
#endif
        linkA = a.link;
        linkB = b.link;
        gap = approach.gap;
        leaves = gap < kMiss && isLeaf(linkA & linkB);
        if (gap < kMiss && !leaves) {
          const uvec3 entry = entryOf(ia, a, ib, b, approach);
          const bool first = nearest.x == kNobody || gap < uintBitsToFloat(nearest.z);
          other = first ? nearest : entry;
          nearest = first ? entry : nearest;
        }
      }
      pushLeaves(leaves, linkA, linkB, gap);
    }
    meet();
    if (other.x != kNobody) stack[depth++] = other;
    if (tries) current = nearest;
  }
}
