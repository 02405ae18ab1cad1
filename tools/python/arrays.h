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
#include "workloads/answer_fields.h"

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

/// `count` numbers of a dictionary's array.
template <class T>
const T* numbers(const py::dict& arrays, const char* name, size_t count) {
  const py::object array = arrays[name];
  if (!py::isinstance<Array<T>>(array)) throw py::value_error(std::string(name) + ": expected another array");
  const auto typed = py::reinterpret_borrow<Array<T>>(array);
  requireCount(typed, name, count);
  return typed.data();
}

/// numpy's type of the records.
inline py::object typeOf(const tools::AnswerLayout& layout) {
  py::list names, formats, offsets;
  for (const auto& [field, place] : layout.members) {
    names.append(field->name);
    formats.append(field->width == 1 ? py::object(py::str(field->type)) : py::make_tuple(field->type, field->width));
    offsets.append(place);
  }
  py::dict type;
  type["names"] = names;
  type["formats"] = formats;
  type["offsets"] = offsets;
  type["itemsize"] = layout.size;
  return py::module_::import("numpy").attr("dtype")(type);
}

/// `count` adjacent records.
inline const char* recordsOf(const py::array& array, const tools::AnswerLayout& layout, size_t count) {
  requireCount(array, "records", count);
  if (!array.dtype().equal(typeOf(layout)) || (array.flags() & py::array::c_style) == 0) {
    throw py::value_error("records: expected another array");
  }
  return static_cast<const char*>(array.data());
}

/// Works while other Python threads run, which may write to arrays: it must have copied what it reads of them.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

}  // namespace radar::python
