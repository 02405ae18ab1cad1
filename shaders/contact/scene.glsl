// What the contact tier's shaders read of the scene and of the sensors: texel buffers, which lavapipe loads faster than
// storage buffers.
layout(binding = kSlotVertices) uniform textureBuffer vertexTexels;
layout(binding = kSlotTriangles) uniform utextureBuffer triangleTexels;

vec3 vertexAt(uint i) { return texelFetch(vertexTexels, int(i)).xyz; }
// The corners, and the triangle's id in its mesh.
uvec4 triangleAt(uint slot) { return texelFetch(triangleTexels, int(slot)); }
