/* SPDX-License-Identifier: AGPL-3.0-or-later
 *
 * Every byte of artus' shared memory POS, POS-PROBE, FORCE and IMAGE (docs/protocol.md), and what
 * may stand in them, for C11 and C++. */
#ifndef ARTUS_SHM_LAYOUT_H
#define ARTUS_SHM_LAYOUT_H
#ifndef _GNU_SOURCE
#define _GNU_SOURCE 1 /* of clock_gettime */
#endif
#include <stdint.h>
#include <string.h>
#include <time.h>

#define ARTUS_SHM_VERSION 4u
#define ARTUS_SHM_MAGIC_POS 0x31534f5053545241ull   /* "ARTSPOS1" */
#define ARTUS_SHM_MAGIC_FORCE 0x3143524653545241ull /* "ARTSFRC1" */
#define ARTUS_SHM_MAGIC_IMAGE 0x31474d4953545241ull /* "ARTSIMG1" */
#define ARTUS_SHM_IMAGE_CAPACITY (1024u * 1024u)    /* pixels */
#define ARTUS_SHM_STALE_NS 20000000ull              /* silence after which a peer counts as lost */
#define ARTUS_SHM_MAX_PREFIX 63                     /* characters */
#define ARTUS_SHM_MAX_HOLD_MS 100u                  /* the longest that a pose is held */
#define ARTUS_SHM_MAX_FORCE 100.0                   /* N; no force of artus' is above it */
#define ARTUS_SHM_MAX_TORQUE 10.0                   /* N m */

/* The first 64 bytes of every segment. All numbers are little-endian. */
typedef struct artus_shm_header {
  uint64_t magic;      /*  0 which segment, ARTUS_SHM_MAGIC_... */
  uint32_t version;    /*  8 ARTUS_SHM_VERSION */
  uint32_t size;       /* 12 bytes of the whole segment */
  uint32_t payload;    /* 16 bytes of the payload, which begins at byte 64 */
  uint32_t reserved;   /* 20 zero */
  uint64_t writer_pid; /* 24 process that writes; 0: none, or it left in good order */
  uint64_t heartbeat;  /* 32 grows while the writer lives */
  uint64_t opened_ns;  /* 40 CLOCK_MONOTONIC when that writer opened it; 0: it does not say */
  uint64_t reserved2;  /* 48 zero */
  uint64_t sequence;   /* 56 odd while the payload is being written */
} artus_shm_header;

/* artus_shm_pos.present; of the two of a plunger only one. */
enum {
  ARTUS_SHM_NEEDLE = 1u,
  ARTUS_SHM_PROBE = 2u,
  ARTUS_SHM_PLUNGER_TRAVEL = 4u,
  ARTUS_SHM_PLUNGER_FORCE = 8u
};

/* Which hand a device program holds: its segment, and what it may say is present there. */
enum {
  ARTUS_SHM_ROLE_ALL = 0,  /* POS: needle and plunger, and the probe while nobody has POS-PROBE */
  ARTUS_SHM_ROLE_PROBE = 1 /* POS-PROBE: the probe alone */
};

/* POS and POS-PROBE: where needle and probe are, written by a device program. World frame W,
 * metres. Needle: origin at the tip, z from hub to tip. Probe: origin at the footprint's centre, x
 * along the scanlines' row, z into the body. Quaternions w, x, y, z. */
typedef struct artus_shm_pos {
  uint64_t sample;           /*   0 grows with every sample of a writer */
  uint64_t time_ns;          /*   8 CLOCK_MONOTONIC when the pose was measured */
  double needle_position[3]; /*  16 m */
  double needle_rotation[4]; /*  40 */
  double probe_position[3];  /*  72 m */
  double probe_rotation[4];  /*  96 */
  uint32_t buttons;      /* 128 bit 0: choose the entry point and calibrate; 1: back to exploring */
  uint32_t present;      /* 132 ARTUS_SHM_NEEDLE | ARTUS_SHM_PROBE | one of ARTUS_SHM_PLUNGER_... */
  double plunger_travel; /* 136 m, positive in, from where the plunger was when it was new */
  double plunger_force;  /* 144 N of the thumb, positive pushes in */
  uint32_t hold_ms;      /* 152 a slow device: how long its pose is held, 15 to 100 ms; 0: 15 ms */
  uint32_t reserved;     /* 156 zero */
} artus_shm_pos;         /* 160 */

/* artus_shm_force.status: bits 0-10 are those of artus' needle tick (docs/protocol.md). */
enum {
  ARTUS_SHM_PEER_LOST = 1u << 16,   /* POS is silent or was never written */
  ARTUS_SHM_POS_INVALID = 1u << 17, /* POS holds values that are not a pose */
  ARTUS_SHM_PAUSED = 1u << 18,
  ARTUS_SHM_STOPPED = 1u << 19,       /* artus left in good order */
  ARTUS_SHM_SILENT = 1u << 20,        /* set by artus_shm_read_force: FORCE itself is stale */
  ARTUS_SHM_FORCE_INVALID = 1u << 22, /* set by it: FORCE holds what cannot be a force */
  ARTUS_SHM_TISSUE_LATE = 1u << 23    /* the tissue that is felt is older than 0.1 s: skin and
                                         stiffness are held as last known */
};

/* FORCE: what the hand should feel, written by artus. Frame W, at the needle's tip. */
typedef struct artus_shm_force {
  uint64_t tick;         /*   0 artus' haptic tick */
  uint64_t time_ns;      /*   8 CLOCK_MONOTONIC when the force was computed */
  uint64_t pos_sample;   /*  16 artus_shm_pos.sample that it answers */
  uint64_t pos_time_ns;  /*  24 artus_shm_pos.time_ns of that sample */
  double force[3];       /*  32 N */
  double torque[3];      /*  56 N m */
  double stiffness;      /*  80 N/m, of the layer at the tip */
  double cutting_force;  /*  88 N, that the layer resists with */
  double depth;          /*  96 m along the needle's line from the skin */
  uint32_t status;       /* 104 bits, 0: all well */
  uint32_t contact;      /* 108 0 away 1 touching 2 punctured 3 inserting 4 stopped 5 withdrawing
                                6 reinserting 7 bone */
  uint32_t layer;        /* 112 index of the region at the tip, 0: outside */
  uint32_t probe_status; /* 116 the same bits of the probe's force; 4: the probe has no pose */
  char layer_name[40];   /* 120 its name, zero-terminated */
  double
      probe_force[3]; /* 160 N on the probe's hand, at the face's centre; 0 where tissue is rigid */
  double probe_torque[3];  /* 184 N m */
  double probe_share;      /* 208 of the face that presses, 0..1 */
  double thumb_force;      /* 216 N on the thumb, positive out of the barrel */
  double pressure;         /* 224 Pa in the barrel */
  double tip_pressure;     /* 232 Pa of what lies around the bevel */
  double flow;             /* 240 m3/s out of the tip; negative: drawn in */
  double travel;           /* 248 m of the plunger, positive in */
  double given;            /* 256 m3 that left the tip since the syringe was new; never falls */
  double drawn;            /* 264 m3 of the patient's own in the syringe */
  uint32_t plunger_status; /* 272 bits, see docs/protocol.md */
  uint32_t tissue_age_us;  /* 276 how old the tissue is that is felt; 0: none gives way */
  uint64_t probe_sample;   /* 280 sample that the probe's force answers: of POS-PROBE, or of POS */
  uint64_t probe_time_ns;  /* 288 artus_shm_pos.time_ns of that sample */
} artus_shm_force;         /* 296 */

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

static inline uint64_t artus_shm_now_ns(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (uint64_t)now.tv_sec * 1000000000ull + (uint64_t)now.tv_nsec;
}

/* Whether `prefix` may stand before POS, FORCE and IMAGE: at most 63 letters, digits, '-', '_' and
 * '.'. Both sides ask this function. */
static inline int artus_shm_is_prefix(const char* prefix) {
  const size_t length = strlen(prefix);
  const char* allowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_.";
  return length <= ARTUS_SHM_MAX_PREFIX && strspn(prefix, allowed) == length;
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

/* 1: each of `n` numbers is finite and together they are no longer than `most`. */
static inline int artus_shm_is_within(const double* v, int n, double most) {
  double squares = 0;
  int i;
  for (i = 0; i < n; ++i) {
    if (!(v[i] >= -most && v[i] <= most)) return 0; /* also when it is none */
    squares += v[i] * v[i];
  }
  return squares <= most * most;
}

/* Whether a force is one that artus can have written: what scribbled over FORCE is not felt. */
static inline int artus_shm_is_force(const artus_shm_force* f) {
  return artus_shm_is_within(f->force, 3, ARTUS_SHM_MAX_FORCE) &&
         artus_shm_is_within(f->torque, 3, ARTUS_SHM_MAX_TORQUE) &&
         artus_shm_is_within(f->probe_force, 3, ARTUS_SHM_MAX_FORCE) &&
         artus_shm_is_within(f->probe_torque, 3, ARTUS_SHM_MAX_TORQUE) &&
         artus_shm_is_within(&f->thumb_force, 1, ARTUS_SHM_MAX_FORCE);
}
#endif /* ARTUS_SHM_LAYOUT_H */
