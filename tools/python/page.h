// Casts as a page for a browser.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "python/arrays.h"
#include "python/casting_scene.h"
#include "view/cut.h"

namespace radar::python {

/// What a page shows of a scene as it is now; numbers of meshes and objects are the scene's.
tools::Workload workloadOf(const BasedScene& based, const std::map<uint32_t, std::string>& objectNames);

/// What _engine.pyi says of page(): HTML, of a scene as it is now.
std::string castsPage(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                      const std::string& title, uint64_t count, const std::vector<std::string>& names,
                      const py::dict& arrays, const py::array& records, const std::map<uint32_t, std::string>& reasons,
                      const tools::LeftOut& left, const std::optional<std::pair<py::array, Array<int64_t>>>& hits,
                      const std::optional<py::array>& closest, const std::optional<py::array>& exits);

}  // namespace radar::python
