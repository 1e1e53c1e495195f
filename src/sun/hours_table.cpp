#include "sun/hours_table.h"

#include <fmt/format.h>

#include <iterator>
#include <vector>

#include "base/json_string.h"

namespace tenebra::sun {
namespace {

/// A cell of a row: a number as text, or words.
struct Cell {
  std::string text;
  bool is_number = true;
};
using Cells = std::vector<Cell>;

constexpr double hour_min = 60, kilo = 1000;

const char* model_of_suns(SunKind kind) {
  switch (kind) {
    case SunKind::sums:
      return "weights of the suns that are seen";
    case SunKind::minutes:
      return "minutes of an unclouded sun";
    case SunKind::radiation:
      break;
  }
  return "direct normal radiation of a weather file times the cosine to the surface, where the sun is seen";
}

std::vector<std::string> names_of(const Study& study) {
  const ReceiverKind kind = study.receivers.kind;
  std::vector<std::string> names{kind == ReceiverKind::faces   ? "face"
                                 : kind == ReceiverKind::cells ? "cell"
                                                               : "point"};
  if (kind == ReceiverKind::faces) names.insert(names.end(), {"node", "material"});
  names.insert(names.end(), {"x", "y", "z"});
  if (kind != ReceiverKind::points) names.emplace_back("area_m2");
  names.emplace_back(quantity_of(study.suns).name);
  const bool light = study.suns.kind == SunKind::radiation;
  if (study.sky != nullptr) names.emplace_back(light ? "sky_kwh_m2" : "sky");
  if (light) names.emplace_back("hours");
  if (study.suns.timed()) names.insert(names.end(), {"first_sun", "last_sun"});
  if (!study.hours.months.empty())
    for (int month = 1; month <= 12; ++month)
      names.push_back(fmt::format("{}_{:02}", light ? "direct_kwh_m2" : "minutes", month));
  return names;
}

Cell number(double value) {
  return {fmt::format("{:.9g}", value)};
}
Cell coordinate(double value) {  // to micrometres: vertices are floats beside the offset
  std::string text = fmt::format("{:.6f}", value);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return {text == "-0" ? "0" : text};
}

Cell time_of(const Study& study, std::int32_t sun) {
  if (sun < 0) return {"", false};
  return {time_text(study.suns.list[static_cast<std::size_t>(sun)].utc_s, study.suns.zone_min), false};
}

void add_face(const Study& study, const Receiver& receiver, Cells& cells) {
  cells.push_back({std::to_string(receiver.triangle)});
  cells.push_back({study.scene.nodes[static_cast<std::size_t>(receiver.node)].name, false});
  cells.push_back({study.scene.materials[study.frame.materials[receiver.triangle]].name, false});
}

void fill_row(const Study& study, std::size_t i, Cells& cells) {
  const Receiver& receiver = study.receivers.list[i];
  cells.clear();
  if (study.receivers.kind == ReceiverKind::faces)
    add_face(study, receiver, cells);
  else
    cells.push_back({std::to_string(i)});
  const glm::dvec3 place = study.scene.frame.to_file(receiver.centre);
  for (int axis = 0; axis < 3; ++axis) cells.push_back(coordinate(place[axis]));
  if (study.receivers.kind != ReceiverKind::points) cells.push_back(number(receiver.area_m2));
  cells.push_back(number(value_of(study, i)));
  const bool light = study.suns.kind == SunKind::radiation;
  if (study.sky != nullptr) cells.push_back(number(study.sky->light[i] / (light ? kilo : 1)));
  if (light) cells.push_back(number(study.hours.sums[i] / hour_min));
  if (study.suns.timed()) {
    cells.push_back(time_of(study, study.hours.first[i]));
    cells.push_back(time_of(study, study.hours.last[i]));
  }
  for (std::size_t m = 12 * i; m < study.hours.months.size() && m < 12 * i + 12; ++m)
    cells.push_back(number(study.hours.months[m] / (study.hours.light.empty() ? 1 : kilo)));
}

/// In quotes, those within doubled, where the text would be taken for more than one cell.
std::string csv_cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + '"';
}

std::string json_cell(const Cell& cell) {
  if (cell.is_number) return cell.text;
  return cell.text.empty() ? "null" : base::json_string(cell.text);
}

}  // namespace

Quantity quantity_of(const Suns& suns) {
  switch (suns.kind) {
    case SunKind::sums:
      return {"sum", "", "_SUN_SUM", 1};
    case SunKind::minutes:
      return {"hours", "h", "_SUN_HOURS", hour_min};
    case SunKind::radiation:
      break;
  }
  return {"kwh_m2", "kWh/m2", "_SUN_KWH", kilo};
}

double value_of(const Study& study, std::size_t i) {
  const SunHours& hours = study.hours;
  const bool light = study.suns.kind == SunKind::radiation;
  double amount = !light ? hours.sums[i] : hours.light.empty() ? 0 : hours.light[i];
  if (light && study.sky != nullptr) amount += study.sky->light[i];
  return amount / quantity_of(study.suns).per;
}

std::string csv_of(const Study& study) {
  std::string out;
  for (const std::string& name : names_of(study)) out += (out.empty() ? "" : ",") + name;
  out += '\n';
  Cells cells;
  for (std::size_t i = 0; i < study.receivers.list.size(); ++i) {
    fill_row(study, i, cells);
    for (std::size_t c = 0; c < cells.size(); ++c) (out += c == 0 ? "" : ",") += csv_cell(cells[c].text);
    out += '\n';
  }
  return out;
}

std::string json_of(const Study& study) {
  std::string names;
  for (const std::string& name : names_of(study))
    names += (names.empty() ? "" : ", ") + base::json_string(name);
  std::string out =
      fmt::format("{{\n\"scene\": {},\n\"suns\": {},\n\"suns_below_the_horizon\": {},\n",
                  base::json_string(study.scene.name), study.suns.list.size(), study.suns.below);
  if (const Quantity quantity = quantity_of(study.suns); *quantity.unit != 0)
    out += fmt::format("\"value\": \"{}\",\n\"unit\": \"{}\",\n", quantity.name, quantity.unit);
  out += fmt::format("\"model\": {},\n", base::json_string(model_of_suns(study.suns.kind)));
  if (study.sky != nullptr)
    out +=
        fmt::format("\"sky\": \"equally bright, {} patches seen by their centres\",\n", study.sky->patches);
  if (study.suns.timed())
    out += fmt::format("\"zone\": {},\n", base::json_string(zone_text(study.suns.zone_min)));
  fmt::format_to(std::back_inserter(out), "\"columns\": [{}],\n\"rows\": [", names);
  Cells cells;
  for (std::size_t i = 0; i < study.receivers.list.size(); ++i) {
    fill_row(study, i, cells);
    out += i == 0 ? "\n[" : ",\n[";
    for (std::size_t c = 0; c < cells.size(); ++c) (out += c == 0 ? "" : ", ") += json_cell(cells[c]);
    out += ']';
  }
  return out + "\n]\n}\n";
}

}  // namespace tenebra::sun
