#include "cyber_radar/workload_output.h"

#include <iostream>

#include "batch/query_file.h"

namespace radar::tools {

void WorkloadOutput::addTo(Command& command) {
  command.option("--out", &folder, "Folder for queries.json, its meshes and instance files").required().value("DIR");
  command.option("--binary", &binary, "Writes the queries as an array, in queries.npy, without their ids");
}

void WorkloadOutput::write(const Workload& workload) const {
  const auto file = writeQueryFile(workload, folder, binary);
  std::cout << file.string() << ": " << counted(workload.queries.size(), "query", "queries") << ", "
            << counted(workload.scenes.size(), "scene") << ", " << counted(workload.meshes.size(), "mesh", "meshes")
            << "\n";
}

}  // namespace radar::tools
