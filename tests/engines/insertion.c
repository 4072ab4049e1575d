/* SPDX-License-Identifier: AGPL-3.0-or-later
 * The C interface from C alone: a needle goes in along the first plan. insertion JOINT [rigid] */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "artus.h"

static int failed(const char* what) {
  fprintf(stderr, "%s: %s\n", what, artus_last_error());
  return 1;
}

/* Rotation from z to `way`, w x y z. */
static void along(const double way[3], double q[4]) {
  const double norm = sqrt(2 + 2 * way[2]);
  q[0] = (1 + way[2]) / norm;
  q[1] = -way[1] / norm;
  q[2] = way[0] / norm;
  q[3] = 0;
}

int main(int argc, char** argv) {
  artus_options options;
  artus_simulation* sim;
  artus_felt felt;
  artus_image image;
  double entry[3], target[3], probe[7], needle[7], way[3], length = 0, most = 0;
  uint32_t vertices, triangles, i, images = 0;
  int tick, k;
  if (argc < 2 || artus_api_version() != ARTUS_API_VERSION) return 2;
  artus_default_options(&options);
  options.rigid = 1;
  if (artus_open("no such file", &options) != 0 || strlen(artus_last_error()) == 0) return 3;
  options.device = "nonsense";
  if (artus_open(argv[1], &options) != 0) return 3;
  options.device = "touch";
  options.version = 99;
  if (artus_open(argv[1], &options) != 0) return 3;
  options.version = ARTUS_API_VERSION;
  sim = artus_open(argv[1], &options);
  if (!sim) return failed("open");
  if (artus_is_soft(sim) || artus_render(sim, &image) == 0) return 4;
  if (artus_plan(sim, 0, entry, target) != 0 || artus_default_probe(sim, probe) != 0)
    return failed("plan");
  if (artus_plan(sim, artus_plan_count(sim), entry, target) == 0) return 5;
  if (artus_mesh_size(sim, &vertices, &triangles) != 0) return failed("mesh");
  {
    float* v = malloc(sizeof(float) * 3 * vertices);
    uint32_t* t = malloc(sizeof(uint32_t) * 3 * triangles);
    uint32_t* r = malloc(sizeof(uint32_t) * 2 * triangles);
    if (!v || !t || !r || artus_mesh(sim, v, t, r) != 0) return failed("mesh");
    for (i = 0; i < 3 * triangles; ++i)
      if (t[i] >= vertices) return 6;
    for (i = 0; i < 2 * triangles; ++i)
      if (r[i] >= artus_region_count(sim)) return 6;
    free(v), free(t), free(r);
  }
  for (k = 0; k < 3; ++k) length += (target[k] - entry[k]) * (target[k] - entry[k]);
  length = sqrt(length);
  for (k = 0; k < 3; ++k) way[k] = (target[k] - entry[k]) / length;
  along(way, needle + 3);
  for (tick = 0; tick < 1000; ++tick) {
    const double depth = -0.005 + 0.02 * tick * 1e-3;
    for (k = 0; k < 3; ++k) needle[k] = entry[k] + depth * way[k];
    if (artus_step(sim, needle, probe, 0, &felt) != 0) return failed("step");
    images += felt.image_due;
    most = fmax(most, -(felt.force[0] * way[0] + felt.force[1] * way[1] + felt.force[2] * way[2]));
  }
  if (artus_render(sim, &image) != 0) return failed("render");
  needle[3] = NAN;
  if (artus_step(sim, needle, probe, 0, &felt) == 0) return 7;
  if (artus_set_image(sim, 9, 0) == 0 || artus_set_image(sim, 0.05, 3) != 0) return 8;
  printf("%.6f N, %.3f mm deep in %s, %u images of %u x %u, %.3f s, %s\n", most, 1e3 * felt.depth,
         artus_region_name(sim, felt.region), images, image.width, image.height, artus_time(sim),
         artus_version());
  if (artus_ticks(sim) != 1000 || most < 0.05 || images < 28 || felt.region == 0) return 9;
  artus_free(sim);
  artus_free(0);
  return 0;
}
