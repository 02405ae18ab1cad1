// Vertices and triangles in texel buffers, which lavapipe loads faster than storage buffers. Texels are integers, whose bits
// no device changes.
layout(binding = kSlotVertices) uniform utextureBuffer vertexTexels;
layout(binding = kSlotTriangles) uniform utextureBuffer triangleTexels;

uvec3 vertexBitsAt(uint i) { return texelFetch(vertexTexels, int(i)).xyz; }
vec3 vertexAt(uint i) { return uintBitsToFloat(vertexBitsAt(i)); }
// The corners, and the triangle's id in its mesh.
uvec4 triangleAt(uint slot) { return texelFetch(triangleTexels, int(slot)); }
