// The front of a trade, its page and plot; and the depth cube that hard shadows are compared with.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <array>

#include <tenebra/threads.h>

#include "bench/hard/hard_views.h"
#include "bench/trade/trade_advice.h"
#include "bench/trade/trade_contest.h"
#include "bench/trade/trade_crops.h"
#include "bench/trade/trade_shadow_map.h"

namespace tenebra::bench {
namespace {

TradeTable table_of(std::vector<std::pair<double, double>> points, double none_below = 0) {
  TradeTable table{"soft", "a view", {{"RMS", "1/255"}}, {}, none_below};
  for (const auto& [ms, error] : points)
    table.points.push_back({"rays", std::to_string(table.points.size()), {{1, ms}}, {error}});
  mark_front(table.points, none_below);
  return table;
}

std::string fronts(const TradeTable& table) {
  std::string text;
  for (const TradePoint& p : table.points) text += p.times[0].front ? '*' : '-';
  return text;
}

TEST(TradeTable, TheFrontHoldsWhatNothingBeats) {
  EXPECT_EQ(fronts(table_of({{1, 9}, {2, 5}, {3, 7}, {4, 0}, {5, 0}})), "**-*-");
  EXPECT_EQ(fronts(table_of({{1, 1}})), "*");
  EXPECT_EQ(fronts(table_of({{1, 1}, {1, 1}})), "**") << "none is better";
  EXPECT_EQ(fronts(table_of({{1, 2}, {1, 1}, {2, 1}})), "-*-")
      << "as fast but less exact, as exact but slower";
  EXPECT_EQ(fronts(table_of({{1, 0.005}, {2, 0}, {0.5, 0.02}}, 0.01)), "*-*")
      << "beneath the floor all alike";
}

TEST(TradeTable, EachNumberOfThreadsHasAFrontOfItsOwn) {
  TradeTable table{"soft", "a view", {{"RMS", "1/255"}}, {}};
  table.points = {{"a", "", {{1, 4}, {2, 3}}, {1}}, {"b", "", {{1, 5}, {2, 2}}, {1}}};
  mark_front(table.points, 0);
  EXPECT_TRUE(table.points[0].times[0].front && !table.points[0].times[1].front);
  EXPECT_TRUE(!table.points[1].times[0].front && table.points[1].times[1].front);
}

/// A contestant that says how long it takes.
Contestant saying(double ms, int& runs, std::vector<int>& threads) {
  return {"rays", "",
          [ms, &runs, &threads]() -> Expected<double> {
            ++runs;
            threads.push_back(thread_count());
            return ms;
          },
          [] { return std::vector<double>{1}; }};
}

TEST(TradeContest, SlowSettingsRunLessOften) {
  int quick = 0, slow = 0;
  std::vector<int> quick_on, slow_on;
  const auto points = take_turns({saying(10, quick, quick_on), saying(60, slow, slow_on)}, {{1, 2}, 5, 100});
  ASSERT_TRUE(points);
  EXPECT_EQ(quick, 10);
  EXPECT_EQ(slow, 4) << "two times 60 are enough, on each number of threads";
  EXPECT_EQ(slow_on, (std::vector{1, 2, 1, 2}));
  ASSERT_EQ((*points)[1].times.size(), 2u);
  EXPECT_EQ((*points)[1].times[1].threads, 2);
  EXPECT_EQ((*points)[1].times[1].ms, 60);
}

TEST(TradeContest, MemoryIsThatOfTheFirstRunAndOfWhatWasMade) {
  std::vector<char> kept, shared(5'000'000);
  const auto run = [&]() -> Expected<double> {
    kept.resize(3'000'000);
    shared.resize(5'000'000);
    std::vector<char>(4'000'000).swap(shared);  // for a moment there are both
    return 1;
  };
  Contestant contestant{"rays", "", run, [] { return std::vector<double>{0}; }};
  contestant.forget = [&] { shared = std::vector<char>(); };
  contestant.made_mb = 2;
  const auto points = take_turns({contestant}, {{1}, 3, 100});
  ASSERT_TRUE(points);
  EXPECT_NEAR((*points)[0].mb, 2 + 3 + 5 + 4, 0.1);
}

TEST(TradeCrops, AreOfSettingsNearToTheErrorsWhereTheyStandOut) {
  std::vector<TradePoint> points;
  for (const double error : {0.0, 0.1, 0.6, 3.0, 7.0, 50.0})
    points.push_back({"rays", fmt::format("{}", error), {{1, 1}}, {error}});
  points.push_back({"others", "", {{1, 1}}, {8}});
  constexpr std::array<const char*, 1> families{"rays"};
  const auto chosen = crop_settings(points, families);
  ASSERT_EQ(chosen.size(), 3u);
  EXPECT_EQ(chosen[0]->setting + " " + chosen[1]->setting + " " + chosen[2]->setting, "0.6 3 7");

  constexpr std::size_t width = 60, height = 40;
  std::vector<float> exact(width * height, 0.5f), off = exact, errors(exact.size());
  errors[30 * width + 50] = errors[5 * width + 5] = 1;
  off[30 * width + 50] = 1;                                             // 16 times an error of a half: white
  for (std::size_t x = 0; x < 10; x += 2) exact[5 * width + x] = 0.9f;  // where an error does not stand out
  const CropPlace place = plainest_place(errors, exact, width, 24);
  EXPECT_TRUE(place.x <= 50 && 50 < place.x + 24 && place.y <= 30 && 30 < place.y + 24) << place.x;
  const std::vector<CropPicture> pictures{{chosen[0], off}};
  const TradeCrops crops = make_crops(place, exact, pictures);
  EXPECT_EQ(crops.image.width, 24 + 4 + 24);
  EXPECT_EQ(crops.image.height, 24 + 4 + 24);
  EXPECT_EQ(crops.caption, "exact; rays, 0.6: 0.600 /255");
  const auto at = [&](std::size_t x, std::size_t y) {
    return crops.image.pixels[y * static_cast<std::size_t>(crops.image.width) + x];
  };
  const std::size_t x = 50 - place.x, y = 30 - place.y;
  EXPECT_EQ(at(x, y), 188) << "exact, as sRGB";
  EXPECT_EQ(at(28 + x, y), 255);
  EXPECT_EQ(at(28 + x, 28 + y), 255) << "its error";
  EXPECT_EQ(at(28 + (x + 1) % 24, 28 + y), 0);
}

TEST(TradeTable, NumbersHaveThreeDigitsThatMatter) {
  EXPECT_EQ(short_number(0), "0");
  EXPECT_EQ(short_number(12345.6), "12346");
  EXPECT_EQ(short_number(123.4), "123");
  EXPECT_EQ(short_number(12.34), "12.3");
  EXPECT_EQ(short_number(1.234), "1.23");
  EXPECT_EQ(short_number(0.1234), "0.123");
  EXPECT_EQ(short_number(0.01234), "0.0123");
  EXPECT_EQ(short_number(7), "7");
  EXPECT_EQ(short_number(2.4e-5), "2e-05");
}

TEST(TradeTable, ThePlotRingsTheFrontAndPutsWhatIsExactAtTheFoot) {
  const std::string plot = trade_plot(table_of({{1, 9}, {2, 5}, {3, 7}, {4, 0}}));
  std::size_t rings = 0;
  for (std::size_t at = plot.find("r=\"8\""); at != std::string::npos; at = plot.find("r=\"8\"", at + 1))
    ++rings;
  EXPECT_EQ(rings, 4u) << "three on the front, one in the legend";
  EXPECT_NE(plot.find(">0</text>"), std::string::npos);
  EXPECT_EQ(trade_plot(table_of({{1, 9}, {2, 5}})).find(">0</text>"), std::string::npos)
      << "nothing is exact";
  EXPECT_EQ(trade_plot(table_of({{2, 3}})).find("nan"), std::string::npos) << "one point spans no scale";
}

TEST(TradeTable, AdviceSaysWhereFiguresAreMissing) {
  const TradeTable table = table_of({{1, 9}});
  for (const std::string& text : {hard_advice({&table}), soft_advice({&table}), ao_advice({&table})})
    EXPECT_NE(text.find(" - "), std::string::npos) << text;
  EXPECT_EQ(hard_advice({}).find("nan"), std::string::npos);
}

/// A plate over a floor below a light, seen from aside.
HardView plate_view(int side) {
  HardView view;
  view.frame.geometry.positions = {{-8, 0, -8}, {-8, 0, 8}, {8, 0, 8}, {8, 0, -8},
                                   {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}, {1, 1, -1}};
  view.frame.geometry.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
  view.frame.geometry.normals.assign(8, {0, 1, 0});
  view.frame.geometry.casts_shadow.assign(4, 1);
  view.frame.geometry.materials.assign(4, 0);
  view.frame.diagonal_m = 22;
  view.frame.view = look_at({3, 6, 7}, {0, 0, 0}, {0, 1, 0}, 0.8f, 0.1f, side, side);
  view.light.position = {0.437f, 5.1f, 0.271f};
  return view;
}

TEST(TradeShadowMap, ErrsAtEdgesWithABiasAndEverywhereWithoutOne) {
  auto raster = TradeRaster::create();
  ASSERT_TRUE(raster) << raster.error().message;
  constexpr int side = 200;
  HardView view = plate_view(side);
  std::vector<std::uint32_t> ids;
  std::vector<float> depth;
  ASSERT_TRUE(raster->draw(view.frame.geometry, view.frame.view, side, side, ids, depth));
  compute_visible_points(ids, side, side, view.frame.view, view.frame.triangles(), view.frame.points);
  ShadowMask exact, mask;
  ShadowTracer tracer;
  tracer.trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, {}, exact);
  const auto shadowed = std::count(exact.begin(), exact.end(), 0),
             lit = std::count(exact.begin(), exact.end(), 255);
  ASSERT_GT(shadowed, 500);
  ASSERT_GT(lit, 5000);
  std::size_t before = exact.size();
  for (const int size : {128, 1024}) {
    DepthMap map;
    ASSERT_TRUE(raster->draw_cube(view.frame.geometry, view.light.position, 0.01f, size, map));
    const ShadowMapBias best = best_bias(map, view, exact);
    EXPECT_GT(best.texels, 0);
    shadow_from_map(map, view, best, mask);
    const std::size_t wrong = differing_pixels(mask, exact);
    EXPECT_LT(wrong, before) << "the finer the better";
    before = wrong;
    shadow_from_map(map, view, {}, mask);
    EXPECT_GT(differing_pixels(mask, exact), 10 * (wrong + 10)) << "acne";
    shadow_from_map(map, view, {1e4}, mask);
    EXPECT_EQ(std::count(mask.begin(), mask.end(), 0) - std::count(ids.begin(), ids.end(), no_triangle), 0)
        << "so large a bias leaves no shadow";
  }
  EXPECT_LT(before, 60u) << "along the edges of the shadow alone";
}

TEST(TradeShadowMap, OfASunErrsAtEdgesAlone) {
  auto raster = TradeRaster::create();
  ASSERT_TRUE(raster) << raster.error().message;
  constexpr int side = 200;
  HardView view = plate_view(side);
  view.light = {};
  view.light.directional = true;
  view.light.to_light = {0.3f, 1.0f, 0.2f};
  std::vector<std::uint32_t> ids;
  std::vector<float> depth;
  ASSERT_TRUE(raster->draw(view.frame.geometry, view.frame.view, side, side, ids, depth));
  compute_visible_points(ids, side, side, view.frame.view, view.frame.triangles(), view.frame.points);
  ShadowMask exact, mask;
  ShadowTracer().trace_shadow_mask(view.frame.points, view.frame.triangles(), view.light, {}, exact);
  const auto seen = std::count_if(ids.begin(), ids.end(), [](auto id) { return id != no_triangle; });
  const auto shadowed = seen - std::count(exact.begin(), exact.end(), 255);
  ASSERT_GT(shadowed, 500);
  DepthMap map;
  ASSERT_TRUE(raster->draw_sun(view.frame.geometry, view.light.to_light, 1024, map));
  shadow_from_map(map, view, best_bias(map, view, exact), mask);
  EXPECT_LT(differing_pixels(mask, exact), 100u);
  EXPECT_LT(differing_pixels(mask, exact), static_cast<std::size_t>(shadowed) / 5);
  shadow_from_map(map, view, {}, mask);
  EXPECT_GT(differing_pixels(mask, exact), 1000u) << "acne";
}

// The texels of all six faces: a map holds the distance of what lies in their directions.
TEST(TradeShadowMap, FacesLookAlongTheirAxes) {
  auto raster = TradeRaster::create();
  ASSERT_TRUE(raster) << raster.error().message;
  for (int face = 0; face < 6; ++face) {
    const CubeFace c = cube_face(face);
    FrameGeometry geometry;
    const glm::vec3 at = 3.0f * c.axis + 0.5f * c.u + 1.5f * c.v;
    geometry.positions = {at - 0.2f * c.u - 0.2f * c.v, at + 0.4f * c.u, at + 0.4f * c.v};
    geometry.triangles = {{0, 1, 2}};
    geometry.normals.assign(3, {0, 1, 0});
    geometry.casts_shadow = {1};
    geometry.materials = {0};
    DepthMap map;
    ASSERT_TRUE(raster->draw_cube(geometry, {0, 0, 0}, 0.01f, 96, map));
    EXPECT_NEAR(map.distance(face, 48 + 8, 48 + 24), 3, 1e-4) << face;
    EXPECT_TRUE(std::isinf(map.distance(face, 48 - 8, 48 + 24))) << face;
    EXPECT_TRUE(std::isinf(map.distance(face ^ 1, 48 + 8, 48 + 24))) << face;
    geometry.casts_shadow = {0};
    ASSERT_TRUE(raster->draw_cube(geometry, {0, 0, 0}, 0.01f, 96, map));
    EXPECT_TRUE(std::isinf(map.distance(face, 48 + 8, 48 + 24))) << "what casts nothing is not drawn";
  }
}

}  // namespace
}  // namespace tenebra::bench
