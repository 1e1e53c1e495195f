// What anti-aliasing works with: the samples at the pixels' centres, and the stages that further samples go
// through as the centres did.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "render/antialias/centre_shadows.h"
#include "render/antialias/surface_match.h"
#include "render/centres.h"
#include "render/frame_raster.h"
#include "render/frame_shading.h"
#include "render/lighter.h"
#include "render/see_through_layer.h"

namespace tenebra::render {

struct SampleStages {
  const Frame& frame;
  const Centres& centres;
  FrameRaster& raster;
  Lighter& lighter;
  SeeThroughLayer& layer;
  FrameShading& shading;

  SurfaceMatch surface_match() const { return {frame.input.geometry, frame.input.view}; }
  CentreShadows centre_shadows() const {
    CentreShadows out{centres.seen.width, centres.seen.height, centres.seen.ids, {}, centres.factors, {}};
    if (centres.seen.has_layer) out.layer = centres.seen.layer;
    for (const shade::LightFactors& light : centres.factors)
      out.masks.push_back(light.mask.empty() ? nullptr : light.mask.data());
    return out;
  }
};

}  // namespace tenebra::render
