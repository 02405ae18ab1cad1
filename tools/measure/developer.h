// The sections of the chart that only show how our own searches compare.
#pragma once

#include <functional>
#include <vector>

#include "measure/case.h"
#include "measure/report.h"

namespace radar::tools {

/// Section search: batches of different sizes, on workloads of every kind. Full ones take gigabytes.
std::vector<Case> searchCases(Extent extent);
/// Section contacts: what counts as a contact, and lists of contacts, against the first contact.
std::vector<Case> contactCases(Extent extent);

/// Section edits: a batch of 64 after each change of a large scene, and of a mesh. What changes takes part in no query
/// or is the same for all, so that the answers are the same. Adds a row to the part `edits` for each change, times in
/// microseconds: of the change, with all that it does to trees and copies, and of the batch.
void measureEdits(const Device& device, Extent extent, Json& report);

/// Section recorded: a frame of searches in a host's command buffer. Likewise the part `recorded`; the change is
/// recording, the batch is executing.
void measureRecorded(const Device& device, Extent extent, Json& report);

}  // namespace radar::tools
