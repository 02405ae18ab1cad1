// Arrays of numpy, to and from the engine's numbers.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "radar/scene.h"

namespace radar::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style>;

template <class T>
Array<T> arrayOf(const std::vector<T>& values, std::vector<py::ssize_t> shape) {
  return Array<T>(std::move(shape), values.data());
}

/// Vertices, faces, and the base that the vertices are about.
inline py::tuple meshArrays(std::span<const float> positions, std::span<const uint32_t> indices,
                            const std::array<double, 3>& base) {
  return py::make_tuple(Array<float>({py::ssize_t(positions.size() / 3), py::ssize_t(3)}, positions.data()),
                        Array<uint32_t>({py::ssize_t(indices.size() / 3), py::ssize_t(3)}, indices.data()),
                        Array<double>(3, base.data()));
}

/// The first three rows of a 4x4 matrix.
inline Transform transformFrom(const double* matrix) {
  Transform transform;
  std::copy(matrix, matrix + 12, transform.m.begin());
  return transform;
}

inline void requireCount(const py::array& array, const char* name, size_t count) {
  if (static_cast<size_t>(array.size()) == count) return;
  throw py::value_error(std::string(name) + ": expected " + std::to_string(count) + " numbers, got " +
                        std::to_string(array.size()));
}

/// Works while other Python threads run, which may write to arrays: it must have copied what it reads of them.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

}  // namespace radar::python
