// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <mutex>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <pybind11/stl.h>

#include "artus/detail/echo/display/image_fields.h"
#include "artus/detail/echo/probe/grey_curve_file.h"
#include "artus/detail/python/borders.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"

namespace artus::python {
namespace {

/// A rendered frame that owns its memory. The lines are there when the renderer keeps them.
struct Picture {
  Frame frame;
  bool has_lines = false;
};
using PicturePtr = std::shared_ptr<Picture>;

/// Truth of a frame that owns its memory.
struct Labels {
  LabelImage image;
};

/// Short names that the tool has, too, of settings whose own names are longer.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kShort{
    {{"focus", "elevation_focus"},
     {"lines", "n_lines"},
     {"samples", "n_samples"},
     {"planes", "n_planes"},
     {"compound", "compound_angles"},
     {"threads", "n_threads"}}};

std::string_view short_name(std::string_view name) {
  for (const auto& [abbreviated, full] : kShort)
    if (name == full) return abbreviated;
  return name;
}

/// Look by its name.
Look look_of(const py::handle& value) {
  const auto name = py::cast<std::string>(value);
  const auto at = std::find(kLookNames.begin(), kLookNames.end(), name);
  if (at == kLookNames.end())
    throw py::value_error("look must be raw, clinical or compound, not '" + name + "'");
  return static_cast<Look>(at - kLookNames.begin());
}

/// A value by keyword, given to the setting of that name. Unknown ones are refused with all names.
void take_setting(const std::string& key, const py::handle& value, Transducer& transducer,
                  ImageSettings& settings) {
  if (key == "grey_curve") {
    settings.grey_curve = value_of(find_grey_curve(py::cast<std::string>(value))).curve;
    return;
  }
  bool taken = false;
  std::string names;
  const auto visit = [&](const std::string& name, auto& member) {
    if (name.starts_with("grey_curve.")) {  // all of it, by its name
      if (name.ends_with(".at_0")) names += ", grey_curve";
      return;
    }
    const std::string_view shown = short_name(name);
    names += (names.empty() ? "" : ", ") + std::string(shown);
    if (key != shown) return;
    try {
      using Member = std::remove_reference_t<decltype(member)>;
      if constexpr (std::is_same_v<Member, Look>) {
        member = look_of(value);
        taken = true;
        return;
      }
      member = py::cast<std::remove_reference_t<decltype(member)>>(value);
    } catch (const py::cast_error&) {
      throw py::type_error(key + " cannot be " + std::string(py::repr(value)));
    }
    taken = true;
  };
  visit_fields(transducer, visit);
  visit_fields(settings, visit);
  if (!taken) throw py::type_error("unknown setting '" + key + "'; there are " + names);
}

/// A renderer and the maker of its truth, for one thread at a time.
class PyRenderer {
 public:
  PyRenderer(const Joint& joint, const std::string& transducer, bool keep_lines, int gauge,
             const py::kwargs& settings)
      : scene_(joint.scene), keep_lines_(keep_lines) {
    transducer_ = value_of(find_transducer(transducer)).transducer;
    const auto shape = needle_of_gauge(gauge);
    if (!shape) throw py::value_error("gauge must be 18, 20, 21, 22, 23 or 25");
    needle_ = *shape;
    for (const auto& [key, value] : settings)
      take_setting(py::cast<std::string>(key), value, transducer_, settings_);
    check(validate(transducer_));
    check(validate(settings_));
    const py::gil_scoped_release others_may_run;
    renderer_ = std::make_unique<Renderer>(scene_, transducer_, settings_);
    labels_ = std::make_unique<LabelRenderer>(transducer_, settings_);
  }

  PicturePtr render(const Numbers& probe, const std::optional<Numbers>& needle) {
    const Pose X_JP = pose_of(probe, "probe");
    const std::optional<NeedleView> view = needle_of(needle);
    auto picture = std::make_shared<Picture>();
    const py::gil_scoped_release others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    copy(renderer_->render(X_JP, view), *picture);
    return picture;
  }

  std::shared_ptr<Labels> labels(const Numbers& probe, const std::optional<Numbers>& needle) {
    const Pose X_JP = pose_of(probe, "probe");
    const std::optional<NeedleView> view = needle_of(needle);
    auto out = std::make_shared<Labels>();
    const py::gil_scoped_release others_may_run;
    out->image = labels_->render(*scene_, X_JP, view);
    return out;
  }

  py::dict truth(const Numbers& probe, const Numbers& needle) {
    const Pose X_JP = pose_of(probe, "probe");
    const NeedleTruth truth = labels_->locate(*needle_of(needle), X_JP);
    py::dict out;
    out["tip"] = py::make_tuple(truth.tip.x, truth.tip.y);
    out["tip_offset"] = truth.tip_offset;
    out["plane_angle"] = truth.plane_angle;
    out["face_angle"] = truth.face_angle;
    out["in_plane"] = truth.in_plane;
    return out;
  }

 private:
  static void check(const Result<void>& valid) {
    if (!valid) raise(valid.error());
  }
  [[nodiscard]] std::optional<NeedleView> needle_of(const std::optional<Numbers>& needle) const {
    if (!needle) return std::nullopt;
    return NeedleView{pose_of(*needle, "needle"), needle_};
  }
  /// The parts that are kept; the lines alone are five megabytes.
  void copy(const Frame& from, Picture& to) const {
    if (keep_lines_) {
      to.frame = from;
      to.has_lines = true;
      return;
    }
    Frame& out = to.frame;
    out.status = from.status;
    out.n_lines = from.n_lines;
    out.n_samples = from.n_samples;
    out.sample_depth = from.sample_depth;
    out.width = from.width;
    out.height = from.height;
    out.pixel = from.pixel;
    out.image = from.image;
    out.contact = from.contact;
    out.tip_shown = from.tip_shown;
  }

  std::shared_ptr<const Scene> scene_;
  Transducer transducer_;
  ImageSettings settings_;
  bool keep_lines_;
  NeedleShape needle_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<LabelRenderer> labels_;
  std::mutex mutex_;  // between Python's threads
};

template <class T>
py::array lines_view(const py::object& self, const std::vector<T> Frame::*member) {
  const Picture& picture = py::cast<const Picture&>(self);
  if (!picture.has_lines)
    throw py::value_error("the lines were not kept: make the Renderer with keep_lines=True");
  return view((picture.frame.*member).data(), {picture.frame.n_lines, picture.frame.n_samples},
              self);
}

py::object tip_shown(const Picture& picture) {
  if (!picture.frame.tip_shown) return py::none();
  return py::make_tuple(picture.frame.tip_shown->x, picture.frame.tip_shown->y);
}

void add_pictures(py::module_& module) {
  py::class_<Picture, PicturePtr>(module, "Frame",
                                  "A B-mode image and what led to it; arrays are read-only views.")
      .def_property_readonly(
          "image",
          [](const py::object& self) {
            const Frame& frame = py::cast<const Picture&>(self).frame;
            return view(frame.image.data(), {frame.height, frame.width}, self);
          },
          "(height, width) uint8.")
      .def_property_readonly(
          "in_phase", [](const py::object& s) { return lines_view(s, &Frame::in_phase); },
          "(lines, samples) float32, with keep_lines=True.")
      .def_property_readonly(
          "quadrature", [](const py::object& s) { return lines_view(s, &Frame::quadrature); },
          "(lines, samples) float32, with keep_lines=True.")
      .def_property_readonly(
          "envelope", [](const py::object& s) { return lines_view(s, &Frame::envelope); },
          "(lines, samples) float32, with keep_lines=True.")
      .def_property_readonly(
          "decibel", [](const py::object& s) { return lines_view(s, &Frame::decibel); },
          "(lines, samples) float32 dB, with keep_lines=True.")
      .def_property_readonly(
          "contact",
          [](const py::object& self) {
            const Frame& frame = py::cast<const Picture&>(self).frame;
            return view(frame.contact.data(), {frame.n_lines}, self);
          },
          "(lines,) float32, 0 (in the air) to 1 (on the skin).")
      .def_property_readonly(
          "pixel", [](const Picture& p) { return p.frame.pixel; }, "m, the side of a pixel.")
      .def_property_readonly(
          "sample_depth", [](const Picture& p) { return p.frame.sample_depth; },
          "m between samples.")
      .def_property_readonly("tip_shown", &tip_shown, "(x, y) in pixels, or None.");
  py::class_<Labels, std::shared_ptr<Labels>>(module, "Labels", "What truly lies in the plane.")
      .def_property_readonly(
          "regions",
          [](const py::object& self) {
            const LabelImage& image = py::cast<const Labels&>(self).image;
            return view(image.regions.data(), {image.height, image.width}, self);
          },
          "(height, width) uint16, region ids.")
      .def_property_readonly(
          "needle",
          [](const py::object& self) {
            const LabelImage& image = py::cast<const Labels&>(self).image;
            return view(image.needle.data(), {image.height, image.width}, self);
          },
          "(height, width) uint8, 255 where the shaft is in the plane.")
      .def_property_readonly(
          "pixel", [](const Labels& l) { return l.image.pixel; }, "m, the side of a pixel.");
}

}  // namespace

void add_images(py::module_& module) {
  add_pictures(module);
  py::class_<PyRenderer>(module, "Renderer",
                         "Turns probe poses into B-mode images of one joint, again and again.")
      .def(py::init<const Joint&, const std::string&, bool, int, const py::kwargs&>(),
           py::arg("joint"), py::arg("transducer") = "linear-6-18", py::arg("keep_lines") = false,
           py::arg("gauge") = 22)
      .def("render", &PyRenderer::render, py::arg("probe"), py::arg("needle") = py::none(),
           "The Frame of a probe at (4, 4) m in J, with a needle at (4, 4) m, origin at its tip.")
      .def("labels", &PyRenderer::labels, py::arg("probe"), py::arg("needle") = py::none(),
           "The Labels of the same view: what truly lies in the plane.")
      .def("truth", &PyRenderer::truth, py::arg("probe"), py::arg("needle"),
           "Where the needle truly is: tip (x, y) in pixels, tip_offset m from the plane, "
           "plane_angle "
           "and face_angle rad, in_plane.");
}

}  // namespace artus::python
