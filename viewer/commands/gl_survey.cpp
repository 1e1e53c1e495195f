#include "commands/gl_survey.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gl/survey.h"
#include "shell/console.h"

namespace tenebra::viewer {
namespace {

using Json = nlohmann::ordered_json;

/// What --raster auto draws by, given what the context is.
const char* raster_of_auto(const std::vector<gl::Offer>& offers) {
  const bool hardware = std::any_of(offers.begin(), offers.end(),
                                    [](const gl::Offer& offer) { return offer.taken && !offer.software; });
  return hardware ? "gl" : "cpu";
}

Json json_of(const gl::Offer& offer) {
  Json json{{"name", offer.name}, {"context", offer.context}, {"taken_by_auto", offer.taken}};
  if (!offer.lacks.empty()) {
    json["lacks"] = offer.lacks;
    return json;
  }
  json["vendor"] = offer.vendor;
  json["renderer"] = offer.renderer;
  json["version"] = offer.version;
  json["software"] = offer.software;
  for (const auto& [name, value] : offer.limits) json["limits"][name] = value;
  return json;
}

void print_text(const gl::Offer& offer) {
  const std::string option = offer.context.empty() ? "" : " (--context " + offer.context + ")";
  if (!offer.lacks.empty()) {
    print_out("{}{}: {}\n", offer.name, option, offer.lacks);
    return;
  }
  print_out("{}{}: {}, {}\n  renderer: {}\n  vendor: {}\n  version: {}\n", offer.name, option,
            offer.software ? "software" : "hardware",
            offer.taken ? "auto takes this one" : "not taken by auto", offer.renderer, offer.vendor,
            offer.version);
  for (const auto& [name, value] : offer.limits) print_out("  {}: {}\n", name, value);
}

}  // namespace

int print_gl_survey(bool json) {
  const std::vector<gl::Offer> offers = gl::survey();
  if (json) {
    Json all{{"offers", Json::array()}, {"raster_auto", raster_of_auto(offers)}};
    for (const gl::Offer& offer : offers) all["offers"].push_back(json_of(offer));
    print_out("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
    return 0;
  }
  for (const gl::Offer& offer : offers) print_text(offer);
  print_out("--raster auto: {}\n", raster_of_auto(offers));
  return 0;
}

}  // namespace tenebra::viewer
