// Choices of options in which every two values of two options meet.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "support/seeded_random.h"

namespace tenebra::testing {

/// One value of each option, as its index.
using Choice = std::vector<std::size_t>;

inline Choice choose_at_random(std::span<const std::size_t> counts, Random& random) {
  Choice choice;
  for (const std::size_t count : counts) choice.push_back(random.index(static_cast<std::uint32_t>(count)));
  return choice;
}

/// Choices such that any two values of two options occur together in at least one, as few as a greedy search
/// finds: each next one is the best of some random ones that hold a pair still to come. `counts`: how many
/// values each option has.
inline std::vector<Choice> all_pairs(std::span<const std::size_t> counts, Random random) {
  constexpr int candidates = 200;
  std::vector<std::size_t> first{0};  // of an option's values among all values
  for (const std::size_t count : counts) first.push_back(first.back() + count);
  const std::size_t values = first.back(), options = counts.size();
  std::vector<bool> missing(values * values, false);
  std::size_t left = 0;
  for (std::size_t a = 0; a < options; ++a)
    for (std::size_t b = a + 1; b < options; ++b)
      for (std::size_t i = first[a]; i < first[a + 1]; ++i)
        for (std::size_t j = first[b]; j < first[b + 1]; ++j) missing[i * values + j] = true, ++left;

  const auto each_new_pair = [&](const Choice& choice, const auto& see) {
    for (std::size_t a = 0; a < options; ++a)
      for (std::size_t b = a + 1; b < options; ++b)
        if (const std::size_t pair = (first[a] + choice[a]) * values + first[b] + choice[b]; missing[pair])
          see(pair);
  };
  const auto with_a_new_pair = [&] {
    Choice choice = choose_at_random(counts, random);
    std::size_t pair = random.bits() % missing.size();
    while (!missing[pair]) pair = (pair + 1) % missing.size();
    for (std::size_t option = 0; option < options; ++option)
      for (const std::size_t value : {pair / values, pair % values})
        if (value >= first[option] && value < first[option + 1]) choice[option] = value - first[option];
    return choice;
  };
  std::vector<Choice> found;
  while (left > 0) {
    Choice best;
    std::size_t most = 0;
    for (int i = 0; i < candidates; ++i) {
      const Choice choice = with_a_new_pair();
      std::size_t pairs = 0;
      each_new_pair(choice, [&](std::size_t) { ++pairs; });
      if (pairs > most) most = pairs, best = choice;
    }
    each_new_pair(best, [&](std::size_t pair) { missing[pair] = false; });
    left -= most;
    found.push_back(std::move(best));
  }
  return found;
}

}  // namespace tenebra::testing
