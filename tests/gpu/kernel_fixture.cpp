#include "gpu/kernel_fixture.h"

#include <numeric>

#include "spirv/count_groups_comp.h"
#include "spirv/fill_nodes_comp.h"
#include "spirv/read_depth_comp.h"
#include "spirv/scale_comp.h"
#include "spirv/sum_texels_comp.h"

namespace radar::test {

namespace {

constexpr uint32_t kManyLanes[] = {64};
constexpr uint32_t kOneLaneOffset5[] = {1, 5};

}  // namespace

Kernels::Kernels(const Device::Impl& device)
    : scale(device, k_scale_comp, "scale", kManyLanes),
      scaleAndAdd5(device, k_scale_comp, "scale and add 5", kOneLaneOffset5),
      fillNodes(device, k_fill_nodes_comp, "fill nodes"),
      sumTexels(device, k_sum_texels_comp, "sum texels"),
      countGroups(device, k_count_groups_comp, "count groups"),
      readDepth(device, k_read_depth_comp, "read depth") {}

void run(const std::function<void(const gpu::Commands&)>& record) {
  gpu::Submission submission(impl(), false);
  const gpu::Commands commands = submission.begin();
  record(commands);
  gpu::writtenToHost(commands);
  submission.submitAndWait();
}

gpu::Array<uint32_t> numbers(const char* name, uint32_t count) {
  gpu::Array<uint32_t> array(impl(), name, gpu::BufferDomain::upload);
  array.reserve(count);
  std::iota(array.mapped(), array.mapped() + count, 0u);
  return array;
}

}  // namespace radar::test
