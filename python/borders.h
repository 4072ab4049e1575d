// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include "artus/core/geometry.h"
#include "artus/core/result.h"
#include "artus/raycast/scene.h"

/// What goes through the border between Python and the engine: arrays, poses, failures.
namespace artus::python {

namespace py = pybind11;
/// Without a cast that loses something: complex numbers are refused with a TypeError.
using Numbers = py::array_t<double, py::array::c_style>;

/// Where a joint came from, so that another process can load it again.
struct JointSource {
  std::filesystem::path path;
  std::filesystem::path surfaces;
  std::filesystem::path cache;
  bool skip_refused = false;
};

/// A loaded joint with its index of surfaces.
struct Joint {
  std::shared_ptr<const Scene> scene;
  std::optional<JointSource> source{};  ///< empty: it was made in memory
  [[nodiscard]] const CompiledJoint& data() const noexcept { return scene->joint(); }
};

/// The value, or the engine's message as an exception: FileNotFoundError, OSError or ValueError.
[[noreturn]] void raise(const Error& error);
template <class T>
T value_of(Result<T> result) {
  if (!result) raise(result.error());
  return std::move(*result);
}
/// The same of what is asked for by name: a name that is not there is a ValueError, since no file
/// is missing.
template <class T>
T value_by_name(Result<T> result) {
  if (!result && result.error().code == ErrorCode::not_found)
    result.error().code = ErrorCode::invalid;
  return value_of(std::move(result));
}

/// One pose, 4 x 4, metres; `what` stands in the ValueError for wrong shapes, numbers that are not
/// finite, axes that are not orthonormal, and translations above ten metres (millimetres?).
[[nodiscard]] Pose pose_of(const Numbers& array, const std::string& what);
/// Many, (n, 4, 4).
[[nodiscard]] std::vector<Pose> poses_of(const Numbers& array, const std::string& what);
/// Three finite numbers below ten metres.
[[nodiscard]] Vec3 point_of(const Numbers& array, const std::string& what);
[[nodiscard]] py::array array_of(const Pose& pose);
[[nodiscard]] py::array array_of(const Vec3& v);

/// A read-only view of `shape` on memory that `owner` keeps alive; nothing is copied.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array_t<T> array(std::move(shape), data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

void add_bodies(py::module_& module);
void add_images(py::module_& module);
void add_forces(py::module_& module);
void add_presses(py::module_& module);
void add_simulations(py::module_& module);
void add_injections(py::module_& module);
void add_assessments(py::module_& module);

}  // namespace artus::python
