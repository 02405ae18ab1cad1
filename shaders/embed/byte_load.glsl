// Loads from the bytes copied from a host's buffers.
layout(scalar, binding = kSlotWords) readonly restrict buffer Words { uint words[]; };

// Four bytes from any offset. The buffer has one more word at its end.
uint loadWord(uint byte) {
  const uint low = words[byte >> 2], shift = 8 * (byte & 3);
  return shift == 0 ? low : low >> shift | words[(byte >> 2) + 1] << (32 - shift);
}
