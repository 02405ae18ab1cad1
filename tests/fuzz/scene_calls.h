// Random calls of the public interface: edits of a scene, each compared with a model of it, and queries.
#pragma once

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "fuzz/choices.h"
#include "radar/query.h"
#include "support/scene_model.h"

namespace radar::fuzz {

/// Throws std::logic_error unless the call throws an Error.
template <class Call>
void requireRefused(const Call& call) {
  try {
    call();
  } catch (const Error&) {
    return;
  }
  throw std::logic_error("what is invalid is accepted");
}

/// Leaves the valid ones of some queries. `ask` takes all of them, and must refuse them if one is invalid.
template <class IsInvalid, class Ask>
void leaveValid(std::vector<Query>& queries, const IsInvalid& isInvalid, const Ask& ask) {
  if (std::ranges::none_of(queries, isInvalid)) return;
  requireRefused([&] { ask(queries); });
  std::erase_if(queries, isInvalid);
}

class SceneCalls {
 public:
  explicit SceneCalls(Choices& choices) : choices_(choices), wild_(choices.oneIn(3)), moving_(choices.oneIn(4)) {}

  /// Makes a random edit. Throws std::logic_error if a valid one is refused, an invalid one is accepted, or the scene
  /// is not what it must be then.
  void edit();
  /// Some queries, valid or not, of mode contact or of any.
  std::vector<Query> queries(uint32_t most);
  const Scene& scene() const { return scene_; }

 private:
  using Mesh = test::SceneModel::Mesh;

  void addMesh();
  void setPositions();
  void removeMesh();
  void addObject();
  void editObject();
  void checkModel() const;
  /// Makes the call, which must throw an Error exactly if it is not `valid`. Returns `valid`.
  bool call(const char* name, bool valid, const std::function<void()>& edit) const;

  double number() { return choices_.number<double>(wild_); }
  std::array<double, 3> vector() { return {number(), number(), number()}; }
  Mesh mesh();
  Bounds bounds();
  Transform pose();
  std::array<double, 3> motion();
  /// Mostly an id in use.
  template <class Items>
  uint32_t idOf(const Items& items);
  void aim(Query& query, ObjectId object);
  Query query();

  Choices& choices_;
  bool wild_, moving_;
  Scene scene_;
  test::SceneModel model_;
};

}  // namespace radar::fuzz
