/* SPDX-License-Identifier: AGPL-3.0-or-later
 *
 * artus as a shared library with a C interface, for engines and languages that load one: Unity,
 * Unreal, Godot, ctypes. One body, both hands, forces and B-mode pictures; no clock, no thread of
 * its own that a result hangs on: who calls artus_step 1000 times a second has a haptic loop.
 *
 * Frames: the joint's, LPS, metres. A pose is 7 numbers: x y z, then the quaternion w x y z.
 * Needle: origin at the tip, z from hub to tip. Probe: origin on its face, x along it, z into the
 * body. Threads: one simulation is used by one thread at a time; several may be used at once. A
 * function that returns int gives 0, or -1 and artus_last_error() of the calling thread says what,
 * where and what to do. No function throws or ends the process. Pointers that are returned belong
 * to the simulation and are good until it is freed, or until the call that the function names.
 */
#ifndef ARTUS_H
#define ARTUS_H
#include <stdint.h>

#if defined(_WIN32)
#define ARTUS_API
#else
#define ARTUS_API __attribute__((visibility("default")))
#endif
#ifdef __cplusplus
extern "C" {
#endif

/* Grows when a program that was built with an older header would be wrong. */
#define ARTUS_API_VERSION 1

typedef struct artus_simulation artus_simulation;

/* What a simulation is made with. artus_default_options() fills it. */
typedef struct artus_options {
  uint32_t version;       /* ARTUS_API_VERSION */
  uint32_t rigid;         /* 1: tissue does not give way, which opens at once */
  double haptic_rate;     /* steps a second, 100 to 20000 */
  double image_rate;      /* pictures a second */
  const char* device;     /* touch, virtuose_6d_desktop, delta, ideal: the limits of forces */
  const char* transducer; /* linear-6-18 and others of devices/transducers */
} artus_options;

/* What the hands feel of a step. */
typedef struct artus_felt {
  double force[3];        /* N on the needle's hand */
  double torque[3];       /* N m */
  double probe_force[3];  /* N on the probe's hand, at the face's centre */
  double probe_torque[3]; /* N m */
  double thumb_force;     /* N, out of the barrel */
  double depth;           /* m of the tip below the skin */
  double given;           /* m3 that left the tip */
  uint32_t region;        /* at the tip; 0: outside; artus_region_name */
  uint32_t status;        /* bits of docs/protocol.md, 0: all well */
  uint32_t image_due;     /* 1: artus_render shows this instant */
  uint32_t reserved;      /* 0 */
} artus_felt;

/* A B-mode picture. */
typedef struct artus_image {
  const uint8_t* grey; /* (height, width), x fastest; good until the next artus_render */
  uint32_t width;      /* pixels */
  uint32_t height;     /* pixels */
  double pixel;        /* m, square */
} artus_image;

/* ARTUS_API_VERSION of the library: ask before anything else. */
ARTUS_API uint32_t artus_api_version(void);
/* "0.2.0", of the program. */
ARTUS_API const char* artus_version(void);
/* Of the calling thread's last failure; empty: there was none. Good until its next call. */
ARTUS_API const char* artus_last_error(void);

/* The usual choices. */
ARTUS_API void artus_default_options(artus_options* options);
/* Opens a compiled joint (.artus, made by artus compile). NULL options: the usual ones. NULL when
 * it fails. Cost: some seconds when tissue gives way, most of them in the first step. */
ARTUS_API artus_simulation* artus_open(const char* file, const artus_options* options);
/* Frees it; NULL is nothing. */
ARTUS_API void artus_free(artus_simulation* simulation);

/* Whether its tissue gives way: 1, or 0. */
ARTUS_API int artus_is_soft(const artus_simulation* simulation);
/* Steps done, and the time of the last one, s. */
ARTUS_API uint64_t artus_ticks(const artus_simulation* simulation);
ARTUS_API double artus_time(const artus_simulation* simulation);
/* Regions of the body, 0 is outside, and their names; NULL beyond the last. */
ARTUS_API uint32_t artus_region_count(const artus_simulation* simulation);
ARTUS_API const char* artus_region_name(const artus_simulation* simulation, uint32_t region);
/* Where the probe stands by default. */
ARTUS_API int artus_default_probe(const artus_simulation* simulation, double pose[7]);
/* Planned injections: number, name (NULL beyond the last), entry and target. */
ARTUS_API uint32_t artus_plan_count(const artus_simulation* simulation);
ARTUS_API const char* artus_plan_name(const artus_simulation* simulation, uint32_t plan);
ARTUS_API int artus_plan(const artus_simulation* simulation, uint32_t plan, double entry[3],
                         double target[3]);

/* The surface between regions at rest, as triangles, for an engine to draw: numbers of vertices and
 * triangles, then copies, 3 floats a vertex and 3 indices a triangle; `regions`, two a triangle (in
 * front, behind), may be NULL. */
ARTUS_API int artus_mesh_size(const artus_simulation* simulation, uint32_t* vertices,
                              uint32_t* triangles);
ARTUS_API int artus_mesh(const artus_simulation* simulation, float* vertices, uint32_t* triangles,
                         uint32_t* regions);

/* One tick. `needle` or `probe` NULL: put down. `thumb`: N on the plunger, positive in. Poses must
 * be finite, with a quaternion whose norm is 0.9 to 1.1. */
ARTUS_API int artus_step(artus_simulation* simulation, const double* needle, const double* probe,
                         double thumb, artus_felt* felt);
/* The picture of the newest image that was due. -1 before the first. Cost: an image, some 10 ms. */
ARTUS_API int artus_render(artus_simulation* simulation, artus_image* image);
/* Depth of later pictures, m (0.01 to 0.2), and gain, dB (-40 to 60). */
ARTUS_API int artus_set_image(artus_simulation* simulation, double depth, double gain_db);

#ifdef __cplusplus
}
#endif
#endif /* ARTUS_H */
