/* SPDX-License-Identifier: AGPL-3.0-or-later
 * A device program in some 40 lines: pushes the needle 30 mm into the body at 10 mm/s, holds,
 * withdraws, and says what it felt. Usage: example_device [prefix] [x y z of the skin entry, m]
 * [direction x y z, unit] */
/* clang-format off: first, because it asks the system's headers for clocks and shared memory */
#include "artus_shm.h"
/* clang-format on */
#include <math.h>
#include <sched.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  double line[6] = {0, 0, 0, 0, 0, 1}; /* skin entry and direction */
  for (int i = 0; i < 6 && i + 2 < argc; ++i) line[i] = atof(argv[i + 2]);
  artus_shm_link link;
  if (artus_shm_open(&link, argc > 1 ? argv[1] : "") != 0) {
    perror(link.refusal);
    return 1;
  }
  const struct sched_param urgent = {.sched_priority =
                                         70}; /* a busy system must not make it late */
  sched_setscheduler(0, SCHED_FIFO, &urgent);
  double peak = 0, round_trip = 0;
  long answered = 0, layers = 0;
  unsigned last_layer = 0;
  unsigned long long last_answer = 0;
  struct timespec next;
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (int tick = 0; tick < 8000; ++tick) { /* 8 s at 1 kHz */
    const double t = tick * 1e-3;
    const double depth = t < 4 ? 0.010 * t - 0.010 : t < 5 ? 0.030 : 0.030 - 0.0133 * (t - 5);
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = (uint64_t)tick + 1;
    pos.present = ARTUS_SHM_NEEDLE;
    for (int i = 0; i < 3; ++i) pos.needle_position[i] = line[i] + depth * line[i + 3];
    const double norm = sqrt(2 + 2 * line[5]); /* the turn from z to the direction */
    pos.needle_rotation[0] = (1 + line[5]) / norm;
    pos.needle_rotation[1] = -line[4] / norm;
    pos.needle_rotation[2] = line[3] / norm;
    artus_shm_write_pos(&link, &pos);
    artus_shm_force force;
    if (artus_shm_read_force(&link, &force) && force.pos_sample > last_answer) {
      last_answer = force.pos_sample; /* a real device sends force.force to its motors here */
      peak = fmax(
          peak, -(force.force[0] * line[3] + force.force[1] * line[4] + force.force[2] * line[5]));
      round_trip += (double)(artus_shm_now_ns() - force.pos_time_ns) * 1e-6;
      ++answered;
      if (force.layer != last_layer) printf("%6.2f mm  %s\n", 1e3 * force.depth, force.layer_name);
      layers += force.layer != last_layer;
      last_layer = force.layer;
    }
    next.tv_nsec += 1000000;
    if (next.tv_nsec >= 1000000000) next.tv_nsec -= 1000000000, ++next.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, 0);
  }
  printf("%ld ticks answered, %ld layer changes, peak %.2f N, mean round trip %.3f ms\n", answered,
         layers, peak, answered ? round_trip / (double)answered : 0);
  artus_shm_close(&link);
  return answered > 0 ? 0 : 1;
}
