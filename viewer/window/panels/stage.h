// Where the pictures of A and B are in the window, and how their pixels and places of the scene map to it.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "window/panels/panels.h"

namespace tenebra::viewer {

inline constexpr float gap_px = 4;  // between side by side

inline ImVec2 operator+(ImVec2 a, ImVec2 b) {
  return {a.x + b.x, a.y + b.y};
}
inline ImVec2 operator-(ImVec2 a, ImVec2 b) {
  return {a.x - b.x, a.y - b.y};
}

/// The largest place for a picture of `width` x `height` within `area`, centred on whole pixels; never
/// enlarged.
inline Area fit(Area area, int width, int height) {
  const float w = static_cast<float>(width), h = static_cast<float>(height);
  const float factor = std::min({1.0f, area.size.x / w, area.size.y / h});
  const ImVec2 size{factor == 1 ? w : std::floor(w * factor), factor == 1 ? h : std::floor(h * factor)};
  return {{std::floor(area.low.x + (area.size.x - size.x) / 2),
           std::floor(area.low.y + (area.size.y - size.y) / 2)},
          size};
}

inline Area half_of(Area area, bool right) {
  const float width = (area.size.x - gap_px) / 2;
  return {{right ? area.low.x + area.size.x - width : area.low.x, area.low.y}, {width, area.size.y}};
}

/// Which parts of A and B are drawn, and where.
class Stage {
public:
  Stage(const Ui& ui, Area area) : ui_(ui), list_(*ImGui::GetWindowDrawList()) {
    const Size whole = ui.picture->whole;
    side_ = both() && ui.state.show == CompareView::side_by_side;
    places_[0] = fit(side_ ? half_of(area, false) : area, whole.width, whole.height);
    places_[1] = side_ ? fit(half_of(area, true), whole.width, whole.height) : places_[0];
  }

  /// The overlay explains A: where A is not shown, neither is it.
  bool shows_overlay() const {
    return shows_a() && ui_.state.overlay != Overlay::none && ui_.picture->overlay.kind == ui_.state.overlay;
  }
  /// So do the hours of sun.
  bool shows_hours() const { return shows_a() && ui_.hours != nullptr; }
  bool both() const { return ui_.state.compare && ui_.picture->b.has_value(); }
  Area place() const { return places_[0]; }

  void draw(const ViewTextures& textures) {
    const CompareView show = both() ? ui_.state.show : CompareView::a;
    if (show == CompareView::difference) return image(textures.difference, places_[0], 0, 1);
    if (show == CompareView::b) return image(textures.b, places_[0], 0, 1);
    image(textures.a, places_[0], 0, show == CompareView::wipe ? ui_.state.wipe : 1);
    if (show == CompareView::wipe) image(textures.b, places_[0], ui_.state.wipe, 1);
    if (show == CompareView::side_by_side) image(textures.b, places_[1], 0, 1);
    const float to = show == CompareView::wipe ? ui_.state.wipe : 1;
    if (shows_hours())
      image(textures.hours, {places_[0].low, covered_size()}, 0, std::min(1.0f, to / ui_.hours->covered.x),
            ui_.state.overlay_opacity);
    else if (shows_overlay())
      image(textures.overlay, places_[0], 0, to, ui_.state.overlay_opacity);
  }

  /// Place in the picture of `at`, 0 to 1 from its left and top, in whichever of the places it is.
  glm::vec2 place_at(ImVec2 at) const {
    const Area& area = side_ && at.x >= places_[1].low.x ? places_[1] : places_[0];
    return {(at.x - area.low.x) / area.size.x, (at.y - area.low.y) / area.size.y};
  }
  glm::vec2 pixel_at(ImVec2 at) const {
    const io::Image8& image = ui_.picture->a.result.image;
    return place_at(at) * glm::vec2(image.width, image.height);
  }
  /// The place of the middle of the pixel under the pointer: pointers are at the upper left corners of
  /// pixels.
  glm::dvec2 place_under(ImVec2 pointer) const { return place_at(pointer + ImVec2(0.5f, 0.5f)); }
  ImVec2 at_pixel(glm::dvec2 pixel, int place) const {
    const Area& area = places_[static_cast<std::size_t>(place)];
    const io::Image8& image = ui_.picture->a.result.image;
    return {area.low.x + static_cast<float>(pixel.x / image.width) * area.size.x,
            area.low.y + static_cast<float>(pixel.y / image.height) * area.size.y};
  }
  int places() const { return side_ ? 2 : 1; }

private:
  bool shows_a() const {
    return !both() || (ui_.state.show != CompareView::b && ui_.state.show != CompareView::difference);
  }
  /// Of the part that has hours.
  ImVec2 covered_size() const {
    return {places_[0].size.x * ui_.hours->covered.x, places_[0].size.y * ui_.hours->covered.y};
  }
  void image(const PictureTexture& texture, Area area, float from, float to, float opacity = 1) {
    if (texture.width() == 0) return;
    // The cut lies on a whole pixel of the window, so that both sides stay exact.
    const float left = std::round(area.size.x * from), right = std::round(area.size.x * to);
    list_.AddImage(texture.id(), {area.low.x + left, area.low.y},
                   {area.low.x + right, area.low.y + area.size.y}, {left / area.size.x, 0},
                   {right / area.size.x, 1},
                   IM_COL32(255, 255, 255, static_cast<int>(std::round(255 * opacity))));
  }

  const Ui& ui_;
  ImDrawList& list_;
  std::array<Area, 2> places_;
  bool side_ = false;
};

/// A segment of the scene as a line in the window, cut where it is behind the eye.
void draw_line(const Ui& ui, const Stage& stage, glm::dvec3 a, glm::dvec3 b, ImU32 color, float thickness);
void draw_sun_path(Ui& ui, const Stage& stage);           ///< the day's, over the model
void draw_hours_legend(Ui& ui, const Area& place);        ///< of the colours, where hours are shown
void draw_explanation_lines(Ui& ui, const Stage& stage);  ///< from the explained pixel to each light

}  // namespace tenebra::viewer
