// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/tar_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "artus/detail/core/check.h"

namespace artus {
namespace {

constexpr std::size_t kTarBlock = 512;   // bytes
constexpr std::size_t kNameSize = 100;   // bytes
constexpr std::size_t kSizeField = 124;  // where the size stands
constexpr std::size_t kSumField = 148;

using Block = std::array<char, kTarBlock>;

unsigned sum_of(const char* header) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < kTarBlock; ++i) {
    const bool own = i >= kSumField && i < kSumField + 8;
    sum += own ? ' ' : static_cast<unsigned char>(header[i]);
  }
  return sum;
}

void put(Block& header, std::size_t at, std::string_view text) {
  std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

/// An octal number that ends with a zero or a blank; -1 when it is none.
long long octal_at(const char* field, std::size_t size) {
  long long value = 0;
  const auto read = std::from_chars(field, field + size, value, 8);
  return read.ec == std::errc{} && value >= 0 ? value : -1;
}

std::size_t padded(std::size_t size) {
  return (size + kTarBlock - 1) / kTarBlock * kTarBlock;
}

Result<void> write_and_sync(int file, std::string_view bytes, const std::string& name) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(file, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return fail(ErrorCode::unreadable, std::generic_category().message(errno), name);
    bytes.remove_prefix(static_cast<std::size_t>(n));
  }
  if (fsync(file) != 0)
    return fail(ErrorCode::unreadable, std::generic_category().message(errno), name);
  return {};
}

}  // namespace

void append_member(std::string& archive, std::string_view name, std::string_view bytes) {
  ARTUS_REQUIRE(!name.empty() && name.size() <= kNameSize,
                "a member's name must have 1 to 100 bytes");
  Block header{};
  put(header, 0, name);
  put(header, 100, "0000644");
  put(header, 108, "0000000");
  put(header, 116, "0000000");
  std::array<char, 16> number{};
  std::snprintf(number.data(), number.size(), "%011zo", bytes.size());
  put(header, kSizeField, number.data());
  put(header, 136, "00000000000");
  header[156] = '0';
  put(header, 257, std::string_view("ustar\00000", 8));
  std::snprintf(number.data(), number.size(), "%06o", sum_of(header.data()));
  put(header, kSumField, std::string_view(number.data(), 7));
  header[kSumField + 7] = ' ';
  archive.append(header.data(), kTarBlock);
  archive.append(bytes);
  archive.append(padded(bytes.size()) - bytes.size(), '\0');
}

void finish_archive(std::string& archive) {
  archive.append(2 * kTarBlock, '\0');
}

Result<std::vector<TarMember>> list_members(std::string_view archive) {
  std::vector<TarMember> members;
  while (true) {
    if (archive.size() < kTarBlock) return fail(ErrorCode::corrupt, "the archive is cut off");
    const std::string_view header = archive.substr(0, kTarBlock);
    if (header.find_first_not_of('\0') == std::string_view::npos) return members;
    const long long size = octal_at(header.data() + kSizeField, 12);
    if (size < 0 ||
        octal_at(header.data() + kSumField, 8) != static_cast<int>(sum_of(header.data())))
      return fail(ErrorCode::corrupt, "a member's header is damaged");
    archive.remove_prefix(kTarBlock);
    const auto n = static_cast<std::size_t>(size);
    if (n > archive.size() || padded(n) > archive.size())
      return fail(ErrorCode::corrupt, "the archive is cut off");
    const std::string_view name = header.substr(0, kNameSize);
    members.push_back({name.substr(0, name.find('\0')), archive.substr(0, n)});
    archive.remove_prefix(padded(n));
  }
}

Result<void> write_durably(const std::filesystem::path& file, std::string_view bytes) {
  const std::filesystem::path part =
      file.parent_path() / ("part-" + std::to_string(getpid()) + "-" + file.filename().string());
  const int out = open(part.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0644);
  if (out < 0)
    return fail(ErrorCode::unreadable, std::generic_category().message(errno), part.string());
  const auto written = write_and_sync(out, bytes, part.string());
  close(out);
  ARTUS_TRY(written);
  std::error_code error;
  std::filesystem::rename(part, file, error);
  if (error) return fail(ErrorCode::unreadable, error.message(), file.string());
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const int directory = open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory >= 0) {
    fsync(directory);
    close(directory);
  }
  return {};
}

}  // namespace artus
