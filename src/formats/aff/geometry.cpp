// Meshes, polygons, animated triangles and round shapes.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/fail.h"
#include "formats/aff/reader.h"
#include "formats/aff/shapes.h"

namespace tenebra::formats {
namespace {

constexpr std::string_view coordinate = "a coordinate of a vertex";
constexpr std::string_view normal_coordinate = "a coordinate of a normal";

glm::vec3 read_position(AffLexer& in) {
  const float x = in.real(coordinate);
  const float y = in.real(coordinate);
  return {x, y, in.real(coordinate)};
}

/// A stored normal may have any length. Zero stays zero: the face normal.
glm::vec3 read_normal(AffLexer& in) {
  const glm::dvec3 n = in.look_vector(normal_coordinate);
  const double length = glm::length(n);
  return length > 0.0 && std::isfinite(length) ? glm::vec3(n / length) : glm::vec3(0.0f);
}

/// Not normalised: the keys of animated triangles interpolate it as written.
glm::vec3 read_raw_normal(AffLexer& in) {
  return glm::vec3(in.look_vector(normal_coordinate));
}

template <class Read>
std::vector<glm::vec3> read_list(AffLexer& in, std::string_view what, Read read) {
  const std::size_t count = in.count(what);
  std::vector<glm::vec3> list;
  list.reserve(std::min(count, in.most_numbers_left() / 3));
  for (std::size_t i = 0; i < count; ++i) list.push_back(read(in));
  return list;
}

/// The first row of a picture is at v = 0, as in glTF: BART's paintings and its garden hang upright so, and
/// the garden agrees with the published picture.
glm::vec2 read_texture_coordinates(AffLexer& in) {
  const double u = in.look("a texture coordinate");
  return {u, in.look("a texture coordinate")};
}

/// The tables of an `m`, each with its own indices.
struct MeshTables {
  std::vector<glm::vec3> positions;
  std::vector<glm::vec3> normals;
  std::vector<glm::vec2> texture_coordinates;
  std::string texture;
  std::string texture_place;  ///< where it is named
  bool has_normals = false;
  bool has_texture = false;
};

MeshTables read_tables(AffLexer& in) {
  MeshTables tables;
  in.expect("vertices");
  tables.positions = read_list(in, "the number of vertices", read_position);
  if (in.peek() == "normals") {
    in.expect("normals");
    tables.has_normals = true;
    tables.normals = read_list(in, "the number of normals", read_normal);
  }
  if (in.peek() == "texturecoords") {
    in.expect("texturecoords");
    tables.has_texture = true;
    const std::size_t count = in.count("the number of texture coordinates");
    tables.texture = in.word("the name of a texture");
    tables.texture_place = in.place();
    tables.texture_coordinates.reserve(std::min(count, in.most_numbers_left() / 2));
    for (std::size_t i = 0; i < count; ++i)
      tables.texture_coordinates.push_back(read_texture_coordinates(in));
  }
  return tables;
}

glm::uvec3 read_indices(AffLexer& in, std::size_t size, std::string_view what,
                        std::uint32_t (AffLexer::*read)(std::size_t, std::string_view)) {
  const std::uint32_t a = (in.*read)(size, what);
  const std::uint32_t b = (in.*read)(size, what);
  return {a, b, (in.*read)(size, what)};
}

/// Corners of the triangles: indices by kind; those of kinds that the mesh lacks are empty.
struct Corners {
  std::vector<glm::uvec3> positions;
  std::vector<glm::uvec3> normals;
  std::vector<glm::uvec3> texture_coordinates;
};

/// Indices of normals and texture coordinates that the tables do not have are those of an entry of zeros that
/// is added to them: the face's normal, a picture's corner.
Corners read_triangles(AffLexer& in, MeshTables& tables) {
  in.expect("triangles");
  const std::size_t count = in.count("the number of triangles");
  const std::size_t numbers = 3 + (tables.has_normals ? 3 : 0) + (tables.has_texture ? 3 : 0);
  const std::size_t room = std::min(count, in.most_numbers_left() / numbers);
  Corners corners;
  corners.positions.reserve(room);
  if (tables.has_normals) corners.normals.reserve(room);
  if (tables.has_texture) corners.texture_coordinates.reserve(room);
  for (std::size_t t = 0; t < count; ++t) {
    corners.positions.push_back(
        read_indices(in, tables.positions.size(), "a vertex index", &AffLexer::index));
    if (tables.has_normals) {
      corners.normals.push_back(
          read_indices(in, tables.normals.size(), "a normal index", &AffLexer::look_index));
    }
    if (tables.has_texture) {
      corners.texture_coordinates.push_back(
          read_indices(in, tables.texture_coordinates.size(), "a texture index", &AffLexer::look_index));
    }
  }
  tables.normals.emplace_back(0.0f);
  tables.texture_coordinates.emplace_back(0.0f);
  return corners;
}

/// One vertex for every combination of position, normal and texture coordinates in use.
void join_corners(const MeshTables& tables, const Corners& corners, Mesh& mesh) {
  struct Use {
    std::array<std::uint32_t, 3> kinds;  ///< indices into the tables
    std::uint32_t corner;
  };
  std::vector<Use> uses;
  uses.reserve(3 * corners.positions.size());
  for (std::size_t t = 0; t < corners.positions.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      uses.push_back({{corners.positions[t][k], tables.has_normals ? corners.normals[t][k] : 0,
                       tables.has_texture ? corners.texture_coordinates[t][k] : 0},
                      static_cast<std::uint32_t>(uses.size())});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const Use& a, const Use& b) { return a.kinds < b.kinds; });
  mesh.triangles.resize(corners.positions.size());
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const auto& kinds = uses[i].kinds;
    if (i == 0 || kinds != uses[i - 1].kinds) {
      mesh.positions.push_back(tables.positions[kinds[0]]);
      if (tables.has_normals) mesh.normals.push_back(tables.normals[kinds[1]]);
      if (tables.has_texture) mesh.texture_coordinates[0].push_back(tables.texture_coordinates[kinds[2]]);
    }
    mesh.triangles[uses[i].corner / 3][static_cast<int>(uses[i].corner % 3)] =
        static_cast<std::uint32_t>(mesh.positions.size() - 1);
  }
}

std::size_t memory_of(const Mesh& mesh) {
  return sizeof(glm::vec3) * (mesh.positions.size() + mesh.normals.size()) +
         sizeof(glm::vec2) * mesh.texture_coordinates[0].size() +
         (sizeof(glm::uvec3) + sizeof(std::uint32_t)) * mesh.triangles.size();
}

}  // namespace

std::uint32_t AffReader::current_material(AffLexer& in) {
  if (!material_) {  // a file may give geometry before its first material
    set_material(in, {-1.0}, Material{});
  }
  return *material_;
}

std::uint32_t AffReader::textured_material(AffLexer& in, const std::string& texture,
                                           const std::string& place) {
  const std::uint32_t plain = current_material(in);
  const int image = images_->find(texture, place);
  if (image < 0) return plain;
  const auto next = static_cast<std::uint32_t>(scene_.materials.size());
  const auto [entry, is_new] = textured_materials_.try_emplace({plain, image}, next);
  if (is_new) {
    charge(in, 2 * sizeof(Material) + 2 * sizeof(*entry));
    Material material = scene_.materials[plain];
    material.base_color_map.image = image;
    scene_.materials.push_back(std::move(material));
  }
  return entry->second;
}

Mesh& AffReader::add_mesh(AffLexer& in, std::string source) {
  charge(in, 2 * sizeof(Mesh) + source.size());
  Node node;
  node.mesh = static_cast<int>(scene_.meshes.size());
  add_node(in, std::move(node));
  Mesh& mesh = scene_.meshes.emplace_back();
  mesh.source = std::move(source);
  return mesh;
}

void AffReader::read_mesh(AffLexer& in) {
  std::string source = in.place();
  MeshTables tables = read_tables(in);
  Corners corners = read_triangles(in, tables);
  const std::uint32_t material =
      tables.has_texture ? textured_material(in, tables.texture, tables.texture_place) : current_material(in);
  tables.has_texture = scene_.materials[material].base_color_map.image >= 0;
  Mesh& mesh = add_mesh(in, std::move(source));
  if (tables.has_normals || tables.has_texture) {
    join_corners(tables, corners, mesh);
  } else {
    mesh.positions = std::move(tables.positions);
    mesh.triangles = std::move(corners.positions);
  }
  mesh.materials.assign(mesh.triangles.size(), material);
  charge(in, memory_of(mesh));
}

void AffReader::append_polygon(AffLexer& in, std::string source, std::size_t corners, bool normals,
                               const std::string* texture) {
  const std::uint32_t material = texture ? textured_material(in, *texture, in.place()) : current_material(in);
  if (run_.mesh < 0) {
    add_mesh(in, std::move(source));
    run_.mesh = static_cast<int>(scene_.meshes.size()) - 1;
  }
  Mesh& mesh = scene_.meshes[static_cast<std::size_t>(run_.mesh)];
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::size_t i = 0; i < corners; ++i) {
    mesh.positions.push_back(read_position(in));
    if (normals) mesh.normals.push_back(read_normal(in));
    if (texture) mesh.texture_coordinates[0].push_back(read_texture_coordinates(in));
  }
  for (std::uint32_t i = 1; i + 1 < corners; ++i) {
    mesh.triangles.emplace_back(first, first + i, first + i + 1);
    mesh.materials.push_back(material);
  }
  charge(in,
         corners * (2 * sizeof(glm::vec3) + sizeof(glm::vec2) + sizeof(glm::uvec3) + sizeof(std::uint32_t)));
}

std::size_t AffReader::read_corner_count(AffLexer& in, std::size_t numbers_a_corner) {
  const std::size_t corners = in.count("the number of corners");
  if (corners >= 3) return corners;
  in.warn(fmt::format("{} corners", corners), "at least 3", "left out");
  for (std::size_t i = 0; i < corners * numbers_a_corner; ++i) in.look("a number of a corner");
  return 0;
}

void AffReader::read_polygon(AffLexer& in) {
  std::string source = in.place();
  if (const std::size_t corners = read_corner_count(in, 3); corners > 0)
    append_polygon(in, std::move(source), corners, false, nullptr);
}

void AffReader::read_polygon_with_normals(AffLexer& in) {
  std::string source = in.place();
  if (const std::size_t corners = read_corner_count(in, 6); corners > 0)
    append_polygon(in, std::move(source), corners, true, nullptr);
}

void AffReader::read_textured_triangle(AffLexer& in) {
  std::string source = in.place();
  const std::string texture(in.word("the name of a texture"));
  append_polygon(in, std::move(source), 3, false, &texture);
}

void AffReader::read_textured_triangle_with_normals(AffLexer& in) {
  std::string source = in.place();
  const std::string texture(in.word("the name of a texture"));
  append_polygon(in, std::move(source), 3, true, &texture);
}

void AffReader::read_animated_triangle(AffLexer& in) {
  std::string source = in.place();
  const std::size_t count = in.count("the number of keys");
  if (count == 0) return in.warn("0 keys", "at least one", "left out");
  std::vector<Mesh::Shape> keys;
  for (std::size_t i = 0; i < count; ++i) {
    Mesh::Shape& key = keys.emplace_back();
    key.time_s = in.number("the time of a key");
    if (i > 0 && key.time_s < keys[i - 1].time_s) in.fail("a time before the last key's", "ascending times");
    for (int corner = 0; corner < 3; ++corner) {
      key.positions.push_back(read_position(in));
      key.normals.push_back(read_raw_normal(in));
    }
  }
  const auto same_time = [](const Mesh::Shape& a, const Mesh::Shape& b) { return a.time_s == b.time_s; };
  const auto continues = [&](const Mesh& mesh) {
    return std::equal(keys.begin(), keys.end(), mesh.shapes.begin(), mesh.shapes.end(), same_time);
  };
  if (run_.mesh < 0 || !continues(scene_.meshes[static_cast<std::size_t>(run_.mesh)])) {
    charge(in, count * (sizeof(Mesh::Shape) + 64));
    add_mesh(in, std::move(source)).shapes.resize(count);
    run_.mesh = static_cast<int>(scene_.meshes.size()) - 1;
  }
  Mesh& mesh = scene_.meshes[static_cast<std::size_t>(run_.mesh)];
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  charge(in, (count + 1) * 6 * sizeof(glm::vec3) + sizeof(glm::uvec4));
  for (std::size_t i = 0; i < count; ++i) {
    Mesh::Shape& shape = mesh.shapes[i];
    shape.time_s = keys[i].time_s;
    shape.positions.insert(shape.positions.end(), keys[i].positions.begin(), keys[i].positions.end());
    shape.normals.insert(shape.normals.end(), keys[i].normals.begin(), keys[i].normals.end());
  }
  mesh.positions.insert(mesh.positions.end(), keys[0].positions.begin(), keys[0].positions.end());
  mesh.normals.insert(mesh.normals.end(), keys[0].normals.begin(), keys[0].normals.end());
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.materials.push_back(current_material(in));
}

void AffReader::add_round_shape(AffLexer& in, std::string source, Mesh shape) {
  charge(in, 2 * memory_of(shape));
  shape.source = source;
  shape.materials.assign(shape.triangles.size(), current_material(in));
  add_mesh(in, std::move(source)) = std::move(shape);
}

void AffReader::read_cone(AffLexer& in) {
  std::string source = in.place();
  std::array<double, 8> n{};
  for (double& number : n) number = in.number("one of a cone's 8 numbers");
  const glm::dvec3 base(n[0], n[1], n[2]), apex(n[4], n[5], n[6]);
  const double base_radius = n[3], apex_radius = n[7];
  if (base == apex && std::abs(base_radius) == std::abs(apex_radius))
    return in.warn("a cone's base and apex at one point", "two points", "it is a line, left out");
  if (base == apex) in.fail("a cone's base and apex at one point", "two points");
  if (base_radius * apex_radius < 0.0) in.fail("radii of different signs", "both of one sign");
  const int sides = std::clamp(options_.cone_sides, 3, 1 << 16);
  const bool inside = base_radius < 0.0 || apex_radius < 0.0;
  add_round_shape(in, std::move(source),
                  make_cone(base, std::abs(base_radius), apex, std::abs(apex_radius), sides, inside));
}

void AffReader::read_sphere(AffLexer& in) {
  std::string source = in.place();
  std::array<double, 4> n{};
  for (double& number : n) number = in.number("one of a sphere's 4 numbers");
  add_round_shape(in, std::move(source), make_sphere({n[0], n[1], n[2]}, std::abs(n[3]), n[3] < 0.0));
}

}  // namespace tenebra::formats
