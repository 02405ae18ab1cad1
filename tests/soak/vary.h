// Random changes of queries, and of numbers.
#pragma once

#include "radar/query.h"
#include "workloads/random.h"

namespace radar::soak {

/// Moves a pose by a millionth of `size` up to all of it, or by whole steps.
Transform moved(Transform pose, double size, tools::Random& random);

/// A query with some of what mode contact offers; not always a valid one.
Query varied(Query query, const Scene& scene, tools::Random& random);

}  // namespace radar::soak
