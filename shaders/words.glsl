// What was copied from a host's buffers, and what is wrong with it.

layout(scalar, binding = kBindWords) readonly restrict buffer Words { uint words[]; };
layout(scalar, binding = kBindStrays) restrict buffer Strays { Stray stray; };

// Four bytes from anywhere; the buffer ends a word later.
uint wordAt(uint byte) {
  const uint low = words[byte >> 2], shift = 8 * (byte & 3);
  return shift == 0 ? low : low >> shift | words[(byte >> 2) + 1] << (32 - shift);
}
