#include "apps/reproduce/csv_field.h"

namespace spume::apps {

std::string csvField(const std::string& text) {
  if (text.find_first_of(",\"") == std::string::npos) return text;
  std::string quoted(1, '"');
  for (const char c : text) quoted.append(c == '"' ? 2 : 1, c);
  quoted += '"';
  return quoted;
}

std::vector<std::string> csvFields(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t n = 0; n < line.size(); ++n) {
    if (line[n] == '"' && quoted && n + 1 < line.size() && line[n + 1] == '"')
      fields.back() += line[n++];
    else if (line[n] == '"')
      quoted = !quoted;
    else if (line[n] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[n];
  }
  return fields;
}

}  // namespace spume::apps
