#include "python/signals.h"

#include <pybind11/pybind11.h>

namespace radar::python {

namespace py = pybind11;

std::function<void()> signalsHeeded() {
  const py::object main = py::module_::import("threading").attr("main_thread")();
  if (PyThread_get_thread_ident() != main.attr("ident").cast<unsigned long>()) return {};
  return [] {
    const py::gil_scoped_acquire acquire;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  };
}

}  // namespace radar::python
