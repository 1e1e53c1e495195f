#include <cmath>

#include "formats/import_failure.h"
#include "formats/ply/parts.h"
#include "formats/polygon.h"

namespace tenebra::formats::ply {
namespace {

class FaceReader {
public:
  FaceReader(bool textured, std::size_t materials, Values& values, Mesh& mesh,
             std::vector<UnusedContent>& unused, FaceLists& lists)
      : textured_(textured),
        materials_(materials),
        values_(values),
        mesh_(mesh),
        unused_(unused),
        lists_(lists) {}

  void read(const Element& element) {
    if (mesh_.positions.empty())
      refuse("element '{}': found it before any vertices, expected these first", shown(element.name));
    const FaceProperties of = face_properties(element);
    const bool strips = element.name == "tristrips";
    if (!strips) mesh_.triangles.reserve(mesh_.triangles.size() + element.count);
    for (face_ = 0; face_ < element.count; ++face_) {
      corners_.clear();
      wedges_.clear();
      double picture = 0;
      for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
        const Property& property = element.properties[static_cast<std::size_t>(p)];
        if (p == of.corners)
          take_corners(property, strips);
        else if (p == of.coordinates)
          take_wedges(property);
        else if (p == of.picture)
          picture = values_.take(property.type);
        else
          values_.skip(property);
      }
      values_.end_row();
      if (wedges_.size() == 2 * corners_.size()) split_corners();
      strips ? add_strips() : add_face();
      const bool known = picture >= 0 && picture < static_cast<double>(materials_);
      mesh_.materials.resize(mesh_.triangles.size(), known ? static_cast<std::uint32_t>(picture) : 0);
    }
  }

private:
  /// Which property is what; -1: none.
  struct FaceProperties {
    int corners = -1, coordinates = -1, picture = -1;
  };
  FaceProperties face_properties(const Element& element) {
    FaceProperties found;
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const Property& property = element.properties[p];
      const int index = static_cast<int>(p);
      if (property.count_type && (property.name == "vertex_indices" || property.name == "vertex_index"))
        found.corners = index;
      else if (textured_ && property.count_type && property.name == "texcoord")
        found.coordinates = index;
      else if (!property.count_type && property.name == "texnumber")
        found.picture = index;
      else
        unused_.push_back({"face " + shown(property.name), element.count});
    }
    if (found.corners < 0)
      refuse("element '{}': found no list vertex_indices, expected one", shown(element.name));
    return found;
  }

  /// In strips -1 ends one.
  void take_corners(const Property& property, bool strips) {
    for (std::size_t left = values_.take_count(property); left > 0; --left) {
      const double vertex = values_.take(property.type);
      const bool end = strips && vertex < 0;
      const bool known = vertex >= 0 && vertex < static_cast<double>(lists_.vertices);
      if (!end && (!known || vertex != std::floor(vertex)))
        refuse("face {}: found vertex {}, expected a whole number from 0 to {}: the file may be cut off",
               face_, vertex, lists_.vertices - 1);
      corners_.push_back(end ? no_vertex : static_cast<std::uint32_t>(vertex));
    }
  }

  void take_wedges(const Property& property) {
    for (std::size_t left = values_.take_count(property); left > 0; --left)
      wedges_.push_back(values_.take(property.type));
  }

  /// Gives corners that have other coordinates than their vertex a vertex of their own.
  void split_corners() {
    auto& coordinates = mesh_.texture_coordinates[0];
    auto& next = lists_.next;
    if (coordinates.empty()) coordinates.assign(mesh_.positions.size(), glm::vec2(NAN));
    if (next.empty()) next.assign(mesh_.positions.size(), no_vertex);
    constexpr int most_steps = 64;  // a vertex that is there twice does no harm
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      if (corners_[i] == no_vertex) continue;
      const glm::vec2 wanted = coordinates_of(wedges_[2 * i], wedges_[2 * i + 1]);
      std::uint32_t at = corners_[i];
      const auto fits = [&] { return coordinates[at] == wanted || std::isnan(coordinates[at].x); };
      for (int steps = 0; !fits() && next[at] != no_vertex && steps < most_steps; ++steps) at = next[at];
      if (!fits()) at = copy_behind(at);
      coordinates[at] = wanted;
      corners_[i] = at;
    }
  }

  std::uint32_t copy_behind(std::uint32_t vertex) {
    const auto copy = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto repeat = [vertex](auto& list) {
      if (!list.empty()) list.push_back(list[vertex]);
    };
    repeat(mesh_.positions);
    repeat(mesh_.unrounded);
    repeat(mesh_.normals);
    repeat(mesh_.colors);
    repeat(mesh_.texture_coordinates[0]);
    lists_.next.push_back(lists_.next[vertex]);
    lists_.next[vertex] = copy;
    return copy;
  }

  void add_face() {
    if (corners_.size() >= 3)
      add_polygon(corners_, lists_.work, mesh_);
    else
      ++lists_.left_out;
  }

  void add_strips() {
    bool turned = false;
    for (std::size_t i = 2; i < corners_.size(); ++i) {
      const std::uint32_t a = corners_[i - 2], b = corners_[i - 1], c = corners_[i];
      const bool whole = a != no_vertex && b != no_vertex && c != no_vertex;
      if (whole && a != b && b != c && c != a)
        mesh_.triangles.push_back(turned ? glm::uvec3(b, a, c) : glm::uvec3(a, b, c));
      turned = whole && !turned;
    }
  }

  const bool textured_;
  const std::size_t materials_;
  Values& values_;
  Mesh& mesh_;
  std::vector<UnusedContent>& unused_;
  FaceLists& lists_;
  std::vector<std::uint32_t> corners_;  ///< of the face
  std::vector<double> wedges_;          ///< of the face, two for each corner
  std::uint64_t face_ = 0;              ///< of the element
};

}  // namespace

void read_faces(const Element& element, bool textured, std::size_t materials, Values& values, Mesh& mesh,
                std::vector<UnusedContent>& unused, FaceLists& lists) {
  FaceReader(textured, materials, values, mesh, unused, lists).read(element);
}

}  // namespace tenebra::formats::ply
