#include "apps/report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace spume::apps {
namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    char code[8];
    if (c == '"' || c == '\\')
      out += {'\\', c};
    else if (static_cast<unsigned char>(c) < 0x20) {
      std::snprintf(code, sizeof code, "\\u%04x", c);
      out += code;
    } else {
      out += c;
    }
  }
  return out + '"';
}

/// With as many digits as it takes, 17 at most, to read back the same number.
std::string exactText(double value) {
  char text[32];
  for (int digits = 9; digits <= 17; ++digits) {
    std::snprintf(text, sizeof text, "%.*g", digits, value);
    if (std::strtod(text, nullptr) == value) break;
  }
  return text;
}

}  // namespace

void Report::add(const std::string& key, double value, const std::string& unit) {
  rows_.push_back({key, std::isfinite(value) ? exactText(value) : "null", unit, false});
}

void Report::add(const std::string& key, const std::string& value) {
  rows_.push_back({key, value, {}, true});
}

std::string Report::text() const {
  std::size_t widest = 0;
  for (const Row& row : rows_) widest = std::max(widest, row.key.size());
  std::string out;
  for (const Row& row : rows_) {
    out += row.key + std::string(widest + 2 - row.key.size(), ' ') + row.value;
    if (!row.unit.empty()) out += " " + row.unit;
    out += '\n';
  }
  return out;
}

std::string Report::json() const {
  std::string out = "{";
  for (const Row& row : rows_) {
    out += out.size() > 1 ? ",\n " : "\n ";
    out += quoted(row.key) + ": " + (row.quoted ? quoted(row.value) : row.value);
  }
  return out + "\n}\n";
}

}  // namespace spume::apps
