#include "measure/stability.h"

#include "measure/case_run.h"

namespace radar::tools {

namespace {

// Every way of asking, the one that all families allow at last.
std::vector<Approach> approaches(const StabilitySettings& settings) {
  std::vector<Approach> all;
  for (const uint32_t resolution : settings.resolutions) {
    all.push_back({resolution, true});
    all.push_back({resolution});
  }
  all.emplace_back();
  return all;
}

Json rowOf(const std::string& family, const Approach& asked, const Tally& t) {
  const uint64_t other = t[Fault::unanswered] + t[Fault::wrongStatus] + t[Fault::wrongPair] + t[Fault::wrongList] +
                         t[Fault::late] + t[Fault::point] + t[Fault::normal];
  return {{"family", family},
          {"tier", asked.tier()},
          {"resolution", asked.resolution},
          {"cases", t.queries},
          {"contacts", t.contacts()},
          {"missed", t[Fault::missed] + t.unseen},
          {"false", t[Fault::falseHit]},
          {"brackets_violated", t[Fault::bracket]},
          {"otherwise_wrong", other},
          {"late", t.late},
          {"early", t.early}};
}

Json varied(const HardFamily& family) {
  std::string values;
  for (const double value : family.values) values += (values.empty() ? "" : " ") + print("%g", value);
  return {{"family", family.name}, {"parameter", family.parameter}, {"values", values}};
}

}  // namespace

bool measureStability(const Device& device, const StabilitySettings& settings, Json& report,
                      const std::function<void(const std::string&)>& onWrong,
                      const std::function<void(uint64_t)>& onProgress) {
  const std::vector<std::string> names = settings.families.empty() ? hardFamilyNames() : settings.families;
  const std::vector<Approach> all = approaches(settings);
  std::vector<Tally> totals(all.size());
  Json table = Json::array(), families = Json::array(), sums = Json::array();
  bool right = true;
  CaseRun run(device);
  for (const std::string& name : names) {
    const HardFamily& family = hardFamily(name);
    families.push_back(varied(family));
    const size_t first = offersSampled(family) ? 0 : all.size() - 1;
    const uint64_t cases = (settings.cases + names.size() - 1) / names.size();
    const auto tell = [&](uint64_t number, const Approach& asked, const std::string& words) {
      onWrong(print("%s %u: %s; --family \"%s\" --seed %zu --first %zu --cases 1", asked.tier(), asked.resolution,
                    words.c_str(), name.c_str(), size_t{settings.seed}, size_t{number}));
    };
    const std::vector<Tally> tallies = run.run({name, settings.seed, settings.first, cases, Company::isolated},
                                               std::span(all).subspan(first), tell, onProgress);
    for (size_t i = 0; i < tallies.size(); ++i) {
      const Approach& asked = all[first + i];
      table.push_back(rowOf(name, asked, tallies[i]));
      totals[first + i].add(tallies[i]);
      right = right && (asked.paper || tallies[i].wrong == 0);
    }
  }
  for (size_t i = 0; i < all.size(); ++i) sums.push_back(rowOf("all", all[i], totals[i]));
  setRows(report, "totals", "Each way of asking, over all families", sums);
  setRows(report, "table", "Each way of asking, family by family", table);
  setRows(report, "families", "What each family varies", families);
  return right;
}

}  // namespace radar::tools
