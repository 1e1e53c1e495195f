// The seven sides that a descent may have: the faces of a cube about the light, and the distant face.
// Included once per target.
#if defined(TENEBRA_DESCENT_SIDES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef TENEBRA_DESCENT_SIDES_INL_H_
#undef TENEBRA_DESCENT_SIDES_INL_H_
#else
#define TENEBRA_DESCENT_SIDES_INL_H_
#endif

#include <bit>

#include "shadow/tiles/cluster_planes-inl.h"
#include "shadow/tiles/descent.h"
#include "shadow/tiles/distant_tests-inl.h"
#include "shadow/tiles/face_tests-inl.h"
#include "shadow/tiles/tile_bounds-inl.h"
#include "simd/pack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace tenebra::shadow::HWY_NAMESPACE {
using namespace simd::HWY_NAMESPACE;

/// A face of the cube, as a descent asks for it.
class CubeSide {
public:
  static constexpr bool anchored = false;  ///< whether planes through edges have a d
  CubeSide(const RaySource& source, int face)
      : number_(face), face_(face_axes(face)), light_(source.light), origin_(source.origin) {}

  std::uint32_t project(const BoxNode& node, FaceBoxes& out) const {
    return project_boxes(node, light_, face_, out);
  }
  std::uint32_t project(const TriangleCluster& c, const FaceBox& all, FaceBoxes& out) const {
    return project_triangles(c, light_, face_, all, out);
  }
  void place(const ClusterPlanes& planes, float tau, FaceCluster& out) const {
    face_cluster(planes, face_, tau, out);
  }
  bool bound_rays(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                  FaceBox& box) const {
    return bound(tile, base, lanes, origin_, number_, box);
  }

private:
  const int number_;
  const Face face_;
  const glm::vec3 light_;
  const glm::dvec3 origin_;
};

/// The distant face, as a descent asks for it.
class DistantSide {
public:
  static constexpr bool anchored = true;
  explicit DistantSide(const DistantFace& face) : face_(face) {}

  std::uint32_t project(const BoxNode& node, FaceBoxes& out) const { return project_boxes(node, face_, out); }
  std::uint32_t project(const TriangleCluster& c, const FaceBox& all, FaceBoxes& out) const {
    return project_triangles(c, face_, all, out);
  }
  void place(const ClusterPlanes& planes, float tau, FaceCluster& out) const {
    face_cluster(planes, face_, tau, out);
  }
  bool bound_rays(const points::PointTile& tile, const points::PointBase& base, std::uint32_t lanes,
                  FaceBox& box) const {
    bound(tile, base, lanes, face_, box);
    return true;
  }

private:
  const DistantFace face_;
};

/// Which of a cluster's triangles may block rays of a box on one side, and which block all of them, by the
/// tests that a descent makes on its way.
template <class Side>
ClusterVerdict meet_on(const Side& side, const TriangleCluster& cluster, const BoxNode& boxes,
                       const RaySource& source, const FaceBox& rays, float tau) {
  FaceBoxes of_clusters, of_triangles;
  if ((side.project(boxes, of_clusters) & boxes_met(of_clusters, rays) & 1u) == 0) return {0, 0};
  alignas(64) float u0[16], u1[16], v0[16], v1[16], w[16];
  store(of_clusters.u0, u0), store(of_clusters.u1, u1), store(of_clusters.v0, v0);
  store(of_clusters.v1, v1), store(of_clusters.w, w);
  const FaceBox all{u0[0], u1[0], v0[0], v1[0], w[0]};
  std::uint32_t met = side.project(cluster, all, of_triangles) & boxes_met(of_triangles, rays);
  ClusterPlanes planes;
  set_up_planes(cluster, source, tau > 0, false, planes);
  FaceCluster on_face;
  side.place(planes, tau, on_face);
  met &= planes.valid & triangles_met(on_face, rays);
  RayNode node;
  for (int slot = 0; slot < 16; ++slot) node.set_box(slot, rays);
  ClusterVerdict verdict{met, 0};
  for (std::uint32_t left = met; left != 0; left &= left - 1) {
    const int i = std::countr_zero(left);
    if ((children_covered(node, on_face, i) & 1u) != 0) verdict.covered |= 1u << i;
  }
  return verdict;
}

}  // namespace tenebra::shadow::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
