// The box of all objects: that of the root of the tree over them, about its anchor.
layout(binding = kSlotObjectNodes) uniform utextureBuffer objectNodeTexels;

// Distance from a point, given about the anchor, to the farthest point of the objects, as a sum over the axes.
float farthestFrom(vec3 centre) {
  const vec3 middle = uintBitsToFloat(texelFetch(objectNodeTexels, 0).xyz),
             halfExtent = uintBitsToFloat(texelFetch(objectNodeTexels, 1).xyz);
  const vec3 far = abs(middle - centre) + halfExtent;
  return 1.00001 * (far.x + far.y + far.z);
}
