// SPDX-License-Identifier: AGPL-3.0-or-later
// NOLINTBEGIN: this file replaces the C allocator on purpose; reserved names and a thread-local are
// unavoidable.
#include "tests/support/no_alloc.h"

#include <cstddef>
#if defined(ARTUS_SANITIZED)
#define HOOKS 0
#else
#define HOOKS 1
#endif
namespace {
thread_local long g_count = -1;
}
#if HOOKS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void* malloc(std::size_t n) {
  if (g_count >= 0) ++g_count;
  return __libc_malloc(n);
}
void* calloc(std::size_t n, std::size_t s) {
  if (g_count >= 0) ++g_count;
  return __libc_calloc(n, s);
}
void* realloc(void* p, std::size_t n) {
  if (g_count >= 0) ++g_count;
  return __libc_realloc(p, n);
}
// Over-aligned operator new (libstdc++) and Eigen come through here.
void* aligned_alloc(std::size_t alignment, std::size_t n) {
  if (g_count >= 0) ++g_count;
  return __libc_memalign(alignment, n);
}
int posix_memalign(void** out, std::size_t alignment, std::size_t n) {
  if (g_count >= 0) ++g_count;
  *out = __libc_memalign(alignment, n);
  return *out == nullptr ? 12 /* ENOMEM */ : 0;
}
}
#endif
namespace artus::test {
AllocationCounter::AllocationCounter() noexcept {
  g_count = 0;
}
AllocationCounter::~AllocationCounter() {
  g_count = -1;
}
long AllocationCounter::count() const noexcept {
  return g_count;
}
bool AllocationCounter::supported() noexcept {
  return HOOKS != 0;
}
}  // namespace artus::test
// NOLINTEND
