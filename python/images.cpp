// SPDX-License-Identifier: AGPL-3.0-or-later
#include <mutex>
#include <optional>

#include <pybind11/stl.h>

#include "artus/core/units.h"
#include "artus/echo/labels.h"
#include "artus/echo/renderer.h"
#include "artus/echo/transducer_file.h"
#include "artus/python/borders.h"

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

/// Numbers by keyword, given to the settings of the same names. Unknown ones are refused.
void take_setting(const std::string& key, const py::handle& value, Transducer& t,
                  ImageSettings& s) {
  const auto number = [&] {
    return py::cast<double>(value);
  };
  const auto whole = [&] {
    return py::cast<int>(value);
  };
  const auto flag = [&] {
    return py::cast<bool>(value);
  };
  if (key == "frequency")
    t.frequency = number();
  else if (key == "focus")
    t.elevation_focus = number();
  else if (key == "transmit_focus")
    t.transmit_focus = number();
  else if (key == "steering")
    t.steering = number();
  else if (key == "lines")
    t.n_lines = whole();
  else if (key == "depth")
    s.depth = number();
  else if (key == "samples")
    s.n_samples = whole();
  else if (key == "planes")
    s.n_planes = whole();
  else if (key == "pixel")
    s.pixel = number();
  else if (key == "gain_db")
    s.gain_db = number();
  else if (key == "dynamic_range_db")
    s.dynamic_range_db = number();
  else if (key == "tgc_db_cm_mhz")
    s.tgc_db_cm_mhz = number();
  else if (key == "smoothing")
    s.smoothing = number();
  else if (key == "compound")
    s.compound_angles = whole();
  else if (key == "persistence")
    s.persistence = number();
  else if (key == "refraction")
    s.refraction = flag();
  else if (key == "reverberation")
    s.reverberation = flag();
  else if (key == "texture")
    s.texture = flag();
  else if (key == "seed")
    s.seed = py::cast<std::uint64_t>(value);
  else if (key == "threads")
    s.n_threads = whole();
  else
    throw py::type_error("unknown setting '" + key +
                         "'; there are frequency, focus, transmit_focus, steering, lines, depth, "
                         "samples, planes, pixel, gain_db, dynamic_range_db, tgc_db_cm_mhz, "
                         "smoothing, compound, persistence, refraction, reverberation, texture, "
                         "seed, threads");
}

/// A renderer and the maker of its truth, for one thread at a time.
class PyRenderer {
 public:
  PyRenderer(const Joint& joint, const std::string& transducer, bool keep_lines,
             const py::kwargs& settings)
      : scene_(joint.scene), keep_lines_(keep_lines) {
    transducer_ = value_of(find_transducer(transducer)).transducer;
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
  [[nodiscard]] static std::optional<NeedleView> needle_of(const std::optional<Numbers>& needle) {
    if (!needle) return std::nullopt;
    NeedleView view;
    view.X_JN = pose_of(*needle, "needle");
    view.shape = *needle_of_gauge(22);
    return view;
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
      .def_property_readonly("in_phase",
                             [](const py::object& s) { return lines_view(s, &Frame::in_phase); })
      .def_property_readonly("quadrature",
                             [](const py::object& s) { return lines_view(s, &Frame::quadrature); })
      .def_property_readonly("envelope",
                             [](const py::object& s) { return lines_view(s, &Frame::envelope); })
      .def_property_readonly("decibel",
                             [](const py::object& s) { return lines_view(s, &Frame::decibel); })
      .def_property_readonly("contact",
                             [](const py::object& self) {
                               const Frame& frame = py::cast<const Picture&>(self).frame;
                               return view(frame.contact.data(), {frame.n_lines}, self);
                             })
      .def_property_readonly("pixel", [](const Picture& p) { return p.frame.pixel; })
      .def_property_readonly("sample_depth", [](const Picture& p) { return p.frame.sample_depth; })
      .def_property_readonly("tip_shown", &tip_shown, "(x, y) in pixels, or None.");
  py::class_<Labels, std::shared_ptr<Labels>>(module, "Labels", "What truly lies in the plane.")
      .def_property_readonly(
          "regions",
          [](const py::object& self) {
            const LabelImage& image = py::cast<const Labels&>(self).image;
            return view(image.regions.data(), {image.height, image.width}, self);
          },
          "(height, width) uint16, region ids.")
      .def_property_readonly("needle",
                             [](const py::object& self) {
                               const LabelImage& image = py::cast<const Labels&>(self).image;
                               return view(image.needle.data(), {image.height, image.width}, self);
                             })
      .def_property_readonly("pixel", [](const Labels& l) { return l.image.pixel; });
}

}  // namespace

void add_images(py::module_& module) {
  add_pictures(module);
  py::class_<PyRenderer>(module, "Renderer",
                         "Turns probe poses into B-mode images of one joint, again and again.")
      .def(py::init<const Joint&, const std::string&, bool, const py::kwargs&>(), py::arg("joint"),
           py::arg("transducer") = "linear-6-18", py::arg("keep_lines") = false)
      .def("render", &PyRenderer::render, py::arg("probe"), py::arg("needle") = py::none())
      .def("labels", &PyRenderer::labels, py::arg("probe"), py::arg("needle") = py::none())
      .def("truth", &PyRenderer::truth, py::arg("probe"), py::arg("needle"));
}

}  // namespace artus::python
