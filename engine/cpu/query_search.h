// Answers queries on one thread: traverses the tree over the objects, nearest first.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "cpu/cutter_search.h"
#include "cpu/mesh_search.h"
#include "cpu/nearest_search.h"
#include "cpu/turn_contact.h"
#include "query/swept.h"

namespace radar::cpu {

/// Valid queries, and where their answers go. `tree` is the scene's; neither changes meanwhile.
struct Batch {
  std::span<const Query> queries;
  std::span<const uint32_t> order;  ///< in which they are answered; may be empty
  std::span<Result> results;        ///< one for each query
  std::span<Listed> lists;          ///< the same; may be empty if no query asks for any
  Tier tier;                        ///< of all answers
  const Scene::Impl& scene;
  const ObjectTree& tree;
  const std::stop_token& stop;
};

/// Reuses its memory between queries. For one thread at a time; those of several threads share no cache line.
class alignas(kThreadLines) QuerySearch {
 public:
  /// Answers queries `first` to `last`, without `last`, of the batch's order. Throws Cancelled soon after its `stop` is
  /// requested; queries without an answer then have the result that they had before.
  void answer(const Batch& batch, size_t first, size_t last);
  uint64_t pairs() const { return pairs_; }

 private:
  struct Task;
  struct Flight;
  /// What a flight leaves to the next one.
  struct FlightMemory {
    std::vector<exact::TouchingPair> touching;
    std::vector<detail::OpenNode> open;
  };
  // Queries of a batch that take turns: while memory is fetched for one, the others go on.
  static constexpr size_t kFlights = 8;

  /// Answers one query, without tiers. `lists`: may be null if the query asks for none.
  Result answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists,
                const std::stop_token& stop);
  template <class Finder>
  static Result answerOf(const Task& task, const Finder& finder, std::span<const ObjectId> skipped, Listed* lists);
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
  /// `sensor`: its placement at the piece's start. `clearance`: as of a PairMotion.
  void searchObject(const Task& task, ObjectId id, const MeshPlacement& sensor, const Piece& piece, double clearance,
                    PairVisitor& visitor);

  const std::stop_token* stop_ = nullptr;  // of the answer in hand
  std::array<FlightMemory, kFlights> memory_;
  MeshSearch meshes_;
  NearestSearch nearest_;
  CutterSearch cutters_;
  uint64_t pairs_ = 0;
};

}  // namespace radar::cpu
