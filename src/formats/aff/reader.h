// Reads the directives of an AFF scene, file after file, into a Scene. Throws AffFailure.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "formats/aff/files.h"
#include "formats/aff/keys.h"
#include "formats/aff/lexer.h"
#include "formats/images/scene_images.h"
#include "formats/import_scene.h"

namespace tenebra::formats {

class AffReader {
public:
  explicit AffReader(const ImportOptions& options) : options_(options) {}
  Scene read(const std::filesystem::path& path);

private:
  struct Directive;
  static const Directive directives[];

  // reader.cpp: files, blocks, global state
  void read_file(AffFile& file);
  void read_directive(AffLexer& in);
  void read_include(AffLexer& in);
  void read_detail_level(AffLexer& in);
  void read_background(AffLexer& in);
  void read_ambient(AffLexer& in);
  void read_static_transform(AffLexer& in);
  void read_animated_transform(AffLexer& in);
  void read_keys(AffLexer& in);
  void open_block(AffLexer& in, Node node);
  void close_block(AffLexer& in);

  // view.cpp: camera, lights, materials, time
  void read_view(AffLexer& in);
  void read_light(AffLexer& in);
  void read_animated_light(AffLexer& in);
  void read_fill(AffLexer& in);
  void read_material(AffLexer& in);
  void read_animation(AffLexer& in);
  void add_light(AffLexer& in, Node node);
  void set_material(AffLexer& in, const std::array<double, 12>& numbers, const Material& material);

  // geometry.cpp
  void read_mesh(AffLexer& in);
  void read_polygon(AffLexer& in);
  void read_polygon_with_normals(AffLexer& in);
  void read_textured_triangle(AffLexer& in);
  void read_textured_triangle_with_normals(AffLexer& in);
  void read_animated_triangle(AffLexer& in);
  void read_cone(AffLexer& in);
  void read_sphere(AffLexer& in);
  /// The number of corners; 0, with a fault, where they enclose nothing: they are read then.
  std::size_t read_corner_count(AffLexer& in, std::size_t numbers_a_corner);
  /// `texture`: the picture that the corners have coordinates of, or nullptr.
  void append_polygon(AffLexer& in, std::string source, std::size_t corners, bool normals,
                      const std::string* texture);
  Mesh& add_mesh(AffLexer& in, std::string source);
  void add_round_shape(AffLexer& in, std::string source, Mesh shape);
  std::uint32_t current_material(AffLexer& in);
  /// The current material with a picture on it; without one where there is no such picture.
  std::uint32_t textured_material(AffLexer& in, const std::string& texture, const std::string& place);

  // finish.cpp: what is known only at the end
  void finish();
  void add_camera();
  void add_channels(int node, const std::string& name, bool translation_only);
  int track_of(const std::string& name, ChannelPath path, const Track& track);
  void bound_interval();
  void name_missing_keys();
  void name_faults();

  int add_node(AffLexer& in, Node node);
  /// Counts `bytes` of the scene; fails where the file's include directives make the scene larger than
  /// import_scene promises.
  void charge(AffLexer& in, std::size_t bytes);

  struct Block {
    int node = -1;
    std::string place;
  };
  struct View {
    Camera camera;
    Node node;
  };
  struct Animated {
    int node = -1;
    std::string name;
    bool translation_only = false;
  };
  /// Consecutive directives of one kind share a mesh.
  struct Run {
    std::string_view keyword;
    int mesh = -1;
  };

  ImportOptions options_;
  AffFiles files_;
  AffFaults faults_;
  Scene scene_;
  std::vector<AffFile*> open_files_;
  std::vector<Block> blocks_;
  std::size_t first_block_of_file_ = 0;
  std::int64_t detail_level_ = 0;
  std::optional<std::uint32_t> material_;
  std::map<std::array<double, 12>, std::uint32_t> known_materials_;
  std::optional<SceneImages> images_;
  std::map<std::pair<std::uint32_t, int>, std::uint32_t> textured_materials_;  ///< by material and image
  std::optional<View> view_;
  std::map<std::string, AffKeys, std::less<>> keys_;
  std::vector<Animated> animated_;
  std::map<std::pair<std::string, ChannelPath>, int> tracks_;
  Clip clip_;
  bool interval_stated_ = false;
  Run run_;
  std::uint64_t scene_bytes_ = 0;
  std::uint64_t expanded_bytes_ = 0;
  std::size_t includes_ = 0;
};

}  // namespace tenebra::formats
