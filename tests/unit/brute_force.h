// What a query's answer must be, by brute force over all pairs of triangles in exact integers.
#pragma once

#include <string>

#include "exact_oracle.h"

namespace oracle {

/// A first contact.
struct Contact {
  Fraction s;  ///< least parameter, 0 for overlap; of a step its fraction
  radar::ObjectId object = radar::kNone;
  uint32_t triB = radar::kNone, triA = radar::kNone;
  bool isOfStep = false;  ///< the query has a motion, or objects move
};

struct Truth {
  std::vector<radar::ObjectId> overlapping;  ///< objects that are skipped, ascending
  std::vector<Contact> contacts;             ///< within D, one per object, by (t, object)
};

/// Whether the query counts the object, by its mask and what is excluded.
bool takesPart(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id);

/// Whether the pose turns a mesh inside out.
bool isMirrored(const radar::Transform& pose);

/// How far the sensor and an object may sink into each other by rounding.
double slackOf(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id);

/// Whether the query takes a step; along what its sensor then moves past an object, at rest if that is 0.
bool isStep(const radar::Scene& scene, const radar::Query& query);
Corner directionPast(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id);

/// Whether surfaces cross at the start by more than the slack.
bool surfacesCross(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id);

/// Of a query without a clearance.
Truth truthOf(const radar::Scene& scene, const radar::Query& query);

/// Sign of the contact's t - limit.
int compareToTime(const Contact& contact, const radar::Query& query, double limit);

/// What is wrong with the status, the pair and the bracket of an answer, in words; empty if nothing is. `contact`: null
/// if there is none.
std::string faultOf(const Contact* contact, const radar::Query& query, const radar::Result& result);

/// What is wrong with an answer and with its lists.
std::string faultOf(const Truth& truth, const radar::Query& query, const radar::Result& result,
                    std::span<const radar::Result> hits, std::span<const radar::ObjectId> overlapping);

/// What is wrong with the normal of a hit, or of an overlap that has one, in words; empty if nothing is. In exact
/// arithmetic but for the rounding of the normal itself: whether it is a unit vector, does not point along the motion,
/// and keeps apart, at the moment of contact, the triangles of the answer; all triangles around the point of contact,
/// if some normal against the motion does; and all that touch then, if one of a touching pair of triangles does.
std::string faultOfNormal(const radar::Scene& scene, const radar::Query& query, const radar::Result& hit);

}  // namespace oracle
