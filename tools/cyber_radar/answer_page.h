// Answers as a page: what the program's commands show of them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "cyber_radar/answering.h"
#include "view/cut.h"

namespace radar::tools {

struct PageOptions {
  const Device* device = nullptr;  ///< which draws scopes
  /// Answers of mode sampled to the same queries, to be compared with; none if the page's own are.
  std::span<const Answer> sampled;
  std::optional<uint32_t> tour;  ///< a query that is played when the page opens, before all are
};

std::vector<Result> resultsOf(std::span<const Answer> answers);
/// What answers say they left out.
LeftOut leftOutOf(std::span<const Answer> answers);

/// Writes a page of all queries of a workload and their answers. Where one is of mode sampled, a sentence says what an
/// exact search on the CPU finds; the scopes are shown, if there is a device, of the first queries as far as 16 MB go.
/// Throws std::runtime_error if the file cannot be written.
void writePage(const std::filesystem::path& file, const std::string& title, const Workload& workload,
               std::span<const Answer> answers, const PageOptions& options);

}  // namespace radar::tools
