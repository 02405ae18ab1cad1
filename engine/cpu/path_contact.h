// Finds when two triangles first touch, or come within a clearance, whose corners move smoothly, for s from 0 to 1.
#pragma once

#include "cpu/bracketed_contact.h"
#include "cpu/pair_motion.h"

namespace radar::cpu {

/// World units: how narrow brackets are to be, times the greatest speed (Query::tolerance), of what is in `box`.
/// `speed`: of a sensor without a size, which replaces it.
double pathToleranceOf(const Query& query, const Box& box, double speed);

/// How two triangles move.
class PairPath {
 public:
  /// About a common point, divided by a power of two so that products neither over- nor underflow.
  struct Places {
    exact::Triangle a, b;
  };
  virtual Places at(double s) const = 0;
  /// Whether they certainly are in contact at the start, or touch without a contact that counts.
  enum class Start { open, meet, rest };
  virtual Start atStart() const { return certainlyMeet(at(0)) ? Start::meet : Start::open; }
  /// In the world.
  virtual Separation separationAt(double s) const = 0;

  double error() const { return error_; }
  double speed() const { return speed_; }
  double bend() const { return bend_; }
  /// How deep they may cross without a contact, world units; 0: touching is one.
  double slack() const { return slack_; }

  /// Of a time of `length`, at whose ends they are at `begin` and `end`, the part in which they may be nearer than the
  /// clearance, less `depth`; of 1.
  TimeSpan possible(const Places& begin, const Places& end, double length, double depth) const;
  /// Whether they certainly cross by more than the slack, or are nearer than the clearance.
  bool certainlyMeet(const Places& places) const;

 protected:
  explicit PairPath(double clearance) : clearance_(clearance) {}
  ~PairPath() = default;
  /// `most`: no coordinate of Places is larger in world units.
  void setUnit(double most);

  const double clearance_;
  // World units, in 1 of s: of a corner of a, relative to b. Error: of its place, and of times. Bend: off its straight
  // way, across `axis_`, or in any direction if that is 0.
  double error_ = 0, speed_ = 0, bend_ = 0, slack_ = 0;
  Vector axis_{};
  double unit_ = 1;
};

/// Brackets of s.
class PathContact : public BracketedContact {
 public:
  /// Of the pairs considered next: they are known not to meet before `from`, and are of no interest after `to`.
  void setTimes(double from, double to) {
    from_ = from;
    to_ = to;
  }

 protected:
  /// `query` outlives this: what it asks, but for the motion.
  explicit PathContact(const Query& query) : BracketedContact(query, 1, 0) {}
  ~PathContact() = default;
  /// Before pairs: how narrow brackets are to be times the greatest speed, world units, and that speed.
  void setTolerance(double tolerance, double speed);
  /// Of the pair's first contact; none if it certainly does not meet in time to matter.
  std::optional<Approach> bracket(const PairPath& pair) const;

 private:
  bool counts(const exact::PlacedPair&) const override { return true; }
  std::optional<Approach> bracket(const PairPath& pair, double depth) const;

  double tolerance_ = 0;  // half of the one that is asked for
  double fine_ = 1;       // s in which the sensor moves by tolerance_
  double from_ = 0, to_ = 1;
};

}  // namespace radar::cpu
