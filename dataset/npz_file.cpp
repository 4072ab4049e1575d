// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/dataset/npz_file.h"

#include <bit>
#include <cstdint>
#include <limits>
#include <type_traits>

#include <zlib.h>

namespace artus {
namespace {

static_assert(std::endian::native == std::endian::little, "arrays are written as they lie");

constexpr std::size_t kAligned = 64;  // bytes, of an array's beginning
constexpr std::uint16_t kVersion = 20;
constexpr std::uint16_t kFirstDay = 0x21;  // 1 January 1980, the earliest that there is

template <class Integer>
void put(std::string& out, Integer value) {
  for (std::size_t i = 0; i < sizeof(Integer); ++i)
    out.push_back(static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xffU));
}

template <class T>
constexpr const char* kKind = "<f4";
template <>
constexpr const char* kKind<double> = "<f8";
template <>
constexpr const char* kKind<std::complex<float>> = "<c8";

/// An array as a .npy file.
std::string npy_of(const NamedArray& array) {
  std::string shape;
  for (const std::size_t n : array.shape) shape += std::to_string(n) + ", ";
  return std::visit(
      [&](const auto& values) {
        using T = std::remove_const_t<typename std::remove_cvref_t<decltype(values)>::element_type>;
        std::string head = std::string("{'descr': '") + kKind<T> +
                           "', 'fortran_order': False, 'shape': (" + shape + "), }";
        constexpr std::size_t kMagic = 10;
        head.append(kAligned - 1 - (kMagic + head.size()) % kAligned, ' ');
        head.push_back('\n');
        std::string out("\x93NUMPY\x01\x00", 8);
        put(out, static_cast<std::uint16_t>(head.size()));
        out += head;
        out.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());
        return out;
      },
      array.values);
}

struct Entry {
  std::string name;
  std::uint32_t sum;
  std::uint32_t size;
  std::uint32_t begin;
};

/// What a member's own header and its line in the directory share.
void put_facts(std::string& out, const Entry& entry) {
  put(out, kVersion);
  put(out, std::uint16_t{0});  // flags
  put(out, std::uint16_t{0});  // stored
  put(out, std::uint16_t{0});  // time
  put(out, kFirstDay);
  put(out, entry.sum);
  put(out, entry.size);
  put(out, entry.size);
  put(out, static_cast<std::uint16_t>(entry.name.size()));
  put(out, std::uint16_t{0});  // extra
}

void put_directory_line(std::string& out, const Entry& entry) {
  put(out, std::uint32_t{0x02014b50});
  put(out, kVersion);
  put_facts(out, entry);
  put(out, std::uint16_t{0});  // comment
  put(out, std::uint16_t{0});  // disk
  put(out, std::uint16_t{0});  // inside
  put(out, std::uint32_t{0});  // outside
  put(out, entry.begin);
  out += entry.name;
}

}  // namespace

Result<std::string> npz_bytes(std::span<const NamedArray> arrays) {
  std::string out;
  std::string directory;
  for (const NamedArray& array : arrays) {
    const std::string bytes = npy_of(array);
    if (out.size() + bytes.size() > std::numeric_limits<std::uint32_t>::max() / 2)
      return fail(ErrorCode::unsupported, "the arrays are too large for one .npz",
                  std::string(array.name));
    const auto size = static_cast<std::uint32_t>(bytes.size());
    const auto sum = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), size);
    const Entry entry{std::string(array.name) + ".npy", static_cast<std::uint32_t>(sum), size,
                      static_cast<std::uint32_t>(out.size())};
    put(out, std::uint32_t{0x04034b50});
    put_facts(out, entry);
    out += entry.name;
    out += bytes;
    put_directory_line(directory, entry);
  }
  const auto begin = static_cast<std::uint32_t>(out.size());
  out += directory;
  put(out, std::uint32_t{0x06054b50});
  put(out, std::uint32_t{0});  // disks
  put(out, static_cast<std::uint16_t>(arrays.size()));
  put(out, static_cast<std::uint16_t>(arrays.size()));
  put(out, static_cast<std::uint32_t>(directory.size()));
  put(out, begin);
  put(out, std::uint16_t{0});  // comment
  return out;
}

}  // namespace artus
