// SPDX-License-Identifier: AGPL-3.0-or-later
// NOLINTBEGIN: this file stands before the C library's locks on purpose; reserved names and a
// thread-local are unavoidable.
#include "tests/support/no_lock.h"

#include <dlfcn.h>
#include <pthread.h>
#include <semaphore.h>
#if defined(ARTUS_SANITIZED)
#define HOOKS 0
#else
#define HOOKS 1
#endif
namespace {
thread_local long g_locks = -1;
}
#if HOOKS
namespace {
template <class Function>
Function* next(const char* name) noexcept {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}
void count_lock() noexcept {
  if (g_locks >= 0) ++g_locks;
}
}  // namespace
extern "C" {
int pthread_mutex_lock(pthread_mutex_t* m) noexcept {
  static const auto real = next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  count_lock();
  return real(m);
}
int pthread_mutex_trylock(pthread_mutex_t* m) noexcept {
  static const auto real = next<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  count_lock();
  return real(m);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* l) noexcept {
  static const auto real = next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  count_lock();
  return real(l);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* l) noexcept {
  static const auto real = next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  count_lock();
  return real(l);
}
int pthread_cond_wait(pthread_cond_t* c, pthread_mutex_t* m) {
  static const auto real = next<int(pthread_cond_t*, pthread_mutex_t*)>("pthread_cond_wait");
  count_lock();
  return real(c, m);
}
int sem_wait(sem_t* s) {
  static const auto real = next<int(sem_t*)>("sem_wait");
  count_lock();
  return real(s);
}
}
#endif
namespace artus::test {
LockCounter::LockCounter() noexcept {
  g_locks = 0;
}
LockCounter::~LockCounter() {
  g_locks = -1;
}
long LockCounter::count() const noexcept {
  return g_locks;
}
bool LockCounter::supported() noexcept {
  return HOOKS != 0;
}
}  // namespace artus::test
// NOLINTEND
