#include "stability/measure.h"

namespace radar::tools {

std::vector<StabilityRow> measureStability(const Device& device, const StabilitySettings& settings,
                                           const std::function<void(const std::string&)>& onWrong,
                                           const std::function<void(uint64_t)>& onProgress) {
  std::vector<std::string> families = settings.families;
  if (families.empty()) {
    for (const HardFamily& family : hardFamilies()) families.push_back(family.name);
  }
  std::vector<Approach> asked;
  for (const uint32_t resolution : settings.resolutions) {
    asked.push_back({Method::paper, resolution});
    asked.push_back({Method::sampled, resolution});
  }
  asked.push_back({Method::contact, 0});
  const uint64_t each = (settings.cases + families.size() - 1) / families.size();
  CaseRun run(device);
  std::vector<StabilityRow> rows;
  for (const std::string& family : families) {
    const auto tell = [&](uint64_t number, const Approach& who, const std::string& words) {
      onWrong(who.name() + ": " + words + "; --family \"" + family + "\" --seed " + std::to_string(settings.seed) +
              " --first " + std::to_string(number) + " --cases 1");
    };
    const std::vector<Tally> tallies =
        run.run({family, settings.seed, settings.first, each, Company::isolated}, asked, tell, onProgress);
    for (size_t i = 0; i < asked.size(); ++i) rows.push_back({family, asked[i], tallies[i]});
  }
  return rows;
}

}  // namespace radar::tools
