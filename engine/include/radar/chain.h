// Chains of joints, such as robot arms: which conflict comes first between two configurations, with a certified bracket
// of its moment. On the CPU's cores.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "radar/answers.h"
#include "radar/query.h"

namespace radar {

enum class JointType : uint32_t { fixed, revolute, prismatic };

/// A mesh of a link.
struct LinkMesh {
  MeshId mesh = kNone;  ///< of the scene
  Transform linkFromMesh{};
};

/// A link and the joint that carries it. In a configuration q, the link is placed in its parent's frame by
///   parentFromJoint J(q[variable]),
/// where J turns by that angle, radians, about the axis through the joint's origin, by the right-hand rule (revolute),
/// moves by that length along axis / |axis| (prismatic), or does nothing (fixed). As in URDF.
struct Link {
  uint32_t parent = kNone;      ///< a link before this one; kNone: the base
  Transform parentFromJoint{};  ///< rigid: products of its columns differ from 0 and 1 by at most 1e-6
  JointType joint = JointType::fixed;
  std::array<double, 3> axis{1, 0, 0};  ///< in the joint's frame; of any length but 0
  uint32_t variable = kNone;            ///< of a joint that is not fixed; joints may share one
  std::vector<LinkMesh> meshes{};
};

struct Chain {
  std::vector<Link> links{};
  uint32_t variables = 0;  ///< numbers in a configuration
  /// Links that are tested with each other, beside the scene. Those that touch in all configurations, as neighbours at
  /// a joint do, do not belong here.
  std::vector<std::array<uint32_t, 2>> pairs{};
};

/// A chain moves from one configuration to another: each number q of it as from + s (to - from), for s from 0 to 1.
/// Objects move by Object::motion meanwhile.
struct ChainQuery {
  std::span<const double> from{}, to{};  ///< angles up to 2^16, lengths up to 2^300; in place until the answer is there
  Transform worldFromBase{};             ///< rigid, as joints are; all lengths up to 2^300
  bool anyHit = false;                   ///< as of Query
  std::vector<ObjectId> exclude{};
  uint32_t mask = ~0u;
  double clearance = 0;
  /// World units, at least 0; without a value, or with a larger one: 1e-6 of the longest side of the mesh of the link,
  /// in its frame, or of the clearance if that is longer.
  std::optional<double> tolerance{};
};

/// Of the exact motion: no link certainly has a point in common (with a clearance, is as near) with an object, or with
/// a link that it is tested with, before `contact.lo`, and at `contact.hi` some certainly cross (are nearer). t, lo and
/// hi are s. (hi - lo) times the greatest speed of the link's mesh is at most the tolerance, if rounding allows, where
/// a contact gets deeper than that at once. Another may be undecided, or have a wider bracket, as may what only touches
/// at the start, or at the end to within rounding; so may, without a clearance, a point or a segment that passes
/// through a face, and boxes that slide into boxes of the same width.
struct ChainResult {
  Result contact{};  ///< triA: of the link's mesh; triB: of the object's or of the other link's, which are touched
  uint32_t link = kNone, mesh = kNone;            ///< the mesh's number among the link's
  uint32_t otherLink = kNone, otherMesh = kNone;  ///< if it is a link; else contact.object is the object
};

/// Empty, or what is wrong and what was expected.
RADAR_API std::string validate(const Chain& chain, const Scene& scene);
RADAR_API std::string validate(const ChainQuery& query, const Chain& chain, const Scene& scene);

/// Answers batches of queries about one chain in one scene.
class RADAR_API ChainSweeper {
 public:
  /// As CpuSweeper. Throws Error if the chain breaks its contract.
  ChainSweeper(const Scene& scene, Chain chain, unsigned threads = 0);
  ~ChainSweeper();
  ChainSweeper(ChainSweeper&&) noexcept;
  ChainSweeper& operator=(ChainSweeper&&) noexcept;

  /// In the order of the queries. An answer does not depend on its batch or on the number of threads. Throws Error,
  /// naming the query, if one breaks its contract, before any is answered. Soon after `stop` is requested, returns;
  /// what is not answered is Status::invalid.
  std::vector<ChainResult> run(std::span<const ChainQuery> queries, const std::stop_token& stop = {});
  const Chain& chain() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
