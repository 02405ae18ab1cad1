// What Python may ask of a scene, but for casts.
#pragma once

#include <pybind11/pybind11.h>

#include "python/casting_scene.h"

namespace radar::python {

void defineScene(pybind11::module_& module, pybind11::class_<CastingScene>& scene);

}  // namespace radar::python
