// SPDX-License-Identifier: AGPL-3.0-or-later
#include <optional>
#include <string>
#include <utility>

#include <pybind11/stl.h>

#include <nlohmann/json.hpp>

#include "artus/detail/evidence/runs/injection_report.h"
#include "artus/detail/evidence/runs/injection_request.h"
#include "artus/detail/python/borders.h"

namespace artus::python {
namespace {

/// (n,), of a value of each tick.
template <class T, class Of>
py::array_t<T> column(const InjectionRun& run, Of of) {
  py::array_t<T> out(static_cast<py::ssize_t>(run.rows.size()));
  T* at = out.mutable_data();
  for (const InjectionRow& row : run.rows) *at++ = static_cast<T>(of(row));
  return out;
}

py::dict to_arrays(const InjectionRun& run) {
  using Row = const InjectionRow&;
  py::dict out;
  out["time"] = column<double>(run, [](Row r) { return r.time; });
  out["depth"] = column<double>(run, [](Row r) { return r.depth; });
  out["region"] = column<std::uint16_t>(run, [](Row r) { return r.region; });
  out["axial"] = column<double>(run, [](Row r) { return r.axial; });
  out["thumb"] = column<double>(run, [](Row r) { return r.thumb; });
  out["barrel_pressure"] = column<double>(run, [](Row r) { return r.plunger.pressure; });
  out["tip_pressure"] = column<double>(run, [](Row r) { return r.plunger.tip_pressure; });
  out["flow"] = column<double>(run, [](Row r) { return r.plunger.flow; });
  out["travel"] = column<double>(run, [](Row r) { return r.plunger.travel; });
  out["content"] = column<double>(run, [](Row r) { return r.plunger.content; });
  out["status"] = column<std::uint32_t>(run, [](Row r) { return r.plunger.status; });
  py::list phases;
  for (const InjectionRow& row : run.rows)
    phases.append(py::str(row.phase.data(), row.phase.size()));
  out["phase"] = phases;
  py::dict volumes;
  for (std::size_t k = 0; k < run.places.size(); ++k)
    volumes[py::str(run.places[k])] = column<double>(run, [k](Row r) { return r.volumes[k]; });
  out["volumes"] = volumes;
  out["needle"] = array_of(run.X_JN);
  return out;
}

/// A number by keyword that must lie in a range; the message has its unit.
void check_range(double value, std::pair<double, double> range, const char* name,
                 const char* unit) {
  if (value >= range.first && value <= range.second) return;
  const auto text = [](double v) {
    return std::string(py::str(py::float_(v)));
  };
  throw py::value_error(std::string(name) + " must be " + text(range.first) + " to " +
                        text(range.second) + " " + unit + ", not " + text(value));
}

InjectionRequest request_of(const py::kwargs& given) {
  InjectionRequest request;
  const auto take = [&](const char* name, auto& member) {
    if (!given.contains(name)) return;
    try {
      member = py::cast<std::remove_reference_t<decltype(member)>>(given[name]);
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(name) + " cannot be " + std::string(py::repr(given[name])));
    }
  };
  std::string technique = "direct";
  take("technique", technique);
  take("injection", request.injection);
  take("into", request.into);
  take("volume", request.volume);
  take("rate", request.rate);
  take("liquid", request.liquid);
  take("gauge", request.gauge);
  take("needle_length", request.needle_length);
  take("syringe", request.syringe);
  take("air", request.air);
  take("aspirate", request.aspirate);
  take("rigid", request.rigid);
  take("haptic_rate", request.rate_hz);
  take("device", request.device);
  take("seed", request.seed);
  check_range(request.volume, {1e-8, 5e-5}, "volume", "m^3 (1e-6 is a millilitre)");
  check_range(request.rate, {1e-9, 5e-6}, "rate", "m^3/s (1e-6 is a millilitre a second)");
  check_range(request.needle_length, {0.01, 0.2}, "needle_length", "m");
  check_range(request.syringe, {0, 5e-5}, "syringe", "m^3");
  check_range(request.air, {0, 5e-6}, "air", "m^3");
  check_range(request.aspirate, {0, 60}, "aspirate", "s");
  check_range(request.rate_hz, {100, 20000}, "haptic_rate", "Hz");
  if (technique == "through-and-back")
    request.technique = Technique::through_and_back;
  else if (technique != "direct")
    throw py::value_error("technique must be 'direct' or 'through-and-back', not '" + technique +
                          "'");
  return request;
}

/// Arrays, and the summary as JSON text.
py::tuple inject(const Joint& joint, const std::optional<Numbers>& entry,
                 const std::optional<Numbers>& target, const py::kwargs& given) {
  InjectionRequest request = request_of(given);
  if (entry.has_value() != target.has_value())
    throw py::value_error("give both entry and target, or neither");
  if (entry) {
    request.line = {point_of(*entry, "entry"), point_of(*target, "target")};
    if ((request.line->first - request.line->second).norm() < 1e-6)
      throw py::value_error("entry and target are the same point");
  }
  Result<InjectionRun> done = [&] {
    const py::gil_scoped_release others_may_run;
    return run_injection(*joint.scene, request);
  }();
  const InjectionRun run = value_by_name(std::move(done));
  return py::make_tuple(to_arrays(run), summarize(run).dump());
}

}  // namespace

void add_injections(py::module_& module) {
  module.def("_inject", &inject, py::arg("joint"), py::arg("entry"), py::arg("target"));
}

}  // namespace artus::python
