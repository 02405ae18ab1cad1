#include "baselines/rigid.h"

namespace radar::tools {

std::vector<BaselineRow> peerRows() {
  std::vector<BaselineRow> rows;
  for (auto* more : {embreeRows, fclRows, bulletRows, odeRows}) {
    for (BaselineRow& row : more()) rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace radar::tools
