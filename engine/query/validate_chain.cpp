// Validation of chains, and of questions about them.
#include <cmath>

#include "math/float_environment.h"
#include "math/number_text.h"
#include "math/vector.h"
#include "radar/chain.h"
#include "scene/scene.h"

namespace radar {

namespace {

constexpr double kMostAngle = 0x1p16, kMostLength = 0x1p300;
constexpr size_t kMostLinks = 1024;

std::string wrongPlace(const Transform& pose) {
  if (std::string wrong = validate(pose); !wrong.empty()) return wrong;
  for (const double value : pose.m) {
    if (std::abs(value) > kMostLength) return "expected numbers up to 2^300, got " + textOf(value);
  }
  return {};
}

std::string wrongRigid(const Transform& pose) {
  std::string wrong = wrongPlace(pose);
  return wrong.empty() ? validateRigid(pose) : wrong;
}

std::string wrongLink(const Chain& chain, uint32_t index, const Scene& scene) {
  const Link& link = chain.links[index];
  if (link.parent != kNone && link.parent >= index) {
    return "parent: expected a link before it, got " + std::to_string(link.parent);
  }
  if (std::string wrong = wrongRigid(link.parentFromJoint); !wrong.empty()) return "parentFromJoint: " + wrong;
  if (link.joint > JointType::prismatic) return "joint: expected fixed, revolute or prismatic";
  if (link.joint != JointType::fixed) {
    for (const double value : link.axis) {
      if (!std::isfinite(value)) return "axis: expected 3 finite numbers, got " + textOf(value);
    }
    if (link.axis == Vector{}) return "axis: expected a vector that is not zero";
    if (link.variable >= chain.variables) {
      return "variable: expected less than " + std::to_string(chain.variables) + ", got " +
             std::to_string(link.variable);
    }
  }
  for (size_t i = 0; i < link.meshes.size(); ++i) {
    const std::string name = "mesh " + std::to_string(i) + ": ";
    if (!scene.hasMesh(link.meshes[i].mesh)) {
      return name + "mesh " + std::to_string(link.meshes[i].mesh) + " of the scene does not exist";
    }
    if (!scene.impl().meshes[link.meshes[i].mesh].parts.empty()) return name + "expected a mesh, got a cutter";
    if (std::string wrong = wrongPlace(link.meshes[i].linkFromMesh); !wrong.empty()) return name + wrong;
  }
  return {};
}

}  // namespace

std::string validate(const Chain& chain, const Scene& scene) {
  const FloatEnvironment floats;
  if (chain.links.size() > kMostLinks) {
    return "links: expected at most " + std::to_string(kMostLinks) + ", got " + std::to_string(chain.links.size());
  }
  for (uint32_t i = 0; i < chain.links.size(); ++i) {
    if (std::string wrong = wrongLink(chain, i, scene); !wrong.empty())
      return "link " + std::to_string(i) + ": " + wrong;
  }
  for (size_t i = 0; i < chain.pairs.size(); ++i) {
    const auto [a, b] = chain.pairs[i];
    if (a < chain.links.size() && b < chain.links.size() && a != b) continue;
    return "pair " + std::to_string(i) + ": expected two links below " + std::to_string(chain.links.size()) + ", got " +
           std::to_string(a) + " and " + std::to_string(b);
  }
  return {};
}

std::string validate(const ChainQuery& query, const Chain& chain, const Scene& scene) {
  const FloatEnvironment floats;
  for (const auto& [name, configuration] : {std::pair{"from", query.from}, std::pair{"to", query.to}}) {
    if (configuration.size() != chain.variables) {
      return std::string(name) + ": expected " + std::to_string(chain.variables) + " numbers, got " +
             std::to_string(configuration.size());
    }
    for (const Link& link : chain.links) {
      if (link.joint == JointType::fixed) continue;
      const double value = configuration[link.variable];
      const bool turns = link.joint == JointType::revolute;
      if (std::abs(value) <= (turns ? kMostAngle : kMostLength)) continue;
      return std::string(name) + ": variable " + std::to_string(link.variable) + ": expected " +
             (turns ? "an angle up to 2^16" : "a length up to 2^300") + ", got " + textOf(value);
    }
  }
  if (std::string wrong = wrongRigid(query.worldFromBase); !wrong.empty()) return "worldFromBase: " + wrong;
  for (const ObjectId object : query.exclude) {
    if (!scene.hasObject(object)) return "exclude: object " + std::to_string(object) + " does not exist";
  }
  if (!(query.clearance >= 0 && query.clearance <= kMostLength)) {
    return "clearance: expected 0 to 2^300, got " + textOf(query.clearance);
  }
  if (query.tolerance && !(std::isfinite(*query.tolerance) && *query.tolerance >= 0)) {
    return "tolerance: expected a finite number of 0 or more, got " + textOf(*query.tolerance);
  }
  return {};
}

}  // namespace radar
