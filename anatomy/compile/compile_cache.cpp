// SPDX-License-Identifier: AGPL-3.0-or-later
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <optional>
#include <vector>

#include "artus/anatomy/compile.h"
#include "artus/detail/anatomy/body/holders.h"
#include "artus/detail/anatomy/body/joint_path.h"
#include "artus/detail/anatomy/body/skin_line.h"
#include "artus/detail/anatomy/compile/attach_metadata.h"
#include "artus/detail/anatomy/compile/check/plan_check.h"
#include "artus/detail/core/text_file.h"

namespace artus {
namespace {

/// Nothing in artus changes the environment while threads run.
std::filesystem::path folder_from_environment(const char* name) {
  const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe): see above
  return value != nullptr ? value : "";
}

std::filesystem::path default_cache() {
  if (const auto cache = folder_from_environment("XDG_CACHE_HOME"); !cache.empty()) {
    return cache / "artus";
  }
  if (const auto home = folder_from_environment("HOME"); !home.empty()) {
    return home / ".cache" / "artus";
  }
  return std::filesystem::temp_directory_path() / "artus-cache";
}

std::filesystem::path cache_of(const LoadOptions& options) {
  return options.cache.empty() ? default_cache() : options.cache;
}

/// What the bodies of a joint are called in the cache; those of all its patients alike.
std::string stem_of(const JointFile& file) {
  const std::size_t patient = file.name.find('@');
  return patient == std::string::npos ? file.name : file.name.substr(0, patient) + "@patient";
}

/// Where a body and the report of its making are kept.
struct KeptBody {
  std::filesystem::path body;
  std::filesystem::path report;
};

KeptBody place_of(const JointFile& file, const std::string& digest, const LoadOptions& options) {
  const auto cache = cache_of(options);
  const std::string stem =
      stem_of(file) + "-" + digest + (options.compile.skip_refused ? "-partial" : "");
  return {cache / (stem + ".artus"), cache / (stem + ".json")};
}

/// The kept body dressed anew; empty when there is none that can be used.
std::optional<CompileOutcome> find_kept(const JointFile& file, const std::string& digest,
                                        const KeptBody& place) {
  const auto text = read_bytes(place.report);
  if (!text) return std::nullopt;
  auto report = parse_compile_report(*text, place.report.string());
  if (!report) return std::nullopt;
  auto body = read_compiled_joint(place.body);
  if (!body || body->source_digest != digest) return std::nullopt;
  CompileOutcome outcome;
  outcome.report = std::move(*report);
  outcome.report.body_kept = true;
  outcome.report.notes.clear();
  outcome.report.steps.clear();
  outcome.joint = attach_metadata(file, std::move(body->mesh), digest, outcome.report.notes);
  return outcome;
}

/// Removes all but the newest bodies of the joint, so that a cache does not grow without end.
void forget_old(const JointFile& file, const std::filesystem::path& cache) {
  constexpr std::size_t kKept = 4;
  constexpr std::size_t kKeptPatients = 64;
  constexpr std::size_t kDigest = 32;  // hex digits
  const std::string name = stem_of(file);
  const std::size_t kept = file.patient.empty() ? kKept : kKeptPatients;
  struct Old {
    std::filesystem::file_time_type time;
    std::filesystem::path path;
  };
  std::vector<Old> bodies;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(cache, ignored)) {
    const std::string stem = entry.path().stem().string();
    const bool ours =
        entry.path().extension() == ".artus" && stem.rfind(name + "-", 0) == 0 &&
        stem.find_first_not_of("0123456789abcdef", name.size() + 1) >= name.size() + 1 + kDigest;
    if (ours) bodies.push_back({entry.last_write_time(ignored), entry.path()});
  }
  std::sort(bodies.begin(), bodies.end(),
            [](const Old& a, const Old& b) { return a.time > b.time; });
  for (std::size_t i = kept; i < bodies.size(); ++i) {
    std::filesystem::remove(bodies[i].path, ignored);
    std::filesystem::remove(bodies[i].path.replace_extension(".json"), ignored);
  }
}

void keep(const JointFile& file, const CompileOutcome& outcome, const KeptBody& place) {
  std::error_code ignored;
  std::filesystem::create_directories(place.body.parent_path(), ignored);
  if (!write_compiled_joint(outcome.joint, place.body)) return;
  static_cast<void>(write_text(place.report, to_json(outcome.report)));
  forget_old(file, place.body.parent_path());
}

/// The file with its plans where the compiled body has them.
JointFile with_plans_of(JointFile file, const CompiledJoint& joint) {
  file.injections = joint.injections;
  if (file.X_JP_default) file.X_JP_default = joint.X_JP_default;
  if (file.needle)
    file.needle->entry =
        std::get<SurfaceFile>(file.body.shape).grow == 0
            ? file.needle->entry
            : moved_onto_skin(joint, file.needle->entry,
                              (file.needle->target - file.needle->entry).normalized());
  return file;
}

}  // namespace

Result<CompileOutcome> compile_or_reuse(const JointSources& sources, const LoadOptions& options,
                                        const Progress& progress) {
  const JointFile& file = sources.joint();
  const auto start = std::chrono::steady_clock::now();
  const Result<std::string> digest = compute_source_digest(sources);
  ARTUS_TRY(digest);
  const KeptBody place = place_of(file, *digest, options);
  Result<CompileOutcome> outcome = CompileOutcome{};
  if (auto kept = find_kept(file, *digest, place)) {
    outcome = std::move(*kept);
  } else {
    CompileOptions compile = options.compile;
    if (compile.parts.empty()) compile.parts = cache_of(options) / "parts";
    outcome = compile_joint(sources, compile, progress);
    ARTUS_TRY(outcome);
    keep(file, *outcome, place);
  }
  if (options.compile.check_plans) {
    std::vector<std::string> problems;
    const PlanGround ground = make_ground(outcome->joint, file.region_of_interest);
    for (const PlanProblem& p : find_plan_problems(with_plans_of(file, outcome->joint), ground))
      problems.push_back(to_line(p));
    if (!find_holders(outcome->joint).any()) problems.push_back(explain_unheld());
    ARTUS_TRY(refuse_all(problems, file));
  }
  if (outcome->report.body_kept)
    outcome->report.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return outcome;
}

Result<CompiledJoint> load_joint(const std::filesystem::path& path, const LoadOptions& options,
                                 const Progress& progress) {
  if (!is_joint_folder(path)) {
    std::error_code ignored;
    if (std::filesystem::exists(path, ignored)) return read_compiled_joint(path);
    return fail(ErrorCode::not_found,
                "there is no such joint: neither a folder with a joint.toml, nor a compiled file, "
                "nor the name of a bundled one",
                path.string());
  }
  Result<JointFile> file = read_joint(path, options.surfaces);
  ARTUS_TRY(file);
  Result<CompileOutcome> outcome = compile_or_reuse(std::move(*file), options, progress);
  ARTUS_TRY(outcome);
  return std::move(outcome->joint);
}

}  // namespace artus
