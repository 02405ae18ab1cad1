#include "peers/peer.h"

namespace radar::tools {

std::vector<PeerRow> peerRows() {
  return {};
}

}  // namespace radar::tools
