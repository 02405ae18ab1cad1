#include "cpu/cutter_search.h"

#include <algorithm>
#include <cmath>

#include "cpu/bracketed_contact.h"
#include "cpu/node_gap.h"
#include "query/swept.h"

namespace radar::cpu {

namespace {

// Of nodes, between two looks at whether the search is still wanted.
constexpr uint32_t kVisits = 1024;

Vector product(const Matrix3& rows, const Vector& v) {
  return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)};
}
/// The product with the transpose.
Vector transposed(const Matrix3& rows, const Vector& v) {
  return along(along(scaled(v[0], rows[0]), v[1], rows[1]), v[2], rows[2]);
}

Matrix3 linearOf(const Transform& pose) {
  const auto& m = pose.m;
  return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}};
}

std::vector<RingHull> grown(const std::vector<RingHull>& parts, double clearance) {
  std::vector<RingHull> out;
  for (const RingHull& part : parts) out.emplace_back(part.rings(), clearance);
  return out;
}

/// Nodes of an object's tree, as a hull in motion sees them.
class NodeTimes {
 public:
  /// A point q of the mesh is at linear q + offset, off by at most `error`.
  NodeTimes(const HullMotion& motion, const Matrix3& linear, const Vector& offset, double error)
      : motion_(motion), linear_(linear), offset_(offset), error_(error) {}

  /// No earlier than this the hull meets what a node holds; infinite if certainly not before `latest`. `known`: a
  /// normal that may tell, or 0.
  double operator()(const gpu::MeshNode& node, const Vector& known, double latest) const {
    FreeTimes free;
    const auto add = [&](const Vector& n) {
      free.add(motion_, n, dot(n, offset_) - topAlong(node, linear_, scaled(-1, n)), error_);
    };
    if (known != Vector{}) add(known);
    Vector middle = offset_, half{};
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        middle[i] += linear_[i][k] * node.centre[k];
        half[i] += std::abs(linear_[i][k]) * node.halfExtent[k];
      }
    }
    // Any normals will do. That at the box's point nearest to the cutter's middle is good if the two are about to meet.
    for (int tries = 0; tries < 2 && !free.isFreeUntil(latest); ++tries) {
      Vector p{0, 0, motion_.hull.middle()};
      for (int i = 0; i < 3; ++i) {
        const double then = middle[i] - free.until() * motion_.way[i];
        p[i] = std::clamp(p[i], then - half[i], then + half[i]);
      }
      const RingHull::Foot foot = motion_.hull.footOf(p);
      if (foot.distance <= 0) break;
      add(foot.normal);
    }
    return free.isFreeUntil(latest) ? std::numeric_limits<double>::infinity() : free.until();
  }

 private:
  const HullMotion& motion_;
  const Matrix3& linear_;
  const Vector& offset_;
  double error_;
};

}  // namespace

/// A cutter, and its motion past an object, in the cutter's frame.
class CutterSearch::Way {
 public:
  Way(const Query& query, const Mesh& cutter)
      : query_(query),
        pose_(linearOf(query.worldFromMesh)),
        origin_{query.worldFromMesh.m[3], query.worldFromMesh.m[7], query.worldFromMesh.m[11]},
        axes_(pose_),
        grown_(query.clearance > 0 ? grown(cutter.parts, query.clearance) : std::vector<RingHull>()),
        parts_(query.clearance > 0 ? grown_ : cutter.parts) {
    // A coordinate in this frame is off by less than this part of what it is summed from.
    loss_ = 2 * (std::max({axes_.residual[0], axes_.residual[1], axes_.residual[2]}) + 40 * kUnit);
    // A ball of the world is one of this frame, but for what the pose lacks of being rigid.
    if (query.clearance == 0) return;
    double lack = 16 * kUnit;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        lack += std::abs(pose_[0][i] * pose_[0][k] + pose_[1][i] * pose_[1][k] + pose_[2][i] * pose_[2][k] - (i == k));
      }
    }
    bulge_ = 2 * lack * query.clearance;
  }

  /// `motion` must stay in place until the next.
  void setMotion(const Translation& motion) {
    motion_ = &motion;
    const Vector way = motion.isStep && !motion.stands ? motion.direction : motion.unit;
    way_ = product(axes_.rows, way);
    drift_ = (loss_ + (motion.isStep ? 0 : 16 * kUnit)) * norm1(way);
  }

  size_t count() const { return parts_.size(); }
  HullMotion motionOf(size_t part) const { return {parts_[part], way_, drift_}; }
  /// What the object's normalised vertices are here.
  struct Placed {
    Matrix3 linear;
    Vector offset;
    double error;
  };
  Placed placed(const MeshPlacement& placement, size_t part) const {
    Placed out;
    const Vector apart = minus(placement.origin, origin_);
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        out.linear[i][k] = axes_.rows[i][0] * placement.linear[0][k] + axes_.rows[i][1] * placement.linear[1][k] +
                           axes_.rows[i][2] * placement.linear[2][k];
      }
    }
    out.offset = product(axes_.rows, apart);
    const double size = norm1(apart) + norm1(placement.extent);
    out.error = (loss_ + 64 * kUnit) * size + 2 * norm1(placement.error) + 32 * kUnit * parts_[part].size() + bulge_;
    return out;
  }
  /// A normal of the cutter's frame, from it to an object, of a world's from the object.
  Vector normalOf(const Vector& across) const { return scaled(-1, transposed(pose_, across)); }
  double latest(const PairVisitor& visitor) const { return motion_->stands ? 0 : visitor.latest(); }

  std::optional<Approach> approach(size_t part, const exact::Triangle& corners, double latest) const {
    exact::Triangle here;
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector apart = minus(corners[i], origin_);
      here[i] = product(axes_.rows, apart);
      size = std::max(size, norm1(apart));
    }
    const auto found = contactOf(motionOf(part), here, loss_ * size + bulge_, motion_->stands ? 0 : latest);
    if (!found) return std::nullopt;
    // That is the end of the way at most, or of a part of it within which another contact is known.
    const bool isLate = found->hi > motion_->end || (motion_->stands && found->hi > 0);
    Approach out{found->lo, isLate ? std::numeric_limits<double>::infinity() : found->hi, {}};
    if (std::isinf(out.hi)) return out;
    const Vector& at = found->weights;
    int touching = 0;
    for (int i = 0; i < 3; ++i) touching += at[i] > 0 ? 1 : 0;
    Vector& point = out.atLo.point;
    for (int i = 0; i < 3; ++i) {
      if (at[i] == 1) point = corners[i];
    }
    if (touching > 1) {
      point = corners[0];
      for (int i = 1; i < 3; ++i) point = along(point, at[i], minus(corners[i], corners[0]));
    }
    if (motion_->isStep) point = along(point, out.lo, motion_->drift);
    const Vector normal = transposed(axes_.rows, found->normal);
    out.atLo.normal = scaled(-1 / std::sqrt(dot(normal, normal)), normal);
    out.atLo.distance = out.hi == 0 ? std::numeric_limits<double>::quiet_NaN() : query_.clearance;
    out.atLo.features = {Feature::none, static_cast<Feature>(touching)};
    return out;
  }

 private:
  const Query& query_;
  Matrix3 pose_;
  Vector origin_;
  MeshAxes axes_;
  const std::vector<RingHull> grown_, &parts_;
  double loss_ = 0, bulge_ = 0;
  const Translation* motion_ = nullptr;
  Vector way_{};
  double drift_ = 0;
};

class CutterSearch::Contact final : public BracketedContact {
 public:
  Contact(const Query& query, double end, const Way& way) : BracketedContact(query, end, 0), way_(way) {}

 private:
  std::optional<Approach> bracketOf(const exact::PairName& name, const exact::PlacedPair& pair) override {
    return way_.approach(name.triA, pair.b, latest_);
  }
  bool counts(const exact::PlacedPair&) const override { return true; }

  const Way& way_;
};

/// Of what certainly touches at the start, finds the least.
class CutterSearch::LeastAtStart final : public PairVisitor {
 public:
  explicit LeastAtStart(const Way& way) : PairVisitor(0), way_(way) {}

  void consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis) override {
    if (isBefore(name)) return;
    const auto found = way_.approach(name.triA, pair.b, 0);
    if (!found || found->hi != 0) return;
    atStart_ = true;
    first_ = name;
    nearest_ = found->atLo;
  }
  void describe(Result& result) const {
    if (!atStart_) return;
    result.object = first_.object;
    result.triB = first_.triB;
    result.triA = first_.triA;
    setSeparation(result, nearest_);
  }

 private:
  const Way& way_;
  Separation nearest_{};
};

Result CutterSearch::answer(const Query& query, const Scene::Impl& scene, const ObjectTree& tree, Listed* lists,
                            uint64_t& pairs, const std::stop_token& stop) {
  const Course course(query, scene);
  const Translation motion = course.past();
  Way way(query, scene.meshes[query.mesh]);
  std::optional<Translation> past;
  const auto consider = [&](ObjectId id, PairVisitor& visitor) {
    const Object& object = scene.objects[id].object;
    way.setMotion(course.isStep() ? past.emplace(course.past(id)) : motion);
    search(way, id, object, scene.meshes[object.mesh], visitor, pairs, stop);
  };
  Contact contact(query, motion.end, way);
  const auto reach = [&] { return reachOf(contact, motion); };
  const Participants participants(query, scene);
  const Box box = roomyBox(query, scene);
  walk(participants, tree, motion, box, reach, [&](ObjectId id) {
    consider(id, contact);
    contact.endObject();
  });
  Result first = contact.first();
  if (first.status == Status::overlap) {
    LeastAtStart least(way);
    walk(
        participants, tree, motion, box, [] { return 0.0; }, [&](ObjectId id) { consider(id, least); });
    least.describe(first);
  }
  course.toQuery(first);
  if (lists == nullptr) return first;
  *lists = {contact.nearest(), {}, {}, {}};
  for (Result& hit : lists->hits) {
    if (hit.status == Status::overlap) {
      LeastAtStart least(way);
      consider(hit.object, least);
      least.describe(hit);
    }
    course.toQuery(hit);
  }
  return first;
}

void CutterSearch::search(const Way& way, ObjectId id, const Object& object, const Mesh& mesh, PairVisitor& visitor,
                          uint64_t& pairs, const std::stop_token& stop) {
  const MeshTree& tree = mesh.tree;
  const MeshPlacement placement(mesh, object.worldFromMesh);
  uint32_t visits = 0;
  for (uint32_t part = 0; part < way.count() && !visitor.isDecided(); ++part) {
    const Way::Placed placed = way.placed(placement, part);
    const HullMotion motion = way.motionOf(part);
    const NodeTimes times(motion, placed.linear, placed.offset, placed.error);
    Vector known{};
    const auto openOf = [&](uint32_t node) { return Open{times(tree.nodes[node], known, way.latest(visitor)), node}; };
    open_ = {openOf(0)};
    while (!open_.empty() && !visitor.isDecided()) {
      const Open open = open_.back();
      open_.pop_back();
      const MeshTree::Below& below = tree.below[open.node];
      if (std::isinf(open.near) || open.near > way.latest(visitor)) continue;
      if (visitor.isBefore({id, below.least, part})) continue;
      if (++visits % kVisits == 0) throwIfStopped(stop);
      const gpu::MeshNode& node = tree.nodes[open.node];
      if (!isLeaf(node)) {
        Open nearer = openOf(node.link), farther = openOf(node.link + 1);
        if (farther.near < nearer.near) std::swap(nearer, farther);
        if (!std::isinf(farther.near)) open_.push_back(farther);
        if (!std::isinf(nearer.near)) open_.push_back(nearer);
        continue;
      }
      pairs += below.count;
      for (uint32_t i = 0; i < below.count; ++i) {
        const uint32_t triangle = tree.order[below.first + i];
        visitor.consider({id, triangle, part}, {{}, placedTriangle(mesh, object.worldFromMesh, triangle)}, 0);
      }
      if (visitor.across() != Vector{}) known = way.normalOf(visitor.across());
    }
  }
}

}  // namespace radar::cpu
