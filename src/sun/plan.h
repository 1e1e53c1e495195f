// The hours on the ground as a picture for people and as a raster for programs of maps.
#pragma once

#include <string>

#include "io/image.h"
#include "sun/colour_scale.h"

namespace tenebra::sun {

/// The cells from above, the file's north up, with a bar of the colours and one of the length. Of cells.
io::Image8 plan_of(const Study& study, const ColourScale& scale);

/// The values as a GeoTIFF of one band of floats, in the coordinates of the scene's file: x east, north its y
/// where z is up, its -z where y is. `epsg`: number of the projection that these are of; 0: not known. Of
/// cells.
std::string geotiff_of(const Study& study, int epsg);

}  // namespace tenebra::sun
