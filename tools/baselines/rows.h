// The rows of each library.
#pragma once

#include "baselines/baseline.h"

namespace radar::tools {

std::vector<BaselineRow> embreeRows();
std::vector<BaselineRow> fclRows();
std::vector<BaselineRow> bulletRows();
std::vector<BaselineRow> odeRows();

}  // namespace radar::tools
