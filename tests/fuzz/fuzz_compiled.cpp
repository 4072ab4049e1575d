// SPDX-License-Identifier: AGPL-3.0-or-later
#include <filesystem>
#include <fstream>
#include <iterator>

#include "artus/anatomy/compiled_joint.h"
#include "tests/fuzz/fuzz_surface.h"

namespace {

constexpr std::size_t kHeaderSize = 32;  // docs/file-format.md

/// One tetrahedron of one tissue.
artus::CompiledJoint make_smallest_joint() {
  artus::CompiledJoint joint;
  joint.name = "smallest";
  joint.tissues.resize(2);
  joint.regions = {{"outside", 0, {}}, {"beyond", 0, {}}, {"muscle", 1, artus::Vec3::UnitX()}};
  joint.mesh.vertices = {artus::Vec3::Zero(), artus::Vec3::UnitX(), artus::Vec3::UnitY(),
                         artus::Vec3::UnitZ()};
  joint.mesh.tetrahedra = {{0, 1, 2, 3}};
  joint.mesh.regions = {2};
  joint.mesh.interfaces = {{{0, 2, 1}, 0, 2}};
  joint.landmarks.resize(1);
  joint.injections.resize(1);
  return joint;
}

}  // namespace

/// Starts from a sound joint: random bytes hardly ever get past the first section.
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  for (int i = 1; i < *argc; ++i) {
    const std::filesystem::path corpus = (*argv)[i];
    if (!std::filesystem::is_directory(corpus)) continue;
    const auto file = corpus / "smallest.artus";
    if (!artus::write_compiled_joint(make_smallest_joint(), file)) std::abort();
    std::ifstream in(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    std::ofstream(corpus / "smallest", std::ios::binary) << bytes.substr(kHeaderSize);
    std::filesystem::remove(file);
    break;
  }
  return 0;
}

/// A compiled joint's payload: every index usable, or a refusal with a message.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto joint =
      artus::parse_compiled_joint(std::string(artus::as_text(data, size)), "fuzz.artus");
  if (!joint) {
    if (joint.error().message.empty()) std::abort();
    return 0;
  }
  for (const auto& interface : joint->mesh.interfaces) {
    if (interface.front >= joint->regions.size() || interface.back >= joint->regions.size())
      std::abort();
  }
  for (const auto& region : joint->regions)
    if (region.tissue >= joint->tissues.size()) std::abort();
  return 0;
}
