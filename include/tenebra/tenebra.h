/** \file
 * The C interface: hard masks, soft shadows and ambient occlusion for points and triangles of your own, as
 * in the C++ header queries.h, which says more about each. No exception leaves a call. Lengths are metres, in
 * world space; arrays are the caller's, read or written during the call only.
 *
 * Within one TENEBRA_ABI_VERSION functions and members of structures are only added, members at the end:
 * struct_size tells which members the caller knows. Initialise structures with the macros below. */
#ifndef TENEBRA_TENEBRA_H
#define TENEBRA_TENEBRA_H

/* C, also where C++ reads it. NOLINTBEGIN(modernize-use-using,modernize-deprecated-headers) */
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The version of this header. */
#define TENEBRA_ABI_VERSION 1
/** The triangle of a point that lies on none. */
#define TENEBRA_NO_TRIANGLE 0xffffffffu

/** The version of the loaded library; it has to equal the TENEBRA_ABI_VERSION that the caller was compiled
 * with.
 */
int tenebra_abi_version(void);

/** How a call ended. */
typedef enum tenebra_status {
  TENEBRA_OK = 0,     /**< the answers are complete */
  TENEBRA_FAILED = 1, /**< the handle's error says why; answers are unspecified */
  TENEBRA_STOPPED = 2 /**< tenebra_tracer_stop or the progress function asked for it; answers unspecified */
} tenebra_status;

/** Triangles. Any number of tracers may use one at once; set and move them while none does. */
typedef struct tenebra_geometry tenebra_geometry;
/** Answers questions about points; keeps its buffers from call to call. One caller at a time. */
typedef struct tenebra_tracer tenebra_tracer;

/** Null if there is no memory. Destroying null does nothing. */
tenebra_geometry* tenebra_geometry_create(void);
/** For a geometry that no tracer is using. */
void tenebra_geometry_destroy(tenebra_geometry* geometry);
/** One sentence: what the last failed call with this handle found and expected; "" before the first failure.
 * Valid until the next call with the handle. */
const char* tenebra_geometry_error(const tenebra_geometry* geometry);

/** positions: x, y, z of each vertex. triangles: three vertices each, counter-clockwise seen from the front;
 * a triangle's number is its place. casts_shadow: 0 or 1 for each triangle, or null: all cast. */
tenebra_status tenebra_geometry_set(tenebra_geometry* geometry, const float* positions, size_t vertex_count,
                                    const uint32_t* triangles, size_t triangle_count,
                                    const uint8_t* casts_shadow);
/** The same triangles with other vertices, as many as before. */
tenebra_status tenebra_geometry_move(tenebra_geometry* geometry, const float* positions, size_t vertex_count);
/** Like tenebra_geometry_set and tenebra_geometry_move, from doubles, in map coordinates for instance: an
 * offset of whole numbers is subtracted from these, from points and from lights before they become floats. */
tenebra_status tenebra_geometry_set_doubles(tenebra_geometry* geometry, const double* positions,
                                            size_t vertex_count, const uint32_t* triangles,
                                            size_t triangle_count, const uint8_t* casts_shadow);
tenebra_status tenebra_geometry_move_doubles(tenebra_geometry* geometry, const double* positions,
                                             size_t vertex_count);

/** Null if there is no memory. */
tenebra_tracer* tenebra_tracer_create(void);
/** For a tracer with no call in progress; null does nothing. */
void tenebra_tracer_destroy(tenebra_tracer* tracer);
/** Like tenebra_geometry_error. */
const char* tenebra_tracer_error(const tenebra_tracer* tracer);
/** From any thread: the running call, or else the next one, ends with TENEBRA_STOPPED within some ten
 * milliseconds. */
void tenebra_tracer_stop(tenebra_tracer* tracer);

/** Points to ask about: see QueryPoints of queries.h. All but positions may be null. */
typedef struct tenebra_points {
  size_t struct_size;        /**< sizeof(tenebra_points) */
  size_t count;              /**< how many points */
  const double* positions;   /**< x, y, z of each */
  const uint32_t* triangles; /**< the triangle that each lies on, or TENEBRA_NO_TRIANGLE */
  const float* normals;      /**< x, y, z of each, any length; zero: none */
  const int8_t* sides;       /**< 1 in front of its triangle, -1 behind, 0 not given */
  int32_t width;             /**< a picture with this many columns, row by row; 0: a list */
} tenebra_points;
/** Default values. */
#define TENEBRA_POINTS_INIT \
  { sizeof(tenebra_points), 0, NULL, NULL, NULL, NULL, 0 }

/** A light without an area. */
typedef struct tenebra_light {
  size_t struct_size;   /**< sizeof(tenebra_light) */
  int32_t directional;  /**< 0: a point or a spot at position; else light from to_light */
  float position[3];    /**< point and spot */
  float to_light[3];    /**< directional: towards the light, any length but zero */
  float spot_axis[3];   /**< unit, the way a spot shines */
  float spot_cos_outer; /**< no light outside of this cone; -1: no cone */
  float range_m;        /**< no light farther away; 0: unbounded */
  /** x, y, z of a point or a spot, in place of position; may be null. */
  const double* position_doubles;
} tenebra_light;
/** Default values. */
#define TENEBRA_LIGHT_INIT \
  { sizeof(tenebra_light), 0, {0, 0, 0}, {0, 1, 0}, {0, -1, 0}, -1, 0, NULL }

/** A planar convex polygon that shines to one side; or a sun, which has no place. */
typedef struct tenebra_area_light {
  size_t struct_size;    /**< sizeof(tenebra_area_light) */
  const float* vertices; /**< x, y, z of each, counter-clockwise seen from the lit side */
  size_t vertex_count;   /**< 3 to 14 */
  /** x, y, z of each vertex in place of vertices; may be null. */
  const double* vertices_doubles;
  /** If not 0, a sun this wide in degrees, 1e-6 to 90: a disc at infinity. It has no vertices. */
  double sun_diameter_deg;
  float to_sun[3]; /**< towards the sun, any length but zero */
} tenebra_area_light;
/** Default values. */
#define TENEBRA_AREA_LIGHT_INIT                       \
  {                                                   \
    sizeof(tenebra_area_light), NULL, 0, NULL, 0.0, { \
      0, 1, 0                                         \
    }                                                 \
  }

/** Options of all calls. */
typedef struct tenebra_options {
  size_t struct_size;   /**< sizeof(tenebra_options) */
  int32_t threads;      /**< at most this many, 1 to 1024; 0: all cores. No answer depends on it */
  double soft_error;    /**< allowed in soft shadows, 1/255 of white, RMS over the penumbra; 0: exact */
  double ao_error;      /**< allowed in ambient occlusion, 1/255, RMS over the points; 0.1 to 255 */
  double ao_distance_m; /**< where occlusion has fallen off to nothing; 0: a twentieth of the diagonal */
  /** Called now and then on the caller's thread with the part that is done, 0 to 1; returns 0 to go on. May
   * be null. */
  int (*progress)(void* user, double done);
  void* user; /**< handed to progress */
  /** Bounds the candidates and lists of soft shadows, all threads together; 0: as many as the system has. A
   * call that needs more fails. Answers do not depend on it. */
  uint64_t soft_memory_bytes;
} tenebra_options;
/** Default values. */
#define TENEBRA_OPTIONS_INIT \
  { sizeof(tenebra_options), 0, 0.0, 2.5, 0.0, NULL, NULL, 0 }

/* In all calls, options may be null, which means TENEBRA_OPTIONS_INIT. */

/** mask: for each point 255 if it sees the light, else 0. */
tenebra_status tenebra_hard_mask(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                 const tenebra_points* points, const tenebra_light* light,
                                 const tenebra_options* options, uint8_t* mask);
/** visible_fraction: for each point the visible part of the light, 0 to 1. irradiance: W/m2 for a light of
 * radiance 1. One of the two may be null. */
tenebra_status tenebra_soft_visibility(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                       const tenebra_points* points, const tenebra_area_light* light,
                                       const tenebra_options* options, float* visible_fraction,
                                       float* irradiance);
/** openness: for each point, 1 open to 0 closed. Points need a triangle or a normal. */
tenebra_status tenebra_ambient_occlusion(tenebra_tracer* tracer, const tenebra_geometry* geometry,
                                         const tenebra_points* points, const tenebra_options* options,
                                         float* openness);

#ifdef __cplusplus
}
#endif
/* NOLINTEND(modernize-use-using,modernize-deprecated-headers) */

#endif
