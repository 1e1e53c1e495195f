// Pictures of a render, made small for a page.
#pragma once

#include <string>
#include <vector>

#include "io/image.h"
#include "log/log_file.h"
#include "options/settings_names.h"

namespace tenebra::viewer {

/// A frame's picture, of one render or two, as data URIs.
struct PagePicture {
  int frame = 0;
  int width = 0, height = 0;  ///< of the small picture, pixels
  std::string a;
  std::string b;  ///< "" with one render
};

/// A picture as PNG, for the source of an image.
Expected<std::string> data_uri(const io::Image8& picture);

/// --pictures: a folder of pictures that are named as `render` names them (%04d.png), or a pattern.
Expected<OutputPattern> picture_pattern(const std::string& text);

/// Pictures of at most `most_page_pictures` of the frames, spread evenly over those that have a file, at most
/// `widest_page_picture` pixels wide. With `b`, frames that have both. Fails if there is no picture at all or
/// one cannot be read.
Expected<std::vector<PagePicture>> page_pictures(const std::vector<int>& frames, const OutputPattern& a,
                                                 const OutputPattern* b);

inline constexpr std::size_t most_page_pictures = 8;
inline constexpr int widest_page_picture = 480;

}  // namespace tenebra::viewer
