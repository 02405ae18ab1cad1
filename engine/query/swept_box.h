// Bounds the distances at which a moving world box meets boxes of the tree over objects. docs/method.md derives the
// error bounds.
#pragma once

#include "exact/translation.h"
#include "scene/object_tree.h"

namespace radar {

using TwoDoubles = double __attribute__((vector_size(16)));

class SweptBox {
 public:
  /// `tree` must be in range.
  SweptBox(const Box& box, const Piece& piece, const ObjectTree& tree);

  /// Lower bounds on the distances, world units, at which the boxes of two nodes are met; infinite if they are not.
  TwoDoubles operator()(const gpu::ObjectNode& first, const gpu::ObjectNode& second) const;

 private:
  TwoDoubles rate_[3], rateSize_[3], offset_[3], half_[3];
};

}  // namespace radar
