// What a picture of a batch can hold, and what it leaves out.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "workloads/workload.h"

namespace radar::tools {

/// By query: the objects that skipOverlapping left out, ascending; only of queries that left some out.
using LeftOut = std::map<uint32_t, std::vector<uint32_t>>;

/// A moment of its way that a query lists.
struct ListedMoment {
  enum class As : uint8_t { contact, closest, exit };
  Result result;
  As as = As::contact;
};
/// By query; only of queries that list some.
using ListedMoments = std::map<uint32_t, std::vector<ListedMoment>>;
/// Those of an answer that have an object.
std::vector<ListedMoment> momentsOf(const Listed& listed);

/// No picture has more; the first are shown.
inline constexpr uint32_t kMostShownQueries = 10'000;

/// Chooses, and says in sentences what is not chosen. What it is given must outlive it.
class Cut {
 public:
  /// An answer for each query of the workload. `all`: how many queries there are.
  Cut(const Workload& workload, std::span<const Result> answers, const LeftOut& left, uint64_t all,
      const ListedMoments& moments = {});

  /// The largest meshes become boxes until the others have no more than three million triangles.
  void boxMeshes();
  bool isBoxed(size_t mesh) const { return boxed_.contains(mesh); }
  /// The first so many are shown.
  size_t queries() const { return queries_; }
  /// The lists of so many first queries are shown: no more than 100,000 contacts.
  size_t listing() const { return listing_; }
  /// A scene that neither a query nor such a scene needs is left out.
  bool hasScene(uint32_t scene) const { return workload_.queries.empty() || scenes_.contains(scene); }
  /// Numbers among the scene's own instances, of which the first has the number `first`: no more than 100,000 with
  /// those of the base, those that queries touch or leave out before others; none without a mesh.
  std::vector<uint32_t> objects(uint32_t scene, uint32_t first);
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  void note(const std::string& sentence);

  const Workload& workload_;
  size_t queries_ = 0, listing_ = 0;
  std::set<uint32_t> scenes_;
  std::map<uint32_t, std::set<uint32_t>> touched_;  ///< by scene: objects that answers name
  std::set<size_t> boxed_;
  std::vector<std::string> notes_;
};

}  // namespace radar::tools
