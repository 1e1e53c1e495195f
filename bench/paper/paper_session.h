// One run of `tenebra-bench paper`: what its parts share and what they add to docs/papers.md.
#pragma once

#include <vector>

#include "bench/common/bench_session.h"
#include "bench/paper/paper_claims.h"

namespace tenebra::bench {

// Titles of the sections.
inline constexpr const char *hard_title = "Hard shadows: Olsson and Assarsson 2011",
                            *soft_title = "Soft shadows: Mora et al. 2012",
                            *ao_title = "Ambient occlusion: Gaitatzes et al. 2010",
                            *bart_title = "BART's rules: Lext, Assarsson and Möller 2001";

struct PaperOptions {
  std::filesystem::path docs;  ///< folder of papers.md and its plots; empty: none
  int stride = 0;              ///< frames of an animation from one that is measured to the next; 0: by effort
};

struct PaperSession : BenchSession {
  using BenchSession::BenchSession;

  PaperOptions paper;
  std::vector<PaperSection> sections;

  /// Frames of an animation of `count`.
  std::vector<int> frames(int count) const {
    const int step = paper.stride > 0 ? paper.stride : by_effort(count / 2, 160, 8);
    std::vector<int> chosen;
    for (int f = 0; f < count; f += step) chosen.push_back(f);
    return chosen;
  }
  /// The first of the scenes that is there; its others stand in for it, and the page says so.
  std::string scene_of(const std::vector<std::string>& names);
  /// Prints what was found and keeps it for the page.
  void finish(PaperSection section);
};

/// papers.md and its plots; sections of parts that were left out stay as they are. Fails where the folder
/// cannot be written.
Expected<void> write_paper_page(const PaperSession& session);

// The parts.
Expected<void> measure_paper_hard(PaperSession& session);  ///< Olsson and Assarsson 2011
Expected<void> measure_paper_soft(PaperSession& session);  ///< Mora et al. 2012
Expected<void> measure_paper_ao(PaperSession& session);    ///< Gaitatzes et al. 2010
Expected<void> measure_paper_bart(PaperSession& session);  ///< Lext et al. 2001: the benchmark's rules

}  // namespace tenebra::bench
