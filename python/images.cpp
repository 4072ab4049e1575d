// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <mutex>
#include <optional>
#include <string_view>
#include <type_traits>
#include <utility>

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include "artus/detail/echo/display/image_fields.h"
#include "artus/detail/echo/display/rf_lines.h"
#include "artus/detail/echo/display/shown_places.h"
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

/// What a name or a .toml file stands for: a missing file is a FileNotFoundError, an unknown name a
/// ValueError.
template <class T>
T found_by(const std::string& name, Result<T> result) {
  return name.ends_with(".toml") ? value_of(std::move(result)) : value_by_name(std::move(result));
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
    const auto name = py::cast<std::string>(value);
    settings.grey_curve = found_by(name, find_grey_curve(name)).curve;
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

/// A copy as numpy has it; a number where it has no dimensions.
py::object copied(const NamedArray& array) {
  return std::visit(
      [&](const auto& values) -> py::object {
        using T = std::remove_const_t<typename std::remove_cvref_t<decltype(values)>::element_type>;
        if constexpr (std::is_same_v<T, double>)
          if (array.shape.empty()) return py::float_(values.front());
        return py::array_t<T>(array.shape, values.data());
      },
      array.values);
}

/// A renderer and the maker of its truth, for one thread at a time.
class PyRenderer {
 public:
  PyRenderer(const Joint& joint, const std::string& transducer, bool keep_lines, int gauge,
             const py::kwargs& settings)
      : joint_(joint),
        scene_(joint.scene),
        made_of_(py::make_tuple(transducer, keep_lines, gauge, settings)),
        keep_lines_(keep_lines) {
    transducer_ = found_by(transducer, find_transducer(transducer)).transducer;
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

  PicturePtr render(const Numbers& probe, const std::optional<Numbers>& needle,
                    std::optional<double> time) {
    if (time && !std::isfinite(*time)) throw py::value_error("time must be finite");
    const Pose X_JP = pose_of(probe, "probe");
    const std::optional<NeedleView> view = needle_of(needle);
    auto picture = std::make_shared<Picture>();
    const py::gil_scoped_release others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    renderer_->set_flow_time(time);
    copy(renderer_->render(X_JP, view), *picture);
    return picture;
  }

  std::shared_ptr<Labels> labels(const Numbers& probe, const std::optional<Numbers>& needle,
                                 const std::string& truth) {
    if (truth != "shown" && truth != "true")
      throw py::value_error("truth must be shown or true, not '" + truth + "'");
    const Pose X_JP = pose_of(probe, "probe");
    const std::optional<NeedleView> view = needle_of(needle);
    auto out = std::make_shared<Labels>();
    const py::gil_scoped_release others_may_run;
    out->image = truth == "true" ? labels_->render(*scene_, X_JP, view)
                                 : labels_->render_shown(renderer_->shown_places(X_JP), X_JP, view);
    return out;
  }

  py::dict truth(const Numbers& probe, const Numbers& needle) {
    const Pose X_JP = pose_of(probe, "probe");
    const NeedleTruth truth = labels_->locate(*needle_of(needle), X_JP);
    py::dict out;
    out["tip_true"] = py::make_tuple(truth.tip.x, truth.tip.y);
    out["tip_in_picture"] = truth.in_picture;
    out["tip_in_slice"] = truth.in_slice;
    out["tip_offset"] = truth.tip_offset;
    out["plane_angle"] = truth.plane_angle;
    out["face_angle"] = truth.face_angle;
    out["in_plane"] = truth.in_plane;
    return out;
  }

  py::dict rf(const Numbers& probe, const std::optional<Numbers>& needle) {
    const Pose X_JP = pose_of(probe, "probe");
    const std::optional<NeedleView> view = needle_of(needle);
    const auto lines = [&] {
      const py::gil_scoped_release others_may_run;
      const std::lock_guard<std::mutex> lock(mutex_);
      return make_rf_lines(renderer_->render(X_JP, view), transducer_, settings_);
    }();
    if (!lines) raise(lines.error());
    py::dict out;
    for (const NamedArray& array : arrays_of(*lines))
      out[py::str(std::string(array.name))] = copied(array);
    return out;
  }

  [[nodiscard]] py::tuple state() const { return py::make_tuple(joint_, made_of_); }
  static std::unique_ptr<PyRenderer> of_state(const py::tuple& state) {
    const auto made_of = state[1].cast<py::tuple>();
    const auto joint = state[0].cast<Joint>();
    return std::make_unique<PyRenderer>(joint, made_of[0].cast<std::string>(),
                                        made_of[1].cast<bool>(), made_of[2].cast<int>(),
                                        py::kwargs(made_of[3]));
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

  Joint joint_;
  std::shared_ptr<const Scene> scene_;
  py::tuple made_of_;  // transducer, keep_lines, gauge, settings
  Transducer transducer_;
  ImageSettings settings_;
  bool keep_lines_;
  NeedleShape needle_;
  std::unique_ptr<Renderer> renderer_;
  std::unique_ptr<LabelRenderer> labels_;
  std::mutex mutex_;  // between Python's threads
};

template <class T>
py::bytes bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

template <class T>
std::vector<T> vector_of(const py::handle& bytes) {
  const auto text = bytes.cast<std::string>();
  std::vector<T> values(text.size() / sizeof(T));
  std::memcpy(values.data(), text.data(), values.size() * sizeof(T));
  return values;
}

py::tuple picture_state(const Picture& picture) {
  const Frame& f = picture.frame;
  py::object tip = py::none();
  if (f.tip_shown) tip = py::make_tuple(f.tip_shown->x, f.tip_shown->y);
  return py::make_tuple(f.status, f.n_lines, f.n_samples, f.sample_depth, f.width, f.height,
                        f.pixel, tip, bytes_of(f.image), bytes_of(f.contact), picture.has_lines,
                        bytes_of(f.in_phase), bytes_of(f.quadrature), bytes_of(f.envelope),
                        bytes_of(f.decibel), bytes_of(f.velocity), bytes_of(f.motion_db));
}

PicturePtr picture_of_state(const py::tuple& state) {
  auto picture = std::make_shared<Picture>();
  Frame& f = picture->frame;
  f.status = state[0].cast<std::uint32_t>();
  f.n_lines = state[1].cast<int>();
  f.n_samples = state[2].cast<int>();
  f.sample_depth = state[3].cast<double>();
  f.width = state[4].cast<int>();
  f.height = state[5].cast<int>();
  f.pixel = state[6].cast<double>();
  if (!state[7].is_none()) {
    const auto [x, y] = state[7].cast<std::pair<double, double>>();
    f.tip_shown = PixelPoint{x, y};
  }
  f.image = vector_of<std::uint8_t>(state[8]);
  f.contact = vector_of<float>(state[9]);
  picture->has_lines = state[10].cast<bool>();
  std::size_t at = 11;
  for (auto* lines :
       {&f.in_phase, &f.quadrature, &f.envelope, &f.decibel, &f.velocity, &f.motion_db})
    *lines = vector_of<float>(state[at++]);
  return picture;
}

py::tuple labels_state(const Labels& labels) {
  const LabelImage& image = labels.image;
  return py::make_tuple(image.width, image.height, image.pixel, bytes_of(image.regions),
                        bytes_of(image.needle));
}

std::shared_ptr<Labels> labels_of_state(const py::tuple& state) {
  auto labels = std::make_shared<Labels>();
  labels->image = {state[0].cast<int>(), state[1].cast<int>(), state[2].cast<double>(),
                   vector_of<RegionId>(state[3]), vector_of<std::uint8_t>(state[4])};
  return labels;
}

template <class T>
py::array lines_view(const py::object& self, const std::vector<T> Frame::*member) {
  const Picture& picture = py::cast<const Picture&>(self);
  if (!picture.has_lines)
    throw py::value_error("the lines were not kept: make the Renderer with keep_lines=True");
  if ((picture.frame.*member).empty())
    throw py::value_error("nothing that moves was looked for: make the Renderer with doppler=True");
  return view((picture.frame.*member).data(), {picture.frame.n_lines, picture.frame.n_samples},
              self);
}

py::object tip_shown(const Picture& picture) {
  if (!picture.frame.tip_shown) return py::none();
  return py::make_tuple(picture.frame.tip_shown->x, picture.frame.tip_shown->y);
}

/// What the picture was made of, line by line.
void add_lines(py::class_<Picture, PicturePtr>& frame) {
  frame
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
          "velocity", [](const py::object& s) { return lines_view(s, &Frame::velocity); },
          "(lines, samples) float32 m/s toward the probe, NaN where nothing moves; with "
          "keep_lines=True and doppler=True.")
      .def_property_readonly(
          "motion_db", [](const py::object& s) { return lines_view(s, &Frame::motion_db); },
          "(lines, samples) float32 dB, how strong the echo of what moves is; where velocity is.");
}

void add_pictures(py::module_& module) {
  py::class_<Picture, PicturePtr> frame(
      module, "Frame", "A B-mode image and what led to it; arrays are read-only views.");
  add_lines(frame);
  frame
      .def_property_readonly(
          "image",
          [](const py::object& self) {
            const Frame& frame = py::cast<const Picture&>(self).frame;
            return view(frame.image.data(), {frame.height, frame.width}, self);
          },
          "(height, width) uint8.")
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
      .def_property_readonly("tip_shown", &tip_shown, "(x, y) in pixels, or None.")
      .def(py::pickle(&picture_state, &picture_of_state));
  py::class_<Labels, std::shared_ptr<Labels>>(module, "Labels", "What lies in the plane.")
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
          "pixel", [](const Labels& l) { return l.image.pixel; }, "m, the side of a pixel.")
      .def(py::pickle(&labels_state, &labels_of_state));
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
           py::arg("time") = py::none(),
           "The Frame of a probe at (4, 4) m in J, with a needle at (4, 4) m, origin at its tip. "
           "With "
           "doppler=True blood runs as it does at `time` (s), and tissue has moved since the frame "
           "before; None: nothing moves.")
      .def(py::pickle([](const PyRenderer& r) { return r.state(); }, &PyRenderer::of_state))
      .def("labels", &PyRenderer::labels, py::arg("probe"), py::arg("needle") = py::none(),
           py::arg("truth") = "shown",
           "The Labels of the same view: where the picture shows things, or with truth=\"true\" "
           "where they are.")
      .def(
          "rf", &PyRenderer::rf, py::arg("probe"), py::arg("needle") = py::none(),
          "The beamformed lines of the same view before the envelope, as `artus image --rf` writes "
          "them: iq (lines, samples) complex64, rf (lines, rf_samples) float32, time_gain, origins "
          "and directions (lines, 3) m in P, and numbers in SI. Envelope: time_gain * abs(iq).")
      .def("truth", &PyRenderer::truth, py::arg("probe"), py::arg("needle"),
           "Where the needle truly is: tip_true (x, y) in pixels, tip_offset m from the plane, "
           "plane_angle and face_angle rad, tip_in_picture, tip_in_slice, in_plane.");
}

}  // namespace artus::python
