// Materials outlive closing braces: a scanner of its own reads the kitchen's text by both rules.
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "formats/import_scene.h"
#include "support/bart.h"
#include "support/temporary_folder.h"

namespace tenebra {
namespace {

/// Material in force at each `m`, if braces let it be and if they restored it.
class MaterialScanner {
public:
  struct Mesh {
    std::vector<double> kept, restored;
  };

  explicit MaterialScanner(std::filesystem::path folder) : folder_(std::move(folder)) {}

  void read(const std::string& file) {
    std::istringstream text(testing::read_text(folder_ / file));
    std::vector<std::string> words;
    for (std::string line, word; std::getline(text, line);) {
      std::istringstream rest(line.substr(0, line.find('#')));
      while (rest >> word) words.push_back(word);
    }
    for (std::size_t i = 0; i < words.size(); ++i) {
      if (words[i] == "fm") {
        kept_.clear();
        for (int k = 0; k < 12; ++k) kept_.push_back(std::stod(words.at(++i)));
        restored_ = kept_;
      } else if (words[i] == "m") {
        meshes.push_back({kept_, restored_});
      } else if (words[i] == "{") {
        outer_.push_back(restored_);
      } else if (words[i] == "}") {
        restored_ = outer_.back();
        outer_.pop_back();
      } else if (words[i] == "i") {
        i += 2;
        read(words.at(i));
      } else if (words[i] == "x" || words[i] == "k") {
        ++i;
      }
    }
  }

  std::vector<Mesh> meshes;

private:
  std::filesystem::path folder_;
  std::vector<double> kept_, restored_;
  std::vector<std::vector<double>> outer_;
};

TEST(AffMaterials, OutliveClosingBraces) {
  const auto folder = testing::bart_folder() / "kitchen";
  MaterialScanner scanner(folder);
  scanner.read("kitchen.aff");
  const auto scene = formats::import_aff(folder / "kitchen.aff", {});
  ASSERT_TRUE(scene.has_value()) << scene.error().message;
  ASSERT_EQ(scene->meshes.size(), scanner.meshes.size());
  int differ = 0;
  for (std::size_t i = 0; i < scene->meshes.size(); ++i) {
    const auto& [kept, restored] = scanner.meshes[i];
    differ += kept != restored;
    ASSERT_FALSE(scene->meshes[i].materials.empty());
    const Material& material = scene->materials[scene->meshes[i].materials[0]];
    for (int k = 0; k < 3; ++k) {
      EXPECT_EQ(material.ambient[k], static_cast<float>(kept[static_cast<std::size_t>(k)]))
          << scene->meshes[i].source;
      EXPECT_EQ(material.base_color[k], static_cast<float>(kept[static_cast<std::size_t>(k) + 3]));
    }
  }
  EXPECT_EQ(differ, 28);
}

}  // namespace
}  // namespace tenebra
