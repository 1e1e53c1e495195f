// Embree's packets of rays by the type of the packet.
#pragma once

#include "ao/reference/embree.h"

namespace tenebra::bench {

inline void intersect(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRayHit16& r) {
  q.intersect16(valid, s, r);
}
inline void intersect(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRayHit8& r) {
  q.intersect8(valid, s, r);
}
inline void intersect(ao::EmbreeQuery& q, const int* valid, RTCScene s, RTCRayHit4& r) {
  q.intersect4(valid, s, r);
}

}  // namespace tenebra::bench
