// Answers a query whose sensor is a cutter: past the tree over objects, then each part of the cutter past an object's
// tree, nearest first, in the cutter's frame.
#pragma once

#include <vector>

#include "cpu/mesh_search.h"
#include "cpu/part_contact.h"
#include "query/course.h"

namespace radar::cpu {

/// Reuses its memory between queries. For one thread at a time.
class CutterSearch {
 public:
  /// As of QuerySearch::answer; adds the triangles that are tested to `pairs`.
  Result answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists, uint64_t& pairs,
                const std::stop_token& stop);

 private:
  class Way;
  class Contact;
  class LeastAtStart;

  void search(const Way& way, ObjectId id, const Object& object, const Mesh& mesh, PairVisitor& visitor,
              uint64_t& pairs, const std::stop_token& stop);

  struct Open {
    double near;
    uint32_t node;
  };
  std::vector<Open> open_;
};

}  // namespace radar::cpu
