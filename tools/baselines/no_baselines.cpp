#include "baselines/baseline.h"

namespace radar::tools {

std::vector<BaselineRow> peerRows() {
  return {};
}

}  // namespace radar::tools
