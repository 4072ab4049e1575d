/* SPDX-License-Identifier: AGPL-3.0-or-later
 * A device program in 40 lines: pushes the needle 30 mm into the body at 10 mm/s, holds, withdraws,
 * and says what it felt. Usage: example_device [prefix] [entry x y z, m] [direction x y z, unit] */
/* clang-format off: first, because it asks the system's headers for clocks and shared memory */
#include "artus_shm.h"
/* clang-format on */
#include <math.h>
#include <sched.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  double line[6] = {0, 0, 0, 0, 0, 1}, peak = 0, sum = 0, worst = 0; /* entry and direction */
  long answered = 0, last_layer = 0, last_answer = 0;
  artus_shm_link link;
  artus_shm_force force;
  struct timespec next;
  const struct sched_param urgent = {.sched_priority = 70};
  for (int i = 0; i < 6 && i + 2 < argc; ++i) line[i] = atof(argv[i + 2]);
  if (artus_shm_open(&link, argc > 1 ? argv[1] : "") != 0) return perror(link.refusal), 1;
  sched_setscheduler(0, SCHED_FIFO, &urgent); /* a busy system must not make it late */
  clock_gettime(CLOCK_MONOTONIC, &next);
  for (int tick = 0; tick < 8000; ++tick) { /* 8 s at 1 kHz */
    const double t = tick * 1e-3, norm = sqrt(2 + 2 * line[5]);
    const double depth = t < 4 ? 0.010 * t - 0.010 : t < 5 ? 0.030 : 0.030 - 0.0133 * (t - 5);
    artus_shm_pos pos = artus_shm_pos_init();
    pos.sample = (uint64_t)tick + 1;
    pos.present = ARTUS_SHM_NEEDLE;
    for (int i = 0; i < 3; ++i) pos.needle_position[i] = line[i] + depth * line[i + 3];
    pos.needle_rotation[0] = (1 + line[5]) / norm; /* the turn from z to the direction */
    pos.needle_rotation[1] = -line[4] / norm;
    pos.needle_rotation[2] = line[3] / norm;
    artus_shm_write_pos(&link, &pos);
    if (artus_shm_read_force(&link, &force) && (long)force.pos_sample > last_answer) {
      const double* f = force.force; /* a real device sends it to its motors here */
      const double trip = (double)(artus_shm_now_ns() - force.pos_time_ns) * 1e-6;
      peak = fmax(peak, -(f[0] * line[3] + f[1] * line[4] + f[2] * line[5]));
      sum += trip, worst = fmax(worst, trip), ++answered;
      last_answer = (long)force.pos_sample;
      if (force.layer != last_layer) printf("%6.2f mm  %s\n", 1e3 * force.depth, force.layer_name);
      last_layer = force.layer;
    }
    next.tv_nsec += 1000000;
    if (next.tv_nsec >= 1000000000) next.tv_nsec -= 1000000000, ++next.tv_sec;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &next, 0);
  }
  printf("%ld ticks answered, peak %.2f N, round trip mean %.3f ms, longest %.3f ms\n", answered,
         peak, answered ? sum / (double)answered : 0, worst);
  return artus_shm_close(&link), answered == 0;
}
