// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace artus {

/// A joint folder, the variants that are asked for and whose joint it is.
struct JointChoice {
  std::filesystem::path folder;
  std::vector<std::string> variants;  ///< in alphabetical order, each once
  std::string patient;                ///< as resolve_patient reads it; empty: as modelled
};

/// Takes "meshes/shoulder+calcific_deposit+effusion@adult_f_bmi30" apart. A folder whose own name
/// has a '+' or '@' is that folder.
[[nodiscard]] JointChoice split_variants(const std::filesystem::path& joint);

/// `joint` with one more variant asked for.
[[nodiscard]] std::filesystem::path with_variant(std::filesystem::path joint,
                                                 const std::string& variant);

/// `joint` of the patient that is asked for, in place of any other. Empty: as modelled.
[[nodiscard]] std::filesystem::path with_patient(const std::filesystem::path& joint,
                                                 const std::string& patient);

/// Where `joint` is, with its variants and patient. As it is named, when there is such a folder or
/// file; else the one of that name that comes with artus, wherever the program was started:
/// "shoulder", "meshes/shoulder+effusion", "simple-shoulder.artus" (find_bundled); else as named.
[[nodiscard]] std::filesystem::path find_joint(const std::filesystem::path& joint);

/// Whether `joint`, where find_joint finds it, is a folder and no compiled file.
[[nodiscard]] bool is_joint_folder(const std::filesystem::path& joint);

}  // namespace artus
