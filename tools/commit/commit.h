// What reports say they were made from.
#pragma once

namespace radar::tools {

/// `git describe --always --dirty` of the sources when they were built; "unknown" outside a repository.
const char* commit();

}  // namespace radar::tools
