// numpy arrays as spans and vectors, and back.
#pragma once

#include <pybind11/numpy.h>

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "io/image.h"

namespace tenebra::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style>;
template <class T>
using MaybeArray = std::optional<Array<T>>;

static_assert(sizeof(glm::vec3) == 3 * sizeof(float) && sizeof(glm::dvec3) == 3 * sizeof(double) &&
              sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));

/// Rows of three numbers as vectors. __init__.py has seen to the shapes.
template <class Vector, class T>
std::span<const Vector> vectors(const Array<T>& array) {
  return {reinterpret_cast<const Vector*>(array.data()), static_cast<std::size_t>(array.size()) / 3};
}
template <class Vector, class T>
std::span<const Vector> vectors(const MaybeArray<T>& array) {
  return array ? vectors<Vector>(*array) : std::span<const Vector>();
}
template <class T>
std::span<const T> values(const MaybeArray<T>& array) {
  return array ? std::span<const T>(array->data(), static_cast<std::size_t>(array->size()))
               : std::span<const T>();
}
template <class T>
std::span<T> room(Array<T>& array) {
  return {array.mutable_data(), static_cast<std::size_t>(array.size())};
}

/// An array that owns what was in `values`: nothing is copied.
template <class T>
py::array given_away(std::vector<T>&& values, std::vector<py::ssize_t> shape) {
  auto* const kept = new std::vector<T>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
  return py::array_t<T>(std::move(shape), kept->data(), owner);
}
template <class Vector>
py::array given_away_vectors(std::vector<Vector>&& values, std::vector<py::ssize_t> shape) {
  using T = typename Vector::value_type;
  auto* const kept = new std::vector<Vector>(std::move(values));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<Vector>*>(p); });
  shape.push_back(3);
  return py::array_t<T>(std::move(shape), reinterpret_cast<const T*>(kept->data()), owner);
}
template <class T>
py::array image(io::Image<T>&& from) {
  std::vector<py::ssize_t> shape{from.height, from.width};
  if (from.channels > 1) shape.push_back(from.channels);
  return given_away(std::move(from.pixels), std::move(shape));
}
template <class T>
py::tuple tuple_of(const glm::vec<3, T>& v) {
  return py::make_tuple(v.x, v.y, v.z);
}

}  // namespace tenebra::python
