// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/shm/shared_memory.h"

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <optional>
#include <system_error>
#include <thread>
#include <utility>

#include <boost/interprocess/exceptions.hpp>
#include <boost/interprocess/mapped_region.hpp>
#include <boost/interprocess/permissions.hpp>
#include <boost/interprocess/shared_memory_object.hpp>

namespace artus {
namespace ipc = boost::interprocess;

static_assert(sizeof(artus_shm_header) == 64);
static_assert(offsetof(artus_shm_header, sequence) == 56, "the seqlock's words follow it");
static_assert(sizeof(artus_shm_pos) == 160 && sizeof(artus_shm_force) == 296);

struct SharedSegment::Impl {
  std::string prefix;
  std::string name;
  SegmentLayout layout;
  SegmentAccess access = SegmentAccess::observer;
  bool writes = false;
  ipc::shared_memory_object object;
  ipc::mapped_region region;
  artus_shm_range* range = nullptr;

  Impl() = default;
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;
  ~Impl() { artus_shm_unguard(range); }  // before the region goes

  [[nodiscard]] artus_shm_header* header() const noexcept {
    return static_cast<artus_shm_header*>(region.get_address());
  }
  [[nodiscard]] int file() const noexcept { return object.get_mapping_handle().handle; }
};

namespace {

std::uint64_t load(const std::uint64_t& word) noexcept {
  return __atomic_load_n(&word, __ATOMIC_ACQUIRE);
}

enum class Soundness { sound, fresh, damaged, foreign };

Soundness inspect(int file, const SegmentLayout& layout) noexcept {
  struct stat st {};
  if (fstat(file, &st) != 0) return Soundness::damaged;
  if (st.st_uid != geteuid()) return Soundness::foreign;
  if ((st.st_mode & 077U) != 0) return Soundness::damaged;
  if (st.st_size == 0) return Soundness::fresh;
  return st.st_size == static_cast<off_t>(layout.size()) ? Soundness::sound : Soundness::damaged;
}

bool has_right_head(const artus_shm_header& head, const SegmentLayout& layout) noexcept {
  return load(head.magic) == layout.magic && head.version == ARTUS_SHM_VERSION &&
         head.size == layout.size() && head.payload == layout.payload_size;
}

void write_head(artus_shm_header& head, const SegmentLayout& layout) noexcept {
  head.version = ARTUS_SHM_VERSION;
  head.size = layout.size();
  head.payload = layout.payload_size;
  __atomic_store_n(&head.magic, layout.magic, __ATOMIC_RELEASE);
}

/// What a name leads to; empty when there is none.
std::optional<struct stat> find_file(const std::string& name) noexcept {
  const int file = shm_open(("/" + name).c_str(), O_RDONLY | O_CLOEXEC, 0);
  if (file < 0) return std::nullopt;
  struct stat found {};
  const bool known = fstat(file, &found) == 0;
  close(file);
  return known ? std::optional(found) : std::nullopt;
}

bool is_same_file(const struct stat& a, const struct stat& b) noexcept {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

/// The writer's lock; a program that is just starting or stopping may hold it for a moment.
bool take_writer_lock(int file) {
  for (int i = 0; i < 20; ++i) {
    if (flock(file, LOCK_EX | LOCK_NB) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace

SharedSegment::SharedSegment(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
SharedSegment::SharedSegment(SharedSegment&&) noexcept = default;
SharedSegment& SharedSegment::operator=(SharedSegment&&) noexcept = default;

SharedSegment::~SharedSegment() {
  if (impl_ && impl_->writes) {
    __atomic_store_n(&impl_->header()->writer_pid, std::uint64_t{0}, __ATOMIC_RELEASE);
  }
}

namespace {

/// What one attempt to open ended with: a left-over that must go first, or the answer.
struct Attempt {
  bool replace = false;
  std::optional<Error> error;
};

template <class Segment>
Attempt map_segment(Segment& impl, bool owner) {
  const SegmentLayout& layout = impl.layout;
  switch (inspect(impl.file(), layout)) {
    case Soundness::foreign:
      return {false, Error{ErrorCode::invalid, "the shared memory belongs to another user", {}}};
    case Soundness::damaged:
      if (owner) return {true, {}};
      return {false, Error{ErrorCode::corrupt,
                           "the shared memory has the wrong size or is open to others",
                           {}}};
    case Soundness::fresh:
      if (!owner) return {false, Error{ErrorCode::corrupt, "the shared memory is empty", {}}};
      impl.object.truncate(layout.size());
      break;
    case Soundness::sound:
      break;
  }
  impl.region = ipc::mapped_region(impl.object, ipc::read_write, 0, layout.size());
  impl.range = artus_shm_guard(impl.region.get_address(), layout.size(), impl.file(), 0);
  artus_shm_header* head = impl.header();
  if (load(head->magic) == 0 && owner) write_head(*head, layout);
  if (has_right_head(*head, layout)) return {};
  if (owner) return {true, {}};
  return {false,
          Error{ErrorCode::corrupt, "the shared memory is not of this version of artus", {}}};
}

}  // namespace

Result<SharedSegment> SharedSegment::open(const std::string& prefix, const SegmentLayout& layout,
                                          SegmentAccess access) {
  const bool owner = access != SegmentAccess::observer;
  const std::string name = prefix + layout.name;
  if (artus_shm_is_prefix(prefix.c_str()) == 0 || prefix.find('\0') != std::string::npos)
    return fail(ErrorCode::invalid,
                "a prefix has at most 63 letters, digits, '-', '_' and '.', not \"" + prefix + "\"",
                "--prefix");
  for (int attempt = 0; attempt < 3; ++attempt) {
    try {
      auto impl = std::make_unique<Impl>();
      impl->prefix = prefix;
      impl->name = name;
      impl->layout = layout;
      impl->access = access;
      impl->object = owner
                         ? ipc::shared_memory_object(ipc::open_or_create, name.c_str(),
                                                     ipc::read_write, ipc::permissions(0600))
                         : ipc::shared_memory_object(ipc::open_only, name.c_str(), ipc::read_write);
      const Attempt result = map_segment(*impl, owner);
      if (result.error) return fail(result.error->code, result.error->message, name);
      if (result.replace) {
        ipc::shared_memory_object::remove(name.c_str());
        continue;
      }
      if (access == SegmentAccess::owner_writes) {
        if (!take_writer_lock(impl->file()))
          return fail(ErrorCode::invalid,
                      "another program is writing to this shared memory; stop it first", name);
        impl->writes = true;
        if (impl->range != nullptr && layout.magic == ARTUS_SHM_MAGIC_FORCE) impl->range->force = 1;
        __atomic_store_n(&impl->header()->opened_ns, artus_shm_now_ns(), __ATOMIC_RELEASE);
        __atomic_store_n(&impl->header()->writer_pid, static_cast<std::uint64_t>(getpid()),
                         __ATOMIC_RELEASE);
      }
      return SharedSegment(std::move(impl));
    } catch (const ipc::interprocess_exception& e) {
      if (e.get_error_code() == ipc::not_found_error)
        return fail(ErrorCode::not_found,
                    "this shared memory does not exist; start `artus serve` first", name);
      if (e.get_error_code() == ipc::security_error)
        return fail(ErrorCode::invalid, "the shared memory belongs to another user", name);
      if (attempt == 2) return fail(ErrorCode::unreadable, e.what(), name);
    }
  }
  return fail(ErrorCode::unreadable,
              "damaged shared memory of an earlier run could not be replaced", name);
}

Result<SharedSegment> SharedSegment::open_again() const {
  remove_own();  // spoiled: nobody else has a right to it, and its lock is held here
  return open(impl_->prefix, impl_->layout, impl_->access);
}

void SharedSegment::remove_own() const noexcept {
  struct stat ours {};
  const auto named = find_file(impl_->name);
  if (named && fstat(impl_->file(), &ours) == 0 && is_same_file(*named, ours))
    remove(impl_->prefix, impl_->layout);
}

void SharedSegment::remove(const std::string& prefix, const SegmentLayout& layout) noexcept {
  shm_unlink(("/" + prefix + layout.name).c_str());
}

std::uint64_t SharedSegment::heartbeat() const noexcept {
  return load(impl_->header()->heartbeat);
}

std::uint64_t SharedSegment::writer_pid() const noexcept {
  return load(impl_->header()->writer_pid);
}

std::uint64_t SharedSegment::opened_ns() const noexcept {
  return load(impl_->header()->opened_ns);
}

void SharedSegment::beat() noexcept {
  __atomic_fetch_add(&impl_->header()->heartbeat, std::uint64_t{1}, __ATOMIC_RELEASE);
}

void* SharedSegment::seqlock() const noexcept {
  return &impl_->header()->sequence;
}

const char* SharedSegment::find_trouble() const noexcept {
  struct stat ours {};
  if (artus_shm_is_lost(impl_->range) != 0) return "was cut off";
  if (fstat(impl_->file(), &ours) != 0) return "cannot be read";
  const auto named = find_file(impl_->name);
  if (!named) return "was removed";
  if (!is_same_file(*named, ours)) return "was replaced";
  if (named->st_size != static_cast<off_t>(impl_->layout.size())) return "was cut off";
  if (!has_right_head(*impl_->header(), impl_->layout)) return "was overwritten";
  return nullptr;
}

}  // namespace artus
