#include "contact/kernels.h"

#include <algorithm>
#include <array>

#include "gpu/requirements.h"
#include "spirv/contact_block_comp.h"
#include "spirv/contact_collect_comp.h"
#include "spirv/contact_filter_comp.h"
#include "spirv/contact_link_comp.h"
#include "spirv/contact_refine_comp.h"
#include "spirv/contact_resolve_comp.h"
#include "spirv/contact_resolve_comp_RADAR_NO_DOUBLES.h"
#include "spirv/contact_search_comp.h"

namespace radar {

namespace {

std::array<uint32_t, 4> searchConstants(const Device::Impl& device, const SearchShape& shape) {
  const uint32_t lanes = device.subgroupSize;
  uint32_t queue = std::max(shape.queue != 0 ? shape.queue : std::max(8 * lanes, 128u), 6 * lanes);
  while (queue > 6 * lanes &&
         gpu::searchSharedBytes(lanes, queue) > device.properties.limits.maxComputeSharedMemorySize) {
    queue -= lanes;
  }
  return {lanes, queue, std::max(shape.stack, 4u), 0};
}

}  // namespace

ContactKernels::ContactKernels(const Device::Impl& device, const SearchShape& shape)
    : lanes(device.subgroupSize),
      stack(searchConstants(device, shape)[2]),
      search(device, k_contact_search_comp, "search", searchConstants(device, shape), gpu::Subgroups::full),
      collect(device, k_contact_collect_comp, "collect"),
      filter(device, k_contact_filter_comp, "filter"),
      link(device, k_contact_link_comp, "link"),
      resolve(
          device,
          device.doubles ? std::span<const uint32_t>(k_contact_resolve_comp) : k_contact_resolve_comp_RADAR_NO_DOUBLES,
          "resolve", device.divisionConstants()),
      device_(device),
      constants_(searchConstants(device, shape)) {
  if (!device.doubles) return;
  const uint32_t divides = device.divisionConstants()[0];
  refine.emplace(device, k_contact_refine_comp, "refine", std::array{divides, 0u});
  refineLeaving.emplace(device, k_contact_refine_comp, "refine, leaving ignored", std::array{divides, 1u});
  block.emplace(device, k_contact_block_comp, "block");
}

const gpu::Kernel& ContactKernels::searchWithClearance() const {
  std::call_once(clearanceOnce_, [&] {
    std::array<uint32_t, 4> constants = constants_;
    constants[3] = 1;
    clearance_.emplace(device_, k_contact_search_comp, "search, with a clearance", constants, gpu::Subgroups::full);
  });
  return *clearance_;
}

}  // namespace radar
