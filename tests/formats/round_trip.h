// A scene written to a file and read again.
#pragma once

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "formats/import_scene.h"
#include "glb_second_reader.h"
#include "support/temporary_folder.h"

namespace tenebra::testing {

struct RoundTrip {
  Scene back;
  std::vector<std::string> losses;
  nlohmann::json root;  ///< of the file
};

inline RoundTrip round_trip(const Scene& scene) {
  const TemporaryFolder folder;
  auto losses = formats::export_glb(scene, folder / "out.glb");
  EXPECT_TRUE(losses.has_value()) << losses.error().message;
  const SecondReader reader(read_text(folder / "out.glb"));
  reader.check();
  auto back = formats::import_gltf(folder / "out.glb");
  EXPECT_TRUE(back.has_value()) << back.error().message;
  return {std::move(*back), std::move(*losses), reader.root};
}

}  // namespace tenebra::testing
