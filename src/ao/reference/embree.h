// Embree 3 and Embree 4 by the same calls: in version 4 a query's context became optional arguments, one
// structure for nearest hits and one for occlusion. TENEBRA_EMBREE is the major version that the build found.
#pragma once

#if TENEBRA_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tenebra::ao {

/// What Embree is told about rays besides the rays themselves: made once, used for many.
class EmbreeQuery {
public:
  enum Rays { incoherent, coherent };

#if TENEBRA_EMBREE >= 4
  explicit EmbreeQuery(Rays rays = incoherent) {
    rtcInitIntersectArguments(&intersect_);
    rtcInitOccludedArguments(&occluded_);
    if (rays == coherent) intersect_.flags = occluded_.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  }
  void intersect1(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &ray, &intersect_);
  }
  void intersect4(const int* valid, RTCScene scene, RTCRayHit4& rays) {
    rtcIntersect4(valid, scene, &rays, &intersect_);
  }
  void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &rays, &intersect_);
  }
  void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &rays, &intersect_);
  }
  void occluded1(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &ray, &occluded_);
  }
  void occluded4(const int* valid, RTCScene scene, RTCRay4& rays) {
    rtcOccluded4(valid, scene, &rays, &occluded_);
  }
  void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &rays, &occluded_);
  }
  void occluded16(const int* valid, RTCScene scene, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &rays, &occluded_);
  }

private:
  RTCIntersectArguments intersect_;
  RTCOccludedArguments occluded_;
#else
  explicit EmbreeQuery(Rays rays = incoherent) {
    rtcInitIntersectContext(&context_);
    if (rays == coherent) context_.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  }
  void intersect1(RTCScene scene, RTCRayHit& ray) {
    rtcIntersect1(scene, &context_, &ray);
  }
  void intersect4(const int* valid, RTCScene scene, RTCRayHit4& rays) {
    rtcIntersect4(valid, scene, &context_, &rays);
  }
  void intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays) {
    rtcIntersect8(valid, scene, &context_, &rays);
  }
  void intersect16(const int* valid, RTCScene scene, RTCRayHit16& rays) {
    rtcIntersect16(valid, scene, &context_, &rays);
  }
  void occluded1(RTCScene scene, RTCRay& ray) {
    rtcOccluded1(scene, &context_, &ray);
  }
  void occluded4(const int* valid, RTCScene scene, RTCRay4& rays) {
    rtcOccluded4(valid, scene, &context_, &rays);
  }
  void occluded8(const int* valid, RTCScene scene, RTCRay8& rays) {
    rtcOccluded8(valid, scene, &context_, &rays);
  }
  void occluded16(const int* valid, RTCScene scene, RTCRay16& rays) {
    rtcOccluded16(valid, scene, &context_, &rays);
  }

private:
  RTCIntersectContext context_;
#endif
};

}  // namespace tenebra::ao
