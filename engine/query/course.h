// How a query's sensor moves past each object, and what t means in an answer.
#pragma once

#include "exact/translation.h"
#include "radar/answers.h"
#include "scene/scene.h"

namespace radar {

class Course {
 public:
  /// A valid query's. The scene outlives it.
  Course(const Query& query, const Scene::Impl& scene);

  /// Whether t is the fraction of a step, in which objects may move; else it is the distance moved.
  bool isStep() const { return isStep_; }
  /// The motion past an object in a step, or past all objects; kNone: past objects that stand.
  Translation past(ObjectId object = kNone) const;
  /// From a search's t to the query's: a direction's is a distance, even in a step.
  void toQuery(Result& result) const;

 private:
  const Query& query_;
  const Scene::Impl& scene_;
  bool isStep_;
  Vector displacement_;  // in a step, the sensor's
};

}  // namespace radar
