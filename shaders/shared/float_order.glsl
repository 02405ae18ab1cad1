// Numbers in the order of floats, by their bits: comparing floats may flush small ones to 0.

uint inOrder(uint bits) { return (bits & 0x80000000u) != 0 ? ~bits : bits | 0x80000000u; }
uvec3 inOrder(uvec3 bits) { return uvec3(inOrder(bits.x), inOrder(bits.y), inOrder(bits.z)); }

// The float with this number.
float floatOf(uint number) { return uintBitsToFloat((number & 0x80000000u) != 0 ? number & 0x7fffffffu : ~number); }
