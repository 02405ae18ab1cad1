// A chain and all objects, at any time of its motion: exact tests of poses that long doubles place.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "radar/chain.h"
#include "scene/scene.h"
#include "support/shape.h"

namespace radar::test {

using Real = long double;
using Place = std::array<Real, 12>;

inline Place widened(const Transform& pose) {
  Place out;
  std::ranges::copy(pose.m, out.begin());
  return out;
}

inline Place product(const Place& outer, const Place& inner) {
  Place out;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 4; ++k) {
      out[4 * i + k] = k == 3 ? outer[4 * i + 3] : 0;
      for (int j = 0; j < 3; ++j) out[4 * i + k] += outer[4 * i + j] * inner[4 * j + k];
    }
  }
  return out;
}

// As the question is stated.
inline Place jointPlace(const Link& link, Real q) {
  Place out = widened({});
  const Real length = std::sqrt(Real(link.axis[0]) * link.axis[0] + Real(link.axis[1]) * link.axis[1] +
                                Real(link.axis[2]) * link.axis[2]);
  const Real n[3] = {link.axis[0] / length, link.axis[1] / length, link.axis[2] / length};
  if (link.joint == JointType::prismatic) {
    for (int k = 0; k < 3; ++k) out[4 * k + 3] = q * n[k];
  } else if (link.joint == JointType::revolute) {
    const Real c = std::cos(q), s = std::sin(q);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) out[4 * i + k] = (1 - c) * n[i] * n[k] + (i == k ? c : 0);
      out[4 * i + (i + 1) % 3] -= s * n[(i + 2) % 3];
      out[4 * i + (i + 2) % 3] += s * n[(i + 1) % 3];
    }
  }
  return out;
}

/// A chain and all objects at any time.
class ChainTruth {
 public:
  ChainTruth(const Chain& chain, const ChainQuery& query, const Scene& scene)
      : chain_(chain), query_(query), scene_(scene.impl()) {}

  /// Whether surfaces cross by more than `slack`; with a clearance, whether they are nearer than that less `slack`.
  bool meet(double s, double slack) const {
    std::vector<std::vector<Shape>> links;
    std::vector<Place> places;
    for (const Link& link : chain_.links) {
      Place place = product(link.parent == kNone ? widened(query_.worldFromBase) : places[link.parent],
                            widened(link.parentFromJoint));
      if (link.joint != JointType::fixed) {
        const Real from = query_.from[link.variable], to = query_.to[link.variable];
        place = product(place, jointPlace(link, from + s * (to - from)));
      }
      places.push_back(place);
      links.emplace_back();
      for (const LinkMesh& mesh : link.meshes) {
        links.back().push_back(shapeOf(scene_.meshes[mesh.mesh], product(place, widened(mesh.linkFromMesh)), {}));
      }
    }
    for (const auto& [a, b] : chain_.pairs) {
      for (const Shape& first : links[a]) {
        for (const Shape& second : links[b]) {
          if (test::meet(first, second, query_.clearance, slack)) return true;
        }
      }
    }
    for (ObjectId id = 0; id < scene_.objects.size(); ++id) {
      const Object& object = scene_.objects[id].object;
      if ((object.mask & query_.mask) == 0 || std::ranges::count(query_.exclude, id) > 0) continue;
      const Shape other = shapeOf(scene_.meshes[object.mesh], widened(object.worldFromMesh), scaled(s, object.motion));
      for (const std::vector<Shape>& link : links) {
        for (const Shape& shape : link) {
          if (test::meet(shape, other, query_.clearance, slack)) return true;
        }
      }
    }
    return false;
  }

 private:
  static Shape shapeOf(const Mesh& mesh, const Place& place, const Vector& moved) {
    Shape out;
    for (uint32_t i = 0; i < mesh.triangleCount(); ++i) {
      exact::Triangle corners;
      for (int c = 0; c < 3; ++c) {
        const float* p = &mesh.positions[3 * mesh.indices[3 * i + c]];
        for (int k = 0; k < 3; ++k) {
          corners[c][k] = double(place[4 * k] * p[0] + place[4 * k + 1] * p[1] + place[4 * k + 2] * p[2] +
                                 place[4 * k + 3] + moved[k]);
        }
      }
      out.add(corners);
    }
    return out;
  }
  const Chain& chain_;
  const ChainQuery& query_;
  const Scene::Impl& scene_;
};

}  // namespace radar::test
