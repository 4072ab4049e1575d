/* SPDX-License-Identifier: AGPL-3.0-or-later
 *
 * The C client of artus' shared memory: one header, no library, C11 and C++ (GCC or Clang, Linux).
 * A device program writes its pose into POS and reads what the hand should feel from FORCE; the
 * newest B-mode image is in IMAGE. docs/protocol.md describes every byte. With glibc older than
 * 2.34 link with -lrt.
 *
 *   artus_shm_link link;
 *   if (artus_shm_open(&link, "") != 0) perror(link.refusal);
 *   for (;;) {                                   // at the device's rate, 1 kHz
 *     artus_shm_pos pos = artus_shm_pos_init();  // fill in pose and buttons
 *     artus_shm_write_pos(&link, &pos);
 *     artus_shm_force force;
 *     artus_shm_read_force(&link, &force);       // zero force when artus is silent for 20 ms
 *   }
 */
#ifndef ARTUS_SHM_H
#define ARTUS_SHM_H
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1
#endif
#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define ARTUS_SHM_VERSION 1u
#define ARTUS_SHM_MAGIC_POS 0x31534f5053545241ull   /* "ARTSPOS1" */
#define ARTUS_SHM_MAGIC_FORCE 0x3143524653545241ull /* "ARTSFRC1" */
#define ARTUS_SHM_MAGIC_IMAGE 0x31474d4953545241ull /* "ARTSIMG1" */
#define ARTUS_SHM_IMAGE_CAPACITY (1024u * 1024u)    /* pixels */
#define ARTUS_SHM_STALE_NS 20000000ull              /* silence after which a peer counts as lost */

/* The first 64 bytes of every segment. All numbers are little-endian. */
typedef struct artus_shm_header {
  uint64_t magic;        /*  0 which segment, ARTUS_SHM_MAGIC_... */
  uint32_t version;      /*  8 ARTUS_SHM_VERSION */
  uint32_t size;         /* 12 bytes of the whole segment */
  uint32_t payload;      /* 16 bytes of the payload, which begins at byte 64 */
  uint32_t reserved;     /* 20 zero */
  uint64_t writer_pid;   /* 24 process that writes; 0: none, or it left in good order */
  uint64_t heartbeat;    /* 32 grows while the writer lives */
  uint64_t reserved2[2]; /* 40 zero */
  uint64_t sequence;     /* 56 odd while the payload is being written */
} artus_shm_header;

enum { ARTUS_SHM_NEEDLE = 1u, ARTUS_SHM_PROBE = 2u }; /* artus_shm_pos.present */

/* POS: where needle and probe are, written by the device program. World frame W, metres.
 * Needle: origin at the tip, z from hub to tip. Probe: origin at the footprint's centre, x along
 * the scanlines' row, z into the body. Quaternions w, x, y, z. */
typedef struct artus_shm_pos {
  uint64_t sample;           /*   0 grows by one with every sample */
  uint64_t time_ns;          /*   8 CLOCK_MONOTONIC when the pose was measured */
  double needle_position[3]; /*  16 m */
  double needle_rotation[4]; /*  40 */
  double probe_position[3];  /*  72 m */
  double probe_rotation[4];  /*  96 */
  uint32_t buttons; /* 128 bit 0: choose the entry point and calibrate; 1: back to exploring */
  uint32_t present; /* 132 ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE */
} artus_shm_pos;    /* 136 */

/* artus_shm_force.status: bits 0-10 are those of artus' needle tick (docs/protocol.md). */
enum {
  ARTUS_SHM_PEER_LOST = 1u << 16,   /* POS is silent or was never written */
  ARTUS_SHM_POS_INVALID = 1u << 17, /* POS holds values that are not a pose */
  ARTUS_SHM_PAUSED = 1u << 18,
  ARTUS_SHM_STOPPED = 1u << 19, /* artus left in good order */
  ARTUS_SHM_SILENT = 1u << 20   /* set by artus_shm_read_force: FORCE itself is stale */
};

/* FORCE: what the hand should feel, written by artus. Frame W, at the needle's tip. */
typedef struct artus_shm_force {
  uint64_t tick;        /*   0 artus' haptic tick */
  uint64_t time_ns;     /*   8 CLOCK_MONOTONIC when the force was computed */
  uint64_t pos_sample;  /*  16 artus_shm_pos.sample that it answers */
  uint64_t pos_time_ns; /*  24 artus_shm_pos.time_ns of that sample */
  double force[3];      /*  32 N */
  double torque[3];     /*  56 N m */
  double stiffness;     /*  80 N/m, of the layer at the tip */
  double cutting_force; /*  88 N, that the layer resists with */
  double depth;         /*  96 m along the needle's line from the skin */
  uint32_t status;      /* 104 bits, 0: all well */
  uint32_t contact;     /* 108 0 away 1 touching 2 punctured 3 inserting 4 stopped 5 withdrawing
                               6 reinserting 7 bone */
  uint32_t layer;       /* 112 index of the region at the tip, 0: outside */
  uint32_t reserved;    /* 116 zero */
  char layer_name[40];  /* 120 its name, zero-terminated */
} artus_shm_force;      /* 160 */

/* IMAGE: the newest B-mode frame, written by artus. */
typedef struct artus_shm_image {
  uint64_t frame;                         /*  0 grows by one with every frame */
  uint64_t time_ns;                       /*  8 CLOCK_MONOTONIC when it was ready */
  uint64_t pos_time_ns;                   /* 16 of the pose that it shows */
  double pixel;                           /* 24 m, square */
  uint32_t width;                         /* 32 pixels */
  uint32_t height;                        /* 36 pixels */
  uint64_t reserved[3];                   /* 40 zero */
  uint8_t grey[ARTUS_SHM_IMAGE_CAPACITY]; /* 64 (height, width), x fastest */
} artus_shm_image;

/* One mapped segment; `beat` and `seen_ns` remember when its heartbeat last changed. */
typedef struct artus_shm_segment {
  artus_shm_header* header;
  int file;
  uint64_t beat;
  uint64_t seen_ns;
} artus_shm_segment;

typedef struct artus_shm_link {
  artus_shm_segment pos;
  artus_shm_segment force;
  char prefix[64];
  uint64_t reopened_ns;
  const char* refusal; /* what could not be opened, for a message; errno says why */
} artus_shm_link;

static inline uint64_t artus_shm_now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000ull + (uint64_t)now.tv_nsec;
}

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
  if (segment->header) munmap(segment->header, segment->header->size);
  if (segment->file >= 0) close(segment->file);
  segment->header = 0;
  segment->file = -1;
}

/* Opens the named segment or makes an empty one; -1 and errno when it cannot be used: EPROTO (it is
 * not one of this version), EPERM (others may touch it), EBUSY (`write`: it has a writer). */
static inline int artus_shm_map(artus_shm_segment* segment, const char* name, uint64_t magic,
                                size_t payload, int write) {
  const size_t size = sizeof(artus_shm_header) + payload;
  struct stat st;
  artus_shm_header* h;
  memset(segment, 0, sizeof *segment);
  segment->file = shm_open(name, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (segment->file < 0) return -1;
  if (write && flock(segment->file, LOCK_EX | LOCK_NB) != 0) { /* the kernel drops it at a crash */
    close(segment->file);
    segment->file = -1;
    errno = EBUSY;
    return -1;
  }
  if (fstat(segment->file, &st) != 0) goto failed;
  if (st.st_uid != geteuid() || (st.st_mode & 077) != 0) {
    errno = EPERM;
    goto failed;
  }
  if (st.st_size == 0) {
    if (ftruncate(segment->file, (off_t)size) != 0) goto failed;
  } else if (st.st_size != (off_t)size) {
    errno = EPROTO;
    goto failed;
  }
  h = (artus_shm_header*)mmap(0, size, PROT_READ | PROT_WRITE, MAP_SHARED, segment->file, 0);
  if (h == MAP_FAILED) goto failed;
  if (h->magic == 0) { /* fresh; two that start at once write the same here */
    h->version = ARTUS_SHM_VERSION;
    h->size = (uint32_t)size;
    h->payload = (uint32_t)payload;
    __atomic_store_n(&h->magic, magic, __ATOMIC_RELEASE);
  }
  if (h->magic != magic || h->version != ARTUS_SHM_VERSION || h->size != size ||
      h->payload != payload) {
    munmap(h, size);
    errno = EPROTO;
    goto failed;
  }
  if (write) __atomic_store_n(&h->writer_pid, (uint64_t)getpid(), __ATOMIC_RELEASE);
  segment->beat =
      __atomic_load_n(&h->heartbeat, __ATOMIC_ACQUIRE); /* what was left behind is old */
  segment->header = h;
  return 0;
failed : {
  const int why = errno;
  close(segment->file);
  segment->file = -1;
  errno = why;
  return -1;
}
}

static inline int artus_shm_map_named(artus_shm_link* link, artus_shm_segment* segment,
                                      const char* what, uint64_t magic, size_t payload, int write) {
  char name[96];
  snprintf(name, sizeof name, "/%s%s", link->prefix, what);
  if (artus_shm_map(segment, name, magic, payload, write) == 0) return 0;
  link->refusal = what;
  return -1;
}

/* Opens POS for writing and FORCE for reading; either side may start first. `prefix` stands before
 * the names POS and FORCE, "" for the usual ones. 0, or -1 with errno and link->refusal. */
static inline int artus_shm_open(artus_shm_link* link, const char* prefix) {
  memset(link, 0, sizeof *link);
  link->force.file = -1;
  if (strlen(prefix) >= sizeof link->prefix) {
    link->refusal = prefix;
    errno = ENAMETOOLONG;
    return -1;
  }
  memcpy(link->prefix, prefix, strlen(prefix) + 1);
  if (artus_shm_map_named(link, &link->pos, "POS", ARTUS_SHM_MAGIC_POS, sizeof(artus_shm_pos), 1) !=
      0)
    return -1;
  if (artus_shm_map_named(link, &link->force, "FORCE", ARTUS_SHM_MAGIC_FORCE,
                          sizeof(artus_shm_force), 0) != 0) {
    artus_shm_unmap(&link->pos);
    return -1;
  }
  return 0;
}

static inline void artus_shm_close(artus_shm_link* link) {
  if (link->pos.header) __atomic_store_n(&link->pos.header->writer_pid, 0, __ATOMIC_RELEASE);
  artus_shm_unmap(&link->pos);
  artus_shm_unmap(&link->force);
}

/* Nothing is held, rotations are the identity, the time is now. */
static inline artus_shm_pos artus_shm_pos_init(void) {
  artus_shm_pos pos;
  memset(&pos, 0, sizeof pos);
  pos.time_ns = artus_shm_now_ns();
  pos.needle_rotation[0] = 1;
  pos.probe_rotation[0] = 1;
  return pos;
}

static inline void artus_shm_write_pos(artus_shm_link* link, const artus_shm_pos* pos) {
  artus_shm_store(link->pos.header, pos, sizeof *pos);
}

/* The newest force; zero with ARTUS_SHM_SILENT when FORCE did not change for 20 ms. Then also
 * looks, at most every 100 ms, whether a restarted artus made new segments. 1: fresh, 0: silent. */
static inline int artus_shm_read_force(artus_shm_link* link, artus_shm_force* force) {
  const uint64_t now = artus_shm_now_ns();
  artus_shm_segment* s = &link->force;
  const uint64_t beat = __atomic_load_n(&s->header->heartbeat, __ATOMIC_ACQUIRE);
  const int whole = artus_shm_load(s->header, force, sizeof *force);
  if (beat != s->beat) {
    s->beat = beat;
    s->seen_ns = now;
  }
  if (whole && s->seen_ns != 0 && now - s->seen_ns < ARTUS_SHM_STALE_NS &&
      now - force->time_ns < ARTUS_SHM_STALE_NS)
    return 1;
  memset(force, 0, sizeof *force);
  force->status = ARTUS_SHM_SILENT;
  if (now - link->reopened_ns > 100000000ull && now - s->seen_ns > 100000000ull) {
    artus_shm_link fresh;
    link->reopened_ns = now;
    flock(link->pos.file, LOCK_UN);
    if (artus_shm_open(&fresh, link->prefix) == 0) {
      artus_shm_unmap(&link->pos);
      artus_shm_unmap(&link->force);
      fresh.reopened_ns = now;
      *link = fresh;
    } else {
      flock(link->pos.file, LOCK_EX | LOCK_NB);
    }
  }
  return 0;
}
#endif /* ARTUS_SHM_H */
