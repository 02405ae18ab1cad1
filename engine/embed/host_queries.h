// Queries that a host's shaders write: copied from its buffers and encoded for the search, in the host's command
// buffer.
#pragma once

#include <string>

#include "contact/pass.h"
#include "gpu/kernel.h"
#include "radar/host.h"
#include "radar/query.h"
#include "shaders/embed/interop.h"

namespace radar {

/// Empty if `queries` are valid; `most`: Capacity::queries.
std::string validate(const HostQueries& queries, uint32_t most);

class HostQueriesPass {
 public:
  explicit HostQueriesPass(const gpu::Owner& owner);

  /// Stores `queries`, at least one, and makes room for them, while the device is idle. Throws if they do not fit the
  /// device.
  void stage(const HostQueries& queries);
  /// Call after recording the upload of `search`, which has room for as many sensors. The search
  /// may then be recorded.
  void record(const gpu::Commands& commands, const ContactPass& search, const GpuScene& resident,
              const Scene::Impl& scene);

 private:
  const Device::Impl* device_;
  gpu::Passes run_;
  gpu::Array<uint32_t> words_;
  HostQueries queries_;
  VkDeviceSize span_ = 0;  ///< bytes of the queries, and of the padding after them
};

/// The query of a Sweep, as far as its answer depends on it.
Query queryOf(const gpu::Sweep& sweep);

}  // namespace radar
