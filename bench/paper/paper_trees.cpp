#include <algorithm>
#include <cmath>

#include "base/stopwatch.h"
#include "bench/paper/paper_soft.h"
#include "parallel/parallel.h"
#include "scene/view_basis.h"
#include "soft/groups/point_groups.h"
#include "soft/occluders/group_frame.h"
#include "soft/shafts/shafts.h"
#include "soft/solve/prepared_group.h"
#include "soft/solve/solvers.h"

namespace tenebra::bench {
namespace {

constexpr double smallest_side_percent = 1;
constexpr std::size_t tile_side = 8;     // pixels
constexpr std::size_t grid_side = 6;     // lights of Figure 10's grid
constexpr float grid_step_percent = 2;   // of the diagonal, between centres
constexpr std::size_t trees_tried = 40;  // for Figure 11

/// The points of one of `every` tiles; the rest sees nothing.
VisiblePoints some_tiles(const VisiblePoints& points, std::size_t every) {
  VisiblePoints some = points;
  const auto width = static_cast<std::size_t>(points.width);
  const std::size_t columns = (width + tile_side - 1) / tile_side;
  for (std::size_t i = 0; i < some.triangles.size(); ++i) {
    const std::size_t tile = i / width / tile_side * columns + i % width / tile_side;
    if (tile * 2654435761u % 4294967296u * every / 4294967296u != 0) some.triangles[i] = no_triangle;
  }
  return some;
}

/// Half of the points lie on triangles that have at most so many.
double points_a_triangle(const VisiblePoints& points) {
  std::vector<std::uint32_t> seen = points.triangles;
  std::erase(seen, no_triangle);
  std::sort(seen.begin(), seen.end());
  std::vector<std::size_t> counts;  // of each visible triangle
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (i == 0 || seen[i] != seen[i - 1]) counts.push_back(0);
    ++counts.back();
  }
  std::sort(counts.begin(), counts.end());
  std::size_t points_so_far = 0;
  for (const std::size_t count : counts) {
    points_so_far += count;
    if (2 * points_so_far >= seen.size()) return static_cast<double>(count);
  }
  return 0;
}

SoftMask trace_light(const SoftView& view, const AreaLight& light, const SoftShadowConfig& config,
                     double& bytes) {
  SoftShadowTracer tracer;
  SoftMask mask;
  tracer.trace(view.frame.points, view.frame.normals, view.frame.triangles(), light, config, mask);
  bytes = std::max(bytes, static_cast<double>(tracer.stats().peak_tree_bytes));
  return mask;
}

/// One visible triangle's points with what may stand before them.
struct TreeTask {
  std::vector<std::uint32_t> pixels;  ///< in scanline order
  std::vector<std::uint32_t> receivers, candidates;
  soft::GroupFrame frame;
};

std::vector<TreeTask> tree_tasks(const SoftView& view, const SoftShadowConfig& config) {
  soft::PointGroups groups;
  const TriangleView triangles = view.frame.triangles();
  soft::group_points(view.frame.points, triangles, view.light, config.grouping, groups);
  std::vector<TreeTask> tasks;
  soft::ShaftCuller culler;
  culler.for_each_family(groups, triangles, view.light, config, nullptr,
                         [&](std::span<const soft::GroupDecision> family, int) {
                           for (const soft::GroupDecision& decision : family) {
                             if (decision.kind != soft::GroupClass::mixed) continue;
                             const soft::PointGroup& group = *decision.group;
                             TreeTask task;
                             const auto pixels = groups.pixels_of(group);
                             task.pixels.assign(pixels.begin(), pixels.end());
                             std::sort(task.pixels.begin(), task.pixels.end());
                             const soft::PointGroup* const of[] = {&group};
                             task.frame = soft::frame_of(of, groups, task.receivers);
                             task.candidates.assign(decision.candidates.begin(), decision.candidates.end());
                             tasks.push_back(std::move(task));
                           }
                         });
  std::sort(tasks.begin(), tasks.end(), [](const TreeTask& a, const TreeTask& b) {
    const std::size_t work_a = a.pixels.size() * a.candidates.size(),
                      work_b = b.pixels.size() * b.candidates.size();
    return work_a != work_b ? work_a > work_b : a.pixels < b.pixels;
  });
  return tasks;
}

/// All queries of one tree, `rows` parts of them in turn.
TreeLife live(const soft::SoftFrame& frame, TreeTask& task, std::size_t rows) {
  task.frame.receivers = task.receivers;
  soft::GroupPreparer preparer(SimdLevel::automatic);
  soft::PreparedGroup group = preparer.prepare(frame, {task.pixels, task.frame, task.candidates});
  group.tree_bytes = std::min(frame.config.tree_bytes, soft::largest_tree_bytes);
  const auto solver = soft::make_bsp_solver(SimdLevel::automatic);
  solver->begin(frame, group);
  TreeLife life;
  life.occluders = static_cast<double>(task.candidates.size());
  const std::span<const std::uint32_t> pixels = task.pixels;
  std::size_t before = 0;
  for (std::size_t row = 1; row <= rows; ++row) {
    const std::size_t count = pixels.size() * row * row / (rows * rows);  // denser at first
    if (count <= before) continue;
    SoftStats stats;
    soft::PixelWriter writer(frame, SoftClass::bsp, stats);
    base::Stopwatch watch;
    solver->solve(frame, group, pixels.subspan(before, count - before), writer);
    const double us = 1000 * watch.lap_ms();
    if (stats.points_clip > 0 || stats.tree_nodes == 0) {
      life.dropped_at = static_cast<double>(before);
      break;
    }
    life.rows.push_back({static_cast<double>(count), us / static_cast<double>(count - before),
                         static_cast<double>(stats.peak_tree_bytes), static_cast<double>(stats.tree_nodes)});
    before = count;
  }
  return life;
}

}  // namespace

SoftShadowConfig mora_config() {
  SoftShadowConfig config;
  config.solver = SoftSolver::bsp;
  config.grouping = SoftGrouping::triangle;
  config.choice = OccluderChoice::random;
  config.tree_bytes = tree_bound_mib << 20;
  return config;
}

TreeView measure_grouping(const SoftView& view) {
  TreeView found;
  found.view = view.name;
  found.triangles = static_cast<double>(view.frame.geometry.triangles.size());
  found.points_a_triangle = points_a_triangle(view.frame.points);
  SoftShadowConfig config = mora_config();
  found.paper = tree_cost(view, view.frame.points, config);
  config.grouping = SoftGrouping::neighbourhood;
  found.neighbourhood = tree_cost(view, view.frame.points, config);
  return found;
}

TreeView measure_trees(const SoftView& view, std::size_t every) {
  TreeView found = measure_grouping(view);
  const VisiblePoints &all = view.frame.points, some = some_tiles(all, every);
  SoftShadowConfig config = mora_config();
  found.kept = tree_cost(view, some, config);
  config.keep_trees = false;
  found.anew = tree_cost(view, some, config);
  config = mora_config();
  config.choice = OccluderChoice::largest;
  found.largest = tree_cost(view, all, config);
  return found;
}

std::vector<GrowthRow> grow_light(const SoftView& view, const std::vector<double>& factors) {
  std::vector<GrowthRow> rows;
  SoftView grown = view;
  for (const double factor : factors) {
    const auto light = square_light(view.frame, smallest_side_percent * std::sqrt(factor));
    if (!light) continue;  // cannot happen: squares of 1 to 10 % are lights wherever one of 4 % is
    grown.light = *light;
    rows.push_back({factor, tree_cost(grown, view.frame.points, mora_config())});
  }
  return rows;
}

std::vector<GrowthRow> add_lights(const SoftView& view, const std::vector<std::size_t>& counts) {
  std::vector<AreaLight> lights;
  const float step_m = 0.01f * grid_step_percent * view.frame.diagonal_m;
  for (std::size_t i = 0; i < grid_side * grid_side; ++i) {
    const float x = static_cast<float>(i % grid_side) - 0.5f * (grid_side - 1);
    const float z = static_cast<float>(i / grid_side) - 0.5f * (grid_side - 1);
    const auto light = square_light(view.frame, smallest_side_percent, step_m * glm::vec3(x, 0, z));
    if (light) lights.push_back(*light);
  }
  std::vector<TreeCost> each;
  SoftView one = view;
  for (const AreaLight& light : lights) {
    one.light = light;
    each.push_back(tree_cost(one, view.frame.points, mora_config()));
  }
  std::vector<GrowthRow> rows;
  for (const std::size_t asked : counts) {
    const std::size_t count = std::min(asked, each.size());
    GrowthRow row{static_cast<double>(count), {}};
    for (std::size_t i = 0; i < count; ++i) {
      const TreeCost& cost = each[i * each.size() / count];  // spread over the grid
      row.cost.ms += cost.ms, row.cost.nodes += cost.nodes;
      row.cost.clipped += cost.clipped, row.cost.by_tree += cost.by_tree;
      row.cost.bytes = std::max(row.cost.bytes, cost.bytes);
    }
    rows.push_back(row);
  }
  return rows;
}

SplitLight split_light(const SoftView& view) {
  SplitLight split;
  const auto whole = square_light(view.frame, 10);
  if (!whole) return split;
  const SoftMask at_once = trace_light(view, *whole, mora_config(), split.whole_bytes);
  const glm::vec3 place = view.frame.lights.front().position;
  const glm::dmat3 basis =
      scene::view_basis(glm::dvec3(view.frame.centre) - glm::dvec3(place), glm::dvec3(0, 1, 0));
  const double quarter_m = 0.0025 * 10 * static_cast<double>(view.frame.diagonal_m);
  std::vector<double> sum(at_once.irradiance.size());
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const glm::vec3 shift(quarter_m * (u * basis[0] + v * basis[1]));
      const auto part = make_rectangle_light(place + shift, glm::vec3(quarter_m * basis[0]),
                                             glm::vec3(-quarter_m * basis[1]));
      if (!part) return split;
      const SoftMask mask = trace_light(view, *part, mora_config(), split.part_bytes);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += static_cast<double>(mask.irradiance[i]);
    }
  }
  const double white =
      static_cast<double>(*std::max_element(at_once.irradiance.begin(), at_once.irradiance.end()));
  for (std::size_t i = 0; i < sum.size() && white > 0; ++i)
    split.difference_255 = std::max(
        split.difference_255, 255 * std::abs(sum[i] - static_cast<double>(at_once.irradiance[i])) / white);
  return split;
}

TreeLife measure_life(const SoftView& view, std::size_t rows) {
  const SoftShadowConfig config = mora_config();
  TreeLife life;
  with_threads(1, [&] {
    std::vector<TreeTask> tasks = tree_tasks(view, config);
    const soft::LightFrame light = soft::light_frame(view.light);
    const TriangleView triangles = view.frame.triangles();
    SoftMask mask;
    mask.visible_fraction.resize(view.frame.pixel_count());
    mask.irradiance.resize(view.frame.pixel_count());
    std::vector<std::uint8_t> classes(view.frame.pixel_count());
    const soft::SoftFrame frame{
        view.frame.points, view.frame.normals, triangles, light, config, mask, classes, nullptr};
    for (std::size_t i = 0; i < std::min(tasks.size(), trees_tried); ++i) {
      TreeLife tried = live(frame, tasks[i], rows);
      const bool better = life.rows.empty() || (life.dropped_at > 0 && tried.dropped_at == 0);
      if (better && !tried.rows.empty()) life = std::move(tried);
      if (!life.rows.empty() && life.dropped_at == 0) break;
    }
  });
  return life;
}

}  // namespace tenebra::bench
