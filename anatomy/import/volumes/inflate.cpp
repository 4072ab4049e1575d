// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/anatomy/import/volumes/inflate.h"

#include <algorithm>

#include <zlib.h>

#include "artus/detail/core/printed.h"

namespace artus {
namespace {

constexpr std::size_t kStep = std::size_t{1} << 20;  // bytes taken or given at once
constexpr int kEither = 15 + 32;                     // window of zlib; gzip or zlib by the header
constexpr int kGzip = 15 + 16;

/// A stream of zlib that is closed.
class Stream {
 public:
  Stream() { ok_ = inflateInit2(&z, kEither) == Z_OK; }
  ~Stream() {
    if (ok_) inflateEnd(&z);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;
  Stream(Stream&&) = delete;
  Stream& operator=(Stream&&) = delete;
  [[nodiscard]] bool ok() const noexcept { return ok_; }

  z_stream z{};

 private:
  bool ok_ = false;
};

tl::unexpected<Error> broken_off(std::size_t got, std::size_t wanted, const std::string& where) {
  return fail(ErrorCode::corrupt,
              printed("the compressed data break off: %zu of %zu bytes are there; the file is not "
                      "complete: copy or download it again",
                      got, wanted),
              where);
}

}  // namespace

bool is_gzip(std::string_view bytes) noexcept {
  return bytes.size() > 2 && bytes[0] == '\x1f' && bytes[1] == '\x8b';
}

Result<Inflated> inflate(std::string_view bytes, std::size_t at_most, const std::string& where) {
  Stream stream;
  if (!stream.ok()) return fail(ErrorCode::failed, "zlib cannot be started", where);
  z_stream& z = stream.z;
  Inflated out;
  while (out.bytes.size() < at_most) {
    const std::size_t before = out.bytes.size();
    const std::size_t room = std::min(std::max(kStep, before), at_most - before);
    out.bytes.resize(before + room);
    const std::size_t offered = std::min(bytes.size(), kStep);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));  // zlib only reads it
    z.avail_in = static_cast<uInt>(offered);
    z.next_out = reinterpret_cast<Bytef*>(out.bytes.data() + before);
    z.avail_out = static_cast<uInt>(std::min(room, std::size_t{1} << 30));
    const auto given = z.avail_out;
    const int code = ::inflate(&z, Z_NO_FLUSH);
    out.bytes.resize(before + (given - z.avail_out));
    bytes.remove_prefix(offered - z.avail_in);
    if (code == Z_STREAM_END) {
      if (!is_gzip(bytes)) {
        out.ended = true;
        return out;
      }
      inflateReset(&z);
    } else if (code == Z_BUF_ERROR || (code == Z_OK && bytes.empty() && z.avail_out > 0)) {
      return out;  // nothing more to take
    } else if (code != Z_OK) {
      return fail(ErrorCode::corrupt,
                  printed("the compressed data are damaged after %zu bytes (%s); copy or download "
                          "the file again",
                          out.bytes.size(), z.msg != nullptr ? z.msg : "no such stream"),
                  where);
    }
  }
  return out;
}

Result<std::string> inflate_exactly(std::string_view bytes, std::size_t size,
                                    const std::string& where) {
  auto out = inflate(bytes, size + 1, where);
  ARTUS_TRY(out);
  if (out->bytes.size() > size)
    return fail(
        ErrorCode::corrupt,
        printed("the compressed data hold more than the %zu bytes that the header promises", size),
        where);
  if (out->bytes.size() < size || !out->ended) return broken_off(out->bytes.size(), size, where);
  return std::move(out->bytes);
}

std::string deflate_gzip(std::string_view bytes) {
  z_stream z{};
  std::string out;
  if (deflateInit2(&z, Z_BEST_SPEED, Z_DEFLATED, kGzip, 8, Z_DEFAULT_STRATEGY) != Z_OK) return out;
  out.resize(deflateBound(&z, static_cast<uLong>(bytes.size())));
  std::size_t taken = 0;
  int code = Z_OK;
  while (code != Z_STREAM_END) {
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + taken));
    z.avail_in = static_cast<uInt>(std::min(bytes.size() - taken, std::size_t{1} << 30));
    const uInt offered = z.avail_in;
    z.next_out = reinterpret_cast<Bytef*>(out.data() + z.total_out);
    z.avail_out = static_cast<uInt>(std::min(out.size() - z.total_out, std::size_t{1} << 30));
    code = deflate(&z, taken + offered == bytes.size() ? Z_FINISH : Z_NO_FLUSH);
    taken += offered - z.avail_in;
    if (code != Z_OK && code != Z_STREAM_END) break;
  }
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

}  // namespace artus
