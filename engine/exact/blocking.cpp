#include "exact/blocking.h"

#include <algorithm>

#include "exact/bounded.h"
#include "exact/determinant.h"
#include "exact/three.h"

namespace radar::exact {

namespace {

// The decisions below are written once, for two kinds of numbers: Bounded, which may leave them open, and Dyadic.
enum class Answer { no, yes, open };

Answer operator!(Answer answer) {
  return answer == Answer::open ? answer : answer == Answer::no ? Answer::yes : Answer::no;
}

Answer both(Answer p, Answer q) {
  if (p == Answer::no || q == Answer::no) return Answer::no;
  return p == Answer::yes && q == Answer::yes ? Answer::yes : Answer::open;
}

Answer either(Answer p, Answer q) {
  return !both(!p, !q);
}

Answer isPositive(const Bounded& x) {
  return x.sign() > 0 ? Answer::yes : x.isCertain() ? Answer::no : Answer::open;
}

Answer isPositive(const Dyadic& x) {
  return x.sign() > 0 ? Answer::yes : Answer::no;
}

Dyadic abs(const Dyadic& x) {
  return x.sign() < 0 ? Dyadic(0) - x : x;
}

Dyadic max(const Dyadic& p, const Dyadic& q) {
  return (p - q).sign() < 0 ? q : p;
}

/// How far two triangles reach past each other along a normal n.
template <class Number>
struct Depths {
  Number forward;   ///< greatest n . (b - a)
  Number backward;  ///< greatest n . (a - b)
  Number allowed;   ///< slack times the largest component of n
};

/// Two placed triangles, and the way if one counts.
template <class Number>
class Pair {
 public:
  Pair(const Triangle& a, const Triangle& b, const Way* way, double slack) : moves_(way != nullptr), slack_(slack) {
    const Three<Number> origin = numbers<Number>(a[0]);
    for (size_t i = 0; i < 3; ++i) {
      a_[i] = minus(numbers<Number>(a[i]), origin);
      b_[i] = minus(numbers<Number>(b[i]), origin);
    }
    for (size_t i = 0; i < 3; ++i) {
      edgesA_[i] = minus(a_[(i + 1) % 3], a_[i]);
      edgesB_[i] = minus(b_[(i + 1) % 3], b_[i]);
    }
    if (way != nullptr) {
      direction_ = numbers<Number>(way->direction);
      distance_ = Number(way->distance);
      length_ = Number(way->length);
    }
    normalA_ = crossProduct(edgesA_[0], edgesA_[1]);
    normalB_ = crossProduct(edgesB_[0], edgesB_[1]);
    depthsA_ = depthsAlong(normalA_);
    depthsB_ = depthsAlong(normalB_);
  }

  /// Whether the triangles lie in one plane, face each other and overlap.
  Answer areFlush(Mirrored mirrored) const {
    const Number facing = inner(normalA_, normalB_);
    Answer flush = isPositive(mirrored.a == mirrored.b ? Number(0) - facing : facing);
    if (flush == Answer::no) return flush;
    flush = both(flush, either(isThin(depthsA_), isThin(depthsB_)));
    for (size_t i = 0; i < 3 && flush != Answer::no; ++i) {
      flush = both(flush, overlapAlong(crossProduct(normalA_, edgesA_[i])));
      flush = both(flush, overlapAlong(crossProduct(normalB_, edgesB_[i])));
    }
    return flush;
  }

  /// Whether flush triangles would sink into each other by more than the slack: no plane that has the solid behind b on
  /// its one side, and a on the other, does for the whole motion.
  Answer isPressing(bool mirrored) const {
    Three<Number> outwards = normalB_;
    if (mirrored) outwards = minus(Three<Number>{Number(0), Number(0), Number(0)}, normalB_);
    const Number sinking = distance_ * (Number(0) - inner(direction_, outwards));
    const Answer sinks = isPositive(sinking - length_ * depthsB_.allowed);
    return sinks == Answer::no ? sinks : both(sinks, areInseparable(&outwards));
  }

  /// Whether no normal keeps the triangles apart; only those count that lead `outwards`, if that is given. The normals
  /// are those of all faces of the polyhedron of differences b - a or, with a direction, b - a - s * direction for all
  /// s >= 0.
  Answer areInseparable(const Three<Number>* outwards = nullptr) const {
    Answer exists = Answer::no, apart = Answer::no;
    const auto tryNormal = [&](const Three<Number>& n, const Depths<Number>& depths, bool isAcross) {
      const Answer isNormal = isNotZero(n);
      exists = either(exists, isNormal);
      if (isNormal != Answer::no) apart = either(apart, both(isNormal, separates(n, depths, isAcross, outwards)));
      return apart == Answer::yes;
    };
    if (tryNormal(normalA_, depthsA_, false) || tryNormal(normalB_, depthsB_, false)) return Answer::no;
    for (size_t i = 0; i < 6 && moves_; ++i) {
      const Three<Number> n = crossProduct(direction_, i < 3 ? edgesA_[i] : edgesB_[i - 3]);
      if (tryNormal(n, depthsAlong(n), true)) return Answer::no;
    }
    for (size_t i = 0; i < 9; ++i) {
      const Three<Number> n = crossProduct(edgesA_[i / 3], edgesB_[i % 3]);
      if (tryNormal(n, depthsAlong(n), false)) return Answer::no;
    }
    return both(exists, !apart);
  }

 private:
  static Answer isNotZero(const Three<Number>& n) {
    Answer positive = Answer::no;
    for (const Number& c : n) positive = either(positive, isPositive(abs(c)));
    return positive;
  }

  Depths<Number> depthsAlong(const Three<Number>& n) const {
    const Number zero(0), a1 = inner(n, a_[1]), a2 = inner(n, a_[2]);
    const Number b0 = inner(n, b_[0]), b1 = inner(n, b_[1]), b2 = inner(n, b_[2]);
    return {max(max(b0, b1), b2) + max(max(zero, zero - a1), zero - a2),
            max(max(zero, a1), a2) + max(max(zero - b0, zero - b1), zero - b2),
            slack_ * max(max(abs(n[0]), abs(n[1])), abs(n[2]))};
  }

  /// Whether n or -n keeps the triangles apart. `isAcross`: n is orthogonal to the direction.
  Answer separates(const Three<Number>& n, const Depths<Number>& depths, bool isAcross,
                   const Three<Number>* outwards) const {
    Answer forward = !isPositive(depths.forward - depths.allowed);
    Answer backward = !isPositive(depths.backward - depths.allowed);
    if (moves_ && !isAcross && (forward != Answer::no || backward != Answer::no)) {
      const Number along = inner(n, direction_);
      forward = both(forward, !isPositive(Number(0) - along));
      backward = both(backward, !isPositive(along));
    }
    if (outwards != nullptr && (forward != Answer::no || backward != Answer::no)) {
      const Number leads = inner(n, *outwards);
      forward = both(forward, isPositive(leads));
      backward = both(backward, isPositive(Number(0) - leads));
    }
    return either(forward, backward);
  }

  static Answer isThin(const Depths<Number>& depths) {
    return both(!isPositive(depths.forward - depths.allowed), !isPositive(depths.backward - depths.allowed));
  }

  Answer overlapAlong(const Three<Number>& n) const {
    const Depths<Number> depths = depthsAlong(n);
    return both(isPositive(depths.forward - depths.allowed), isPositive(depths.backward - depths.allowed));
  }

  bool moves_;
  Number slack_, distance_, length_;
  Three<Number> a_[3], b_[3], edgesA_[3], edgesB_[3];  // corners relative to corner 0 of a
  Three<Number> direction_, normalA_, normalB_;
  Depths<Number> depthsA_, depthsB_;
};

/// Whether doubles with error bounds may compute with these numbers.
bool haveSafeRange(const Triangle& a, const Triangle& b, const Way* way, double slack) {
  bool safe = hasSafeRange(slack);
  for (size_t k = 0; k < 3; ++k) {
    for (size_t i = 1; i < 3; ++i) safe &= hasSafeRange(a[i][k] - a[0][k]);
    for (size_t i = 0; i < 3; ++i) safe &= hasSafeRange(b[i][k] - a[0][k]);
    if (way != nullptr) safe &= hasSafeRange(way->direction[k]);
  }
  if (way != nullptr) safe &= hasSafeRange(way->distance) && hasSafeRange(way->length);
  return safe;
}

template <class Decide>
bool decided(const Triangle& a, const Triangle& b, const Way* way, double slack, const Decide& decide) {
  if (haveSafeRange(a, b, way, slack)) {
    const Answer rough = decide(Pair<Bounded>(a, b, way, slack));
    if (rough != Answer::open) return rough == Answer::yes;
  }
  return decide(Pair<Dyadic>(a, b, way, slack)) == Answer::yes;
}

}  // namespace

bool isMirroring(const Transform& pose) {
  const auto row = [&](int i) { return Vector{pose.m[4 * i], pose.m[4 * i + 1], pose.m[4 * i + 2]}; };
  const Vector first = row(0), second = row(1), third = row(2);
  return sign(Determinant{{kOrigin, first}, {kOrigin, second}, {kOrigin, third}}) < 0;
}

bool blocks(const Triangle& a, const Triangle& b, const Way& way, double slack, Mirrored mirrored) {
  return decided(a, b, &way, slack, [&](const auto& pair) {
    const Answer flush = pair.areFlush(mirrored);
    if (flush == Answer::open) return flush;
    return flush == Answer::yes ? pair.isPressing(mirrored.b) : pair.areInseparable();
  });
}

bool arePressed(const Triangle& a, const Triangle& b, const Way& way, double slack, Mirrored mirrored) {
  return decided(a, b, &way, slack, [&](const auto& pair) {
    const Answer flush = pair.areFlush(mirrored);
    return flush == Answer::no ? flush : both(flush, pair.isPressing(mirrored.b));
  });
}

bool cross(const Triangle& a, const Triangle& b, double slack) {
  return decided(a, b, nullptr, slack, [](const auto& pair) { return pair.areInseparable(); });
}

}  // namespace radar::exact
