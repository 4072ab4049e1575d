// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/evidence/validation/echo/echo_gates.h"

#include <algorithm>
#include <array>

#include <nlohmann/json.hpp>

#include "artus/detail/core/known_names.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/evidence/validation/echo/echo_gates_list.h"
#include "artus/echo/image_io.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, 13> kNames{
    "speckle",    "lateral-width", "slice-width",  "attenuation",   "matched-impedance",
    "interfaces", "needle-rings",  "needle-angle", "needle-offset", "tendon",
    "fat-shift",  "enhancement",   "motion"};
constexpr std::array<EchoGate (*)(), kNames.size()> kGates{
    gate_speckle,      gate_lateral_width,     gate_slice_width,
    gate_attenuation,  gate_matched_impedance, gate_interfaces,
    gate_needle_rings, gate_needle_angle,      gate_needle_offset,
    gate_tendon,       gate_fat_shift,         gate_enhancement,
    gate_motion};

bool passes(const EchoGate& gate) {
  return all_hold(gate.claims);
}

std::vector<Claim> claims_of(std::span<const EchoGate> gates) {
  std::vector<Claim> all;
  for (const EchoGate& gate : gates) all.insert(all.end(), gate.claims.begin(), gate.claims.end());
  return all;
}

std::string section_of(const EchoGate& gate) {
  std::string text = "\n## " + gate.name + (passes(gate) ? "" : " - does not hold") + "\n\n";
  text += gate.title + ".\n\n" + to_markdown(gate.claims);
  if (!gate.assumed.empty()) text += "\nAssumed: " + gate.assumed + ".\n";
  if (!gate.plot.panels.empty()) text += "\n![plot](pictures/" + gate.name + ".svg)\n";
  for (const GatePicture& picture : gate.pictures)
    text += "\n![" + picture.name + "](pictures/" + picture.name + "-image.png)\n";
  return text;
}

}  // namespace

std::span<const std::string_view> echo_gates() noexcept {
  return kNames;
}

Result<EchoGate> run_echo_gate(std::string_view name) {
  const auto at = find_name(kNames, name, "gate");
  ARTUS_TRY(at);
  EchoGate gate = kGates.at(*at)();
  gate.name = name;
  return gate;
}

nlohmann::json to_json(std::span<const EchoGate> gates) {
  nlohmann::json list = nlohmann::json::object();
  for (const EchoGate& gate : gates) {
    list[gate.name] = verdict(gate.claims);
    list[gate.name]["title"] = gate.title;
    list[gate.name]["assumed"] = gate.assumed;
  }
  nlohmann::json all = verdict(claims_of(gates));
  all.erase("claims");
  all["gates"] = std::move(list);
  return all;
}

Result<void> write_gate_report(std::span<const EchoGate> gates,
                               const std::filesystem::path& folder) {
  const std::filesystem::path pictures = folder / "pictures";
  std::error_code error;
  std::filesystem::create_directories(pictures, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), pictures.string());
  std::string report =
      "# Gates of the image's physics\n\n| gate | claims | hold | rests on an assumed value "
      "|\n|---|---|---|---|\n";
  std::string sections;
  for (const EchoGate& gate : gates) {
    const auto held = std::count_if(gate.claims.begin(), gate.claims.end(),
                                    [](const Claim& claim) { return claim.pass; });
    report += "| " + gate.name + " | " + std::to_string(gate.claims.size()) + " | " +
              (passes(gate) ? "all" : "**" + std::to_string(held) + "**") + " | " +
              (gate.assumed.empty() ? "" : "yes") + " |\n";
    sections += section_of(gate);
    for (const GatePicture& picture : gate.pictures)
      ARTUS_TRY(write_image(picture.image, pictures / (picture.name + "-image.png")));
    if (gate.plot.panels.empty()) continue;
    ARTUS_TRY(write_plot(pictures / (gate.name + ".svg"), gate.plot));
  }
  ARTUS_TRY(write_text(folder / "report.md",
                       report + "\n" + count_claims(claims_of(gates)) + ".\n" + sections));
  return write_text(folder / "gates.json", to_json(gates).dump(2) + "\n");
}

}  // namespace artus
