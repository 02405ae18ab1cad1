#include "baselines/baseline.h"

namespace radar::tools {

std::vector<BaselineRow> peerRows() {
  return {};
}

std::unique_ptr<RigidBodies> makeRigidBodies(const Workload&) {
  return nullptr;
}

std::optional<TreeCost> embreeTree(const MeshData&, std::span<const float>, std::span<const Transform>) {
  return std::nullopt;
}

}  // namespace radar::tools
