#include "cpu/chain_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "math/frame.h"
#include "query/swept.h"

namespace radar::cpu {

namespace {

constexpr double kRoom = 1 + 0x1p-40;  // for the roundings of bounds
constexpr double kSteps = 8;           // of a part

}  // namespace

ChainPlan::ChainPlan(const Chain& chain, const Scene::Impl& scene) {
  std::vector<std::vector<size_t>> ofLink(chain.links.size());
  for (auto link = static_cast<uint32_t>(chain.links.size()); link-- > 0;) {
    const std::vector<LinkMesh>& meshes = chain.links[link].meshes;
    for (uint32_t number = 0; number < meshes.size(); ++number) {
      const auto& [id, pose] = meshes[number];
      const Mesh& mesh = scene.meshes[id];
      Body body{link,
                number,
                &mesh,
                pose,
                {mesh, pose},
                boxOf(mesh, pose.m),
                {},
                0,
                0,
                0,
                0,
                LinkWay::between(chain, kNone, link)};
      Vector half, far;
      for (int k = 0; k < 3; ++k) {
        body.middle[k] = body.box.middle(k);
        half[k] = std::max(body.box.hi[k] - body.middle[k], body.middle[k] - body.box.lo[k]);
        far[k] = std::max(std::abs(body.box.lo[k]), std::abs(body.box.hi[k]));
        body.error = std::max(body.error, 16 * kUnit * magnitudeAlong(&pose.m[4 * k], mesh.span()));
      }
      body.half = kRoom * norm(half);
      body.radius = kRoom * norm(far);
      body.least = bendAllowed(mesh, pose, body.half);
      ofLink[link].push_back(bodies.size());
      bodies.push_back(std::move(body));
    }
  }
  for (const auto& [first, second] : chain.pairs) {
    const uint32_t root = commonLink(chain, first, second);
    const LinkWay wayA = LinkWay::between(chain, root, first), wayB = LinkWay::between(chain, root, second);
    for (const size_t a : ofLink[first]) {
      for (const size_t b : ofLink[second]) pairs.push_back({a, b, wayA, wayB});
    }
  }
}

struct ChainSearch::Task {
  const Scene::Impl& scene;
  const ChainMotion& motion;
  const Query& query;  ///< what is asked, but for the motion
  const std::stop_token& stop;
};

struct ChainSearch::Moving {
  const ChainPlan::Body& body;
  const LinkWay& way;
  WayBounds points, middle;
  SpinBounds spin;
  double half;  ///< as of the body

  Moving(const ChainMotion& motion, const ChainPlan::Body& of, const LinkWay& along)
      : body(of),
        way(along),
        points(motion.boundsFor(along, of.radius, of.error)),
        middle(motion.boundsFor(along, kRoom * norm(of.middle), of.error)),
        spin(motion.spinOf(along)),
        half(points.scale * of.half) {}

  /// In a part of `length`, of a point: off its straight way.
  double bend(double length) const { return kRoom * length * length * points.turning / 8; }
  /// Of a point with that speed and second derivative which comes within `clearance`: off its straight way, as seen
  /// from this body. With z from its middle to the point, that is R^T z, of which the second derivative is at most
  /// |z''| + 2 w |z'| + (w^2 + w') |z|.
  double bendSeen(double length, double speed, double turning, double clearance) const {
    const double past = middle.speed + speed, far = half + clearance + past * length;
    return points.scale * points.scale * kRoom * length * length / 8 *
           (middle.turning + turning + 2 * spin.speed * past + (spin.speed * spin.speed + spin.turning) * far);
  }
  /// In how many parts a body that moves so may be searched past points that do.
  double parts(double speed, double turning, double clearance) const {
    const double least = std::max(body.least, 0x1p-14 * (points.speed + speed));
    return partsOf(spin.speed, least,
                   [&](double share) { return std::max(bend(share), bendSeen(share, speed, turning, clearance)); });
  }
};

ChainResult ChainSearch::answer(const ChainQuery& asked, const Chain& chain, const ChainPlan& plan,
                                const Scene::Impl& scene, const std::stop_token& stop) {
  const ChainMotion motion(chain, asked);
  Query query;
  query.anyHit = asked.anyHit;
  query.exclude = asked.exclude;
  query.mask = asked.mask;
  query.clearance = asked.clearance;
  query.tolerance = asked.tolerance;
  const Task task{scene, motion, query, stop};
  who_.clear();
  ChainContact finder(query, motion);
  searchObjects(task, plan, finder);
  for (const ChainPlan::Pair& pair : plan.pairs) {
    if (finder.isDecided()) break;
    const ChainPlan::Body &a = plan.bodies[pair.a], &b = plan.bodies[pair.b];
    who_.push_back({&a, kNone, &b});
    searchPair(task, pair, finder);
  }
  ChainResult out;
  out.contact = finder.first();
  out.contact.tier = Tier::reference;
  if (out.contact.object == kNone) return out;
  const Who& who = who_[out.contact.object];
  out.contact.object = who.object;
  out.link = who.body->link;
  out.mesh = who.body->number;
  if (who.other != nullptr) {
    out.otherLink = who.other->link;
    out.otherMesh = who.other->number;
  }
  return out;
}

/// A body's way from the base, part by part.
class ChainSearch::Ahead {
 public:
  Ahead(const Task& task, const ChainPlan::Body& body)
      : motion_(task.motion),
        moving_(task.motion, body, body.way),
        count_(moving_.parts(0, 0, task.query.clearance)),
        error_(moving_.points.error + 16 * kUnit * (norm1(task.motion.base()) + moving_.points.reach)),
        last_(endAt(0)) {}

  const Moving& moving() const { return moving_; }
  /// Where the next part begins; infinite after the last one.
  double from() const { return index_ < count_ ? last_.s : INFINITY; }
  PathPart next() {
    ++index_;
    const PathPart::End first = std::exchange(last_, endAt(index_ < count_ ? index_ / count_ : 1));
    return {*moving_.body.mesh, first, last_, moving_.bend(kRoom * (last_.s - first.s)), error_};
  }

 private:
  PathPart::End endAt(double s) const {
    Transform pose = motion_.pose(moving_.way, s);
    const Vector base = motion_.base();
    for (int k = 0; k < 3; ++k) pose.m[4 * k + 3] += base[k];
    return {s, product(pose, moving_.body.pose), transform(pose, moving_.body.middle)};
  }

  const ChainMotion& motion_;
  Moving moving_;
  double count_, index_ = 0, error_;
  PathPart::End last_;
};

// All bodies' ways at once, so that an early conflict of one ends the search of all.
void ChainSearch::searchObjects(const Task& task, const ChainPlan& plan, ChainContact& finder) {
  const ObjectTree& tree = task.scene.objectTree();
  const double clearance = task.query.clearance;
  const Participants participants(task.query, task.scene);
  std::vector<Ahead> ahead;
  ahead.reserve(plan.bodies.size());
  for (const ChainPlan::Body& body : plan.bodies) ahead.emplace_back(task, body);
  while (!finder.isDecided() && !ahead.empty()) {
    Ahead& earliest = *std::ranges::min_element(ahead, {}, &Ahead::from);
    if (std::isinf(earliest.from()) || earliest.from() > finder.latest()) break;
    const PathPart part = earliest.next();
    Box start = part.start;
    for (int k = 0; k < 3; ++k) {
      start.lo[k] -= clearance;
      start.hi[k] += clearance;
    }
    walk(
        participants, tree, part.piece, start, [&] { return reachOf(finder, part.piece); },
        [&](ObjectId id) { searchObject(task, earliest.moving(), part, id, finder); });
  }
}

void ChainSearch::searchObject(const Task& task, const Moving& moving, const PathPart& part, ObjectId id,
                               ChainContact& finder) {
  throwIfStopped(task.stop);
  const ChainPlan::Body& body = moving.body;
  const Object& object = task.scene.objects[id].object;
  const Mesh& mesh = task.scene.meshes[object.mesh];
  const MeshPlacement placement(mesh, object.worldFromMesh);
  const double drift = norm1(object.motion), speed = moving.points.speed + drift,
               length = kRoom * (part.end - part.from);
  const auto name = static_cast<ObjectId>(who_.size());
  who_.push_back({&body, id, nullptr});
  finder.beginObject({&body.way, &body.way, body.error}, object.motion, pathToleranceOf(task.query, body.box, speed),
                     speed);
  PathPair pair = pairOf({*body.mesh, body.pose, body.placement}, part, {mesh, object.worldFromMesh, placement}, name,
                         object.motion, task.query.clearance);
  pair.steps = kSteps;
  pair.bendSeen = moving.bendSeen(length, drift, 0, task.query.clearance);
  meshes_.run(pair, finder, pairs_, task.stop);
  if (!finder.isFirst(name)) who_.pop_back();
}

void ChainSearch::searchPair(const Task& task, const ChainPlan::Pair& of, ChainContact& finder) {
  const ChainPlan::Body &bodyA = *who_.back().body, &bodyB = *who_.back().other;
  // A clearance is a length in the world.
  const bool isInWorld = task.query.clearance > 0 && !task.motion.keepsLengths(of.wayA.root);
  const LinkWay &wayA = isInWorld ? bodyA.way : of.wayA, &wayB = isInWorld ? bodyB.way : of.wayB;
  const Moving a(task.motion, bodyA, wayA), b(task.motion, bodyB, wayB);
  const double clearance = task.query.clearance, speed = a.points.speed + b.points.speed;
  const double error = a.points.error + b.points.error;
  const double count = std::max(a.parts(b.points.speed, b.points.turning, clearance),
                                b.parts(a.points.speed, a.points.turning, clearance));
  finder.beginLinks({&wayA, &bodyA.way, bodyA.error}, {&wayB, &bodyB.way, bodyB.error},
                    pathToleranceOf(task.query, bodyA.box, speed), speed);
  const auto search = [&](double from, double end) {
    const double length = kRoom * (end - from);
    PathPair pair{{*bodyA.mesh, bodyA.pose, bodyA.placement},
                  {*bodyB.mesh, bodyB.pose, bodyB.placement},
                  static_cast<ObjectId>(who_.size() - 1)};
    pair.from = from;
    pair.end = end;
    const auto placed = [&](const Moving& moving, double s) {
      return MeshPlacement(*moving.body.mesh, product(task.motion.pose(moving.way, s), moving.body.pose));
    };
    const MeshPlacement atA[2]{placed(a, from), placed(a, end)}, atB[2]{placed(b, from), placed(b, end)};
    const MeshAxes axesA[2]{MeshAxes(atA[0].linear), MeshAxes(atA[1].linear)};
    const MeshAxes axesB[2]{MeshAxes(atB[0].linear), MeshAxes(atB[1].linear)};
    for (int e = 0; e < 2; ++e) {
      pair.a[e] = {&atA[e], &axesA[e]};
      pair.b[e] = {&atB[e], &axesB[e]};
      pair.gap[e] = minus(atB[e].origin, atA[e].origin);
    }
    pair.steps = kSteps;
    pair.apart = clearance + error;
    pair.bend = b.bendSeen(length, a.points.speed, a.points.turning, clearance);
    pair.bendSeen = a.bendSeen(length, b.points.speed, b.points.turning, clearance);
    meshes_.run(pair, finder, pairs_, task.stop);
  };
  const auto middleAt = [&](const Moving& moving, double s) {
    return transform(task.motion.pose(moving.way, s), moving.body.middle);
  };
  // Earlier halves first; none in which balls around both stay apart.
  const auto visit = [&](const auto& self, double from, double end) -> void {
    throwIfStopped(task.stop);
    if (finder.isDecided() || finder.latest() < from) return;
    const double middle = from + 0.5 * (end - from), length = kRoom * (end - from);
    const double apart = norm(minus(middleAt(a, middle), middleAt(b, middle))) * (1 - 0x1p-40);
    const double near = a.half + b.half + (1 + 2 * ChainMotion::kKeptLengths) * clearance + a.middle.error +
                        b.middle.error + (a.middle.speed + b.middle.speed) * length / 2;
    if (apart > kRoom * near) return;
    if (length * count <= 1 + 0x1p-20) return search(from, end);
    self(self, from, middle);
    self(self, middle, end);
  };
  visit(visit, 0, 1);
}

}  // namespace radar::cpu
