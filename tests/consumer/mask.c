/* A consumer in C: a triangle hangs above the right half of a floor, and what must be in its shadow is known. */
#include <tenebra/tenebra.h>

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void expect(int holds, const char* what) {
  if (holds) return;
  fprintf(stderr, "mask.c: expected %s\n", what);
  ++failures;
}

static int stop_at_once(void* user, double done) {
  *(double*)user = done;
  return 1;
}

static const float positions[] = {-9, 0, 9, 9, 0, 9, 9, 0, -9, -9, 0, -9, 0, 1, 9, 9, 1, 0, 0, 1, -9};
static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 4, 5, 6};
static const double at[] = {-1, 0, 0, 1, 0, 0};
static const uint32_t on[] = {1, 1};

static void ask(tenebra_tracer* tracer, const tenebra_geometry* geometry) {
  tenebra_points points = TENEBRA_POINTS_INIT;
  points.count = 2, points.positions = at, points.triangles = on;
  tenebra_light light = TENEBRA_LIGHT_INIT;
  light.position[1] = 5;
  uint8_t mask[2] = {7, 7};
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, NULL, mask) == TENEBRA_OK, "a mask");
  expect(mask[0] == 255 && mask[1] == 0, "the left point lit and the right one in shadow");
  tenebra_options too_many = TENEBRA_OPTIONS_INIT;
  too_many.threads = 1 << 24;
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, &too_many, mask) == TENEBRA_FAILED &&
             strstr(tenebra_tracer_error(tracer), "expected 1 to 1024") != NULL,
         "a sentence on the number of threads");

  const float square[] = {-1, 4, -1, 1, 4, -1, 1, 4, 1, -1, 4, 1};
  tenebra_area_light area = TENEBRA_AREA_LIGHT_INIT;
  area.vertices = square, area.vertex_count = 4;
  float fraction[2];
  expect(tenebra_soft_visibility(tracer, geometry, &points, &area, NULL, fraction, NULL) == TENEBRA_OK,
         "fractions");
  expect(fraction[0] == 1 && fraction[1] == 0, "all of the light at the left and none at the right");

  const double below_its_edge[] = {0, 0, 0};
  tenebra_points half = TENEBRA_POINTS_INIT;
  half.count = 1, half.positions = below_its_edge, half.triangles = on;
  tenebra_options bounded = TENEBRA_OPTIONS_INIT;
  bounded.soft_memory_bytes = 1;
  expect(tenebra_soft_visibility(tracer, geometry, &half, &area, &bounded, fraction, NULL) == TENEBRA_FAILED &&
             strstr(tenebra_tracer_error(tracer), "not enough memory for soft shadows") != NULL,
         "a sentence on a bound of one byte");
  bounded.struct_size = offsetof(tenebra_options, soft_memory_bytes);
  expect(tenebra_soft_visibility(tracer, geometry, &half, &area, &bounded, fraction, NULL) == TENEBRA_OK &&
             fabs(fraction[0] - 0.5) < 1e-4,
         "no bound from a caller who does not know of it");

  float open[2];
  tenebra_options options = TENEBRA_OPTIONS_INIT;
  options.ao_error = 0.5, options.ao_distance_m = 2;
  expect(tenebra_ambient_occlusion(tracer, geometry, &points, &options, open) == TENEBRA_OK, "occlusion");
  expect(fabs(open[1] - 0.75) < 0.1 && open[0] > open[1], "less open below the triangle");

  double done = 0;
  options.progress = stop_at_once, options.user = &done;
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, &options, mask) == TENEBRA_STOPPED && done == 1,
         "a stop that the progress function asked for");
  tenebra_tracer_stop(tracer);
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, NULL, mask) == TENEBRA_STOPPED, "a stop");
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, NULL, mask) == TENEBRA_OK, "no stop again");

  points.struct_size = 3;
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, NULL, mask) == TENEBRA_FAILED &&
             strstr(tenebra_tracer_error(tracer), "struct_size is 3") != NULL,
         "a sentence on struct_size");
}

/* The same scene in map coordinates: an offset is subtracted before anything becomes a float. */
static void ask_far_away(tenebra_tracer* tracer) {
  const double east = 691234.127, north = 5334567.381;
  double far_positions[21], far_at[6];
  for (int i = 0; i < 21; ++i) far_positions[i] = positions[i] + (i % 3 == 0 ? east : i % 3 == 2 ? north : 0);
  for (int i = 0; i < 6; ++i) far_at[i] = at[i] + (i % 3 == 0 ? east : i % 3 == 2 ? north : 0);
  tenebra_geometry* geometry = tenebra_geometry_create();
  expect(tenebra_geometry_set_doubles(geometry, far_positions, 7, triangles, 3, NULL) == TENEBRA_OK,
         "a geometry from doubles");
  tenebra_points points = TENEBRA_POINTS_INIT;
  points.count = 2, points.positions = far_at, points.triangles = on;
  const double lamp[3] = {east, 5, north};
  tenebra_light light = TENEBRA_LIGHT_INIT;
  light.position_doubles = lamp;
  uint8_t mask[2] = {7, 7};
  expect(tenebra_hard_mask(tracer, geometry, &points, &light, NULL, mask) == TENEBRA_OK && mask[0] == 255 &&
             mask[1] == 0,
         "the left point lit and the right one in shadow, far away");
  tenebra_area_light sun = TENEBRA_AREA_LIGHT_INIT;
  sun.sun_diameter_deg = 0.53;
  float fraction[2] = {7, 7};
  expect(tenebra_soft_visibility(tracer, geometry, &points, &sun, NULL, fraction, NULL) == TENEBRA_OK &&
             fraction[0] == 1 && fraction[1] == 0,
         "a sun at the left and none at the right");
  expect(tenebra_geometry_move_doubles(geometry, far_positions, 7) == TENEBRA_OK, "moved vertices");
  tenebra_geometry_destroy(geometry);
}

int main(void) {
  expect(tenebra_abi_version() == TENEBRA_ABI_VERSION, "the library of this header");
  tenebra_geometry* geometry = tenebra_geometry_create();
  tenebra_tracer* tracer = tenebra_tracer_create();
  expect(geometry != NULL && tracer != NULL, "handles");
  expect(tenebra_hard_mask(tracer, geometry, NULL, NULL, NULL, NULL) == TENEBRA_FAILED, "no geometry yet");
  expect(tenebra_geometry_set(geometry, positions, 6, triangles, 3, NULL) == TENEBRA_FAILED &&
             strcmp(tenebra_geometry_error(geometry),
                    "geometry: triangle 2 has the vertices 4, 5 and 6, expected numbers below 6") == 0,
         "a sentence on the missing vertex");
  expect(tenebra_geometry_set(geometry, positions, 7, triangles, 3, NULL) == TENEBRA_OK, "a geometry");
  ask(tracer, geometry);
  ask_far_away(tracer);
  expect(tenebra_geometry_move(geometry, positions, 7) == TENEBRA_OK, "moved vertices");
  expect(tenebra_geometry_move(geometry, positions, 6) == TENEBRA_FAILED, "as many vertices as before");
  tenebra_tracer_destroy(tracer);
  tenebra_geometry_destroy(geometry);
  return failures != 0;
}
