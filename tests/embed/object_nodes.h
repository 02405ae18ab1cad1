// The tree over objects on a device, as a search finds it.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "scene/scene.h"
#include "shaders/shared/interop.h"

namespace radar::test {

using ObjectNodes = std::vector<gpu::ObjectNode>;

/// By object, the nodes on the way to its leaf, the root first. Throws std::logic_error if there is none to a node, or
/// two to an object.
std::map<ObjectId, std::vector<uint32_t>> pathsTo(const ObjectNodes& nodes);

/// Empty if the tree has each of the scene's objects once, and each box that the device has built all that are below
/// it.
std::string faultOf(const ObjectNodes& nodes, const Scene& scene);

/// Nodes whose children a search looks at in all, for boxes like those of every third object that go so far in random
/// directions, until the first box.
size_t testsOf(const ObjectNodes& nodes, double distance);

/// The tree over the same leaves that the CPU would build, and that which has the links of `links`.
ObjectNodes rebuilt(const ObjectNodes& nodes);
ObjectNodes refitted(const ObjectNodes& nodes, const ObjectNodes& links);

}  // namespace radar::test
