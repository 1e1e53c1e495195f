#include <algorithm>
#include <array>
#include <cmath>

#include "formats/import_failure.h"
#include "formats/ply/parts.h"
#include "math/srgb.h"

namespace tenebra::formats::ply {
namespace {

/// What a property of a vertex is; the names that programs give it.
enum Slot { x, y, z, nx, ny, nz, red, green, blue, alpha, u, v, slots };
constexpr struct {
  std::string_view name;
  Slot slot;
} slot_names[] = {{"x", x},
                  {"y", y},
                  {"z", z},
                  {"nx", nx},
                  {"ny", ny},
                  {"nz", nz},
                  {"red", red},
                  {"green", green},
                  {"blue", blue},
                  {"alpha", alpha},
                  {"r", red},
                  {"g", green},
                  {"b", blue},
                  {"a", alpha},
                  {"diffuse_red", red},
                  {"diffuse_green", green},
                  {"diffuse_blue", blue},
                  {"s", u},
                  {"t", v},
                  {"u", u},
                  {"v", v},
                  {"texture_u", u},
                  {"texture_v", v},
                  {"texture_s", u},
                  {"texture_t", v}};

/// The slot of each property of the vertices; slots: not used.
std::vector<Slot> slots_of(const Element& element) {
  std::vector<Slot> found;
  for (const Property& property : element.properties) {
    const auto known = std::find_if(std::begin(slot_names), std::end(slot_names),
                                    [&](const auto& entry) { return entry.name == property.name; });
    found.push_back(known == std::end(slot_names) || property.count_type ? slots : known->slot);
  }
  return found;
}

/// What 1 is stored as in a colour of this type.
double whole_of(Type type) {
  if (type == Type::float32 || type == Type::float64) return 1;
  return type == Type::uint16 ? 65535 : 255;
}

/// Linear colour of an encoded one, as photographs and scanners have them.
float linear(double encoded) {
  return math::linear_of_srgb(static_cast<float>(std::isnan(encoded) ? 1 : std::clamp(encoded, 0.0, 1.0)));
}

}  // namespace

glm::vec2 coordinates_of(double s, double t) {
  return std::isfinite(s) && std::isfinite(t) ? glm::vec2(s, 1 - t) : glm::vec2(0);
}

std::vector<glm::dvec3> read_vertices(const Element& element, bool textured, Values& values, Mesh& mesh,
                                      std::vector<UnusedContent>& unused) {
  const std::vector<Slot> slots_in = slots_of(element);
  const auto has = [&](Slot slot) {
    return std::find(slots_in.begin(), slots_in.end(), slot) != slots_in.end();
  };
  if (!has(x) || !has(y) || !has(z) || !mesh.positions.empty() || element.count >= no_vertex)
    refuse("element 'vertex': found {} of them, expected one list with x, y and z", element.count);
  const bool normals = has(nx) && has(ny) && has(nz), colors = has(red) && has(green) && has(blue);
  const bool coordinates = has(u) && has(v) && textured;
  std::vector<glm::dvec3> points;
  points.reserve(element.count);
  if (normals) mesh.normals.reserve(element.count);
  if (colors) mesh.colors.reserve(element.count);
  if (coordinates) mesh.texture_coordinates[0].reserve(element.count);
  std::array<double, slots + 1> at{};  // the last: what is not used
  at[alpha] = 1;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t p = 0; p < slots_in.size(); ++p) {
      const Property& property = element.properties[p];
      if (property.count_type) {
        values.skip(property);
        continue;
      }
      const bool color = slots_in[p] >= red && slots_in[p] <= alpha;
      at[slots_in[p]] = values.take(property.type) / (color ? whole_of(property.type) : 1);
    }
    values.end_row();
    points.emplace_back(at[x], at[y], at[z]);
    if (normals) mesh.normals.emplace_back(at[nx], at[ny], at[nz]);
    if (colors) mesh.colors.emplace_back(linear(at[red]), linear(at[green]), linear(at[blue]), at[alpha]);
    if (coordinates) mesh.texture_coordinates[0].push_back(coordinates_of(at[u], at[v]));
  }
  for (std::size_t p = 0; p < slots_in.size(); ++p)
    if (slots_in[p] == slots)
      unused.push_back({"vertex " + shown(element.properties[p].name), element.count});
  return points;
}

}  // namespace tenebra::formats::ply
