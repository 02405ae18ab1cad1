// Chains of joints: arrays in, arrays out, with no object for each motion.
#pragma once

#include <pybind11/pybind11.h>

#include "python/casting_scene.h"

namespace radar::python {

void defineChains(pybind11::module_& module, pybind11::class_<CastingScene>& scene);

}  // namespace radar::python
