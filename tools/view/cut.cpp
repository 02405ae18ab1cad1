#include "view/cut.h"

#include <algorithm>
#include <numeric>

namespace radar::tools {

namespace {

constexpr uint32_t kMostObjects = 100'000, kMostTriangles = 3'000'000, kMostListed = 100'000;
// Vertices need 12 bytes, and listed contacts 150, so that a page of this many is about 70 MB.

}  // namespace

std::vector<ListedMoment> momentsOf(const Listed& listed) {
  std::vector<ListedMoment> moments;
  for (const Result& hit : listed.hits) moments.push_back({hit});
  if (listed.closest && listed.closest->at.object != kNone) {
    moments.push_back({listed.closest->at, ListedMoment::As::closest});
    // A page shows where it is.
    Status& status = moments.back().result.status;
    if (status == Status::clear) status = Status::hit;
  }
  if (listed.exit && listed.exit->object != kNone) moments.push_back({*listed.exit, ListedMoment::As::exit});
  return moments;
}

Cut::Cut(const Workload& workload, std::span<const Result> answers, const LeftOut& left, uint64_t all,
         const ListedMoments& moments)
    : workload_(workload) {
  queries_ = listing_ = std::min<size_t>(workload.queries.size(), kMostShownQueries);
  if (queries_ < all) note("The first " + std::to_string(queries_) + " of " + std::to_string(all) + " queries.");
  size_t listed = 0;
  for (const auto& [query, own] : moments) {
    listed += own.size();
    if (listed > kMostListed) listing_ = std::min<size_t>(listing_, query);
  }
  if (listing_ < queries_) note("Lists of contacts are those of the first " + std::to_string(listing_) + " queries.");
  for (uint32_t i = 0; i < queries_; ++i) {
    const uint32_t scene = workload.queries[i].scene;
    for (const uint32_t part : {scene, workload.scenes[scene].base.value_or(scene)}) {
      scenes_.insert(part);
      if (answers[i].object != kNone) touched_[part].insert(answers[i].object);
      if (const auto found = left.find(i); found != left.end()) {
        touched_[part].insert(found->second.begin(), found->second.end());
      }
      if (const auto found = moments.find(i); found != moments.end() && i < listing_) {
        for (const ListedMoment& moment : found->second) touched_[part].insert(moment.result.object);
      }
    }
  }
}

// A base is asked for once for each scene that has it.
void Cut::note(const std::string& sentence) {
  if (std::ranges::find(notes_, sentence) == notes_.end()) notes_.push_back(sentence);
}

void Cut::boxMeshes() {
  std::vector<size_t> largest(workload_.meshes.size());
  std::iota(largest.begin(), largest.end(), size_t{0});
  const auto triangles = [&](size_t mesh) { return workload_.meshes[mesh].triangleCount(); };
  std::ranges::stable_sort(largest, std::greater<>(), triangles);
  uint64_t sum = 0;
  for (size_t mesh : largest) sum += triangles(mesh);
  for (size_t i = 0; sum > kMostTriangles; ++i) {
    sum -= triangles(largest[i]);
    boxed_.insert(largest[i]);
  }
  if (boxed_.empty()) return;
  const size_t count = boxed_.size();
  note(count == 1 ? "The largest mesh is shown as its box."
                  : "The largest " + std::to_string(count) + " meshes are shown as their boxes.");
}

std::vector<uint32_t> Cut::objects(uint32_t scene, uint32_t first) {
  const std::vector<Instance>& instances = workload_.scenes[scene].instances;
  const size_t room = kMostObjects - std::min(kMostObjects, first);
  std::vector<uint32_t> kept;
  const std::set<uint32_t>& touched = touched_[scene];
  const auto from = touched.lower_bound(first), to = touched.lower_bound(first + uint32_t(instances.size()));
  size_t others = room - std::min<size_t>(room, static_cast<size_t>(std::distance(from, to)));
  for (uint32_t i = 0; i < instances.size(); ++i) {
    if (instances[i].mesh == kNone) continue;
    const bool isTouched = touched.contains(first + i);
    if (isTouched || others > 0) kept.push_back(i);
    others -= !isTouched && others > 0;
  }
  if (instances.size() > room) {
    note("Scene " + workload_.scenes[scene].id + ": " + std::to_string(kept.size()) + " of " +
         std::to_string(instances.size()) + " objects, with all that answers name.");
  }
  return kept;
}

}  // namespace radar::tools
