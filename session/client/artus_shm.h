/* SPDX-License-Identifier: AGPL-3.0-or-later
 *
 * The C client of artus' shared memory: headers, no library, C11 and C++ (GCC or Clang, Linux).
 * A device program writes its pose into POS and reads what the hand should feel from FORCE; the
 * newest B-mode image is in IMAGE. Where needle and probe are two devices with a program each, the
 * probe's opens with artus_shm_open_role(&link, "", ARTUS_SHM_ROLE_PROBE). artus_shm_layout.h has
 * every byte, docs/protocol.md the rules. With glibc older than 2.34 link with -lrt.
 *
 *   artus_shm_link link;
 *   if (artus_shm_open(&link, "") != 0) perror(link.refusal);
 *   for (;;) {                                   // at the device's rate, 1 kHz
 *     artus_shm_pos pos = artus_shm_pos_init();  // fill in pose and buttons
 *     artus_shm_write_pos(&link, &pos);
 *     artus_shm_force force;
 *     artus_shm_read_force(&link, &force);       // zero force when artus is silent for 20 ms
 *   }
 *
 * A segment that another program truncates does not kill its readers: a handler for SIGBUS puts an
 * empty page in its place (all other faults go to the handler that was there before). Define
 * ARTUS_SHM_NO_SIGBUS before the include to do without.
 */
#ifndef ARTUS_SHM_H
#define ARTUS_SHM_H
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "artus_shm_layout.h"

#define ARTUS_SHM_LOOK_NS 100000000ull /* between two looks for newer segments */
#define ARTUS_SHM_MAX_RANGES 64        /* mapped segments of one process */

/* The mapped segments of this process. Data for signal handlers has to be static; weak, so that all
 * files that include this header share it. */
typedef struct artus_shm_range {
  uintptr_t base; /* 0: unused, 1: being filled in */
  size_t size;    /* bytes, whole pages */
  int file;
  int lost;  /* a page of it had no file behind it any more */
  int force; /* FORCE, written by this process: the last that it says must be zero */
} artus_shm_range;
__attribute__((weak)) artus_shm_range artus_shm_ranges[ARTUS_SHM_MAX_RANGES];
__attribute__((weak)) struct sigaction artus_shm_former_sigbus;
__attribute__((weak)) int artus_shm_guards;

/* Gives the range empty memory of this process' own: whatever is written there stays here. */
static inline int artus_shm_detach(artus_shm_range* range) {
  void* base = (void*)__atomic_load_n(&range->base, __ATOMIC_ACQUIRE);
  __atomic_store_n(&range->lost, 1, __ATOMIC_RELEASE);
  return mmap(base, range->size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED,
              -1, 0) == MAP_FAILED
             ? -1
             : 0;
}

static inline void artus_shm_on_sigbus(int number, siginfo_t* info, void* context) {
  const uintptr_t at = (uintptr_t)info->si_addr;
  const int saved = errno;
  int i;
  for (i = 0; i < ARTUS_SHM_MAX_RANGES; ++i) {
    const uintptr_t base = __atomic_load_n(&artus_shm_ranges[i].base, __ATOMIC_ACQUIRE);
    if (base > 1 && at >= base && at - base < artus_shm_ranges[i].size &&
        artus_shm_detach(&artus_shm_ranges[i]) == 0) {
      errno = saved;
      return;
    }
  }
  if (artus_shm_former_sigbus.sa_flags & SA_SIGINFO)
    artus_shm_former_sigbus.sa_sigaction(number, info, context);
  else if (artus_shm_former_sigbus.sa_handler == SIG_DFL ||
           artus_shm_former_sigbus.sa_handler == SIG_IGN)
    signal(number, SIG_DFL); /* the access faults again and ends the process */
  else
    artus_shm_former_sigbus.sa_handler(number);
}

/* Takes SIGBUS, once a process. */
static inline void artus_shm_guard_all(void) {
#ifndef ARTUS_SHM_NO_SIGBUS
  struct sigaction action;
  if (__atomic_exchange_n(&artus_shm_guards, 1, __ATOMIC_ACQ_REL) != 0) return;
  memset(&action, 0, sizeof action);
  action.sa_sigaction = artus_shm_on_sigbus;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGBUS, &action, &artus_shm_former_sigbus);
#endif
}

/* Enters a mapping; 0 when the table is full, and then it is not guarded. */
static inline artus_shm_range* artus_shm_guard(void* base, size_t size, int file, int force) {
  const size_t page = (size_t)sysconf(_SC_PAGESIZE);
  int i;
  artus_shm_guard_all();
  for (i = 0; i < ARTUS_SHM_MAX_RANGES; ++i) {
    artus_shm_range* range = &artus_shm_ranges[i];
    uintptr_t unused = 0;
    if (!__atomic_compare_exchange_n(&range->base, &unused, 1, 0, __ATOMIC_ACQ_REL,
                                     __ATOMIC_RELAXED))
      continue;
    range->size = (size + page - 1) / page * page;
    range->file = file;
    range->lost = 0;
    range->force = force;
    __atomic_store_n(&range->base, (uintptr_t)base, __ATOMIC_RELEASE);
    return range;
  }
  return 0;
}

static inline void artus_shm_unguard(artus_shm_range* range) {
  if (range) __atomic_store_n(&range->base, (uintptr_t)0, __ATOMIC_RELEASE);
}

static inline int artus_shm_is_lost(const artus_shm_range* range) {
  return range && __atomic_load_n(&range->lost, __ATOMIC_ACQUIRE);
}

/* One mapped segment; `beat` and `seen_ns` remember when its heartbeat last changed. */
typedef struct artus_shm_segment {
  artus_shm_header* header;
  artus_shm_range* range;
  size_t size; /* bytes that are mapped, whatever the header says */
  int file;
  int gone; /* its name leads elsewhere and the new one could not be opened */
  uint64_t beat;
  uint64_t seen_ns;
} artus_shm_segment;

typedef struct artus_shm_link {
  artus_shm_segment pos;
  artus_shm_segment force;
  artus_shm_force last; /* the newest that was read whole */
  char prefix[ARTUS_SHM_MAX_PREFIX + 1];
  int role; /* ARTUS_SHM_ROLE_... */
  uint64_t looked_ns;
  const char* refusal; /* what could not be opened, for a message; errno says why */
} artus_shm_link;

/* IMAGE, opened for reading. */
typedef struct artus_shm_screen {
  artus_shm_segment image;
  char prefix[ARTUS_SHM_MAX_PREFIX + 1];
  uint64_t looked_ns;
} artus_shm_screen;

/* Seqlock write: the sequence is odd while the words change; release order keeps them after it. */
static inline void artus_shm_store(artus_shm_header* header, const void* value, size_t size) {
  uint64_t* words = (uint64_t*)(header + 1);
  const uint64_t odd = __atomic_load_n(&header->sequence, __ATOMIC_RELAXED) | 1u;
  size_t i;
  __atomic_store_n(&header->sequence, odd, __ATOMIC_RELAXED);
  for (i = 0; i < size / 8; ++i) {
    uint64_t word;
    memcpy(&word, (const char*)value + 8 * i, 8);
    __atomic_store_n(&words[i], word, __ATOMIC_RELEASE);
  }
  __atomic_store_n(&header->sequence, odd + 1, __ATOMIC_RELEASE);
  __atomic_fetch_add(&header->heartbeat, 1, __ATOMIC_RELEASE);
}

/* Seqlock read; 1: `value` is whole, 0: the writer was writing during each of 64 tries. */
static inline int artus_shm_load(const artus_shm_header* header, void* value, size_t size) {
  const uint64_t* words = (const uint64_t*)(header + 1);
  int attempt;
  size_t i;
  for (attempt = 0; attempt < 64; ++attempt) {
    const uint64_t before = __atomic_load_n(&header->sequence, __ATOMIC_ACQUIRE);
    if (before & 1u) continue;
    for (i = 0; i < size / 8; ++i) {
      const uint64_t word = __atomic_load_n(&words[i], __ATOMIC_ACQUIRE);
      memcpy((char*)value + 8 * i, &word, 8);
    }
    if (__atomic_load_n(&header->sequence, __ATOMIC_RELAXED) == before) return 1;
  }
  return 0;
}

static inline void artus_shm_unmap(artus_shm_segment* segment) {
  artus_shm_unguard(segment->range);
  if (segment->header) munmap(segment->header, segment->size);
  if (segment->file >= 0) close(segment->file);
  memset(segment, 0, sizeof *segment);
  segment->file = -1;
}

/* Opens the named segment; -1 and errno when it cannot be used: EPERM (others may touch it), EBUSY
 * (`write`: it has a writer), ENOENT (not `make`). */
static inline int artus_shm_open_file(const char* name, int make, int write) {
  struct stat st;
  int why = EPERM;
  const int file = shm_open(name, O_RDWR | O_CLOEXEC | (make ? O_CREAT : 0), 0600);
  if (file < 0) return -1;
  if (fstat(file, &st) == 0 && st.st_uid == geteuid() && (st.st_mode & 077) == 0) {
    /* the kernel drops this lock at a crash */
    if (!write || flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    why = EBUSY;
  }
  close(file);
  errno = why;
  return -1;
}

/* Maps an opened segment, after giving an empty one its size and header. It owns `file` from then
 * on. -1 and EPROTO when it is not one of this version. */
static inline int artus_shm_map_file(artus_shm_segment* segment, int file, uint64_t magic,
                                     size_t payload, int write) {
  const size_t size = sizeof(artus_shm_header) + payload;
  struct stat st;
  artus_shm_header* h;
  if (fstat(file, &st) != 0) return -1;
  if (st.st_size == 0 && ftruncate(file, (off_t)size) != 0) return -1;
  if (st.st_size != 0 && st.st_size != (off_t)size) return errno = EPROTO, -1;
  h = (artus_shm_header*)mmap(0, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (h == MAP_FAILED) return -1;
  memset(segment, 0, sizeof *segment);
  segment->header = h;
  segment->size = size;
  segment->file = file;
  segment->range = artus_shm_guard(h, size, file, 0);
  if (h->magic == 0) { /* fresh; two that start at once write the same here */
    h->version = ARTUS_SHM_VERSION;
    h->size = (uint32_t)size;
    h->payload = (uint32_t)payload;
    __atomic_store_n(&h->magic, magic, __ATOMIC_RELEASE);
  }
  if (h->magic != magic || h->version != ARTUS_SHM_VERSION || h->size != size ||
      h->payload != payload) {
    segment->file = -1; /* stays the caller's */
    artus_shm_unmap(segment);
    return errno = EPROTO, -1;
  }
  if (write) {
    __atomic_store_n(&h->opened_ns, artus_shm_now_ns(), __ATOMIC_RELEASE);
    __atomic_store_n(&h->writer_pid, (uint64_t)getpid(), __ATOMIC_RELEASE);
  }
  segment->beat =
      __atomic_load_n(&h->heartbeat, __ATOMIC_ACQUIRE); /* what was left behind is old */
  return 0;
}

/* A kind of segment: its name after the prefix, and what its header must say. */
typedef struct artus_shm_kind {
  const char* name;
  uint64_t magic;
  size_t payload;
} artus_shm_kind;

/* Follows the name: maps what it leads to now, if that is not what is mapped. A writer's lock goes
 * with its file: it is never given up while the name leads there. -1 and errno: the old mapping
 * stays, marked as gone. */
static inline int artus_shm_follow(artus_shm_segment* segment, const char* prefix,
                                   const artus_shm_kind* kind, int write, int make) {
  char name[ARTUS_SHM_MAX_PREFIX + 16];
  struct stat ours, named;
  artus_shm_segment fresh;
  int file, same = 0, looked = -1;
  snprintf(name, sizeof name, "/%s%s", prefix, kind->name);
  if (segment->header) {
    looked = shm_open(name, O_RDONLY | O_CLOEXEC, 0);
    same = looked >= 0 && fstat(looked, &named) == 0 && fstat(segment->file, &ours) == 0 &&
           named.st_ino == ours.st_ino && named.st_dev == ours.st_dev;
    if (looked >= 0) close(looked);
    if (same && (size_t)ours.st_size == segment->size && !artus_shm_is_lost(segment->range))
      return segment->gone = 0;
  }
  file = same ? segment->file : artus_shm_open_file(name, make, write);
  if (file < 0) return segment->gone = 1, -1;
  if (artus_shm_map_file(&fresh, file, kind->magic, kind->payload, write) != 0) {
    const int why = errno;
    if (!same) close(file);
    segment->gone = 1;
    return errno = why, -1;
  }
  if (same) segment->file = -1; /* the fresh one has it */
  artus_shm_unmap(segment);
  *segment = fresh;
  return 0;
}

static inline int artus_shm_follow_pos(artus_shm_link* link) {
  const artus_shm_kind kind = {link->role == ARTUS_SHM_ROLE_PROBE ? "POS-PROBE" : "POS",
                               ARTUS_SHM_MAGIC_POS, sizeof(artus_shm_pos)};
  return artus_shm_follow(&link->pos, link->prefix, &kind, 1, 1);
}
static inline int artus_shm_follow_force(artus_shm_link* link) {
  const artus_shm_kind kind = {"FORCE", ARTUS_SHM_MAGIC_FORCE, sizeof(artus_shm_force)};
  return artus_shm_follow(&link->force, link->prefix, &kind, 0, 1);
}
static inline int artus_shm_follow_image(artus_shm_screen* screen) {
  const artus_shm_kind kind = {"IMAGE", ARTUS_SHM_MAGIC_IMAGE, sizeof(artus_shm_image)};
  return artus_shm_follow(&screen->image, screen->prefix, &kind, 0, 0);
}

/* Opens a hand's segment for writing, POS or POS-PROBE by its role, and FORCE for reading; either
 * side may start first. `prefix` stands before the names, "" for the usual ones. 0, or -1 with
 * errno and link->refusal: EINVAL (the prefix, see artus_shm_is_prefix, or the role), EPROTO (a
 * segment is not one of this version), EPERM (others may touch it), EBUSY (that role has a writer).
 */
static inline int artus_shm_open_role(artus_shm_link* link, const char* prefix, int role) {
  const int probe = role == ARTUS_SHM_ROLE_PROBE;
  memset(link, 0, sizeof *link);
  link->pos.file = link->force.file = -1;
  link->refusal = prefix;
  if (!artus_shm_is_prefix(prefix)) return errno = EINVAL, -1;
  link->refusal = "role";
  if (!probe && role != ARTUS_SHM_ROLE_ALL) return errno = EINVAL, -1;
  memcpy(link->prefix, prefix, strlen(prefix) + 1);
  link->role = role;
  link->refusal = probe ? "POS-PROBE" : "POS";
  if (artus_shm_follow_pos(link) != 0) {
    if (errno == EPROTO)
      link->refusal = probe ? "POS-PROBE is of another version of artus' shared memory"
                            : "POS is of another version of artus' shared memory";
    return -1;
  }
  link->refusal = "FORCE";
  if (artus_shm_follow_force(link) != 0) {
    const int why = errno;
    if (why == EPROTO) link->refusal = "FORCE is of another version of artus' shared memory";
    artus_shm_unmap(&link->pos);
    return errno = why, -1;
  }
  link->refusal = 0;
  return 0;
}

/* The same for a program that holds the needle, or both hands. */
static inline int artus_shm_open(artus_shm_link* link, const char* prefix) {
  return artus_shm_open_role(link, prefix, ARTUS_SHM_ROLE_ALL);
}

static inline void artus_shm_close(artus_shm_link* link) {
  if (link->pos.header) __atomic_store_n(&link->pos.header->writer_pid, 0, __ATOMIC_RELEASE);
  artus_shm_unmap(&link->pos);
  artus_shm_unmap(&link->force);
}

static inline void artus_shm_write_pos(artus_shm_link* link, const artus_shm_pos* pos) {
  artus_shm_store(link->pos.header, pos, sizeof *pos);
}

/* At most every 100 ms: what do the names lead to? */
static inline void artus_shm_look(artus_shm_link* link, uint64_t now) {
  if (now - link->looked_ns < ARTUS_SHM_LOOK_NS) return;
  link->looked_ns = now;
  artus_shm_follow_pos(link);
  artus_shm_follow_force(link);
}

/* Whether artus hears what this program writes. */
static inline int artus_shm_is_heard(const artus_shm_link* link, const artus_shm_force* force) {
  const uint32_t no_pose = 1u << 4;
  return link->role == ARTUS_SHM_ROLE_PROBE
             ? !(force->probe_status & (ARTUS_SHM_PEER_LOST | no_pose))
             : !(force->status & ARTUS_SHM_PEER_LOST);
}

/* The newest force; zero with ARTUS_SHM_SILENT when FORCE did not change, or was computed, 20 ms
 * ago, and with ARTUS_SHM_FORCE_INVALID beside when what is there cannot be a force. While artus is
 * silent or does not hear POS it looks whether the names lead to new segments. 1: fresh, 0: silent.
 */
static inline int artus_shm_read_force(artus_shm_link* link, artus_shm_force* force) {
  artus_shm_segment* s = &link->force;
  uint64_t now = 0;
  int attempt, scribbled = 0;
  for (attempt = 0; attempt < 4; ++attempt) { /* again when this thread itself was held up */
    const uint64_t beat = __atomic_load_n(&s->header->heartbeat, __ATOMIC_ACQUIRE);
    const int whole = artus_shm_load(s->header, force, sizeof *force);
    int64_t age;
    now =
        artus_shm_now_ns(); /* after the load: a force of the moment between is not of the future */
    if (beat != s->beat) {
      s->beat = beat;
      s->seen_ns = now;
    }
    if (s->seen_ns == 0) continue; /* what is there may be a left-over */
    scribbled = whole && !artus_shm_is_force(force);
    if (scribbled) break;
    if (whole) {
      force->layer_name[sizeof force->layer_name - 1] = 0;
      link->last = *force;
    }
    age = (int64_t)(now - link->last.time_ns);
    if (age > -1000000 && age < (int64_t)ARTUS_SHM_STALE_NS &&
        now - s->seen_ns < ARTUS_SHM_STALE_NS && !link->pos.gone) {
      *force = link->last;
      if (!artus_shm_is_heard(link, force) || artus_shm_is_lost(link->pos.range))
        artus_shm_look(link, now);
      return 1;
    }
  }
  memset(force, 0, sizeof *force);
  force->status = ARTUS_SHM_SILENT | (scribbled ? (uint32_t)ARTUS_SHM_FORCE_INVALID : 0u);
  if (now - s->seen_ns > ARTUS_SHM_LOOK_NS || artus_shm_is_lost(s->range) || link->pos.gone)
    artus_shm_look(link, now);
  return 0;
}

/* Opens IMAGE for reading. 0, or -1 with errno: ENOENT (artus writes none), else as artus_shm_open.
 */
static inline int artus_shm_open_image(artus_shm_screen* screen, const char* prefix) {
  memset(screen, 0, sizeof *screen);
  screen->image.file = -1;
  if (!artus_shm_is_prefix(prefix)) return errno = EINVAL, -1;
  memcpy(screen->prefix, prefix, strlen(prefix) + 1);
  return artus_shm_follow_image(screen);
}

/* Copies the newest image when it is newer than that of the last call: 1, else 0. Follows the name
 * after 100 ms without one. */
static inline int artus_shm_read_image(artus_shm_screen* screen, artus_shm_image* image) {
  artus_shm_segment* s = &screen->image;
  const size_t head = sizeof *image - sizeof image->grey;
  const uint64_t beat = __atomic_load_n(&s->header->heartbeat, __ATOMIC_ACQUIRE);
  const uint64_t now = artus_shm_now_ns();
  if (beat != s->beat && artus_shm_load(s->header, image, head) &&
      (uint64_t)image->width * image->height <= ARTUS_SHM_IMAGE_CAPACITY) {
    const uint32_t width = image->width, height = image->height;
    const size_t pixels = (size_t)width * height;
    if (artus_shm_load(s->header, image, head + (pixels + 7) / 8 * 8) && image->width == width &&
        image->height == height) {
      s->beat = beat;
      s->seen_ns = now;
      return 1;
    }
  }
  if (now - s->seen_ns > ARTUS_SHM_LOOK_NS && now - screen->looked_ns > ARTUS_SHM_LOOK_NS) {
    screen->looked_ns = now;
    artus_shm_follow_image(screen);
  }
  return 0;
}

static inline void artus_shm_close_image(artus_shm_screen* screen) {
  artus_shm_unmap(&screen->image);
}
#endif /* ARTUS_SHM_H */
