// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/body/joint_path.h"

#include <algorithm>
#include <system_error>

#include "artus/detail/core/bundled.h"

namespace artus {

JointChoice split_variants(const std::filesystem::path& joint) {
  JointChoice choice{joint, {}, {}};
  std::error_code ignored;
  if (std::filesystem::exists(joint, ignored)) return choice;
  std::string name = joint.filename().string();
  if (const std::size_t at = name.find('@'); at != std::string::npos && at > 0) {
    choice.patient = name.substr(at + 1);
    name.resize(at);
    choice.folder = joint.parent_path() / name;
    if (std::filesystem::exists(choice.folder, ignored)) return choice;
  }
  std::size_t plus = name.find('+');
  if (plus == std::string::npos || plus == 0) return choice;
  for (std::size_t at = name.rfind('+'); at > plus; at = name.rfind('+', at - 1)) {
    if (!std::filesystem::is_directory(joint.parent_path() / name.substr(0, at), ignored)) continue;
    plus = at;
    break;
  }
  choice.folder = joint.parent_path() / name.substr(0, plus);
  while (plus != std::string::npos) {
    const std::size_t next = name.find('+', plus + 1);
    choice.variants.push_back(name.substr(plus + 1, next - plus - 1));
    plus = next;
  }
  std::sort(choice.variants.begin(), choice.variants.end());
  choice.variants.erase(std::unique(choice.variants.begin(), choice.variants.end()),
                        choice.variants.end());
  return choice;
}

std::filesystem::path with_variant(std::filesystem::path joint, const std::string& variant) {
  if (!joint.has_filename()) joint = joint.parent_path();  // "shoulder/"
  const std::string patient = split_variants(joint).patient;
  return with_patient(with_patient(joint, {}) += "+" + variant, patient);
}

std::filesystem::path with_patient(const std::filesystem::path& joint, const std::string& patient) {
  std::filesystem::path out = joint.has_filename() ? joint : joint.parent_path();
  if (const std::string old = split_variants(out).patient; !old.empty()) {
    std::string name = out.filename().string();
    name.resize(name.find('@'));
    out.replace_filename(name);
  }
  return patient.empty() ? out : out += "@" + patient;
}

std::filesystem::path find_joint(const std::filesystem::path& joint) {
  if (!joint.empty() && !joint.has_filename()) return find_joint(joint.parent_path());  // "knee/"
  const std::filesystem::path folder = split_variants(joint).folder;
  const bool bundled_name = joint.parent_path().empty() || joint.parent_path() == "meshes";
  std::error_code ignored;
  if (joint.empty() || !bundled_name || std::filesystem::exists(folder, ignored)) return joint;
  const std::filesystem::path found = find_bundled("meshes" / folder.filename());
  return found.empty() ? joint : found.parent_path() / joint.filename();
}

bool is_joint_folder(const std::filesystem::path& joint) {
  std::error_code ignored;
  return std::filesystem::is_directory(split_variants(find_joint(joint)).folder, ignored);
}

}  // namespace artus
