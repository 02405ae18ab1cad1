// Answers one query on one thread: traverses the tree over the objects, nearest first.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "cpu/cutter_search.h"
#include "cpu/mesh_search.h"
#include "cpu/nearest_search.h"
#include "cpu/turn_contact.h"

namespace radar::cpu {

/// Reuses its memory between queries. For one thread at a time; those of several threads share no cache line.
class alignas(kThreadLines) QuerySearch {
 public:
  /// Answers a valid query, without tiers. `tree` is the scene's; neither changes meanwhile. `lists`: may be null if
  /// the query asks for none. Throws Cancelled soon after `stop` is requested.
  Result answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists,
                const std::stop_token& stop);
  uint64_t pairs() const { return pairs_; }

 private:
  struct Task;

  /// Finds the objects whose surfaces cross the sensor's at the start.
  std::vector<ObjectId> overlapping(const Query& query, const Scene::Impl& scene, const ObjectTree& tree);
  /// Of an answer that something is within the clearance at the start, names the nearest pair; in its list, of each
  /// object.
  void describeStart(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                     std::span<const ObjectId> skipped, Result& first, Listed* lists);
  Result answerTurn(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                    std::span<const ObjectId> skipped, Listed* lists);
  void searchTurning(const Task& task, ObjectId id, const TurnMotion& motion, const PathPart& part,
                     TurnContact& finder);
  /// `first`: the answer to the query.
  Result lastContact(const Task& task, const ObjectTree& tree, std::span<const ObjectId> skipped, const Result& first);
  Closest closestApproach(const Query& query, const Scene::Impl& scene, const ObjectTree& tree,
                          std::span<const ObjectId> skipped, const Result& first);
  template <class Finder>
  void search(const Task& task, ObjectId id, Finder& finder);
  /// Stays in place until the next one.
  const Translation& pastOf(const Task& task, ObjectId id);
  /// `sensor`: its placement at the piece's start. `clearance`: as of a PairMotion.
  void searchObject(const Task& task, ObjectId id, const MeshPlacement& sensor, const Piece& piece, double clearance,
                    PairVisitor& visitor);

  const std::stop_token* stop_ = nullptr;  // of the answer in hand
  std::optional<Translation> past_;        // the sensor's motion past the current object, in a step
  std::vector<exact::TouchingPair> touching_;
  MeshSearch meshes_;
  NearestSearch nearest_;
  CutterSearch cutters_;
  uint64_t pairs_ = 0;
};

}  // namespace radar::cpu
