// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/stored_sweep.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include <opencv2/imgcodecs.hpp>

#include <nlohmann/json.hpp>

#include "artus/detail/core/text_file.h"
#include "artus/detail/core/units.h"
#include "artus/detail/dataset/echo_truth.h"
#include "artus/detail/dataset/tar_file.h"

namespace artus {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using Take = std::function<Result<void>(const StoredFrame&)>;

/// The probes of a sweep by the names that its frames give; "" is its own.
using Probes = std::map<std::string, Transducer>;

Result<Probes> probes_of(const json& sweep) {
  Probes probes;
  const auto own = transducer_of(sweep.value("transducer", json()));
  ARTUS_TRY(own);
  probes[""] = *own;
  for (const json& entry : sweep.value("transducers", json::array())) {
    const auto drawn = transducer_of(entry.value("values", json()));
    ARTUS_TRY(drawn);
    probes[entry.value("name", "")] = *drawn;
  }
  return probes;
}

/// The poses of a line of truth, read as a list of poses is.
Result<ListedPose> pose_of(const json& truth, const std::string& where) {
  json line{{"probe", truth.value("probe", json())}};
  if (truth.contains("time_s")) line["time_s"] = truth["time_s"];
  if (const auto needle = truth.find("needle"); needle != truth.end() && needle->is_object())
    line["needle"] = {{"entry_mm", needle->value("entry_mm", json())},
                      {"tip_mm", needle->value("tip_mm", json())}};
  auto poses = parse_poses_jsonl(line.dump(-1, ' ', false, json::error_handler_t::replace), where);
  ARTUS_TRY(poses);
  return poses->front();
}

Result<StoredFrame> frame_of(std::string_view line, std::string_view png, const Probes& probes,
                             const std::string& where) {
  const json truth = json::parse(line, nullptr, false);
  if (!truth.is_object()) return fail(ErrorCode::malformed, "the line is not JSON", where);
  StoredFrame frame;
  auto pose = pose_of(truth, where);
  ARTUS_TRY(pose);
  frame.pose = std::move(*pose);
  const json name = truth.value("transducer", json(""));
  const auto probe = probes.find(name.is_string() ? name.get<std::string>() : "?");
  const json pixel = truth.value("pixel_mm", json());
  if (probe == probes.end() || !pixel.is_number() || !(pixel.get<double>() > 0))
    return fail(ErrorCode::malformed, "'transducer' or 'pixel_mm' is invalid", where);
  frame.transducer = probe->second;
  frame.pixel = pixel.get<double>() * kMillimetre;
  const std::vector<char> bytes(png.begin(), png.end());
  const cv::Mat picture = bytes.empty() ? cv::Mat() : cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
  if (picture.empty() || picture.type() != CV_8UC1)
    return fail(ErrorCode::corrupt, "its image is not a PNG of 8-bit greys", where);
  frame.width = picture.cols;
  frame.height = picture.rows;
  frame.grey.assign(picture.datastart, picture.dataend);
  return frame;
}

Result<json> read_object(const fs::path& file) {
  const auto text = read_bytes(file);
  ARTUS_TRY(text);
  json object = json::parse(*text, nullptr, false);
  if (!object.is_object()) return fail(ErrorCode::malformed, "it is not JSON", file.string());
  return object;
}

Result<void> read_folder(const fs::path& folder, const Take& take) {
  const auto sweep = read_object(folder / "sweep.json");
  ARTUS_TRY(sweep);
  const auto probes = probes_of(*sweep);
  ARTUS_TRY(probes);
  const fs::path file = folder / "truth.jsonl";
  const auto lines = read_bytes(file);
  ARTUS_TRY(lines);
  std::size_t number = 0;
  for (std::size_t at = 0; at < lines->size(); ++number) {
    const std::size_t end = std::min(lines->find('\n', at), lines->size());
    const std::string_view line = std::string_view(*lines).substr(at, end - at);
    const std::string where = file.string() + ":" + std::to_string(number + 1);
    const json truth = json::parse(line, nullptr, false);
    const json name = truth.is_object() ? truth.value("image", json()) : json();
    if (!name.is_string()) return fail(ErrorCode::malformed, "the line has no 'image'", where);
    const auto png = read_bytes(folder / name.get<std::string>());
    ARTUS_TRY(png);
    const auto frame = frame_of(line, *png, *probes, where);
    ARTUS_TRY(frame);
    ARTUS_TRY(take(*frame));
    at = end + 1;
  }
  return {};
}

Result<void> read_shard(const fs::path& sidecar, const Take& take) {
  const auto said = read_object(sidecar);
  ARTUS_TRY(said);
  const auto probes = probes_of(said->value("sweep", json::object()));
  if (!probes) return fail(probes.error().code, probes.error().message, sidecar.string());
  const fs::path file = fs::path(sidecar).replace_extension(".tar");
  const auto archive = read_bytes(file);
  ARTUS_TRY(archive);
  const auto members = list_members(*archive);
  if (!members) return fail(members.error().code, members.error().message, file.string());
  for (std::size_t i = 0; i + 1 < members->size(); ++i) {
    const TarMember& line = (*members)[i];
    const TarMember& image = (*members)[i + 1];
    const std::string_view key = line.name.substr(0, line.name.find('.'));
    if (line.name.substr(key.size()) != ".json") continue;
    if (image.name != std::string(key) + ".png")
      return fail(ErrorCode::corrupt, "a frame has no image",
                  file.string() + ":" + std::string(key));
    const auto frame =
        frame_of(line.bytes, image.bytes, *probes, file.string() + ":" + std::string(key));
    ARTUS_TRY(frame);
    ARTUS_TRY(take(*frame));
  }
  return {};
}

}  // namespace

Result<void> read_sweep(const fs::path& folder, const Take& take) {
  std::error_code error;
  if (fs::exists(folder / "truth.jsonl", error)) return read_folder(folder, take);
  std::vector<fs::path> sidecars;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.path().filename().string().rfind("shard-", 0) == 0 &&
        entry.path().extension() == ".json")
      sidecars.push_back(entry.path());
  if (sidecars.empty())
    return fail(ErrorCode::not_found, "there is neither truth.jsonl nor a shard", folder.string());
  std::sort(sidecars.begin(), sidecars.end());
  for (const fs::path& sidecar : sidecars) ARTUS_TRY(read_shard(sidecar, take));
  return {};
}

}  // namespace artus
