// A second reader of GLB files that shares no code with Tenebra's: chunks, JSON and accessors by hand.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

namespace tenebra::testing {

class SecondReader {
public:
  explicit SecondReader(std::string bytes) : bytes_(std::move(bytes)) {
    const std::uint32_t json_length = word(12);
    root = nlohmann::json::parse(bytes_.substr(20, json_length));
    binary_ = 20 + json_length + 8;
  }

  nlohmann::json root;

  /// Numbers of an accessor of floats or unsigned integers, tightly packed.
  std::vector<double> numbers(const nlohmann::json& index) const {
    const auto& accessor = root["accessors"][index.get<std::size_t>()];
    const auto& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    const std::size_t at = binary_ + view["byteOffset"].get<std::size_t>();
    const int type = accessor["componentType"];
    const std::size_t size = type == 5123 ? 2 : 4;
    std::vector<double> values(accessor["count"].get<std::size_t>() * width(accessor));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const char* from = bytes_.data() + at + i * size;
      values[i] = type == 5126   ? double{read<float>(from)}
                  : type == 5123 ? read<std::uint16_t>(from)
                                 : read<std::uint32_t>(from);
    }
    return values;
  }

  static std::size_t width(const nlohmann::json& accessor) {
    const std::string type = accessor["type"];
    return type == "SCALAR" ? 1 : type == "MAT4" ? 16 : static_cast<std::size_t>(type[3] - '0');
  }

  void check() const {
    check_container();
    check_accessors();
    check_meshes();
    check_nodes();
    check_animations();
  }

  /// Triangles that the nodes of the scene show.
  std::size_t triangles() const {
    std::size_t count = 0;
    for (const auto& node : list(root, "nodes"))
      if (node.contains("mesh"))
        for (const auto& primitive : root["meshes"][node["mesh"].get<std::size_t>()]["primitives"])
          count += root["accessors"][primitive["indices"].get<std::size_t>()]["count"].get<std::size_t>() / 3;
    return count;
  }

private:
  template <class T>
  static T read(const char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
  }
  std::uint32_t word(std::size_t at) const { return read<std::uint32_t>(bytes_.data() + at); }

  static nlohmann::json list(const nlohmann::json& object, const char* name) {
    return object.contains(name) ? object[name] : nlohmann::json::array();
  }

  void check_container() const {
    EXPECT_EQ(bytes_.substr(0, 4), "glTF");
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes_.size());
    EXPECT_EQ(word(12) % 4, 0u);
    EXPECT_EQ(bytes_.size() - binary_, word(binary_ - 8));
    EXPECT_EQ(root["buffers"][0]["byteLength"], bytes_.size() - binary_);
  }

  void check_accessors() const {
    for (std::size_t i = 0; i < root["accessors"].size(); ++i) {
      const auto& accessor = root["accessors"][i];
      const auto& view = root["bufferViews"][accessor["bufferView"].get<std::size_t>()];
      const std::size_t offset = view["byteOffset"], length = view["byteLength"];
      const std::size_t size = accessor["componentType"] == 5123 ? 2 : 4;
      ASSERT_EQ(offset % 4, 0u);
      ASSERT_LE(offset + length, bytes_.size() - binary_);
      ASSERT_EQ(accessor["count"].get<std::size_t>() * width(accessor) * size, length);
      ASSERT_GT(accessor["count"], 0);
      if (accessor.contains("min")) check_bounds(accessor, numbers(i));
    }
  }

  static void check_bounds(const nlohmann::json& accessor, const std::vector<double>& values) {
    const std::size_t n = width(accessor);
    for (std::size_t c = 0; c < n; ++c) {
      double low = values[c], high = values[c];
      for (std::size_t k = c; k < values.size(); k += n)
        low = std::min(low, values[k]), high = std::max(high, values[k]);
      ASSERT_EQ(accessor["min"][c].get<double>(), low);
      ASSERT_EQ(accessor["max"][c].get<double>(), high);
    }
  }

  void check_meshes() const {
    for (const auto& mesh : root["meshes"])
      for (const auto& primitive : mesh["primitives"]) {
        const auto& position = root["accessors"][primitive["attributes"]["POSITION"].get<std::size_t>()];
        ASSERT_TRUE(position.contains("min"));
        ASSERT_LT(primitive["material"], root["materials"].size());
        std::vector<bool> used(position["count"].get<std::size_t>(), false);
        for (const double index : numbers(primitive["indices"])) {
          ASSERT_LT(index, used.size());
          used[static_cast<std::size_t>(index)] = true;
        }
        ASSERT_EQ(std::count(used.begin(), used.end(), false), 0) << "vertices that no triangle uses";
        for (const auto& target : list(primitive, "targets"))
          for (const auto& accessor : target)
            ASSERT_EQ(root["accessors"][accessor.get<std::size_t>()]["count"], used.size());
        for (const auto& accessor : primitive["attributes"])
          ASSERT_EQ(root["accessors"][accessor.get<std::size_t>()]["count"], used.size());
        if (primitive["attributes"].contains("NORMAL"))
          check_unit(numbers(primitive["attributes"]["NORMAL"]), 3);
      }
  }

  static void check_unit(const std::vector<double>& values, std::size_t width) {
    for (std::size_t i = 0; i < values.size(); i += width) {
      double square = 0;
      for (std::size_t c = 0; c < width; ++c) square += values[i + c] * values[i + c];
      ASSERT_NEAR(square, 1, 1e-5);
    }
  }

  void check_nodes() const {
    const std::size_t count = root["nodes"].size();
    std::vector<int> parents(count, 0);
    for (const auto& node : root["nodes"])
      for (const auto& child : list(node, "children")) ++parents[child.get<std::size_t>()];
    for (const auto& node : root["scenes"][0]["nodes"]) ++parents[node.get<std::size_t>()];
    EXPECT_EQ(std::count(parents.begin(), parents.end(), 1), static_cast<std::ptrdiff_t>(count));
  }

  void check_animations() const {
    for (const auto& animation : list(root, "animations")) {
      for (const auto& sampler : animation["samplers"]) {
        const std::vector<double> times = numbers(sampler["input"]);
        ASSERT_GE(times[0], 0);
        for (std::size_t i = 1; i < times.size(); ++i) ASSERT_GT(times[i], times[i - 1]);
      }
      std::set<std::string> driven;
      for (const auto& channel : animation["channels"]) check_channel(animation, channel, driven);
    }
  }

  void check_channel(const nlohmann::json& animation, const nlohmann::json& channel,
                     std::set<std::string>& driven) const {
    const auto& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
    const auto& node = root["nodes"][channel["target"]["node"].get<std::size_t>()];
    const std::string path = channel["target"]["path"];
    ASSERT_TRUE(driven.insert(channel["target"].dump()).second) << "driven twice";
    ASSERT_TRUE(path == "weights" || !node.contains("matrix"));
    std::size_t values = sampler["interpolation"] == "CUBICSPLINE" ? 3 : 1;
    if (path == "weights")
      values *= root["meshes"][node["mesh"].get<std::size_t>()]["primitives"][0]["targets"].size();
    const auto& output = root["accessors"][sampler["output"].get<std::size_t>()];
    ASSERT_EQ(output["type"], path == "weights" ? "SCALAR" : path == "rotation" ? "VEC4" : "VEC3");
    ASSERT_EQ(output["count"].get<std::size_t>(),
              values * root["accessors"][sampler["input"].get<std::size_t>()]["count"].get<std::size_t>());
    if (path == "rotation" && values == 1) check_unit(numbers(sampler["output"]), 4);
  }

  std::string bytes_;
  std::size_t binary_ = 0;
};

}  // namespace tenebra::testing
