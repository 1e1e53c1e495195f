// A small animated scene on disk for the tests of the program: a blocker that moves over a floor for ten
// seconds.
#pragma once

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "support/child_process.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

inline constexpr int moving_scene_frames = 301;  // 10 s at 30 frames per second, both ends included
inline constexpr int moving_scene_triangles = 3;

/// floor (2 triangles) at y = 0, blocker (1 triangle) at y = 1; camera "eye"; `lights` point lights 3 m
/// above. It states its ambient light, so its pictures are exposed by 1.
inline std::filesystem::path write_moving_scene(const TemporaryFolder& folder, int lights = 1) {
  const std::array<float, 9 * 3> corners{-4, 0, -4, -4, 0, 4, 4,  0,  -4, 4, 0, -4, -4, 0,
                                         4,  4, 0,  4,  0, 0, -1, -1, 0,  1, 1, 0,  1};
  const std::array<float, 2> times{0, 10};
  const std::array<float, 6> places{-1, 1, 0, 1, 1, 0};
  const auto bytes = [](const auto& values) {
    return std::string(reinterpret_cast<const char*>(values.data()), sizeof(values));
  };
  write_text(folder / "moving.bin", bytes(corners) + bytes(times) + bytes(places));
  std::string light_list;
  std::string light_nodes;
  std::string roots = "0,1,2";
  for (int i = 0; i < lights; ++i) {
    const std::string number = std::to_string(i);
    light_list.append(i == 0 ? "" : ",").append(R"({"type":"point","intensity":10})");
    light_nodes.append(R"(,{"translation":[)").append(number);
    light_nodes.append(R"(,3,0],"extensions":{"KHR_lights_punctual":{"light":)").append(number).append("}}}");
    roots.append(",").append(std::to_string(3 + i));
  }
  write_text(folder / "moving.gltf", R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)" + roots +
                                         R"(],"extras":{"ambient_light":[0.1,0.1,0.101]}}],
"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[)" +
                                         light_list + R"(]}},
"nodes":[{"name":"floor","mesh":0},{"name":"blocker","mesh":1},
{"name":"eye","camera":0,"translation":[0,2,6],"rotation":[-0.1564345,0,0,0.9876883]})" +
                                         light_nodes + R"(],
"cameras":[{"name":"eye","type":"perspective","perspective":{"yfov":0.8,"znear":0.1}}],
"meshes":[{"name":"floor","primitives":[{"attributes":{"POSITION":0},"material":0}]},
{"name":"blocker","primitives":[{"attributes":{"POSITION":1},"material":0}]}],
"materials":[{"pbrMetallicRoughness":{"baseColorFactor":[0.2,0.2,0.2,1]}}],
"animations":[{"name":"slide","samplers":[{"input":2,"output":3}],
"channels":[{"sampler":0,"target":{"node":1,"path":"translation"}}]}],
"accessors":[
{"bufferView":0,"componentType":5126,"count":6,"type":"VEC3","min":[-4,0,-4],"max":[4,0,4]},
{"bufferView":1,"componentType":5126,"count":3,"type":"VEC3","min":[-1,0,-1],"max":[1,0,1]},
{"bufferView":2,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[10]},
{"bufferView":3,"componentType":5126,"count":2,"type":"VEC3"}],
"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":72},{"buffer":0,"byteOffset":72,"byteLength":36},
{"buffer":0,"byteOffset":108,"byteLength":8},{"buffer":0,"byteOffset":116,"byteLength":24}],
"buffers":[{"uri":"moving.bin","byteLength":140}]})");
  return folder / "moving.gltf";
}

/// The program with `arguments`.
inline ProgramResult tenebra(std::vector<std::string> arguments, const std::function<void()>& prepare = {}) {
  arguments.insert(arguments.begin(), TENEBRA_PROGRAM);
  return run_program(arguments, prepare);
}

/// True if `text` is one line that begins with "tenebra: ".
inline bool is_one_sentence(const std::string& text) {
  return text.starts_with("tenebra: ") && text.ends_with("\n") && text.find('\n') == text.size() - 1;
}

}  // namespace tenebra::testing
