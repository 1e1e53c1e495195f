#include "bench/sun/sun_models.h"

#include <cmath>

namespace tenebra::bench {
namespace {

using glm::vec3;

/// The same numbers each time, 0 to 1.
class Dice {
public:
  float operator()(float low, float high) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * static_cast<float>(state_ >> 40) * 0x1p-24f;
  }

private:
  std::uint64_t state_ = 55;
};

void add_triangle(Mesh& mesh, const vec3& a, const vec3& b, const vec3& c) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), {a, b, c});
  mesh.triangles.emplace_back(first, first + 1, first + 2);
  mesh.materials.push_back(0);
}
void add_quad(Mesh& mesh, const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
  add_triangle(mesh, a, b, c), add_triangle(mesh, a, c, d);
}

/// Walls, gables and two slopes of a roof about `middle`, turned by `angle`.
void add_house(Mesh& mesh, const vec3& middle, Dice& dice) {
  const float w = dice(4, 6), d = dice(4, 7), eaves = dice(4, 9), ridge = eaves + dice(2, 4),
              angle = dice(-0.5f, 0.5f), c = std::cos(angle), s = std::sin(angle);
  const auto at = [&](float x, float y, float z) { return middle + vec3(c * x + s * z, y, c * z - s * x); };
  const float x[4] = {-w, w, w, -w}, z[4] = {d, d, -d, -d};
  for (int k = 0; k < 4; ++k) {
    const int next = (k + 1) % 4;
    add_quad(mesh, at(x[k], 0, z[k]), at(x[next], 0, z[next]), at(x[next], eaves, z[next]),
             at(x[k], eaves, z[k]));
  }
  const vec3 front = at(0, ridge, d), back = at(0, ridge, -d);
  add_triangle(mesh, at(-w, eaves, d), at(w, eaves, d), front);
  add_triangle(mesh, at(w, eaves, -d), at(-w, eaves, -d), back);
  add_quad(mesh, at(w, eaves, d), at(w, eaves, -d), back, front);
  add_quad(mesh, at(-w, eaves, -d), at(-w, eaves, d), front, back);
}

Scene scene_of(std::initializer_list<Mesh> meshes) {
  Scene scene;
  scene.materials.emplace_back();
  for (const Mesh& mesh : meshes) {
    scene.nodes.push_back({.name = mesh.name, .mesh = static_cast<int>(scene.meshes.size())});
    scene.meshes.push_back(mesh);
  }
  return scene;
}

float height_at(int column, int row) {
  float height = 0, size = 120, wave = 0.011f;
  for (int octave = 0; octave < 6; ++octave, size *= 0.45f, wave *= 2.1f) {
    const auto x = static_cast<float>(column), z = static_cast<float>(row);
    const float turn = static_cast<float>(octave) * 0.7f;
    height += size * std::sin(wave * (x * std::cos(turn) + z * std::sin(turn)) + 1.3f * turn) *
              std::cos(wave * (z * std::cos(turn) - x * std::sin(turn)));
  }
  return height;
}

}  // namespace

Scene houses_scene(int rows, int columns) {
  constexpr float plot_x = 18, plot_z = 20;
  Mesh houses, floor;
  houses.name = "houses", floor.name = "floor";
  Dice dice;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const vec3 middle(plot_x * static_cast<float>(column), 0, plot_z * static_cast<float>(row));
      add_house(houses, middle + vec3(dice(-1, 1), 0, dice(-1, 1)), dice);
      const float x = plot_x / 2, z = plot_z / 2;
      add_quad(floor, middle + vec3(-x, 0, z), middle + vec3(x, 0, z), middle + vec3(x, 0, -z),
               middle + vec3(-x, 0, -z));
    }
  return scene_of({houses, floor});
}

Scene terrain_scene(int quads, int middle) {
  constexpr float cell = 10;
  Mesh around, inner;
  around.name = "around", inner.name = "middle";
  const auto at = [&](int column, int row) {
    return vec3(cell * static_cast<float>(column - quads / 2), height_at(column, row),
                cell * static_cast<float>(row - quads / 2));
  };
  const int first = (quads - middle) / 2, end = first + middle;
  for (int row = 0; row < quads; ++row)
    for (int column = 0; column < quads; ++column) {
      const bool inside = row >= first && row < end && column >= first && column < end;
      add_quad(inside ? inner : around, at(column, row + 1), at(column + 1, row + 1), at(column + 1, row),
               at(column, row));
    }
  return scene_of({around, inner});
}

namespace {

sun::Suns suns_in_munich(const char* first, const char* last, int every, double step_min) {
  sun::SunTimes times;
  times.place = {48.14, 11.58};
  times.days = {*sun::parse_day(first), *sun::parse_day(last), every};
  times.step_min = step_min;
  return *sun::suns_of(times);
}

}  // namespace

sun::Suns suns_of_day(double step_min) {
  return suns_in_munich("2026-06-21", "2026-06-21", 1, step_min);
}
sun::Suns suns_of_year(int every, double step_min) {
  return suns_in_munich("2026-01-01", "2026-12-31", every, step_min);
}

}  // namespace tenebra::bench
