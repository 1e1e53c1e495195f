// The parts of the window, each drawn by one function in a file of its own. They change the state and ask for
// actions; none touches the worker or the window system, or writes files.
#pragma once

#include "window/panels/ui.h"
#include "window/view_textures.h"

namespace tenebra::viewer {

struct Area {
  ImVec2 low, size;
};

/// Where the picture, the panel and the transport bar go in a window of `window`: the panel only where there
/// is room for it.
struct Layout {
  Area view, panel, transport;
  bool has_panel = false;
};
Layout layout_of(const Ui& ui, ImVec2 window);

/// Pixels that a picture has there, if its size is not fixed: half of the width side by side.
Size picture_size(const ViewState& state, Area view, float pixels_a_unit);

void draw_view(Ui& ui, const ViewTextures& textures, Area area);  ///< the picture, and the mouse in it
void draw_transport(Ui& ui, Area area);                           ///< play, scrubber, speed
void draw_panel(Ui& ui, Area area);                               ///< all sections below
void draw_scene_section(Ui& ui);
void draw_method_section(Ui& ui);
void draw_light_section(Ui& ui);
void draw_sun_section(Ui& ui);
void draw_tree_section(Ui& ui);
void draw_material_section(Ui& ui);
void draw_camera_section(Ui& ui);
void draw_compare_section(Ui& ui);
void draw_trade_plot(Ui& ui);        ///< which settings are worth their time here
void draw_research_section(Ui& ui);  ///< variants, solvers, threads, costs: the second level
void draw_cost_section(Ui& ui);
void draw_day(Ui& ui,
              const PictureAnswer& answer);     ///< of a pixel: which minutes are dark, and who blocks them
void draw_explanation_card(Ui& ui, Area view);  ///< why a pixel is dark, in words
void draw_open_dialog(Ui& ui, ImVec2 window);
void draw_help(Ui& ui, ImVec2 window);  ///< the overlay of keys
void draw_progress(Ui& ui, Area view);  ///< what takes long, and its cancel button

/// Keys that act wherever the pointer is; `seconds` since the last call moves a flying camera.
void handle_keys(Ui& ui, float seconds);
bool flies(const ImGuiIO& io);  ///< a key that moves the camera is down

/// Changes that several parts offer.
void toggle_playing(ViewState& state);
void leave_scene_camera(Ui& ui, CameraMode mode);
void flip_slots(ViewState& state);
void choose_clip(ViewState& state, int clip);
void add_light(Ui& ui, LightType type);  ///< above what was asked about last, or the scene; selects it

/// What nodes are called where they have no name.
std::string node_name(const ViewState& state, int node);
/// A word that selects what it names when it is clicked.
bool link(Ui& ui, const std::string& text, const std::string& mark);

}  // namespace tenebra::viewer
