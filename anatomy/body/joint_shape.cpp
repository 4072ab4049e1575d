// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_shape.h"

#include <array>
#include <sstream>
#include <string_view>

#include "artus/detail/anatomy/body/joint_parameter_toml.h"
#include "artus/detail/anatomy/body/joint_variant_toml.h"
#include "artus/detail/core/text_file.h"
#include "artus/detail/core/toml_table.h"

namespace artus {
namespace {

constexpr std::array<std::string_view, 12> kShapeNothing{
    "title",  "side",      "axes",   "surfaces",       "landmark", "probe",
    "needle", "injection", "tissue", "tissue_library", "space",    "pose"};

}  // namespace

Result<std::string> read_joint_shape(const std::filesystem::path& folder,
                                     const std::vector<std::string>& variants,
                                     const std::vector<PatientValue>& patient) {
  const auto file = folder / "joint.toml";
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  auto document = parse_toml(*text, file.string());
  ARTUS_TRY(document);
  Problems problems;
  const auto chosen = apply_patient(*document, patient, variants, problems);
  static_cast<void>(choose_variants(*document, chosen, problems));
  if (!problems.empty()) return problems.refusal(ErrorCode::invalid, file.string());
  for (const std::string_view key : kShapeNothing) document->erase(key);
  if (auto* structures = document->get_as<toml::array>("structure"))
    for (toml::node& node : *structures)
      if (auto* structure = node.as_table()) {
        structure->erase("fibre_axis");
        structure->erase("fibre_course");
      }
  std::ostringstream out;
  out << toml::toml_formatter(*document);
  return out.str();
}

}  // namespace artus
