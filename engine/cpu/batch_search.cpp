// Queries of a batch that take turns on one thread.
#include <cstddef>
#include <memory>
#include <new>
#include <utility>

#include "cpu/query_task.h"
#include "query/hits.h"

namespace radar::cpu {

namespace {

constexpr size_t kCacheLine = 64;

template <bool toWrite, class Value>
void prefetch(const Value& value) {
  const char* const bytes = reinterpret_cast<const char*>(&value);
  for (size_t at = 0; at < sizeof(Value); at += kCacheLine) __builtin_prefetch(bytes + at, toWrite ? 1 : 0);
}

}  // namespace

/// A query without a clearance whose answer is under way.
struct QuerySearch::Flight {
  size_t place;  ///< in the batch
  Task task;
  Participants participants;
  FirstContact finder;
  double reach;
  Walk walk;
  ObjectId object = kNone;  ///< that the walk has reached

  Flight(const Batch& batch, size_t i, FlightMemory& memory)
      : place(i),
        task(batch.queries[i], batch.scene),
        participants(task.query, task.scene),
        finder(task.query, task.motion, std::move(memory.touching)),
        reach(reachOf(finder, task.motion)),
        walk(task.scene, batch.tree, task.motion, roomyBox(task.query, task.scene), reach, memory.open) {}

  /// Whether a query can take turns with others on one thread.
  static bool canAnswer(const Query& query, const Batch& batch) {
    return query.clearance == 0 && !query.skipOverlapping && !query.closest && !query.exit && !turns(query) &&
           Participants::areFew(query) && batch.scene.meshes[query.mesh].parts.empty() && batch.tree.inRange();
  }
  /// Takes a step of the walk. Returns whether it goes on, since it has not reached an object yet.
  bool step() {
    object = walk.step(reach);
    if (object != kNone && !participants.contain(object)) object = kNone;
    return object == kNone && !walk.isOver();
  }
};

void QuerySearch::answer(const Batch& batch, size_t first, size_t last) {
  stop_ = &batch.stop;
  const auto placeOf = [&](size_t at) { return batch.order.empty() ? at : batch.order[at]; };
  const auto listedOf = [&](size_t i) { return hasLists(batch.queries[i]) ? &batch.lists[i] : nullptr; };
  const auto keep = [&](size_t i, const Result& result) {
    batch.results[i] = result;
    batch.results[i].tier = batch.tier;
    Listed* const listed = listedOf(i);
    if (listed == nullptr) return;
    for (Result& hit : listed->hits) hit.tier = batch.tier;
    if (listed->closest) listed->closest->at.tier = batch.tier;
    if (listed->exit) listed->exit->tier = batch.tier;
  };
  // Pointers, since GCC fills an array of empty optionals with zeros.
  alignas(Flight) std::byte places[kFlights][sizeof(Flight)];
  struct Destroy {
    void operator()(Flight* flight) const { std::destroy_at(flight); }
  };
  std::array<std::unique_ptr<Flight, Destroy>, kFlights> flights;
  const auto begin = [&](size_t slot) {
    while (first < last && !flights[slot]) {
      throwIfStopped(batch.stop);
      const size_t i = placeOf(first);
      if (++first < last) prefetch<false>(batch.queries[placeOf(first)]);
      prefetch<true>(batch.results[i]);
      if (Flight::canAnswer(batch.queries[i], batch)) {
        flights[slot].reset(new (places[slot]) Flight(batch, i, memory_[slot]));
      } else {
        keep(i, answer(batch.queries[i], batch.scene, batch.tree, listedOf(i), batch.stop));
      }
    }
    return flights[slot] != nullptr;
  };
  for (bool isUnderWay = true; isUnderWay;) {
    isUnderWay = false;
    std::array<Flight*, kFlights> walking;
    size_t count = 0;
    for (size_t slot = 0; slot < kFlights; ++slot) {
      if (!begin(slot)) continue;
      isUnderWay = true;
      walking[count++] = flights[slot].get();
    }
    // Without an inner loop, whose end nothing could foresee.
    for (size_t i = 0; count > 0; i &= size_t{0} - (i < count)) {
      if (walking[i]->step()) {
        ++i;
      } else {
        walking[i] = walking[--count];
      }
    }
    for (size_t slot = 0; slot < kFlights; ++slot) {
      std::unique_ptr<Flight, Destroy>& flight = flights[slot];
      if (!flight) continue;
      if (flight->object != kNone) {
        search(flight->task, flight->object, flight->finder);
        flight->finder.endObject();
        flight->reach = reachOf(flight->finder, flight->task.motion);
      } else {
        keep(flight->place, answerOf(flight->task, flight->finder, {}, listedOf(flight->place)));
        memory_[slot].touching = flight->finder.giveBack();
        flight.reset();
      }
    }
  }
}

}  // namespace radar::cpu
