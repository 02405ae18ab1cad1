#include "peers/rows.h"

namespace radar::tools {

std::vector<PeerRow> peerRows() {
  std::vector<PeerRow> rows;
  for (auto* more : {embreeRows, fclRows, bulletRows, odeRows}) {
    for (PeerRow& row : more()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace radar::tools
