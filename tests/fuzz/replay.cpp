// A fuzzer without libFuzzer: gives the inputs of a folder, and then changed ones for some seconds, to the
// fuzzer that it is linked with. It does not see what code they reach, as tools/fuzz.sh does, but any
// compiler builds it. Usage: replay_NAME SECONDS FOLDER. The input at hand lies in NAME.input, in the working
// directory, until all are done.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size);

namespace {

namespace fs = std::filesystem;
using Input = std::string;

constexpr std::size_t longest = 65536;  // as tools/fuzz.sh has it

std::vector<Input> inputs_of(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::vector<Input> inputs;
  for (const fs::path& path : files) {
    std::ifstream file(path, std::ios::binary);
    inputs.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return inputs;
}

/// Changes inputs at random; the same ones in every run.
class Changes {
public:
  /// One of `inputs` with one to eight changes.
  Input next(const std::vector<Input>& inputs) {
    Input input = inputs[below(inputs.size())];
    for (std::size_t i = 1 + below(8); i > 0; --i) change(input, inputs[below(inputs.size())]);
    input.resize(std::min(input.size(), longest));
    return input;
  }

private:
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(random_() % count); }

  void change(Input& input, const Input& other) {
    static const std::string words[] = {"0",
                                        "-1",
                                        "255",
                                        "65536",
                                        "4294967295",
                                        "1e39",
                                        "-1e-39",
                                        "nan",
                                        std::string(4, '\xff'),
                                        std::string(8, '\0'),
                                        "\"\"",
                                        "[]",
                                        "{}",
                                        "\n"};
    const std::size_t at = below(input.size() + 1),
                      end = at + below(std::min<std::size_t>(input.size() - at, 64) + 1);
    switch (below(6)) {
      case 0:
        if (at < input.size()) input[at] = static_cast<char>(input[at] ^ 1 << below(8));
        break;
      case 1:
        if (at < input.size()) input[at] = static_cast<char>(below(256));
        break;
      case 2:
        input.erase(at, end - at);
        break;
      case 3:
        input.insert(at, input.substr(at, end - at));
        break;
      case 4:
        input.replace(at, end - at, words[below(std::size(words))]);
        break;
      default: {
        const std::size_t from = below(other.size() + 1);
        input.replace(at, end - at, other, from, below(64));
      }
    }
  }

  std::mt19937_64 random_{1};
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 3) {
    std::fprintf(stderr, "expected SECONDS FOLDER\n");
    return 2;
  }
  const std::vector<Input> inputs = inputs_of(arguments[2]);
  if (inputs.empty()) {
    std::fprintf(stderr, "%s has no inputs\n", arguments[2]);
    return 2;
  }
  const fs::path at_hand = fs::path(arguments[0]).filename().string() + ".input";
  const auto run = [&](const Input& input) {
    std::ofstream(at_hand, std::ios::binary) << input;
    LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  };
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(arguments[1]));
  for (const Input& input : inputs) run(input);
  Changes changes;
  std::size_t changed = 0;
  for (; std::chrono::steady_clock::now() < end; ++changed) run(changes.next(inputs));
  fs::remove(at_hand);
  std::printf("%zu inputs, %zu changed ones\n", inputs.size(), changed);
  return 0;
}
