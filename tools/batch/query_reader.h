// The JSON of query files.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "batch/fingerprint.h"
#include "batch/outputs.h"
#include "workloads/workload.h"

namespace radar::tools {

struct JsonQueryFile {
  std::string name;                          ///< for messages
  Workload workload;                         ///< without the queries of a queries file
  std::vector<std::array<double, 3>> bases;  ///< of the meshes that sensors may be; those of assemblies follow
  std::optional<std::filesystem::path> queriesFile;
  Fingerprint fingerprint;  ///< of all but the queries file
};

/// As QueryFile(), but for the content of a queries file.
JsonQueryFile readJsonQueryFile(const std::filesystem::path& file, std::vector<std::string>& warnings,
                                const Outputs& outputs);

}  // namespace radar::tools
