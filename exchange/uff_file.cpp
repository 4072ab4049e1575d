// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/exchange/uff_file.h"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <hdf5.h>

namespace artus {
namespace {

constexpr const char* kVersion = "v1.2.0";
constexpr std::size_t kGrowth = 1U << 20U;  // bytes that the file in memory grows by
constexpr const char* kInfo =
    "Simulated by artus. Beamformed lines before the envelope: the engine forms beams directly, "
    "there is no channel data. Echoes that do not overlap have no phase of a carrier to each "
    "other. "
    "The rows of probe.geometry are where lines leave the face, not elements. The picture's "
    "envelope is abs(iq) times a time gain.";

/// Something of HDF5 that is closed; a negative one could not be had.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close) noexcept : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const noexcept { return id_; }

 private:
  hid_t id_;
  Close close_;
};

/// Writes objects as the format has them: groups and arrays with attributes that name their class.
/// After a failure it writes nothing more.
class UffWriter {
 public:
  UffWriter()
      : file_(make_file(), &H5Fclose),
        made_(H5Pcreate(H5P_DATASET_CREATE), &H5Pclose),
        ok_(file_.id() >= 0 && made_.id() >= 0) {
    note(H5Pset_obj_track_times(made_.id(), false));
    add_version();
  }

  /// A structure at `path`, whose last part is `name`.
  void add_object(const std::string& path, const std::string& name, const char* kind) {
    const Handle group(H5Gcreate2(file_.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       &H5Gclose);
    note(group.id());
    add_names(group.id(), name, kind);
    add_numbers(group.id(), "size", {1, 1});
    add_numbers(group.id(), "array", {0});
  }

  /// A matrix of the format, whose dimensions are the other way round in HDF5: `columns` values
  /// follow each other.
  template <class T>
  void add_matrix(const std::string& path, const std::string& name, hsize_t rows, hsize_t columns,
                  const T* values, bool imaginary = false) {
    constexpr bool is_single = sizeof(T) == sizeof(float);
    const Handle data = add_array(path, {columns, rows}, is_single);
    note(H5Dwrite(data.id(), is_single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                  H5P_DEFAULT, values));
    add_names(data.id(), name, is_single ? "single" : "double");
    add_numbers(data.id(), "imaginary", {imaginary ? 1.0 : 0.0});
    add_numbers(data.id(), "complex", {0});
  }
  void add_number(const std::string& object, const char* name, double value) {
    add_matrix(object + "/" + name, name, 1, 1, &value);
  }
  void add_column(const std::string& object, const char* name, const std::vector<double>& values) {
    add_matrix(object + "/" + name, name, values.size(), 1, values.data());
  }
  void add_text(const std::string& object, const char* name, const std::string& text) {
    const std::vector<float> letters(text.begin(), text.end());
    const Handle data = add_array(object + "/" + name, {letters.size(), 1}, true);
    note(H5Dwrite(data.id(), H5T_NATIVE_FLOAT, H5S_ALL, H5S_ALL, H5P_DEFAULT, letters.data()));
    add_names(data.id(), name, "char");
  }
  /// A complex column as two.
  void add_complex(const std::string& object, const char* name,
                   const std::vector<std::complex<float>>& values) {
    const std::string path = object + "/" + name;
    const Handle group(H5Gcreate2(file_.id(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                       &H5Gclose);
    note(group.id());
    add_names(group.id(), name, "single");
    add_numbers(group.id(), "complex", {1});
    std::vector<float> part(values.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = values[i].real();
    add_matrix(path + "/real", "real", part.size(), 1, part.data());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = values[i].imag();
    add_matrix(path + "/imag", "imag", part.size(), 1, part.data(), true);
  }

  [[nodiscard]] Result<std::string> bytes() {
    std::string out;
    if (ok_) {
      note(H5Fflush(file_.id(), H5F_SCOPE_GLOBAL));
      const auto size = H5Fget_file_image(file_.id(), nullptr, 0);
      if (size > 0) out.resize(static_cast<std::size_t>(size));
      if (size <= 0 || H5Fget_file_image(file_.id(), out.data(), out.size()) != size) ok_ = false;
    }
    if (!ok_) return fail(ErrorCode::failed, "HDF5 cannot make the file in memory", "uff");
    return out;
  }

 private:
  static hid_t make_file() {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what fails is told by us
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
    if (H5Pset_fapl_core(access.id(), kGrowth, false) < 0) return -1;
    return H5Fcreate("lines.uff", H5F_ACC_TRUNC, H5P_DEFAULT, access.id());
  }

  void note(hid_t result) noexcept { ok_ = ok_ && result >= 0; }

  Handle add_array(const std::string& path, std::array<hsize_t, 2> size, bool is_single) {
    const Handle space(H5Screate_simple(2, size.data(), nullptr), &H5Sclose);
    Handle data(H5Dcreate2(file_.id(), path.c_str(), is_single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE,
                           space.id(), H5P_DEFAULT, made_.id(), H5P_DEFAULT),
                &H5Dclose);
    note(data.id());
    return data;
  }

  void add_names(hid_t object, const std::string& name, const char* kind) {
    const Handle scalar(H5Screate(H5S_SCALAR), &H5Sclose);
    add_string(object, "class", kind, scalar.id());
    add_string(object, "name", name, scalar.id());
  }
  /// The version is a list of one string, as the toolbox's own.
  void add_version() {
    const hsize_t one = 1;
    const Handle list(H5Screate_simple(1, &one, nullptr), &H5Sclose);
    add_string(file_.id(), "version", kVersion, list.id());
  }
  void add_string(hid_t object, const char* key, const std::string& text, hid_t space) {
    const Handle type(H5Tcopy(H5T_C_S1), &H5Tclose);
    note(H5Tset_size(type.id(), text.size() + 1));
    const Handle attribute(H5Acreate2(object, key, type.id(), space, H5P_DEFAULT, H5P_DEFAULT),
                           &H5Aclose);
    note(H5Awrite(attribute.id(), type.id(), text.c_str()));
  }
  void add_numbers(hid_t object, const char* key, const std::vector<double>& values) {
    const hsize_t n = values.size();
    const Handle space(H5Screate_simple(1, &n, nullptr), &H5Sclose);
    const Handle attribute(
        H5Acreate2(object, key, H5T_IEEE_F64LE, space.id(), H5P_DEFAULT, H5P_DEFAULT), &H5Aclose);
    note(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, values.data()));
  }

  Handle file_;
  Handle made_;
  bool ok_;
};

std::vector<double> steps(double first, double step, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(first + step * i);
  return out;
}

/// Angle of line `l` from the face's normal, rad.
double angle_of(const RfLines& lines, int l) {
  const double* const direction = lines.directions.data() + 3 * static_cast<std::size_t>(l);
  return std::atan2(direction[0], direction[2]);
}

/// Where each sample lies: axes where the face is straight and not steered, a fan from its centre
/// where it is curved, and else every pixel by itself.
void add_scan(UffWriter& out, const std::string& object, const RfLines& lines, double step, int n) {
  const std::string scan = object + "/scan";
  if (lines.face_radius > 0) {
    out.add_object(scan, "scan", "uff.sector_scan");
    std::vector<double> angles;
    for (int l = 0; l < lines.n_lines; ++l) angles.push_back(angle_of(lines, l));
    out.add_column(scan, "azimuth_axis", angles);
    out.add_column(scan, "depth_axis", steps(lines.face_radius, step, n));
    out.add_object(scan + "/apex", "apex", "uff.point");
    out.add_number(scan + "/apex", "distance", lines.face_radius);
    out.add_number(scan + "/apex", "azimuth", std::numbers::pi);
    out.add_number(scan + "/apex", "elevation", 0);
    return;
  }
  if (lines.steering == 0) {
    out.add_object(scan, "scan", "uff.linear_scan");
    std::vector<double> x;
    for (std::size_t i = 0; i < lines.origins.size(); i += 3) x.push_back(lines.origins[i]);
    out.add_column(scan, "x_axis", x);
    out.add_column(scan, "z_axis", steps(0, step, n));
    return;
  }
  out.add_object(scan, "scan", "uff.scan");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<double> places;
    for (std::size_t i = axis; i < lines.origins.size(); i += 3)
      for (int s = 0; s < n; ++s)
        places.push_back(lines.origins[i] + lines.directions[i] * step * s);
    out.add_column(scan, std::array{"x", "y", "z"}[axis], places);
  }
}

/// x, y, z, angles to both sides, width, height, each of all lines.
void add_probe(UffWriter& out, const std::string& object, const RfLines& lines) {
  const std::string probe = object + "/probe";
  out.add_object(probe, "probe", "uff.probe");
  std::vector<double> geometry;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t i = axis; i < lines.origins.size(); i += 3)
      geometry.push_back(lines.origins[i]);
  const auto n = static_cast<std::size_t>(lines.n_lines);
  for (int l = 0; l < lines.n_lines; ++l)
    geometry.push_back(lines.face_radius > 0 ? angle_of(lines, l) : 0);
  geometry.insert(geometry.end(), n, 0.0);
  geometry.insert(geometry.end(), n, lines.face_width / std::max(1.0, static_cast<double>(n) - 1));
  geometry.insert(geometry.end(), n, lines.elevation_height);
  out.add_matrix(probe + "/geometry", "geometry", n, 7, geometry.data());
}

void add_beamformed(UffWriter& out, const std::string& name, const RfLines& lines, double rate,
                    int n_samples) {
  const std::string object = "/" + name;
  out.add_object(object, name, "uff.beamformed_data");
  out.add_text(object, "info", kInfo);
  add_scan(out, object, lines, lines.sound_speed / (2 * rate), n_samples);
  add_probe(out, object, lines);
  out.add_object(object + "/pulse", "pulse", "uff.pulse");
  out.add_number(object + "/pulse", "center_frequency", lines.centre_frequency);
  out.add_number(object + "/pulse", "fractional_bandwidth", lines.bandwidth);
  out.add_number(object + "/pulse", "phase", 0);
  out.add_number(object, "sampling_frequency", rate);
}

}  // namespace

Result<std::string> uff_bytes(const RfLines& lines) {
  UffWriter out;
  add_beamformed(out, "iq", lines, lines.sampling_frequency, lines.n_samples);
  out.add_number("/iq", "modulation_frequency", lines.centre_frequency);
  out.add_complex("/iq", "data", lines.iq);
  add_beamformed(out, "rf", lines, lines.rf_sampling_frequency, lines.n_rf_samples);
  out.add_number("/rf", "modulation_frequency", 0);
  out.add_matrix("/rf/data", "data", lines.rf.size(), 1, lines.rf.data());
  return out.bytes();
}

}  // namespace artus
