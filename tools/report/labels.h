// Names and numbers beside the points they belong to, apart from each other and from the lines.
#pragma once

#include <optional>
#include <vector>

namespace radar::tools {

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;
};

struct Spot {
  double x = 0, y = 0;
};

class LabelPlaces {
 public:
  /// Labels had better stay inside.
  explicit LabelPlaces(const Box& inside) : inside_(inside) {}

  void take(const Box& box) { taken_.push_back(box); }
  void takeLine(const Spot& from, const Spot& to);

  struct Place {
    Box box;
    Spot spot;  ///< beside which it is
  };
  /// The freest place for a label of this size beside one of the spots, then taken; nothing where it would stand on
  /// more than `most` square pixels of what is there already. Of places as free, the last spot's.
  std::optional<Place> placeBeside(const std::vector<Spot>& spots, double width, double height, double most);

 private:
  double cost(const Box& box) const;

  Box inside_;
  std::vector<Box> taken_;
};

}  // namespace radar::tools
