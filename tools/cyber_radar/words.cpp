#include "cyber_radar/words.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace radar::tools {

namespace {

std::string triangleInWords(uint32_t triangle, Feature feature) {
  const std::string name = "triangle " + std::to_string(triangle);
  return feature == Feature::none || feature == Feature::face ? name : nameOf(feature) + (" of " + name);
}

/// object 3 "lid" (gearbox.glb#3)
std::string objectInWords(const Workload& workload, uint32_t scene, ObjectId object) {
  const std::vector<std::string> names = workload.objectNames(scene);
  const std::string name = names.empty() ? "" : printable(names[object], 200);
  return "object " + std::to_string(object) + (name.empty() ? "" : " \"" + name + "\"") + " (" +
         workload.meshes[workload.instance(scene, object).mesh].name + ")";
}

std::string contactInWords(const Workload& workload, const QuerySpec& query, const Result& result) {
  std::string text = "  what    " + triangleInWords(result.triB, result.featureB) + " of " +
                     objectInWords(workload, query.scene, result.object) + ", by the sensor's " +
                     triangleInWords(result.triA, result.featureA) + " (" + workload.meshes[query.mesh].name + ")\n";
  if (!std::isnan(result.point[0])) text += "  where   " + inDigits(result.point) + "\n";
  if (!std::isnan(result.normal[0])) {
    text += "  normal  " + inDigits(result.normal) + ", from the touched surface towards the sensor\n";
  }
  if (query.speed) text += "  when    after " + inDigits(result.t / *query.speed) + " s\n";
  return text;
}

/// A time, as answers have it: how far it is, or of a step its fraction.
std::string timeInWords(const Query& query, double time) {
  return takesStep(query) ? inDigits(100 * time) + "% of the motion" : inDigits(time);
}

/// How certain a hit of mode contact is.
std::string bracketInWords(const Query& query, const Result& result) {
  if (result.tier == Tier::sampled) return "certainly no later; mode sampled does not say how much earlier";
  if (takesStep(query) && result.lo < result.hi) {
    return "no earlier; certainly at most " + inDigits(100 * (result.hi - result.lo)) + "% of the motion later";
  }
  return query.clearance > 0 ? "no earlier; certainly by " + inDigits(result.hi) : "exact, to rounding";
}

std::string listsInWords(const Workload& workload, const QuerySpec& query, const Listed& listed) {
  std::string text;
  for (size_t i = 1; i < listed.hits.size(); ++i) {
    const Result& hit = listed.hits[i];
    text += "  then    " + objectInWords(workload, query.scene, hit.object) +
            (hit.status == Status::overlap     ? " at the start\n"
             : hit.status == Status::undecided ? ", perhaps, after " + timeInWords(query, hit.lo) + "\n"
                                               : " after " + timeInWords(query, hit.t) + "\n");
  }
  for (const ObjectId object : listed.overlapping) {
    text += "  without " + objectInWords(workload, query.scene, object) +
            ", whose surface crosses the sensor's at the start\n";
  }
  if (listed.closest && listed.closest->at.object != kNone) {
    const Closest& closest = *listed.closest;
    text += "  nearest " + inDigits(closest.hi) + " to " + objectInWords(workload, query.scene, closest.at.object) +
            ", after " + timeInWords(query, closest.at.t) + "\n";
  }
  if (listed.exit && listed.exit->status != Status::clear) {
    const Result& exit = *listed.exit;
    const double end = takesStep(query) ? 1 : query.distance;
    text += "  out of  " + objectInWords(workload, query.scene, exit.object) +
            (exit.lo == end                     ? " not within the motion\n"
             : exit.status == Status::undecided ? " after " + timeInWords(query, exit.hi) + ", if ever in it\n"
                                                : ", and of all others, after " + timeInWords(query, exit.hi) + "\n");
  }
  return text;
}

std::string resultInWords(const Workload& workload, const QuerySpec& query, const Answer& answer) {
  const Result& result = answer.result;
  const bool isStep = takesStep(query);
  const std::string distance = inDigits(query.distance), during = isStep ? "during the motion" : "within " + distance;
  switch (result.status) {
    case Status::hit:
      return "hit: " + std::string(query.clearance > 0 ? "within " + inDigits(query.clearance) : "first contact") +
             " after " + timeInWords(query, result.t) +
             (isStep ? "" : " of " + distance + " (" + inDigits(100 * result.fraction) + "% of the way)") +
             "\n  how     " + bracketInWords(query, result) + "\n" + contactInWords(workload, query, result);
    case Status::overlap:
      return "overlap: the surfaces " +
             (query.clearance > 0 ? "are within " + inDigits(query.clearance) + " of each other"
                                  : std::string("meet")) +
             " at the start already\n" + contactInWords(workload, query, result);
    case Status::clear:
      return "clear: certainly " +
             (query.clearance > 0 ? "nothing nearer than " + inDigits(query.clearance) : std::string("no contact")) +
             " " + during + "\n";
    case Status::undecided:
      if (query.clearance > 0) {
        return "undecided: passes at a distance of " + inDigits(query.clearance) + ", to rounding, after " +
               timeInWords(query, result.lo) + "\n";
      }
      if (isStep) {
        return "undecided: certainly no contact for " + timeInWords(query, result.lo) +
               "; none after that gets deeper than the tolerance\n";
      }
      return std::string("undecided: ") +
             (result.detected == Detected::no ? "no pixel saw anything in the way" : "no pixel found a contact") +
             " within " + distance +
             ", which is no proof; a higher --resolution may find one, --mode reference knows\n";
    case Status::invalid:
      break;
  }
  return "invalid: " + answer.reason + "\n";
}

}  // namespace

std::string inDigits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string inDigits(const std::array<double, 3>& vector) {
  return "(" + inDigits(vector[0]) + ", " + inDigits(vector[1]) + ", " + inDigits(vector[2]) + ")";
}

std::string leastFreeDistance(const Scopes& scopes) {
  return std::isnan(scopes.result.paperMinL) ? "none" : inDigits(scopes.result.paperMinL);
}

std::string courseInWords(const Query& query) {
  if (!query.turn) return "moves " + inDigits(query.distance) + " along " + inDigits(query.direction) + "\n";
  const Turn& turn = *query.turn;
  const double degrees = turn.angle * (180 / std::acos(-1.0));
  return (query.motion ? "moves by " + inDigits(*query.motion) + "\n" : "") + "turns by " + inDigits(turn.angle) +
         " (" + inDigits(degrees) + " degrees) about " + inDigits(turn.axis) + " through " + inDigits(turn.centre) +
         "\n";
}

std::string inWords(const Workload& workload, const QuerySpec& query, const Answer& answer) {
  return resultInWords(workload, query, answer) + listsInWords(workload, query, answer.listed);
}

std::string statusesInWords(const AnsweringStats& stats) {
  std::string text;
  for (size_t i = 0; i < stats.statuses.size(); ++i) {
    if (stats.statuses[i] == 0) continue;
    text += (text.empty() ? ": " : ", ") + std::to_string(stats.statuses[i]) + " " + nameOf(static_cast<Status>(i));
  }
  return text;
}

std::string resolutionsInWords(const AnsweringStats& stats) {
  if (stats.mostResolution == 0) return {};
  std::string text = "resolution: " + std::to_string(stats.leastResolution);
  if (stats.mostResolution != stats.leastResolution) text += " to " + std::to_string(stats.mostResolution);
  return text;
}

}  // namespace radar::tools
