// The rows of each library.
#pragma once

#include "peers/peer.h"

namespace radar::tools {

std::vector<PeerRow> embreeRows();
std::vector<PeerRow> fclRows();
std::vector<PeerRow> bulletRows();
std::vector<PeerRow> odeRows();

}  // namespace radar::tools
